#!/usr/bin/env python3
"""The cases of tests/verification with a key of the deck set in all runs that accept it: which checks do not hold any more.

    python3 tests/measure/verification_with.py BIN KEY=VALUE [NAME ...] [--folder FOLDER] > table.md

BIN is the folder of the programs, KEY=VALUE as for `--set`: time.subcycling.levels=4, say. NAMEs choose some of the cases and may have * and ?. Decks that the key does
not go with (exit code 3 of --check) run as they are.

A row tells how many runs of a case had the key, and what of its checks failed, with value, reference and tolerance. Some fail for good reason: the first five thousandths of
an energy balance are no error where a key lets runs take longer steps. The exit code is 0.
"""

import argparse
import fnmatch
import json
import os
import pathlib
import stat
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = """#!/bin/sh
# {real} with one key more, where the deck goes with it.
deck="$1"
case "$deck" in
*.yaml) ;;
*) exec "{real}" "$@" ;;
esac
restart=
for one in "$@"; do # --check starts nothing anew
  shift
  if [ "$one" = --restart ]; then restart=--restart; else set -- "$@" "$one"; fi
done
if env -i PATH="$PATH" HOME="$HOME" OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "{real}" "$@" --set "{key}" --check >/dev/null 2>&1; then
  [ "${{OMPI_COMM_WORLD_RANK:-0}}" = 0 ] && echo with >>"{tally}"
  exec "{real}" "$@" --set "{key}" $restart
fi
exec "{real}" "$@" $restart
"""


def programs_with(bin_folder, key, folder):
    """A folder of programs like the other one, with a `coplane` that sets the key."""
    programs = folder / "bin"
    programs.mkdir(parents=True, exist_ok=True)
    for file in bin_folder.iterdir():
        link = programs / file.name
        link.unlink(missing_ok=True)
        if file.name != "coplane":
            link.symlink_to(file.resolve())
    own = programs / "coplane"
    own.write_text(PROGRAM.format(real=(bin_folder / "coplane").resolve(), key=key, tally=folder / "tally"))
    own.chmod(own.stat().st_mode | stat.S_IXUSR)
    return programs


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("key")
    parser.add_argument("names", nargs="*", default=["*"])
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("verification_with"))
    options = parser.parse_args()
    folder = options.folder.resolve()
    programs = programs_with(options.bin, options.key, folder)
    environment = {**os.environ, "COPLANE_BIN": str(programs), "COPLANE_SOURCE": str(SOURCE)}
    environment["PYTHONPATH"] = os.pathsep.join([str(SOURCE / "tests/support"), str(SOURCE / "exodus_inputs")])
    environment.setdefault("MPIEXEC", "mpiexec")
    print(f"Verification with `{options.key}`\n\n| case | runs with it | checks | do not hold |\n|---|---|---|---|")
    for check in sorted((SOURCE / "tests/verification").glob("*/check.py")):
        name = check.parent.name
        if not any(fnmatch.fnmatch(name, wanted) for wanted in options.names):
            continue
        place = folder / name
        place.mkdir(exist_ok=True)
        (folder / "tally").write_text("")
        for old in place.glob("checks.jsonl"):
            old.unlink()
        done = subprocess.run([sys.executable, check], cwd=place, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        (place / "log").write_text(done.stdout)
        results = place / "checks.jsonl"
        checks = [json.loads(line) for line in results.read_text().splitlines()] if results.exists() else []
        failed = [f"{c['quantity']}: {c['value']} for {c['reference']} +- {c['tolerance']}" for c in checks if not c["passed"] and not c.get("reported")]
        if done.returncode and not failed:
            failed = [(done.stdout.strip().splitlines() or ["no output"])[-1]]
        print(f"| {name} | {len((folder / 'tally').read_text().split())} | {len(checks)} | {'; '.join(failed)} |", flush=True)


if __name__ == "__main__":
    main()
