# Read by Trilinos' own project() call (CMAKE_PROJECT_Trilinos_INCLUDE). Keeps a few targets out of unity builds.
cmake_language(DEFER CALL coplane_tame_unity_builds)

function(coplane_tame_unity_builds)
  foreach(target IN ITEMS kokkoscore teuchosparameterlist zoltan exodus)
    if(TARGET ${target})
      set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
    endif()
  endforeach()
  # In one unity file with Tpetra_CrsMatrix_*.cpp these leave an undefined symbol in libtpetra.
  if(TARGET tpetra)
    get_target_property(sources tpetra SOURCES)
    list(FILTER sources INCLUDE REGEX "Tpetra_RowMatrixTransposer_.*\\.cpp$")
    # They are generated, so their names are relative to the target's binary folder.
    get_target_property(folder tpetra BINARY_DIR)
    list(TRANSFORM sources PREPEND "${folder}/")
    set_source_files_properties(${sources} TARGET_DIRECTORY tpetra PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endfunction()
