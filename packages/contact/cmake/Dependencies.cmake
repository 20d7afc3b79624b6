coplane_dependencies(PACKAGES mesh geometry joint core)
