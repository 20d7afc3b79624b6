"""Restarts whose files are not as they left them, or are of another run: nothing is lost (README.md).

Usage: check.py [vtp]   planes in a file for each step in place of one
"""

import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import time

from coplanetest import Case, documents, program

from coplane.planes import Planes

case = Case("continued", __file__)
recipe, deck = case.load("tests/parallel/same_bits/mesh_2d.yaml"), case.load("tests/parallel/same_bits/deck.yaml")
deck["initial"] = [{"block": "bar", "velocity": [100, 20, 0]}]
deck["time"] = {"end": 1e-5}
FORMAT = "vtp" if "vtp" in sys.argv[1:] else "vtkhdf"
SERIES = {"vtkhdf": "run_planes.vtkhdf", "vtp": "run_planes.pvd"}[FORMAT]
deck["output"] = {"every": 2e-6, "planes_format": FORMAT}
deck["history"] = {"tables": ["blocks", "pairs"]}
deck["checkpoint"] = {"every_cycles": 10, "at_end": True}
DECK, OUTPUT, COMPUTATION = 3, 5, 6
documents.save({"title": "continued", **recipe}, "mesh.yaml")
program.make_mesh("mesh.yaml", "mesh.e")
aside = ".old-"


def run(name, folder, *options, code=0, words=(), deck_file="run.yaml", ranks=1):
    found, output = program.run_program([deck_file, *options], folder, ranks, timeout=60)
    good = case.check_equal(f"{name}: exit code", found, code)
    if not (case.check_equal(f"{name}: words missing", [word for word in words if word not in output], []) and good):
        print(output[-3000:])
    return output


def folder_for(name, started=True):
    folder = pathlib.Path(name.replace(" ", "_")).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy("mesh.e", folder)
    documents.save({"mesh": "mesh.e", **deck}, folder / "run.yaml")
    if started:
        run(f"{name}: the first part", folder)
    return folder


def on(end):
    return ["--restart", "--set", f"time.end={end!r}"]


def contents(folder, names):
    return {name: (folder / name).read_bytes() for name in names if (folder / name).is_file()}


