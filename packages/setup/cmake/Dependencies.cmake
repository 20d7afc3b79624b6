coplane_dependencies(PACKAGES dynamics partition input material schema mesh core PRIVATE_LIBRARIES fmt::fmt)
