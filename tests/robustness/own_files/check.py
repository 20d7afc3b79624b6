"""No input is ever overwritten, and nothing is removed that was not written by the program itself.

Usage: check.py [vtp]   planes in a file for each step in place of one
"""

import fcntl
import importlib.util
import os
import pathlib
import resource
import shutil
import signal
import socket
import struct
import subprocess
import sys
import time

from coplanetest import Case, documents, program

case = Case("own_files", __file__)
recipe = {"dimension": 2, "parts": [{"shape": "box", "block": "bar", "min": [0, 0], "size": [1, 1], "divisions": [2, 2]}]}
deck = {"materials": {"steel": {"model": "linear_elastic", "density": 7800, "youngs_modulus": 200e9, "poisson_ratio": 0.3}},
        "blocks": {"bar": {"material": "steel"}}, "time": {"end": 1e-6}}
USAGE, DECK, MESH, OUTPUT = 2, 3, 4, 5
# The file that names all steps of the planes, another one of them, and one that a later step has.
FORMAT = "vtp" if "vtp" in sys.argv[1:] else "vtkhdf"
SERIES, OTHER, LATER = {"vtkhdf": ("run_planes.vtkhdf", "run_planes.xmf3", "run_planes.vtkhdf"),
                        "vtp": ("run_planes.pvd", "run_planes_0000.vtp", "run_planes_0001.vtp")}[FORMAT]  # fmt: skip
documents.save({"title": "own files", **recipe}, "mesh.yaml")
program.make_mesh("mesh.yaml", "good.e")


def folder_for(name, mesh="mesh.e", deck_name="run.yaml", **sections):
    folder = pathlib.Path(name.replace(" ", "_")).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy("good.e", folder / "mesh.e")
    sections["output"] = {"planes_format": FORMAT, **sections.get("output", {})}
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
        ("planes and history", {"history": {"file": SERIES}, "contact": {"enabled": True}}, ["history.file", "output.planes"]),
        ("history is a device", {"history": {"file": "/dev/null"}}, ["/dev/null", "a device"]),
        ("results are a folder", {"output": {"results": "/tmp"}}, ["/tmp", "a folder"])]:
    refused(name, folder_for(name, **sections), words)
folder = folder_for("the mesh is a part of the series", mesh=LATER)
os.rename(folder / "mesh.e", folder / LATER)
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

# --- a new start replaces what an earlier one wrote, and puts everything else aside -------------------------
OUTPUTS = ["run.csv", "run_blocks.csv", "run.e", "run.run.json", SERIES, OTHER]
everything = {"contact": {"enabled": True}, "history": {"tables": ["blocks"]}, "output": {"planes": True}}


def asides(folder):
    """Names before '.old-' of what was put aside, and what they hold."""
    return {path.name.split(".old-")[0]: path.read_text(errors="replace") for path in folder.glob("*.old-*")}


for ranks in (1, 2):
    folder = folder_for(f"files of the user, {ranks} ranks", **everything)
    notes = {name: f"precious: {name}" for name in [*OUTPUTS, "run_planes_0007.vtp", "run.e-s0002", "run.run-s0002.json"]}
    for name, text in notes.items():
        (folder / name).write_text(text)
    found, output = program.run_program(["run.yaml"], folder, ranks)
    case.check_equal(f"files of the user, {ranks} ranks: exit code", found, 0)
    there = {path.name: path.read_text(errors="replace") for path in folder.iterdir() if path.is_file()}
    kept = {name: text for name, text in {**asides(folder), **{n: t for n, t in there.items() if t == notes.get(n)}}.items() if name in notes}
    case.check_equal(f"files of the user, {ranks} ranks: all are kept", kept, notes)
    case.check_equal(f"files of the user, {ranks} ranks: the run's own are there",
                     [name for name in OUTPUTS if not (folder / name).is_file() or name in notes and there[name] == notes[name]], [])
    case.check_equal(f"files of the user, {ranks} ranks: names are said", "WARNING" in output and ".old-" in output, True)
    before = set(path.name for path in folder.iterdir())
    found, output = program.run_program(["run.yaml"], folder, ranks)
    case.check_equal(f"started again, {ranks} ranks: nothing is put aside", (found, sorted(set(path.name for path in folder.iterdir()) - before)), (0, []))
    case.check_equal(f"started again, {ranks} ranks: no word of it", ".old-" in output, False)
