#!/usr/bin/env bash
# Sets up, builds and runs the main job: a 5 m steel bar strikes a wall of 210 bricks at 70 m/s. Then draws it.
#
#   packages/cmake/main-job.sh [--no-pictures] [--end SECONDS] [--folder FOLDER] [--overwrite]
#
# --no-pictures   do not install ParaView and a virtual display, draw nothing
# --end           stop earlier than 0.041 s of simulated time
# --folder        where results and pictures go; default build/main-job
# --overwrite     also files of the same names there that this script has not written; else it refuses
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

say "dependencies"
arguments=()
[ $pictures = no ] || arguments+=(--with-paraview)
COPLANE_TRILINOS=$("$top/packages/cmake/dependencies.sh" "${arguments[@]}" | tail -n 1)
export COPLANE_TRILINOS
say "building (log: build/build.log)"
coplane_configure_and_build coplane coplane_mesh

arguments=()
[ -z "$end" ] || arguments+=(--set "time.end=$end")
[ $pictures = yes ] || arguments+=(--no-pictures)
[ -z "$overwrite" ] || arguments+=(--overwrite)
# /usr/bin/python3 is the one that has Debian's modules.
python=/usr/bin/python3
[ -x $python ] || python=python3
# An early end leaves out what the checks ask for.
[ -z "$end" ] || arguments+=(--no-check)
COPLANE_BIN=$top/build/bin $python "$top/exodus_inputs/run.py" bar_wall_3d --size S --output "$folder" "${arguments[@]}"