def check_kept(name, folder, before):
    """Every file of before is there under its name, as its beginning, or as a file that was put aside."""
    now = {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    lost = [old for old, data in before.items()
            if not any(found == data for other, found in now.items() if other == old or other.startswith(old + aside))]
    case.check_equal(f"{name}: files that are lost", lost, [])


def steps_of_planes(folder):
    """So many are in the series now; 0 when there is none."""
    try:
        return len(Planes(folder / SERIES))
    except OSError:
        return 0


def columns(file):
    return {line.count(",") for line in file.read_text().splitlines()}


# --- a history that is not as it was -------------------------------------------------------------------------
changes = {
    "a line is missing": lambda data: b"\n".join(line for i, line in enumerate(data.split(b"\n")) if i != 5),
    "a name of a column is shorter": lambda data: data.replace(b"kinetic", b"kin", 1),
    "other ends of lines": lambda data: data.replace(b"\n", b"\r\n"),
    "a digit is another": lambda data: data[:-40] + (b"1" if data[-40:-39] != b"1" else b"2") + data[-39:],
}
for name, change in changes.items():
    folder = folder_for(name)
    for table in ("run.csv", "run_blocks.csv"):
        (folder / table).write_bytes(change((folder / table).read_bytes()))
    before = contents(folder, ["run.csv", "run_blocks.csv"])
    run(name, folder, *on(1.4e-5), words=["have been changed", "is kept under the name"])
    check_kept(name, folder, before)
    case.check_equal(f"{name}: columns of the new lines", len(columns(folder / "run.csv")), 1)

# --- outputs that one part does not write ----------------------------------------------------------------------
folder = folder_for("left out in the second part")
pairs, steps = (folder / "run_pairs.csv").read_bytes(), steps_of_planes(folder)
results = sorted(folder.glob("run_planes_*.vtp"))
before = contents(folder, [path.name for path in results])
run("a table and planes are left out", folder, *on(1.4e-5), "--set", "history.tables=[blocks]", "--set", "output.planes=false")
case.check_equal("left out: the table stays as it is", (folder / "run_pairs.csv").read_bytes() == pairs, True)
run("both are written again", folder, *on(1.8e-5))
case.check_equal("written again: the table goes on", (folder / "run_pairs.csv").read_bytes().startswith(pairs), True)
case.check_equal("written again: it has more", len((folder / "run_pairs.csv").read_bytes()) > len(pairs), True)
check_kept("written again: planes", folder, before)
case.check_equal("written again: the series has old steps and new ones", steps_of_planes(folder) > steps > 0, True)

# --- names of another run ---------------------------------------------------------------------------------------
def other_run(name):
    """A folder with a run, and another of other names and another speed."""
    folder = folder_for(name)
    shutil.copy(folder / "run.yaml", folder / "other.yaml")
    run(f"{name}: the other run", folder, "--set", "initial.0.velocity=[50,0,0]", deck_file="other.yaml")
    for part, end in ((2, 1.2e-5), (3, 1.4e-5)):
        run(f"{name}: the other run, part {part}", folder, *on(end), "--set", "initial.0.velocity=[50,0,0]", deck_file="other.yaml")
    return folder, contents(folder, [path.name for path in folder.glob("other*") if path.suffix != ".yaml"])


folder, before = other_run("the deck of the other with the checkpoint of the first")
run("the deck of the other with the checkpoint of the first", folder, "--restart", "run.chk.0", "--set", "time.end=1.4e-5", deck_file="other.yaml")
check_kept("the deck of the other with the checkpoint of the first", folder, before)
for key, value in (("checkpoint.file", "other.chk"), ("output.results", "other.e"), ("history.file", "other.csv")):
    folder, before = other_run(f"a restart with {key} of the other")
    run(f"a restart with {key} of the other", folder, "--restart", "run.chk.1", "--set", "time.end=1.4e-5", "--set", f"{key}={value}")
    check_kept(f"a restart with {key} of the other", folder, before)
    run(f"a restart with {key} of the other, again", folder, *on(1.8e-5), "--set", f"{key}={value}")
    check_kept(f"a restart with {key} of the other, again", folder, before)

# --- a part without steps of the planes, under the name of the other --------------------------------------------
folder, before = other_run("no step of the planes")
names = ["--set", "output.results=other.e"]
run("no step of the planes: at first", folder, "--restart", "run.chk.1", "--set", "time.end=1.2e-5", "--set", "output.every=1", "--set", "checkpoint.every_cycles=3", *names,
    "--max-wall", "0.001", code=8)
run("no step of the planes: then some", folder, *on(1.8e-5), *names)
check_kept("no step of the planes", folder, before)

# --- a history that had no line yet, names that change and change back, links ---------------------------------------
folder = folder_for("no line yet")
run("no line yet: another history", folder, *on(1.2e-5), "--set", "history.file=new.csv", "--set", "history.every=1")
run("no line yet: it goes on", folder, *on(1.6e-5), "--set", "history.file=new.csv", "--set", "history.every=1")
case.check_equal("no line yet: nothing is put aside", [path.name for path in folder.glob("new.csv" + aside + "*")], [])
folder = folder_for("a linked history")
(folder / "far").mkdir()
os.rename(folder / "run.csv", folder / "far" / "history.csv")
(folder / "run.csv").symlink_to("far/history.csv")
(folder / "far" / "history.csv").write_text("of the user\n")
run("a linked history", folder, *on(1.4e-5))
case.check_equal("a linked history: the link stays", (folder / "run.csv").is_symlink(), True)
case.check_equal("a linked history: what it led to is kept", [path.read_text() for path in (folder / "far").glob("history.csv" + aside + "*")], ["of the user\n"])
folder = folder_for("linked results", started=False)
(folder / "far").mkdir()
(folder / "run.e").symlink_to("far/real.e")
(folder / "far" / "real.e.part").write_text("of the user")
run("linked results", folder)
case.check_equal("linked results: a file of the user beside them is kept", [path.read_text() for path in (folder / "far").glob("real.e.part*")], ["of the user"])
case.check_equal("linked results: they are where the link leads", (folder / "far" / "real.e").exists(), True)
folder = folder_for("outputs called part", started=False)
names = ["--set", "output.results=wall.part", "--set", "history.file=h.part"]
run("outputs called part", folder, *names)
run("outputs called part: a restart", folder, *on(1.4e-5), *names)
case.check_equal("outputs called part: nothing is put aside", [path.name for path in folder.glob("*" + aside + "*")], [])

# --- an old checkpoint where a newer run has been ----------------------------------------------------------------
folder = folder_for("a checkpoint that was put aside")
run("a newer run", folder, "--set", "initial.0.velocity=[50,0,0]")
run("a newer run goes on", folder, *on(1.6e-5), "--set", "initial.0.velocity=[50,0,0]")
before = contents(folder, [path.name for path in folder.glob("run*") if path.suffix != ".yaml" and aside not in path.name])
old = max(folder.glob("run.chk.?" + aside + "*"), key=lambda path: path.stat().st_mtime).name
run("a restart of the older run", folder, "--restart", old, "--set", "time.end=1.4e-5", words=["is kept under the name"])
check_kept("a restart of the older run", folder, before)

# --- names of drafts and of what one derives ----------------------------------------------------------------------
# Drafts have names that no user gives: run.e.part-1f2e3d4c.
folder = folder_for("drafts of a user", started=False)
names = [name + ".part" for name in ("run.chk.0", "run.run.json", SERIES, "run_planes_0002.vtp", "run.e", "run.e-s0002", "run.run-s0003.json")]
for name in names:
    (folder / name).write_text("of the user: " + name)
(folder / "elsewhere").write_text("of somebody")
(folder / "run.chk.1.part").symlink_to("elsewhere")
(folder / "run.run.json").write_text('{"software": "of the user"}')
before = contents(folder, [*names, "elsewhere", "run.run.json"])
run("drafts of a user", folder, words=["is kept under the name"])
check_kept("drafts of a user", folder, before)
case.check_equal("drafts of a user: they have their names", sorted(path.name for path in folder.glob("*.part")), sorted([*names, "run.chk.1.part"]))
left = ["run.chk.0.part-00c0ffee", "run.e-s0007.part-00c0ffee"]
(folder / "run.lock").write_text(f"process 1 on {socket.gethostname()}, since 2026-11-22 00:00:00 UTC\n"
                                 f"a draft\t{folder / left[0]}\na draft\t{folder / 'run.e-s'}\t.part-00c0ffee\n")
for name in left:
    (folder / name).write_text("half of something")
(folder / "run_planes_0900.vtp.part-00000000").write_text("of the user, too")
before = contents(folder, [path.name for path in folder.iterdir() if path.name not in (*left, "run.lock")])
run("a run that is refused beside drafts", folder, "--set", "blocks.nobody.material=steel", code=DECK)
case.check_equal("a run that is refused beside drafts: nothing is touched", contents(folder, before) == before, True)
run("a draft of a killed run", folder)
case.check_equal("a draft of a killed run: it is not kept", [path.name for path in folder.iterdir() if path.is_file() and path.read_bytes() == b"half of something"], [])
check_kept("a draft of a user beside it", folder, {"run_planes_0900.vtp.part-00000000": b"of the user, too"})
case.check_equal("no draft is left", [path.name for path in folder.glob("*.part-*") if not path.name.endswith("-00000000")], [])

for name in ("run.e-s0002.2.1", "run.e-s0002"):
    folder = folder_for("the mesh is " + name, started=False)
    os.rename(folder / "mesh.e", folder / name)
    before = contents(folder, [name])
    run(f"the mesh is {name}", folder, "--set", f"mesh={name}", code=DECK, words=["the mesh (mesh)", name])
    check_kept(f"the mesh is {name}", folder, before)

# --- other spellings of a name, names that only look like parts, links ------------------------------------------------
folder = folder_for("other spellings")
before = contents(folder, [path.name for path in folder.glob("run*") if path.suffix in (".e", ".csv", ".pvd", ".vtkhdf")])
run("other spellings", folder, *on(1.4e-5), "--set", "output.results=./run.e", "--set", f"history.file={folder}/run.csv")
case.check_equal("other spellings: nothing is put aside", [path.name for path in folder.glob("*" + aside + "*")], [])
case.check_equal("other spellings: the history goes on", (folder / "run.csv").read_bytes().startswith(before["run.csv"]), True)
folder = folder_for("inputs like parts", started=False)
os.rename(folder / "mesh.e", folder / "run.e.2.0")
names = ["--set", "mesh=run.e.2.0", "--set", "checkpoint.file=run.e.3"]
run("inputs like parts", folder, *names)
before = contents(folder, ["run.e.2.0", "run.e.3.0", "run.e.3.1"])
run("inputs like parts: a restart", folder, *on(1.4e-5), *names)
case.check_equal("inputs like parts: they have their names", [name for name in before if not (folder / name).is_file()], [])
case.check_equal("inputs like parts: the mesh is as before", (folder / "run.e.2.0").read_bytes() == before["run.e.2.0"], True)
folder = folder_for("a history without a line", started=False)
names = ["--set", "history.file=notes.csv", "--set", "history.every=1", "--set", "history.tables=[]"]
run("a history without a line", folder, *names, "--max-wall", "0.001", code=8)
(folder / "notes.csv").write_text("notes of the user\n")
run("a history without a line: a restart", folder, *on(1.4e-5), *names)
check_kept("a history without a line", folder, {"notes.csv": b"notes of the user\n"})
folder = folder_for("linked checkpoints")
(folder / "far").mkdir()
for name in ("run.chk.0", "run.chk.1", SERIES):
    os.rename(folder / name, folder / "far" / name)
    (folder / name).symlink_to("far/" + name)
steps = steps_of_planes(folder)
run("linked checkpoints", folder, *on(1.8e-5))
case.check_equal("linked checkpoints: links stay", [(folder / name).is_symlink() for name in ("run.chk.0", "run.chk.1", SERIES)], [True] * 3)
case.check_equal("linked checkpoints: the series goes on", steps_of_planes(folder) > steps, True)
run("linked checkpoints: once more", folder, *on(2.2e-5))

# --- an editor, and somebody who moves the history away ------------------------------------------------------------------
folder = folder_for("an editor", started=False)
with open(folder / "run.log", "w") as log:
    process = subprocess.Popen([program.binary("coplane"), "run.yaml", "--set", "time.end=1"], cwd=folder, stdout=log, stderr=subprocess.STDOUT)
deadline = time.monotonic() + 60


def wait_until(condition):
    while not condition() and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.02)


