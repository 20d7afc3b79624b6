coplane_dependencies(PACKAGES core LIBRARIES fmt::fmt PRIVATE_LIBRARIES coplane::tpetra)
