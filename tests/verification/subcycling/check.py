"""Subcycling: waves through thin elements, blocks that meet with crushed ones, stress at rest, what is refused."""

import numpy
from coplanetest import Case

case = Case("subcycling", __file__)

DENSITY, YOUNG = 2000.0, 2e9
SPEED = (YOUNG / DENSITY) ** 0.5  # of waves along a bar without lateral contraction
STONE = {"stone": {"model": "linear_elastic", "density": DENSITY, "youngs_modulus": YOUNG, "poisson_ratio": 0}}


def with_levels(deck, levels):
    return {**deck, "time": {**deck["time"], "subcycling": {"levels": levels}}}


def lines(ends, divisions):
    return {"ends": ends, "divisions": divisions}


# A pulse of 1 MPa and 2 ms runs through a bar with two thin elements, and throws its other end on by twice the impulse over rho c.
def bar(dimension, turned):
    parts = [{"shape": "box", "block": "bar", "lines": {"x": lines([0, 2, 2.01, 4, 4.01, 6], [20, 1, 20, 1, 20]), "y": lines([0, 0.1], [1])}}]
    if dimension == 3:
        parts[0]["lines"]["z"] = lines([0, 0.1], [1])
    recipe = {"dimension": dimension, "parts": parts, "node_sets": {"far": {"where": {"x": 6}}}, "side_sets": {"near": {"where": {"x": 0}}}}
    if turned:
        recipe["transform"] = [{"rotate": {"angle": turned, "axis": [0, 0, 1]}}]
    push = {"times": [0, *numpy.linspace(0, 2e-3, 41)[1:].tolist(), 1], "values": [0, *(1e6 * numpy.sin(numpy.pi * numpy.linspace(0, 1, 41)[1:]) ** 2).tolist(), 0]}
    deck = {
        "materials": STONE, "blocks": {"bar": {"material": "stone"}}, "contact": {"enabled": False},
        "conditions": [{"type": "pressure", "side_set": "near", "value": push}], "viscosity": {"linear": 0, "quadratic": 0},
        "time": {"end": 9.5e-3}, "output": {"every": 1}, "history": {"every": 0, "probes": [{"name": "far", "node_set": "far"}]},
    }  # fmt: skip
    return recipe, deck


for name, dimension, turned in (("2d", 2, 0), ("3d", 3, 0)):
    recipe, deck = bar(dimension, turned)
    small = case.run(f"bar_{name}_small_steps", recipe, deck)
    run = case.run(f"bar_{name}", recipe, with_levels(deck, 5), energy=1e-2)
    exact = 2 * 1e6 * 1e-3 / (DENSITY * SPEED)
    for what, one in (("small steps", small), ("subcycled", run)):
        case.check(f"bar {name}, {what}: displacement of the far end over the exact one", one.history["far_displacement_x"][-1] / exact, 1, 1e-2)
    case.check_within(f"bar {name}: cycles with small steps over those when subcycled", small.history["cycle"][-1] / run.history["cycle"][-1], 5, 11)
    case.check_equal(f"bar {name}: largest number of substeps", numpy.max(run.history["substeps"]), 16)
    case.check_within(f"bar {name}: elements that are substepped", numpy.max(run.history["substepped_elements"]), 6, 10)
    case.same_bits(f"bar {name}", recipe, with_levels(deck, 5), run)
case.finish()
