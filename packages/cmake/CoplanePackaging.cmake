# cpack -G DEB: two packages for Debian 12, coplane and coplane-dev. packages/cmake/packaging/make-packages.sh makes them for every processor; made in
# a single build they are for processors with what COPLANE_ARCH names, and their version says so. A Trilinos of the user's own does not
# go into a package.
if(NOT COPLANE_OWN_TRILINOS)
  return()
endif()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME coplane)
set(CPACK_PACKAGE_VENDOR Coplane)
set(CPACK_PACKAGE_CONTACT "Coplane <coplane@localhost>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "explicit dynamics of solids in contact by common planes")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/packages/cmake/OpenFolders.cmake")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL programs common development)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_THREADS 0)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
if(NOT COPLANE_LEVELS)
  string(MAKE_C_IDENTIFIER "${COPLANE_ARCH}" _arch) # a version has letters and digits
  string(REPLACE "_" "." _arch "${_arch}")
  set(CPACK_DEBIAN_PACKAGE_RELEASE 1+${_arch})
endif()
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${Trilinos_DIR}/../..")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_RUN_PACKAGE_NAME coplane)
set(CPACK_DEBIAN_RUN_PACKAGE_DEPENDS "openmpi-bin, python3 (>= 3.11), python3-numpy, python3-netcdf4, python3-yaml")
set(CPACK_DEBIAN_RUN_PACKAGE_RECOMMENDS "python3-plotly, python3-pandas, python3-xarray, python3-jsonschema, python3-ruamel.yaml, python3-matplotlib, python3-pil")
set(CPACK_DEBIAN_RUN_PACKAGE_SUGGESTS "coplane-dev, paraview, python3-paraview | python3-vtk9, xvfb, xauth, ffmpeg, bash-completion")
set(CPACK_DEBIAN_RUN_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/packages/cmake/packaging/debian/postinst;${PROJECT_SOURCE_DIR}/packages/cmake/packaging/debian/prerm")
set(CPACK_DEBIAN_RUN_DESCRIPTION "Motion of jointed rock, masonry, and whatever breaks and collides: finite elements whose
exterior faces may all touch each other. Programs, examples, the Python package, documents.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME coplane-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "g++, make, cmake, libopenmpi-dev, libhdf5-openmpi-dev, libnetcdf-pnetcdf-dev, libpnetcdf-dev,\
 libcurl4-gnutls-dev, liblapack-dev, libblas-dev, libfmt-dev, libspdlog-dev, libyaml-cpp-dev, nlohmann-json3-dev, libssl-dev, libmuparser-dev")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "Libraries, headers and the CMake package, with the part of Trilinos that they use.")

if(COPLANE_LEVELS)
  # Programs of the builds for other levels beside this one; everything else is of this one.
  set(CPACK_COMPONENTS_PROGRAMS programs)
  set(CPACK_INSTALL_CMAKE_PROJECTS "${PROJECT_BINARY_DIR};Coplane;ALL;/")
  foreach(_build IN LISTS COPLANE_OTHER_LEVELS)
    list(APPEND CPACK_INSTALL_CMAKE_PROJECTS "${_build};Coplane;programs;/")
  endforeach()
endif()

include(CPack)
cpack_add_component_group(run DISPLAY_NAME coplane)
cpack_add_component_group(development DISPLAY_NAME coplane-dev)
cpack_add_component(programs GROUP run)
cpack_add_component(common GROUP run)
cpack_add_component(development GROUP development)
