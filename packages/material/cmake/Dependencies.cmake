coplane_dependencies(PACKAGES schema geometry core PRIVATE_LIBRARIES fmt::fmt)
