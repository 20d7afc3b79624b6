"""V61: a run that is stopped and restarted, again and again, on other ranks, threads and back ends, has the bits of the run that
was never stopped: state, history, results, planes.

Usage: check.py 2d|3d|sliding|erosion|erosion_3d|everything|rigid|rings|joints|detonation [all]
"""

import json
import pathlib
import sys

import numpy
from coplanetest import Case, program, series_differences
from coplanetest.scenes import straight_run

scene, full = sys.argv[1], "all" in sys.argv[2:]
case = Case(f"V61 {scene}", __file__)
recipe, deck, joints, straight = straight_run(case, scene)
h = straight.history
cycles = len(h["time"]) - 1

# Where the run is stopped, and on what the next part runs: (fraction of the cycles, ranks, threads, back end).
chain = [(0.03, 1, 1, "serial"), (0.21, 3, 1, "serial"), (0.36, 2, 2, "threads"), (0.52, 4, 1, "threads"),
         (0.77, 1, 2, "threads"), (1, 2, 1, "serial")]
if full:
    layouts = [(1, 1, "serial"), (7, 1, "serial"), (2, 2, "threads"), (3, 1, "threads"), (4, 1, "serial"), (1, 4, "threads")]
    chain = [((i + 1) / 40, *layouts[i % len(layouts)]) for i in range(40)]


def options(end, restart):
    return ["--set", f"time.end={end!r}", "--set", "checkpoint.at_end=true"] + (["--restart"] if restart else [])


def run_part(folder, fraction, ranks, threads, backend, restart):
    cycle = min(cycles, max(1, int(fraction * cycles) + 1))  # mostly between two searches
    end = float(h["time"][cycle]) if fraction < 1 else deck["time"]["end"]
    arguments = ["run.yaml", "--backend", backend, "--threads", str(threads), *options(end, restart)]
    code, output = program.run_program(arguments, folder, ranks)
    name = f"stop at cycle {cycle}, {ranks} ranks x {threads} {backend}"
    if not case.check_equal(f"{name}: exit code", code, 0):
        sys.exit(output)
    return cycle


fraction, ranks, threads, backend = chain[0]
end = float(h["time"][max(1, int(fraction * cycles) + 1)])
first = case.attempt("stopped", recipe, deck, ranks, threads, backend, options(end, False), joints=joints)
case.check_equal("first part: exit code", first.code, 0)
others = case.attempt("stopped_3", recipe, deck, 3, 1, "threads", options(end, False), joints=joints)
case.check_equal("checkpoint of 1 and of 3 ranks differ", first.bytes_of("run.chk.0") != others.bytes_of("run.chk.0"), False)
for part in chain[1:]:
    run_part(first.folder, *part, True)

record = json.loads(pathlib.Path(first.path(f"run.run-s{len(chain):04}.json")).read_text())
case.check_equal("state hash", record["state_hash"], straight.state_hash)
for file in ["run.csv"] + [f"run_{table}.csv" for table in deck["history"]["tables"]]:
    case.check_equal(f"{file} differs", first.bytes_of(file) != straight.bytes_of(file), False)
parts = [first.path("run.e")] + [first.path(f"run.e-s{number:04}") for number in range(2, len(chain) + 1)]
parts = [part for part in parts if pathlib.Path(part).exists()]
case.check_equal("results that differ", series_differences(straight.path("run.e"), parts), [])
case.check_equal("planes files", first.planes_files(), straight.planes_files())
unequal = [f for f in straight.planes_files() if f in first.planes_files() and first.bytes_of(f) != straight.bytes_of(f)]
case.check_equal("planes files that differ", unequal, [])
case.finish()
