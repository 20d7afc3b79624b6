# Run by cpack before it packs: folders of a package are for everybody, whatever the umask of who makes it.
cmake_policy(VERSION 3.25)
file(GLOB_RECURSE _all LIST_DIRECTORIES true "${CPACK_TEMPORARY_DIRECTORY}/*")
foreach(_folder IN LISTS _all)
  if(IS_DIRECTORY "${_folder}" AND NOT IS_SYMLINK "${_folder}")
    file(CHMOD "${_folder}" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  endif()
endforeach()
