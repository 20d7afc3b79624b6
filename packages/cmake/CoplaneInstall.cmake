# cmake --install build --prefix <folder>: programs, libraries, headers, a CMake package (find_package(Coplane)), and in
# <folder>/share/coplane the Python package, the examples with run.py and what their pictures share.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
install(TARGETS coplane_flags coplane_kokkos coplane_tpetra coplane_zoltan2 coplane_seacas_exodus coplane_hdf5 EXPORT CoplaneTargets)
install(EXPORT CoplaneTargets NAMESPACE coplane:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Coplane)
configure_package_config_file(packages/cmake/CoplaneConfig.cmake.in "${PROJECT_BINARY_DIR}/CoplaneConfig.cmake"
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Coplane)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/CoplaneConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/CoplaneConfig.cmake" "${PROJECT_BINARY_DIR}/CoplaneConfigVersion.cmake"
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Coplane)
install(DIRECTORY exodus_inputs DESTINATION ${CMAKE_INSTALL_DATADIR}/coplane USE_SOURCE_PERMISSIONS PATTERN "__pycache__" EXCLUDE)
install(DIRECTORY packages/python/coplane DESTINATION ${CMAKE_INSTALL_DATADIR}/coplane/python PATTERN "__pycache__" EXCLUDE)
install(DIRECTORY apps/coplane/paraview DESTINATION ${CMAKE_INSTALL_DATADIR}/coplane PATTERN "__pycache__" EXCLUDE)
# Input files name their schema by its way from there.
install(DIRECTORY docs/schemas DESTINATION ${CMAKE_INSTALL_DATADIR}/coplane/docs)
