#!/usr/bin/env bash
# Makes the Debian packages coplane and coplane-dev, for every x86-64 processor: the programs are compiled for several levels of
# processors, and a launcher takes the best that a machine has.
#
#   packages/cmake/packaging/make-packages.sh [OUTPUT_FOLDER]        default: build-package
#
# It installs what building needs (packages/cmake/dependencies.sh) and builds in build-package/LEVEL. What is built is not built again.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
output=${1:-$top/build-package}
mkdir -p "$output"
output=$(cd "$output" && pwd)
levels=(x86-64 x86-64-v3) # the first one is for everybody else, and gives all that is not compiled for one level
say() { printf 'make-packages [%4d s]: %s\n' "$SECONDS" "$*"; }
. "$top/packages/cmake/environment.sh"

say "dependencies"
trilinos=$(env -u COPLANE_TRILINOS -u Trilinos_DIR "$top/packages/cmake/dependencies.sh" | tail -n 1)
others=
for level in "${levels[@]:1}"; do others+="${others:+;}$top/build-package/$level"; done
for level in "${levels[@]}"; do
  build=$top/build-package/$level
  mkdir -p "$build"
  say "building for $level (log: $build/build.log)"
  { cmake -S "$top" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCOPLANE_UNITY=ON -DCOPLANE_LEVELS=ON "-DCOPLANE_ARCH=$level" "-DCOPLANE_OTHER_LEVELS=$others" \
      -DCOPLANE_TESTS=OFF -DCOPLANE_BENCHMARKS=OFF "-DCOPLANE_TRILINOS=$trilinos" -DCMAKE_INSTALL_PREFIX=/usr && ninja -C "$build"; } \
    >"$build/build.log" 2>&1 || { grep -E 'error|Error|FAILED' -A 8 "$build/build.log" | head -n 40 >&2; echo "make-packages: see $build/build.log" >&2; exit 1; }
done
say "packing"
log=$top/build-package/packing.log
rm -f "$output"/coplane_*.deb "$output"/coplane-dev_*.deb
(cd "$top/build-package/${levels[0]}" && cpack -G DEB -B "$output") >"$log" 2>&1 || { tail -n 20 "$log" >&2; exit 1; }
rm -rf "$output/_CPack_Packages"
say "done"
ls -l "$output"/coplane*.deb
