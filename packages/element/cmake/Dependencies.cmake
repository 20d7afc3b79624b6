coplane_dependencies(PACKAGES mesh material core)
