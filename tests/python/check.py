"""The Python package coplane on short runs: what it reads is what the files hold, whatever wrote them (README.md)."""

import fcntl
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import threading
import time

import netCDF4
import numpy
import pandas

from coplanetest import Case, documents

import coplane
from coplane import exodus, needs, planes, tables
from coplane.units import PLANES, VARIABLES

SOURCE = pathlib.Path(os.environ["COPLANE_SOURCE"])
case = Case("python", __file__)


def equal(what, value, reference):
    case.check_equal(what, bool(numpy.array_equal(value, reference)), True)


def told(what, error, call, *words):
    """A call raises this error, and its text has these words."""
    try:
        call()
        text = "no error"
    except error as raised:
        text = str(raised)
    case.check_equal(f"{what}: told of", [word for word in words if word not in text], [])


# Names with dots, as the program's --set takes them.
dotted = {"joints": {"set.1": {"friction": 0.6, "cohesion": 1e5}, "set": {"friction": 0.7}}}
documents.demand_card(dotted, "joints.set.1.friction")
documents.change(dotted, "joints.set.1.friction", 0.3)
documents.change(dotted, "joints.set.1.cohesion", None)
documents.change(dotted, "joints.set.friction", 0.4)
case.check_equal("names with dots: changed", dotted, {"joints": {"set.1": {"friction": 0.3}, "set": {"friction": 0.4}}})
case.check_equal("names with dots: read", documents.value_at(dotted, "joints.set.1.friction"), 0.3)
told("names with dots: a card that is not there", KeyError, lambda: documents.demand_card(dotted, "joints.det.1.friction"), "the deck has no joints.det; it has set.1, set")

recipe = case.load("exodus_inputs/jointed_rock_2d/mesh.yaml")
documents.change(recipe, "parts.0.blocks", [6, 2])
for group in ("node_sets", "side_sets"):
    for name, axis, place in (("right", "x", 6), ("top", "y", 2)):
        if name in recipe[group]:
            recipe[group][name]["where"][axis] = place
for name in ("after_5", "after_10"):
    recipe["node_sets"].pop(name)
deck = case.load("exodus_inputs/jointed_rock_2d/deck.yaml")
deck.pop("mesh")
deck["time"] = {"end": 3e-3}
deck["output"] = {"every": 5e-4}
deck["history"] = {"every": 0, "joints": ["*"], "tables": ["blocks", "pairs", "materials"], "probes": [{"name": "near", "node_set": "near"}]}
straight = case.run("straight", recipe, deck)

# --- one series, however it was written --------------------------------------------------------------

whole = coplane.open("straight")
first = case.attempt("parts", recipe, {**deck, "output": {"every": 5e-4, "file_per_rank": True}, "checkpoint": {"at_end": True}}, ranks=2,
                     options=["--set", "time.end=1.5e-3"])  # fmt: skip
case.check_equal("first part: exit code", first.code, 0)
split = coplane.Deck.read("parts/run.yaml")
split["output"] = {"every": 5e-4}
split["time.end"] = 3e-3
split.write("parts/run.yaml")
parts = coplane.run("parts/run.yaml", threads=2, restart=True)
case.check_equal("files of each part", [len(files) for files in exodus.files_of("parts/run.e")], [2, 1])
case.check_equal("records", len(parts.records), 2)
steps = [numpy.argmin(numpy.abs(parts.results.times - time)) for time in whole.results.times]
equal("times of the results", parts.results.times[steps], whole.results.times)
case.check_equal("times ascend", bool((numpy.diff(parts.results.times) > 0).all()), True)
for what in ("coordinates", "node_ids", "element_ids"):
    equal(what, getattr(parts.results, what), getattr(whole.results, what))
equal("connectivity", parts.results.connectivity("rock"), whole.results.connectivity("rock"))
for name in whole.results.node_sets:
    equal(f"node set {name}", sorted(parts.node_sets[name]), sorted(whole.node_sets[name]))
for name in whole.nodes:
    equal(f"{name} of all parts", parts.nodes[name].values[steps], whole.nodes[name].values)
