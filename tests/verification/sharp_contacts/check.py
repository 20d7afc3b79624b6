"""Corners beside seams, edges that cross, needles, bonds that break while tilted: nothing of it makes energy or depends on a cut."""

import math
import random
import sys

import numpy
from coplanetest import Case

case = Case("sharp_contacts", __file__)
full = "all" in sys.argv[1:]
soft = {"model": "linear_elastic", "density": 2000, "youngs_modulus": 1e8, "poisson_ratio": 0.2}
quiet = {"linear": 0, "quadratic": 0}


def turned(points, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return points @ numpy.array([[c, s], [-s, c]])


# --- A corner that lands beside a seam of two flush slabs, or over a line of the mesh --------------------
def landing(cut, tilt, off, speed):
    """A square of 0.3 m falls on its corner; `off` from the middle of a rigid slab in one part or two."""
    parts = [(-0.4, 0.4, "left"), (0.0, 0.4, "right")] if cut else [(-0.4, 0.8, "left")]
    recipe = {
        "dimension": 2,
        "parts": [{"shape": "box", "block": "falling", "min": [0, 10], "size": [0.3, 0.3], "divisions": [2, 2]}]
        + [
            {"shape": "box", "block": name, "min": [x, -0.1], "size": [wide, 0.1], "divisions": [round(wide / 0.1), 1]}
            for x, wide, name in parts
        ],
    }

    def place(x):
        mine = x[:, 1] > 5
        square = turned(x[mine] - [0.15, 10.15], tilt)
        x[mine] = square - square[numpy.argmin(square[:, 1])] + [off, 2e-3 * speed]
        return x

    deck = {
        "materials": {"soft": soft},
        "blocks": {"falling": {"material": "soft"}, **{name: {"material": "soft", "rigid": True} for *_, name in parts}},
        "conditions": [
            {"type": "rigid_motion", "block": name, "velocity": [0, 0, 0], "angular_velocity": [0, 0, 0]} for *_, name in parts
        ],
        "initial": [{"block": "falling", "velocity": [0, -speed, 0]}],
        "viscosity": quiet,
        "time": {"end": 0.06 / speed**0.7},
        "history": {"probes": [{"name": "falling", "block": "falling"}]},
    }
    return recipe, deck, place


for tilt, off, speed in (
    (45, 5e-4, 0.01), (45, 3e-3, 1.0), (30, 0.0, 0.01), (30, -3e-3, 1.0), (20, 0.0, 1.0), (10, -3e-3, 1.0), (5, 3e-3, 0.01)
):
    name = f"corner {tilt} degrees, {off:g} m off, {speed:g} m/s"
    after = []
    for cut in (False, True):
        recipe, deck, place = landing(cut, tilt, off, speed)
        folder = f"corner_{tilt}_{off:g}_{speed:g}_{'cut' if cut else 'whole'}"
        run = case.run(folder, recipe, deck, change_mesh=place, energy=2e-3)
        h = run.history
        energy = h["kinetic"][0]
        # Of the second order in the step: 1e-7 at 0.01 m/s, where contacts last long, 9e-4 at 1 m/s.
        case.check(f"{name}, {'two slabs' if cut else 'one slab'}: contact remainder", h["contact_remainder"][-1] / energy, 0, 2e-3)
        after.append([h[f"falling_velocity_{axis}"][-1] / speed for axis in "xy"])
        case.check(f"{name}, {'two slabs' if cut else 'one slab'}: velocity aside", after[-1][0], 0, 1e-3)
    case.check(f"{name}: two slabs against one", float(numpy.linalg.norm(numpy.subtract(*after))), 0, 1e-4)
    if speed == 1.0 and tilt in (45, 20):
        case.same_bits(folder, recipe, deck, run, ranks=3, threads=2, change_mesh=place)


# --- A corner that lands near the end of a slab ---------------------------------------------------------------
# A side of the square and the end of the slab face each other, one behind the other, and share what the corner dips in. Where the end is far
# that is no contact, as the way out is up; where it is near, the corner slips over it. Both ways, nothing is made or lost.
def near_end(end, tilt):
    """As landing(), on a slab that ends so far to the left of the corner."""
    recipe, deck, place = landing(False, tilt, 0.0, 1.0)
    recipe["parts"][1].update(min=[-end, -0.1], size=[end + 0.4, 0.1], divisions=[5, 1])
    deck["time"]["step_factor"] = 0.2 if end > 5e-3 else 0.1  # of the second order; slipping over takes few steps
    return recipe, deck, place


for tilt in (-80, -60, -40, -20, -8, 8, 20, 40) if full else (-60, -40, -20, 20):
    after = []
    for end in (0.4, 0.02, 9e-3, 3e-3):
        name = f"corner {tilt} degrees, {1e3 * end:g} mm from the end"
        recipe, deck, place = near_end(end, tilt)
        run = case.run(f"end_{tilt}_{end:g}", recipe, deck, change_mesh=place, energy=2e-3)
        h = run.history
        case.check(f"{name}: contact remainder", h["contact_remainder"][-1] / h["kinetic"][0], 0, 2e-3)
        after.append(numpy.array([h[f"falling_velocity_{axis}"][-1] for axis in "xy"]))
        if end == 0.02 and tilt != -8:  # at -8 degrees the next corner, too, lands on the wide slab
            case.check(f"{name}: against a wide slab", float(numpy.linalg.norm(after[-1] - after[0])), 0, 1e-3)
    if abs(tilt) == 40:
        case.same_bits(f"end_{tilt}_{end:g}", recipe, deck, run, ranks=3, threads=2, change_mesh=place)


def near_corner(off, turns):
    """The same in three dimensions: a cube of 0.3 m falls on its corner beside that of a rigid slab."""
    recipe = {
        "dimension": 3,
        "parts": [
            {"shape": "box", "block": "falling", "min": [0, 0, 10], "size": [0.3, 0.3, 0.3], "divisions": [2, 2, 2]},
            {"shape": "box", "block": "slab", "min": [-off[0], -off[1], -0.1], "size": [0.4, 0.4, 0.1], "divisions": [3, 4, 1]},
        ],
    }

    def place(x):
        mine = x[:, 2] > 5
        cube = x[mine] - [0.15, 0.15, 10.15]
        cube[:, [0, 1]] = turned(cube[:, [0, 1]], turns[0])
        cube[:, [1, 2]] = turned(cube[:, [1, 2]], turns[1])
        cube[:, [2, 0]] = turned(cube[:, [2, 0]], turns[2])
        x[mine] = cube - cube[numpy.argmin(cube[:, 2])] + [0, 0, 2e-3]
        return x

    deck = {
        "materials": {"soft": soft},
        "blocks": {"falling": {"material": "soft"}, "slab": {"material": "soft", "rigid": True}},
        "conditions": [{"type": "rigid_motion", "block": "slab", "velocity": [0, 0, 0], "angular_velocity": [0, 0, 0]}],
        "initial": [{"block": "falling", "velocity": [0, 0, -1]}],
        "viscosity": quiet,
        "time": {"end": 0.06, "step_factor": 0.2},
    }
    return recipe, deck, place


for off, turns in (
    ((0.004, 0.006), (10, 20, 30)), ((0.004, 0.1), (10, 30, 5)), ((0.01, 0.003), (30, 40, -15)), ((0.002, 0.002), (45, -25, 40)), ((0.1, 0.005), (0, 20, 0.5)),
    ((0.0101, 0.0101), (1, -19, -40)), ((0.0052, 0.0101), (-17, -32, 18)), ((0.0091, 0.002), (0, -6, -27))
)[:: 1 if full else 2]:
    recipe, deck, place = near_corner(off, turns)
    folder = f"corner_3d_{off[0]:g}_{off[1]:g}"
    run = case.run(folder, recipe, deck, change_mesh=place, energy=2e-3)
    h = run.history
    name = f"cube {1e3 * off[0]:g} mm and {1e3 * off[1]:g} mm from the edges of a slab, turned by {turns}"
    case.check(f"{name}: contact remainder", h["contact_remainder"][-1] / h["kinetic"][0], 0, 2e-3)
    if off == (0.004, 0.006):
        case.same_bits(folder, recipe, deck, run, ranks=3, threads=2, change_mesh=place)


# --- Boxes that meet tip on tip: each pair of their faces shares a small square beside two edges, and the way out along the normal is as
# long as those over the edges. Something has to hold them, and no step may be so long that it misses where their shadows begin to meet.
diagonal = math.degrees(math.atan(math.sqrt(0.5)))  # after 45 degrees about x a cube stands on a corner


def rotation(angles):
    if numpy.ndim(angles) == 0:
        return numpy.array([[math.cos(math.radians(angles)), -math.sin(math.radians(angles))], [math.sin(math.radians(angles)), math.cos(math.radians(angles))]])
    result = numpy.eye(3)
    for (i, j), degrees in zip(((1, 2), (2, 0), (0, 1)), angles):
        one = numpy.eye(3)
        one[numpy.ix_([i, j], [i, j])] = rotation(degrees)
        result = one @ result
    return result


def tip_on_tip(sizes, angles, rigid, miss, speed):
    """`miss`: of the upper tip over 0.1 m along x; half of that along y."""
    dimension = len(sizes[0])
    parts, tips = [], []
    for block, size, turns, side in zip(("lower", "upper"), sizes, angles, (1, -1)):
        corners = 0.5 * numpy.array(numpy.meshgrid(*[(-x, x) for x in size])).reshape(dimension, -1).T @ rotation(turns).T
        tips.append(corners[numpy.argmax(side * corners[:, -1])])
        parts.append({"shape": "box", "block": block, "min": [-x / 2 for x in size], "size": size, "divisions": [1] * dimension, "about": [0] * dimension, "rotate": turns})
    offset = tips[0] - tips[1] + ([0.1 * miss, 1e-4] if dimension == 2 else [0.1 * miss, 0.05 * miss, 1e-4])
    parts[1]["offset"] = [float(x) for x in offset]
    deck = {"materials": {"stone": {"model": "linear_elastic", "density": 2300, "youngs_modulus": 30e9, "poisson_ratio": 0.2}},
            "blocks": {block: {"material": "stone", "rigid": bool(of)} for block, of in zip(("lower", "upper"), rigid)},
            "initial": [{"block": "upper", "velocity": [0, -speed, 0] if dimension == 2 else [0, 0, -speed]}], "viscosity": quiet,
            "time": {"end": 0.06 / speed}, "output": {"every": 0.002 / speed}, "history": {"probes": [{"name": block, "block": block} for block in ("lower", "upper")]}}  # fmt: skip
    return {"dimension": dimension, "parts": parts}, deck


def within(run, sizes, angles):
    """Most of the smaller box that was within the other one, by places that move with the upper one."""
    r, dimension = run.results, len(sizes[0])
    start = r.coordinates[:, :dimension]
    of = [numpy.unique(r.connectivity(block)) for block in ("lower", "upper")]
    places = numpy.random.default_rng(1).random((4000, dimension)) - 0.5
    most = 0
    for step in range(len(r.times)):
        now = start + r.nodal("displacement", step)[:, :dimension]
        middles = [now[nodes].mean(axis=0) for nodes in of]
        maps = [numpy.linalg.lstsq(start[nodes] - start[nodes].mean(axis=0), now[nodes] - middle, rcond=None)[0] for nodes, middle in zip(of, middles)]
        moved = places * sizes[1] @ rotation(angles[1]).T @ maps[1] + middles[1]
        seen = (moved - middles[0]) @ numpy.linalg.inv(maps[0]) @ rotation(angles[0])
        most = max(most, (numpy.abs(seen) < numpy.array(sizes[0]) / 2).all(axis=1).mean())
    return most * numpy.prod(sizes[1]) / min(numpy.prod(size) for size in sizes)


cube, plank, brick = [0.1] * 3, [0.05, 0.1, 0.2], [0.2, 0.1, 0.1]
tip, turned_tip = [45, diagonal, 0], [45, diagonal, 60]
scenes = [([size] * 2, angles, (1, 1), miss, speed) for size, angles in (([0.1] * 2, [45, 45]), (cube, [tip, tip]), (cube, [tip, turned_tip]))
          for miss in (0, 1e-3, 1e-2) for speed in (1, 20)]  # fmt: skip
scenes += [([cube] * 2, [tip, tip], (0, 0), miss, 5) for miss in (0, 1e-2)]
scenes += [([plank, cube], [tip, tip], (1, 0), 0, 5), ([brick, [0.1, 0.1, 0.05]], [tip, tip], (1, 1), 0, 5), ([[0.2, 0.1, 0.05], cube], [tip, tip], (0, 0), 5e-4, 5)]
chosen = len(scenes)
if full:
    draw = random.Random(7)
    for _ in range(60):
        dimension = draw.choice((2, 3, 3))
        some = [45, draw.uniform(0, 90)] if dimension == 2 else [tip, turned_tip, [45, 0, draw.choice((0, 90, 37))], [draw.uniform(0, 90) for _ in range(3)]]
        scenes.append(([[draw.choice((0.05, 0.1, 0.2)) for _ in range(dimension)] for _ in range(2)], [draw.choice(some) for _ in range(2)],
                       draw.choice(((1, 1), (1, 0), (0, 0))), draw.choice((0, 1e-4, 1e-3, 1e-2, 0.03)), draw.choice((0.5, 5, 20))))  # fmt: skip
compared = [([cube] * 2, [tip, tip], (1, 1), 1e-2, 20), ([plank, cube], [tip, tip], (1, 0), 0, 5)]
for number, scene in enumerate(scenes):
    sizes, angles, rigid, miss, speed = scene
    dimension, drawn = len(sizes[0]), number >= chosen
    recipe, deck = tip_on_tip(*scene)
    if drawn:
        deck["time"]["step_factor"] = 0.4
    kind = " and ".join(("elastic", "rigid")[of] for of in rigid)
    folder = f"tips_{number}"
    run = case.run(folder, recipe, deck, energy=5e-3)  # the step falls and rises while they touch
    h = run.history
    name = f"tip on tip {number}, {sizes[0]} m on {sizes[1]} m, {kind}, {miss:g} off, {speed} m/s"
    case.check(f"{name}: contact remainder", numpy.max(numpy.abs(h["contact_remainder"])) / h["kinetic"][0], 0, 3e-2 if drawn else 1e-2 if miss or dimension == 2 else 2e-3)
    case.check(f"{name}: part of one within the other", within(run, sizes, angles), 0, 0.01)
    if not drawn and sizes[0] == sizes[1] and rigid == (1, 1) and not miss:  # they change their velocities
        axis = "y" if dimension == 2 else "z"
        case.check(f"{name}: velocity of the lower one over the speed", -h[f"lower_velocity_{axis}"][-1] / speed, 1, 2e-3)
    if scene in compared:
        case.same_bits(folder, recipe, deck, run, ranks=3, threads=2)
        case.restarts(folder, recipe, deck, run, 5e-5 / speed, ranks=2)  # before they meet

# The paper's forces keep corners apart as well, though they make and lose energy.
for dimension, angles in ((2, [45, 45]), (3, [tip, tip]), (3, [[45, 0, 0], [45, 0, 0]])):
    for speed in (1, 20):
        scene = [[0.1] * dimension] * 2, angles, (1, 1), 0, speed
        recipe, deck = tip_on_tip(*scene)
        deck["contact"] = {"forces": "common_normal"}
        deck["time"]["contact_gain_tolerance"] = 10
        run = case.attempt(f"common_normal_{dimension}_{angles[0] == tip}_{speed}", recipe, deck)
        name = f"tip on tip along the common normal, {dimension}D, {angles[0]}, {speed} m/s"
        case.check_equal(f"{name}: exit code", run.code, 0)
        case.check(f"{name}: part of one within the other", within(run, scene[0], angles), 0, 0.05)

# --- A corner that comes down on a seam, flush or a hair open: it drives two bodies apart, or is held ----------------------------
def on_seam(gap, off, kind, elements):
    """A square on its corner, `off` beside the middle of the seam of two others, the right one of so many elements a side."""
    part = lambda block, low, divisions: {"shape": "box", "block": block, "min": low, "size": [1, 1], "divisions": [divisions] * 2}  # noqa: E731
    parts = [part("left", [-1 - gap / 2, -1], 1), part("right", [gap / 2, -1], elements),
             {**part("falling", [-0.5, -0.5], 1), "rotate": 45, "about": [0, 0], "offset": [off, 0.5 * math.sqrt(2) + 0.02]}]  # fmt: skip
    names = ("left", "right", "falling")
    deck = {"materials": {"rock": {"model": "linear_elastic", "density": 2600, "youngs_modulus": 50e9, "poisson_ratio": 0.25}},
            "blocks": {name: {"material": "rock", "rigid": kind != "elastic"} for name in names}, "viscosity": quiet,
            "initial": [{"block": "falling", "velocity": [0, -4, 0]}], "time": {"end": 0.02, "step_factor": 0.2}}  # fmt: skip
    if kind == "held":
        deck["conditions"] = [{"type": "rigid_motion", "block": name, "velocity": [0, 0, 0], "angular_velocity": [0, 0, 0]} for name in names[:2]]
    return {"dimension": 2, "parts": parts}, deck


seams = [(0, 0, "free", 1), (0, 0, "elastic", 1), (4.9e-3, 2e-3, "free", 1), (4e-4, 0, "elastic", 1), (0, 3e-3, "held", 4)]
if full:
    seams = [(gap, off, kind, elements) for gap in (0, 1e-4, 1e-3, 4.9e-3, 6e-3) for off in (0, 2e-3) for kind in ("held", "free", "elastic") for elements in (1, 4)]
for gap, off, kind, elements in seams:
    recipe, deck = on_seam(gap, off, kind, elements)
    folder = f"seam_{gap:g}_{off:g}_{kind}_{elements}"
    run = case.run(folder, recipe, deck)
    h = run.history
    name = f"corner {1e3 * off:g} mm beside a seam {1e3 * gap:g} mm open, {kind}, {elements} elements beyond"
    case.check(f"{name}: contact remainder", numpy.max(numpy.abs(h["contact_remainder"])) / h["kinetic"][0], 0, 6e-3)
    if (gap, kind, elements) == (0, "free", 1) and off == 0:
        case.same_bits(folder, recipe, deck, run, ranks=3, threads=2)
        case.restarts(folder, recipe, deck, run, 9e-3, ranks=2)  # while they touch

# --- The seam of two blocks over a line of the mesh, all of it symmetric -------------------------------------
# Corners pass each other and the line below them by round-off only, which must not decide what they feel.
for friction in (0.0, 0.6):
    for declared in (False, True):
        recipe = {
            "dimension": 2,
            "parts": [
                {"shape": "box", "block": "left", "min": [-0.2, 0.001], "size": [0.2, 0.1], "divisions": [2, 1]},
                {"shape": "box", "block": "right", "min": [0, 0.001], "size": [0.2, 0.1], "divisions": [2, 1]},
                {"shape": "box", "block": "slab", "min": [-0.4, -0.1], "size": [0.8, 0.1], "divisions": [8, 1]},
            ],
            "node_sets": {"base": {"block": "slab", "where": {"y": -0.1}}},
        }
        deck = {
            "materials": {"soft": soft},
            "blocks": {name: {"material": "soft"} for name in ("left", "right", "slab")},
            "joints": {"law": {"model": "linear", "normal_stiffness": 1e9, "shear_stiffness": 5e8, "friction": friction}},
            "contact": {
                "default_joint": "law",
                "pairs": [{"blocks": ["left", "right"], "declared": declared}],
            },
            "conditions": [{"type": "fixed", "node_set": "base"}],
            "initial": [{"block": name, "velocity": [0, -5, 0]} for name in ("left", "right")],
            "time": {"end": 0.01, "step_factor": 0.2},
            "history": {"probes": [{"name": name, "block": name} for name in ("left", "right")]},
        }
        run = case.run(f"seam_{friction:g}_{declared}", recipe, deck)
        h = run.history
        apart = max(
            numpy.max(numpy.abs(h["left_velocity_x"] + h["right_velocity_x"])),
            numpy.max(numpy.abs(h["left_velocity_y"] - h["right_velocity_y"])),
        )
        name = f"seam over a line of the mesh, friction {friction:g}, {'declared' if declared else 'met'}"
        case.check(f"{name}: one side against the other", float(apart) / 5, 0, 1e-9)
        case.check(f"{name}: contact remainder", h["contact_remainder"][-1] / h["kinetic"][0], 0, 5e-3)


# --- Two roofs that meet edge on edge ---------------------------------------------------------------------
def roofs(angle, crossing):
    """Two prisms of four rows of elements with an edge of `angle`, which cross; they meet at 2 m/s."""
    recipe = {
        "dimension": 3,
        "parts": [
            {"shape": "box", "block": name, "min": [0, 0, z], "size": [1, 1, 1], "divisions": [2, 2, 4]}
            for name, z in (("lower", 10), ("upper", 20))
        ],
    }
    high = 0.15
    wide = high * math.tan(math.radians(angle) / 2)
    section = numpy.array([[0, 0], [-wide, -high], [0, -1.3 * high - 0.3 * wide], [wide, -high]])

    def place(x):
        for base, sign, turn, off in ((10, 1, 0, [0, 0, 0]), (20, -1, crossing, [0.013, 0.007, 0.002])):
            mine = (x[:, 2] > base - 1) & (x[:, 2] < base + 2)
            u, v, t = x[mine, 0], x[mine, 1], x[mine, 2] - base
            weights = numpy.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=1)
            y, z = (weights @ section).T
            plan = turned(numpy.stack([0.4 * (t - 0.5), sign * y], axis=1), turn)
            x[mine] = numpy.column_stack([plan, sign * z]) + off
        return x

    deck = {
        "materials": {"soft": soft},
        "blocks": {"lower": {"material": "soft"}, "upper": {"material": "soft"}},
        "initial": [{"block": "lower", "velocity": [0, 0, 1]}, {"block": "upper", "velocity": [0, 0, -1]}],
        "time": {"end": 0.05},
        "history": {"probes": [{"name": "lower", "block": "lower"}, {"name": "upper", "block": "upper"}]},
    }
    return recipe, deck, place


