#!/usr/bin/env bash
# Brings everything Coplane needs onto a Debian 12 machine and prints, as its last line, the folder of Trilinos.
#
#   packages/cmake/dependencies.sh [--with-paraview | --only-paraview] [--with-browser]
#
# 1. installs the Debian packages of debian-packages.txt that are missing (as root, or through sudo);
# 2. unless COPLANE_TRILINOS or Trilinos_DIR names a Trilinos that is already there, or the Debian package coplane-dev has brought the
#    same one, builds the subset described in trilinos/recipe.sh into a per-user cache ($COPLANE_CACHE, else $XDG_CACHE_HOME/coplane,
#    else ~/.cache/coplane).
# --only-paraview installs what draws pictures, and does nothing else. --with-browser installs the browser in which two tests look at pages;
# where that fails they are skipped.
#
# Every stage leaves a stamp: an interrupted run goes on where it stopped, and nothing is ever built twice. Takes about 12
# minutes on two cores the first time, under a second when all is there.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
say() { printf 'dependencies: %s\n' "$*" >&2; }
die() { say "ERROR: $*"; exit 1; }

with_paraview=no only_paraview=no with_browser=no
for argument in "$@"; do
  case $argument in
    --with-paraview) with_paraview=yes ;;
    --only-paraview) only_paraview=yes ;;
    --with-browser) with_browser=yes ;;
    *) die "unknown argument '$argument'; accepted: --with-paraview, --only-paraview, --with-browser" ;;
  esac
done

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"
  elif command -v sudo >/dev/null; then sudo "$@"
  else die "need root for: $* (run as root, or install sudo)"; fi
}

