"""Valgrind's memcheck finds nothing in a run on two ranks that has every law with a memory, rebalances, writes everything and is
restarted on one rank and on three: no value that was never set, no byte outside what was allocated, nothing lost.

What Open MPI does inside MPI_Init and MPI_Finalize and in its own threads is not counted, nor what it has allocated inside a call and
lost (4.1 does so in every collective read of a file). Needs Debian's valgrind, and programs built
for a processor whose instructions it knows (no AVX-512).
"""

import glob
import os
import re
import shutil
import subprocess
import sys

from coplanetest import Case, program
from coplanetest.scenes import scene_of

case = Case("memcheck", __file__)
if not shutil.which("valgrind"):
    sys.exit("memcheck: no valgrind; install the Debian package valgrind")
recipe, deck, _, _ = scene_of(case, "everything")
deck["time"]["end"] = 2e-5
deck["output"]["every"] = 5e-6
deck["checkpoint"] = {"every_cycles": 13, "at_end": True}
deck["partition"] = {"rebalance": "always", "rebalance_every": 17}
suppressions = [f"--suppressions={path}" for path in glob.glob("/usr/share/openmpi/*valgrind.supp")]
memcheck = ["valgrind", "--leak-check=full", "--show-leak-kinds=definite", "--num-callers=40", "--log-file=memcheck.%p.log", *suppressions]
os.environ["OMP_NUM_THREADS"] = "1"


def errors(folder):
    """Reports of memcheck that are ours, and processes seen."""
    found, processes = [], 0
    for path in glob.glob(os.path.join(folder, "memcheck.*.log")):
        with open(path) as file:
            text = re.sub(r"(?m)^==\d+== ?", "", file.read())
        os.remove(path)
        processes += "ERROR SUMMARY" in text
        for report in re.split(r"\n\s*\n", text):
            stack = re.findall(r"(?m)^ +(?:at|by) 0x[0-9A-F]+: (.*)$", report)
            lost = "definitely lost" in report
            foreign = any("PMPI_Init" in line or "mpi_finalize" in line or (lost and "PMPI_" in line) for line in stack)
            if not foreign and any("coplane" in line for line in stack):
                found.append(report)
    return found, processes


def look(name, folder, ranks):
    found, processes = errors(folder)
    case.check_equal(f"{name}: processes that memcheck saw to their end", processes, ranks)
    case.check_equal(f"{name}: reports", len(found), 0)
    print("\n".join(found[:5]))


def part(name, folder, ranks, end):
    command = (["mpirun", "-np", str(ranks), "--bind-to", "none"] if ranks > 1 else []) + memcheck
    arguments = ["run.yaml", "--backend", "serial", "--restart", "--set", f"time.end={end}"]
    done = subprocess.run(command + [program.binary("coplane")] + arguments, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, timeout=3000)
    if not case.check_equal(f"{name}: exit code", done.returncode, 0):
        print(done.stdout)
    look(name, folder, ranks)


# The first part begins with a run without memcheck, of a few cycles, because it makes the mesh and the deck.
first = case.attempt("run", recipe, deck, 2, 1, "serial", ["--set", "time.end=1e-6"])
if first.code:
    sys.exit(first.output)
part("restarted on 2 ranks", first.folder, 2, 2e-5)
part("restarted on 1 rank", first.folder, 1, 2.3e-5)
part("restarted on 3 ranks", first.folder, 3, 2.6e-5)
sys.exit(case.finish())
