#!/usr/bin/env bash
# Sets up, builds and runs the main job: a 5 m steel bar strikes a wall of 210 bricks at 70 m/s. Then draws it.
#
#   packages/cmake/main-job.sh [--no-pictures] [--end SECONDS] [--folder FOLDER] [--overwrite]
#
# --no-pictures   do not install ParaView and a virtual display, draw nothing
# --end           stop earlier than 0.041 s of simulated time
# --folder        where results and pictures go; default build/main-job
# --overwrite     also files of the same names there that this script has not written; else it refuses
# Nothing is compiled where the Debian package of this very source tree is installed (packages/cmake/packaging/make-packages.sh).
# It is the example exodus_inputs/bar_wall_3d in size S. Every part that is done already is not done again.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
pictures=yes end= folder=$top/build/main-job overwrite=
usage() { echo "main-job: $1; accepted: --no-pictures, --end SECONDS, --folder FOLDER, --overwrite" >&2; exit 2; }
while [ $# -gt 0 ]; do
  case $1 in
    --no-pictures) pictures=no; shift ;;
    --overwrite) overwrite=--overwrite; shift ;;
    --end | --folder)
      [ $# -ge 2 ] && [ -n "$2" ] || usage "$1 lacks its value"
      if [ "$1" = --end ]; then end=$2; else folder=$2; fi
      shift 2 ;;
    *) usage "unknown argument '$1'" ;;
  esac
done
. "$top/packages/cmake/environment.sh"
say() { printf 'main-job [%4d s]: %s\n' "$SECONDS" "$*"; }

# Whether an installed program is of this tree: its version and its revision, with nothing changed since.
is_of_this_tree() {
  local number revision
  number=$(sed -nE 's/^project\(Coplane VERSION ([0-9.]+).*/\1/p' "$top/CMakeLists.txt")
  revision=$(git -C "$top" describe --always --dirty 2>/dev/null || true)
  case $revision in '' | *-dirty) return 1 ;; esac # without git nobody knows
  case $("$1" --version 2>/dev/null) in "coplane $number ($revision;"*) ;; *) return 1 ;; esac
}

installed=$(command -v coplane || true)
if [ -n "$installed" ] && is_of_this_tree "$installed"; then
  programs=$(dirname "$installed")
  say "programs of this version are installed in $programs: nothing is built"
  [ $pictures = no ] || "$top/packages/cmake/dependencies.sh" --only-paraview
else
  programs=$top/build/bin
  say "dependencies"
  arguments=()
  [ $pictures = no ] || arguments+=(--with-paraview)
  COPLANE_TRILINOS=$("$top/packages/cmake/dependencies.sh" "${arguments[@]}" | tail -n 1)
  export COPLANE_TRILINOS
  say "building (log: build/build.log)"
  coplane_configure_and_build coplane coplane_mesh
fi

arguments=()
[ -z "$end" ] || arguments+=(--set "time.end=$end")
[ $pictures = yes ] || arguments+=(--no-pictures)
[ -z "$overwrite" ] || arguments+=(--overwrite)
# /usr/bin/python3 is the one that has Debian's modules.
python=/usr/bin/python3
[ -x $python ] || python=python3
# An early end leaves out what the checks ask for.
[ -z "$end" ] || arguments+=(--no-check)
COPLANE_BIN=$programs $python "$top/exodus_inputs/run.py" bar_wall_3d --size S --output "$folder" "${arguments[@]}"
