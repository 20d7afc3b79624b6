"""Fragments: connected bodies after erosion and broken joints, with their mass, motion and box (README.md)."""

import csv
import pathlib
import shutil

import numpy
from coplanetest import Case, documents, program

case = Case("output_fragments", __file__)
# A bar of 28 x 4 x 2 cm with a thin layer at 0.1, which dies in the first cycle; its end from 0.2 on is bonded to it. All turns.
density, width, depth = 2500.0, 0.04, 0.02
ends = [0, 0.1, 0.1004, 0.2]
recipe = {
    "dimension": 3,
    "parts": [
        {"shape": "box", "block": "bar", "lines": {"x": {"ends": ends, "divisions": [10, 1, 10]}, "y": {"ends": [0, width], "divisions": [4]},
                                                   "z": {"ends": [0, depth], "divisions": [2]}}},
        {"shape": "box", "block": "tail", "min": [0.2, 0, 0], "size": [0.08, width, depth], "divisions": [8, 4, 2]},
    ],
}
velocity, spin, center = numpy.array([3.0, -2.0, 1.0]), numpy.array([0.0, 5.0, 20.0]), numpy.array([0.14, 0.02, 0.01])
motion = {"velocity": velocity.tolist(), "angular_velocity": spin.tolist(), "center": center.tolist()}
deck = {
    "materials": {"stone": {"model": "linear_elastic", "density": density, "youngs_modulus": 1e9, "poisson_ratio": 0.2}},
    "blocks": {"bar": {"material": "stone", "erosion": {"stable_step": 2e-6}}, "tail": {"material": "stone"}},
    "joints": {"glue": {"model": "penalty"}, "bond": {
        "model": "bilinear", "normal_stiffness": 1e12, "tensile_strength": 1e4, "tension_energy": 1, "shear_energy": 1, "cohesion": 1e4}},
    "contact": {"default_joint": "glue", "pairs": [{"blocks": ["bar", "tail"], "joint": "bond", "declared": True}]},
    "initial": [{"block": "bar", **motion}, {"block": "tail", **motion}],
    "time": {"end": 2e-4},
    "output": {"every": 1e-4, "fragments": True, "planes": False},
}
VECTORS = ("center", "velocity", "angular_momentum", "spin", "low", "high")


def fragments(folder):
    """{time: {id: row}}; vectors as arrays."""
    times = {}
    with open(pathlib.Path(folder, "run_fragments.csv"), newline="") as file:
        for line in csv.DictReader(file):
            numbers = {name.split("[")[0]: float(value) for name, value in line.items()}
            row = {name: numbers[name] for name in ("elements", "mass", "time")}
            for name in VECTORS:
                row[name] = numpy.array([numbers[f"{name}_{axis}"] for axis in "xyz"])
            times.setdefault(numbers["time"], {})[int(numbers["fragment"])] = row
    return times


def check_sums(name, times):
    """Masses, momenta and angular momenta of the bodies are those of the run; boxes hold their centres."""
    for time, bodies in times.items():
        rows = list(bodies.values())
        mass = sum(row["mass"] for row in rows)
        momentum = sum(row["mass"] * row["velocity"] for row in rows)
        angular = sum(row["angular_momentum"] + row["mass"] * numpy.cross(row["center"], row["velocity"]) for row in rows)
        case.check(f"{name}: mass at {time:.2g} s [kg]", mass, total, 1e-13, relative=True)
        # No force acts from outside: those of the start.
        case.check(f"{name}: momentum at {time:.2g} s", numpy.max(numpy.abs(momentum - total * velocity)) / (total * 4), 0, 1e-12)
        case.check(f"{name}: angular momentum at {time:.2g} s", numpy.max(numpy.abs(angular - angular_at_start)) / total, 0, 1e-11)
        inside = all(numpy.all(row["low"] <= row["center"]) and numpy.all(row["center"] <= row["high"]) for row in rows)
        case.check_equal(f"{name}: centres in their boxes at {time:.2g} s", inside, True)


lengths = {"left": 0.1, "layer": 0.0004, "right": 0.0996, "tail": 0.08}
masses = {name: density * width * depth * length for name, length in lengths.items()}
total = sum(masses.values())


def inertia_of_nodes(pieces):
    """Sum of m (r^2 1 - r r) over lumped corner masses, about `center`: pieces of (from, to, divisions)."""
    tensor, moment = numpy.zeros((3, 3)), numpy.zeros(3)
    for low, high, count in pieces:
        x = numpy.linspace(low, high, count + 1)
        y, z = numpy.linspace(0, width, 5), numpy.linspace(0, depth, 3)
        weights = [numpy.convolve(numpy.full(len(a) - 1, 0.5 * (a[1] - a[0])), [1, 1]) for a in (x, y, z)]
        for i, xi in enumerate(x):
            for j, yj in enumerate(y):
                for k, zk in enumerate(z):
                    m = density * weights[0][i] * weights[1][j] * weights[2][k]
                    r = numpy.array([xi, yj, zk]) - center
                    tensor += m * (r @ r * numpy.eye(3) - numpy.outer(r, r))
                    moment += m * numpy.array([xi, yj, zk])
    return tensor, moment


