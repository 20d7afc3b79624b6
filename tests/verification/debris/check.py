"""Debris: corners of a cube that dies bounce off a rigid floor in closed form, and off a free elastic block with all momenta."""

import sys

import numpy
from coplanetest import Case

case = Case("debris", __file__)
deck = case.load()
rock = deck["materials"]["rock"]
nu = rock["poisson_ratio"]
modulus = rock["youngs_modulus"] * (1 - nu) / ((1 + nu) * (1 - 2 * nu))
size, height, floor = 0.1, 0.05, 0.5


def scene(dimension):
    """A cube above a floor; what it flies with along the floor, and down as its corners part."""
    flat = dimension == 2
    recipe = {"dimension": dimension, "parts": [
        {"shape": "box", "block": "floor", "min": [0, 0, -floor][-dimension:], "size": [2 * floor, 2 * floor, floor][-dimension:], "divisions": [2, 2, 1][-dimension:]},
        {"shape": "box", "block": "dust", "min": [0.33, 0.37, height][-dimension:], "size": [size] * dimension, "divisions": [1] * dimension},
    ]}  # fmt: skip
    one = case.load()
    down = f"-10 + ({'y' if flat else 'z'} - {height + size / 2})"
    one["initial"][0]["velocity_field"] = [3, down, 0] if flat else [3, -2, down]
    return recipe, one


def corners(run, step):
    """Heights at the start and velocities of what was the cube."""
    r = run.results
    dust = numpy.unique(r.connectivity("dust"))
    return r.coordinates[dust, r.dimension - 1], r.nodal("velocity", step)[dust, : r.dimension]


# --- a rigid floor that does not move: half a period of a mass on a spring ------------------------------------------------
for dimension in (2, 3):
    name = f"rigid_{dimension}d"
    recipe, one = scene(dimension)
    mass = rock["density"] * size**dimension / 2**dimension
    behind = rock["density"] * floor**dimension  # of the element, which is lighter than none of the points
    stiffness = 0.5 * modulus * (floor if dimension == 3 else 1) * min(1, mass / behind)
    run = case.run(name, recipe, one)
    h = run.history
    case.check_equal(f"{name}: points", int(h["debris_points"][-1]), 2**dimension)
    low, high = 10 + size / 2, 10 - size / 2  # speeds of the lower and upper corners
    z, v = corners(run, -1)
    lower = z < height + size / 2
    case.check(f"{name}: speed of the lower corners after the bounce [m/s]", v[lower, -1].mean(), low, 1e-3, relative=True)
    case.check(f"{name}: speed of the upper ones [m/s]", v[~lower, -1].mean(), high, 1e-3, relative=True)
    case.check(f"{name}: largest difference within each", max(numpy.ptp(v[lower, -1]), numpy.ptp(v[~lower, -1])) / low, 0, 1e-12)
    along = [3.0] if dimension == 2 else [3.0, -2.0]
    case.check(f"{name}: speed along the floor, largest change over the speed", numpy.abs(v[:, :-1] - along).max() / 3, 0, 1e-12)
    most = 2 ** (dimension - 1) * mass * low**2 / 2
    case.check(f"{name}: largest energy stored [J]", h["debris_stored"].max(), most, 2e-3, relative=True)
    first = h["time"][(h["debris_touching"] > 0) & (h["time"] < height / low + 3e-3)]
    case.check(f"{name}: time in contact [s]", first[-1] - first[0], numpy.pi * numpy.sqrt(mass / stiffness), 0.02, relative=True)
    case.check(f"{name}: what is not stored, over that", numpy.abs(h["debris_remainder"]).max() / most, 0, 1e-3)
    if dimension == 3:
        if "all" in sys.argv[1:]:
            case.same_bits(name, recipe, one, run)
        case.same_bits(f"{name}_three", recipe, one, run, ranks=3, backend="serial")
        touched = run.history["time"][run.history["debris_touching"] > 0]
        case.restarts(name, recipe, one, run, touched[20], ranks=2)

    # Cut in two 1 mm beside corners, which do not fly along it: the seam is no way out.
    side, box = recipe["parts"][1]["min"][0], recipe["parts"][0]
    seam = side + 1e-3
    for gap in (0, 1e-5):
        part = lambda low, high: {**box, "min": [low, *box["min"][1:]], "size": [high - low, *box["size"][1:]], "divisions": [1, *box["divisions"][1:]]}
        halves = {**recipe, "parts": [part(0, seam), part(seam + gap, 2 * floor), recipe["parts"][1]]}
        straight = {**one, "initial": [{**one["initial"][0], "velocity_field": [0] * (dimension - 1) + [one["initial"][0]["velocity_field"][dimension - 1]] + [0] * (3 - dimension)}]}
        run = case.run(f"halves_{dimension}d_{gap:g}", halves, straight)
        z, v = corners(run, -1)
        after = v[:, -1] / numpy.where(z < height + size / 2, low, high)
        case.check(f"halves {gap:g} m apart, {dimension}D: speed after the bounce, largest change", numpy.abs(after - 1).max(), 0, 1e-3)
    for lean in (-0.25, 0.25) if dimension == 2 else ():
        top, bottom = side + 5e-4, side + 5e-4 + lean  # a slanting seam, 0.5 mm beside corners
        quadrilateral = lambda *corners: {"shape": "quadrilateral", "block": "floor", "corners": corners, "divisions": [1, 1], "split": "none"}
        halves = {**recipe, "parts": [quadrilateral([0, -floor], [bottom, -floor], [top, 0], [0, 0]), quadrilateral([bottom, -floor], [2 * floor, -floor], [2 * floor, 0], [top, 0]),
                                      recipe["parts"][1]]}  # fmt: skip
        run = case.run(f"slanting_{lean:g}", halves, straight)
        z, v = corners(run, -1)
        after = v[:, -1] / numpy.where(z < height + size / 2, low, high)
        case.check(f"seam that leans by {lean:g} m: speed after the bounce, largest change", numpy.abs(after - 1).max(), 0, 1e-3)
    if dimension == 3:
        case.same_bits("halves_3d_1e-05", halves, straight, run, ranks=2)

