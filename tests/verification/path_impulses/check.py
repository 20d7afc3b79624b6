"""Impulses along the path of a step: what bounces keeps its energy, and lines of the mesh are passed as if there were none."""

import itertools
import math
import sys

import numpy
from coplanetest import Case

case = Case("path_impulses", __file__)
full = "all" in sys.argv[1:]
soft = {"model": "linear_elastic", "density": 2000, "youngs_modulus": 1e8, "poisson_ratio": 0.2}
# The law has an energy of its own, so that what is lost is lost by contact.
rubber = {"model": "neo_hookean", "density": 2000, "youngs_modulus": 1e8, "poisson_ratio": 0.2}
quiet = {"linear": 0, "quadratic": 0}


def box(block, low, size, divisions, **more):
    return {"shape": "box", "block": block, "min": low, "size": size, "divisions": divisions, **more}


def turning(name, center, n, dimension):
    """A motion of its own for each body."""
    return {"block": name, "velocity": [1.5 * math.cos(7 * n), 1.5 * math.sin(5 * n), math.sin(3 * n) * (dimension - 2)],
            "angular_velocity": [math.sin(n) * (dimension - 2), math.cos(2 * n) * (dimension - 2), 3 * math.cos(n)], "center": center}  # fmt: skip


# --- Blocks that tumble in a box, without friction, damping or viscosity ----------------------------------------
def tumbling(dimension, rigid, start):
    """Four squares and a box of four long blocks around them; or two cubes between six plates."""
    wall, inside = 0.1, 0.8
    parts, names, initial = [], [], []
    for axis, upper in itertools.product(range(dimension), (False, True)):
        low, size = [0.0] * dimension, [inside] * dimension
        low[axis], size[axis] = (inside if upper else -wall), wall
        parts.append(box(f"wall_{axis}_{int(upper)}", low, size, [1 if a == axis else 4 for a in range(dimension)]))
    walls = [part["block"] for part in parts]
    places = [(0.2, 0.2), (0.6, 0.22), (0.2, 0.58), (0.58, 0.6)] if dimension == 2 else [(0.25, 0.25, 0.3), (0.55, 0.5, 0.45)]
    for n, place in enumerate(places):
        side, center = (0.16 if dimension == 2 else 0.2), [*place, 0.0][:3]
        names.append(f"block_{n}")
        turn = 13.0 * (n + 1) if dimension == 2 else [13.0 * (n + 1), 20.0, 5.0 - 31.0 * n]
        parts.append(box(names[-1], [c - side / 2 for c in place], [side] * dimension, [2] * dimension, rotate=turn, about=list(place)))
        initial.append(turning(names[-1], center, n + 1 + start, dimension))
    deck = {
        "materials": {"rubber": rubber},
        "blocks": {**{name: {"material": "rubber", "rigid": True} for name in walls}, **{name: {"material": "rubber", "rigid": rigid} for name in names}},
        "conditions": [{"type": "rigid_motion", "block": name, "velocity": [0, 0, 0], "angular_velocity": [0, 0, 0]} for name in walls],
        "initial": initial, "viscosity": quiet, "time": {"end": 1.0 if dimension == 2 else 0.5},
    }  # fmt: skip
    return {"dimension": dimension, "parts": parts}, deck


lost, factors = {}, (0.8, 0.4) if full else (0.8,)
for dimension, rigid, start in itertools.product((2, 3), (False, True), range(6 if full else 3)):
    recipe, deck = tumbling(dimension, rigid, start)
    kind = f"{dimension}D, {'rigid' if rigid else 'elastic'}"
    for impulses in ("leapfrog", "path"):
        deck["contact"] = {"impulses": impulses}
        for factor in factors:
            deck["time"].update(step_factor=factor, energy_tolerance=0.1)
            folder = f"boxes_{dimension}_{int(rigid)}_{start}_{impulses}_{factor:g}"
            run = case.run(folder, recipe, deck, energy=0.1)
            h = run.history
            left = numpy.abs(h["contact_remainder"]) / h["kinetic"].max()
            lost.setdefault((kind, impulses, factor), []).append((float(left[-1]), float(numpy.max(left))))
            if (impulses, factor, start) == ("path", 0.8, 0):
                case.check_equal(f"{folder}: contacts", bool(h["contact_stored"].max() > 0.01 * h["kinetic"].max()), True)
                case.same_bits(folder, recipe, deck, run, ranks=3, threads=2)
                case.restarts(folder, recipe, deck, run, 0.37 * deck["time"]["end"], ranks=2)
for kind in sorted({kind for kind, *_ in lost}):
    for factor in factors:
        ends, path = (numpy.median(lost[kind, which, factor], axis=0) for which in ("leapfrog", "path"))
        name = f"{kind}, step factor {factor:g}"
        case.check(f"{name}: contact remainder at the end, median of the motions", float(path[0]), 0, 2e-4)
        case.check(f"{name}: over that of the leapfrog rule", float(path[0] / ends[0]), 0, 0.2)
        case.check(f"{name}: the largest at any time, median of the motions", float(path[1]), 0, 5e-3)  # what is owed is paid later


