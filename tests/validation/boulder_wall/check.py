"""A boulder strikes a free-standing panel, which is exact, and a wall of bricks with mortar at the speeds of a published test, which is foretold."""

import math
import re

import numpy
from coplanetest import ValidationCase

case = ValidationCase(__file__)
G, THICK, HIGH, WIDE = 9.81, 0.115, 1.0, 1.0
BOULDER = 72.925  # [kg]


def masses(run):
    return {name: float(value) for name, value in re.findall(r"block '(\w+)' .*mass (\S+) kg", run.output)}


def scaled(deck, recipe):
    """The density that gives the meshed boulder its mass; found by a run of no length."""
    global density
    if density is None:
        probe = case.attempt("weigh", recipe, {**deck, "time": {"end": 1e-6}})
        density = deck["materials"]["granite"]["density"] * BOULDER / masses(probe)["boulder"]
    deck["materials"]["granite"]["density"] = density


density = None

# --- a panel that stands free: angular momentum about its foot, and energy, are kept ------------------------


def panel(name, speed, height, end=0.55, bed=1e12):
    recipe, deck = case.load("mesh.yaml"), case.load()
    recipe["parts"][1] = {"shape": "box", "block": "wall", "min": [0, 0, 0], "size": [WIDE, HIGH, THICK], "divisions": [4, 12, 2]}
    recipe["parts"][2]["offset"] = [0.5, height, -0.188]
    deck["joints"]["bed"] = {"model": "linear", "normal_stiffness": bed, "shear_stiffness": bed / 2, "friction": 3}
    deck["joints"]["strike"].update(normal_stiffness=2e11, shear_stiffness=1e11, friction=0)
    deck["contact"]["pairs"] = [{"blocks": ["ground", "wall"], "joint": "bed"}]
    deck["initial"] = [{"block": "boulder", "velocity": [0, 0, speed]}]
    deck["time"] = {"end": end}
    deck["history"]["probes"] += [{"name": "top", "point": [0.5, HIGH, THICK]}, {"name": "toe", "point": [0.5, 0, THICK]}]
    # The boulder does not fall: the impact lasts a millisecond, and it must not strike the ground.
    scaled(deck, recipe)
    run, spent = case.timed(name, recipe, deck, remainder=0.01)
    h = run.history
    tilt = numpy.arctan2(h["top_displacement_z"] - h["toe_displacement_z"], HIGH + h["top_displacement_y"] - h["toe_displacement_y"])
    return h, tilt, masses(run), run, spent


wall = 1800 * THICK * HIGH * WIDE
about_foot = wall * (THICK**2 + HIGH**2) / 3
strike_height = about_foot / (wall * HIGH / 2)  # where a blow gives the foot no push along the ground
reduced = about_foot / strike_height**2
lift = math.hypot(THICK, HIGH) / 2 - HIGH / 2
spin = math.sqrt(2 * wall * G * lift / about_foot)
limit = spin * strike_height * (BOULDER + reduced) / (2 * BOULDER)
for factor in (0.9, 1.1):
    h, tilt, found, run, spent = panel(f"panel_{factor}", factor * limit, strike_height)
    name = f"free panel, boulder at {factor} of {limit:.4f} m/s"
    case.check(f"{name}: mass of the boulder [kg]", found["boulder"], BOULDER, 1e-6, relative=True)
    after = h["boulder_velocity_z"][-1]
    case.check(f"{name}: velocity of the boulder afterwards over that before", after / (factor * limit), (BOULDER - reduced) / (BOULDER + reduced), 0.02)
    case.check_equal(f"{name}: the panel falls", bool(tilt.max() > math.atan(THICK / HIGH)), factor > 1)
    if factor < 1:
        # I w^2/2 = M g (R cos(alpha - tilt) - h/2)
        corner = math.hypot(THICK, HIGH) / 2
        highest = math.atan(THICK / HIGH) - math.acos(min(1, (HIGH / 2 + lift * factor**2) / corner))
        case.check(f"{name}: largest tilt [rad]", tilt.max(), highest, 0.1, relative=True)

