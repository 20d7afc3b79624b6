"""Disks, files and numbers that fail around checkpoints and restarts: the right exit code, a message that says what to mend, and
nothing lost that was written before. The table in docs/user/faults.md tells of the same.
"""

import copy
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

import netCDF4
from coplanetest import Case, documents, program, series_differences

case = Case("faults", __file__)
recipe, deck = case.load("tests/parallel/same_bits/mesh_2d.yaml"), case.load("tests/parallel/same_bits/deck.yaml")
deck["initial"] = [{"block": "bar", "velocity": [100, 20, 0]}]
deck["time"] = {"end": 1e-4}
deck["output"] = {"every": 2e-5}
deck["checkpoint"] = {"every_cycles": 40}
# As docs/user/exit-codes.md has them.
DECK, OUTPUT, COMPUTATION, RESUMABLE, CHECKPOINT = 3, 5, 6, 8, 9

straight = case.attempt("straight", recipe, {**deck, "checkpoint": {}})
if straight.code:
    sys.exit(straight.output)


def folder_for(name, changes=None):
    folder = pathlib.Path(name.replace(" ", "_")).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy(straight.path("mesh.e"), folder / "mesh.e")
    write_deck(folder, changes)
    return folder


def write_deck(folder, changes=None):
    changed = copy.deepcopy(deck)
    for path, value in (changes or {}).items():
        place = changed
        *way, last = path.split(".")
        for key in way:
            place = place.setdefault(key, {})
        place[last] = value
    documents.save({"mesh": "mesh.e", **changed}, folder / "run.yaml")


def run(name, folder, code, texts=(), options=(), ranks=1, prefix=()):
    found, output = program.run_program(["run.yaml", *options], folder, ranks, prefix, timeout=120)
    good = case.check_equal(f"{name}: exit code", found, code)
    missing = [text for text in texts if text not in output]
    if not (case.check_equal(f"{name}: words missing in the output", missing, []) and good):
        print(output[-3000:])
    return output


def finish(name, folder, options=("--restart",), ranks=2, texts=()):
    """Restarts without the fault: the end is that of the straight run."""
    output = run(f"{name}, restarted", folder, 0, texts, options, ranks)
    records = sorted(folder.glob("run.run-s*.json"))
    state = json.loads(records[-1].read_text())["state_hash"] if records else "no record"
    case.check_equal(f"{name}, restarted: state hash", state, straight.state_hash)
    case.check_equal(f"{name}, restarted: history differs", (folder / "run.csv").read_bytes() != straight.bytes_of("run.csv"), False)
    parts = [str(folder / "run.e")] + sorted(str(part) for part in folder.glob("run.e-s*"))
    case.check_equal(f"{name}, restarted: results that differ", series_differences(straight.path("run.e"), parts), [])
    return output


def head(file):
    """Lines of the head of a checkpoint, by their first word."""
    return dict(line.split(" ", 1) for line in file.read_bytes()[:512].split(b"\0")[0].decode().splitlines() if " " in line)


def stopped(name, changes=None, ranks=1):
    """A run that was stopped with two checkpoints."""
    folder = folder_for(name, changes)
    run(f"{name}: first part", folder, 0, (), ["--set", "time.end=6e-5"], ranks)
    return folder


# --- ends that are asked for --------------------------------------------------------------------------
folder = folder_for("wall clock", {"time.end": 1.0})
run("wall clock", folder, RESUMABLE, ["checkpoint run.chk."], ["--max-wall", "1.5"])
folder = folder_for("stop file", {"time.end": 1.0})
process = subprocess.Popen([program.binary("coplane"), "run.yaml"], cwd=folder, stdout=subprocess.DEVNULL)
# A stop file from before the start would be removed as an old one.
while process.poll() is None and not ((folder / "run.csv").exists() and (folder / "run.csv").read_bytes().count(b"\n") > 3):
    time.sleep(0.02)
(folder / "run.stop").write_text("")
case.check_equal("stop file: exit code", process.wait(timeout=120), RESUMABLE)
case.check_equal("stop file: is removed", (folder / "run.stop").exists(), False)
case.check_equal("stop file: a checkpoint is there", any(folder.glob("run.chk.[01]")), True)
folder = folder_for("exact stop")
run("exact stop", folder, RESUMABLE, (), ["--max-wall", "0.001"])
finish("exact stop", folder)

