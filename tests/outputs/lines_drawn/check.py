"""Lines as files for ParaView: the numbers of the table of lines, the same bytes on any ranks and after a restart; lines that come and go."""

import csv
import json
import pathlib
import shutil
import subprocess

import numpy
from coplanetest import Case, documents, program

import coplane
from coplane.planes import planes as fields_of
from coplane.planes import joint_names

case = Case("lines drawn", __file__)
rock = {"model": "linear_elastic", "density": 2500, "youngs_modulus": 20e9, "poisson_ratio": 0.2}
recipe = {
    "dimension": 2,
    "parts": [
        {"shape": "box", "block": "low", "min": [0, 0], "size": [1, 1], "divisions": [4, 4]},
        {"shape": "box", "block": "high", "min": [0, 1.01], "size": [1, 1], "divisions": [4, 4]},
    ],
    "node_sets": {"top": {"where": {"y": 2.01}}},
}
steel = {"area": 5e-4, "youngs_modulus": 200e9}
deck = {
    "materials": {"rock": rock},
    "blocks": {"low": {"material": "rock"}, "high": {"material": "rock"}},
    "contact": {"enabled": False},
    "conditions": [{"type": "fixed", "node_set": "top"}],
    "gravity": [0, -10, 0],
    "lines": {
        "bolt": {"points": [[0.3, 1.9], [0.3, 0.1]], "segment_length": 0.2, "grout": {"stiffness": 2e9, "strength": 1e5}, **steel},
        "late": {"points": [[0.6, 1.9], [0.6, 0.1]], "attach": "ends", "from": 2.5e-3, **steel},
        "gone": {"points": [[0.8, 1.9], [0.8, 0.1]], "attach": "ends", "until": 4.5e-3, **steel},
    },
    "time": {"end": 6e-3},
    "output": {"every": 1e-3, "lines": True},
    "history": {"every": 1e-3, "tables": ["lines"]},
}


def steps_of(folder):
    """Times and files of the series."""
    text = (pathlib.Path(folder) / "run_lines.pvd").read_text()
    entries = [part.split('"')[1:6:4] for part in text.split("<DataSet ")[1:]]
    return [(float(time), pathlib.Path(folder) / file) for time, file in entries]


run = case.run("one", recipe, deck)
steps = steps_of(run.folder)
case.check_equal("steps are those of the results", [time for time, _ in steps], list(run.results.times))
with open(pathlib.Path(run.folder, "run_lines.csv")) as file:
    table = list(csv.DictReader(file))
frame = coplane.open(run.folder).tables["lines"]
case.check_equal("the table as Python reads it: lines and segments", list(zip(frame.line, frame.segment)), [(row["line"], int(row["segment"])) for row in table])
names = joint_names(steps[0][1], "line_names")
case.check_equal("names of lines", names, ["bolt", "late", "gone"])
shown = []
for time, file in steps:
    fields = fields_of(file)
    rows = [row for row in table if float(row["time[s]"]) == time]
    shown.append(sorted({names[int(i)] for i in fields["line"]}))
    ends = fields["connectivity"].reshape(-1, 2)
    case.check_equal(f"t = {time:.4f}: lines and segments", [(names[int(l)], int(s)) for l, s in zip(fields["line"], fields["segment"])],
                     [(row["line"], int(row["segment"])) for row in rows])  # fmt: skip
    middles = 0.5 * (fields["Points"][ends[:, 0]] + fields["Points"][ends[:, 1]])
    for name, values in (("force[N]", fields["force"]), ("stress[Pa]", fields["stress"]), ("strain", fields["strain"]), ("broken", fields["broken"]), ("x[m]", middles[:, 0]),
                         ("y[m]", middles[:, 1]), ("slip_a[m]", fields["slip"][ends[:, 0]]), ("bond_b[N]", fields["bond"][ends[:, 1]])):  # fmt: skip
        told = numpy.array([float(row[name]) for row in rows])
        case.check_equal(f"t = {time:.4f}: {name} is that of the table", bool(len(told) == len(values) and (values == told).all()), True)
case.check_equal("lines over time", shown, [["bolt", "gone"]] * 3 + [["bolt", "gone", "late"]] * 2 + [["bolt", "late"]] * (len(steps) - 5))
h = run.history
case.check_equal("what the line that was taken out stored is booked", bool(h["line_rupture"][-1] > 0 and h["line_rupture"][3] == 0), True)
case.check("remainder of lines over their work", h["line_remainder"][-1] / h["line_stored"].max(), 0, 1e-3)

# --- ranks, restart -----------------------------------------------------------------------------------------------------------------
case.same_bits("one", recipe, deck, run, ranks=2)
other = case.attempt("ranks", recipe, deck, ranks=2)
case.check_equal("ranks: exit code", other.code, 0)
files = sorted(path.name for path in pathlib.Path(run.folder).glob("run_lines*") if path.suffix != ".csv")
for name in files:
    case.check_equal(f"{name} has the same bytes on two ranks", other.bytes_of(name) == run.bytes_of(name), True)
half = case.attempt("restarted", recipe, {**deck, "time": {"end": 3.5e-3}, "checkpoint": {"at_end": True}}, ranks=2)
case.check_equal("restart: exit code of the first half", half.code, 0)
documents.save({"mesh": "mesh.e", **deck}, "restarted/run.yaml")
code, output = program.run_program(["run.yaml", "--restart"], "restarted", ranks=1)
case.check_equal("restart: exit code", code, 0)
case.check_equal("restart: state hash", json.loads(pathlib.Path("restarted/run.run-s0002.json").read_text())["state_hash"], run.state_hash)
again = steps_of("restarted")
kept = [entry for entry in again if entry[0] in dict(steps)]
case.check_equal("restart: all steps of the run without", [time for time, _ in kept], [time for time, _ in steps])
for (time, file), (_, first) in zip(kept, steps):
    fields, of_first = fields_of(file), fields_of(first)
    case.check_equal(f"restart, t = {time:.4f}: the same numbers", all((fields[name] == of_first[name]).all() for name in of_first), True)

# --- ParaView, where it is ---------------------------------------------------------------------------------------------------------------
if shutil.which("pvpython"):
    script = """
import sys
from paraview import servermanager, simple
series = simple.OpenDataFile(sys.argv[1])
series.UpdatePipelineInformation()
times = list(series.TimestepValues)
series.UpdatePipeline(times[-1])
data = servermanager.Fetch(series)
print("READ", len(times), data.GetNumberOfCells(), data.GetCellData().GetArray("force").GetRange()[1])
"""
    pathlib.Path("read.py").write_text(script)
    ended = subprocess.run(["pvpython", "read.py", "./one/run_lines.pvd"], capture_output=True, text=True)
    read = [line.split()[1:] for line in ended.stdout.splitlines() if line.startswith("READ")]
    last = fields_of(steps[-1][1])
    case.check_equal("ParaView: steps and segments", read[0][:2] if read else ended.stderr, [str(len(steps)), str(len(last["force"]))])
    case.check("ParaView: largest force [N]", float(read[0][2]) if read else 0, float(last["force"].max()), 1e-9, relative=True)
case.finish()