def lines_of(name):
    return (folder / name).read_bytes().count(b"\n") if (folder / name).exists() else 0


wait_until(lambda: lines_of("run.csv") > 5)
shutil.copy(folder / "run.csv", folder / "edited")
os.replace(folder / "edited", folder / "run.csv")  # as editors do
there = lines_of("run.csv")
wait_until(lambda: lines_of("run.csv") > there + 5)
case.check_equal("an editor: lines go on in the file that has the name", lines_of("run.csv") > there + 5, True)
case.check_equal("an editor: the run says so", "somebody has replaced the file" in (folder / "run.log").read_text(), True)
os.rename(folder / "run.csv", folder / "moved.csv")
wait_until(lambda: lines_of("run.csv") > 5)
case.check_equal("moved away: a new history", (folder / "run.csv").read_text()[:13] if lines_of("run.csv") else "", "time[s],cycle")
os.remove(folder / "run.csv")
(folder / "run.csv").write_text("notes of the user\n")
wait_until(lambda: lines_of("run.csv") > 5)
(folder / "sub").mkdir()
for make in (lambda file: os.mkfifo(file), lambda file: file.symlink_to("sub"), lambda file: file.write_text("")):
    os.remove(folder / "run.csv")
    make(folder / "run.csv")
    wait_until(lambda: (folder / "run.csv").is_file() and not (folder / "run.csv").is_symlink() and lines_of("run.csv") > 5)
    case.check_equal("a pipe, a linked folder, an empty file: lines go on", lines_of("run.csv") > 5, True)
