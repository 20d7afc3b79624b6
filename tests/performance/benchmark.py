#!/usr/bin/python3
"""Five fixed runs and the kernels, timed: a page of Markdown on standard output.

    benchmark.py BIN [--against PROGRAM] [--turns N] [--part SHARE] [--folder FOLDER] [--only EXAMPLE ...] [--kernels]

BIN is the folder of the programs. The runs are examples of exodus_inputs, each for a share of its time (--part, 1: to the end) on one core, on two
threads and on two ranks. --against names another `coplane`, such as that of an older revision: it runs the same mesh and deck in turns with this
one, on one core; a deck that it does not know is told. --kernels adds coplane_bench_elements and coplane_bench_contact where they are built.

Times are processor seconds (user and system, of all ranks and threads) of the whole process, and wall seconds; the least of the turns counts.
Compare numbers of one page only: processors and what else runs differ.
"""

import argparse
import json
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/support"))
from coplanetest import documents, examples, program  # noqa: E402

# Example, size, variant, share of its time that is run by default: some ten seconds each on one core.
RUNS = [
    ("bar_wall_3d", "S", "", 0.1),
    ("projectile_wall_2d", "S", "", 0.2),
    ("jointed_rock_2d", "M", "base", 0.5),
    ("explosion_3d", "S", "", 0.5),
    ("perforation_3d", "coarse", "", 1.0),
]
WAYS = {"1 core": (1, ["--backend", "serial"]), "2 threads": (1, ["--backend", "threads", "--threads", "2"]), "2 ranks": (2, ["--backend", "serial"])}
# What the timers of a run are about, by the words of their names.
PARTS = {"A to H": "step6", "contact forces": "addforces", "search": "dynamics::search", "elements": "element::update", "nodes": ("kick", "gatherforces"), "output": "output"}


def prepared(folder, name, size, variant, share):
    """The run's folder with mesh and deck; returns the simulated time [s]."""
    recipe, deck, joints = examples.sized(name, size, variant)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    whole = folder / ("whole.e" if joints else "mesh.e")
    program.make_mesh(recipe, str(whole))
    if joints:
        program.split_mesh(str(whole), joints, str(folder / "mesh.e"))
    deck["time"]["end"] *= share
    deck["output"] = {"every": deck["time"]["end"], "planes": False}
    documents.save({**deck, "mesh": "mesh.e"}, folder / "run.yaml")
    return deck["time"]["end"]


