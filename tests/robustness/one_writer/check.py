"""Two runs of one name, ranks that differ, fresh starts by mistake, leftovers of killed runs (README.md)."""

import ctypes
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

from coplanetest import Case, documents, program

case = Case("one_writer", __file__)
recipe, deck = case.load("tests/parallel/same_bits/mesh_2d.yaml"), case.load("tests/parallel/same_bits/deck.yaml")
deck["initial"] = [{"block": "bar", "velocity": [100, 20, 0]}]
deck["time"] = {"end": 1e-5}
deck["output"] = {"every": 5e-6}
deck["checkpoint"] = {"every_cycles": 10}
USAGE, DECK, MESH, OUTPUT, RESUMABLE, CHECKPOINT = 2, 3, 4, 5, 8, 9
documents.save({"title": "one writer", **recipe}, "mesh.yaml")
program.make_mesh("mesh.yaml", "mesh.e")


def folder_for(name, **sections):
    folder = pathlib.Path(name.replace(" ", "_")).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy("mesh.e", folder)
    documents.save({"mesh": "mesh.e", **deck, **sections}, folder / "run.yaml")
    return folder


def expect(name, found, output, code, words=()):
    good = case.check_equal(f"{name}: exit code", found, code)
    if not (case.check_equal(f"{name}: words missing", [word for word in words if word not in output], []) and good):
        print(output[-3000:])


def run(name, folder, code, words=(), options=(), ranks=1):
    try:
        found, output = program.run_program(["run.yaml", *options], folder, ranks, timeout=60)
    except subprocess.TimeoutExpired as error:
        found, output = "no end", str(error.stdout or "")
    expect(name, found, output, code, words)
    return output


# --- two at once --------------------------------------------------------------------------------------------
folder = folder_for("two at once", time={"end": 10.0})
with open(folder / "first.log", "w") as log:
    first = subprocess.Popen([program.binary("coplane"), "run.yaml"], cwd=folder, stdout=log, stderr=subprocess.STDOUT)
deadline = time.monotonic() + 60
while not ((folder / "run.csv").exists() and (folder / "run.csv").read_bytes().count(b"\n") > 3) and time.monotonic() < deadline:
    time.sleep(0.02)
words = ["another run", f"process {first.pid} on {socket.gethostname()}", "UTC"]
run("a second run", folder, OUTPUT, words)
run("a second run on two ranks", folder, OUTPUT, words, ranks=2)
run("a restart beside it", folder, OUTPUT, words, ["--restart"])
run("a check beside it", folder, 0, options=["--check"])
run("a run with one output in common", folder, OUTPUT, words, ["--set", "output.results=other.e", "--set", "checkpoint.file=other.chk"])
run("a run of other names in the same folder", folder, 0, (), ["--set", "output.results=other.e", "--set", "checkpoint.file=other.chk",
    "--set", "history.file=other.csv", "--set", "time.end=1e-7"])
for clash in ("history.file=run_planes.vtkhdf", "history.file=run_planes.xmf3", "output.results=run.csv"):
    only = ["output.results=other.e", "checkpoint.file=other.chk", "history.file=other.csv", clash]
    options = [word for key in only for word in ("--set", key)]
    run(f"a run of other names but for {clash}", folder, OUTPUT, words, [*options, "--set", "time.end=1e-7"])
(folder / "sub").mkdir()
os.symlink("../run.csv", folder / "sub/linked.csv")
os.link(folder / "run.csv", folder / "hard.csv")
for name in ("sub/linked.csv", "hard.csv"):
    run(f"the history of the first run as {name}", folder, OUTPUT, words,
        ["--set", "output.results=other.e", "--set", "checkpoint.file=other.chk", "--set", f"history.file={name}"])
first.send_signal(signal.SIGKILL)
first.wait()
case.check_equal("the killed run has left its lock", (folder / "run.lock").exists(), True)
run("a new run after the killed one", folder, 0, (), ["--set", "time.end=1e-7"], ranks=2)
case.check_equal("no lock is left", list(folder.glob("*.lock")), [])

# A first run through a link, and a second one where it leads to; two runs in two folders through two links.
folder = folder_for("through links", time={"end": 10.0})
for name in ("a", "b"):
    (folder / name).mkdir()
    shutil.copy(folder / "mesh.e", folder / name)
    shutil.copy(folder / "run.yaml", folder / name)
    os.symlink("../run.csv", folder / name / "run.csv")
first = subprocess.Popen([program.binary("coplane"), "run.yaml", "--quiet"], cwd=folder / "a")
while not ((folder / "run.csv").exists() and (folder / "run.csv").read_bytes().count(b"\n") > 3) and time.monotonic() < deadline + 60:
    time.sleep(0.02)
for name, place in (("where a link of the first leads", folder), ("through another link", folder / "b")):
    run(f"a second run {name}", place, OUTPUT, ["another run", f"process {first.pid} on"])
