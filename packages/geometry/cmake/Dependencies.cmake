coplane_dependencies(PACKAGES core LIBRARIES coplane::kokkos)
