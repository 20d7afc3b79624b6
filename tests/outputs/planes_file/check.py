"""All planes in one VTKHDF file: the values of the .vtp files, the same bytes on any ranks and after kills and restarts, every finished step after a
kill; ParaView finds all steps of it, and of results that restarts have continued (README.md).

Usage: check.py [number of kills]
"""

import json
import pathlib
import random
import shutil
import subprocess
import sys
import time

import numpy
from coplanetest import Case, documents, program

import coplane
from coplane.planes import Planes

case = Case("planes_file", __file__)
if not shutil.which("pvpython"):
    sys.exit("this test needs ParaView: packages/cmake/dependencies.sh --with-paraview")
kills = int(sys.argv[1]) if sys.argv[1:] and sys.argv[1].isdigit() else 12
recipe, deck = case.load("tests/parallel/same_bits/mesh_2d.yaml"), case.load("tests/parallel/same_bits/deck.yaml")
deck["initial"] = [{"block": "bar", "velocity": [100, 20, 0]}]
deck["time"] = {"end": 6e-4}
deck["output"] = {"every": 4e-6}
in_one = deck
in_many = {**deck, "output": {**deck["output"], "planes_format": "vtp"}}
FILES = ("run_planes.vtkhdf", "run_planes.xmf3")


def attempt(name, deck, *more):
    run = case.attempt(name, recipe, deck, *more)
    if not case.check_equal(f"{name}: exit code", run.code, 0):
        sys.exit(run.output[-3000:])
    return pathlib.Path(run.folder)


def different(series, times, reference):
    """Steps of a series that are not those of the beginning of another one, of which the fields of all steps are given."""
    if not numpy.array_equal(series.times, times[: len(series)]):
        return ["times"]
    return [step for step in range(len(series)) if not same(series.fields(step), reference[step])]


def same(fields, others):
    return fields.keys() == others.keys() and all(numpy.array_equal(values, others[name]) for name, values in fields.items())


# --- values and bytes --------------------------------------------------------------------------------------
vtp = Planes(attempt("vtp", in_many) / "run_planes.pvd")
straight = attempt("ranks_1", in_one)
series = coplane.open(straight).planes
fields = [series.fields(step) for step in range(len(series))]
case.check_within("steps", len(series), 100, 1000)
case.check_equal("steps are those of the .vtp files", (len(series), different(vtp, series.times, fields)), (len(vtp), []))
case.check_equal("names of joints", series.joint_names(-1), vtp.joint_names(-1))
case.check_equal("files", sorted(path.name for path in straight.glob("run_planes*")), sorted(FILES))
other = attempt("ranks_2", in_one, 2)
case.check_equal("ranks change the bytes of", [name for name in FILES if (other / name).read_bytes() != (straight / name).read_bytes()], [])

# --- ParaView --------------------------------------------------------------------------------------------------
reader = """
import json, sys
from paraview import servermanager, simple
found = {}
for name in sys.argv[2:]:
    file = simple.IOSSReader(FileName=name.split(",")) if "," in name else simple.OpenDataFile(name)
    file.UpdatePipelineInformation()
    found[name] = {"times": list(file.TimestepValues)}
    if name.endswith(".xmf3"):
        found[name]["planes"], found[name]["largest"] = [], []
        for time in found[name]["times"]:
            file.UpdatePipeline(time)
            data = servermanager.Fetch(file)
            area = data.GetPointData().GetArray("area")
            found[name]["planes"].append([data.GetNumberOfPoints(), data.GetNumberOfCells()])
            found[name]["largest"].append(area.GetRange()[1] if area else None)
json.dump(found, open(sys.argv[1], "w"))
"""


def paraview(folder, *names):
    (folder / "read.py").write_text(reader)
    done = subprocess.run(["pvpython", "--force-offscreen-rendering", "read.py", "paraview.json", *names], cwd=folder, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=250)  # fmt: skip
    if done.returncode:
        sys.exit(f"pvpython ends with {done.returncode}\n{done.stdout}")
    return json.loads((folder / "paraview.json").read_text())


