#!/usr/bin/env bash
# Sets up, builds and runs the main job: a 5 m steel bar strikes a wall of 210 bricks at 70 m/s. Then draws it.
#
#   packages/cmake/main-job.sh [--no-pictures] [--end SECONDS] [--folder FOLDER]
#
# --no-pictures   do not install ParaView and a virtual display, draw nothing
# --end           stop earlier than 0.041 s of simulated time
# --folder        where results and pictures go; default build/main-job
# Every part that is done already is not done again; an interrupted run goes on where it stopped.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
pictures=yes end= folder=$top/build/main-job
while [ $# -gt 0 ]; do
  case $1 in
    --no-pictures) pictures=no; shift ;;
    --end) end=$2; shift 2 ;;
    --folder) folder=$2; shift 2 ;;
    *) echo "main-job: unknown argument '$1'; accepted: --no-pictures, --end SECONDS, --folder FOLDER" >&2; exit 2 ;;
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
coplane_configure_and_build coplane coplane_mesh_program

mkdir -p "$folder"
cd "$folder"
inputs=$top/exodus_inputs/bar_wall_3d
say "making the mesh"
"$top/build/bin/coplane_mesh" make "$inputs/mesh.yaml" -o bar_wall_3d.e
cp "$inputs/wall.yaml" wall.yaml
# A finished run of the same deck, mesh and program is not repeated.
key=$(cat wall.yaml bar_wall_3d.e "$top/build/bin/coplane" <(echo "end $end") | sha256sum | cut -d' ' -f1)
if [ "$(cat done 2>/dev/null)" != "$key" ]; then
  rm -f done
  say "running (log: $folder/wall.log)"
  overrides=()
  [ -z "$end" ] || overrides=(--set "time.end=$end")
  mpirun -np 2 "$top/build/bin/coplane" wall.yaml --backend serial "${overrides[@]}" | tee wall.log
  echo "$key" > done
fi
if [ $pictures = yes ]; then
  say "drawing"
  mkdir -p pictures
  xvfb-run -a pvbatch "$top/apps/coplane/paraview/wall_pictures.py" wall.e wall_planes.pvd pictures 0 0.0013 0.0183 0.041 >pictures.log 2>&1 ||
    { tail -n 20 pictures.log >&2; exit 1; }
  say "pictures: $folder/pictures/*.png"
fi
say "results: $folder/wall.e (mesh and fields), wall_planes.pvd (contact planes), wall.csv (history), wall.run.json (record)"