case.check_equal("a linked folder keeps its name", (folder / "sub").is_dir(), True)
kinds = [(path.is_fifo(), path.is_symlink(), path.is_file() and path.stat().st_size == 0) for path in folder.glob("run.csv.old-*")]
case.check_equal("a pipe, a linked folder, an empty file: are put aside", [any(kind[i] for kind in kinds) for i in range(3)], [True] * 3)
process.send_signal(signal.SIGUSR2)
case.check_equal("an editor: exit code", process.wait(timeout=60), 8)
check_kept("an editor", folder, {"run.csv": b"notes of the user\n"})
case.check_equal("an editor: there is a checkpoint", any((folder / f"run.chk.{slot}").exists() for slot in (0, 1)), True)

# --- results that somebody cuts off, a stop file that cannot be removed ---------------------------------------------
folder = folder_for("results are cut off", started=False)
with open(folder / "run.log", "w") as log:
    process = subprocess.Popen([program.binary("coplane"), "run.yaml", "--set", "time.end=1"], cwd=folder, stdout=log, stderr=subprocess.STDOUT)
deadline = time.monotonic() + 60
while steps_of_planes(folder) < 4 and time.monotonic() < deadline:
    time.sleep(0.02)
os.truncate(folder / "run.e", 20000)
while "somebody cut off the file" not in (folder / "run.log").read_text() and time.monotonic() < deadline:
    time.sleep(0.05)
