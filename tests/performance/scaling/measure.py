#!/usr/bin/env python3
"""Counts messages, bytes and memory of whole runs, for the model in docs/developer/scaling.md.

    tests/performance/scaling/measure.py [--bin build/bin] [--memory]

Boxes of n^3 hexahedra (one elastic block; or two halves that press on each other across a joint) run for two numbers of cycles; the
difference is what a cycle costs. MPI calls are counted by traffic.c, which is preloaded; memory is what the operating system says.
Prints one line for each run and a table. Takes a few minutes; the counts do not depend on what else the machine does.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
TOP = HERE.parents[2]
sys.path.insert(0, str(TOP / "tests/support"))
sys.dont_write_bytecode = True
from coplanetest import documents  # noqa: E402

STEP = 1e-6


def box(name, low, high, divisions):
    return {"shape": "box", "block": name, "min": low, "max": high, "divisions": divisions}


def recipe_of(kind, n):
    """n x n x n elements in all; in contact the upper half has one element more along both sides of the joint. A bar: 16 x 16 x n."""
    if kind == "bar":
        return {"dimension": 3, "parts": [box("lower", [0, 0, 0], [16, 16, n], [16, 16, n])]}
    if kind == "block":
        return {"dimension": 3, "parts": [box("lower", [0, 0, 0], [1, 1, 1], [n, n, n])]}
    return {"dimension": 3, "parts": [box("lower", [0, 0, 0], [1, 1, 0.5], [n, n, n // 2]), box("upper", [0, 0, 0.5], [1, 1, 1], [n + 1, n + 1, n // 2])]}


def deck_of(kind, cycles, search):
    blocks = ["lower", "upper"] if kind == "contact" else ["lower"]
    deck = {
        "mesh": "mesh.e",
        "materials": {"stone": {"model": "linear_elastic", "density": 2500, "youngs_modulus": 1e9, "poisson_ratio": 0.25}},
        "blocks": {name: {"material": "stone"} for name in blocks},
        "time": {"end": STEP * (cycles - 0.5), "fixed_step": STEP},
        "output": {"results": "none", "planes": False},
        "history": {"every": 1},
    }
    if kind == "bar":
        deck["partition"] = {"method": "rcb"}
    if kind != "contact":
        deck["contact"] = {"enabled": False}
    else:
        deck["joints"] = {"dry": {"model": "closure_curve", "initial_stiffness": 1e10, "maximum_closure": 1e-3, "shear_stiffness": 5e9, "friction": 0.5}}
        deck["contact"] = {"default_joint": "dry", "search_every": search}
        deck["initial"] = [{"block": "upper", "velocity": [0, 0, -1]}]
    return deck


class Counter:
    def __init__(self, folder, binaries, counting):
        self.folder, self.bin, self.counting = folder, binaries, counting

    def mesh(self, kind, n):
        documents.save({"title": "counts", **recipe_of(kind, n)}, self.folder / "mesh.yaml")
        subprocess.run([self.bin / "coplane_mesh", "make", "mesh.yaml", "--output", "mesh.e"], cwd=self.folder, check=True, stdout=subprocess.DEVNULL)

    def run(self, kind, ranks, cycles, search=4):
        """What each rank did: a list of counts; and the record of the run."""
        documents.save(deck_of(kind, cycles, search), self.folder / "run.yaml")
        command = [os.environ.get("MPIEXEC", "mpirun"), "-np", str(ranks), "-x", "LD_PRELOAD", "-x", "TRAFFIC", self.bin / "coplane", "run.yaml", "--backend", "serial", "--quiet"]
        environment = {**os.environ, "LD_PRELOAD": str(self.counting), "TRAFFIC": str(self.folder / "traffic"),
                       "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}
        done = subprocess.run(command, cwd=self.folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            sys.exit(done.stdout)
        counts = [json.loads((self.folder / f"traffic.{rank}").read_text()) for rank in range(ranks)]
        return counts, json.loads((self.folder / "run.run.json").read_text())

    def per_cycle(self, kind, ranks, search=4, cycles=(20, 60)):
        """Calls and bytes of a cycle, of the rank that has most of them: {function: (calls, bytes)}."""
        (first, _), (second, record) = (self.run(kind, ranks, c, search) for c in cycles)
        found = {}
        for name in first[0]:
            if name == "largest":
                continue
            pairs = [((b[name][0] - a[name][0]) / (cycles[1] - cycles[0]), (b[name][1] - a[name][1]) / (cycles[1] - cycles[0])) for a, b in zip(first, second)]
            if max(pairs)[0] > 0:
                found[name] = (max(p[0] for p in pairs), max(p[1] for p in pairs))
        return found, record


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, default=TOP / "build/bin", help="folder with coplane and coplane_mesh")
    parser.add_argument("--memory", action="store_true", help="measure memory only")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        counting = folder / "libtraffic.so"
        subprocess.run(["mpicc", "-O2", "-shared", "-fPIC", "-o", counting, HERE / "traffic.c"], check=True)
        counter = Counter(folder, options.bin.resolve(), counting)

        traffic = [("block", (12, 24), (2, 4, 8), 4), ("contact", (12, 24), (2, 4, 8), "once"), ("contact", (12, 24), (2, 4, 8), 4)]
        if not options.memory:
            print("| run | n | ranks | elements a rank | calls and bytes a cycle, of the rank with most |")
            print("|---|---|---|---|---|")
        for kind, sizes, all_ranks, search in [] if options.memory else traffic:
            for n in sizes:
                counter.mesh(kind, n)
                for ranks in all_ranks:
                    found, _ = counter.per_cycle(kind, ranks, search)
                    text = "; ".join(f"{what} {c:.2f}, {b:.0f} B" for what, (c, b) in found.items())
                    label = kind if kind == "block" else f"{kind}, search {search}"
                    print(f"| {label} | {n} | {ranks} | {n**3 // ranks} | {text} |", flush=True)

        print("\n| run | n | elements | planes | ranks | peak memory of the ranks [MB] |\n|---|---|---|---|---|---|")
        some, many = (1, 2, 4), (1, 2, 4, 8, 16)
        memory = [("block", 32, some), ("block", 48, many), ("block", 64, many), ("contact", 32, some), ("contact", 48, some), ("contact", 64, some)]
        # Bars of 64 layers for each rank, cut across; and of so few elements that only what a run takes anyway is seen.
        memory += [("bar", layers, (ranks,)) for ranks in (4, 8, 16) for layers in (64 * ranks, ranks)]
        for kind, n, all_ranks in memory:
            counter.mesh(kind, n)
            for ranks in all_ranks:
                counts, record = counter.run(kind, ranks, 5)
                size = record["sizes"]
                peaks = sorted(count["largest"] / 1e6 for count in counts)
                print(f"| {kind} | {n} | {size['elements']} | {size.get('planes', 0)} | {ranks} | {peaks[0]:.1f} to {peaks[-1]:.1f} |", flush=True)


main()
