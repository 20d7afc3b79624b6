"""Subcycling: waves through thin elements, blocks that meet with crushed ones, stress at rest, what is refused."""

import numpy
from coplanetest import Case

case = Case("subcycling", __file__)

DENSITY, YOUNG = 2000.0, 2e9
SPEED = (YOUNG / DENSITY) ** 0.5  # of waves along a bar without lateral contraction
STONE = {"stone": {"model": "linear_elastic", "density": DENSITY, "youngs_modulus": YOUNG, "poisson_ratio": 0}}


phases = numpy.linspace(0, 1, 41)  # of a pulse


def with_levels(deck, levels):
    return {**deck, "time": {**deck["time"], "subcycling": {"levels": levels}}}


def lines(ends, divisions):
    return {"ends": ends, "divisions": divisions}


# A pulse of 1 MPa and 2 ms runs through a bar with two thin elements, and throws its other end on by twice the impulse over rho c.
def bar(dimension):
    parts = [{"shape": "box", "block": "bar", "lines": {"x": lines([0, 2, 2.01, 4, 4.01, 6], [20, 1, 20, 1, 20]), "y": lines([0, 0.1], [1])}}]
    if dimension == 3:
        parts[0]["lines"]["z"] = lines([0, 0.1], [1])
    recipe = {"dimension": dimension, "parts": parts, "node_sets": {"far": {"where": {"x": 6}}}, "side_sets": {"near": {"where": {"x": 0}}}}
    push = {"times": [*(2e-3 * phases).tolist(), 1], "values": [*(1e6 * numpy.sin(numpy.pi * phases) ** 2).tolist(), 0]}
    deck = {
        "materials": STONE, "blocks": {"bar": {"material": "stone"}}, "contact": {"enabled": False},
        "conditions": [{"type": "pressure", "side_set": "near", "value": push}], "viscosity": {"linear": 0, "quadratic": 0},
        "time": {"end": 9.5e-3}, "output": {"every": 1}, "history": {"every": 0, "probes": [{"name": "far", "node_set": "far"}]},
    }  # fmt: skip
    return recipe, deck


for name, dimension in (("2d", 2), ("3d", 3)):
    recipe, deck = bar(dimension)
    small = case.run(f"bar_{name}_small_steps", recipe, deck)
    run = case.run(f"bar_{name}", recipe, with_levels(deck, 5), energy=1e-2)
    exact = 2 * 1e6 * 1e-3 / (DENSITY * SPEED)
    for what, one in (("small steps", small), ("subcycled", run)):
        case.check(f"bar {name}, {what}: displacement of the far end over the exact one", one.history["far_displacement_x"][-1] / exact, 1, 1e-2)
    case.check_within(f"bar {name}: cycles with small steps over those when subcycled", small.history["cycle"][-1] / run.history["cycle"][-1], 5, 11)
    case.check_equal(f"bar {name}: largest number of substeps", numpy.max(run.history["substeps"]), 8)
    case.check_within(f"bar {name}: elements that are substepped", numpy.max(run.history["substepped_elements"]), 6, 10)
    case.same_bits(f"bar {name}", recipe, with_levels(deck, 5), run)

# A block strikes a slab aslant where that has a column of thin elements, and leaves again.
def blocks(offset):
    recipe = {
        "dimension": 2,
        "parts": [
            {"shape": "box", "block": "slab", "lines": {"x": lines([0, 0.55, 0.556, 1.2], [11, 1, 13]), "y": lines([-0.6, 0], [12])}},
            {"shape": "box", "block": "block", "min": [0.45 + offset, 1e-3], "size": [0.2, 0.2], "divisions": [4, 4]},
        ],
        "node_sets": {"block": {"block": "block"}},
    }  # fmt: skip
    deck = {
        "materials": STONE, "blocks": {"slab": {"material": "stone"}, "block": {"material": "stone"}},
        "joints": {"touch": {"friction": 0.3}}, "contact": {"default_joint": "touch"},
        "initial": [{"block": "block", "velocity": [2, -5, 0]}],
        "time": {"end": 1.5e-3}, "output": {"every": 1}, "history": {"every": 0, "probes": [{"name": "block", "block": "block"}]},
    }  # fmt: skip
    return recipe, deck


for offset in (0, 0.013):
    name = f"blocks {offset} m aside"
    recipe, deck = blocks(offset)
    small = case.run(f"{name}, small steps", recipe, deck)
    # The angular momentum: what is steady acts in all of a cycle, while nodes move.
    run = case.run(name, recipe, with_levels(deck, 5), energy=5e-3, angular=1e-7, remainder=2e-2)
    case.check_equal(f"{name}: contact has carried", bool(numpy.max(run.history["carrying"]) > 0 and run.history["carrying"][-1] == 0), True)
    for axis in "xy":
        ways = [one.history[f"block_velocity_{axis}"][-1] for one in (run, small)]
        case.check(f"{name}: velocity along {axis} at the end less that with small steps, over 5 m/s", (ways[0] - ways[1]) / 5, 0, 1e-2)
    case.check_within(f"{name}: cycles with small steps over those when subcycled", small.history["cycle"][-1] / run.history["cycle"][-1], 2, 9)
    case.check_within(f"{name}: most substeps", numpy.max(run.history["substeps"]), 4, 16)
    case.same_bits(name, recipe, with_levels(deck, 5), run)
case.restarts(name, recipe, with_levels(deck, 5), run, 0.7e-3)