first.send_signal(signal.SIGKILL)
first.wait()
folder = folder_for("a file of the user")
run("a file of the user: the first run", folder, 0, options=["--set", "checkpoint.at_end=true"])
(folder / "user.csv").write_text("of the user\n")
run("a restart with the history in a file of the user", folder, 0, (), ["--restart", "--set", "time.end=1.4e-5", "--set", "history.file=user.csv"])
case.check_equal("a restart with the history in a file of the user: it is kept",
                 [path.read_text() for path in folder.glob("user.csv.old-*")], ["of the user\n"])
folder = folder_for("many at once")
many = []
for i in range(8):
    documents.save({"mesh": "mesh.e", **deck, "time": {"end": 1e-6}}, folder / f"run{i}.yaml")
(folder / "left.lock").write_text("process 1 on nowhere, since 2000-01-01 00:00:00 UTC\n")
for i in range(8):
    many.append(subprocess.Popen([program.binary("coplane"), f"run{i}.yaml", "--quiet"], cwd=folder))
case.check_equal("many runs at once, each with its names", [each.wait(timeout=120) for each in many], [0] * 8)

# --- fresh starts by mistake --------------------------------------------------------------------------------
folder = folder_for("fresh starts")
run("the good run", folder, 0, options=["--set", "checkpoint.at_end=true"])
good = {path.read_bytes() for path in folder.glob("run.chk.?")}
case.check_equal("the good run has two checkpoints", len(good), 2)
for start in range(3):
    output = run(f"mistake {start + 1}", folder, 0, (), ["--set", "time.end=1e-6", "--set", "checkpoint.at_end=true"], ranks=1 + start % 2)
    there = {path.read_bytes() for path in folder.glob("run.chk.*")}
    case.check_equal(f"mistake {start + 1}: checkpoints of the good run that are lost", len(good - there), 0)
case.check_equal("it is said how to get rid of them", "rm run.chk." in output, True)
aside = sorted((path for path in folder.glob("run.chk.*") if path.read_bytes() in good), key=lambda path: path.stat().st_mtime)
run("a restart from one that was put aside", folder, 0, (), ["--restart", aside[-1].name, "--set", "time.end=1.2e-5", "--set", "checkpoint.at_end=true"])
before = {path.name: path.read_bytes() for path in folder.iterdir()}
run("a restart that ends before its checkpoint", folder, DECK, ["time.end", "checkpoint"], ["--restart", "--set", "time.end=1e-7"])
case.check_equal("a restart that ends before its checkpoint: nothing is touched", {path.name: path.read_bytes() for path in folder.iterdir()} == before, True)
for path in folder.glob("run.chk.?"):
    path.unlink()
run("a restart without checkpoint names those of earlier runs", folder, CHECKPOINT, [aside[-1].name], ["--restart"])

