coplane_dependencies(PACKAGES core PRIVATE_LIBRARIES yaml-cpp::yaml-cpp nlohmann_json::nlohmann_json muparser::muparser)
