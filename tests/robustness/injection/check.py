"""One call fails on one rank: the run ends with a code, or with the right bits; never does it wait for ever (README.md).

Usage: check.py [all|last [new|restart RANKS]]; COPLANE_FAULTS is the library of Faults.cpp.
"""

import bisect
import collections
import errno
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

from coplanetest import Case, documents, program

full = "all" in sys.argv[1:]
last = "last" in sys.argv[1:]  # only the last collective calls, from the last cycle to the end
if not full and not last:
    parts = [("new", 2), ("new", 3), ("restart", 2)]
elif len(sys.argv) == 4:
    parts = [(sys.argv[2], int(sys.argv[3]))]
else:
    parts = [(start, ranks) for start in ("new", "restart") for ranks in (1, 2, 3)]
case = Case("injection", __file__)
library = os.path.abspath(os.environ["COPLANE_FAULTS"])
patience, times = 60, 10  # a run may take so many seconds (on a machine that others use), and so many times the run without a fault on the same ranks
recipe, deck = case.load("tests/parallel/same_bits/mesh_2d.yaml"), case.load("tests/parallel/same_bits/deck.yaml")
deck["initial"] = [{"block": "bar", "velocity": [100, 20, 0]}]
deck["time"] = {"end": 5e-6 if sys.argv[1:3] == ["last", "new"] else 2e-5}
deck["output"] = {"every": 5e-6}
deck["history"]["tables"] = ["blocks", "pairs"]
deck["checkpoint"] = {"every_cycles": 12}
deck["partition"] = {"rebalance": "always", "rebalance_every": 10}
MACHINE = 10
# Codes that a fault may end with; 0: a run that survives has the right bits. A stream of the library takes a std::bad_alloc for an
# error of its file, so that a fault of memory may be told as one of the file that was being read or written.
accepted = {"memory": {0, 3, 4, 5, 9, MACHINE}, "collective": {MACHINE}, "open": {0, 3, 4, 5, 9}, "read": {0, 3, 4, 5, 9}, "write": {0, 5},
            "sync": {0, 5}, "reserve": {0, 5}, "rename": {0, 5}, "close": {0, 5}}
errors = {"open": ["EMFILE", "EIO"], "read": ["EIO"], "write": ["EIO", "ENOSPC"], "sync": ["EIO", "ENOSPC"], "reserve": ["ENOSPC", "EIO"], "rename": ["EIO", "ENOSPC"],
          "close": ["EIO", "ENOSPC"]}

documents.save({"title": "injection", **recipe}, "mesh.yaml")
program.make_mesh("mesh.yaml", "mesh.e")


def symbols():
    """Functions of the program by address, so that callers of collectives have names."""
    text = subprocess.run(["nm", "-C", "--defined-only", program.binary("coplane")], stdout=subprocess.PIPE, text=True, check=True).stdout
    pairs = sorted((int(line[:16], 16), line[19:]) for line in text.splitlines() if line[17:18] in "tTwW")
    return [address for address, _ in pairs], [name for _, name in pairs]


addresses, functions = symbols()


def stage(stack):
    """What the program was doing, from the addresses of its callers."""
    names = [functions[bisect.bisect_right(addresses, int(address, 16)) - 1] for address in stack.split() if not address.startswith("-")]
    for what, pattern in [("checkpoint", "Checkpoint"), ("output", "Observer|ResultsFile|RunRecord"), ("rebalance", "Rebalancer|repartition"),
                          ("restart", "restart|StateSource|restore"), ("search", "Search|findGhosts|pairUp|Solver::search"), ("cycle", "Solver::")]:
        if any(re.search(pattern, name) for name in names):
            return what
    return "start"


def prepare(name, restart):
    folder = pathlib.Path(name).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    if restart:
        shutil.copytree("first_part", folder)
    else:
        folder.mkdir()
        shutil.copy("mesh.e", folder)
    documents.save({"mesh": "mesh.e", **deck}, folder / "run.yaml")
    return folder


def run(folder, ranks, restart, faults, limit=300):
    """Exit code (None: it did not end), output, seconds."""
    command = [program.binary("coplane"), "run.yaml", "--backend", "serial"] + (["--restart"] if restart else [])
    environment = {"LD_PRELOAD": library, **faults}
    command = ["env", *[f"{name}={value}" for name, value in environment.items()], *command]
    if ranks > 1:
        command = [os.environ.get("MPIEXEC", "mpirun"), "-np", str(ranks), "--bind-to", "none", *command]
    begin = time.monotonic()
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", start_new_session=True)
    try:
        output, _ = process.communicate(timeout=limit)
        return process.returncode, output, time.monotonic() - begin
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        output, _ = process.communicate()
        return None, output, time.monotonic() - begin