for angle, crossing in (
    (120, 50), (90, 90), (90, 60), (90, 30), (90, 16), (75, 90), (75, 60), (60, 90), (60, 60), (60, 40), (60, 20), (50, 90), (45, 75), (38, 45),
    (30, 90), (20, 90), (10, 90)
) if full else ((120, 50), (90, 16), (60, 90), (60, 20), (50, 90), (38, 45), (10, 90)):
    recipe, deck, place = roofs(angle, crossing)
    run = case.run(f"roofs_{angle}_{crossing}", recipe, deck, change_mesh=place)
    h = run.history
    name = f"edges of {angle} degrees that cross at {crossing}"
    case.check(f"{name}: contact remainder", h["contact_remainder"][-1] / h["kinetic"][0], 0, 5e-3)
    # None goes through, and the edges are pushed along their common normal. Thin ones bend and ring.
    apart = [(h[f"upper_velocity_{axis}"][-1] - h[f"lower_velocity_{axis}"][-1]) / 2 for axis in "xyz"]
    case.check_within(f"{name}: velocity apart over that before", apart[2], 0.9, 1.01)
    case.check(f"{name}: velocity aside", math.hypot(*apart[:2]), 0, 0.03)
    if (angle, crossing) in ((60, 20), (38, 45)):
        case.same_bits(f"roofs_{angle}_{crossing}", recipe, deck, run, ranks=3, threads=2, change_mesh=place)