seen = paraview(straight, "./run_planes.xmf3")["./run_planes.xmf3"]
case.check_equal("ParaView: times are the same", seen["times"] == list(series.times), True)
case.check_equal("ParaView: points and vertices of all steps", seen["planes"] == [[len(found["area"])] * 2 for found in fields], True)
case.check_equal("ParaView: largest areas", seen["largest"] == [max(found["area"]) if len(found["area"]) else None for found in fields], True)

# --- kills and restarts -------------------------------------------------------------------------------------------
chance = random.Random(1805)


def folder_for(name, deck):
    folder = pathlib.Path(name).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy(straight / "mesh.e", folder / "mesh.e")
    documents.save({"mesh": "mesh.e", **deck}, folder / "run.yaml")
    return folder


def wait_for(path, change, process):
    """Until a file has changed so many times, or the run has ended."""
    seen = None
    while change > 0 and process.poll() is None:
        try:
            now = path.stat().st_mtime_ns
        except OSError:
            now = None
        change -= now != seen
        seen = now
        time.sleep(1e-4)
    return process.poll() is None


killed = restarted = 0
reached, wrong = [], []
restarting = {**in_one, "checkpoint": {"every_cycles": 40}}
reference = attempt("checkpoints", restarting)
while killed < kills:
    folder = folder_for("killed", restarting)
    while True:
        again = any(folder.glob("run.chk.[01]"))
        with open(folder / "run.log", "w") as log:
            process = subprocess.Popen([program.binary("coplane"), "run.yaml", *(["--restart"] if again else [])], cwd=folder, stdout=log, stderr=log)
            if killed < kills and wait_for(folder / FILES[0], chance.randint(2, 60), process):
                time.sleep(chance.uniform(0, 0.004))
                process.kill()
            code = process.wait(timeout=300)
        if code == -9:
            killed += 1
            restarted += again
            found = Planes(folder / FILES[0])
            reached.append(len(found))
            wrong += different(found, series.times, fields)
            continue
        if not case.check_equal("killed: the part that was left alone", code, 0):
            sys.exit((folder / "run.log").read_text()[-3000:])
        break
    case.check_equal("killed: bytes that differ at the end", [name for name in FILES if (folder / name).read_bytes() != (reference / name).read_bytes()], [])
    case.check_equal("killed: drafts that are left", [path.name for path in folder.glob("*.part-*")], [])
case.check_equal("killed: steps with other values", wrong, [])
case.check_within("killed: most steps that were there", max(reached), 10, len(series))
case.check_within("killed: restarts", restarted, 1, kills)

# Results in parts: the reader of ParaView looks for parts in the folder that is named, or is told all of them.
parts = ["run.e", *sorted(path.name for path in folder.glob("run.e-s*"))]
case.check_within("parts of the results", len(parts), 2, 1000)
expected = list(coplane.open(folder).results.times)
seen = paraview(folder, *(f"./{name}" for name in parts), str(folder / "run.e"), ",".join(parts))
case.check_equal("ParaView: parts from which all steps are found", [name for name in seen if seen[name]["times"] == expected], list(seen))

# --- files that are there -----------------------------------------------------------------------------------------
folder = folder_for("foreign", in_one)
(folder / FILES[0]).write_text("of the user")
done = subprocess.run([program.binary("coplane"), "run.yaml"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
aside = list(folder.glob(f"{FILES[0]}.old-*"))
case.check_equal("a file of the user is kept", (done.returncode, [path.read_text() for path in aside]), (0, ["of the user"]))
case.check_equal("a file of an earlier run is replaced", (subprocess.run([program.binary("coplane"), "run.yaml", "--quiet"], cwd=folder).returncode,
                 len(list(folder.glob(f"{FILES[0]}.old-*")))), (0, 1))  # fmt: skip
case.finish()
