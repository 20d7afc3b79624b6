"""V12: a joint driven through load and unload; V13: dragged, it sticks, then slips. The blocks move as rigid bodies."""

import math

import numpy
from coplanetest import Case

case = Case("V12", __file__)
recipe = case.load("mesh.yaml")
area, k, c_m = 0.1, 1e11, 2e-4  # [m^2] per metre of depth, [Pa/m], [m]


def drive(name, legs, **joint):
    """Runs the upper block through legs of constant velocity: [(vx, vy, duration)]."""
    deck = case.load()
    expressions = []
    for axis in (0, 1):
        text, end = "0", sum(leg[2] for leg in legs)
        for leg in reversed(legs):
            text = f"t < {end!r} ? {leg[axis]!r} : ({text})"
            end -= leg[2]
        expressions.append(text)
    deck["conditions"].append({"type": "velocity", "node_set": "upper", "value": expressions + [0]})
    if joint:
        deck["joints"]["joint"] = joint
    deck["time"]["end"] = sum(leg[2] for leg in legs)
    run = case.run(name, recipe, deck)
    upper = run.results.nodes_of("upper")
    force = numpy.array([run.results.nodal("contact_force", s)[upper].sum(axis=0) for s in range(len(run.results.times))])
    rows = numpy.searchsorted(run.history["time"], run.results.times * (1 - 1e-12))
    return run.history, run.results.times, force / area, rows


def loading(c):
    return k * c / (1 - c / c_m)


def law(closures):
    """The load-unload curve along a path: hyperbola while the closure grows beyond all before, else its tangent."""
    most, tractions = 0.0, []
    for c in closures:
        most = max(most, c)
        tractions.append(max(0.0, loading(most) - k / (1 - most / c_m) ** 2 * (most - c)))
    return numpy.array(tractions)


# Closures in parts of c_m: load to a half, unload to the residual (1/2)^2, load to 0.8, open.
speed = 0.1
path = [0, 0.5, 0.25, 0.8, 0]
legs = [(0, -math.copysign(speed, b - a), abs(b - a) * c_m / speed) for a, b in zip(path, path[1:])]
h, times, traction, rows = drive("closure", legs)
closure = -h["upper_displacement_y"]
expected = law(closure)
error = numpy.max(numpy.abs(traction[:, 1] - expected[rows])) / numpy.max(expected)
case.check("traction against the curve, over its largest", error, 0, 1e-3)

ends = numpy.cumsum([leg[2] for leg in legs])
for part, leg, sigma in ((0.5, 0, 20e6), (0.25, 1, 0), (0.8, 2, 80e6)):
    row = int(numpy.argmin(numpy.abs(times - ends[leg])))
    case.check(f"closure at turn {leg + 1} [m]", closure[rows[row]], part * c_m, 1e-3 * c_m)
    # A closure that is off by one step of speed dt = 2e-7 m shifts the traction by up to k_t times that.
    slope = k / (1 - max(0.5, part)) ** 2
    case.check(f"traction at turn {leg + 1} [Pa]", traction[row, 1], sigma, slope * speed * 2e-6)
# Work per area of loading to x = c / c_m: k c_m^2 (-x - ln(1 - x)); given back: k c_m^2 x^2 / 2.
x = numpy.max(closure) / c_m
lost = k * c_m**2 * (-x - math.log(1 - x) - x * x / 2) * area
case.check("hysteresis at the end [J]", h["contact_hysteresis"][-1], lost, 1e-3, relative=True)
case.check("stored at the end [J]", h["contact_stored"][-1], 0, 1e-9)
# The balance of this plane: what was put in is lost, stored or in the remainder.
case.check("remainder over the work put in", numpy.max(numpy.abs(h["contact_remainder"])) / lost, 0, 1e-3)

case.name = "V13"
normal, shear, friction = 1e11, 5e10, 0.6
joint = {"model": "linear", "normal_stiffness": normal, "shear_stiffness": shear, "friction": friction}
sigma = 2e6
down, drag = sigma / normal, 1e-4  # [m]
legs = [(0, -0.1, down / 0.1), (0.1, 0, drag / 0.1), (-0.1, 0, drag / 0.1)]
h, times, traction, rows = drive("drag", legs, **joint)
strength = friction * sigma
moved, expected = 0.0, []
for step in numpy.diff(h["upper_displacement_x"], prepend=0):
    moved = min(max(moved - shear * step, -strength), strength)
    expected.append(moved)
expected = numpy.array(expected)
late = h["upper_displacement_x"][rows] != 0
case.check("shear traction against stick and slip [Pa]",
           numpy.max(numpy.abs(traction[late, 0] - expected[rows][late])) / strength, 0, 1e-3)
case.check("plateau [Pa]", -numpy.min(traction[:, 0]), strength, 1e-3, relative=True)
case.check("plateau, back [Pa]", numpy.max(traction[:, 0]), strength, 1e-3, relative=True)
# Sticking takes tau / k_s of the way out; and twice that on the way back, where the traction first turns round.
slip = (drag - strength / shear) + (drag - 2 * strength / shear)
case.check("friction work [J]", h["contact_friction"][-1], strength * area * slip, 2e-3, relative=True)
case.finish()