# --- A needle on a face -----------------------------------------------------------------------------------
for angle in (5, 10, 12, 30):
    recipe = {
        "dimension": 2,
        "parts": [
            {"shape": "box", "block": "needle", "min": [0, 10], "size": [1, 1], "divisions": [6, 6]},
            {"shape": "box", "block": "plate", "min": [-0.2, -0.2], "size": [0.4, 0.2], "divisions": [5, 3]},
        ],
    }
    wide = 0.3 * math.tan(math.radians(angle) / 2)
    section = numpy.array([[0, 0], [wide, 0.3], [0, 0.315], [-wide, 0.3]])

    def place(x, section=section):
        mine = x[:, 1] > 5
        u, v = x[mine, 0], x[mine, 1] - 10
        weights = numpy.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=1)
        x[mine] = weights @ section + [0.013, 0.003]
        return x

    deck = {
        "materials": {"soft": soft},
        "blocks": {"needle": {"material": "soft"}, "plate": {"material": "soft"}},
        "initial": [{"block": "needle", "velocity": [0, -1, 0]}],
        "viscosity": quiet,
        "time": {"end": 0.05},
        "history": {"probes": [{"name": "needle", "block": "needle"}]},
    }
    run = case.run(f"needle_{angle}", recipe, deck, change_mesh=place)
    h = run.history
    case.check(f"needle of {angle} degrees: contact remainder", h["contact_remainder"][-1] / h["kinetic"][0], 0, 1e-3)
    case.check_within(f"needle of {angle} degrees: velocity after", h["needle_velocity_y"][-1], 0.2, 1.0)

