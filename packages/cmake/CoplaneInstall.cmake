# cmake --install build --prefix <folder>: all of it can be moved:
#   bin                 the programs; with COPLANE_LEVELS a launcher of them, and the programs in lib/coplane/levels/<COPLANE_ARCH>
#   lib/coplane         libraries of the Trilinos that packages/cmake/dependencies.sh built; one of the user's own stays where it is
#   lib, include        libraries, headers and the CMake package (find_package(Coplane)); lib/coplane/trilinos: the Trilinos that it uses
#   share/coplane       the Python package, examples with run.py, what pictures share, documents
#   share/man, share/bash-completion   made from what the programs say with --help
#   share/doc/coplane/html   the searchable site of all pages (packages/cmake/make-site.py)
# Components: programs (of one processor level), common, development. CoplanePackaging.cmake makes Debian packages of them.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
set(COPLANE_PRIVATE_LIBRARIES lib/coplane) # relative, as all of these
if(COPLANE_LEVELS)
  set(COPLANE_PROGRAMS ${COPLANE_PRIVATE_LIBRARIES}/levels/${COPLANE_ARCH})
else()
  set(COPLANE_PROGRAMS ${CMAKE_INSTALL_BINDIR})
endif()

# coplane_install_programs(<target> ...): where they find their libraries.
function(coplane_install_programs)
  coplane_precompile(${ARGN})
  if(COPLANE_OWN_TRILINOS)
    file(RELATIVE_PATH _to_libraries "/${COPLANE_PROGRAMS}" "/${COPLANE_PRIVATE_LIBRARIES}")
    set_target_properties(${ARGN} PROPERTIES INSTALL_RPATH "$ORIGIN/${_to_libraries}")
  else()
    set_target_properties(${ARGN} PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
  endif()
  install(TARGETS ${ARGN} RUNTIME_DEPENDENCY_SET coplane_libraries DESTINATION ${COPLANE_PROGRAMS} COMPONENT programs)
endfunction()

function(_coplane_install_trilinos)
  install(DIRECTORY "${COPLANE_TRILINOS}/include" "${COPLANE_TRILINOS}/lib" DESTINATION ${COPLANE_TRILINOS_INSTALLED}
    COMPONENT development PATTERN "*.py" EXCLUDE PATTERN tribits EXCLUDE)
  install(FILES "${COPLANE_TRILINOS}/recipe.txt" DESTINATION ${COPLANE_TRILINOS_INSTALLED} COMPONENT development)
  configure_file("${PROJECT_SOURCE_DIR}/packages/cmake/MoveTrilinos.cmake.in" "${PROJECT_BINARY_DIR}/MoveTrilinos.cmake" @ONLY)
  install(SCRIPT "${PROJECT_BINARY_DIR}/MoveTrilinos.cmake" COMPONENT development)
endfunction()

function(_coplane_install_cmake_package)
  set(_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Coplane)
  set(COPLANE_TRILINOS_HINT "${Trilinos_DIR}")
  if(COPLANE_OWN_TRILINOS)
    _coplane_install_trilinos()
    set(COPLANE_TRILINOS_HINT "\${PACKAGE_PREFIX_DIR}/${COPLANE_TRILINOS_INSTALLED}")
  endif()
  install(TARGETS coplane_flags coplane_kokkos coplane_tpetra coplane_zoltan2 coplane_seacas_exodus coplane_hdf5 EXPORT CoplaneTargets COMPONENT development)
  install(EXPORT CoplaneTargets NAMESPACE coplane:: DESTINATION ${_folder} COMPONENT development)
  configure_package_config_file(packages/cmake/CoplaneConfig.cmake.in "${PROJECT_BINARY_DIR}/CoplaneConfig.cmake" INSTALL_DESTINATION ${_folder})
  write_basic_package_version_file("${PROJECT_BINARY_DIR}/CoplaneConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
  install(FILES "${PROJECT_BINARY_DIR}/CoplaneConfig.cmake" "${PROJECT_BINARY_DIR}/CoplaneConfigVersion.cmake"
    DESTINATION ${_folder} COMPONENT development)
endfunction()

# Manual pages and completion, from what the programs say with --help.
function(_coplane_install_manuals)
  set(_python /usr/bin/python3) # as in the first line of coplane_command
  execute_process(COMMAND ${_python} -c "import netCDF4, numpy, yaml" RESULT_VARIABLE _missing OUTPUT_QUIET ERROR_QUIET)
  if(NOT _missing STREQUAL "0")
    message(STATUS "No manual pages and no completion: /usr/bin/python3 lacks netCDF4, numpy or yaml")
    return()
  endif()
  set(_folder "${PROJECT_BINARY_DIR}/manuals")
  set(_script "${PROJECT_SOURCE_DIR}/packages/cmake/program-manuals.py")
  set(_programs coplane coplane_mesh coplane_new coplane_pictures coplane_point coplane_report coplane_watch)
  list(TRANSFORM _programs PREPEND "${_folder}/" OUTPUT_VARIABLE _pages)
  list(TRANSFORM _pages APPEND .1.gz)
  file(GLOB _modules CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/packages/python/coplane/*.py")
  add_custom_command(OUTPUT ${_pages} "${_folder}/completion"
    COMMAND ${CMAKE_COMMAND} -E env ${COPLANE_MPI_ENVIRONMENT} ${_python} "${_script}" ${PROJECT_VERSION} "${CMAKE_RUNTIME_OUTPUT_DIRECTORY}" "${_folder}"
    DEPENDS coplane coplane_mesh coplane_point "${_script}" ${_modules}
    COMMENT "Manual pages and completion from --help" VERBATIM)
  add_custom_target(coplane_manuals ALL DEPENDS ${_pages} "${_folder}/completion")
  install(FILES ${_pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT common)
  foreach(_program IN LISTS _programs) # bash looks for a file of the name of the command
    install(FILES "${_folder}/completion" RENAME ${_program} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT common)
  endforeach()
endfunction()

# The searchable site of all pages. It is made while installing, from the pages as they are then; without mkdocs there is none.
function(_coplane_install_site)
  install(CODE "
    execute_process(COMMAND /usr/bin/python3 \"${PROJECT_SOURCE_DIR}/packages/cmake/make-site.py\" \"${PROJECT_BINARY_DIR}/site\"
      RESULT_VARIABLE _failed OUTPUT_VARIABLE _said ERROR_VARIABLE _said)
    if(_failed)
      message(WARNING \"No site of the documents: \${_said}\")
    else()
      file(INSTALL \"${PROJECT_BINARY_DIR}/site/\" DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/doc/coplane/html\")
    endif()" COMPONENT common)
endfunction()

function(coplane_install)
  _coplane_install_cmake_package()
  _coplane_install_manuals()
  _coplane_install_site()
  if(COPLANE_OWN_TRILINOS)
    file(REAL_PATH "${COPLANE_TRILINOS}" _trilinos)
    string(REGEX REPLACE "([][+.*()^$?|])" "\\\\\\1" _trilinos "${_trilinos}")
    install(RUNTIME_DEPENDENCY_SET coplane_libraries POST_INCLUDE_REGEXES "^${_trilinos}/" POST_EXCLUDE_REGEXES ".*"
      LIBRARY DESTINATION ${COPLANE_PRIVATE_LIBRARIES} COMPONENT common)
    install(SCRIPT "${PROJECT_SOURCE_DIR}/packages/cmake/MoveLibraries.cmake" COMPONENT common)
  endif()
  install(DIRECTORY exodus_inputs docs DESTINATION ${CMAKE_INSTALL_DATADIR}/coplane COMPONENT common PATTERN "__pycache__" EXCLUDE PATTERN "*.e" EXCLUDE
    PATTERN run.py EXCLUDE)
  install(PROGRAMS exodus_inputs/run.py DESTINATION ${CMAKE_INSTALL_DATADIR}/coplane/exodus_inputs COMPONENT common)
  install(DIRECTORY packages/python/coplane DESTINATION ${CMAKE_INSTALL_DATADIR}/coplane/python COMPONENT common PATTERN "__pycache__" EXCLUDE)
  install(DIRECTORY apps/coplane/paraview DESTINATION ${CMAKE_INSTALL_DATADIR}/coplane COMPONENT common PATTERN "__pycache__" EXCLUDE)
  # What Debian looks for in its own places.
  set(_links "${PROJECT_BINARY_DIR}/links")
  file(MAKE_DIRECTORY "${_links}")
  file(CREATE_LINK ../../../share/coplane/python/coplane "${_links}/coplane" SYMBOLIC)
  install(FILES "${_links}/coplane" DESTINATION lib/python3/dist-packages COMPONENT common)
  file(CREATE_LINK ../../coplane/docs "${_links}/docs" SYMBOLIC)
  install(FILES "${_links}/docs" packages/cmake/packaging/debian/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/coplane COMPONENT common)
  install(FILES packages/cmake/packaging/debian/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/coplane-dev COMPONENT development)
endfunction()
