coplane_dependencies(PACKAGES core mesh)