# --- A bond that breaks in shear while its pair is tilted -------------------------------------------------
recipe = {
    "dimension": 2,
    "parts": [
        {"shape": "box", "block": "lower", "min": [-0.15, -0.3], "size": [0.3, 0.3], "divisions": [1, 1]},
        {"shape": "box", "block": "upper", "min": [-0.15, 0], "size": [0.3, 0.3], "divisions": [1, 1]},
    ],
}
deck = {
    "materials": {"soft": soft},
    "blocks": {"lower": {"material": "soft", "rigid": True}, "upper": {"material": "soft", "rigid": True}},
    "joints": {
        "glue": {
            "model": "bilinear", "normal_stiffness": 1e9, "shear_stiffness": 4e8, "friction": 0.6,
            "tensile_strength": 3e5, "cohesion": 4e5, "tension_energy": 100.0, "shear_energy": 500.0,
        }
    },
    "contact": {"default_joint": "glue", "pairs": [{"blocks": ["lower", "upper"], "joint": "glue", "declared": True}]},
    "conditions": [
        {"type": "rigid_motion", "block": "lower", "velocity": [0, 0, 0], "angular_velocity": [0, 0, 0]},
        {"type": "rigid_motion", "block": "upper", "velocity": [0, 0, 0], "angular_velocity": [0, 0, 0.05]},
    ],
    "time": {"end": 1.0, "maximum_step": 2.5e-4},
}
run = case.run("bond", recipe, deck, momentum=1e-11)
h = run.history
play = numpy.max(numpy.abs(h["external_work"]))
case.check_equal("bond: breaks", bool(h["contact_fracture"][-1] > 5), True)
case.check("bond: contact makes no energy, over the work done", float(numpy.max(-h["contact_remainder"])) / play, 0, 1e-2)
case.same_bits("bond", recipe, deck, run, ranks=2, threads=2)
case.finish()
