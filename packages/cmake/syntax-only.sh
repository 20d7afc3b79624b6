#!/bin/sh
# Compiler launcher of the header check: runs the compiler (which only checks syntax) and leaves an empty object file.
"$@" || exit 1
while [ $# -gt 0 ]; do
  [ "$1" = -o ] && : > "$2"
  [ "$1" = -MF ] && [ ! -e "$2" ] && : > "$2"
  shift
done
exit 0
