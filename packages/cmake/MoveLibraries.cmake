# Run at installation: the private libraries find each other where they are.
file(GLOB _libraries "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/lib/coplane/lib*.so*")
foreach(_library IN LISTS _libraries)
  file(RPATH_SET FILE "${_library}" NEW_RPATH "$ORIGIN")
endforeach()
