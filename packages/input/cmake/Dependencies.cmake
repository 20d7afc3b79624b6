coplane_dependencies(PACKAGES schema joint material core PRIVATE_LIBRARIES fmt::fmt)
