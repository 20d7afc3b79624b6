"""V61: a run whose mesh is dealt out anew every few cycles has the bits of the run on one rank: state, history, tables, results,
planes; so has one that is restarted after a rebalance.

Usage: check.py 2d|3d|sliding|erosion|erosion_3d|everything|rigid|rings|joints|detonation [all]
"""

import itertools
import json
import pathlib
import sys

from coplanetest import Case, differences, program, series_differences
from coplanetest.scenes import straight_run

scene, full = sys.argv[1], "all" in sys.argv[2:]
case = Case(f"V61 rebalance {scene}", __file__)
recipe, deck, joints, straight = straight_run(case, scene)
h = straight.history
cycles = len(h["time"]) - 1
tables = ["run.csv"] + [f"run_{table}.csv" for table in deck["history"]["tables"]]


def rebalanced(count, **partition):
    """The deck with about so many rebalances, between searches too: searches come every 4 cycles."""
    return {**deck, "partition": {"rebalance": "always", "rebalance_every": max(1, cycles // count) | 1, **partition}}


moved = 0  # nodes that changed their rank, over all runs: whether any does in one of them is a matter of measured times


def check_record(name, record, ranks):
    global moved
    done = record["rebalances"]
    if ranks == 1:
        case.check_equal(f"{name}: rebalances", done["count"], 0)
        return
    case.check_within(f"{name}: rebalances", done["count"], 1, float("inf"))
    moved += done["nodes_moved"]


def check_tables_and_planes(name, run):
    case.check_equal(f"{name}: tables that differ", [t for t in tables if run.bytes_of(t) != straight.bytes_of(t)], [])
    files = straight.planes_files()
    case.check_equal(f"{name}: planes files", run.planes_files(), files)
    unequal = [f for f in files if f in run.planes_files() and run.bytes_of(f) != straight.bytes_of(f)]
    case.check_equal(f"{name}: planes files that differ", unequal, [])


def compare(name, ranks, threads, backend, changed):
    run = case.attempt(name, recipe, changed, ranks, threads, backend, joints=joints)
    if not case.check_equal(f"{name}: exit code", run.code, 0):
        print(run.output)
        return
    check_record(name, run.record, ranks)
    case.check_equal(f"{name}: state hash", run.state_hash, straight.state_hash)
    case.check_equal(f"{name}: results that differ", differences(run.path("run.e"), straight.path("run.e")), [])
    check_tables_and_planes(name, run)


runs = [(1, 1, "serial"), (2, 1, "serial"), (3, 1, "threads"), (4, 1, "serial")]
if full:
    runs = [run for run in itertools.product((1, 2, 3, 4, 7), (1, 2), ("serial", "threads")) if run[1] == 1 or run[2] == "threads"]
for ranks, threads, backend in runs:
    compare(f"{ranks}x{threads}_{backend}", ranks, threads, backend, rebalanced(40 if full else 12))
compare("rcb", 2, 2, "threads", rebalanced(12, method="rcb"))

# Stopped after a rebalance, and restarted on other ranks, which rebalance as well.
middle = float(h["time"][cycles * 5 // 9])
stop = ["--set", f"time.end={middle!r}", "--set", "checkpoint.at_end=true"]
first = case.attempt("restarted", recipe, rebalanced(12), 3, 1, "serial", stop, joints=joints)
case.check_equal("restarted, first part: exit code", first.code, 0)
check_record("restarted, first part", first.record, 3)
plain = case.attempt("plain", recipe, deck, 1, 1, "serial", stop, joints=joints)
case.check_equal("checkpoint after rebalances and without differ", first.bytes_of("run.chk.0") != plain.bytes_of("run.chk.0"), False)
code, output = program.run_program(["run.yaml", "--restart", "--backend", "threads", "--threads", "1"], first.folder, 2)
if not case.check_equal("restarted, second part: exit code", code, 0):
    sys.exit(output)
record = json.loads(pathlib.Path(first.path("run.run-s0002.json")).read_text())
check_record("restarted, second part", record, 2)
case.check_equal("restarted: state hash", record["state_hash"], straight.state_hash)
parts = [part for part in (first.path("run.e"), first.path("run.e-s0002")) if pathlib.Path(part).exists()]
case.check_equal("restarted: results that differ", series_differences(straight.path("run.e"), parts), [])
check_tables_and_planes("restarted", first)
case.check_within("nodes that changed their rank, in all runs", moved, 1, float("inf"))
case.finish()
