coplane_dependencies(PACKAGES core LIBRARIES fmt::fmt PRIVATE_LIBRARIES yaml-cpp::yaml-cpp nlohmann_json::nlohmann_json muparser::muparser)
