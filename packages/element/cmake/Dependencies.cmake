coplane_dependencies(PACKAGES mesh material core PRIVATE_LIBRARIES coplane::kokkos)