for name in whole.elements:
    equal(f"{name} of all parts", parts.elements[name].values[steps], whole.elements[name].values)
order = numpy.lexsort(whole.results.sides("right").T[::-1])
equal("sides of a set", parts.results.sides("right"), whole.results.sides("right")[order])
equal("tractions of a set", parts.side_sets["right"].side_normal_traction.values[steps], whole.side_sets["right"].side_normal_traction.values[:, order])
equal("the history", parts.history.kinetic.values, whole.history.kinetic.values)

# --- fields -----------------------------------------------------------------------------------------

with netCDF4.Dataset("straight/run.e") as file:
    file.set_auto_mask(False)
    number = whole.results.nodal_names.index("velocity_x") + 1
    equal("velocity of the file", whole.nodes.velocity_x.values, file[f"vals_nod_var{number}"][:])
    equal("one step, some nodes", whole.nodes.velocity_x[3, 5:8].values, file[f"vals_nod_var{number}"][3, 5:8])
    equal("every other step", whole.nodes.velocity_x[::2, 4].values, file[f"vals_nod_var{number}"][::2, 4])
near = whole.nodes.isel(node=whole.node_sets["near"]).velocity_x.mean("node")
probe = numpy.interp(near.time, whole.history.index, whole.probes["near"].velocity_x)
case.check("probe: mean over the node set", float(abs(near - probe).max()), 0, 1e-12)
case.check_equal("unit of a velocity", whole.nodes.velocity_y.attrs, {"units": "m/s", "long_name": "velocity, y"})
case.check_equal("blocks", list(whole.blocks), ["rock"])
case.check("corners of an element, against its middle", float(whole.nodes.x.values[whole.blocks["rock"].connectivity[7]].mean()),
           float(whole.elements.x[7]), 1e-12)  # fmt: skip
equal("kinetic energy of results and history", numpy.interp(whole.results.times, whole.history.index, whole.history.kinetic),
      whole.globals.kinetic_energy)  # fmt: skip
page = (SOURCE / "docs/user/outputs.md").read_text()
for line in re.findall(r"^\| (`[a-z_]+[`_,x-z].*) \| (?:nodes|elements|global|side sets) \| (\S*) \|", page, flags=re.M):
    names = re.findall(r"`([a-z_]+?)(?:_x,.*|_xx,.*)?`", line[0])
    unit = {"–": "1", "kg/m³": "kg/m^3"}.get(line[1], line[1])
    case.check_equal(f"unit of {names} on the page", [name for name in names if name in VARIABLES and VARIABLES[name][0] != unit], [])

of_planes = page[page.index("## Planes") : page.index("Open planes keep")]
rows = {name: unit for names, unit in re.findall(r"^\| (`.*?`) \| (.*?) \|", of_planes, flags=re.M) for name, unit in
        zip(re.findall("`(.*?)`", names), unit.split(", ") if ", " in unit else [unit] * 9)}  # fmt: skip
told_units = {name: {"m²": "m^2", "–": None}.get(unit, unit) for name, unit in rows.items()}
case.check_equal("units of planes on the page", {name: unit for name, unit in told_units.items() if unit}, PLANES)

# --- history, tables, planes ------------------------------------------------------------------------

history = whole.history
case.check_equal("units of the history", [history.attrs["units"].get(name) for name in ("kinetic", "dt", "cycle")], ["J", "s", None])
equal("kinetic energy as pandas reads it", history.kinetic, pandas.read_csv("straight/run.csv", float_precision="round_trip")["kinetic[J]"])
case.check_equal("joints and probes", (list(whole.joints), list(whole.probes), list(whole.bodies)), (["tight"], ["near"], []))
equal("stored energy of the joint", whole.joints["tight"].stored, history.contact_stored)
case.check_equal("tables", sorted(whole.tables), ["blocks", "materials", "pairs"])
equal("planes of the pairs", whole.tables["pairs"].groupby("time").planes.sum(), history.planes)
case.check_equal("planes of the last step", len(whole.planes[-1]), int(history.planes.iloc[-1]))
case.check_equal("joints of the planes", sorted(set(whole.planes.at(0).joint)), ["tight"])
case.check("stored energy of the planes", whole.planes[-1].stored.sum(), history.contact_stored.iloc[-1], 1e-12, relative=True)
figure = whole.history.plot(y=["kinetic", "internal"], backend="plotly")
case.check_equal("lines of a plot", [trace.name for trace in figure.data], ["kinetic", "internal"])

