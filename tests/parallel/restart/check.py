"""V61: a run that is stopped and restarted, again and again, on other ranks, threads and back ends, has the bits of the run that
was never stopped: state, history, results, planes.

Usage: check.py 2d|3d|sliding|erosion|erosion_3d|everything|rigid|rings|joints|common_plane [all]
"""

import json
import pathlib
import sys

import numpy
from coplanetest import Case, program, series_differences

scene, full = sys.argv[1], "all" in sys.argv[2:]
case = Case(f"V61 {scene}", __file__)
joints, change = None, {}


def of(folder, mesh="mesh.yaml", deck="deck.yaml"):
    return case.load(f"tests/{folder}/{mesh}"), case.load(f"tests/{folder}/{deck}")


if scene in ("2d", "3d", "common_plane"):
    recipe, deck = of("parallel/same_bits", "mesh_3d.yaml" if scene == "3d" else "mesh_2d.yaml")
    velocity, end = ([5, -40, 90], 5e-4) if scene == "3d" else ([100, 20, 0], 1.2e-4)
    deck["initial"] = [{"block": "bar", "velocity": velocity}]
    deck["time"] = {"end": end}
    deck["output"] = {"every": end / 9}
    if scene == "common_plane":
        deck["contact"]["method"] = "common_plane"
    happened = ["stick", "slip", "contact_friction", "contact_damping", "contact_hysteresis", "plastic", "open"]
elif scene == "sliding":
    recipe, deck = of("verification/V64_life_of_planes")
    deck["time"]["end"] = 0.09
    deck["output"] = {"every": 0.01}
    happened = ["slip", "contact_friction"]
elif scene in ("erosion", "erosion_3d"):
    recipe, deck = of("verification/erosion", "mesh_3d.yaml" if scene == "erosion_3d" else "mesh.yaml")
    if scene == "erosion_3d":
        deck["initial"][0]["velocity"] = [0, 0, -800]
        deck["time"]["end"] = 4e-5
    deck["output"]["every"] = deck["time"]["end"] / 9
    happened = ["eroded_elements", "contact_eroded", "eroded"]
elif scene == "everything":
    recipe, deck = case.load("mesh_everything.yaml"), case.load("everything.yaml")
    happened = ["eroded_elements", "contact_eroded", "contact_hysteresis", "contact_fracture", "contact_friction", "plastic",
                "mass_damping", "local_damping", "contact_damping"]
elif scene == "rigid":
    recipe, deck = case.load("exodus_inputs/rocking_block_2d/mesh.yaml"), case.load("exodus_inputs/rocking_block_2d/deck.yaml")
    deck.pop("mesh", None)
    deck["blocks"]["block"]["rigid"] = True
    recipe["parts"][1].update(rotate=-3, about=[0.3, 0])
    deck["time"] = {"end": 0.02}
    deck["output"] = {"every": 0.02 / 9}
    happened = ["stick", "contact_damping"]
elif scene == "rings":
    recipe, deck = of("verification/V72_axisymmetric_contact", "mesh_rings.yaml", "deck_rings.yaml")
    deck["time"]["end"] = 5e-4
    deck["output"] = {"every": 5e-4 / 9}
    happened = ["contact_stored", "mass_damping"]
elif scene == "joints":
    recipe, deck = case.load("exodus_inputs/cut_rock_2d/mesh.yaml"), case.load("exodus_inputs/cut_rock_2d/rock.yaml")
    joints = case.load("exodus_inputs/cut_rock_2d/joints.yaml")
    del deck["mesh"]
    happened = ["stick", "contact_stored"]
deck.setdefault("history", {})["every"] = 0
if scene != "everything":
    deck["history"]["tables"] = ["blocks", "pairs"]

straight = case.attempt("straight", recipe, deck, joints=joints)
if straight.code:
    sys.exit(straight.output)
h = straight.history
# The comparison is worth something only if everything has happened.
for what in happened:
    case.check_within(f"straight: {what}", float(max(h[what])), 1e-9, float("inf"))
cycles = len(h["time"]) - 1

# Where the run is stopped, and on what the next part runs: (fraction of the cycles, ranks, threads, back end).
chain = [(0.03, 1, 1, "serial"), (0.21, 3, 1, "serial"), (0.36, 2, 2, "threads"), (0.52, 4, 1, "threads"),
         (0.77, 1, 2, "threads"), (1, 2, 1, "serial")]
if full:
    layouts = [(1, 1, "serial"), (7, 1, "serial"), (2, 2, "threads"), (3, 1, "threads"), (4, 1, "serial"), (1, 4, "threads")]
    chain = [((i + 1) / 40, *layouts[i % len(layouts)]) for i in range(40)]


def options(end, restart):
    return ["--set", f"time.end={end!r}", "--set", "checkpoint.at_end=true"] + (["--restart"] if restart else [])


def run_part(folder, fraction, ranks, threads, backend, restart):
    cycle = min(cycles, max(1, int(fraction * cycles) + 1))  # mostly between two searches
    end = float(h["time"][cycle]) if fraction < 1 else deck["time"]["end"]
    arguments = ["run.yaml", "--backend", backend, "--threads", str(threads), *options(end, restart)]
    code, output = program.run_program(arguments, folder, ranks)
    name = f"stop at cycle {cycle}, {ranks} ranks x {threads} {backend}"
    if not case.check_equal(f"{name}: exit code", code, 0):
        sys.exit(output)
    return cycle


fraction, ranks, threads, backend = chain[0]
end = float(h["time"][max(1, int(fraction * cycles) + 1)])
first = case.attempt("stopped", recipe, deck, ranks, threads, backend, options(end, False), joints=joints)
case.check_equal("first part: exit code", first.code, 0)
others = case.attempt("stopped_3", recipe, deck, 3, 1, "threads", options(end, False), joints=joints)
case.check_equal("checkpoint of 1 and of 3 ranks differ", first.bytes_of("run.chk.0") != others.bytes_of("run.chk.0"), False)
for part in chain[1:]:
    run_part(first.folder, *part, True)

record = json.loads(pathlib.Path(first.path(f"run.run-s{len(chain):04}.json")).read_text())
case.check_equal("state hash", record["state_hash"], straight.state_hash)
for file in ["run.csv"] + [f"run_{table}.csv" for table in deck["history"]["tables"]]:
    case.check_equal(f"{file} differs", first.bytes_of(file) != straight.bytes_of(file), False)
parts = [first.path("run.e")] + [first.path(f"run.e-s{number:04}") for number in range(2, len(chain) + 1)]
parts = [part for part in parts if pathlib.Path(part).exists()]
case.check_equal("results that differ", series_differences(straight.path("run.e"), parts), [])
case.check_equal("planes files", first.planes_files(), straight.planes_files())
unequal = [f for f in straight.planes_files() if f in first.planes_files() and first.bytes_of(f) != straight.bytes_of(f)]
case.check_equal("planes files that differ", unequal, [])
case.finish()