# --- Blocks that ring on each other under their weight, and in a row with gaps: contacts begin and end all the time --------
def ringing(row):
    """Four blocks on a rigid floor, gravity at once; or three between rigid walls, 0.1 mm apart, the first of them thrown."""
    gap, names = 1e-4, [f"block_{n}" for n in range(3 if row else 4)]
    if row:
        rigid = [box("left", [-0.1, -0.05], [0.1, 0.3], [1, 3]), box("right", [3 * 0.2 + 4 * gap, -0.05], [0.1, 0.3], [1, 3])]
        parts = [box(name, [n * 0.2 + (n + 1) * gap, 0.0], [0.2, 0.2], [3, 3]) for n, name in enumerate(names)]
    else:
        rigid = [box("floor", [-1.0, -0.1], [2.0, 0.1], [10, 1])]
        parts = [box(name, [-0.15, 0.2 * n], [0.3, 0.2], [4, 2]) for n, name in enumerate(names)]
    walls = [part["block"] for part in rigid]
    deck = {
        "materials": {"rubber": rubber},
        "blocks": {**{name: {"material": "rubber", "rigid": True} for name in walls}, **{name: {"material": "rubber"} for name in names}},
        "conditions": [{"type": "rigid_motion", "block": name, "velocity": [0, 0, 0], "angular_velocity": [0, 0, 0]} for name in walls],
        "viscosity": quiet, "time": {"end": 1.0, "step_factor": 0.8, "energy_tolerance": 0.5},
        "history": {"every": 1e-2}, "output": {"planes": False},
        "contact": {"impulses": "path"},
    }  # fmt: skip
    deck.update({"initial": [{"block": names[0], "velocity": [1.0, 0.0, 0.0]}]} if row else {"gravity": [0, -9.81, 0]})
    return {"dimension": 2, "parts": [*rigid, *parts]}, deck


for row, most in ((False, 0.03), (True, 0.06)):
    recipe, deck = ringing(row)
    name = "a row with gaps" if row else "a stack"
    run = case.run("row" if row else "stack", recipe, deck, energy=0.5)
    h = run.history
    play = float(numpy.max(h["kinetic"] + h["internal"] + h["contact_stored"]))
    case.check(f"{name}: contact remainder over the largest energy in play, of all times", float(numpy.max(numpy.abs(h["contact_remainder"]))) / play, 0, most)

# --- A corner that lands over a line of the mesh, or a seam; and the same turned, mirrored, flying past ---------
def landing(tilt, off, cut, angle=0.0, mirrored=False, drift=(0.0, 0.0)):
    """A square of 0.3 m falls on its corner; `off` from the middle of a rigid slab in one part or two."""
    slabs = [(-0.4, 0.4, "left"), (0.0, 0.4, "right")] if cut else [(-0.4, 0.8, "left")]
    parts = [box("falling", [0, 10], [0.3, 0.3], [2, 2])] + [box(name, [x, -0.1], [wide, 0.1], [round(wide / 0.1), 1]) for x, wide, name in slabs]
    side = -1 if mirrored else 1

    def turn(points, degrees):
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        return points @ numpy.array([[c, s], [-s, c]])

    def place(x):
        mine = x[:, 1] > 5
        square = turn(x[mine] - [0.15, 10.15], side * tilt)
        x[mine] = square - square[numpy.argmin(square[:, 1])] + [side * off, 2e-3]
        return turn(x, angle)

    fall = (turn(numpy.array([0.0, -1.0]), angle) + drift).tolist()
    names = [name for *_, name in slabs]
    deck = {
        "materials": {"soft": soft}, "blocks": {"falling": {"material": "soft"}, **{name: {"material": "soft", "rigid": True} for name in names}},
        "conditions": [{"type": "rigid_motion", "block": name, "velocity": [*drift, 0], "angular_velocity": [0, 0, 0]} for name in names],
        "initial": [{"block": "falling", "velocity": [*fall, 0]}, *({"block": name, "velocity": [*drift, 0]} for name in names)],
        "viscosity": quiet, "contact": {"impulses": "path"}, "time": {"end": 0.06}, "history": {"probes": [{"name": "falling", "block": "falling"}]},
    }  # fmt: skip

    def after(h):
        velocity = turn(numpy.array([h[f"falling_velocity_{axis}"][-1] for axis in "xy"]) - drift, -angle)
        return velocity * [side, 1]

    return {"dimension": 2, "parts": parts}, deck, place, after


for tilt, off in ((45, 3e-3), (30, 0.0), (20, 0.0), (10, -3e-3)):
    found = {}
    for name, told in {
        "whole": {}, "cut": {"cut": True}, "turned": {"cut": True, "angle": 37.3}, "mirrored": {"mirrored": True}, "drifting": {"drift": (3.0, -2.0)}, "finer": {}
    }.items():  # fmt: skip
        recipe, deck, place, after = landing(tilt, off, **{"cut": False, **told})
        if name == "finer":
            deck["time"]["step_factor"] = 0.1
        run = case.run(f"corner_{tilt}_{name}", recipe, deck, change_mesh=place, energy=2e-3)
        found[name] = after(run.history)
        if name == "whole":
            case.check(f"corner at {tilt} degrees: contact remainder", run.history["contact_remainder"][-1] / run.history["kinetic"][0], 0, 2e-4)
        if name == "cut":
            case.same_bits(f"corner_{tilt}_cut", recipe, deck, run, ranks=3, threads=2, change_mesh=place)
    for name, most in {"cut": 2e-4, "turned": 2e-4, "mirrored": 1e-12, "drifting": 1e-12, "finer": 2e-4}.items():
        case.check(f"corner at {tilt} degrees, {name}: velocity against the whole", float(numpy.linalg.norm(found[name] - found["whole"])), 0, most)
case.finish()
