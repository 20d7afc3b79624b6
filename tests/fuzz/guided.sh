#!/usr/bin/env bash
# Searches for a time with a coverage-guided fuzzer (AFL++) for files that a reader does not survive:
#
#   tests/fuzz/guided.sh READER SECONDS
#
# Builds coplane_fuzz in build-fuzz with AFL's compiler pass (Debian package afl++), starts from the good files of CMakeLists.txt and from
# earlier findings, and leaves what it finds in build-fuzz/findings/READER/default/{crashes,hangs}.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
[ $# = 2 ] || { echo "usage: tests/fuzz/guided.sh READER SECONDS" >&2; exit 2; }
reader=$1 seconds=$2 build=$top/build-fuzz
command -v afl-fuzz >/dev/null || { echo "guided.sh: no afl-fuzz; install the Debian package afl++" >&2; exit 1; }
. "$top/packages/cmake/environment.sh"
trilinos=${COPLANE_TRILINOS:-$("$top/packages/cmake/dependencies.sh" | tail -n 1)}
cmake -S "$top" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=afl-g++ -DCOPLANE_BENCHMARKS=OFF \
  -DCOPLANE_TRILINOS="$trilinos" >/dev/null
ninja -C "$build" coplane_fuzz | tail -n 1
inputs=$top/exodus_inputs seeds=$build/seeds/$reader
rm -rf "$seeds" && mkdir -p "$seeds" "$build/findings"
case $reader in
  deck) cp "$inputs"/bars_2d/bars.yaml "$inputs"/bar_wall_3d/wall.yaml "$inputs"/cut_rock_2d/rock.yaml "$seeds" ;;
  gmsh) cp "$top"/apps/coplane_mesh/test/*.msh "$seeds" ;;
  exodus | exodus_hdf5) (cd "$seeds" && "$build/bin/coplane_fuzz" "$reader" --count 0 "$inputs/incline/mesh.yaml" && rm -f read.log) ;;
esac
[ "$reader" != exodus_hdf5 ] || rm -f "$seeds"/*_good.e
resume=$seeds
[ ! -d "$build/findings/$reader/default" ] || resume=-
export AFL_SKIP_CPUFREQ=1 AFL_I_DONT_CARE_ABOUT_MISSING_CRASHES=1 AFL_NO_UI=1 AFL_NO_AFFINITY=1
afl-fuzz -i "$resume" -o "$build/findings/$reader" -t 2000 -V "$seconds" -- "$build/bin/coplane_fuzz" --read "$reader" @@ >"$build/$reader.log" 2>&1 || true
grep -E '^(execs_done|saved_crashes|saved_hangs|corpus_count|bitmap_cvg)' "$build/findings/$reader/default/fuzzer_stats"