folder = folder_for("a mesh in the place of the results", output={"results": "other.e"})
shutil.copy("good.e", folder / "other.e")
found, output = program.run_program(["run.yaml"], folder)
aside = list(folder.glob("other.e.old-*"))
case.check_equal("a mesh in the place of the results is put aside", (found, [path.read_bytes() == pathlib.Path("good.e").read_bytes() for path in aside]),
                 (0, [True]))
folder = folder_for("a link in the place of the history")
(folder / "notes.csv").write_text("a,b\n1,2\n")
os.symlink("notes.csv", folder / "run.csv")
found, output = program.run_program(["run.yaml"], folder)
case.check_equal("what a link leads to is put aside", (found, list(asides(folder).items()), (folder / "run.csv").is_symlink()),
                 (0, [("notes.csv", "a,b\n1,2\n")], True))
folder = folder_for("line breaks in names", history={"file": "a\nb.csv"})
refused("a line break in the name of an output", folder, ["history.file", "a?b.csv", "line breaks"])

# --- under the names of a series, at the places of checkpoints, behind links and hard links ----------------------
def kept(name, folder, precious, options=(), code=0):
    """Runs once more; files that hold these texts are there afterwards, under whatever name."""
    found, output = program.run_program(["run.yaml", *options], folder, timeout=60)
    case.check_equal(f"{name}: exit code", found, code)
    texts = [path.read_text(errors="replace") for path in folder.rglob("*") if path.is_file()]
    case.check_equal(f"{name}: texts that are gone", [text for text in precious if text not in texts], [])
    if found != code:
        print(output)
    return output


folder = folder_for("a step of the series is of the user", **everything)
kept("a first run", folder, [])
(folder / LATER).write_text("precious step")
kept("a step of the series is of the user", folder, ["precious step"])
folder = folder_for("checkpoints at a restart", checkpoint={"every_cycles": 1, "at_end": True})
kept("checkpoints at a restart: first run", folder, [], ["--set", "time.end=3e-4"])
case.check_equal("checkpoints at a restart: both are there", [(folder / f"run.chk.{slot}").exists() for slot in (0, 1)], [True, True])
newest = max((folder / "run.chk.0", folder / "run.chk.1"), key=lambda path: path.stat().st_mtime_ns)
other = folder / ("run.chk.1" if newest.name.endswith("0") else "run.chk.0")
other.write_text("precious checkpoint")
kept("a text at the place of the other checkpoint", folder, ["precious checkpoint"], ["--restart", newest.name, "--set", "time.end=6e-4"])
case.check_equal("a text at the place of the other checkpoint is put aside, once", len(list(folder.glob("run.chk.*.old-*"))), 1)
newest = max((folder / "run.chk.0", folder / "run.chk.1"), key=lambda path: path.stat().st_mtime_ns)
kept("a restart with both of its own", folder, [], ["--restart", newest.name, "--set", "time.end=9e-4"])
case.check_equal("a restart with both of its own puts nothing aside", len(list(folder.glob("run.chk.*.old-*"))), 1)
folder = folder_for("hard links", **everything)
kept("hard links: first run", folder, [])
copy = folder / "copy"
copy.mkdir()
for path in folder.glob("run*.csv"):
    os.link(path, copy / path.name)
before = contents(copy)
kept("hard links", folder, [], ["--set", "time.end=2e-4"])
case.check_equal("hard links: the copies are as before", contents(copy) == before, True)
folder = folder_for("a copy of a folder in which a run was killed")
(folder / "run.chk.0.part-00c0ffee").write_text("of the killed run")
(folder / "run.lock").write_text(f"process 1 on {socket.gethostname()}, since 2026-11-22 00:00:00 UTC\na draft\t{folder / 'run.chk.0.part-00c0ffee'}\n")
copied = pathlib.Path("a copy").resolve()
shutil.rmtree(copied, ignore_errors=True)
shutil.copytree(folder, copied)
before = contents(folder)
kept("a copy of a folder in which a run was killed", copied, [])
case.check_equal("a copy of a folder: drafts of the original are as before", contents(folder) == before, True)
case.check_equal("a copy of a folder: its own are removed", [path.name for path in copied.glob("*.part-*")], [])
os.link(folder / "run.lock", folder / "kept.txt")
kept("a lock with a second link", folder, [])
case.check_equal("a lock with a second link: drafts are removed", [path.name for path in folder.glob("*.part-*")], [])
folder = folder_for("what is put aside is said")
notes = {name: f"precious {name}" for name in ("run.csv", "run.e", "run.run.json", SERIES, "run.chk.0", "run.chk.1", "run.e-s0002")}
for name, text in notes.items():
    (folder / name).write_text(text)