# --- disks ----------------------------------------------------------------------------------------------
# A full disk, imitated by a limit on the size of files of 10 MB: MPI's own files must stay below it, so the checkpoint is made
# larger. Results are off, so that the checkpoint meets the limit first.
large = {"dimension": 2, "parts": [
    {"shape": "box", "block": "bricks", "min": [0, 0], "size": [1, 1], "divisions": [140, 140]},
    {"shape": "box", "block": "bar", "min": [1, 0], "size": [1, 1], "divisions": [120, 120]}]}
documents.save({"title": "large", **large}, "large.yaml")
program.make_mesh("large.yaml", "large.e")
limited = ["bash", "-c", 'trap "" XFSZ; ulimit -f 10240; exec "$@"', "bash"]
folder = folder_for("full disk for checkpoints")
shutil.copy("large.e", folder / "mesh.e")
small = {key: deck[key] for key in ("materials", "blocks")}
documents.save({"mesh": "mesh.e", **small, "time": {"end": 4e-6}, "output": {"results": "none"}, "checkpoint": {"every_cycles": 2}}, folder / "run.yaml")
run("full disk for checkpoints", folder, 0, ["cannot be written", "File too large", "run.chk."], prefix=limited)
case.check_equal("full disk for checkpoints: no draft is left", list(folder.glob("*.part*")), [])
run("full disk before an end that was asked for", folder, OUTPUT, ["File too large"], ["--max-wall", "0.001"], prefix=limited)

# A real one: a small file system, where that is allowed.
disk = pathlib.Path("disk").resolve()
disk.mkdir(exist_ok=True)
subprocess.run(["umount", str(disk)], stderr=subprocess.DEVNULL)
if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=3m", "tmpfs", str(disk)], stderr=subprocess.DEVNULL).returncode == 0:
    try:
        folder = folder_for("disk/full", {"output.every": 1e-6})
        run("small disk", folder, OUTPUT, ["No space left on device"])
        with netCDF4.Dataset(folder / "run.e") as file:
            case.check_within("small disk: steps that can be read", len(file["time_whole"]), 2, 100)
        larger = pathlib.Path("larger_disk").resolve()
        shutil.rmtree(larger, ignore_errors=True)
        shutil.copytree(folder, larger)
        run("small disk, restarted on a larger one", larger, 0, (), ["--restart"])
    finally:
        subprocess.run(["umount", str(disk)])
else:
    print("small disk: skipped, file systems cannot be mounted here")

def read_only(folder):
    run("read-only folder", folder, OUTPUT, [folder.name, "ermission denied" if os.geteuid() else "Read-only file system"])


if os.geteuid() != 0:
    folder = folder_for("read only")
    os.chmod(folder, 0o555)
    read_only(folder)
    os.chmod(folder, 0o755)
elif subprocess.run(["mount", "-t", "tmpfs", "tmpfs", str(disk)], stderr=subprocess.DEVNULL).returncode == 0:
    try:
        folder = folder_for("disk/read only")
        subprocess.run(["mount", "-o", "remount,ro", str(disk)], check=True)
        read_only(folder)
    finally:
        subprocess.run(["umount", str(disk)])
else:
    print("read-only folder: skipped, nothing is read-only for root where file systems cannot be mounted")

# One rank of three cannot write: all end together.
folder = folder_for("one rank", {"output.file_per_rank": True, "output.every": 1e-6})
one = 'trap "" XFSZ; [ "$OMPI_COMM_WORLD_RANK" = 1 ] && ulimit -f 400; exec "$@"'
command = [os.environ.get("MPIEXEC", "mpirun"), "-np", "3", "--bind-to", "none", "bash", "-c", one, "bash"]
run("one rank fails", folder, OUTPUT, ["rank 1"], prefix=command)

# --- files of the checkpoint --------------------------------------------------------------------------------
def newest(folder):
    return max(folder.glob("run.chk.[01]"), key=lambda file: int(head(file)["cycle"]))


def flip(data):
    place = len(data) * 2 // 3
    return data[:place] + bytes([data[place] ^ 4]) + data[place + 1 :]


