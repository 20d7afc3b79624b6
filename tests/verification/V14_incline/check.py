"""V14: a block slides down an incline, or sticks; V65: 2D equals a slice of 3D."""

import copy
import math

import numpy
from coplanetest import Case, turned

case = Case("V14", __file__)
g, end = 9.81, 0.5
mass = 2000 * 0.2 * 0.1  # per metre of depth


def deck_for(angle, friction, **contact):
    deck = copy.deepcopy(case.load())
    deck["gravity"] = [g * math.sin(math.radians(angle)), -g * math.cos(math.radians(angle)), 0.0]
    deck["joints"]["rough"]["friction"] = friction
    deck["contact"].update(contact)
    return deck


def distance(angle, friction):
    """Slid in 0.5 s from rest [m]: a = g (sin - mu cos)."""
    a = g * (math.sin(math.radians(angle)) - friction * math.cos(math.radians(angle)))
    return a * end**2 / 2


def slide(name, recipe, deck, angle, friction, depth=1.0, matrix=None, report=False):
    run = case.run(name, recipe, deck)
    h = run.history
    motion = numpy.stack([h[f"block_displacement_{axis}"] for axis in "xyz"])
    base = numpy.stack([h[f"base_displacement_{axis}"] for axis in "xyz"])
    if matrix is not None:
        motion, base = matrix.T @ motion, matrix.T @ base
    slid = motion[0][-1] * (end / h["time"][-1]) ** 2  # the last step may end a little later
    case.check(f"{name}: distance slid [m]", slid, distance(angle, friction), 0.01, relative=True, report=report)
    work = friction * mass * depth * g * math.cos(math.radians(angle)) * motion[0][-1]
    case.check(f"{name}: friction work [J]", h["contact_friction"][-1], work, 0.01, relative=True, report=report)
    # The base must neither sink nor rise while it passes six or more faces (no ratchet). Means over
    # 0.1 s: the block still rocks and bounces a little.
    sunk = [-numpy.mean(base[1][(h["time"] >= t) & (h["time"] < t + 0.1)]) for t in (0.1, 0.2, 0.3, 0.4)]
    for t, s in zip((0.2, 0.3, 0.4), sunk[1:]):
        case.check(f"{name}: sunk at {t} s over {sunk[0]:.4e} m", s / sunk[0], 1, 0.02, report=report)
    case.check(f"{name}: planes deeper than the limit", int(numpy.max(h["too_deep"])), 0, 0)
    return run


recipe = case.load("mesh.yaml")
slide("30_degrees", recipe, deck_for(30, 0.3), 30, 0.3)
slide("45_degrees", recipe, deck_for(45, 0.5), 45, 0.5)

# The geometry truly turned, by 30 degrees downhill: gravity is then plumb.
tilted, deck, matrix = turned(recipe, deck_for(30, 0.3), -30)
case.check("plumb", deck["gravity"][0], 0, 1e-12)
slide("turned", tilted, deck, 30, 0.3, matrix=matrix)
slide("3d", case.load("mesh_3d.yaml"), deck_for(30, 0.3), 30, 0.3, depth=0.1)

# The paper's own choices, for the record: whole areas, forces at the centre, closure summed up.
slide("seed", recipe, deck_for(30, 0.3, preset="seed"), 30, 0.3, report=True)

# Sticking: at rest after a damped start, tan 30 = 0.577 < 0.7.
deck = deck_for(30, 0.7)
deck["damping"] = {"mass": 60, "until": 0.3}
h = case.run("sticks", recipe, deck).history
late = h["time"] > 0.4
creep = numpy.polyfit(h["time"][late], h["block_displacement_x"][late], 1)[0]
case.check("sticks: creep [m/s]", creep, 0, 1e-5)
case.check("sticks: planes that slip late", int(numpy.max(h["slip"][late])), 0, 0)

case.name = "V65"
results = {}
for name, mesh in (("slice", "mesh_slice.yaml"), ("plane", "mesh.yaml")):
    deck = deck_for(30, 0.3)
    if name == "slice":
        deck["conditions"] += [{"type": "symmetry", "node_set": s, "normal": [0, 0, 1]} for s in ("back", "front")]
    # Bulk viscosity and hourglass control measure an element by its volume^(1/dimension) and by all its
    # gradients: with a thickness of 1 m they differ from the plane's, and are switched off here.
    deck["viscosity"] = {"linear": 0, "quadratic": 0}
    deck["blocks"]["block"]["hourglass"] = {"stiffness": 0}
    deck["time"].update(end=0.1, fixed_step=1.2e-4)
    results[name] = case.run(name, case.load(mesh), deck).history
for quantity in ("block_displacement_x", "block_displacement_y", "block_velocity_x", "contact_friction"):
    a, b = results["slice"][quantity], results["plane"][quantity]
    case.check(f"slice: {quantity}", numpy.max(numpy.abs(a - b)) / numpy.max(numpy.abs(b)), 0, 1e-10)
case.finish()