install_packages() { # files with package names
  command -v apt-get >/dev/null || die "apt-get not found: this script is for Debian 12; elsewhere install the equivalents of $* by hand and set COPLANE_TRILINOS"
  local wanted missing=() package
  wanted=$(sed 's/#.*//' "$@" | tr -s '[:space:]' '\n' | grep -v '^$')
  for package in $wanted; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
  done
  [ ${#missing[@]} = 0 ] && return
  say "installing Debian packages: ${missing[*]}"
  local log
  log=$(mktemp)
  { as_root apt-get update -qq &&
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"; } >"$log" 2>&1 ||
    { tail -n 20 "$log" >&2; die "installing Debian packages failed, see $log"; }
  rm -f "$log"
}

[ $only_paraview = no ] || { install_packages "$here/debian-packages-paraview.txt"; exit 0; }
install_packages "$here/debian-packages.txt"
[ $with_paraview = no ] || install_packages "$here/debian-packages-paraview.txt"
[ $with_browser = no ] || (install_packages "$here/debian-packages-browser.txt") || say "no browser: pages are not looked at"

# A Trilinos of the user's own.
given=${COPLANE_TRILINOS:-${Trilinos_DIR:-}}
if [ -n "$given" ]; then
  for folder in "$given" "$given/lib/cmake/Trilinos"; do
    [ -f "$folder/TrilinosConfig.cmake" ] && { say "using the Trilinos in $given"; echo "$given"; exit 0; }
  done
  die "COPLANE_TRILINOS or Trilinos_DIR is '$given', but there is no TrilinosConfig.cmake there or in lib/cmake/Trilinos below it"
fi

packaged=/usr/lib/coplane/trilinos
cmp -s "$here/trilinos/recipe.sh" "$packaged/recipe.txt" && { say "using the Trilinos of the Debian package coplane-dev"; echo "$packaged"; exit 0; }

. "$here/trilinos/recipe.sh"
multiarch=$(gcc -print-multiarch)
netcdf=/usr/lib/$multiarch/netcdf/pnetcdf
[ -f "$netcdf/libnetcdf_pnetcdf.so" ] || [ -f "$netcdf/libnetcdf.so" ] || ls "$netcdf" >/dev/null || die "no netCDF with PnetCDF in $netcdf"
key=$(cat "$here"/trilinos/* <(gcc -dumpfullversion) | sha256sum | cut -c1-12)
cache=${COPLANE_CACHE:-${XDG_CACHE_HOME:+$XDG_CACHE_HOME/coplane}}
[ -n "$cache" ] || cache=${HOME:+$HOME/.cache/coplane}
[ -n "$cache" ] || die "no folder for the build of Trilinos: HOME, XDG_CACHE_HOME and COPLANE_CACHE are all unset; set COPLANE_CACHE to a folder"
prefix=$cache/trilinos-${trilinos_source_version}-$key
work=$cache/work-$key
[ -f "$prefix/complete" ] && { echo "$prefix"; exit 0; }

mkdir -p "$work"
exec 9>"$work/lock"
flock -n 9 || { say "another run builds Trilinos; waiting for it"; flock 9; }
[ -f "$prefix/complete" ] && { echo "$prefix"; exit 0; }
began=$SECONDS

# Source package. A private apt state with the machine's own sources switched to deb-src: the system's lists stay untouched.
if [ ! -f "$work/unpacked" ]; then
  say "fetching the source package $trilinos_source_package $trilinos_source_version (about 170 MB)"
  rm -rf "$work/source" "$work/apt"
  mkdir -p "$work/source" "$work/apt/"{lists/partial,archives/partial,sources}
  codename=$(. /etc/os-release && echo "$VERSION_CODENAME")
  for file in /etc/apt/sources.list.d/*.sources; do
    [ -f "$file" ] || continue
    awk -v RS= -v ORS='\n\n' -v c="$codename" '$0 ~ ("Suites:[^\n]*[ \t]" c "([ \t\n]|$)")' "$file" |
      sed 's/^Types:.*/Types: deb-src/' > "$work/apt/sources/$(basename "$file")"
  done
  { cat /etc/apt/sources.list /etc/apt/sources.list.d/*.list 2>/dev/null || true; } |
    grep -E "^deb .*[[:space:]]$codename[[:space:]]" | sed 's/^deb /deb-src /' > "$work/apt/sources/derived.list" || true
  apt=(-o "Dir::Etc::sourcelist=/dev/null" -o "Dir::Etc::sourceparts=$work/apt/sources" -o "Dir::State::lists=$work/apt/lists"
       -o "Dir::Cache=$work/apt" -o APT::Sandbox::User=)
  { apt-get "${apt[@]}" update -qq >&2 &&
    (cd "$work/source" && apt-get "${apt[@]}" source -qq --download-only "$trilinos_source_package=$trilinos_source_version" >&2); } ||
    die "the source package $trilinos_source_package $trilinos_source_version cannot be fetched (above: what apt says). Is there a network, and does the" \
      "Debian mirror still have this version? Otherwise build Trilinos yourself, as docs/developer/building.md says, and name its folder in COPLANE_TRILINOS"
  (cd "$work/source" && dpkg-source --no-check -x ./*.dsc tree >"$work/unpack.log" 2>&1) || die "unpacking failed, see $work/unpack.log"
  # netCDF 4.9 has a macro of the name of this constant.
  sed -i '/NC_SZIP_NN *=/d' "$(find "$work/source/tree/packages/seacas" -name ex_utils.c)"
  touch "$work/unpacked"
fi

say "building Trilinos $trilinos_source_version into $prefix (about 10 minutes on two cores; log: $work/build.log)"
mkdir -p "$work/build"
if [ ! -f "$work/build/build.ninja" ]; then
  CC=mpicc CXX=mpicxx cmake -S "$work/source/tree" -B "$work/build" -G Ninja -DCMAKE_INSTALL_PREFIX="$prefix" \
    -DCMAKE_PROJECT_Trilinos_INCLUDE="$here/trilinos/project.cmake" "${trilinos_options[@]}" \
    -DHDF5_INCLUDE_DIRS="/usr/include/hdf5/openmpi" -DHDF5_LIBRARY_DIRS="/usr/lib/$multiarch/hdf5/openmpi" \
    -DNetcdf_INCLUDE_DIRS="$netcdf/include" -DNetcdf_LIBRARY_DIRS="$netcdf" \
    -DPnetcdf_INCLUDE_DIRS=/usr/include -DPnetcdf_LIBRARY_DIRS="/usr/lib/$multiarch" \
    >"$work/configure.log" 2>&1 || { rm -f "$work/build/build.ninja"; tail -30 "$work/configure.log" >&2; die "configuring Trilinos failed, see $work/configure.log"; }
fi
jobs=${COPLANE_JOBS:-$(nproc)}
nice -n 5 ninja -C "$work/build" -j "$jobs" install >"$work/build.log" 2>&1 || { grep -E 'FAILED|error' "$work/build.log" | head -20 >&2; die "building Trilinos failed, see $work/build.log"; }
{ cat "$here/trilinos/recipe.sh"; } > "$prefix/recipe.txt"
touch "$prefix/complete"
[ -n "${COPLANE_KEEP_WORK:-}" ] || rm -rf "$work/build" "$work/source" "$work/apt" "$work/unpacked"
say "Trilinos is ready after $(( (SECONDS - began) / 60 )) min $(( (SECONDS - began) % 60 )) s"
echo "$prefix"
