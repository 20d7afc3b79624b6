"""V51: a slender block rocks on a rigid floor (Housner 1963); V58: the same in other frames."""

import copy
import math
import sys

import numpy
from coplanetest import Case, rotation, turned_deck
from coplanetest.rocking import rocking

from coplane import Deck, record
from coplane.documents import parse, text

case = Case("V51", __file__)
width, height, g = 0.3, 1.2, 9.81
alpha = math.atan(width / height)
frequency = math.sqrt(3 * g / (2 * math.hypot(width, height)))  # p of Housner: p^2 = 3 g / (4 R) [1/s]
recipe = case.load("exodus_inputs/rocking_block_2d/mesh.yaml")


def quarter_period(start):
    """Time from rest at the tilt `start` alpha until the block stands, turning about a corner [s].

    I th'' = -m g R sin(alpha - th) with I = 4/3 m R^2, so th'^2 / 2 = p^2 (cos(alpha - th0) - cos(alpha - th)).
    With th = th0 (1 - s^2) the integrand of t = int dth / th' is smooth; Gauss and Legendre, 40 points.
    """
    th0 = start * alpha
    points, weights = numpy.polynomial.legendre.leggauss(40)
    s = (points + 1) / 2
    difference = numpy.cos(alpha - th0) - numpy.cos(alpha - th0 * (1 - s**2))
    return float(numpy.sum(weights / 2 * 2 * th0 * s / (frequency * numpy.sqrt(2 * difference))))


def energy(angle):
    """Of the rigid block at rest, over m g R; 0 when it stands."""
    return math.cos(alpha - abs(angle)) - math.cos(alpha)


def tilted(start, feet=False):
    """Turned clockwise by `start` alpha about the right corner of its base. `feet`: the floor reaches only under
    the outer eighths of the base.
    """
    changed = copy.deepcopy(recipe)
    floor, block = changed["parts"]
    if start:
        block.update(rotate=-math.degrees(start * alpha), about=[width, 0])
    if feet:
        left = dict(floor, size=[0.3 + width / 8, 0.1])
        changed["parts"] = [left, dict(left, min=[width * 7 / 8, -0.1]), block]
    return changed


def angles(run, start):
    """Clockwise turn of the line from a corner of the base to the corner above it [rad]."""
    h = run.history
    across = h["head_displacement_x"] - h["foot_displacement_x"] + height * math.sin(start * alpha)
    up = h["head_displacement_y"] - h["foot_displacement_y"] + height * math.cos(start * alpha)
    return numpy.arctan2(across, up)


def rock(name, start, end, damping=1.5, feet=False, report=False, rigid=False, **contact):
    """Lets the block go; returns the part of the energy left after the first impact, where the run is long enough."""
    deck = case.load("exodus_inputs/rocking_block_2d/deck.yaml")
    deck["time"]["end"] = end
    deck["contact"]["damping"]["normal"] = damping
    deck["contact"].update(contact)
    for block in deck["blocks"].values():
        block["rigid"] = rigid
    run = case.run(name, tilted(start, feet), deck)
    times, turn = run.history["time"], angles(run, start)
    case.check(f"{name}: tilt at the start over alpha", turn[0] / alpha, start, 1e-9)
    after = int(numpy.argmax(turn < 0))
    crossing = times[after - 1] + (times[after] - times[after - 1]) * turn[after - 1] / (turn[after - 1] - turn[after])
    case.check(f"{name}: quarter period [s]", crossing, quarter_period(start), 0.04, relative=True, report=report)
    peak = after + int(numpy.argmin(turn[after:]))
    left = energy(turn[peak]) / energy(start * alpha)
    return left if peak < len(turn) - 1 else None


housner = (1 - 1.5 * math.sin(alpha) ** 2) ** 2
case.check("quarter period after Housner's linear equation [s]", math.acosh(1 / (1 - 0.5)) / frequency, quarter_period(0.5), 0.005, relative=True)
rock("quarter", 0.25, 0.26)
rock("three_quarters", 0.75, 0.65)
rock("rigid_quarter", 0.25, 0.26, rigid=True)
rigid = rock("rigid_half", 0.5, 0.85, rigid=True)
case.check_within("rigid_half: energy left after the first impact", rigid, housner, 1)
full = rock("half", 0.5, 0.85)
case.check_within("half: energy left after the first impact", full, housner, 1)

if "all" in sys.argv[1:]:
    more = rock("more_damping", 0.5, 0.85, damping=4.5)
    case.check_within("more_damping: energy left after the first impact", more, housner, full)
    feet = rock("feet", 0.5, 0.85, feet=True)
    case.check_within("feet: energy left after the first impact", feet, 0.83, 0.95)
    left = rock("centroid", 0.5, 0.85, weights="centroid", report=True)
    case.check("centroid: energy left after the first impact, against pressure weights", left, full, 0.02, report=True)

    # A floor that is accelerated evenly, after a rise of 0.4 s. A rigid block rocks beyond g tan(alpha). On a bed of
    # stiffness k it stands on a strip of width w at its edge with W = k th w^2 / 2, so the arm of W is
    # b - w/3 - h th, at most 0.897 b at th = 0.0086.
    weight, stiffness = 2300 * width * height * g, 2e9
    turns = numpy.linspace(1e-4, 0.05, 5000)
    arm = numpy.max(width / 2 - numpy.sqrt(2 * weight / (stiffness * turns)) / 3 - height / 2 * turns) / (width / 2)
    case.check("least acceleration on the bed over g tan(alpha)", arm, 0.897, 1e-3)
    for part, low, high in ((0.87, 0, 0.1), (1.05, 0.3, math.inf)):
        deck = case.load("exodus_inputs/rocking_block_2d/deck.yaml")
        deck["contact"]["damping"]["normal"] = 0.75
        a = part * g * math.tan(alpha)
        deck["conditions"] = [{"type": "velocity", "node_set": "floor",
                               "value": [f"t < 0.4 ? {a!r}*t*t/0.8 : {a!r}*(t - 0.2)", 0, 0]}]
        deck["time"]["end"] = 1.4
        run = case.run(f"base_{part}", tilted(0), deck)
        turn = numpy.max(numpy.abs(angles(run, 0))) / alpha
        case.check_within(f"base_{part}: largest tilt over alpha", turn, low, high)