damages = {"cut off": lambda data: data[: len(data) // 2], "a bit turned": flip, "empty": lambda data: b"",
           "foreign": lambda data: b"title: a deck\n" * 100}
for name, damage in damages.items():
    folder = stopped(name, ranks=2)
    file = newest(folder)
    whole = file.read_bytes()
    file.write_bytes(damage(whole))
    words = {"cut off": "bytes and should have", "a bit turned": "checksum", "empty": "not a checkpoint", "foreign": "not a checkpoint"}[name]
    run(f"{name}, named", folder, CHECKPOINT, [file.name, words], ["--restart", file.name], ranks=2)
    finish(name, folder, texts=[file.name, words])  # from the one before
folder = stopped("both damaged")
for file in folder.glob("run.chk.[01]"):
    file.write_bytes(flip(file.read_bytes()))
run("both damaged", folder, CHECKPOINT, ["run.chk.0", "run.chk.1", "checksum"], ["--restart"])
folder = folder_for("no checkpoint")
run("no checkpoint", folder, CHECKPOINT, ["run.chk.0", "No such file"], ["--restart"], ranks=2)

# --- a mesh or a deck that has changed ---------------------------------------------------------------------------
folder = stopped("changes")


def refused(name, words, changes=None):
    write_deck(folder, changes)
    run(name, folder, CHECKPOINT, ["is not that of the checkpoint", *words], ["--restart"], ranks=2)


refused("density changed", ["materials.steel.density was 7850 and is 7800 now"], {"materials.steel.density": 7800})
refused("pair changed", ["contact.pairs.0.declared was true and is false now"],
        {"contact.pairs": [{"blocks": ["bricks", "bricks"], "joint": "dry", "declared": False}]})
write_deck(folder)
shutil.copy(folder / "mesh.e", folder / "kept.e")
with netCDF4.Dataset(folder / "mesh.e", "a") as file:
    file["coordx"][3] += 1e-9
refused("coordinate changed", ["coordinates changed"])
shutil.copy(folder / "kept.e", folder / "mesh.e")
run("results in other intervals", folder, 0, (), ["--restart", "--set", "output.every=5e-6", "--set", "title=again"], ranks=2)
case.check_equal("results in other intervals: state hash",
                 json.loads((folder / "run.run-s0002.json").read_text())["state_hash"], straight.state_hash)

folder = stopped("step factor changed")
write_deck(folder, {"time.step_factor": 0.5})
run("step factor changed", folder, 0, ["time.step_factor is 0.5 now and was not there"], ["--restart"], ranks=2)

# --- files of the outputs that are gone -------------------------------------------------------------------------
folder = stopped("a file per rank", {"output.file_per_rank": True}, ranks=2)
(folder / "run.e.2.1").unlink()
(folder / "run.csv").unlink()
run("files that are gone", folder, 0, ["the file begins anew with the restart"], ["--restart"], ranks=3)
case.check_equal("files that are gone: the next part is there", len(list(folder.glob("run.e-s0002.3.*"))), 3)

# --- numbers --------------------------------------------------------------------------------------------------
folder = folder_for("energy", {"time.energy_tolerance": 1e-9, "checkpoint.every_cycles": 30})
run("energy balance", folder, COMPUTATION, ["the energy balance is off", "energy_tolerance"])
case.check_equal("energy balance: the last state is in the results", float(netCDF4.Dataset(folder / "run.e")["time_whole"][-1]) > 0, True)
finish("energy balance", folder, ["--restart", "--set", "time.energy_tolerance=0.1"])

folder = folder_for("not a number")
speed = {"type": "velocity", "node_set": "tip", "components": ["x"], "value": ["100*sqrt(6e-5 - t)", 0, 0]}
write_deck(folder, {"conditions": deck["conditions"] + [speed]})
output = run("not a number", folder, COMPUTATION, ["ERROR"], ranks=2)
case.check_equal("not a number: element is named", "element" in output, True)
case.check_equal("not a number: a checkpoint from before is there", any(folder.glob("run.chk.[01]")), True)
again = run("not a number, restarted", folder, COMPUTATION, ["ERROR"], ["--restart"])


def failure(text):
    """What is printed, whichever rank says it."""
    return sorted({re.sub(r"rank \d+: ", "", line) for line in text.splitlines() if line.startswith("ERROR")})


case.check_equal("not a number, restarted: fails in the same cycle", failure(again), failure(output))

# A point of the material that goes wrong: an element is crushed until its volume is negative.
folder = folder_for("crushed")
speed = {"type": "velocity", "node_set": "tip", "components": ["x"], "value": ["2e3", 0, 0]}
write_deck(folder, {"conditions": deck["conditions"] + [speed], "time.energy_tolerance": 1e9, "time.end": 1e-3, "time.fixed_step": 2e-7})
run("crushed element", folder, COMPUTATION, ["turned inside out", "block 'bar'"])
case.check_equal("crushed element: a checkpoint from before is there", any(folder.glob("run.chk.[01]")), True)
case.finish()
