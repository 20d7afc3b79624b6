"""Contacts that are closed by tenths of an element and slide over lines of the mesh, to and fro: none of them lets go."""

import numpy
from coplanetest import Case, program
from coplanetest.slides import slid_block

case = Case("deep_slides", __file__)

CLOSURE, STIFFNESS = 0.015, 1e8  # 0.3 of a quadrilateral [m], and [Pa/m]


def block_on_slab(dimension, stroke, press, joint, geometry="plane_strain", split=None, closure=CLOSURE):
    """A block is pressed on a slab, led to `stroke`, back as far on the other side of where it began, and on by most of an element. Their
    mesh lines coincide where it begins. `press`: the pressure before the full one comes, over that."""
    third, flat = ([0.1], [2]) if dimension == 3 else ([], [])
    first = 1.0 if geometry == "axisymmetric" else 0.0
    parts = [
        {"shape": "box", "block": "slab", "min": [first, -0.1, *[0.0] * len(third)], "size": [0.9, 0.1, *third], "divisions": [18, 2, *flat]},
        {"shape": "box", "block": "block", "min": [first + 0.1, 0.0, *[0.0] * len(third)], "size": [0.2, 0.1, *third], "divisions": [4, 2, *flat]},
    ]  # fmt: skip
    for part in parts:
        part |= {"split": split} if split else {}
    recipe = {
        "dimension": dimension, "parts": parts, "node_sets": {"slab": {"block": "slab"}, "block": {"block": "block"}},
        "side_sets": {"top": {"block": "block", "where": {"y": 0.1}}},
    }  # fmt: skip
    ways = {"times": [0, 0.05, 0.08, 0.14, 0.28, 0.5], "values": [0, 0, stroke, -stroke, -stroke, 0.045]}
    full = STIFFNESS * closure
    deck = {
        "geometry": geometry,
        "materials": {"soft": {"model": "linear_elastic", "density": 2000, "youngs_modulus": 1e8, "poisson_ratio": 0}},
        "blocks": {"slab": {"material": "soft"}, "block": {"material": "soft"}},
        "joints": {"touch": {"normal_stiffness": STIFFNESS, **joint}},
        "contact": {"default_joint": "touch", "damping": {"normal": 0.5}},
        "conditions": [
            {"type": "fixed", "node_set": "slab"},
            {"type": "displacement", "node_set": "block", "components": ["x", "z"][: dimension - 1], "value": [ways, 0, 0]},
            {"type": "pressure", "side_set": "top", "value": {"times": [0, 0.04, 0.16, 0.25], "values": [0, press * full, press * full, full]}},
        ],
        "damping": {"mass": 50},
        "time": {"end": 0.5},
        "output": {"every": 0.5, "planes": False},
        "history": {"every": 0.5 / 300, "joints": ["touch"]},
    }  # fmt: skip
    return recipe, deck


LINEAR, ROUGH = {"model": "linear"}, {"model": "linear", "friction": 0.3}
SCENES = [
    ("1 mm to and fro", 2, 1e-3, 1.0, LINEAR, {}),
    ("10 mm", 2, 1e-2, 1.0, LINEAR, {}),
    ("pressed lightly first", 2, 1e-3, 0.05, LINEAR, {}),
    ("with friction", 2, 1e-3, 0.05, ROUGH, {}),
    # Of triangles, half as thick, the depth limit is 0.015 m.
    ("triangles", 2, 1e-3, 1.0, LINEAR, {"split": "triangles", "closure": 0.009}),
    ("rings", 2, 1e-3, 1.0, LINEAR, {"geometry": "axisymmetric"}),
    ("in space", 3, 1e-3, 1.0, LINEAR, {}),
]
for name, dimension, stroke, press, joint, how in SCENES:
    recipe, deck = block_on_slab(dimension, stroke, press, joint, **how)
    # Turning over lines of the mesh at such a depth is no small step: friction and damping take part of it.
    run = case.run(name, recipe, deck, energy=2e-3, momentum=1e-9, angular=1e-9)
    results = run.results
    block = numpy.unique(results.connectivity("block"))
    bottom = block[results.coordinates[block, 1] == 0]
    closures = -results.nodal("displacement_y")[bottom] / how.get("closure", CLOSURE)
    case.check(f"{name}: largest closure at the end over p / k", closures.max(), 1, 0.05)
    case.check(f"{name}: least closure at the end over p / k", closures.min(), 1, 0.05)
    case.check(f"{name}: pairs that are released, most of all", run.history["released"].max(), 0, 0)
    if name in ("rings", "in space"):
        case.same_bits(name, recipe, deck, run)


