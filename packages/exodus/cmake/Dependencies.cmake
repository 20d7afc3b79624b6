coplane_dependencies(PACKAGES core mesh PRIVATE_LIBRARIES coplane::seacas_exodus fmt::fmt)
