"""V59 to V61 on an example: ranks, threads, back ends, rebalances and a restart change no bit.

Usage: check.py NAME: a folder of exodus_inputs.
"""

import json
import pathlib
import sys

from coplanetest import Case, differences, examples, program, series_differences

name = sys.argv[1]
case = Case(f"example {name}", __file__)
recipe, deck, joints = examples.coarse(name)
tables = [f"run_{table}.csv" for table in deck.get("history", {}).get("tables", [])]

straight = case.attempt("straight", recipe, deck, joints=joints)
if straight.code:
    sys.exit(straight.output)
times = straight.history["time"]
cycles = int(straight.history["cycle"][-1])
case.check_within("cycles", cycles, 20, float("inf"))
case.check_within("planes that carry", float(max(straight.history["stick"] + straight.history["slip"])), 1, float("inf"))


def compare(what, run, results, state_hash):
    case.check_equal(f"{what}: state hash", state_hash, straight.state_hash)
    case.check_equal(f"{what}: tables that differ", [t for t in ["run.csv"] + tables if run.bytes_of(t) != straight.bytes_of(t)], [])
    case.check_equal(f"{what}: results that differ", results, [])
    case.check_equal(f"{what}: planes files", run.planes_files(), straight.planes_files())
    case.check_equal(f"{what}: planes files that differ",
                     [f for f in straight.planes_files() if run.bytes_of(f) != straight.bytes_of(f)], [])


often = {"rebalance": "always", "rebalance_every": max(1, cycles // 8) | 1}
for ranks, threads, backend, partition in [(3, 1, "serial", {}), (2, 2, "threads", {}), (2, 1, "threads", often), (3, 1, "serial", often)]:
    what = f"{ranks} ranks x {threads} {backend}{', rebalanced' if partition else ''}"
    run = case.attempt(what.replace(" ", "_").replace(",", ""), recipe, {**deck, "partition": {**deck.get("partition", {}), **partition}},
                       ranks, threads, backend, joints=joints)
    if not case.check_equal(f"{what}: exit code", run.code, 0):
        print(run.output)
        continue
    if partition:
        case.check_within(f"{what}: rebalances", run.record["rebalances"]["count"], 1, float("inf"))
    compare(what, run, differences(run.path("run.e"), straight.path("run.e")), run.state_hash)

middle = float(times[len(times) * 5 // 9])
first = case.attempt("restarted", recipe, deck, 2, 1, "threads",
                     ["--set", f"time.end={middle!r}", "--set", "checkpoint.at_end=true"], joints=joints)
case.check_equal("restarted, first part: exit code", first.code, 0)
code, output = program.run_program(["run.yaml", "--restart", "--backend", "serial"], first.folder, 3)
if not case.check_equal("restarted, second part: exit code", code, 0):
    sys.exit(output)
parts = [part for part in (first.path("run.e"), first.path("run.e-s0002")) if pathlib.Path(part).exists()]
record = json.loads(pathlib.Path(first.path("run.run-s0002.json")).read_text())
compare("restarted", first, series_differences(straight.path("run.e"), parts), record["state_hash"])
case.finish()