# Soft blocks pressed on slabs of the same, to a part of their height, and slid. The second ones roll onto their sides, whose faces take part.
FINE = {"block": (10, 6), "slab": (36, 6)}
MIXED = {"block": (5, 3), "slab": (36, 6)}
COARSE = {"block": (5, 3), "slab": (18, 3)}
for name, how in (
    ("to 0.75, slid", {"ratio": 0.75, "slide": 0.1, "friction": 0.4}),
    ("to 0.7, slid", {"ratio": 0.7, "slide": 0.1, "friction": 0.4}),
    ("to 0.7, slid, finer", {"ratio": 0.7, "slide": 0.1, "friction": 0.4, "block": (8, 6), "slab": (42, 6)}),
    ("to 0.6", {"ratio": 0.6, "slide": 0.0, "friction": 0.0}),
    ("to 0.75, slid, in space", {"ratio": 0.75, "slide": 0.1, "friction": 0.4, "dimension": 3}),
    ("to 0.8, slid on", {"ratio": 0.8, "slide": 0.3, "friction": 0.3, **COARSE}),
    ("to 0.8, slid on, back", {"ratio": 0.8, "slide": -0.2, "friction": 0.3, **COARSE}),
    ("to 0.75, slid on, no friction", {"ratio": 0.75, "slide": 0.3, "friction": 0, **COARSE}),
    ("to 0.75, slid on, rough", {"ratio": 0.75, "slide": 0.2, "friction": 0.6, **COARSE}),
    ("to 0.7, slid on, full integration", {"ratio": 0.7, "slide": 0.2, "friction": 0, "element": "full_integration", **COARSE}),
    ("to 0.7, slid on, triangles", {"ratio": 0.7, "slide": 0.2, "friction": 0, "split": "triangles", **COARSE}),
    ("to 0.8, slid on, finer", {"ratio": 0.8, "slide": 0.2, "friction": 0, **FINE}),
    ("to 0.8, slid on, slab finer", {"ratio": 0.8, "slide": 0.2, "friction": 0.4, **MIXED}),
    ("to 0.7, slid on, in space", {"ratio": 0.7, "slide": 0.15, "friction": 0, "dimension": 3, **COARSE}),
):
    run = case.run(f"punch {name}", *slid_block(**how), energy=5e-3, momentum=1e-11)
    force = run.history["touch_normal_force"]
    slid = force[len(force) // 2 :]
    least = 0.68 if "slid on" in name else 0.85  # one that is led so far tilts and rolls
    case.check(f"punch {name}: least force while it slides over the largest", slid.min() / force.max(), 1, 1 - least)
    remainder = run.history["contact_remainder"][-1] / abs(run.history["external_work"]).max()
    case.check(f"punch {name}: contact remainder over the work", remainder, 0, 2e-3)
# Pressed so that corners come to lie more than an element deep, a block goes through: that ends the run, or the log tells of it.
mesh, deck = slid_block(ratio=0.7, slide=0.2, friction=0, **FINE)
stopped = case.attempt("punch to 0.7, slid on, fine", mesh, deck)
deck["contact"]["lost_contact"] = "warn"
run = case.attempt("punch to 0.7, slid on, fine, warned of", mesh, deck)
force = run.history["touch_normal_force"]
gone = force[-1] < 0.3 * force.max()
case.check_equal("punch to 0.7, slid on, fine: ends with code 6 if it goes through", stopped.code, 6 if gone else 0)
case.check_equal("punch to 0.7, slid on, fine: told to go on, it does", run.code, 0)
case.check_equal("punch to 0.7, slid on, fine: and says that it goes through", "go through each other" in run.output, gone)
# The end is the same on other ranks and threads, and after a restart between the looks that decide.
deck["contact"]["lost_contact"] = "stop"
last = int(stopped.history["cycle"][-1])
others = {"3 ranks": {"ranks": 3}, "2 threads": {"threads": 2, "backend": "threads"}, "a restart": {"options": ["--set", "checkpoint.every_cycles=50"]}}
for words, how in others.items():
    again = case.attempt(f"punch to 0.7, slid on, fine, {words}", mesh, deck, **how)
    if words == "a restart":
        code, output = program.run_program(["run.yaml", "--restart"], again.folder)
        case.check_equal("punch to 0.7, slid on, fine, a restart: goes on from the last checkpoint", f": cycle {(last - 1) // 50 * 50}, t = " in output, True)
        case.check_equal("punch to 0.7, slid on, fine, a restart: ends with code 6", code, 6)
        case.check_equal("punch to 0.7, slid on, fine, a restart: in the same cycle", f"cycle {last}, " in output, True)
        continue
    case.check_equal(f"punch to 0.7, slid on, fine, {words}: exit code", again.code, stopped.code)
    case.check_equal(f"punch to 0.7, slid on, fine, {words}: last cycle", int(again.history["cycle"][-1]), last)
# What lies in another body by design is not lost: embedded bodies that fall and turn together, a block that a stage adds, an excluded pair.
turn = [{"block": name, "angular_velocity": [0, 0, 5], "center": [0.5, 0.5, 0]} for name in ("big", "inner")]
box = {"shape": "box", "block": "inner", "min": [0.3, 0.3], "size": [0.4, 0.4], "divisions": [7, 7], "rotate": 31}
parts = [{"shape": "box", "block": "big", "min": [0, 0], "size": [1, 1], "divisions": [10, 10], "rotate": 13}, box]
rubber = {"rubber": {"model": "neo_hookean", "density": 1000, "youngs_modulus": 1e6, "poisson_ratio": 0.3}}
both = {name: {"material": "rubber"} for name in ("big", "inner")}
common = {"materials": rubber, "blocks": both, "gravity": [0, -9.81, 0], "time": {"end": 1.5}, "output": {"planes": False}}
designs = {
    "embedded, turned": common | {"contact": {"initial_overlap": "allow"}, "initial": turn},
    "added by a stage": common | {"stages": [{"name": "first", "until": 0.1}, {"name": "second", "add": ["inner"]}]},
    "excluded": common | {"contact": {"pairs": [{"blocks": ["big", "inner"], "excluded": True}]}},
}
for words, deck in designs.items():
    run = case.attempt(f"in each other, {words}", {"dimension": 2, "parts": parts}, deck)
    case.check_equal(f"in each other, {words}: exit code", run.code, 0)
    case.check_equal(f"in each other, {words}: was looked at more than twice", bool(run.history["cycle"][-1] > 300), True)
    case.check_equal(f"in each other, {words}: no face is called lost", "faces lie in other bodies" in run.output, False)
case.finish()
