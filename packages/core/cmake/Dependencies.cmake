coplane_dependencies(LIBRARIES coplane::kokkos MPI::MPI_CXX fmt::fmt PRIVATE_LIBRARIES spdlog::spdlog)