# --- ranks that differ --------------------------------------------------------------------------------------
def two_commands(name, first, second, code, words, folder):
    launch = [os.environ.get("MPIEXEC", "mpirun"), "--bind-to", "none", "-np", "1", program.binary("coplane"), *first,
              ":", "-np", "1", program.binary("coplane"), *second]
    try:
        done = subprocess.run(launch, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
        expect(name, done.returncode, done.stdout, code, words)
        case.check_equal(f"{name}: nothing was written", sorted(path.name for path in folder.iterdir()), before)
        case.check_equal(f"{name}: it is said once", done.stdout.count("not started alike"), 1)
    except subprocess.TimeoutExpired:
        expect(name, "no end", "", code, words)


folder = folder_for("ranks that differ")
documents.save({"mesh": "mesh.e", **deck, "time": {"end": 2e-5}}, folder / "other.yaml")
(folder / "sub").mkdir()
before = sorted(path.name for path in folder.iterdir())
same = ["run.yaml"]
for name, second in [("another --set", [*same, "--set", "materials.steel.density=7800"]), ("another end", [*same, "--set", "time.end=3e-5"]),
                     ("--restart on one rank", [*same, "--restart"]), ("--check on one rank", [*same, "--check"]),
                     ("another deck", ["other.yaml"]), ("help on one rank", ["--help-codes"]),
                     ("an unknown option on one rank", [*same, "--wrong"])]:
    two_commands(name, same, second, USAGE, ["rank 0", "rank 1"], folder)
(folder / "sub/run.yaml").write_text((folder / "other.yaml").read_text().replace("mesh.e", "../mesh.e"))
launch = [os.environ.get("MPIEXEC", "mpirun"), "--bind-to", "none", "-np", "1", program.binary("coplane"), "run.yaml",
          ":", "-np", "1", "-wdir", str(folder / "sub"), program.binary("coplane"), "run.yaml"]
done = subprocess.run(launch, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
expect("one name, two decks", done.returncode, done.stdout, DECK, ["not started alike", "the deck"])
# Equal decks; meshes of one name and size that differ in one bit.
(folder / "sub/run.yaml").write_text((folder / "run.yaml").read_text())
spoilt = bytearray((folder / "mesh.e").read_bytes())
spoilt[-1] ^= 1
(folder / "sub/mesh.e").write_bytes(spoilt)
done = subprocess.run(launch, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
expect("two working folders", done.returncode, done.stdout, USAGE, ["not started alike", "the working folder"])
shutil.copy(folder / "mesh.e", folder / "sub/copy.e")
for name, code in (("sub/mesh.e", MESH), ("sub/copy.e", 0)):  # the same name on each rank leads to a file of its own
    seen = ["sh", "-c", 'exec 9< "$0"; exec "$@"']
    told = [program.binary("coplane"), "run.yaml", "--check", "--set", "mesh=/proc/self/fd/9"]
    two = [os.environ.get("MPIEXEC", "mpirun"), "--bind-to", "none", "-np", "1", *seen, "mesh.e", *told, ":", "-np", "1", *seen, name, *told]
    done = subprocess.run(two, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
    expect(f"each rank its mesh, {name}", done.returncode, done.stdout, code, ["not started alike", "SHA-256"] if code else [])
run("too many threads", folder, USAGE, ["--threads"], ["--threads", "5000"])
run("--max-wall nan", folder, USAGE, ["--max-wall"], ["--max-wall", "nan"])
run("--max-wall inf", folder, USAGE, ["--max-wall"], ["--max-wall", "inf"])

# --- a stale semaphore --------------------------------------------------------------------------------------
# sem_open("/OMPIO_run.e", O_CREAT, 0644, 0): what a killed run with MPI-IO leaves.
folder = folder_for("stale semaphores")
library = ctypes.CDLL(None, use_errno=True)
library.sem_open.restype = ctypes.c_void_p
library.sem_open.argtypes = [ctypes.c_char_p, ctypes.c_int, ctypes.c_uint, ctypes.c_uint]
library.sem_unlink.argtypes = [ctypes.c_char_p]
stale = [b"/OMPIO_" + name for name in (b"run.e", b"run.chk.0.part", b"run.chk.1.part", b"run.chk.0", b"run.chk.1", b"run.e-s0002", b"mesh.e")]
try:
    for ranks, options in ((1, []), (2, []), (2, ["--restart", "--set", "time.end=1.5e-5"])):
        for name in stale:  # anew for each run: a run that meets one may take its name away
            library.sem_unlink(name)
        made = [library.sem_open(name, os.O_CREAT, 0o644, 0) for name in stale]
        case.check_equal("the semaphores are there", all(made), True)
        run(f"stale semaphores, {'a restart' if options else 'a new run'} on {ranks} ranks", folder, 0, (), options, ranks)
finally:
    for name in stale:
        library.sem_unlink(name)

# --- a file that goes away while the run goes on ------------------------------------------------------------
folder = folder_for("history is removed", time={"end": 10.0}, checkpoint={"every_cycles": 50})
with open(folder / "run.log", "w") as log:
    process = subprocess.Popen([os.environ.get("MPIEXEC", "mpirun"), "-np", "2", "--bind-to", "none", program.binary("coplane"), "run.yaml"],
                               cwd=folder, stdout=log, stderr=subprocess.STDOUT)
deadline = time.monotonic() + 60
while not any(folder.glob("run.chk.?")) and time.monotonic() < deadline:
    time.sleep(0.05)
(folder / "run.csv").unlink()
(folder / "run.e").unlink()
words = "somebody has removed or moved the file"
while words not in (folder / "run.log").read_text() and time.monotonic() < deadline:
    time.sleep(0.1)
case.check_equal("history is removed: the run says so", words in (folder / "run.log").read_text(), True)
while "somebody removed the file" not in (folder / "run.log").read_text() and time.monotonic() < deadline:
    time.sleep(0.1)
case.check_equal("results are removed: the run says so", "run.e: somebody removed the file" in (folder / "run.log").read_text(), True)
case.check_equal("history is removed: the run goes on", process.poll(), None)
process.send_signal(signal.SIGUSR2)
try:
    case.check_equal("history is removed: the end that was asked for", process.wait(timeout=60), RESUMABLE)
except subprocess.TimeoutExpired:
    process.kill()
    case.check_equal("history is removed: the run ends", "no end", RESUMABLE)
case.check_equal("history is removed: a new one is there, with its header",
                 (folder / "run.csv").read_text().startswith("time[s],cycle") and (folder / "run.csv").read_text().count("time[s]") == 1, True)
run("history is removed: a restart goes on", folder, RESUMABLE, options=["--restart", "--set", "time.end=2"] + ["--max-wall", "1"])
# --- one rank needs no folder that all such runs would share ------------------------------------------------------
folder = folder_for("session")
(folder / "tmp").mkdir()
with subprocess.Popen([program.binary("coplane"), "run.yaml", "--set", "time.end=1"], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                      env={**os.environ, "TMPDIR": str(folder / "tmp")}) as process:
    deadline = time.monotonic() + 60
    while not ((folder / "run.csv").exists() and (folder / "run.csv").stat().st_size > 0) and time.monotonic() < deadline:
        time.sleep(0.02)
    case.check_equal("a run on one rank makes no session of Open MPI", (process.poll(), [path.name for path in (folder / "tmp").glob("ompi*")]), (None, []))
    process.kill()
case.finish()
