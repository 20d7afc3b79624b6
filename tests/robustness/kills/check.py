"""Killed with SIGKILL at random moments, inside the writing of results and checkpoints too: what was written before can be read,
the newest checkpoint restarts on any ranks, and in the end nothing shows that the run was ever killed.

Usage: check.py [number of kills]
"""

import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

import netCDF4
import numpy
from coplanetest import Case, documents, program, series_differences

from coplane.planes import Planes

numbers = [argument for argument in sys.argv[1:] if argument.isdigit()]
wanted = int(numbers[0]) if numbers else 16
case = Case("kills", __file__)
recipe, deck = case.load("tests/parallel/same_bits/mesh_2d.yaml"), case.load("tests/parallel/same_bits/deck.yaml")
deck["initial"] = [{"block": "bar", "velocity": [100, 20, 0]}]
end = 6e-4
deck["time"] = {"end": end}
deck["output"] = {"every": end / 60}  # so that kills fall into the writing now and then
deck["history"]["tables"] = ["blocks", "pairs"]
deck["checkpoint"] = {"every_cycles": 13}
NO_CHECKPOINT = 9
chance = random.Random(20260)

began = time.time()
straight = case.attempt("straight", recipe, {**deck, "checkpoint": {}})
duration = time.time() - began  # the mesh is made in it too: more than the run takes
if straight.code:
    sys.exit(straight.output)


def begin(folder, ranks, threads, backend, restart):
    """Starts a run whose ranks put down their process ids."""
    for old in folder.glob("pid.*"):
        old.unlink()
    told = ["sh", "-c", 'echo $$ > pid.${OMPI_COMM_WORLD_RANK:-0}; exec "$@"', "sh", program.binary("coplane"), "run.yaml",
            "--backend", backend, "--threads", str(threads)] + (["--restart"] if restart else [])
    if ranks > 1:
        told = [os.environ.get("MPIEXEC", "mpirun"), "-np", str(ranks), "--bind-to", "none"] + told
    output = open(folder / "output.txt", "a")
    return subprocess.Popen(told, cwd=folder, stdout=output, stderr=subprocess.STDOUT)


def kill(folder):
    for file in folder.glob("pid.*"):
        text = file.read_text().strip()
        if text:
            try:
                os.kill(int(text), signal.SIGKILL)
            except ProcessLookupError:
                pass


def drafts(folder):
    """Checkpoints that are being written, or were when the run was killed."""
    return list(folder.glob("run.chk.*.part-*"))


def wait_and_kill(folder, process, how):
    """Returns whether the run was killed; it may end before."""
    moment = time.time() + (chance.uniform(0.05, 0.8) * duration if how == "any" else 20)
    while time.time() < moment and process.poll() is None:
        if how == "checkpoint" and drafts(folder):
            time.sleep(chance.uniform(0, 0.002))
            break
        time.sleep(2e-4 if how == "checkpoint" else 2e-3)
    if process.poll() is not None:
        return False
    for _ in range(100):  # again and again: on a busy machine a rank may not have put down its process id yet
        kill(folder)
        try:
            return process.wait(timeout=0.1) != 0
        except subprocess.TimeoutExpired:
            pass
    process.kill()  # mpirun 4.1 now and then waits for ever for ranks that are dead (one in some hundred kills)
    process.wait()
    return True


def readable(folder, steps_before):
    """Every part of the results can be opened; finished steps are never lost. Returns what is wrong."""
    steps, wrong = 0, []
    for part in sorted(folder.glob("run.e*")):
        try:
            with netCDF4.Dataset(part) as file:
                times = file["time_whole"][:]
                steps += len(times)
                if len(times) and not (numpy.all(numpy.diff(times) > 0) and numpy.all(numpy.isfinite(file["vals_nod_var1"][-1]))):
                    wrong.append(f"{part.name}: times or values")
        except (OSError, IndexError) as error:
            # A file that was being created holds no step yet.
            if steps_before.get(part.name, 0) > 0:
                wrong.append(f"{part.name}: {error}")
    series = folder / "run_planes.vtkhdf"
    try:
        if series.exists() and not numpy.all(numpy.diff(Planes(series).times) > 0):
            wrong.append(f"{series.name}: times")
    except (OSError, ValueError, IndexError) as error:
        wrong.append(f"{series.name}: {error}")
    return wrong


def steps_of(folder):
    counts = {}
    for part in folder.glob("run.e*"):
        try:
            with netCDF4.Dataset(part) as file:
                counts[part.name] = len(file["time_whole"])
        except (OSError, IndexError):
            pass
    return counts


def new_folder(number):
    folder = pathlib.Path(f"killed_{number}").resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy(straight.path("mesh.e"), folder / "mesh.e")
    documents.save({"mesh": "mesh.e", **deck}, folder / "run.yaml")
    return folder


def compare(folder):
    records = sorted(folder.glob("run.run*.json"), key=lambda path: (len(path.name), path.name))
    hashes = [json.loads(path.read_text()).get("state_hash") for path in records]
    case.check_equal("state hash", hashes[-1], straight.state_hash)
    for name in ("run.csv", "run_blocks.csv", "run_pairs.csv"):
        case.check_equal(f"{name} differs", (folder / name).read_bytes() != straight.bytes_of(name), False)
    parts = [folder / "run.e"] + sorted(folder.glob("run.e-s*"))
    case.check_equal("results that differ", series_differences(straight.path("run.e"), [str(part) for part in parts]), [])
    names = straight.planes_files()
    case.check_equal("planes that differ", [n for n in names if (folder / n).read_bytes() != straight.bytes_of(n)], [])


kills = inside = restarts = runs = 0
damaged = []
while kills < wanted:
    folder = new_folder(runs)
    runs += 1
    while True:
        layout = chance.choice([(1, 1, "serial"), (1, 2, "threads"), (2, 1, "serial"), (3, 1, "threads")])
        restart = any(folder.glob("run.chk.[01]"))
        before = steps_of(folder)
        process = begin(folder, *layout, restart)
        if kills < wanted and wait_and_kill(folder, process, chance.choice(["any", "checkpoint"])):
            kills += 1
            inside += bool(drafts(folder))
            damaged += readable(folder, before)
            restarts += restart
            continue
        code = process.wait(timeout=300)
        if not case.check_equal("exit code of the part that was left alone", code, 0):
            sys.exit((folder / "output.txt").read_text()[-3000:])
        break
    compare(folder)
case.check_equal("what could not be read after a kill", damaged, [])
case.check_within("kills", kills, wanted, 10**6)
case.check_within("kills while a checkpoint was being written", inside, 1, kills)
case.check_within("restarts that were killed in their turn", restarts, 1, kills)
case.finish()
