"""V59, V60: one run, bit for bit, on any number of ranks and threads and on either back end.

Usage: check.py 2d|3d|tiny [all] [common_normal]
"""

import itertools
import sys

from coplanetest import Case, differences

dimension, full = sys.argv[1], "all" in sys.argv[2:]
case = Case(f"V59 V60 {dimension}", __file__)
recipe, deck = case.load(f"mesh_{dimension}.yaml"), case.load()
velocity, end = {"2d": ([100, 20, 0], 1.2e-4), "3d": ([5, -40, 90], 5e-4), "tiny": ([20, 5, 0], 5e-4)}[dimension]
deck["initial"] = [{"block": "bar", "velocity": velocity}]
deck["time"] = {"end": end}
deck["output"] = {"every": end / 4}

if "common_normal" in sys.argv[2:]:
    deck["contact"]["forces"] = "common_normal"

# (ranks, threads, back end): covers more ranks than cores, odd counts, and ranks times threads.
covering = [(2, 1, "serial"), (3, 1, "threads"), (4, 2, "threads"), (7, 1, "serial"), (1, 4, "threads"), (1, 2, "threads")]
if dimension == "tiny":  # two elements: most ranks have none
    covering = [(2, 1, "serial"), (7, 1, "serial"), (7, 1, "threads")]
if "common_normal" in sys.argv[2:]:
    covering = [(2, 1, "serial"), (3, 1, "serial"), (4, 2, "threads"), (1, 2, "threads")]
product = list(itertools.product((1, 2, 3, 4, 7, 8), (1, 2, 4), ("serial", "threads")))

reference = case.run("reference", recipe, deck)
h = reference.history
# The comparison is worth something only if everything has happened.
happened = ["stick", "slip", "contact_friction", "contact_damping"]
if dimension != "tiny":
    happened += ["contact_hysteresis", "plastic", "open", "ends_reaction_y"]
for what in happened:
    case.check_within(f"reference: {what}", max(h[what]), 1e-9, float("inf"))


def compare(name, ranks, threads, backend, **changes):
    run = case.attempt(name, recipe, {**deck, **changes}, ranks, threads, backend)
    if not case.check_equal(f"{name}: exit code", run.code, 0):
        print(run.output)
        return
    case.check_equal(f"{name}: state hash", run.state_hash, reference.state_hash)
    case.check_equal(f"{name}: history differs", run.bytes_of("run.csv") != reference.bytes_of("run.csv"), False)
    case.check_equal(f"{name}: results that differ", differences(run.path("run.e"), reference.path("run.e")), [])
    files = reference.planes_files()
    case.check_equal(f"{name}: planes files", run.planes_files(), files)
    unequal = [f for f in files if f in run.planes_files() and run.bytes_of(f) != reference.bytes_of(f)]
    case.check_equal(f"{name}: planes files that differ", unequal, [])


for ranks, threads, backend in product if full else covering:
    if backend == "serial" and threads > 1:
        continue
    compare(f"{ranks}x{threads}_{backend}", ranks, threads, backend)
compare("rcb", 7 if dimension == "tiny" else 3, 1, "serial", partition={"method": "rcb"})
compare("hypergraph", 2, 1, "serial", partition={"method": "hypergraph", "balance": "nodes"})
case.finish()
