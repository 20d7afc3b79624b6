coplane_dependencies(LIBRARIES coplane::trilinos fmt::fmt PRIVATE_LIBRARIES spdlog::spdlog)
