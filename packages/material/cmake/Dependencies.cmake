coplane_dependencies(PACKAGES schema core PRIVATE_LIBRARIES fmt::fmt)
