coplane_dependencies(PACKAGES dynamics contact element exodus checkpoint mesh core PRIVATE_LIBRARIES coplane::hdf5 fmt::fmt nlohmann_json::nlohmann_json OpenSSL::Crypto)
