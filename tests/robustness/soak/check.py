"""Random kills, signals, full disks and failing calls, restarts on changing ranks: in the end the bits of the straight run.

Usage: check.py [seconds]; COPLANE_FAULTS is the library of tests/robustness/injection.
"""

import collections
import contextlib
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import time

from coplanetest import Case, documents, program, series_differences

seconds = float(next((argument for argument in sys.argv[1:] if argument.isdigit()), 3600))
case = Case("soak", __file__)
recipe, deck = case.load("tests/parallel/same_bits/mesh_2d.yaml"), case.load("tests/parallel/same_bits/deck.yaml")
deck["initial"] = [{"block": "bar", "velocity": [100, 20, 0]}]
deck["time"] = {"end": 3e-4}
deck["output"] = {"every": 5e-6}
deck["history"]["tables"] = ["blocks", "pairs"]
deck["checkpoint"] = {"every_cycles": 17}
chance = random.Random(20261)
library = os.path.abspath(os.environ["COPLANE_FAULTS"])
patience = 60  # s that a run may write nothing

# How a start may end; what signals leave is told by the shell, by Python or by mpirun.
KILLED, STOPPED, TERMINATED = {-signal.SIGKILL, 128 + signal.SIGKILL}, {8, -signal.SIGUSR2, 128 + signal.SIGUSR2}, {7, -signal.SIGTERM, 128 + signal.SIGTERM}
accepted = {"kill": {0, "mpirun", *KILLED}, "kill one": {0, *KILLED}, "stop": {0, *STOPPED}, "terminate": {0, *TERMINATED}, "disk": {0, 5},
            "call": {0, 3, 4, 5, 9, 10}, "none": {0}}

straight = case.attempt("straight", recipe, {**deck, "checkpoint": {}})
if straight.code:
    sys.exit(straight.output)
log = open("soak.log", "w")
counts = collections.Counter()
bad = []


def say(text):
    log.write(f"{time.strftime('%H:%M:%S', time.gmtime())} {text}\n")
    log.flush()


def start(folder, ranks, restart, fault):
    tell = 'echo $$ > pid.${OMPI_COMM_WORLD_RANK:-0}; exec "$@"'
    if fault == "disk":
        tell = 'trap "" XFSZ; ' + tell
    command = ["sh", "-c", tell, "sh", program.binary("coplane"), "run.yaml", "--backend", "serial"] + (["--restart"] if restart else [])
    if fault == "call":
        kind, most = chance.choice([("write", 3000), ("sync", 200), ("rename", 60), ("close", 300), ("open", 300), ("memory", 200000), ("collective", 4000)])
        command = ["env", f"LD_PRELOAD={library}", f"FAULT_KIND={kind}", f"FAULT_RANK={chance.randrange(ranks)}",
                   f"FAULT_NTH={chance.randint(1, most)}", *command]
    if ranks > 1:
        command = [os.environ.get("MPIEXEC", "mpirun"), "-np", str(ranks), "--bind-to", "none", *command]
    for old in folder.glob("pid.*"):
        old.unlink()
    return subprocess.Popen(command, cwd=folder, stdout=open(folder / "output.txt", "w"), stderr=subprocess.STDOUT, start_new_session=True)


def send(folder, which, number):
    files = sorted(folder.glob("pid.*"))
    for file in files if which == "all" else chance.sample(files, min(1, len(files))):
        try:
            os.kill(int(file.read_text()), number)
        except (ValueError, ProcessLookupError):
            pass


def last_change(folder):
    """When something was written last."""
    times = [0.0]
    for file in folder.iterdir():
        with contextlib.suppress(FileNotFoundError):  # a draft that has got its name meanwhile
            times.append(file.stat().st_mtime)
    return max(times)


def fill_disk(folder, process):
    """From some moment on files may not grow beyond a size, as on a full disk: of all ranks, or of one. (Set from the start, it would keep
    Open MPI from starting.)
    """
    which, size, deadline = chance.choice(("all", "one")), chance.choice((20000, 150000, 300000)), time.monotonic() + 20
    begun = time.time() - 0.1
    while not ((folder / "run.lock").exists() and (folder / "run.lock").stat().st_mtime > begun) and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.02)
    files = sorted(folder.glob("pid.*"))
    for file in files if which == "all" else chance.sample(files, min(1, len(files))):
        with contextlib.suppress(ValueError, ProcessLookupError):
            resource.prlimit(int(file.read_text()), resource.RLIMIT_FSIZE, (size, size))


