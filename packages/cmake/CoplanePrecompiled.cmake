# coplane_precompile(<target> ... [TESTS] [ONE_BY_ONE]): compiles these with one precompiled header of what nearly every source includes: Kokkos, fmt,
# MPI and the standard library; with TESTS also GoogleTest. Reading those took longer than compiling what is ours. Sources still include
# what they use: the header of a package that leaves out another header of ours does not compile alone. -DCOPLANE_PRECOMPILED=OFF: without.
# -DCOPLANE_UNITY=ON, as the commands of the README have it: sources of a library, program or test are compiled eight at a time, so what they
# all include and instantiate is compiled once. In what follows a change more is compiled again, so it is off by default. Two of the eight
# cannot have a name in anonymous namespaces in common: rename one. With ONE_BY_ONE sources are compiled one by one.
option(COPLANE_UNITY "Compile sources of libraries, programs and tests several at a time" OFF)

option(COPLANE_PRECOMPILED "Compile with precompiled headers of Kokkos, fmt, MPI and the standard library" ON)

function(_coplane_precompiled target)
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/precompiled.cpp" CONTENT "")
  add_library(${target} OBJECT "${PROJECT_BINARY_DIR}/precompiled.cpp")
  target_link_libraries(${target} PRIVATE coplane::flags coplane::kokkos fmt::fmt MPI::MPI_CXX)
  target_precompile_headers(${target} PRIVATE <Kokkos_Core.hpp> <fmt/format.h> <mpi.h>
    <algorithm> <array> <cmath> <cstdint> <experimental/simd> <filesystem> <fstream> <functional> <iostream> <limits> <map> <memory>
    <numeric> <optional> <set> <sstream> <string> <string_view> <tuple> <type_traits> <unordered_map> <utility> <variant> <vector>)
endfunction()

if(COPLANE_PRECOMPILED)
  # Position-independent code of one kind for libraries and programs: a precompiled header is for one set of options.
  set(CMAKE_CXX_COMPILE_OPTIONS_PIE ${CMAKE_CXX_COMPILE_OPTIONS_PIC})
  _coplane_precompiled(coplane_precompiled)
  if(COPLANE_TESTS)
    _coplane_precompiled(coplane_precompiled_tests)
    target_link_libraries(coplane_precompiled_tests PRIVATE GTest::gtest)
    target_precompile_headers(coplane_precompiled_tests PRIVATE <gtest/gtest.h>)
  endif()
endif()

function(coplane_precompile)
  cmake_parse_arguments(P "TESTS;ONE_BY_ONE" "" "" ${ARGN})
  set(_suffix "")
  if(P_TESTS)
    set(_suffix _tests)
  endif()
  if(COPLANE_UNITY AND NOT P_ONE_BY_ONE)
    set_target_properties(${P_UNPARSED_ARGUMENTS} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    if(P_TESTS) # fixtures in anonymous namespaces
      foreach(_target IN LISTS P_UNPARSED_ARGUMENTS)
        target_compile_options(${_target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
      endforeach()
    endif()
  endif()
  if(COPLANE_PRECOMPILED)
    foreach(_target IN LISTS P_UNPARSED_ARGUMENTS)
      target_compile_options(${_target} PRIVATE -fopenmp) # Kokkos wants it
      target_precompile_headers(${_target} REUSE_FROM coplane_precompiled${_suffix})
    endforeach()
  endif()
endfunction()
