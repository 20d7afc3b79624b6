"""Dry-stone walls on a tilting table: the load multiplier (tangent of the tilt) at which stacks and walls in running bond fall."""

import math

import limit
import numpy
from coplanetest import ValidationCase

case = ValidationCase(__file__)
G, LENGTH, COURSE = 9.81, 0.08, 0.04  # [m/s^2], stone of a wall [m]
# Part of the multiplier of limit analysis at which a wall has to stand: stones that do not climb bear less, the more so where openings make thrusts.
STANDS = {"wall 1": 0.95, "wall 3": 0.8}


def stack(width, heights):
    """Parts of stones of one width on each other."""
    parts, y = [], 0.0
    for height in heights:
        parts.append({"shape": "box", "block": "stones", "min": [0.5, y], "size": [width, height], "divisions": [4, max(1, round(4 * height / width))]})
        y += height
    return parts


def bond(bricks, courses):
    """A wall in running bond, seen from its side, half stones at its ends."""
    return [{"shape": "wall", "block": "stones", "brick": [LENGTH, COURSE], "courses": courses, "length_in_bricks": bricks, "divisions": [2, 1], "offset": [0.5, 0]}]


def least_multiplier(bricks, courses):
    """Of a wall in running bond that turns about its toe, stones without sliding: everything above a crack turns that starts at the heel of k whole stones of the lowest course and climbs by half a stone in each course, because
    a stone that lies on one that is lifted is lifted too. Moments about the toe; the least over all k.
    """
    best = math.inf
    for k in range(1, bricks + 1):
        reaches = [min(bricks, k + row / 2) * LENGTH for row in range(courses)]
        arm = sum(reach**2 / 2 for reach in reaches)
        up = sum(reach * (row + 0.5) * COURSE for row, reach in enumerate(reaches))
        best = min(best, arm / up)
    return best


def published(name):
    """Parts of one of Ferris and Tin-Loi's walls."""
    return [
        {"shape": "box", "block": "stones", "min": [0.5 + x, y], "size": [length, limit.COURSE], "divisions": [round(2 * length / limit.LENGTH), 1]}
        for x, y, length in limit.stones(limit.walls()[name])
    ]


def stand(name, parts, multiplier, friction=0.7, stiffness=5e10, size=1, end=1.2):
    """Most that a stone moves after all damping has ended [m]; run and seconds. The tilt grows within 0.5 s, damped until 0.7 s."""
    recipe, deck = case.load("mesh.yaml"), case.load()
    recipe["parts"][0]["max"][0] = 4.0 if parts[0].get("size", [0, 0])[1] == limit.COURSE else 2.5
    for part in parts:
        recipe["parts"].append({**part, "divisions": [n * size for n in part["divisions"]]})
    turn = f"{math.atan(multiplier)!r}*min(t/0.5, 1)"
    deck["gravity"] = [f"{G}*sin({turn})", f"-{G}*cos({turn})", 0]
    deck["joints"]["dry"].update(friction=friction, normal_stiffness=stiffness)
    deck["time"]["end"] = end
    run, spent = case.timed(name, recipe, deck, load=2680 * G * 2.0)
    results = run.results
    early = int(numpy.searchsorted(results.times, 0.8 - 1e-3))
    return numpy.linalg.norm(results.nodal("displacement") - results.nodal("displacement", early), axis=1).max(), run, spent


def bracket(name, parts, exact, below=0.95, above=1.04, **options):
    for part, falls in ((below, False), (above, True)):
        moved, run, spent = stand(f"{name}_{part}", parts, part * exact, **options)
        case.check_within(f"{name}: at {part} of the multiplier {exact:.4f}: motion [m]", moved, *((2e-3, math.inf) if falls else (0, 1.5e-3)))
    return run


stones = {"one stone": stack(0.1, [0.4]), "four stones": stack(0.1, [0.1] * 4)}
for name, parts in stones.items():
    bracket(name.replace(" ", "_"), parts, 0.1 / 0.4)
bracket("flat_stone_slides", stack(0.1, [0.05]), 0.5, friction=0.5)
exact = least_multiplier(2, 6)
run = bracket("bond_2x6", bond(2, 6), exact, 0.92, 1.06, friction=1.2, stiffness=2e10)
case.picture(run, "--shares", "0", "0.67", "0.83", "1", "--strip", "4", "--planes", "none", "--window", "0.4", "0.95", "-0.05", "0.32", "--size", "330", "240")
# Walls of Ferris and Tin-Loi, friction of 0.65: our limit analysis gives the one multiplier that could be read, and is a bound from above for stones that do not climb as they slide.
climbing = {name: limit.multiplier(courses) for name, courses in limit.walls().items() if case.full and name != "wall 6" or name in STANDS}
case.check("limit analysis of wall 1 against the published multiplier", climbing["wall 1"], 0.643, 1e-3, relative=True)
for name, exact in climbing.items():
    for part in ((STANDS[name],) if name in STANDS else ()) + (1.04,):
        moved, _, _ = stand(f"{name.replace(' ', '_')}_{part}", published(name), part * exact, friction=limit.FRICTION)
        words = f"{name} of Ferris and Tin-Loi: at {part} of the multiplier {exact:.4f} of limit analysis: motion [m]"
        case.check_within(words, moved, *((2e-3, math.inf) if part > 1 else (0, 1.5e-3)))
if case.full:
    for name, exact in climbing.items():
        for stiffness in (1e10, 5e10) if name in STANDS else (5e10,):
            for part in (0.9, 0.8, 0.7):
                moved, _, spent = stand(f"{name.replace(' ', '_')}_search", published(name), part * exact, friction=limit.FRICTION, stiffness=stiffness)
                if moved < 1.5e-3:
                    break
            case.study(f"{name}: largest of the tried multipliers at which it stands (reference: limit analysis)", f"2 along a stone, joints of {stiffness / 1e9:g} GPa/m", part * exact, exact, spent)
    for size in (1, 2):
        for part in (0.92, 1.06):
            moved, _, spent = stand(f"size_{size}_{part}", bond(2, 6), part * exact, friction=1.2, stiffness=2e10, size=size)
            case.study(f"running bond, 2 stones long, at {part} of the multiplier: motion [m]", f"{2 * size} along a stone", moved, None, spent)
    moved, _, spent = stand("low_friction", bond(3, 6), 0.92 * least_multiplier(3, 6), friction=0.7, stiffness=2e10)
    case.study("running bond, 3 stones long, friction of 0.7, at 0.92 of the multiplier without sliding: motion [m]", "2 along a stone", moved, None, spent)
case.finish()
