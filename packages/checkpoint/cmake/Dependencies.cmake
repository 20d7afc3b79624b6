coplane_dependencies(PACKAGES core PRIVATE_LIBRARIES coplane::hdf5)