# --- an elastic block that nothing holds: all momenta, and the energy that goes into waves --------------------------------
recipe, one = scene(3)
recipe["parts"][0]["divisions"] = [4, 4, 2]
one["conditions"] = []
del one["blocks"]["floor"]["rigid"], one["history"]["rigid"]
run = case.run("elastic", recipe, one)
h = run.history
touched = h["debris_touching"] > 0
case.check_within("elastic: recorded cycles in contact", int(touched.sum()), 100, 1000)
case.check("elastic: what is not stored, over the energy at the start", numpy.abs(h["debris_remainder"]).max() / h["initial"][0], 0, 2e-3)
z, v = corners(run, -1)
case.check("elastic: speed of the corners after the bounce over that before, mean", (v[:, 2] / numpy.where(z < height + size / 2, 10 + size / 2, 10 - size / 2)).mean(), 1, 0.03)
case.same_bits("elastic", recipe, one, run, ranks=3)


# --- wherever points come down: half of a body and its image, simplices, a rigid body that asks for no step ---------------
def rain(low, divisions, split="none", rigid=False, speed=100, dense=1, aside=0):
    """Two rows of points, 17 mm over `dense` from each other, that fall on a plate, towards its middle with `aside`; its elements are 30 mm wide."""
    recipe = {"dimension": 2, "parts": [
        {"shape": "box", "block": "floor", "min": [low, -0.12], "max": [0.3, 0], "divisions": [divisions, 3], "split": split},
        {"shape": "box", "block": "dust", "min": [10 * 0.017 * low / 0.3, 0.002], "max": [0.17, 0.019], "divisions": [dense * (20 if low < 0 else 10), 1]}],
        "node_sets": {"middle": {"where": {"x": 0}}}}  # fmt: skip
    one = case.load()
    inward = f"-{aside} * (x > 1e-9) + {aside} * (x < -1e-9)"
    one["initial"][0]["velocity_field"] = [inward, f"-{speed} + 0.01 * {speed} * (y - 0.01)", 0]
    if not rigid:
        one["conditions"] = [{"type": "symmetry", "node_set": "middle", "normal": [1, 0, 0]}] if low == 0 else []
        del one["blocks"]["floor"]["rigid"], one["history"]["rigid"]
    one["blocks"]["dust"]["erosion"] = {"stable_step": 1}
    one["time"] = {"end": 0.12 / speed, "step_factor": 0.8 if rigid else 0.3}
    one["history"]["every"] = 1e-3 / speed
    return recipe, one


def fallen(run):
    """Places along the floor at the start, velocities and heights of what was the row."""
    r = run.results
    dust = numpy.unique(r.connectivity("dust"))
    start = r.coordinates[dust]
    return start[:, 0], r.nodal("velocity", -1)[dust, 1], start[:, 1] + r.nodal("displacement", -1)[dust, 1]


