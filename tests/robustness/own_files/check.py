"""No input is ever overwritten, and nothing is removed that was not written by the program itself."""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys

from coplanetest import Case, documents, program

case = Case("own_files", __file__)
recipe = {"dimension": 2, "parts": [{"shape": "box", "block": "bar", "min": [0, 0], "size": [1, 1], "divisions": [2, 2]}]}
deck = {"materials": {"steel": {"model": "linear_elastic", "density": 7800, "youngs_modulus": 200e9, "poisson_ratio": 0.3}},
        "blocks": {"bar": {"material": "steel"}}, "time": {"end": 1e-6}}
USAGE, DECK, MESH, OUTPUT = 2, 3, 4, 5
documents.save({"title": "own files", **recipe}, "mesh.yaml")
program.make_mesh("mesh.yaml", "good.e")


def folder_for(name, mesh="mesh.e", deck_name="run.yaml", **sections):
    folder = pathlib.Path(name.replace(" ", "_")).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy("good.e", folder / "mesh.e")
    documents.save({"mesh": mesh, **deck, **sections}, folder / deck_name)
    return folder


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def refused(name, folder, words, deck_name="run.yaml", ranks=1, code=DECK, options=()):
    before = contents(folder)
    found, output = program.run_program([deck_name, *options], folder, ranks, timeout=60)
    case.check_equal(f"{name}: exit code", found, code)
    case.check_equal(f"{name}: words missing", [word for word in words if word not in output], [])
    case.check_equal(f"{name}: the error is said once", output.count("ERROR"), 1)
    case.check_equal(f"{name}: every file is as before", contents(folder) == before, True)
    if found != code:
        print(output)


# --- results and mesh, in all shapes of a name ------------------------------------------------------------
folder = folder_for("the names of the manual", mesh="wall.e", deck_name="wall.yaml")
os.rename(folder / "mesh.e", folder / "wall.e")
for ranks in (1, 2):
    refused(f"deck wall.yaml with mesh wall.e, {ranks} ranks", folder, ["output.results", "the mesh (mesh)", "wall.e"], "wall.yaml", ranks)
refused("the same, checked only", folder, ["output.results", "the mesh (mesh)"], "wall.yaml", options=["--check"])
folder = folder_for("relative", output={"results": "./sub/../mesh.e"})
(folder / "sub").mkdir()
refused("./sub/../mesh.e", folder, ["mesh.e"])
folder = folder_for("hard link", output={"results": "other.e"})
os.link(folder / "mesh.e", folder / "other.e")
refused("hard link", folder, ["other.e", "mesh.e"])
folder = folder_for("symbolic link", output={"results": "other.e"})
os.symlink("mesh.e", folder / "other.e")
refused("symbolic link", folder, ["other.e", "mesh.e"])
folder = folder_for("linked folder", output={"results": "here/mesh.e"})
os.symlink(".", folder / "here")
refused("linked folder", folder, ["here/mesh.e", "mesh.e"])

# --- other outputs, deck, each other ----------------------------------------------------------------------
for name, sections, words in [
        ("history names the mesh", {"history": {"file": "mesh.e"}}, ["history.file", "the mesh"]),
        ("history names the deck", {"history": {"file": "run.yaml"}}, ["history.file", "the deck"]),
        ("results name the deck", {"output": {"results": "run.yaml"}}, ["output.results", "the deck"]),
        ("checkpoint and results", {"checkpoint": {"file": "run"}, "output": {"results": "run.0"}}, ["output.results", "checkpoint.file"]),
        ("history and results", {"history": {"file": "run.e"}}, ["history.file", "output.results"]),
        ("a table and the results", {"history": {"tables": ["blocks"]}, "output": {"results": "run_blocks.csv"}},
         ["history.tables", "output.results"]),
        ("planes and history", {"history": {"file": "run_planes.pvd"}, "contact": {"enabled": True}}, ["history.file", "output.planes"]),
        ("history is a device", {"history": {"file": "/dev/null"}}, ["/dev/null", "a device"]),
        ("results are a folder", {"output": {"results": "/tmp"}}, ["/tmp", "a folder"])]:
    refused(name, folder_for(name, **sections), words)
folder = folder_for("the mesh is a part of the series", mesh="run_planes_0002.vtp")
os.rename(folder / "mesh.e", folder / "run_planes_0002.vtp")
refused("the mesh is a part of the series", folder, ["output.planes", "the mesh"])

# --- parts of a mesh, files with the name of a lock, outputs that cannot be replaced ------------------------
folder = folder_for("parts of a mesh", mesh="wall.e")
code, output = program.run_program(
    ["run.yaml", "--set", "mesh=mesh.e", "--set", "output.file_per_rank=true", "--set", "output.results=wall.e"], folder, 2)
