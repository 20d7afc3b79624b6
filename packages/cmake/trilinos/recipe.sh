# The recipe of the Trilinos that Coplane builds when the user brings none. Sourced by dependencies.sh; the cache key is a hash
# of this folder, so any change here leads to a new build in a new folder and leaves the old one alone.
#
# Debian's binary packages have neither the OpenMP back end of Kokkos nor SEACAS, so the subset is built from Debian's *source*
# package. Four settings bring the build from over 90 minutes to about 10 on two cores: no explicit instantiation of
# KokkosKernels, one Tpetra node type, unity builds, and no Fortran.

trilinos_source_package=trilinos
trilinos_source_version=13.2.0-4

trilinos_options=(
  -DTrilinos_ENABLE_ALL_OPTIONAL_PACKAGES=OFF
  -DTrilinos_ENABLE_SECONDARY_TESTED_CODE=ON
  -DTrilinos_ENABLE_TESTS=OFF
  -DTrilinos_ENABLE_EXAMPLES=OFF
  -DTrilinos_ENABLE_EXPLICIT_INSTANTIATION=ON
  -DTrilinos_ENABLE_Fortran=OFF
  -DBUILD_SHARED_LIBS=ON
  -DCMAKE_BUILD_TYPE=Release
  "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG"
  "-DCMAKE_C_FLAGS_RELEASE=-O2 -DNDEBUG"
  "-DCMAKE_CXX_FLAGS=-w -ffp-contract=off"
  "-DCMAKE_C_FLAGS=-w -ffp-contract=off"
  -DCMAKE_CXX_STANDARD=17
  -DTrilinos_CXX11_FLAGS=-std=c++17

  -DTrilinos_ENABLE_Kokkos=ON
  -DTrilinos_ENABLE_Tpetra=ON
  -DTrilinos_ENABLE_Zoltan=ON
  -DTrilinos_ENABLE_Zoltan2Core=ON
  -DTrilinos_ENABLE_Zoltan2=ON
  -DTrilinos_ENABLE_SEACASExodus=ON
  -DTrilinos_ENABLE_SEACASNemesis=ON
  -DTrilinos_ENABLE_SEACASExodiff=ON
  -DTrilinos_ENABLE_SEACASEpu=ON

  -DTrilinos_ENABLE_OpenMP=ON
  -DKokkos_ENABLE_SERIAL=ON
  -DKokkos_ENABLE_OPENMP=ON
  -DKokkosKernels_ADD_DEFAULT_ETI=OFF
  -DKokkosKernels_INST_EXECSPACE_SERIAL=OFF
  -DKokkosKernels_INST_EXECSPACE_OPENMP=OFF
  -DTpetra_INST_OPENMP=ON
  -DTpetra_INST_SERIAL=OFF
  -DTpetra_INST_DOUBLE=ON
  -DTpetra_INST_INT_LONG_LONG=ON
  -DTpetra_ENABLE_DEPRECATED_CODE=OFF
  -DTpetraCore_ENABLE_TSQR=OFF
  -DTrilinos_ENABLE_TpetraTSQR=OFF
  -DTrilinos_ENABLE_Zoltan2Sphynx=OFF

  -DTPL_ENABLE_MPI=ON
  -DTPL_ENABLE_HDF5=ON
  -DTPL_ENABLE_Netcdf=ON
  -DTPL_ENABLE_Pnetcdf=ON
  -DTPL_ENABLE_BLAS=ON
  -DTPL_ENABLE_LAPACK=ON
  -DTPL_ENABLE_X11=OFF
  -DTPL_ENABLE_Matio=OFF

  -DCMAKE_UNITY_BUILD=ON
  -DCMAKE_UNITY_BUILD_BATCH_SIZE=12
)
