coplane_dependencies(PACKAGES joint core PRIVATE_LIBRARIES yaml-cpp::yaml-cpp nlohmann_json::nlohmann_json muparser::muparser)
