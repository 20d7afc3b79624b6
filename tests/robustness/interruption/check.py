"""SIGTERM ends a run in order, SIGUSR1 asks for results, and a killed rank ends the run and spoils no file."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import time

import numpy
from coplanetest import Case, Results, documents, program, tables

from coplane.planes import Planes

case = Case("interruption", __file__)
INTERRUPTED = 7


def children(parent):
    """Process ids: the parent's number is the second field behind the name in parentheses."""
    found = []
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            if int(stat.read_text().rpartition(")")[2].split()[1]) == parent:
                found.append(int(stat.parent.name))
        except OSError:  # it has just ended
            pass
    return found


def begin(name, ranks, every):
    """A run in a folder of its own; returns the folder and mpirun, or the program."""
    folder = pathlib.Path(name.replace(" ", "_")).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    documents.save({"title": case.name, **case.load("mesh.yaml")}, folder / "mesh.yaml")
    program.make_mesh(str(folder / "mesh.yaml"), str(folder / "mesh.e"))
    documents.save({"mesh": "mesh.e", **case.load(), "output": {"every": every}}, folder / "run.yaml")
    told = ["sh", "-c", 'echo $$ > pid.${OMPI_COMM_WORLD_RANK:-0}; exec "$@"', "sh", program.binary("coplane"), "run.yaml"]
    if ranks > 1:
        told = [os.environ.get("MPIEXEC", "mpirun"), "-np", str(ranks), "--bind-to", "none"] + told
    with open(folder / "output.txt", "w") as output:
        process = subprocess.Popen(told, cwd=folder, stdout=output, stderr=subprocess.STDOUT)
    return folder, process


def start(name, ranks, every):
    """The same when it has run for a while; returns the process ids of the ranks, too."""
    folder, process = begin(name, ranks, every)
    history = folder / "run.csv"
    deadline = time.time() + 60
    while time.time() < deadline and not (history.exists() and history.read_bytes().count(b"\n") > 200):
        time.sleep(0.02)
    pids = [int(path.read_text()) for path in sorted(folder.glob("pid.*"))]
    case.check(f"{name}: ranks", len(pids), ranks, 0)
    for pid in pids:  # nothing beside a rank that could outlive it
        case.check_equal(f"{name}: processes that a rank starts", children(pid), [])
    return folder, process, pids


def read(folder):
    """Times of the results, the last displacements, the last complete line of the history."""
    results = Results(str(folder / "run.e"))
    return results, float(tables.columns(folder / "run.csv")["time"][-1])


def ends(name, process):
    try:
        return process.wait(timeout=60)
    except subprocess.TimeoutExpired:
        process.kill()
        case.check_equal(f"{name}: ended by itself", False, True)
        return None


for ranks in (1, 3):
    name = f"SIGTERM on {ranks} ranks"
    folder, process, pids = start(name, ranks, 1.0)
    os.kill(pids[-1], signal.SIGTERM)  # one rank is told; all end
    case.check_equal(f"{name}: exit code", ends(name, process), INTERRUPTED)
    results, last = read(folder)
    # Results are due at 1 s only: the second step is the one that the signal wrote.
    case.check(f"{name}: steps", len(results.times), 2, 0)
    case.check(f"{name}: time of the last step [s]", results.times[-1], last, 0)
    record = json.loads((folder / "run.run.json").read_text())
    case.check_equal(f"{name}: ending in the record", record["ending"], "interrupted")

name = "SIGUSR1"
folder, process, pids = start(name, 2, 1.0)
os.kill(pids[0], signal.SIGUSR1)
time.sleep(1)
os.kill(pids[0], signal.SIGTERM)
case.check_equal(f"{name}: exit code", ends(name, process), INTERRUPTED)
case.check(f"{name}: steps", len(read(folder)[0].times), 3, 0)

# Requests that come while the libraries begin are done in the first cycle. The program holds them, or listens to them, as soon as SIGUSR2 is
# among its blocked or caught signals.
STOPPED = 8


def cares(pid):
    try:
        status = pathlib.Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return False
    masks = [int(line.split()[1], 16) for line in status.splitlines() if line.startswith(("SigBlk", "SigCgt"))]
    return any(mask >> (signal.SIGUSR2 - 1) & 1 for mask in masks)


for what, delays in (("signal", (0, 0.01, 0.03, 0.1)), ("file", (0.05, 0.2))):
    for delay in delays:
        name = f"a {what} {delay:g} s after the start"
        folder, process = begin(name, 1, 1.0)
        deadline = time.time() + 60
        lock = folder / "run.lock"
        while time.time() < deadline and not (cares(process.pid) if what == "signal" else lock.exists()):
            time.sleep(0.001)
        time.sleep(delay)
        process.send_signal(signal.SIGUSR2) if what == "signal" else (folder / "run.stop").touch()
        case.check_equal(f"{name}: exit code", ends(name, process), STOPPED)

# A killed rank: the others wait for it, and mpirun has to end them. Every step costs time, so that the kill falls
# into the writing now and then.
for attempt in range(3):
    name = f"killed rank {attempt}"
    folder, process, pids = start(name, 3, 2e-6)
    time.sleep(0.05 * attempt)
    os.kill(pids[attempt], signal.SIGKILL)
    code = ends(name, process)
    case.check_equal(f"{name}: mpirun ends with an error", code not in (0, None), True)
    results, last = read(folder)
    case.check_within(f"{name}: steps that can be read", len(results.times), 10, 1e9)
    case.check_equal(f"{name}: times grow", bool(numpy.all(numpy.diff(results.times) > 0)), True)
    finite = all(numpy.all(numpy.isfinite(results.nodal(f, -2))) for f in ("displacement", "velocity"))
    case.check_equal(f"{name}: values of the last whole step are numbers", finite, True)
    series = Planes(folder / "run_planes.vtkhdf")
    case.check_within(f"{name}: steps of the planes that can be read", len(series), 10, 1e9)
    case.check_equal(f"{name}: times of the planes grow", bool(numpy.all(numpy.diff(series.times) > 0)), True)
case.finish()