def timed(executable, folder, ranks, options):
    """Processor and wall seconds of one run, and its record; None and what it said when it failed."""
    launch = [os.environ.get("MPIEXEC", "mpirun"), "-np", str(ranks), "--bind-to", "none"] if ranks > 1 else []
    before, began = os.times(), time.perf_counter()
    done = subprocess.run([*launch, executable, "run.yaml", *options], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          env={**os.environ, "OMP_WAIT_POLICY": "active" if "threads" in options else "passive"})  # fmt: skip
    wall, after = time.perf_counter() - began, os.times()
    if done.returncode:
        return None, (done.stdout.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
    seconds = after.children_user + after.children_system - before.children_user - before.children_system
    record = json.loads(next(folder.glob("*.run.json")).read_text())
    return (seconds, wall), record


def other_folder(folder):
    """Where the other program has the same mesh and deck."""
    place = folder / "other"
    if not place.exists():
        place.mkdir()
        for file in ("mesh.e", "run.yaml"):
            shutil.copy(folder / file, place)
    return place


def hash_of(record):
    return record.get("state_hash", "")


def shares(record, whole):
    """Shares of the timers in all seconds of the process [%]."""
    timers = record["timers_s"]
    return [100 * sum(seconds for name, seconds in timers.items() if any(word in name.lower() for word in ([words] if isinstance(words, str) else words))) / whole
            for words in PARTS.values()]  # fmt: skip


def table(title, head, rows):
    print(f"\n## {title}\n\n| {' | '.join(head)} |\n|{'---|' * len(head)}", flush=True)
    for row in rows:
        print(f"| {' | '.join(str(cell) for cell in row)} |", flush=True)


def machine():
    info = pathlib.Path("/proc/cpuinfo").read_text() if pathlib.Path("/proc/cpuinfo").exists() else ""
    model = next((line.split(":", 1)[1].strip() for line in info.splitlines() if line.startswith("model name")), platform.processor())
    return f"{model}, {os.cpu_count()} cores, {platform.system()} {platform.release()}; load before: {os.getloadavg()[0]:.1f}"


def measure(given):
    own = str(pathlib.Path(given.bin).resolve() / "coplane")
    other = str(pathlib.Path(given.against).resolve()) if given.against else None
    rows, parts = [], []
    for name, size, variant, share in RUNS:
        if given.only and name not in given.only:
            continue
        folder = pathlib.Path(given.folder, name).resolve()
        end = prepared(folder, name, size, variant, given.part or share)
        times, records, refused = {}, {}, ""
        for _ in range(given.turns):
            for way, (ranks, options) in WAYS.items():
                found, record = timed(own, folder, ranks, options)
                if found is None:
                    sys.exit(f"{name}: {record}")
                times.setdefault(way, []).append(found)
                records[way] = record
            if other and not refused:
                found, record = timed(other, other_folder(folder), 1, ["--backend", "serial"])
                if found is None:
                    refused = record
                else:
                    times.setdefault("other", []).append(found)
        if len({hash_of(record) for record in records.values()}) != 1:
            sys.exit(f"{name}: the state hashes differ: { {way: hash_of(record) for way, record in records.items()} }")
        least = {way: [min(one[k] for one in found) for k in (0, 1)] for way, found in times.items()}
        record, one = records["1 core"], least["1 core"]
        sizes = record["sizes"]
        work = sizes["elements"] * sizes["cycles"]
        rows.append([f"{name} {size}", f"{1e3 * end:.3g}", sizes["elements"], sizes["cycles"], f"{one[0]:.2f}", f"{one[0] / (1e3 * end):.2f}", f"{1e-6 * work / one[0]:.2f}",
                     f"{one[1] / least['2 threads'][1]:.2f}", f"{one[1] / least['2 ranks'][1]:.2f}",
                     *([f"{least['other'][0] / one[0]:.2f}" if "other" in least else f"refused: {refused[:80]}"] if other else [])])  # fmt: skip
        parts.append([f"{name} {size}", *(f"{share:.0f} %" for share in shares(record, one[1])), f"{record['peak_memory_bytes']['sum'] / 2**20:.0f} MiB"])
    return rows, parts


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("bin", help="folder of the programs")
    parser.add_argument("--against", metavar="PROGRAM", help="another coplane, timed in turns with this one")
    parser.add_argument("--turns", type=int, default=1, metavar="N", help="of each run; the least time counts (default: 1)")
    parser.add_argument("--part", type=float, metavar="SHARE", help="of the time of each example (default: some ten seconds of work)")
    parser.add_argument("--folder", default="benchmark", help="of the runs (default: benchmark)")
    parser.add_argument("--only", nargs="+", choices=[run[0] for run in RUNS], metavar="EXAMPLE", help="only these")
    parser.add_argument("--kernels", action="store_true", help="the kernels as well")
    given = parser.parse_args()
    os.environ["COPLANE_BIN"] = str(pathlib.Path(given.bin).resolve())
    version = subprocess.run([pathlib.Path(given.bin, "coplane"), "--version"], stdout=subprocess.PIPE, text=True, check=True).stdout.strip()
    print(f"# Benchmark\n\n{version}\n\n{machine()}", flush=True)
    rows, parts = measure(given)
    other = ["processor time of the other program over this one's"] if given.against else []
    table("Runs, one core", ["run", "simulated [ms]", "elements", "cycles", "processor time [s]", "per simulated ms [s]", "million element-cycles/s",
                             "two threads: times faster", "two ranks: times faster", *other], rows)  # fmt: skip
    table("Where the time goes, one core", ["run", *PARTS, "memory"], parts)
    if given.kernels:
        for kernel in ("coplane_bench_elements", "coplane_bench_contact"):
            executable = pathlib.Path(given.bin, kernel)
            if executable.exists():
                print(f"\n## {kernel}\n\n```", flush=True)
                subprocess.run([executable, "--benchmark_min_time=0.2"], check=True)
                print("```")


if __name__ == "__main__":
    main()