# --- bricks with mortar, held at the foot, or at the foot and both ends: what becomes of the wall ---------------


def bricks(name, drop, held, end=0.06 if case.full else 0.02, divisions=(2, 1, 1), across=4, weaker=1.0):
    recipe, deck = case.load("mesh.yaml"), case.load()
    recipe["parts"][1]["divisions"] = list(divisions)
    recipe["parts"][2]["across"] = across
    for x in (-0.3, 1.0) if held else ():
        recipe["parts"].append({"shape": "box", "block": "ground", "min": [x, 0, 0], "size": [0.3, HIGH, THICK], "divisions": [2, 16, 1]})
    mortar = deck["joints"]["bed"]
    mortar.update(tensile_strength=0.25e6 * weaker, cohesion=0.35e6 * weaker, tension_energy=18 * weaker, shear_energy=125 * weaker)
    deck["contact"]["pairs"] = [{"blocks": [a, b], "joint": "bed", "declared": True} for a, b in (("wall", "wall"), ("ground", "wall"))]
    deck["contact"]["damping"] = {"normal": 0.1, "shear": 0.1}
    speed = math.sqrt(2 * G * drop)
    deck["initial"] = [{"block": "boulder", "velocity": [0, 0, speed]}]
    deck["time"] = {"end": end}
    deck["output"]["every"] = end / 6
    scaled(deck, recipe)
    run, spent = case.timed(name, recipe, deck, energy=2e-2, momentum=1e-11)
    h = run.history
    moved = run.results.nodal("displacement")
    nodes = run.results.connectivity("wall")
    way = moved[nodes].mean(axis=1)[:, 2]
    per_brick = divisions[0] * divisions[1] * divisions[2]
    return h, speed, way, per_brick, run, spent


FOOT, FRAME = "held at its foot", "held in a rigid frame at its foot and ends"
for held, drop in [(False, 0.25), (False, 0.5), (False, 1.0), (False, 2.5), (False, 3.0), (True, 3.0)] if case.full else [(False, 1.0)]:
    h, speed, way, per_brick, run, spent = bricks(f"drop_{drop}_{'frame' if held else 'foot'}", drop, held)
    left = h["boulder_velocity_z"][-1]
    words = f"{FRAME if held else FOOT}, fall of {drop} m, {BOULDER * G * drop:.0f} J"
    case.check(f"{words}: speed of the boulder [m/s]", h["boulder_velocity_z"][0], speed, 1e-3, relative=True)
    if case.full:
        case.study("foretold, after 60 ms: velocity of the boulder [m/s]", words, left, None, spent)
        case.study("foretold, after 60 ms: largest way of a brick [m]", words, way.max(), None, spent)
        case.study("foretold, after 60 ms: bricks that are away by more than 20 mm, of 64", words, float((way > 0.02).sum() / per_brick), None, spent)
    if not held and drop == 1.0:
        # All that the boulder gave away stands in the ledger of the others and of the ground.
        lost = masses(run)["boulder"] * (speed - left)
        got = masses(run)["wall"] * h["wall_velocity_z"][-1] - h["impulse_z"][-1]
        case.check("held at its foot, fall of 1 m: momentum that the boulder lost, found in the bricks and the ground [N s]", got, lost, 1e-3, relative=True)
        case.picture(run, "--shares", "0", "0.33", "0.67", "1", "--strip", "4", "--direction", "1", "0.4", "-0.9", "--size", "300", "330")
if case.full:
    for words, changes in (("mortar a fifth as strong", {"weaker": 0.2}),):
        h, speed, way, per_brick, run, spent = bricks("other_" + words.replace(" ", "_"), 1.0, False, **changes)
        case.study("foretold, after 60 ms: velocity of the boulder [m/s]", f"{FOOT}, fall of 1.0 m, {words}", h["boulder_velocity_z"][-1], None, spent)
        case.study("foretold, after 60 ms: largest way of a brick [m]", f"{FOOT}, fall of 1.0 m, {words}", way.max(), None, spent)
case.finish()
