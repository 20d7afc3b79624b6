coplane_dependencies(PACKAGES core mesh PRIVATE_LIBRARIES coplane::zoltan2)
