"""Values that are absurd, names that are odd, and small things that were wrong once (README.md)."""

import copy
import csv
import json
import os
import pathlib
import resource
import shutil
import subprocess
import time
import xml.etree.ElementTree

import netCDF4
import numpy
from coplanetest import Case, documents, program

case = Case("limits", __file__)
steel = {"model": "linear_elastic", "density": 7800, "youngs_modulus": 200e9, "poisson_ratio": 0.3}
box = {"shape": "box", "block": "low", "min": [0, 0], "size": [1, 1], "divisions": [4, 4]}
recipe = {"dimension": 2, "parts": [box, {**box, "block": "high", "min": [0, 1.001]}],
          "node_sets": {"ground": {"block": "low", "where": {"y": 0}}, "left": {"block": "low", "where": {"x": 0}}}}
deck = {"materials": {"steel": steel}, "blocks": {"low": {"material": "steel"}, "high": {"material": "steel"}},
        "joints": {"touch": {"model": "penalty", "friction": 0.3}}, "contact": {"default_joint": "touch"},
        "time": {"end": 1e-3}, "output": {"results": "none"}}
DECK, MESH, OUTPUT, COMPUTATION, MACHINE = 3, 4, 5, 6, 10


def attempt(name, code, words=(), changes=None, ranks=1, recipe=recipe, options=(), deck=deck):
    folder = pathlib.Path(name.replace(" ", "_")).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    if recipe:
        documents.save({"title": "limits", **recipe}, folder / "mesh.yaml")
        program.make_mesh(str(folder / "mesh.yaml"), str(folder / "mesh.e"))
    changed = copy.deepcopy(deck)
    for path, value in (changes or {}).items():
        place = changed
        *way, last = path.split(".")
        for key in way:
            place = place.setdefault(key, {})
        place[last] = value
    documents.save({"mesh": "mesh.e", **changed}, folder / "run.yaml")
    begin = time.monotonic()
    try:
        found, output = program.run_program(["run.yaml", *options], folder, ranks, timeout=60)
    except subprocess.TimeoutExpired:
        found, output = "no end", ""
    good = case.check_equal(f"{name}: exit code", found, code)
    if not (case.check_equal(f"{name}: words missing", [word for word in words if word not in output], []) and good):
        print(output[-3000:])
    return folder, output


def history(folder, name="run.csv"):
    with open(folder / name, newline="") as file:
        rows = list(csv.reader(file))
    return rows[0], rows[1:]


# --- absurd values ------------------------------------------------------------------------------------------
up = [{"block": "high", "velocity": [0, -1e150, 0]}]
for ranks in (1, 2, 3):
    attempt(f"velocity 1e150 on {ranks} ranks", COMPUTATION, ["far too large"], {"initial": up}, ranks)
    attempt(f"gravity 1e300 on {ranks} ranks", COMPUTATION, ["not finite"], {"gravity": [0, -1e300, 0]}, ranks)
# The same where many bodies are near one another: on revision 4283725 the search ran out of memory, on one rank with code 70, and on two ranks without an end.
scene = {"recipe": case.load("tests/parallel/same_bits/mesh_2d.yaml"), "deck": case.load("tests/parallel/same_bits/deck.yaml")}
scene["deck"] = {**scene["deck"], "time": {"end": 2e-5}, "output": {"results": "none"}}
for ranks in (1, 2, 3):
    attempt(f"a bar at 1e150 on {ranks} ranks", COMPUTATION, ["far too large"], {"initial": [{"block": "bar", "velocity": [1e150, 2e149, 0]}]}, ranks, **scene)
    attempt(f"bodies under gravity 1e150 on {ranks} ranks", COMPUTATION, ["far too large"], {"gravity": [0, -1e150, 0]}, ranks, **scene)
