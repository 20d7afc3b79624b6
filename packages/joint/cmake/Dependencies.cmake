coplane_dependencies(PACKAGES schema core)
