# cmake --install build --prefix <folder>: programs, libraries, headers and a CMake package (find_package(Coplane)).
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
install(TARGETS coplane_flags coplane_kokkos coplane_tpetra coplane_zoltan2 coplane_seacas_exodus coplane_hdf5 EXPORT CoplaneTargets)
install(EXPORT CoplaneTargets NAMESPACE coplane:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Coplane)
configure_package_config_file(packages/cmake/CoplaneConfig.cmake.in "${PROJECT_BINARY_DIR}/CoplaneConfig.cmake"
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Coplane)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/CoplaneConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/CoplaneConfig.cmake" "${PROJECT_BINARY_DIR}/CoplaneConfigVersion.cmake"
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Coplane)
