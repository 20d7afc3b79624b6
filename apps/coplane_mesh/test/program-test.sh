#!/bin/sh
# Usage: program-test.sh <coplane_mesh> <recipe>: exit codes of the program as docs/user/exit-codes.md states them.
program=$1
recipe=$2
expect()
{
  wanted=$1
  shift
  "$program" "$@" > output.txt 2>&1
  found=$?
  if [ $found -ne "$wanted" ]; then
    echo "coplane_mesh $*: exit code $found, expected $wanted"
    cat output.txt
    exit 1
  fi
}
expect 0 make "$recipe" -o mesh.e
expect 0 check mesh.e
expect 0 --version
expect 0 --help-recipe
expect 2 check
expect 4 check missing.e
expect 3 make missing.yaml -o mesh.e
expect 5 make "$recipe" -o no/such/folder/mesh.e
