# coplane_unit_test(<package> SOURCES <file> ... [AS_SHIPPED <file> ...] [RANKS 1 2 4] [LIBRARIES <target> ...])
#   One GoogleTest program per package; it runs once for every number of ranks on both back ends. Label: unit; with threads on more than
#   two ranks, and on more than four ranks, also slow. Sources have -O1, which compiles faster; AS_SHIPPED: what compares the bits of
#   kernels in headers, compiled as programs are.
# coplane_program_test(<name> LABELS <label> ... COMMAND <command> ... [PROCESSORS n] [TIMEOUT s])
#   A whole-program check. Its working folder is made fresh for it.
if(COPLANE_TESTS)
  enable_testing()
endif()
# pml ob1: on one machine nothing is sent over networks, and looking for fast ones takes 0.2 s of each start.
set(COPLANE_MPI_ENVIRONMENT OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
    OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_pml=ob1 OMP_WAIT_POLICY=passive OMP_PROC_BIND=false)

function(coplane_unit_test package)
  cmake_parse_arguments(T "" "" "SOURCES;AS_SHIPPED;RANKS;LIBRARIES" ${ARGN})
  set(_target coplane_${package}_test)
  add_executable(${_target} ${T_SOURCES} ${T_AS_SHIPPED})
  target_compile_options(${_target} PRIVATE $<$<CONFIG:Release>:-O1>)
  set_source_files_properties(${T_AS_SHIPPED} PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-O3>)
  target_link_libraries(${_target} PRIVATE coplane::${package} coplane::testing ${T_LIBRARIES})
  coplane_precompile(${_target} TESTS)
  add_dependencies(unit_tests ${_target})
  if(NOT T_RANKS)
    set(T_RANKS 1)
  endif()
  foreach(_ranks IN LISTS T_RANKS)
    foreach(_backend serial threads)
      set(_test unit.${package}.${_ranks}ranks.${_backend})
      set(_launch "")
      if(_ranks GREATER 1)
        set(_launch ${MPIEXEC_EXECUTABLE} -np ${_ranks} --bind-to none)
      endif()
      add_test(NAME ${_test} COMMAND ${_launch} $<TARGET_FILE:${_target}> --backend ${_backend} --threads 2)
      set(_labels unit)
      if(_ranks GREATER 4 OR (_ranks GREATER 2 AND _backend STREQUAL threads))
        list(APPEND _labels slow)
      endif()
      set_tests_properties(${_test} PROPERTIES LABELS "${_labels}" PROCESSORS ${_ranks} TIMEOUT 900 ENVIRONMENT "${COPLANE_MPI_ENVIRONMENT}")
    endforeach()
  endforeach()
endfunction()

function(coplane_program_test name)
  cmake_parse_arguments(T "" "PROCESSORS;TIMEOUT" "LABELS;COMMAND" ${ARGN})
  if(NOT T_PROCESSORS)
    set(T_PROCESSORS 2)
  endif()
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 600)
  endif()
  set(_folder "${CMAKE_CURRENT_BINARY_DIR}/${name}")
  file(MAKE_DIRECTORY "${_folder}")
  add_test(NAME ${name} COMMAND ${T_COMMAND} WORKING_DIRECTORY "${_folder}")
  set_tests_properties(${name} PROPERTIES LABELS "${T_LABELS}" PROCESSORS ${T_PROCESSORS} TIMEOUT ${T_TIMEOUT}
    ENVIRONMENT "${COPLANE_MPI_ENVIRONMENT};COPLANE_BIN=${CMAKE_RUNTIME_OUTPUT_DIRECTORY};COPLANE_SOURCE=${PROJECT_SOURCE_DIR};COPLANE_EXODIFF=${Trilinos_DIR}/../../../bin/exodiff")
endfunction()

# `ninja unit_tests` builds the unit tests only (for the sanitizers).
add_custom_target(unit_tests)
# `ninja coplane_headers` compiles each header alone.
add_custom_target(coplane_headers)