whole, half = (case.run(f"rain_{name}", *rain(low, divisions)) for name, low, divisions in (("whole", -0.3, 20), ("half", 0, 10)))
x, v, _ = fallen(whole)
x_half, v_half, _ = fallen(half)
case.check("half of a plate: slowest of the points after the bounce, over 100 m/s", v_half.min() / 100, 0.7, 0.3)
case.check("half of a plate: velocities over those of the whole one, largest difference", numpy.abs(v[x >= -1e-9] - v_half).max() / 100, 0, 1e-6)
aslant = [case.run(f"aslant_{name}", *rain(low, divisions, aside=500)) for name, low, divisions in (("whole", -0.3, 20), ("half", 0, 10))]
(x, v, _), (x_half, v_half, _) = (fallen(run) for run in aslant)
start_half = aslant[1].results.coordinates[numpy.unique(aslant[1].results.connectivity("dust")), 1]
# It takes 190 us to fall, or 20, and 42 to bounce.
met = x_half < 500 * numpy.where(start_half > 0.01, 190e-6, 20e-6)
case.check_within("half of a plate, rain aslant: points that meet it beyond the plane of symmetry", int(met.sum()), 5, 20)
case.check_within("half of a plate, rain aslant: speeds at which they go up again, lowest, over 100 m/s", v_half[met].min() / 100, 0.01, 1)
case.check("half of a plate, rain aslant: velocities over those of the whole one, largest difference", numpy.abs(v[x >= -1e-9] - v_half).max() / 100, 0, 1e-6)
case.same_bits("aslant_half", *rain(0, 10, aside=500), aslant[1], ranks=2)
for split, low in (("triangles", -0.3), ("triangles", 0)):
    recipe, one = rain(low, 10 if low == 0 else 20, split, dense=6)  # some points come down in elements that have no face at the surface
    run = case.run(f"rain_{split}_{low:g}", recipe, one)
    if low == 0:
        case.same_bits(f"rain_{split}_{low:g}", recipe, one, run, ranks=3)
    x, v, y = fallen(run)
    case.check_equal(f"{split}, {'half of a' if low == 0 else 'whole'} plate: points that come through", int(numpy.sum((v < 0) & (y < 0))), 0)
    case.check(f"{split}, {'half of a' if low == 0 else 'whole'} plate: what is not stored, over the energy at the start", numpy.abs(run.history["debris_remainder"]).max() / run.history["initial"][0], 0, 0.02)
for speed in (1, 20):
    run = case.run(f"rain_rigid_{speed}", *rain(-0.3, 20, rigid=True, speed=speed))
    x, v, y = fallen(run)
    case.check(f"rigid plate, {speed} m/s: speed after the bounce over that before, mean", v.mean() / speed, 1, 0.1)
    case.check(f"rigid plate, {speed} m/s: what is not stored, over the energy at the start", numpy.abs(run.history["debris_remainder"]).max() / run.history["initial"][0], 0, 0.1)

# --- a ring of dust goes through the axis of a body of revolution, and meets a tube from within ---------------------------
recipe = {"dimension": 2, "parts": [{"shape": "box", "block": "floor", "min": [0.5, -0.1], "size": [0.1, 0.2], "divisions": [2, 4]},
                                    {"shape": "box", "block": "dust", "min": [0.2, -0.013], "size": [0.02, 0.02], "divisions": [1, 1]}]}  # fmt: skip
one = case.load()
one["geometry"], one["conditions"] = "axisymmetric", []
del one["blocks"]["floor"]["rigid"], one["history"]["rigid"]
one["blocks"]["dust"]["erosion"] = {"stable_step": 1}
one["initial"][0]["velocity_field"] = [-100, 0, 0]
one["time"] = {"end": 0.012, "step_factor": 0.3}
run = case.run("ring", recipe, one)
r, h = run.results, run.history
dust, tube = (numpy.unique(r.connectivity(block)) for block in ("dust", "floor"))
before = r.nodal("velocity", 1)[dust, 0]  # beyond the axis, on the way to the tube
case.check("ring: speed beyond the axis over that at the start, largest difference", numpy.abs(before / -100 - 1).max(), 0, 1e-12)
case.check_within("ring: its places then, over the radius of the tube", (r.coordinates[dust, 0] + r.nodal("displacement", 1)[dust, 0]).max() / 0.5, -1, -0.5)
after = r.nodal("velocity", -1)[dust, 0]
case.check("ring: speed back from the tube over that before, mean", (-after / before).mean(), 0.9, 0.1)
case.check("ring: work of what stops nodes at the axis, over the energy", numpy.abs(h["external_work"]).max() / h["initial"][0], 0, 1e-12)
case.check("ring: what is not stored, over the energy", numpy.abs(h["debris_remainder"]).max() / h["initial"][0], 0, 0.02)
pushed = h["debris_touching"] > 0
case.check_within("ring: points that touch the tube at once", int(h["debris_touching"].max()), 2, 4)
case.same_bits("ring", recipe, one, run, ranks=2)
case.restarts("ring", recipe, one, run, h["time"][pushed][pushed.sum() // 2])
case.finish()
