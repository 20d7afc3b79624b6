coplane_dependencies(PACKAGES core LIBRARIES fmt::fmt yaml-cpp::yaml-cpp PRIVATE_LIBRARIES nlohmann_json::nlohmann_json muparser::muparser)