# --- decks ------------------------------------------------------------------------------------------

for path in sorted((SOURCE / "exodus_inputs").glob("*/*deck*.yaml")):
    plain = documents.load(path)
    case.check_equal(f"{path.parent.name}/{path.name}: as written again", documents.parse(coplane.Deck.read(path).text), plain)
pathlib.Path("digits.yaml").write_text("a: [-4.802534887208887e-05, 3.543160832092786e-05, 210e9, 2.0e+9, -1.50E-3, 1e-05, 0.1]\n")
digits = coplane.Deck.read("digits.yaml")
case.check_equal("all digits of numbers: as written again", digits.text, digits.path.read_text())
opened = coplane.Deck.read(SOURCE / "exodus_inputs/jointed_rock_2d/deck.yaml")
comments = re.findall("# .*", opened.path.read_text())
opened["time.end"] = 1e-3
opened["conditions.1.side_set"] = "right"
del opened["contact.area_min"]
case.check_equal("comments that are lost", [line for line in comments if line not in opened.text and "hair" not in line], [])
case.check_equal("a deck's values", (opened["time.end"], "contact.area_min" in opened, opened.get("a.b")), (1e-3, False, None))
told("no such value", KeyError, lambda: opened["conditions.9.type"], "conditions.9.type", "'9'")
checked = coplane.Deck.read("straight/run.yaml")
case.check_equal("check: prints the model", "deck and mesh are fine" in checked.check(), True)
checked["contact.skn"] = 1
place = 1 + pathlib.Path("straight/run.yaml").read_text().splitlines().index("contact:")
try:
    checked.check()
except coplane.DeckError as error:
    case.check_equal("a wrong key: told once, with what was meant", (str(error).count("skn"), "contact.skn is not known. Did you mean 'skin'?" in str(error)), (1, True))
case.check_equal("a wrong key: its line", [error.startswith(f"{place}: contact: ") for error in checked.schema_errors()], [True])
del checked["contact.skn"]
checked["blocks.rok"] = checked["blocks.rock"]
told("a wrong name", coplane.DeckError, checked.check, "'rok'", "Did you mean 'rock'?", "straight/run.yaml:")
del checked["blocks.rok"]
case.check_equal("nothing is left beside the deck", [path.name for path in pathlib.Path("straight").glob(".check*")], [])

# --- runs -------------------------------------------------------------------------------------------

checked["time.end"] = 2e-3
checked["output.planes_format"] = "vtp"
told("changes without a file", ValueError, lambda: coplane.run(checked), "Deck.write")
started = coplane.run(checked, "watched", ranks=2, wait=False)
seen = [line["time"] for line in coplane.watch(started, 0.05)]
case.check_equal("watched: ending", started.wait().ending, "completed")
equal("watched: times", seen, coplane.open("watched").history.index)
followed = coplane.run(checked, "followed", wait=False)
while not followed.path(".csv").exists():
    time.sleep(0.01)
seen = [line["cycle"] for line in coplane.watch("followed/run", 0.05)]
equal("watched by its name: cycles", seen, followed.wait().history.cycle)
table = coplane.study(checked, {"time.end": [5e-4, 1e-3], "time.step_factor": [0.5, 2]}, "study")
case.check_equal("study: codes", list(table.code), [0, 3, 0, 3])
case.check_equal("study: values", list(table["time.step_factor"]), [0.5, 2, 0.5, 2])
case.check_within("study: time of the third run", table.time[2], 1e-3, 1.1e-3)
told("a failed run", coplane.RunFailed, lambda: coplane.run("study/001/run.yaml"), "exit code 3", "step_factor")

