"""Contact of bodies of revolution by forces from one potential: cones whose tips lie on the axis, and a core that slides through rings."""

import copy

import numpy
from coplanetest import Case

case = Case("ring_contacts", __file__)

STONE = {"model": "linear_elastic", "density": 2000, "youngs_modulus": 1e9, "poisson_ratio": 0.2}


def cone(slope, n, step_factor, mirrored=False, moved=0.0, drift=0.0, friction=0.0, **parts):
    """A cone that strikes a plate at 20 m/s with its tip on the axis; a recipe and a deck."""
    way = -1 if mirrored else 1

    def corners(*points):
        points = [[x, way * y + moved] for x, y in points]
        return points[::-1] if mirrored else points

    recipe = {
        "dimension": 2,
        "parts": [
            {"shape": "quadrilateral", "block": "cone", "corners": corners([0, 0.001], [0.2, 0.001 + 0.2 * slope], [0.2, 0.5], [0, 0.5]), "divisions": [n, 2 * n], **parts},
            {"shape": "quadrilateral", "block": "plate", "corners": corners([0, -0.2], [0.4, -0.2], [0.4, 0], [0, 0]), "divisions": [2 * n, n], **parts},
        ],
    }  # fmt: skip
    deck = {
        "geometry": "axisymmetric",
        "materials": {"stone": STONE},
        "blocks": {"cone": {"material": "stone"}, "plate": {"material": "stone"}},
        "joints": {"touch": {"model": "penalty", "friction": friction}},
        "contact": {"default_joint": "touch"},
        "initial": [{"block": "cone", "velocity": [0, drift - 20 * way, 0]}, {"block": "plate", "velocity": [0, drift, 0]}],
        "time": {"end": 3e-3, "step_factor": step_factor},
        "output": {"every": 3e-3, "planes": False},
        "history": {"every": 1e-4},
    }
    return recipe, deck


def lost(run):
    """What contact has lost without a name, over the energy that strikes."""
    return abs(run.history["contact_remainder"][-1]) / STRIKES


# Kinetic energy of the cone, which a drift does not change.
STRIKES = None
for slope in (1.0, 0.5, 0.2):
    for n in (2, 4, 8):
        found = {}
        for step_factor in (0.8, 0.4):
            recipe, deck = cone(slope, n, step_factor)
            run = case.run(f"cone_{slope}_{n}_{step_factor}", recipe, deck)
            STRIKES = run.history["kinetic"][0]
            found[step_factor] = lost(run)
            case.check(f"cone, slope {slope:g}, {n} elements: contact remainder at a step factor of {step_factor:g}", found[step_factor], 0, 4e-4 if step_factor == 0.8 else 1e-4)
    case.same_bits(f"cone_{slope}_8_0.4", recipe, deck, run, ranks=3)

# The same in other words. Velocities are compared, by the speed of the cone.
recipe, deck = cone(0.5, 4, 0.8, friction=0.4)
plain = case.run("plain", recipe, deck)
STRIKES = plain.history["kinetic"][0]
velocity = [plain.results.nodal(f"velocity_{axis}") for axis in "xy"]
for name, how, way, drift, bound in (("mirrored", {"mirrored": True}, -1, 0, 1e-9), ("moved", {"moved": 7.3}, 1, 0, 1e-9), ("drifting", {"drift": 5.0}, 1, 5, 1e-9)):
    again = case.run(name, *cone(0.5, 4, 0.8, friction=0.4, **how))
    other = [again.results.nodal(f"velocity_{axis}") for axis in "xy"]
    other[1] = way * (other[1] - drift)
    # Meshes that are mirrored have their nodes in another order: places tell them.
    order = numpy.lexsort(numpy.round([plain.results.coordinates[:, 1], plain.results.coordinates[:, 0]], 9))
    places = again.results.coordinates * [1, way] - [0, how.get("moved", 0)]
    theirs = numpy.lexsort(numpy.round([places[:, 1], places[:, 0]], 9))
    off = max(numpy.abs(a[order] - b[theirs]).max() for a, b in zip(velocity, other))
    case.check(f"cone with friction, {name}: largest difference of velocities over 20 m/s", off / 20, 0, bound)
case.check("cone with friction: contact remainder", lost(plain), 0, 4e-4)
case.restarts("plain", recipe, deck, plain, 1.5e-3)

# A core slides along the axis through a sleeve that is squeezed on it, of one ring or of five with flush seams.
SLEEVE = {"model": "linear_elastic", "density": 2000, "youngs_modulus": 1e8, "poisson_ratio": 0.2}


def sleeve(seams, friction, rows, end):
    ends = [-0.2, *seams, 1.0]
    recipe = {
        "dimension": 2,
        "parts": [{"shape": "box", "block": "core", "min": [0, 0], "size": [0.1, 0.2], "divisions": [4, 8]}]
        + [{"shape": "box", "block": "sleeve", "min": [0.1, low], "max": [0.15, high], "divisions": [2, round((high - low) / 1.2 * rows)]} for low, high in zip(ends, ends[1:])],
        "node_sets": {"outside": {"block": "sleeve", "where": {"x": 0.15}}},
    }  # fmt: skip
    deck = {
        "geometry": "axisymmetric",
        "materials": {"sleeve": SLEEVE},
        "blocks": {"core": {"material": "sleeve"}, "sleeve": {"material": "sleeve"}},
        "joints": {"touch": {"model": "penalty", "friction": friction}, "seam": {"model": "penalty"}},
        "contact": {"default_joint": "touch", "pairs": [{"blocks": ["sleeve", "sleeve"], "joint": "seam"}]},
        "conditions": [{"type": "displacement", "node_set": "outside", "components": ["x", "y"], "value": ["-1e-5*min(t/5e-3, 1)", 0, 0]}],
        "initial": [{"block": "core", "velocity": [0, 3, 0]}],
        "time": {"end": end},
        "output": {"every": end, "planes": False},
        "history": {"every": end / 200, "joints": ["touch"]},
    }
    return recipe, deck


for friction, end in ((0.0, 0.13), (0.3, 0.03)):
    speeds = {}
    for name, seams, rows in (("one ring", [], 24), ("five rings", [0.1, 0.25, 0.45, 0.7], 24), ("five rings, other elements", [0.1, 0.25, 0.45, 0.7], 41)):
        recipe, deck = sleeve(seams, friction, rows, end)
        run = case.run(f"sleeve_{friction:g}_{name}", recipe, deck, energy=2e-3)
        h = run.history
        mass = h["momentum_y"][0] / 3
        speeds[name] = run.results.nodal("velocity_y")[run.results.connectivity("core")].mean()
        force = h["touch_normal_force"]
        if friction == 0:
            case.check(f"{name}: speed of the core behind the seams [m/s]", speeds[name], 3, 1e-3)
        else:
            times = h["time"]
            pressed = numpy.sum(0.5 * (force[1:] + force[:-1]) * numpy.diff(times))
            case.check(f"{name}, friction {friction:g}: change of the core's momentum over its friction", mass * (3 - speeds[name]) / (friction * pressed), 1, 0.01)
    if friction == 0:
        case.same_bits("sleeve", recipe, deck, run)
case.finish()