def one_start(folder, ranks, restart, fault):
    """Returns the exit code; None when the run did not end."""
    process = start(folder, ranks, restart, fault)
    if fault == "disk":
        fill_disk(folder, process)
    if fault in ("kill", "kill one", "stop", "terminate"):
        try:
            process.wait(timeout=chance.uniform(0.1, 2.5))
        except subprocess.TimeoutExpired:
            send(folder, "one" if fault == "kill one" else "all",
                 {"kill": signal.SIGKILL, "kill one": signal.SIGKILL, "stop": signal.SIGUSR2, "terminate": signal.SIGTERM}[fault])
    while True:
        try:
            code = process.wait(timeout=5)
            # mpirun 4.1 was seen to crash itself (PMIx_server_finalize) after all its ranks had been killed.
            return "mpirun" if code == -signal.SIGSEGV and fault == "kill" and ranks > 1 else code
        except subprocess.TimeoutExpired:
            if time.time() - last_change(folder) < patience:
                continue  # slow, not stuck
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        # mpirun 4.1 may wait for ever for ranks that are all dead: no fault of the program, whose files are whole.
        return "mpirun" if fault == "kill" and ranks > 1 else None


ends_at = time.monotonic() + seconds
number = 0
while time.monotonic() < ends_at:
    number += 1
    folder = pathlib.Path(f"life_{number}").resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy(straight.path("mesh.e"), folder)
    documents.save({"mesh": "mesh.e", **deck}, folder / "run.yaml")
    for part in range(1, 60):
        ranks = chance.choice((1, 2, 3))
        fault = chance.choice(("kill", "kill one", "stop", "terminate", "disk", "call", "none")) if part < 12 else "none"
        restart = any(folder.glob("run.chk.[01]"))
        code = one_start(folder, ranks, restart, fault)
        counts[fault, str(code)] += 1
        say(f"life {number}, part {part}, {ranks} ranks, {fault}: {code}")
        if code not in accepted[fault]:
            bad.append(f"life {number}, part {part}, {ranks} ranks, {fault}: {code}\n{(folder / 'output.txt').read_text(errors='replace')[-1500:]}")
            break
        if code == 0:
            break
    record = (sorted(folder.glob("run.run-s*.json")) or [folder / "run.run.json"])[-1]
    state = json.loads(record.read_text()).get("state_hash")
    parts = [str(folder / "run.e")] + sorted(str(path) for path in folder.glob("run.e-s*"))
    differences = [name for name in ("run.csv", "run_blocks.csv", "run_pairs.csv") if (folder / name).read_bytes() != straight.bytes_of(name)]
    differences += series_differences(straight.path("run.e"), parts)
    if state != straight.state_hash or differences:
        bad.append(f"life {number}: state {state}, different: {differences}")
    else:
        shutil.rmtree(folder)
say(f"{number} lives, {sum(counts.values())} starts: " + ", ".join(f"{fault} -> {code}: {count}" for (fault, code), count in sorted(counts.items())))
print(pathlib.Path("soak.log").read_text().splitlines()[-1])
for text in bad:
    print(text)
case.check_equal("lives that end wrongly", len(bad), 0)
case.check_within("lives", number, 1, float("inf"))

if seconds >= 600:
    memory = {}
    for cycles in (10000, 100000):
        run = case.attempt(f"cycles_{cycles}", recipe, {**deck, "checkpoint": {}, "output": {"results": "none"},
                                                       "time": {"end": cycles * 1e-8, "fixed_step": 1e-8}, "history": {"every": 1e-4}})
        case.check_equal(f"{cycles} cycles: exit code", run.code, 0)
        memory[cycles] = run.record["peak_memory_bytes"]["largest_rank"]
    case.check_within("memory after 1e5 cycles over that after 1e4", memory[100000] / memory[10000], 0.9, 1.02)
case.finish()
