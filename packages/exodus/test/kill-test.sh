#!/bin/sh
# Usage: kill-test.sh <results_writer> <times> [<launcher> ...]: kills the writer at many moments; every announced step must be in
# the file it leaves, and every step in the file must be complete.
writer=$1
times=$2
shift 2
i=1
while [ $i -le "$times" ]; do
  rm -f killed.e log.txt
  touch log.txt
  "$@" "$writer" write killed.e > log.txt 2> errors.txt &
  launched=$!
  while ! grep -q '^step 1$' log.txt && kill -0 $launched 2>/dev/null; do
    sleep 0.02
  done
  # Moments in odd numbers of milliseconds, so that they fall everywhere in the cycle of steps.
  sleep "$(awk "BEGIN { print 0.0137 * $i }")"
  for pid in $(sed -n 's/^pid //p' log.txt); do
    kill -9 "$pid" 2>/dev/null
  done
  kill -9 $launched 2>/dev/null
  wait $launched 2>/dev/null
  sleep 0.05
  steps=$(sed -n 's/^step //p' log.txt | tail -1)
  if [ -z "$steps" ]; then
    echo "the writer finished no step"
    cat errors.txt
    exit 1
  fi
  "$writer" check killed.e "$steps" || exit 1
  i=$((i + 1))
done
rm -f killed.e
