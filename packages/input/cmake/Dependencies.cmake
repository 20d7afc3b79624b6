coplane_dependencies(PACKAGES core material joint LIBRARIES yaml-cpp::yaml-cpp nlohmann_json::nlohmann_json PRIVATE_LIBRARIES muparser::muparser)
