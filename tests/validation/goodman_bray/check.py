"""Goodman and Bray's 16 blocks: they stand above the limiting friction angle and fall below it."""

import math
import pathlib
import sys

import numpy
from coplanetest import ValidationCase

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import limit  # noqa: E402

case = ValidationCase(__file__)
GRAVITY = 10.0  # [m/s^2], with 2500 kg/m^3: 25 kN/m^3


def slope(size):
    """Recipe with elements of about this size [m]: block n is called bn, n = 1 at the toe."""
    recipe = case.load("mesh.yaml")
    across = round(limit.WIDTH / size)
    for n, height in enumerate(limit.HEIGHTS, start=1):
        left, foot = limit.WIDTH * (n - 1), limit.STEP * (n - 1)
        recipe["parts"].append({"shape": "box", "block": f"b{n}", "min": [left, foot], "size": [limit.WIDTH, height],
                                "divisions": [across, max(1, round(height / size))]})  # fmt: skip
        recipe["parts"].append({"shape": "box", "block": "base", "min": [left, -5], "max": [left + limit.WIDTH, foot], "divisions": [across, 1]})
    return recipe


def stand(name, tangent, size=10.0, end=8.0, **joint):
    """How far the blocks move after damping has ended, b1 first [m]; and the run and its seconds."""
    deck = case.load()
    for n in range(1, 17):
        deck["blocks"][f"b{n}"] = {"material": "rock", "rigid": True}
        deck["history"]["probes"].append({"name": f"b{n}", "block": f"b{n}"})
    turned = [f"{GRAVITY * -math.sin(limit.DIP)!r}*min(t, 1)", f"{GRAVITY * -math.cos(limit.DIP)!r}*min(t, 1)", 0]
    deck["gravity"] = turned
    deck["joints"]["dry"].update(friction=tangent, **joint)
    deck["time"]["end"] = end
    run, spent = case.timed(name, slope(size), deck, load=limit.UNIT_WEIGHT * limit.WIDTH * sum(limit.HEIGHTS))
    h = run.history
    at = int(numpy.searchsorted(h["time"], 3.2))
    moved = [math.hypot(*(h[f"b{n}_displacement_{x}"][-1] - h[f"b{n}_displacement_{x}"][at] for x in "xy")) for n in range(1, 17)]
    return numpy.array(moved), run, spent


def limit_of(size):
    """Ours, over the published tangent: between what stands and what falls, found by halving; and the seconds that it took."""
    low, high, spent = 0.94, 1.04, 0.0
    while high - low > 0.008:
        middle = (low + high) / 2
        moved, _, seconds = stand(f"limit_{size}_{middle:.4f}", middle * tangent, size)
        low, high, spent = (low, middle, spent + seconds) if moved.max() < 1e-3 else (middle, high, spent + seconds)
    return (low + high) / 2, spent


tangent = limit.limiting_tangent()
degrees = math.degrees(math.atan(tangent))
case.check("limiting friction angle by our script against the published one [degrees]", degrees, 38.15, 0.01)
ways = limit.forces(tangent * 1.0001, a2=5.0)[1]
case.check_equal("blocks that topple, after our script", [n for n, way in enumerate(ways, start=1) if way == "topples"], list(range(4, 14)))

for name, part, low, high in (("plus_3", 1.03, 0, 1e-3), ("minus_3", 0.97, 0.1, math.inf)):
    moved, run, spent = stand(name, part * tangent, size=5.0 if case.full else 10.0)
    case.check_within(f"{part} of the limiting friction: largest motion in 4.8 s [m]", moved.max(), low, high)
    if case.full:
        case.study(f"largest motion at {part} of the limiting friction [m]", "5 m", moved.max(), None, spent)
case.check_equal("0.97: blocks that moved", [n for n in range(1, 17) if moved[n - 1] > 1e-3], list(range(1, 14)))
case.picture(run, "--shares", "1", "--planes", "none", "--size", "900", "560")
if case.full:
    for size in (10.0, 5.0, 2.5, 1.25):
        found, spent = limit_of(size)
        case.study("limiting tan(phi) over the published one", f"{size} m, {round(10 / size)} across a block", found, 1.0, spent)
    case.check("limiting tan(phi), elements of 1.25 m, over the published one", found, 1, 0.02, relative=True)
case.finish()
