coplane_dependencies(PACKAGES schema joint material core)
