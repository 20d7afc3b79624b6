#!/usr/bin/env bash
# Sets up and builds what is missing, then times five fixed runs and the kernels: a page of Markdown.
#
#   packages/cmake/benchmark.sh [--against PROGRAM | --revision REVISION] [--turns N] [--part SHARE] [--output PAGE]
#
# --against    another `coplane`, timed in turns with this one
# --revision   the same, of an older revision of this repository, which is built in build/benchmark
# --turns      of each run; the least time counts (default: 1)
# --part       of the time of each example, 1: to the end (default: some ten seconds of work each)
# --output     default: build/benchmark/benchmark.md
# Takes about 5 minutes on two free cores with everything built. Numbers of a machine that does other work as well say little.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
usage() { echo "benchmark: $1; accepted: --against PROGRAM, --revision REVISION, --turns N, --part SHARE, --output PAGE" >&2; exit 2; }
revision= page=$top/build/benchmark/benchmark.md arguments=()
while [ $# -gt 0 ]; do
  case $1 in
    --against | --revision | --turns | --part | --output) [ $# -ge 2 ] && [ -n "$2" ] || usage "$1 lacks its value" ;;
    *) usage "unknown argument '$1'" ;;
  esac
  case $1 in
    --revision) revision=$2 ;;
    --output) page=$2 ;;
    --against) arguments+=(--against "$(realpath "$2")") ;;
    *) arguments+=("$1" "$2") ;;
  esac
  shift 2
done
. "$top/packages/cmake/environment.sh"
say() { printf 'benchmark [%4d s]: %s\n' "$SECONDS" "$*" >&2; }

say "dependencies"
COPLANE_TRILINOS=$("$top/packages/cmake/dependencies.sh" | tail -n 1)
export COPLANE_TRILINOS
say "building (log: build/build.log)"
coplane_configure_and_build coplane coplane_mesh coplane_bench_elements coplane_bench_contact
if [ -n "$revision" ]; then
  other=$top/build/benchmark/$(git -C "$top" rev-parse --short "$revision^{commit}")
  say "building revision $revision in $other (log: build.log there)"
  [ -d "$other/source" ] || git -C "$top" worktree add --detach "$other/source" "$revision" >/dev/null
  { cmake -S "$other/source" -B "$other/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCOPLANE_ARCH=native -DCOPLANE_TRILINOS="$COPLANE_TRILINOS" &&
    ninja -C "$other/build" coplane; } >"$other/build.log" 2>&1 || { tail -n 20 "$other/build.log" >&2; exit 1; }
  arguments+=(--against "$other/build/bin/coplane")
fi
mkdir -p "$(dirname "$page")"
say "runs and kernels"
python=/usr/bin/python3 # the one that has Debian's modules
[ -x $python ] || python=python3
$python "$top/tests/performance/benchmark.py" "$top/build/bin" --kernels --folder "$top/build/benchmark/runs" "${arguments[@]}" | tee "$page"
say "wrote $page"
