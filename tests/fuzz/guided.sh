#!/usr/bin/env bash
# Searches with a coverage-guided fuzzer (libFuzzer) for files that a reader does not survive: what reaches new code is kept and changed
# further.
#
#   tests/fuzz/guided.sh [--sanitize] [--keep] READER RUNS
#
# READER      deck, recipe, gmsh, exodus or checkpoint
# RUNS        files to try; the search starts from corpus/READER and earlier finds
# --sanitize  with address and undefined-behaviour sanitizers, in build-fuzz-sanitize; several times slower
# --keep      at the end corpus/READER becomes the smallest set of files that reaches all that was reached
#
# Needs Debian's clang and libclang-rt-14-dev. Finds are in build-fuzz/READER: crash-*, timeout-*, oom-*; the counts in its log.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$top/build-fuzz keep=no flags=
while [ "${1#--}" != "${1:-}" ]; do
  case $1 in
    --sanitize) build=$top/build-fuzz-sanitize flags="-fsanitize=address,undefined -fno-sanitize-recover=undefined" ;;
    --keep) keep=yes ;;
    *) echo "guided.sh: unknown option '$1'; accepted: --sanitize, --keep" >&2; exit 2 ;;
  esac
  shift
done
[ $# = 2 ] && [ -d "$top/tests/fuzz/corpus/$1" ] || { echo "usage: tests/fuzz/guided.sh [--sanitize] [--keep] READER RUNS; readers:" $(ls "$top/tests/fuzz/corpus") >&2; exit 2; }
command -v clang++ >/dev/null || { echo "guided.sh: no clang++; install the Debian packages clang and libclang-rt-14-dev" >&2; exit 1; }
export COPLANE_READER=$1
runs=$2 corpus=$top/tests/fuzz/corpus/$1 work=$build/$1
. "$top/packages/cmake/environment.sh"
trilinos=${COPLANE_TRILINOS:-$("$top/packages/cmake/dependencies.sh" | tail -n 1)}
cmake -S "$top" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Fuzz -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_FLAGS="$flags" \
  -DCOPLANE_BENCHMARKS=OFF -DCOPLANE_TRILINOS="$trilinos" >/dev/null
ninja -C "$build" coplane_guided | tail -n 1

mkdir -p "$work/found" "$work/smallest"
cd "$work"
export ASAN_OPTIONS=detect_container_overflow=0 # Trilinos is not instrumented
fuzzer=("$build/bin/coplane_guided" -detect_leaks=0 -timeout=30 -rss_limit_mb=4096 -max_len=16384 -print_final_stats=1)
: >log.txt
# In rounds: the netCDF library loses some memory of every file that it refuses.
for ((done = 0; done < runs; done += round)); do
  round=$((runs - done < 200000 ? runs - done : 200000))
  "${fuzzer[@]}" -runs="$round" found "$corpus" >>log.txt 2>&1 || { grep -E 'ERROR|SUMMARY|Test unit' log.txt; exit 1; }
done
echo "$COPLANE_READER: $(awk '/number_of_executed_units/ { n += $2 } END { print n }' log.txt) files, $(grep -E 'cov: [0-9]+' log.txt | tail -n 1 | sed -E 's/.*cov: ([0-9]+) ft: ([0-9]+).*/\1 edges, \2 features/'), no crash"
if [ $keep = yes ]; then
  rm -f smallest/*
  "${fuzzer[@]}" -merge=1 -use_counters=0 smallest "$corpus" found >merge.txt 2>&1
  rm -f "$corpus"/* && cp smallest/* "$corpus"
  echo "$corpus: $(ls smallest | wc -l) files, $(du -sb smallest | cut -f1) bytes"
fi
