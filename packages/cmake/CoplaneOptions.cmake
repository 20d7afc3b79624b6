# What a user can choose when configuring.
set(COPLANE_ARCH "native" CACHE STRING "Processor to compile for (-march=...): native, x86-64-v3, ...; empty for the compiler's default")
set(COPLANE_LANES "" CACHE STRING "Elements or pairs of faces that kernels treat side by side: 4 or 8; empty: 8 if COPLANE_ARCH has AVX-512, else 4")
option(COPLANE_LEVELS "Install programs for COPLANE_ARCH beside those of other builds, and a launcher that takes the best for the processor" OFF)
set(COPLANE_OTHER_LEVELS "" CACHE STRING "Build folders whose programs go into the packages of this one, with COPLANE_LEVELS")
option(COPLANE_TESTS "Build the tests" ON)
option(COPLANE_BENCHMARKS "Build the benchmarks" ON)
option(COPLANE_WARNINGS_AS_ERRORS "Treat warnings as errors (CI does)" OFF)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug, Sanitize, or Fuzz (tests/fuzz/guided.sh)" FORCE)
endif()
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG" CACHE STRING "" FORCE)
# Kernels are inlined whole, and with every check compiling takes three times as long. Left out, unless COPLANE_SANITIZE_ALL: virtual
# tables, object sizes, use after scope, null pointers (they end the program anyway), alignment and overflow of pointers.
option(COPLANE_SANITIZE_ALL "With CMAKE_BUILD_TYPE=Sanitize: with the checks that multiply the time of compiling" OFF)
set(CMAKE_CXX_FLAGS_SANITIZE "-O1 -g1 -fsanitize=address,undefined -fno-omit-frame-pointer -fno-sanitize-recover=undefined")
if(NOT COPLANE_SANITIZE_ALL)
  string(APPEND CMAKE_CXX_FLAGS_SANITIZE " -fno-sanitize=vptr,object-size,null,alignment,pointer-overflow,nonnull-attribute,returns-nonnull-attribute"
    " -fno-sanitize-address-use-after-scope")
endif()
set(CMAKE_EXE_LINKER_FLAGS_SANITIZE "-fsanitize=address,undefined")
set(CMAKE_CXX_FLAGS_FUZZ "-O1 -g1 -fsanitize=fuzzer-no-link")
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")

# Flags of every target of ours. -ffp-contract=off: a run has the same bits whatever back end compiled the kernel, so the
# compiler may not fuse a multiplication with an addition in one place and not in another. Never -ffast-math.
# -fno-tree-slp-vectorize: GCC 12 fuses c x - d y beside d x + c y (a rotation) into one vfmaddsub when it vectorises
# straight-line code, in spite of -ffp-contract=off. Loops and lane types are not concerned.
# -fno-math-errno -fno-trapping-math: square roots and comparisons set no error flags; results are the same.
add_library(coplane_flags INTERFACE)
add_library(coplane::flags ALIAS coplane_flags)
set_target_properties(coplane_flags PROPERTIES EXPORT_NAME flags)
target_compile_features(coplane_flags INTERFACE cxx_std_17)
target_compile_options(coplane_flags INTERFACE -ffp-contract=off -fno-math-errno -fno-trapping-math $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>
  $<BUILD_INTERFACE:-Wall> $<BUILD_INTERFACE:-Wextra> $<BUILD_INTERFACE:-Wno-psabi>)
if(COPLANE_ARCH)
  target_compile_options(coplane_flags INTERFACE $<BUILD_INTERFACE:-march=${COPLANE_ARCH}>)
endif()
# Users of the installed headers need the number that the libraries were built with.
set(lanes "${COPLANE_LANES}")
if(lanes STREQUAL "")
  include(CheckCXXSourceCompiles)
  string(MAKE_C_IDENTIFIER "COPLANE_HAS_AVX512_${COPLANE_ARCH}" has_avx512)
  set(flags_before "${CMAKE_REQUIRED_FLAGS}")
  if(COPLANE_ARCH)
    string(APPEND CMAKE_REQUIRED_FLAGS " -march=${COPLANE_ARCH}")
  endif()
  check_cxx_source_compiles("#ifndef __AVX512F__\n#error\n#endif\nint main() {}" ${has_avx512})
  set(CMAKE_REQUIRED_FLAGS "${flags_before}")
  set(lanes 4)
  if(${has_avx512})
    set(lanes 8)
  endif()
elseif(NOT lanes MATCHES "^[48]$")
  message(FATAL_ERROR "COPLANE_LANES is '${COPLANE_LANES}'; it may be 4, 8 or empty.")
endif()
target_compile_definitions(coplane_flags INTERFACE COPLANE_LANES=${lanes})
if(lanes GREATER 4 AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC's own headers of AVX-512 (bug 105593).
  target_compile_options(coplane_flags INTERFACE $<BUILD_INTERFACE:-Wno-uninitialized> $<BUILD_INTERFACE:-Wno-maybe-uninitialized>)
endif()
if(COPLANE_WARNINGS_AS_ERRORS)
  target_compile_options(coplane_flags INTERFACE $<BUILD_INTERFACE:-Werror>)
endif()
