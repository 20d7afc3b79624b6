"""Contact damping goes by the mass of the elements at a surface: a block rebounds as a rigid mass does, however it is cut and meshed."""

import math

from coplanetest import Case
from coplanetest.rebound import restitution

case = Case("contact_damping", __file__)
base = case.load("tests/verification/V24_rebound/deck.yaml")
# The anvil is made so heavy that it does not count. A dashpot takes the velocity half a step before its force: an error of first order.
base["materials"]["anvil"]["density"] = 2.3e9
base["time"]["step_factor"] = 0.4
ZETA, SPEED, SIDE = 0.21545, 1.0, 0.1  # of critical for the whole block [-]; [m/s]; [m]


def box(block, low, size, divisions, **other):
    return {"shape": "box", "block": block, "min": low, "size": size, "divisions": divisions, **other}


def scene(dimension=2, parts=1, across=1, split="none", left=-SIDE):
    """A block one element high, of flush parts, on an anvil of one element that begins at x = left."""
    more = [0.0] * (dimension - 2)
    width = SIDE / parts
    blocks = [box("block", [i * width, 0, *more], [width, SIDE, *[SIDE for _ in more]], [across, 1, *[across for _ in more]], split=split) for i in range(parts)]
    anvil = box("slab", [left, -SIDE, *[-SIDE for _ in more]], [3 * SIDE, SIDE, *[3 * SIDE for _ in more]], [1] * dimension)
    return {"dimension": dimension, "parts": [*blocks, anvil], "node_sets": {"slab": {"block": "slab"}, "base": {"block": "block", "where": {"y": 0}}}}


# What moves with a surface is half of the element behind each face. A block one element high has so many times that mass, and feels zeta over the root.
for name, masses, recipe, more in (
    ("one element", 2, scene(), {}),
    ("four elements", 2, scene(across=4), {}),
    ("four flush parts", 2, scene(parts=4), {}),
    ("triangles", 4, scene(across=4, split="triangles"), {}),
    ("hexahedra", 2, scene(3, across=2), {}),
    ("tetrahedra", 6, scene(3, across=2, split="tetrahedra"), {}),
    ("a disc", 2, scene(across=4, left=0), {"geometry": "axisymmetric"}),
    ("one element, common normal", 2, scene(), {"forces": "common_normal"}),
):
    forces = {"forces": more.pop("forces")} if "forces" in more else {}
    deck = {**base, **more, "contact": {**base["contact"], **forces, "damping": {"normal": ZETA * math.sqrt(masses)}}}
    word = name.replace(", ", "_").replace(" ", "_")
    run = case.run(word, recipe, deck)
    h, e = run.history, restitution(ZETA)
    case.check(f"{name}: restitution", h["block_velocity_y"][-1] / SPEED, e, 0.01, relative=True)
    case.check(f"{name}: damping work over the energy", h["contact_damping"][-1] / h["kinetic"][0], 1 - e**2, 0.02, relative=True)
    # Work of the dashpot by the velocity before its force alone would leave a gain of first order in the step.
    case.check(f"{name}: contact remainder over the energy", h["contact_remainder"][-1] / h["kinetic"][0], 0, 2e-4)
    if name in ("four flush parts", "tetrahedra"):
        case.same_bits(word, recipe, deck, run, ranks=3)
        case.same_bits(f"{word}_threads", recipe, deck, run, ranks=1, threads=2)
case.restarts(word, recipe, deck, run, near=1e-3)
case.finish()