attempt("fixed step 1e-300", COMPUTATION, ["time.fixed_step"], {"time.fixed_step": 1e-300})
documents.save({"dimension": 3, "parts": [{**box, "min": [0, 0, 0], "size": [1, 1, 1], "divisions": [10000, 10000, 10000]}]}, "huge.yaml")
done = subprocess.run([program.binary("coplane_mesh"), "make", "huge.yaml", "-o", "huge.e"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
case.check_equal("1e12 elements: code and cause", (done.returncode, "at most" in done.stdout), (DECK, True))
documents.save({"dimension": 3, "parts": [{**box, "min": [0, 0, 0], "size": [1, 1, 1], "divisions": [400, 400, 400]}]}, "large.yaml")
done = subprocess.run([program.binary("coplane_mesh"), "make", "large.yaml", "-o", "large.e"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                      preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_DATA, (2**28, 2**28)))
case.check_equal("more than the memory: code and cause", (done.returncode, "not enough memory" in done.stdout), (MACHINE, True))
folder, _ = attempt("a table of a million rows", 0, changes={"time.end": 1e-6})
rows = 500001
table = {"times": [round(i * 1e-6, 6) for i in range(rows)], "values": [0] * rows}
with open(folder / "run.yaml", "a") as file:
    file.write("gravity: [0, {times: [" + ", ".join(f"{i}e-6" for i in range(rows)) + "], values: [" + "0, " * (rows - 1) + "0]}, 0]\n")
code, output = program.run_program(["run.yaml", "--check"], folder, timeout=100)
case.check_equal("a table of a million numbers is read", code, 0)
if code:
    print(output[-2000:])

folder, _ = attempt("a node far away", 0, changes={"time.end": 1e-6})
with netCDF4.Dataset(folder / "mesh.e", "a") as mesh:
    mesh["coordx"][0] = -1e100
for ranks in (1, 2):
    code, output = program.run_program(["run.yaml", "--check"], folder, ranks, timeout=60)
    case.check_equal(f"a node far away, {ranks} ranks: code and place", (code, "1e+100" in output, "outermost" in output), (MESH, True, True))
for key in ("checkpoint.file", "history.file", "output.results", "mesh", "title"):
    attempt(f"a zero byte in {key}", DECK, ["zero byte"], options=["--set", f'{key}="a\\0b"'])
for variable, value in (("KOKKOS_NUM_THREADS", "2"), ("KOKKOS_NUM_THREADS", "abc"), ("KOKKOS_DEVICE_ID", "x"), ("KOKKOS_DISABLE_WARNINGS", "maybe")):
    os.environ[variable] = value
    attempt(f"{variable} = {value}", 0, changes={"time.end": 1e-6})
    del os.environ[variable]

for name, changes in (("gravity", {"gravity": [0, 0, 5]}), ("velocity", {"initial": [{"block": "high", "velocity": [0, -1, 2]}]}),
                      ("angular_velocity", {"initial": [{"block": "high", "angular_velocity": [1, 0, 0]}]}),
                      ("symmetry", {"conditions": [{"type": "symmetry", "node_set": "ground", "normal": [0, 0, 1]}]})):
    attempt(f"{name} out of the plane", DECK, [name, "run.yaml", "two dimensions"], changes)

# --- counts of cycles, free flight --------------------------------------------------------------------------
folder, _ = attempt("fixed step", 0, changes={"time.end": 1e-5, "time.fixed_step": 1e-8, "history.every": 1e-6})
names, lines = history(folder)
case.check_equal("cycles of a fixed step that fits 1000 times", int(lines[-1][names.index("cycle")]), 1000)
case.check_equal("lines of ten outputs and the start", len(lines), 11)
# The first kinetic energy of a start from rest is that of half a step backwards and half a step on: -m/2 (g dt/2)^2.
folder, _ = attempt("from rest", 0, changes={"time.end": 1e-5, "time.fixed_step": 1e-6, "gravity": [0, -9.81, 0]})
names, lines = history(folder)
exact = -0.5 * 2 * 7800 * (9.81 * 0.5e-6) ** 2
case.check("kinetic energy at the start, from rest under gravity [J]", float(lines[0][names.index("kinetic[J]")]), exact, 1e-9, relative=True)
rigid = {"blocks": {name: {"material": "steel", "rigid": True} for name in ("low", "high")}, "time.end": 0.1, "gravity": [0, -9.81, 0],
         "initial": [{"block": name, "velocity": [2, 1, 0]} for name in ("low", "high")], "history.rigid": ["*"]}
for ranks in (1, 2):
    folder, _ = attempt(f"rigid bodies in free flight, {ranks} ranks", 0, changes=rigid, ranks=ranks)
    names, lines = history(folder)
    time_ = float(lines[-1][names.index("time[s]")])
    y = float(lines[-1][names.index("low_displacement_y[m]")])
    exact = 1 * time_ - 0.5 * 9.81 * time_**2
    case.check(f"free flight on {ranks} ranks: way up [m]", y, exact, 1e-9 * abs(exact) + 1e-12)
    case.check(f"free flight on {ranks} ranks: way along x [m]", float(lines[-1][names.index("low_displacement_x[m]")]), 2 * time_, 1e-9)

# --- two conditions on one component ------------------------------------------------------------------------
conditions = [{"type": "fixed", "node_set": "ground"}, {"type": "velocity", "node_set": "left", "components": ["x"], "value": [1, 0, 0]}]
for ranks in (1, 2):
    attempt(f"fixed and velocity on one node, {ranks} ranks", 0, ["'ground'", "'left'", "prescribe the same component of 1 nodes", "node 1"],
            {"conditions": conditions, "time.end": 1e-6}, ranks)
_, output = attempt("fixed twice", 0, changes={"conditions": [conditions[0], {**conditions[0], "node_set": "left"}], "time.end": 1e-6})
case.check_equal("fixed twice is no contradiction", "prescribe the same" in output, False)

# --- names --------------------------------------------------------------------------------------------------
odd = 'a, "b" <c> & Mörtel\nsecond line'
names_recipe = {"dimension": 2, "parts": [{**box, "block": odd}, {**box, "block": "high", "min": [0, 1.0]}]}
folder, output = attempt("odd names", 0, recipe=names_recipe, changes={
    "blocks": {odd: {"material": "steel"}, "high": {"material": "steel"}}, "output": {"results": "x & y <z>.e"}, "time.end": 1e-6,
    "history": {"file": "run.csv", "tables": ["blocks", "pairs"], "probes": [{"name": odd, "block": odd}]}})
header, lines = history(folder)
case.check_equal("odd names: every line has the columns of the header", sorted({len(line) for line in lines}), [len(header)])
case.check_equal("odd names: a column has the name", odd + "_displacement_x[m]" in header, True)
_, lines = history(folder, "run_blocks.csv")
case.check_equal("odd names: the block of a table", sorted({line[2] for line in lines}), sorted([odd, "high"]))
index = xml.etree.ElementTree.parse(folder / "x & y <z>_planes.xmf3")
files = {item.text.split(":")[0] for item in index.iter("DataItem")}
case.check_equal("odd names: the file that the index of the planes names", [(name, (folder / name).exists()) for name in files], [("x & y <z>_planes.vtkhdf", True)])
case.check_equal("odd names: the record holds the deck", odd.split("\n")[0][:3] in json.loads((folder / "run.run.json").read_text())["deck"]["text"], True)
# A mesh whose names are Latin-1 is read as such; a deck is UTF-8.
folder, _ = attempt("Latin-1 in the mesh", 0, changes={"time.end": 1e-6})
with netCDF4.Dataset(folder / "mesh.e", "a") as file:
    file.set_auto_mask(False)
    file["eb_names"][0] = numpy.frombuffer(b"M\xf6rtel".ljust(file["eb_names"].shape[1], b"\0"), "S1")
text = documents.load(folder / "run.yaml")
text["blocks"] = {"Mörtel": {"material": "steel"}, "high": {"material": "steel"}}
documents.save(text, folder / "run.yaml")
code, output = program.run_program(["run.yaml"], folder, timeout=60)
case.check_equal("a name in Latin-1 is that of the deck in UTF-8", code, 0)
if code:
    print(output)
(folder / "run.yaml").write_bytes((folder / "run.yaml").read_text().encode("utf-8").decode("utf-8").encode("latin-1", "replace") + b"# M\xf6rtel\n")
code, output = program.run_program(["run.yaml"], folder, timeout=60)
case.check_equal("a deck in Latin-1", (code, "UTF-8" in output), (DECK, True))
strange = folder / os.fsdecode(b"M\xf6rtel.yaml")
documents.save(text, strange)
done = subprocess.run([program.binary("coplane"), b"M\xf6rtel.yaml", "--set", "checkpoint.at_end=true"], cwd=folder, stdout=subprocess.DEVNULL, timeout=60)
case.check_equal("a deck whose name is Latin-1 runs", done.returncode, 0)

# --- a table that is cut off while the run goes on ----------------------------------------------------------
folder, _ = attempt("a table is cut off", 0, changes={"time.end": 1e-6})
documents.save({"mesh": "mesh.e", **deck, "time": {"end": 10.0}}, folder / "run.yaml")
process = subprocess.Popen([program.binary("coplane"), "run.yaml", "--quiet"], cwd=folder)
deadline = time.monotonic() + 30
while (folder / "run.csv").stat().st_size < 5000 and time.monotonic() < deadline:
    time.sleep(0.02)
os.truncate(folder / "run.csv", 100)
while (folder / "run.csv").stat().st_size < 5000 and time.monotonic() < deadline:
    time.sleep(0.02)
process.kill()
process.wait()
case.check_equal("a table is cut off: bytes of zero", (folder / "run.csv").read_bytes().count(b"\0"), 0)

# --- what is left of an earlier run -------------------------------------------------------------------------
folder, _ = attempt("an earlier run", 0, changes={"output": {"every": 1e-5, "planes_format": "vtp"}, "time.end": 1e-4})
shutil.copy(folder / "run.run.json", folder / "run.run-s0002.json")
(folder / "run.run-s0003.json").write_text("{}")
shutil.copy(folder / "run.e", folder / "run.e-s0002")
(folder / "run.e-s0003").write_text("of the user")
shutil.copy(folder / "mesh.e", folder / "run.e-s0004")
(folder / "run.e-s0002.txt").write_text("of the user")
(folder / "run_planes_0099.vtp").write_text("of the user")
steps = len(list(folder.glob("run_planes_*.vtp")))
code, _ = program.run_program(["run.yaml", "--set", "time.end=1e-6"], folder, timeout=60)
case.check_equal("a new run takes away the steps that the series of the old one names",
                 sorted(path.name for path in folder.glob("run_planes_*.vtp")), ["run_planes_0000.vtp", "run_planes_0001.vtp", "run_planes_0099.vtp"])
for name in ("run.run-s0002.json", "run.e-s0002"):
    case.check_equal(f"a new run takes away {name} of an old one", [path.name for path in folder.glob(name + "*") if path.suffix != ".txt"], [])
for name, text in (("run.run-s0003.json", b"{}"), ("run.e-s0003", b"of the user"), ("run.e-s0004", (folder / "mesh.e").read_bytes())):
    case.check_equal(f"{name}, which is none of its own: put aside as it is", [path.read_bytes() == text for path in folder.glob(name + ".old-*")], [True])
case.check_equal("a file of the user with a similar name stays", (folder / "run.e-s0002.txt").exists(), True)

# --- a standard output that takes nothing -------------------------------------------------------------------
folder, _ = attempt("standard output", 0, changes={"time.end": 1e-5})
for options, code in ((["--schema"], OUTPUT), (["--help-deck"], OUTPUT), (["run.yaml", "--check"], OUTPUT), (["run.yaml"], 0)):
    with open("/dev/full", "w") as full:
        done = subprocess.run([program.binary("coplane"), *options], cwd=folder, stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
    case.check_equal(f"standard output to a full disk, {' '.join(options)}: exit code", done.returncode, code)
    case.check_equal(f"standard output to a full disk, {' '.join(options)}: a reason", "standard output" in done.stderr, code != 0)
for options in (["--help-recipe"], ["check", "mesh.e"]):
    with open("/dev/full", "w") as full:
        done = subprocess.run([program.binary("coplane_mesh"), *options], cwd=folder, stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
    case.check_equal(f"standard output to a full disk, coplane_mesh {options[0]}: exit code", done.returncode, OUTPUT)
    case.check_equal(f"standard output to a full disk, coplane_mesh {options[0]}: a reason", "standard output" in done.stderr, True)
for ranks in (1, 2):
    (folder / "run.csv").unlink()
    launch = [] if ranks == 1 else [os.environ.get("MPIEXEC", "mpirun"), "-np", "2", "--bind-to", "none"]
    reading, writing = os.pipe()
    os.close(reading)  # before the first line
    done = subprocess.run([*launch, program.binary("coplane"), "run.yaml"], cwd=folder, stdout=writing, stderr=subprocess.PIPE, timeout=60)
    os.close(writing)
    if ranks == 1:  # mpirun may die of it itself
        case.check_equal("nobody reads the log: exit code", done.returncode, 0)
    case.check_equal(f"nobody reads the log, {ranks} ranks: the run goes on to its end", float(history(folder)[1][-1][0]) >= 1e-5, True)
    case.check_equal(f"nobody reads the log, {ranks} ranks: no lock is left", list(folder.glob("*.lock")), [])

# --- a folder that goes away --------------------------------------------------------------------------------
folder = pathlib.Path("gone").resolve()
shutil.rmtree(folder, ignore_errors=True)
folder.mkdir()
mesh = pathlib.Path("fixed_step/mesh.e").resolve()
documents.save({"mesh": str(mesh), **deck}, folder / "run.yaml")
shutil.copy(folder / "run.yaml", "gone.yaml")
for ranks in (1, 2):
    folder.mkdir(exist_ok=True)
    for path in pathlib.Path().glob("inside.*"):
        path.unlink()
    launch = [] if ranks == 1 else [os.environ.get("MPIEXEC", "mpirun"), "-np", "2", "--bind-to", "none"]
    # The folder goes when all are inside.
    command = " ".join([*launch, "sh", "-c", f"'cd {folder} && : > {folder.parent}/inside.$$ && until [ $(ls {folder.parent}/inside.* | wc -l) = {ranks} ]; do sleep 0.01; done; "
                        f"until [ ! -d {folder} ]; do rmdir {folder} 2>/dev/null || rm -rf {folder}; done; "
                        f"exec {program.binary('coplane')} {pathlib.Path('gone.yaml').resolve()}'"])
    try:
        done = subprocess.run(command, shell=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
        case.check_equal(f"the folder is gone, {ranks} ranks: exit code", done.returncode, OUTPUT)
        if done.returncode != OUTPUT:
            print(done.stdout[-2000:])
    except subprocess.TimeoutExpired:
        case.check_equal(f"the folder is gone, {ranks} ranks: exit code", "no end", OUTPUT)

# --- limits of the process ------------------------------------------------------------------------------------
folder, _ = attempt("limits of the process", 0, options=["--check"])
before = sorted(path.name for path in folder.iterdir())
for limit, options, word in [("ulimit -n 16", "", "ulimit -n 64"), ("ulimit -v 300000", "--backend threads --threads 16", "threads")]:
    done = subprocess.run(["bash", "-c", f"{limit}; exec {program.binary('coplane')} run.yaml {options}"], cwd=folder,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
    case.check_equal(f"{limit}: code and cause", (done.returncode, word in done.stdout), (MACHINE, True))
case.check_equal("limits of the process: nothing was written", sorted(path.name for path in folder.iterdir()), before)
done = subprocess.run(["bash", "-c", f"ulimit -Sn 16; exec {program.binary('coplane')} run.yaml --set history.tables=[]"], cwd=folder, timeout=60)
case.check_equal("a soft limit of open files: is raised", done.returncode, 0)

# --- a mesh in HDF5 is probed -----------------------------------------------------------------------------------
folder = pathlib.Path("probed").resolve()
shutil.rmtree(folder, ignore_errors=True)
folder.mkdir()
documents.save({"mesh": "mesh.e", **deck}, folder / "run.yaml")
netCDF4.Dataset(folder / "mesh.e", "w", format="NETCDF4").close()
shutil.copy(program.binary("coplane"), folder)
prober = folder / "coplane_mesh"
damaged = "mesh.e: the file is damaged: the HDF5 library fails in it."
empty = "mesh.e: the file is not an Exodus II file"  # said by who reads it
unprobed = "WARNING: mesh.e: this HDF5 file is read without having been probed"
for name, script, words in [("that crashes", "kill -SEGV $$", damaged), ("that ends well", '[ "$*" = "probe mesh.e" ]', empty), ("that is not there", "", empty)]:
    if script:
        prober.write_text(f"#!/bin/sh\n{script}\n")
        prober.chmod(0o755)
    else:
        prober.unlink()
    for ranks in (1, 2):
        launch = [] if ranks == 1 else [os.environ.get("MPIEXEC", "mpirun"), "-np", "2", "--bind-to", "none"]
        done = subprocess.run([*launch, folder / "coplane", "run.yaml", "--check"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
        case.check_equal(f"a prober {name}, {ranks} ranks: code and cause", (done.returncode, words in done.stdout), (MESH, True))
        case.check_equal(f"a prober {name}, {ranks} ranks: warnings", done.stdout.count(unprobed), 0 if script else 1)
        if words not in done.stdout:
            print(done.stdout[-2000:])
case.finish()
