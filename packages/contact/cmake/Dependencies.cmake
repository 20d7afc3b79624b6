coplane_dependencies(PACKAGES mesh geometry joint checkpoint core)