def counted(ranks, restart):
    """Calls of each kind by rank, and the collective ones by what the program was doing."""
    folder = prepare("counted", restart)
    code, output, seconds = run(folder, ranks, restart, {"FAULT_LOG": str(folder)})
    if code:
        sys.exit(f"the run without a fault ends with {code}:\n{output}")
    calls, stages = [], []
    for rank in range(ranks):
        stacks, counts = [], {}
        for line in (folder / f"calls.{rank}").read_text().splitlines():
            if line[:1].isalpha() and " " in line and line.split()[0] in accepted:
                counts[line.split()[0]] = int(line.split()[1])
            else:
                stacks.append(stage(line))
        by_stage = collections.defaultdict(list)
        for number, name in enumerate(stacks, 1):
            by_stage[name].append(number)
        calls.append(counts)
        stages.append(by_stage)
    return calls, stages, ends(folder), patience + times * seconds


def ends(folder):
    records = sorted(folder.glob("run.run-s*.json")) or [folder / "run.run.json"]
    return json.loads(records[-1].read_text()).get("state_hash"), (folder / "run.csv").read_bytes()


def spread(count, of):
    """So many numbers from 1 to `of`, evenly, with both ends."""
    if of <= count:
        return list(range(1, of + 1))
    return sorted({1 + round(i * (of - 1) / max(1, count - 1)) for i in range(count)})


def points(ranks, restart, calls, stages):
    """(kind, rank, number, name of the error, what the program did)"""
    for rank in range(ranks):
        if last:
            many = calls[rank]["collective"]
            for number in range(max(1, many - 11), many + 1):
                name = next(name for name, numbers in stages[rank].items() if number in numbers)
                for _ in range(4):
                    yield "collective", rank, number, None, name
            continue
        for kind in accepted:
            if kind == "collective":
                for name, numbers in sorted(stages[rank].items()):
                    for place in spread(4 if full else 1, len(numbers)):
                        yield kind, rank, numbers[place - 1], None, name
                continue
            many = {"memory": 16, "write": 8, "read": 6, "open": 8}.get(kind, 4) if full or kind == "close" else 1
            chosen = spread(many, calls[rank].get(kind, 0))
            for position, number in enumerate(chosen if full or (restart and kind == "close") else chosen[-1:]):
                names = errors.get(kind, [None])
                yield kind, rank, number, names[position % len(names)], ""


folder = prepare("first_part", False)
done = program.run_program(["run.yaml", "--backend", "serial", "--set", f"time.end={1.95e-5 if last else 1.2e-5}", "--set", "checkpoint.at_end=true"], folder)
if done[0]:
    sys.exit(done[1])
mesh = pathlib.Path("mesh.e").read_bytes()
table = collections.Counter()
tried, unreached, slowest, slow, bad = 0, 0, 0, 0, []
pathlib.Path("points.txt").write_text("")
for start, ranks in parts:
    restart = start == "restart"
    calls, stages, whole, limit = counted(ranks, restart)
    for kind, rank, number, name, what in list(points(ranks, restart, calls, stages)):
        if not full and not last and (rank != ranks - 1 and kind in ("memory", "collective", "open", "read")):
            continue
        if not full and not last and restart and what not in ("", "restart", "rebalance"):
            continue
        folder = prepare("injected", restart)
        faults = {"FAULT_KIND": kind, "FAULT_RANK": rank, "FAULT_NTH": number}
        if name:
            faults["FAULT_ERRNO"] = getattr(errno, name)
        if name == "ENOSPC":
            faults["FAULT_LAST"] = 10**9  # stays full
        code, output, seconds = run(folder, ranks, restart, faults, limit)
        if code == 0 and "FAULT:" not in output:
            unreached += 1  # how often ranks talk and allocate depends on what they wait for
            continue
        with open("points.txt", "a") as file:
            file.write(f"{kind} {number} {name or ''} {what}, rank {rank} of {ranks}{', restart' if restart else ''}: {code} after {seconds:.1f} s\n")
        slow = max(slow, seconds / limit)
        tried += 1
        slowest = max(slowest, seconds)
        good = code in accepted[kind] and (folder / "mesh.e").read_bytes() == mesh
        if code == 0:
            good = good and ends(folder) == whole
        elif code is not None:
            good = good and "ERROR" in output and "a defect of the program" not in output
        table[kind, what, name, "restart" if restart else "new run", ranks, "hangs" if code is None else code] += 1
        if not good:
            bad.append(f"{kind} {number} {name or ''} {what} on rank {rank} of {ranks}{', restart' if restart else ''}: "
                       f"{'no end' if code is None else code}")
            print(bad[-1], "\n", output[-3000:], flush=True)
header = f"{tried} points ({unreached} more were not reached), slowest end {slowest:.1f} s\nkind        program was     error   run      ranks  code  points\n"
text = header + "".join(f"{kind:11} {what:15} {name or '':7} {start:8} {ranks:5} {code:>5} {count:6}\n"
                    for (kind, what, name, start, ranks, code), count in sorted(table.items(), key=str))
pathlib.Path("injections.txt").write_text(text)
print(text)
case.check_equal("points that end wrongly", bad, [])
case.check_within("points tried", tried, sum(45 * ranks for _, ranks in parts) if full else 30, float("inf"))  # 540 in all six parts
case.check_within("slowest end over what is allowed", slow, 0, 1)
case.finish()