told("a study of a joint that is not there", KeyError, lambda: coplane.study(checked, {"joints.tihgt.friction": [0.1, 0.2]}, "study"), "joints.tihgt", "it has tight")
told("a study of a block that is not there", KeyError, lambda: coplane.study(checked, {"blocks.rok.rigid": [True]}, "study"), "blocks.rok", "it has rock")
told("a study of a deck without a name", ValueError, lambda: coplane.study(coplane.Deck({"mesh": "mesh.e"}), {"time.end": [1]}), "no path")
for ranks in (0, -1, 1.5, "2"):
    told(f"ranks={ranks!r}", ValueError, lambda: coplane.run(checked, "nowhere", ranks=ranks), "ranks=", "a whole number from 1 on")
told("threads=0", ValueError, lambda: coplane.run(checked, "nowhere", threads=0), "threads=0", "a whole number from 1 on")
case.check_equal("such runs write nothing", pathlib.Path("nowhere").exists(), False)
told("a step of the planes that is not there", IndexError, lambda: whole.planes[400], "no step 400", f"0 to {len(whole.planes) - 1}")
told("a time for a step", IndexError, lambda: whole.planes[2e-4], "no step 0.0002", "0 to")
told("fragments that nobody asked for", FileNotFoundError, lambda: whole.fragments, "writes no fragments", "output.fragments: true")
told("a mesh for a deck", coplane.DeckError, lambda: coplane.Deck.read("straight/mesh.e"), "mesh.e: is no deck", "UTF-8")
told("a value that is no list", ValueError, lambda: coplane.study(checked, {"time.end": 1e-3}, "study"), "time.end", "no list")
measured = coplane.study(checked, {"time.end": numpy.array([5e-4])}, "measured", measure=lambda run: run.probes["nobody"])
case.check_equal("study: a measure that fails", (list(measured.code), "nobody" in measured.error[0]), ([0], True))
case.check_equal("study: the reason of a failure", ["step_factor" in text for text in table.error], [False, True, False, True])

# Another start over an earlier run: nothing of that one is shown.
again = coplane.Deck.read("straight/run.yaml")
again["initial.0.velocity"] = [0, 0, 0] if "initial.0" in again else None
again["time.end"] = 2e-3
coplane.run(again, "stale")
again["output.results"], again["output.planes"] = "none", False
again["time.end"] = 1e-3
del again["history.tables"]
stale = coplane.run(again, "stale")
case.check_equal("files of the earlier run are there", [pathlib.Path(name).exists() for name in ("stale/run.e", "stale/run_pairs.csv")], [True, True])
told("results of an earlier run", FileNotFoundError, lambda: stale.results, "output.results: none")
told("planes of an earlier run", FileNotFoundError, lambda: stale.planes, "output.planes: false")
told("results of another run", FileNotFoundError, lambda: exodus.files_of("straight/run.e", "other"), "run.e", "another run")
for series in ("straight/run_planes.vtkhdf", "watched/run_planes.pvd"):
    told("planes of another run", FileNotFoundError, lambda: planes.Planes(series, "other"), series, "another run")
case.check_equal("tables of an earlier run", stale.tables, {})
again["time.end"] = -1
try:
    coplane.run(again, "stale")
except coplane.RunFailed as failed:
    case.check_equal("a start that fails over an earlier run", (failed.run.ending, failed.run.record), ("failed", {}))
    told("its history", FileNotFoundError, lambda: failed.run.columns, "earlier")
    case.check_equal("what watch gives of it", list(coplane.watch(failed.run)), [])
busy = pathlib.Path("busy")
busy.mkdir(exist_ok=True)
(busy / "run.log").write_text("of the first\n")
with open(busy / "run.lock", "w") as lock:
    fcntl.flock(lock, fcntl.LOCK_EX)
    told("two runs in a folder", RuntimeError, lambda: coplane.run(checked, busy), "another run writes here", "run.lock")
