coplane_dependencies(PACKAGES core)
