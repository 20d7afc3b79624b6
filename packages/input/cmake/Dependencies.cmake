coplane_dependencies(PACKAGES joint material core PRIVATE_LIBRARIES yaml-cpp::yaml-cpp nlohmann_json::nlohmann_json muparser::muparser)