case.check_equal("the log of the first", ((busy / "run.log").read_text(), (busy / "run.yaml").exists()), ("of the first\n", False))
shutil.copy("straight/run.csv", busy)
os.utime(busy / "run.csv", (0, 0))
seen = []
with open(busy / "run.lock", "w") as lock:
    fcntl.flock(lock, fcntl.LOCK_EX)
    watcher = threading.Thread(target=lambda: seen.extend(line["time"] for line in coplane.watch(busy / "run", 0.05)))
    watcher.start()
    time.sleep(0.3)
    case.check_equal("watched before the new history is there", seen, [])
    (busy / "run.csv").write_text("time[s]\n1\n")
    time.sleep(0.3)
watcher.join()
case.check_equal("watched: the new history alone", seen, [1])
tail = tables.Tail("growing.csv")
for text, times in (("time[s]\n1\n2\n", [1, 2]), ("time[s]\n5\n6\n7\n", [5, 6, 7])):
    pathlib.Path("growing.csv").write_text(text)
    case.check_equal("lines of a file that is replaced", [line["time"] for line in tail.lines()], times)
for name in ("straight/run.e", "straight/run_pairs.csv", "straight/run_planes.vtkhdf", "straight/run_planes.xmf3", "watched/run_planes.pvd",
             "watched/run_planes_0000.vtp", "straight/run.run.json", "straight/run.yaml"):  # fmt: skip
    case.check_equal(f"opened by {name}", coplane.open(name).name, "run")
checked["time.end"] = numpy.float64(1e-3)
checked["contact.skn"] = 1
checked["contact.skin"] = "wide"
told("all faults", coplane.DeckError, checked.check, "contact.skn is not known", "skin", "wide")
del checked["contact.skin"]
del checked["contact.skn"]
checked["mesh"] = pathlib.Path("mesh.e")
case.check_equal("values of numpy and paths", (type(checked["time.end"]).__name__, checked["mesh"]), ("float", "mesh.e"))

# --- what is not there ------------------------------------------------------------------------------

for what, get, words in (
    ("probe", lambda: whole.probes["nope"], ("'nope'", "near", "history.probes")), ("joint", lambda: whole.joints["dry"], ("'dry'", "tight", "history.joints")),
    ("table", lambda: stale.tables["pairs"], ("'pairs'", "it has none", "history.tables")), ("block", lambda: whole.blocks["beem"], ("'beem'", "rock")),
    ("body", lambda: whole.bodies["near"], ("'near'", "history.rigid")), ("node set", lambda: whole.node_sets["lft"], ("'lft'", "left")),
):  # fmt: skip
    told(f"no such {what}", KeyError, get, *words)
told("a mesh", FileNotFoundError, lambda: coplane.open("straight/mesh.e"), "mesh.e is a mesh", "straight/run")
os.makedirs("bare", exist_ok=True)
shutil.copy("straight/run.e", "bare")
bare = coplane.open("bare/run")
case.check_equal("results alone are a run", len(bare.results.times), len(whole.results.times))
told("results without a history", FileNotFoundError, lambda: bare.history, "bare/run.csv", "no history")
told("no such run", FileNotFoundError, lambda: coplane.open("straight/rum"), "rum.run.json", "straight/run")
told("a run that has not begun", FileNotFoundError, lambda: coplane.open("study/001/run"), "study/001/run.log ends with", "step_factor")
told("no run in a folder", FileNotFoundError, lambda: coplane.open("study"), "study", "no record")
lines = pathlib.Path("straight/run.csv").read_text().splitlines(keepends=True)
pathlib.Path("cut.csv").write_text("".join(lines[:5])[:-3])
case.check_equal("a line that is being written", len(tables.columns("cut.csv")["time"]), 3)
pathlib.Path("bad.csv").write_text("".join(lines[:3]) + lines[3][:40] + "\n" + lines[4])
told("a damaged line", ValueError, lambda: tables.columns("bad.csv"), "bad.csv:4", "columns")

pathlib.Path("bad.csv").write_text("".join(lines[:3]) + lines[3].replace(",", ",x", 1))
told("no number", ValueError, lambda: tables.columns("bad.csv"), "bad.csv: column cycle")

# Without any of the other modules the package is there, and says what is missing.
alone = "import sys\nfor name in sys.argv[1:]: sys.modules[name] = None\nimport coplane\nrun = coplane.open('straight')\n" \
    "print(len(run.columns['time']), run.results.nodal('velocity').shape)\nrun.history"