tensor, moment = inertia_of_nodes([(0, 0.1, 10), (0.1, 0.1004, 1), (0.1004, 0.2, 10), (0.2, 0.28, 8)])
# About the origin; the centre of mass is `center`.
case.check("centre of mass of the bar", numpy.max(numpy.abs(moment / total - center)), 0, 1e-15)
angular_at_start = tensor @ spin + total * numpy.cross(center, velocity)

# --- cut by erosion; the bond holds -------------------------------------------------------------------------
run = case.run("cut", recipe, deck, energy=1e-2)
times = fragments("cut")
start, *later = sorted(times)
case.check_equal("times", len(times), 3)
whole = times[start]
case.check_equal("one body at the start", list(whole), [1])
case.check("its mass [kg]", whole[1]["mass"], total, 1e-14, relative=True)
case.check_equal("its elements", whole[1]["elements"], 21 * 8 + 8 * 8)
case.check("its centre [m]", numpy.max(numpy.abs(whole[1]["center"] - center)), 0, 1e-15)
case.check("its velocity [m/s]", numpy.max(numpy.abs(whole[1]["velocity"] - velocity)), 0, 1e-13)
case.check("its spin [rad/s]", numpy.max(numpy.abs(whole[1]["spin"] - spin)), 0, 1e-10)
case.check("its angular momentum [kg m^2/s]", numpy.max(numpy.abs(whole[1]["angular_momentum"] - tensor @ spin)), 0, 1e-13)
case.check("its box [m]", numpy.max(numpy.abs(numpy.append(whole[1]["low"], whole[1]["high"]) - [0, 0, 0, 0.28, width, depth])), 0, 1e-15)
check_sums("cut", times)
variables = {"cut": {block: run.results.element(block, "fragment") for block in ("bar", "tail")}}
results = run.results
ids = {block: results.element(block, "fragment") for block in ("bar", "tail")}
alive = results.element("bar", "alive")
case.check_equal("dead elements", int(numpy.sum(alive == 0)), 8)
for time in later:
    bodies = times[time]
    case.check_equal(f"bodies at {time:.2g} s: none, left, right with tail", sorted(bodies), [0, 1, 12])
    for body, name, expected in ((0, "dead", masses["layer"]), (1, "left", masses["left"]), (12, "right", masses["right"] + masses["tail"])):
        case.check(f"mass of {name} at {time:.2g} s [kg]", bodies[body]["mass"], expected, 1e-13, relative=True)
# The element variable says the same.
counts = {int(i): int(numpy.sum(ids["bar"] == i) + numpy.sum(ids["tail"] == i)) for i in numpy.unique(numpy.append(ids["bar"], ids["tail"]))}
case.check_equal("elements by the variable", counts, {i: int(row["elements"]) for i, row in times[later[-1]].items()})
case.check_equal("dead elements are of none", bool(numpy.all((ids["bar"] == 0) == (alive == 0))), True)

# --- the bond breaks: the tail is faster ---------------------------------------------------------------------
pulled = {**deck, "initial": [{"block": "bar", **motion}, {"block": "tail", **{**motion, "velocity": (velocity + [4, 0, 0]).tolist()}}]}
run = case.run("pulled", recipe, pulled, energy=1e-2)
times = fragments("pulled")
start, *later = sorted(times)
last = times[later[-1]]
variables["pulled"] = {block: run.results.element(block, "fragment") for block in ("bar", "tail")}
case.check_equal("broken: bodies at the end: none, left, right, tail", sorted(last), [0, 1, 12, 169])
for body, name in ((0, "layer"), (1, "left"), (12, "right"), (169, "tail")):
    case.check(f"broken: mass of {name} [kg]", last[body]["mass"], masses[name], 1e-13, relative=True)
# The bond takes next to nothing: 1 J/m^2 over 8 cm^2, of some 1 J.
case.check("broken: speed of the tail along x over its own [m/s]", last[169]["velocity"][0] - last[12]["velocity"][0], 4, 0.01)
case.check("broken: spin of the tail about z [rad/s]", last[169]["spin"][2], spin[2], 0.005, relative=True)

# --- the bond holds, but the tail slides off it: faces without area in common do not connect ----------------------
slid = {
    **pulled,
    "joints": {"glue": {"model": "penalty"}, "bond": {
        "model": "bilinear", "normal_stiffness": 1e6, "tensile_strength": 1e6, "tension_energy": 2e6, "shear_energy": 4e6, "cohesion": 1e6}},
    "initial": [{"block": "bar"}, {"block": "tail", "velocity": [0, 400, 0]}],
}
run = case.attempt("slid", recipe, slid)
case.check_equal("slid: exit code", run.code, 0)
times = fragments("slid")
start, *later = sorted(times)
case.check_equal("slid: bodies at the start", sorted(times[start]), [1])
case.check_equal("slid: bodies at the end: none, left, right, tail", sorted(times[later[-1]]), [0, 1, 12, 169])

