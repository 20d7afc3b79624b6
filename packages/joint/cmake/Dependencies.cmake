coplane_dependencies(PACKAGES schema core LIBRARIES coplane::kokkos PRIVATE_LIBRARIES fmt::fmt)
