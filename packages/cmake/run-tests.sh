#!/usr/bin/env bash
# Sets up, builds and runs all tests, and prints the time used beside the budget of docs/developer/ci.md.
#
#   packages/cmake/run-tests.sh [--slow] [--no-sanitizers]
#
# --slow            also the tests labelled slow: the full product of ranks x threads x back ends; each source and each header compiled alone;
#                   sanitizers with all checks on all packages
# --no-sanitizers   leave out the unit tests under address and undefined-behaviour sanitizers
# What is installed and built already is not done again.
set -uo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
slow=no sanitizers=yes
for argument in "$@"; do
  case $argument in
    --slow) slow=yes ;;
    --no-sanitizers) sanitizers=no ;;
    *) echo "run-tests: unknown argument '$argument'; accepted: --slow, --no-sanitizers" >&2; exit 2 ;;
  esac
done
. "$top/packages/cmake/environment.sh"
export COPLANE_UNDER_RUN_TESTS=1

passed=0 failed=0 table=
budget() { sed -nE "s/^\| $1 +\| *([0-9]+) .*/\1/p" "$top/docs/developer/ci.md" | head -n 1; }
# stage NAME COMMAND ...: runs it and notes the time.
stage() {
  local name=$1 began=$SECONDS status=0 allowed used
  shift
  echo "== $name"
  "$@" || status=$?
  allowed=$(budget "$name")
  used=$((SECONDS - began))
  table+=$(printf '%-14s %6d s of %5s s%s' "$name" "$used" "$((${allowed:-0} * 60))" "$([ $used -gt $((${allowed:-0} * 60)) ] && echo '   OVER BUDGET')")$'\n'
  return $status
}
# tests FOLDER LABEL [CTEST ARGUMENT ...]: runs a label's tests and adds to the counts.
tests() {
  local folder=$1 report=$1/junit-$2.xml bad all
  shift
  local label=$1
  shift
  local exclude=()
  [ $label = slow ] || exclude=(-LE slow)
  ctest --test-dir "$folder" -L "^$label\$" "${exclude[@]}" -j "$(nproc)" --output-on-failure --no-tests=error --output-junit "$report" "$@"
  local status=$?
  all=$(grep -c '<testcase ' "$report" 2>/dev/null || true)
  bad=$(grep -c '<failure' "$report" 2>/dev/null || true)
  passed=$((passed + ${all:-0} - ${bad:-0}))
  failed=$((failed + ${bad:-0}))
  [ $status = 0 ] || [ "${bad:-0}" -gt 0 ] || failed=$((failed + 1))
  return $status
}
finish() {
  echo "== time used"
  printf '%s' "$table"
  echo "$passed passed, $failed failed"
  [ $failed = 0 ]
}

get_dependencies() {
  COPLANE_TRILINOS=$("$top/packages/cmake/dependencies.sh" --with-paraview --with-browser | tail -n 1) && [ -n "$COPLANE_TRILINOS" ] && export COPLANE_TRILINOS
}
# What keeps memory of its own by keys and ranks, and what reads files. Four lanes: checks of eight take twice
# as long to compile. --slow: the programs of all packages, with as many lanes as the processor likes.
sanitized_packages=(core checkpoint mesh exodus contact)
build_sanitized() {
  local targets=(coplane_fuzz)
  for package in "${sanitized_packages[@]}"; do targets+=("coplane_${package}_test"); done
  [ $slow = no ] || targets=(unit_tests)
  { cmake -S "$top" -B "$top/build-sanitize" -G Ninja -DCMAKE_BUILD_TYPE=Sanitize -DCOPLANE_ARCH=native -DCOPLANE_UNITY=ON -DCOPLANE_LANES=$([ $slow = yes ] || echo 4) -DCOPLANE_BENCHMARKS=OFF -DCOPLANE_SANITIZE_ALL=$([ $slow = yes ] && echo ON || echo OFF) \
      -DCOPLANE_TRILINOS="$COPLANE_TRILINOS" && ninja -C "$top/build-sanitize" "${targets[@]}"; } >"$top/build/sanitize.log" 2>&1 ||
    { grep -E 'error|FAILED' -A 8 "$top/build/sanitize.log" | head -n 40 >&2; return 1; }
}
sanitized_tests() {
  local packages
  packages=$(IFS='|'; echo "${sanitized_packages[*]}")
  local without='^unit[.]contact[.]1ranks'
  [ $slow = no ] || packages='.*' without='^$'
  build_sanitized &&
    # Open MPI keeps memory until exit, and Trilinos is not instrumented. Two ranks of threads run what one rank, or more of them, do.
    ASAN_OPTIONS=detect_leaks=0:detect_container_overflow=0 tests "$top/build-sanitize" unit \
      -R "^unit[.](($packages)[.](1ranks[.]serial|2ranks[.]threads)|fuzz[.].*)\$" -E "$without"
}

stage dependencies get_dependencies || { failed=1; finish; exit 1; }
COPLANE_CMAKE_OPTIONS=-DCOPLANE_WARNINGS_AS_ERRORS=ON
[ $slow = no ] || COPLANE_CMAKE_OPTIONS+=" -DCOPLANE_UNITY=OFF"
stage build coplane_configure_and_build all $([ $slow = no ] || echo coplane_headers) || { failed=1; finish; exit 1; }
for label in unit verification metamorphic validation parallel paper; do
  stage $label tests "$top/build" $label
done
[ $slow = no ] || stage slow tests "$top/build" slow
[ $sanitizers = no ] || stage sanitizers sanitized_tests
finish