# A jointed column under stress and its weight, with thin elements at the joint, stays at rest.
recipe = {
    "dimension": 2,
    "parts": [
        {"shape": "box", "block": "lower", "lines": {"x": lines([0, 0.2], [4]), "y": lines([-2, -1.99, -0.01, 0], [1, 38, 1])}},
        {"shape": "box", "block": "upper", "lines": {"x": lines([0, 0.2], [4]), "y": lines([0, 2], [40])}},
    ],
    "node_sets": {"bottom": {"where": {"y": -2}}}, "side_sets": {"top": {"where": {"y": 2}}},
}  # fmt: skip
stress = {"stress": [0, -1e6, 0, 0, 0, 0], "stress_point": [0, 2, 0], "stress_gradient": [0, DENSITY * 10, 0, 0, 0, 0]}
deck = {
    "materials": STONE, "blocks": {"lower": {"material": "stone"}, "upper": {"material": "stone"}},
    "joints": {"bed": {"model": "linear", "normal_stiffness": 1e11, "friction": 0.5}},
    "contact": {"pairs": [{"blocks": ["lower", "upper"], "joint": "bed", "declared": True}]},
    "initial": [{"block": "lower", **stress}, {"block": "upper", **stress}], "gravity": [0, -10, 0],
    "conditions": [{"type": "fixed", "node_set": "bottom"}, {"type": "pressure", "side_set": "top", "value": 1e6}],
    "time": {"end": 0.02, "subcycling": {"levels": 4}}, "output": {"every": 0.02},
    "history": {"every": 0, "probes": [{"name": "bottom", "node_set": "bottom", "reaction": True}]},
}  # fmt: skip
run = case.run("rest", recipe, deck, load=1e6)
force = 0.2 * (1e6 + DENSITY * 10 * 4)
for when, row in (("start", 0), ("end", -1)):
    case.check(f"rest: reaction at the {when} over the weight and the load", run.history["bottom_reaction_y"][row] / force, 1, 1e-9)
case.check_within("rest: most substeps", numpy.max(run.history["substeps"]), 2, 8)
case.check("rest: largest speed at the end [m/s]", numpy.max(numpy.abs(run.results.nodal("velocity_y"))), 0, 1e-9)

# A pulse leaves through an absorbing side at a thin element: dashpots act once in a cycle, so nothing there is substepped.
recipe = {
    "dimension": 2,
    "parts": [{"shape": "box", "block": "bar", "lines": {"x": lines([0, 0.5, 0.51, 1, 1.01], [10, 1, 10, 1]), "y": lines([0, 0.1], [2])}}],
    "side_sets": {"near": {"where": {"x": 0}}, "far": {"where": {"x": 1.01}}},
}  # fmt: skip
push = {"times": [*(1e-3 * phases).tolist(), 1], "values": [*(1e6 * numpy.sin(numpy.pi * phases) ** 2).tolist(), 0]}
deck = {
    "materials": STONE, "blocks": {"bar": {"material": "stone"}}, "contact": {"enabled": False},
    "conditions": [{"type": "pressure", "side_set": "near", "value": push}, {"type": "absorbing", "side_set": "far"}],
    "time": {"end": 4e-3, "subcycling": {"levels": 4}}, "output": {"every": 4e-3}, "history": {"every": 0},
}  # fmt: skip
run = case.run("absorbing", recipe, deck, energy=1e-2)
case.check("absorbing: kinetic energy that is left over the largest", run.history["kinetic"][-1] / numpy.max(run.history["kinetic"]), 0, 1e-3)

# A load comes up on a thin element: it acts in all of its substeps.
recipe = {
    "dimension": 2,
    "parts": [{"shape": "box", "block": "bar", "lines": {"x": lines([0, 0.01, 1], [1, 19]), "y": lines([0, 0.1], [2])}}],
    "node_sets": {"far": {"where": {"x": 1}}}, "side_sets": {"near": {"where": {"x": 0}}},
}  # fmt: skip
deck = {
    "materials": STONE, "blocks": {"bar": {"material": "stone"}}, "contact": {"enabled": False},
    "conditions": [
        {"type": "fixed", "node_set": "far"},
        {"type": "pressure", "side_set": "near", "value": {"times": [0, 1e-3, 1], "values": [0, 1e5, 1e5]}},
    ],
    "time": {"end": 5e-3}, "output": {"every": 5e-3},
    "history": {"every": 0, "probes": [{"name": "thin", "point": [0.005, 0.05, 0], "variables": ["stress_xx"]}]},
}  # fmt: skip
small = case.run("load, small steps", recipe, deck)
run = case.run("load", recipe, with_levels(deck, 4), energy=1e-2)
case.check_within("load: most substeps", numpy.max(run.history["substeps"]), 4, 8)
for what, of in (("least", numpy.min), ("largest", numpy.max)):
    stress = [of(one.history["thin_stress_xx"]) for one in (small, run)]
    case.check(f"load: {what} stress of the thin element less that with small steps, over p", (stress[1] - stress[0]) / 1e5, 0, 2e-2)

# What it does not go with.
recipe, deck = bar(2)
for key, changes in (
    ("time.fixed_step", {"time": {"end": 1e-4, "fixed_step": 1e-7, "subcycling": {"levels": 3}}}),
    ("time.mass_scaling", {"time": {"end": 1e-4, "mass_scaling": {"step": 1e-5}, "subcycling": {"levels": 3}}}),
    ("damping.local", {"damping": {"local": 0.5}, "time": {"end": 1e-4, "subcycling": {"levels": 3}}}),
    ("damping.kinetic", {"damping": {"kinetic": True}, "time": {"end": 1e-4, "subcycling": {"levels": 3}}}),
):
    refused = case.attempt(f"refused {key}", recipe, {**deck, **changes})
    case.check_equal(f"{key}: exit code", refused.code, 3)
    case.check_equal(f"{key}: the message names it", f"time.subcycling does not go with {key}" in refused.output, True)
refused = case.attempt("refused levels", recipe, with_levels(deck, 9))
case.check_equal("nine levels: exit code", refused.code, 3)
case.finish()