case.check_equal("parts of a mesh: made", (code, (folder / "wall.e.2.1").exists()), (0, True))
refused("the history is a part of the mesh", folder, ["wall.e.2.1", "a part of the mesh"], options=["--set", "history.file=wall.e.2.1"])
refused("the checkpoint is a part of the mesh", folder, ["a part of the mesh"], options=["--set", "checkpoint.file=wall.e.2"])
folder = folder_for("a file with the name of the lock")
(folder / "run.lock").write_text("precious")
refused("a file with the name of the lock", folder, ["run.lock"], code=OUTPUT)
(folder / "run.lock").unlink()
(folder / "list.txt").write_text("process 1 of my list")
os.link(folder / "list.txt", folder / "run.lock")
refused("a link with the name of the lock", folder, ["run.lock"], code=OUTPUT)
folder = folder_for("results that cannot be replaced", checkpoint={"every_cycles": 1})
case.check_equal("results that cannot be replaced: first run", program.run_program(["run.yaml"], folder)[0], 0)
os.remove(folder / "run.e")
shutil.copy("/bin/sleep", folder / "run.e")  # even root cannot write over a program that runs
with subprocess.Popen([folder / "run.e", "600"]) as running:
    for ranks in (1, 2):
        refused(f"results that cannot be replaced, {ranks} ranks", folder, ["run.e", "output.results", "busy"], ranks=ranks, code=OUTPUT)
    running.kill()
folder = folder_for("pipe")
os.remove(folder / "mesh.e")
os.mkfifo(folder / "mesh.e")
found, output = program.run_program(["run.yaml"], folder, 2, timeout=60)
case.check_equal("a pipe as mesh: exit code and word", (found, "a pipe" in output), (MESH, True))

# --- coplane_mesh and coplane_point -----------------------------------------------------------------------
def tool(name, program_name, arguments, folder, code):
    before = contents(folder)
    done = subprocess.run([program.binary(program_name), *arguments], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    case.check_equal(f"{name}: exit code", done.returncode, code)
    case.check_equal(f"{name}: both names are said", "same file" in done.stdout, True)
    case.check_equal(f"{name}: every file is as before", contents(folder) == before, True)


folder = folder_for("tools")
shutil.copy("mesh.yaml", folder / "r.yaml")
tool("make", "coplane_mesh", ["make", "r.yaml", "-o", "./r.yaml"], folder, USAGE)
tool("split", "coplane_mesh", ["split", "mesh.e", "r.yaml", "-o", "mesh.e"], folder, USAGE)
tool("convert", "coplane_mesh", ["convert", "mesh.e", "-o", "mesh.e"], folder, USAGE)
path = {"joints": {"dry": {"model": "mortar", "normal_stiffness": 8.2e10, "shear_stiffness": 3.6e10, "friction": 0.75, "cohesion": 0.35e6,
                           "tensile_strength": 0.25e6, "tension_energy": 18, "shear_energy": 125}},
        "joint_paths": {"test": {"joint": "dry", "type": "closing", "closures": [1e-4], "output": "point.yaml"}}}
documents.save(path, folder / "point.yaml")
tool("point", "coplane_point", ["point.yaml"], folder, DECK)

# --- run.py and main-job.sh -------------------------------------------------------------------------------
source = pathlib.Path(os.environ["COPLANE_SOURCE"])
specification = importlib.util.spec_from_file_location("run", source / "exodus_inputs/run.py")
run = importlib.util.module_from_spec(specification)
specification.loader.exec_module(run)
folder = pathlib.Path("a_users_folder").resolve()
shutil.rmtree(folder, ignore_errors=True)
folder.mkdir()
users = {name: f"of the user: {name}" for name in ("run_my_experiments.sh", "running_notes.txt", "run.txt")}
for name, text in users.items():
    (folder / name).write_text(text)
own = run.OwnFiles(folder)
own.claim(["mesh.yaml", "run.e", "run_planes.pvd"], False)
for name in ("mesh.yaml", "run.e"):
    (folder / name).write_text("ours")
(folder / "run_planes_0000.vtp").write_text("ours")
(folder / "run_planes_0001.vtp").write_text("of the user")
(folder / "run_planes.pvd").write_text('<DataSet timestep="0" part="0" file="run_planes_0000.vtp"/>')
own = run.OwnFiles(folder)  # a later start
own.claim(["mesh.yaml", "run.e"], False)
own.remove(keep=["mesh.yaml"])
case.check_equal("run.py removes what it wrote, and only that", sorted(path.name for path in folder.iterdir()),
                 sorted([*users, "mesh.yaml", "run_planes_0001.vtp", "written.json"]))
case.check_equal("files of the user are as before", {name: (folder / name).read_text() for name in users}, users)


def script(name, arguments, folder, words):
    before = contents(folder)
    done = subprocess.run([sys.executable, str(source / "exodus_inputs/run.py"), "rocking_block_2d", "--no-pictures", "--no-check",
                           "--output", str(folder), *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)
    case.check_equal(f"{name}: refuses", done.returncode != 0, True)
    case.check_equal(f"{name}: words missing", [word for word in words if word not in done.stdout], [])
    case.check_equal(f"{name}: every file is as before", contents(folder) == before, True)


folder = pathlib.Path("foreign").resolve()
shutil.rmtree(folder, ignore_errors=True)
folder.mkdir()
for name in ("mesh.yaml", "run.yaml", "run_my_experiments.sh"):
    (folder / name).write_text(f"of the user: {name}")
script("run.py in a folder with files of its names", [], folder, ["mesh.yaml", "run.yaml", "--overwrite"])
done = subprocess.run([str(source / "packages/cmake/main-job.sh"), "--folder"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
case.check_equal("main-job.sh --folder without a value", (done.returncode, "--folder lacks its value" in done.stdout), (2, True))
case.finish()