# --- in the plane: a square that turns, and triangles beside it ----------------------------------------------
flat_recipe = {"dimension": 2, "parts": [
    {"shape": "box", "block": "square", "min": [1, 0], "size": [0.1, 0.1], "divisions": [4, 4]},
    {"shape": "box", "block": "plate", "min": [1.2, 0], "size": [0.1, 0.2], "divisions": [3, 4], "split": "triangles"},
]}
flat = {
    "materials": {"stone": {"model": "linear_elastic", "density": 1000, "youngs_modulus": 1e9, "poisson_ratio": 0.2}},
    "blocks": {"square": {"material": "stone"}, "plate": {"material": "stone"}},
    "initial": [{"block": "square", "velocity": [1, 0, 0], "angular_velocity": [0, 0, 3], "center": [1.05, 0.05, 0]},
                {"block": "plate", "velocity": [0, 2, 0]}],
    "contact": {"enabled": False}, "time": {"end": 1e-5}, "output": {"fragments": True},
}
case.run("flat", flat_recipe, flat)
bodies = next(iter(fragments("flat").values()))
case.check_equal("flat: bodies", sorted(bodies), [1, 17])
case.check("flat: mass of the square [kg/m]", bodies[1]["mass"], 10, 1e-13, relative=True)
case.check("flat: mass of the plate [kg/m]", bodies[17]["mass"], 20, 1e-13, relative=True)
case.check("flat: spin of the square [rad/s]", bodies[1]["spin"][2], 3, 1e-12, relative=True)
case.check("flat: spin of the plate [rad/s]", bodies[17]["spin"][2], 0, 1e-12)

# --- crushed elements connect nothing -----------------------------------------------------------------------
soft = {
    **deck,
    "materials": {"stone": {"model": "kcc", "density": density, "compressive_strength": 40e6, "youngs_modulus": 1e9, "fracture_energy": 1}},
    "initial": [{"block": "bar", "velocity_field": ["60*(x-0.14)/0.14", "0", "0"]}, {"block": "tail", "velocity_field": ["60*(x-0.14)/0.14", "0", "0"]}],
    "output": {**deck["output"], "fragment_damage": 0.5},
}
run = case.attempt("crushed", recipe, soft)
case.check_equal("crushed: exit code", run.code, 0)
if run.code:
    print(run.output[-2000:])
else:
    bodies = fragments("crushed")[max(fragments("crushed"))]
    whole_mass = sum(row["mass"] for row in bodies.values())
    case.check("crushed: mass [kg]", whole_mass, total, 1e-13, relative=True)
    results = run.results
    damage = numpy.append(results.element("bar", "damage"), results.element("tail", "damage"))
    alive = numpy.append(results.element("bar", "alive"), results.element("tail", "alive"))
    body = numpy.append(results.element("bar", "fragment"), results.element("tail", "fragment"))
    case.check_equal("crushed: those of no body are the dead and the damaged", bool(numpy.all((body == 0) == ((alive == 0) | (damage >= 0.5)))), True)
    case.check_within("crushed: elements that are damaged", int(numpy.sum((alive == 1) & (damage >= 0.5))), 8, 231)

# --- the same on other ranks, and after a restart ------------------------------------------------------------
for name, first in (("cut", deck), ("pulled", pulled)):
    before = pathlib.Path(name, "run_fragments.csv").read_bytes()
    for ranks in (2, 3, 4):
        again = case.attempt(f"{name}_{ranks}", recipe, first, ranks=ranks)
        case.check_equal(f"{name}: exit code on {ranks} ranks", again.code, 0)
        same = pathlib.Path(f"{name}_{ranks}", "run_fragments.csv").read_bytes() == before
        case.check_equal(f"{name}: the same table on {ranks} ranks", same, True, "same bits on other ranks")
        for block in ("bar", "tail"):
            same = numpy.array_equal(again.results.element(block, "fragment"), variables[name][block])
            case.check_equal(f"{name}: the same variable on {ranks} ranks, {block}", bool(same), True, "same bits on other ranks")
folder = pathlib.Path("restarted").resolve()
shutil.rmtree(folder, ignore_errors=True)
folder.mkdir()
shutil.copy("pulled/mesh.e", folder)
stopped = {**pulled, "checkpoint": {"at_end": True}}
documents.save({"mesh": "mesh.e", **stopped}, folder / "run.yaml")
code, output = program.run_program(["run.yaml", "--set", "time.end=1e-4"], folder, 2)
case.check_equal("first part: exit code", code, 0)
code, output = program.run_program(["run.yaml", "--restart", "--set", "time.end=2e-4"], folder, 1)
case.check_equal("second part: exit code", code, 0)
same = (folder / "run_fragments.csv").read_bytes() == pathlib.Path("pulled", "run_fragments.csv").read_bytes()
case.check_equal("restarted: the table of the run in one go", same, True)
case.finish()
