# Sourced by main-job.sh and run-tests.sh: the environment of MPI runs on a small machine, and the build. $top is the project.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1     # containers often have only root
export OMPI_MCA_rmaps_base_oversubscribe=1                           # tests use more ranks than small machines have cores
export OMPI_MCA_btl_vader_single_copy_mechanism=none                 # not permitted in many containers
export OMPI_MCA_hwloc_base_binding_policy=none
export OMPI_MCA_mpi_yield_when_idle=1                               # so do ranks that poll
export OMP_WAIT_POLICY=passive                                       # spinning threads starve oversubscribed ranks

# coplane_configure_and_build TARGET ...: in build/, for this processor. More CMake options in $COPLANE_CMAKE_OPTIONS.
coplane_configure_and_build() {
  mkdir -p "$top/build"
  # shellcheck disable=SC2086
  { cmake -S "$top" -B "$top/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCOPLANE_ARCH=native -DCOPLANE_UNITY=ON \
      -DCOPLANE_TRILINOS="$COPLANE_TRILINOS" -DCOPLANE_TESTS=ON ${COPLANE_CMAKE_OPTIONS:-} &&
    ninja -C "$top/build" "$@"; } >"$top/build/build.log" 2>&1 ||
    { grep -E 'error|Error|FAILED' -A 8 "$top/build/build.log" | head -n 60 >&2; echo "the build failed, see build/build.log" >&2; return 1; }
}