output = kept("what is put aside is said", folder, list(notes.values()), ["--quiet"])
case.check_equal("what is put aside is said: names that are not", [name for name in notes if f"{name}.old-" not in output], [])
folder = folder_for("a stop file with text")
(folder / "run.stop").write_text("precious: when to stop")
kept("a stop file with text", folder, ["precious: when to stop"])
folder = folder_for("my run", deck_name="my run.yaml", checkpoint={"every_cycles": 1, "at_end": True})
for _ in range(2):
    found, output = program.run_program(["my run.yaml", "--set", "time.end=3e-4"], folder, timeout=60)
removal = next((line.split("when none is wanted any more: ")[1] for line in output.splitlines() if "rm " in line), "false")
case.check_equal("words for the shell: they remove what they name", subprocess.run(["bash", "-c", removal], cwd=folder).returncode, 0)
case.check_equal("words for the shell: the old checkpoints are gone", list(folder.glob("*.chk.*.old-*")), [])
folder = folder_for("long names", output={"results": "r" * 240 + ".e"})
refused("a name that is too long", folder, ["output.results", "too long"])
folder = folder_for("split mesh", mesh="wall.e", output={"results": "wall.e"})
os.rename(folder / "mesh.e", folder / "wall.e.1.0")
refused("results with the name of a mesh in parts", folder, ["output.results", "the mesh (mesh)"])
folder = folder_for("while it runs", checkpoint={"every_seconds": 0.2}, output={"every": 1e-3}, time={"end": 100.0})
with open(folder / "run.log", "w") as log:
    process = subprocess.Popen([program.binary("coplane"), "run.yaml"], cwd=folder, stdout=log, stderr=subprocess.STDOUT)
names = ("run.run.json", SERIES, "run.chk.0", "run.chk.1")
deadline = time.monotonic() + 60
while not all((folder / name).exists() for name in names) and process.poll() is None and time.monotonic() < deadline:
    time.sleep(0.02)
for name in names:
    (folder / "new").write_text(f"precious {name}, made while it runs")
    os.replace(folder / "new", folder / name)
while not all(list(folder.glob(name + ".old-*")) for name in names[1:]) and process.poll() is None and time.monotonic() < deadline:
    time.sleep(0.02)
process.send_signal(signal.SIGUSR2)
case.check_equal("while it runs: exit code", process.wait(timeout=60), 8)
texts = [path.read_text(errors="replace") for path in folder.iterdir() if path.is_file()]
case.check_equal("while it runs: texts that are gone", [name for name in names if f"precious {name}, made while it runs" not in texts], [])
folder = folder_for("links", **everything)
(folder / "far").mkdir()
for name in ("run.run.json", SERIES, "run.e-s0002"):
    (folder / "far" / name).write_text(f"precious {name}")
    os.symlink("far/" + name, folder / name)
before = contents(folder / "far")
kept("links", folder, list(f"precious {name}" for name in ("run.run.json", SERIES, "run.e-s0002")))
case.check_equal("links: what they lead to is as before", contents(folder / "far") == before, True)
case.check_equal("links: they are put aside", sorted(path.name.split(".old-")[0] for path in folder.iterdir() if path.is_symlink()),
                 ["run.e-s0002", "run.run.json", SERIES])
folder = folder_for("pipes and links that lead nowhere", **everything)
kept("pipes: a first run", folder, [])
os.mkfifo(folder / "run.e-s0002")
if FORMAT == "vtp":  # a pipe in the place of the index is refused, as those in the places of all single files are
    os.remove(folder / OTHER)
    os.mkfifo(folder / OTHER)
os.remove(folder / "run.run.json")
os.symlink("nowhere", folder / "run.e-s0003")
os.symlink("nowhere", folder / "run.run.json")
kept("pipes and links that lead nowhere", folder, [])
case.check_equal("pipes and links that lead nowhere are put aside",
                 sorted(path.name.split(".old-")[0] for path in folder.iterdir() if path.is_symlink() or path.is_fifo()),
                 ["run.e-s0002", "run.e-s0003", "run.run.json"] + ([OTHER] if FORMAT == "vtp" else []))
