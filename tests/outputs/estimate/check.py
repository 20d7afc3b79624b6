"""What --check says that a run will take is what the run takes."""

import json
import pathlib
import re

from coplanetest import Case, Results, program

case = Case("estimate", __file__)


def number(pattern, text):
    found = re.search(pattern, text)
    return float(found.group(1)) if found else float("nan")


bars = case.load("exodus_inputs/bars_2d/bars.yaml")
del bars["mesh"]
flight = {key: value for key, value in bars.items() if key != "initial"} | {
    "initial": [{"block": "left", "velocity": [-2, 0, 0]}], "output": {"every": 1e-4, "times": [5.5e-5, 2e-4]},
    "history": {"every": 1e-4}, "contact": {"enabled": False},
}
for name, deck, tolerance in (("flight", flight, 0), ("bars", bars, 0.05)):
    told = case.attempt(f"{name}_check", case.load("exodus_inputs/bars_2d/mesh.yaml"), deck, ranks=2, options=("--check",))
    case.check_equal(f"{name}: exit code of --check", told.code, 0)
    left = sorted(path.name for path in pathlib.Path(told.folder).iterdir())
    case.check_equal(f"{name}: files after --check", left, ["mesh.e", "mesh.yaml", "output.txt", "run.yaml"])
    run = case.attempt(name, case.load("exodus_inputs/bars_2d/mesh.yaml"), deck, ranks=2)
    case.check_equal(f"{name}: exit code of the run", run.code, 0)
    record = json.loads(pathlib.Path(run.folder, "run.run.json").read_text())
    cycles = record["sizes"]["cycles"]
    estimate = number(r"cycles: ([0-9.e+]+) cycles of", told.output)
    case.check(f"{name}: cycles, {cycles} in fact", estimate, cycles, max(tolerance * cycles, 1))
    case.check(f"{name}: steps of results", number(r"([0-9]+) steps of results", told.output), len(Results(pathlib.Path(run.folder, "run.e")).times), 0)
    size = pathlib.Path(run.folder, "run.e").stat().st_size
    case.check(f"{name}: size of the results [MB]", number(r"([0-9.]+) MB in all", told.output), size / 1e6, 0.1, relative=True)
    case.check(f"{name}: memory [MB]", number(r"memory ([0-9.]+) MB", told.output), record["peak_memory_bytes"]["largest_rank"] / 1e6, 1 / 3, relative=True)
case.finish()