done = subprocess.run([sys.executable, "-c", alone, *needs.DEBIAN], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                      env=dict(os.environ, PYTHONPATH=str(SOURCE / "packages/python")))  # fmt: skip
case.check_equal("numpy alone: the history", done.stdout.split()[:1], [str(len(history))])
case.check_equal("numpy alone: what is missing", "apt-get install python3-pandas" in done.stderr, True)

# --- notebooks, what the page shows of a deck from nothing, and a wheel --------------------------------


def executed(what, code):
    """Runs a program in a folder of its own; returns what it printed."""
    folder = pathlib.Path("notebooks") / what
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    done = subprocess.run([sys.executable, "-c", code], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          env=dict(os.environ, PYTHONPATH=str(SOURCE / "packages/python"), MPLBACKEND="agg"))  # fmt: skip
    print(done.stdout[-3000:])
    case.check_equal(f"{what}: exit code", done.returncode, 0)
    return done.stdout


books = sorted((SOURCE / "docs/examples").glob("*.ipynb"))
case.check_within("notebooks", len(books), 4, 100)
for book in books:
    cells = ["".join(cell["source"]) for cell in json.loads(book.read_text())["cells"] if cell["cell_type"] == "code"]
    # As notebooks do, figures are shown and closed after each cell.
    code = ["from matplotlib import pyplot\nfigures = []"] + [
        f"{cell}\nfigures += [[len(axes.lines), axes.get_xlabel() != ''] for number in pyplot.get_fignums() for axes in pyplot.figure(number).axes]\npyplot.close('all')"
        for cell in cells] + ["print(figures)"]  # fmt: skip
    figures = json.loads(executed(book.stem, "\n\n".join(code)).splitlines()[-1].replace("True", "true").replace("False", "false"))
    case.check_equal(f"{book.stem}: figures without curves or labels", [figure for figure in figures if not (figure[0] and figure[1])], [])
    case.check_within(f"{book.stem}: figures", len(figures), 4 if book.stem == "python" else 0, 10)  # others may have tables only
page = (SOURCE / "docs/user/python.md").read_text()
for number, code in enumerate(re.findall(r"```python\n(import coplane\n.*?)```", page, flags=re.S)):
    if "coplane.Deck({" in code:
        case.check_equal("a deck from nothing: ending", executed(f"page_{number}", code + "print(run.ending)\n").split()[-1:], ["completed"])
        break
else:
    case.check_equal("the page makes a deck from nothing", False, True)
told("a recipe with a mistake", coplane.program.ProgramFailed, lambda: coplane.make_mesh({"dimension": 2, "parts": [{"shape": "bx"}]}, "no.e"),
     "recipe:", "'bx'")  # fmt: skip

build = "import shutil, os; from setuptools import build_meta; " \
    "shutil.rmtree('wheel', True); shutil.copytree(os.environ['COPLANE_SOURCE'] + '/packages/python', 'wheel'); os.chdir('wheel'); " \
    "print(build_meta.build_wheel('.'))"
done = subprocess.run([sys.executable, "-c", build], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
version = re.search(r"project\(Coplane VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text()).group(1)
case.check_equal("the wheel", done.stdout.splitlines()[-1], f"coplane-{version}-py3-none-any.whl")
# Where only the wheel is installed, coplane itself tells the schema of decks.
alone = "import coplane; coplane.Deck({'mesh': 'mesh.e', 'materials': {'steel': {'model': 'linear_elastc'}}}).schema_errors() or exit(1); " \
    "print(coplane.program.schema('deck').exists())"
done = subprocess.run([sys.executable, "-c", alone], cwd="wheel", stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                      env=dict(os.environ, PYTHONPATH="", COPLANE_BIN=str(pathlib.Path(coplane.program.binary("coplane")).parent)))  # fmt: skip
print(done.stdout[-3000:])
case.check_equal("the wheel alone: faults of a deck are found", (done.returncode, done.stdout.split()[-1:]), (0, ["False"]))

case.finish()