folder = folder_for("a large file", **everything)
with open(folder / SERIES, "w") as file:
    file.truncate(20 << 30)
case.check_equal("a large file in the place of the series", program.run_program(["run.yaml"], folder, timeout=60)[0], 0)
aside = list(folder.glob(SERIES + ".old-*"))
case.check_equal("a large file in the place of the series is put aside", [path.stat().st_size for path in aside], [20 << 30])
for path in aside:
    path.unlink()


def make_immutable(path, immutable):
    """What `chattr +i` does, which a bare machine may not have."""
    get_flags, set_flags, flag = 0x80086601, 0x40086602, 0x10  # FS_IOC_GETFLAGS, FS_IOC_SETFLAGS, FS_IMMUTABLE_FL
    with open(path, "rb") as file:
        flags = struct.unpack("i", fcntl.ioctl(file, get_flags, struct.pack("i", 0)))[0]
        fcntl.ioctl(file, set_flags, struct.pack("i", flags | flag if immutable else flags & ~flag))


for name in ("run.run.json", SERIES, OTHER if FORMAT == "vtkhdf" else LATER):
    folder = folder_for("immutable", **everything)
    kept("immutable: first run", folder, [])
    try:
        make_immutable(folder / name, True)
    except OSError as error:  # needs root, and a file system that knows it
        print(f"no file can be made immutable here: {error}")
        break
    refused(f"immutable {name}", folder, [name, "Operation not permitted"], code=OUTPUT)
    make_immutable(folder / name, False)

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
os.rename(folder / "mesh.e", folder / "wall.e.1.0")
tool("split onto a part of the mesh", "coplane_mesh", ["split", "wall.e", "r.yaml", "-o", "wall.e.1.0"], folder, USAGE)
os.rename(folder / "wall.e.1.0", folder / "mesh.e")
path = {"joints": {"dry": {"model": "mortar", "normal_stiffness": 8.2e10, "shear_stiffness": 3.6e10, "friction": 0.75, "cohesion": 0.35e6,
                           "tensile_strength": 0.25e6, "tension_energy": 18, "shear_energy": 125}},
        "joint_paths": {"test": {"joint": "dry", "type": "closing", "closures": [1e-4], "output": "point.yaml"}}}
documents.save(path, folder / "point.yaml")
tool("point", "coplane_point", ["point.yaml"], folder, DECK)

# --- the tools, too: what they wrote before is replaced, the rest put aside, and a full disk loses nothing ---
def made(name, program_name, arguments, output_name, kept, code=0, limit=None):
    limits = (lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))) if limit else None
    before = contents(folder)
    done = subprocess.run([program.binary(program_name), *arguments], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          preexec_fn=limits)
    case.check_equal(f"{name}: exit code", done.returncode, code)
    case.check_equal(f"{name}: what is put aside", sorted(path.read_text() for path in folder.glob(output_name + "*.old-*")), kept)
    if code != 0:
        case.check_equal(f"{name}: every file is as before", contents(folder) == before, True)
    return done.stdout


folder = folder_for("replaced by tools")
shutil.copy("mesh.yaml", folder / "r.yaml")
path["joint_paths"]["test"]["output"] = "p.csv"
path["material_paths"] = {"squeeze": {"material": "steel", "type": "uniaxial_stress", "strains": [1e-3], "steps": 100, "output": "m.csv"}}
path["materials"] = deck["materials"]
documents.save(path, folder / "point.yaml")
for name in ("new.e", "p.csv", "m.csv"):
    (folder / name).write_text(f"precious: {name}")
for again in ("", ", again"):
    made(f"make{again}", "coplane_mesh", ["make", "r.yaml", "-o", "new.e"], "new.e", ["precious: new.e"])
    made(f"joint path{again}", "coplane_point", ["point.yaml"], "p.csv", ["precious: p.csv"])
    made(f"material path{again}", "coplane_point", ["point.yaml"], "m.csv", ["precious: m.csv"])
output = made("a path on a full disk", "coplane_point", ["point.yaml"], "q.csv", [], OUTPUT, 1000)
case.check_equal("a path on a full disk: the system's words", "File too large" in output, True)
made("a mesh on a full disk", "coplane_mesh", ["make", "r.yaml", "-o", "new.e"], "q.e", [], OUTPUT, 1000)

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