# --- under a record: Housner's equation of motion, with the loss at impacts that a free swing on the same bed has ---------------
free, deck = case.load("tests/validation/shaken_block/mesh.yaml"), case.load("tests/validation/shaken_block/deck.yaml")
deck["joints"]["base"]["normal_stiffness"] = 1e11
deck["contact"]["damping"]["normal"] = math.sqrt(2)
shaken = copy.deepcopy(free)
free["parts"][1].update(rotate=-math.degrees(0.5 * alpha), about=[width, 0])
for name in ("foot", "head"):
    where = free["node_sets"][name]
    where["where_own"] = where.pop("where")
deck["gravity"], deck["time"]["end"] = [0, -g, 0], 0.75
run = case.run("free", free, deck)
left = energy(angles(run, 0.5).min()) / energy(0.5 * alpha)
case.check_within("free: energy left after the first impact", left, housner, 1)

times = numpy.arange(0, 2.9, 5e-3)
waves = sum(a * numpy.sin(2 * numpy.pi * f * times + phase) for f, a, phase in ((0.9, 0.59, 1.49), (1.4, 1.3, 3.67), (2.1, 0.59, 2.73), (3.3, 0.98, 1.01)))
ground = record.Record(times, waves * numpy.minimum(times / 0.15, 1) * numpy.exp(-times / 1.2)).scaled(peak=6.0).corrected()
begin = 0.1  # the block stands by then
deck["gravity"], deck["time"]["end"] = [0, f"-{g}*min(t/0.05, 1)", 0], begin + float(times[-1])
deck["conditions"] = [{"type": "fixed", "node_set": "floor", "components": ["y"]}]
told = Deck.from_text(text(deck))
ground.shake(told, "floor", axis="x", start=begin)
run = case.run("record", shaken, parse(told.text), load=2300 * g * (width * height + 0.3))
exact_times, exact = rocking(lambda t: float(numpy.interp(t, ground.times, ground.acceleration)), times[-1], alpha, frequency, g, math.sqrt(left), step=5e-4)
late = run.history["time"] > begin
turn = angles(run, 0)[late]
exact = numpy.interp(run.history["time"][late] - begin, exact_times, exact)
case.check_within("record: impacts", int(numpy.sum(turn[1:] * turn[:-1] < 0)), 5, 20)
case.check("record: largest tilt over alpha", numpy.max(numpy.abs(turn)) / alpha, numpy.max(numpy.abs(exact)) / alpha, 0.03, relative=True)
case.check("record: tilt, largest difference over the largest tilt", numpy.max(numpy.abs(turn - exact)) / numpy.max(numpy.abs(exact)), 0, 0.06)

# --- V58: other frames, while the block turns about its corner ---------------------------------------
case.name = "V58"
deck = case.load("exodus_inputs/rocking_block_2d/deck.yaml")
deck["time"]["end"] = 0.3
plain = case.run("plain", tilted(0.5), deck).results
for frame, angles_of_frame, offset in (("turned", 30, (0, 0, 0)), ("moved by 1 km", 0, (1000, -1000, 0))):
    matrix = rotation(angles_of_frame)

    def change(coordinates):
        return coordinates @ matrix[:2, :2].T + numpy.array(offset[:2])

    run = case.run(frame.split()[0], tilted(0.5), turned_deck(deck, matrix, offset), change_mesh=change)
    for field in ("displacement", "velocity"):
        back = run.results.nodal(field) @ matrix[:2, :2]
        error = numpy.max(numpy.abs(back - plain.nodal(field))) / numpy.max(numpy.abs(plain.nodal(field)))
        case.check(f"rocking block, {frame}: {field}", error, 0, 1e-8)

wind = numpy.array([100, -100])
deck["initial"] = [{"block": block, "velocity": [*wind.tolist(), 0]} for block in ("floor", "block")]
deck["conditions"] = [{"type": "velocity", "node_set": "floor", "value": [*wind.tolist(), 0]}]
flown = case.run("galilean", tilted(0.5), deck).results
for field, common in (("displacement", wind * flown.times[-1]), ("velocity", wind)):
    error = numpy.max(numpy.abs(flown.nodal(field) - common - plain.nodal(field))) / numpy.max(numpy.abs(plain.nodal(field)))
    case.check(f"rocking block, seen from 100 m/s: {field}", error, 0, 1e-8)
case.finish()