case.check_equal("results are cut off: the run says so", "somebody cut off the file" in (folder / "run.log").read_text(), True)
(folder / "run.stop" / "within").mkdir(parents=True)
case.check_equal("a stop file that cannot be removed: exit code", process.wait(timeout=60), 8)
case.check_equal("a stop file that cannot be removed: the run says so", "stop file cannot be removed" in (folder / "run.log").read_text(), True)

# --- programs without streams, with small files, with numbers that are none ------------------------------------------
folder = folder_for("streams", started=False)
shutil.copy("mesh.yaml", folder)
documents.save({"joints": {"dry": {"model": "linear", "normal_stiffness": 1e10, "friction": 0.6}},
                "materials": {"steel": {"model": "linear_elastic", "density": 8000, "youngs_modulus": 2e11, "poisson_ratio": 0.3}},
                "joint_paths": {"one": {"type": "closing", "joint": "dry", "closures": [1e-4, 0]}},
                "material_paths": {"two": {"type": "uniaxial_strain", "material": "steel", "strains": [-1e-3, 0]}}}, folder / "point.yaml")
for command, code in (("coplane_mesh check missing.e 2>/dev/full", 4), ("coplane_mesh check missing.e 2>&-", 4), ("coplane_point missing.yaml 2>&-", DECK),
                      ("coplane_mesh make mesh.yaml -o q.e >&- 2>&-", OUTPUT), ("coplane --help-deck >&- <&-", OUTPUT), ("coplane run.yaml --check >&- <&-", OUTPUT),
                      ("coplane run.yaml >&- 2>&- <&-", 0), ("coplane --set time.end=1e-6 run.yaml", 0),
                      ("coplane_point point.yaml", 0), ("coplane_point point.yaml --set joint_paths.one.steps=5000", OUTPUT),
                      ("coplane_point point.yaml --set 'joint_paths.one.closures=[1e308, -1e308]'", COMPUTATION),
                      ("coplane_point point.yaml --set 'material_paths.two.strains=[1e200]'", COMPUTATION),
                      ("coplane run.yaml --set output.results=$(printf 'caf\\351.e')", DECK)):
    words = command.split(" ", 1)
    limit = "ulimit -f 4; " if "5000" in command else ""
    try:
        found = subprocess.run(["bash", "-c", f"{limit}{program.binary(words[0])} {words[1]}"], cwd=folder, capture_output=True, timeout=60).returncode
    except subprocess.TimeoutExpired:
        found = "no end"
    case.check_equal(f"{command}: exit code", found, code)
for path, values in (("material_paths.two", "strains=[1e200]"), ("joint_paths.one", "closures=[1e308, -1e308]")):
    said = subprocess.run([program.binary("coplane_point"), "point.yaml", "--set", f"{path}.{values}"], cwd=folder, capture_output=True, text=True, timeout=60).stderr
    case.check_equal(f"{path} that cannot be followed: file, line and path are named", bool(re.search(rf"point.yaml:\d+:\d+: {path}: ", said)), True)
long = subprocess.Popen([program.binary("coplane_point"), "point.yaml", "--set", "joint_paths.one.steps=100000000"], cwd=folder,
                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
deadline = time.monotonic() + 30
while not list(folder.glob("*.lock")) and time.monotonic() < deadline:
    time.sleep(0.01)
second = subprocess.run([program.binary("coplane_point"), "point.yaml"], cwd=folder, capture_output=True, text=True, timeout=60)
case.check_equal("two of coplane_point at once: exit code", second.returncode, OUTPUT)
case.check_equal("two of coplane_point at once: the first is named", f"process {long.pid} on" in second.stderr, True)
documents.save({"mesh": str(pathlib.Path("mesh.e").resolve()), **deck}, folder / "run.yaml")
run("a run that writes what coplane_point writes", folder, "--set", "history.file=point_one.csv", code=OUTPUT,
    words=[f"process {long.pid} on"])
long.kill()
long.wait()
case.finish()
