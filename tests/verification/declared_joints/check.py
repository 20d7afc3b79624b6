"""Declared joints close what lies on each other, and nothing beside; they hold nothing where they carry nothing, and make nothing where walls fall."""

import math
import sys

import netCDF4
import numpy
from coplanetest import Case, walls

case = Case("declared_joints", __file__)
ROCK = {"model": "linear_elastic", "density": 2000, "youngs_modulus": 1e9, "poisson_ratio": 0.25}
SPEED = math.sqrt(1.2e9 / 2000)  # of P waves [m/s]
BOND = {"model": "bilinear", "normal_stiffness": 2e11, "shear_stiffness": 8e10, "cohesion": 1e9, "tensile_strength": 1e9, "tension_energy": 1e9, "shear_energy": 1e9, "resists_bending": True}

# --- every face of slender triangles and tetrahedra ---------------------------------------------------------------------
bonded = {"materials": {"rock": ROCK}, "blocks": {"body": {"material": "rock"}}, "joints": {"bond": BOND},
          "contact": {"pairs": [{"joint_set": "bonds", "joint": "bond", "declared": True}]}, "time": {"end": 1e-3}, "history": {"every": 1e-4}, "output": {"planes": False}}  # fmt: skip
for name, size, divisions, split in (("two cells", [0.1, 0.06], [1, 2], "triangles"), ("slender", [0.3, 0.06], [3, 8], "triangles"), ("in space", [0.1, 0.1, 0.06], [1, 2, 3], "tetrahedra")):
    recipe = {"dimension": len(size), "parts": [{"shape": "box", "block": "body", "size": size, "divisions": divisions, "split": split}]}
    joints = {"joints": {"bonds": {"every_face": "body"}}}
    run = case.attempt(name.replace(" ", "_"), recipe, bonded, joints=joints)  # nothing moves: there is nothing that balances could be compared with
    if not case.check_equal(f"{name}: exit code", run.code, 0):
        sys.exit(run.output)
    with netCDF4.Dataset(run.path("mesh.e")) as mesh:
        cut = sum(len(mesh.variables[sides]) for sides in mesh.variables if sides.startswith("elem_ss")) // 2
    case.check_equal(f"{name}: planes that hold, and faces that have been cut", int(run.history["stick"][-1]), cut)
    case.check(f"{name}: largest velocity over that of waves", numpy.abs(run.results.nodal("velocity")).max() / SPEED, 0, 1e-12)
case.same_bits("in_space", recipe, bonded, run, ranks=3, joints=joints)

# --- soft joints that an initial stress has closed by as much as a face is long ------------------------------------------------
def closed_by(law, dimension, forces="auto"):
    """Two blocks on each other, joined by `law`, whose stress the joint bears from the start."""
    deep = [0.5] if dimension == 3 else []
    recipe = {"dimension": dimension, "node_sets": {"base": {"where": {"y": 0}}}, "side_sets": {"lid": {"where": {"y": 0.8}}},
              "parts": [{"shape": "box", "block": block, "min": [0, y] + [0] * len(deep), "size": [0.8, 0.4] + deep, "divisions": [cells, 2] + [2] * len(deep)}
                        for block, y, cells in (("lower", 0, 4), ("upper", 0.4, 4 if dimension == 2 else 3))]}  # fmt: skip
    deck = {"materials": {"rock": ROCK}, "blocks": {block: {"material": "rock"} for block in ("lower", "upper")}, "joints": {"soft": {"friction": 0.5, **law}},
            "contact": {"forces": forces, "pairs": [{"blocks": ["lower", "upper"], "joint": "soft", "declared": True}]},
            "initial": [{"block": block, "stress": [0, -STRESS, 0, 0, 0, 0]} for block in ("lower", "upper")],
            "conditions": [{"type": "fixed", "node_set": "base"}, {"type": "pressure", "side_set": "lid", "value": STRESS}],
            "time": {"end": 5e-3}, "history": {"every": 1e-4}, "output": {"planes": False}}  # fmt: skip
    return recipe, deck


STRESS, FACE = 1e7, 0.2
MODULUS = 1.2e9  # of P waves
for dimension in (2, 3):
    for part in (0.3, 0.8, 2.5):  # of a face
        k = STRESS / (part * FACE)
        for law in ({"model": "linear", "normal_stiffness": k}, {"model": "closure_curve", "initial_stiffness": k / 3, "maximum_closure": 1.5 * part * FACE, "shear_stiffness": k},
                    {"model": "penalty", "stiffness_fraction": 2 * k * FACE / MODULUS}):  # fmt: skip
            for forces in ("auto", "common_normal") if law["model"] == "linear" else ("auto",):
                name = f"{law['model']} joint closed by {part:g} of a face by its stress, {dimension}D, {forces}"
                recipe, deck = closed_by(law, dimension, forces)
                run = case.attempt(f"closed_{law['model']}_{part}_{dimension}_{forces}", recipe, deck)
                if not case.check_equal(f"{name}: exit code", run.code, 0):
                    continue
                h = run.history
                stored = h["contact_stored"][0]
                case.check(f"{name}: kinetic energy over what the joint stores", h["kinetic"].max() / stored, 0, 1e-20)
                case.check(f"{name}: contact remainder over that", numpy.abs(h["contact_remainder"]).max() / stored, 0, 1e-9)
                case.check(f"{name}: planes that are said to lie too deep", h["too_deep"].max(), 0, 0)
                if law["model"] == "linear":
                    case.check(f"{name}: energy of the joint [J]", stored, STRESS**2 / (2 * k) * 0.8 * (0.5 if dimension == 3 else 1), 1e-9, relative=True)
case.same_bits("closed_penalty_2.5_3_auto", recipe, deck, run, ranks=2, threads=2)

# --- contact damping on a joint that carries nothing ----------------------------------------------------------------------
for angle in (0, 37, 90):
    along = numpy.array([math.cos(math.radians(angle)), math.sin(math.radians(angle)), 0])
    recipe = {"dimension": 2, "parts": [{"shape": "box", "block": block, "min": [0, y], "size": [0.4, 0.2], "divisions": [n, 2], "about": [0, 0], "rotate": angle}
                                        for block, y, n in (("lower", -0.2, 3), ("upper", 0, 2))]}  # fmt: skip
    deck = {"materials": {"rock": ROCK}, "blocks": {block: {"material": "rock", "rigid": True} for block in ("lower", "upper")},
            "joints": {"smooth": {"model": "linear", "normal_stiffness": 1e8, "friction": 0}},
            "contact": {"damping": {"shear": 0.2}, "pairs": [{"blocks": ["lower", "upper"], "joint": "smooth", "declared": True}]},
            "initial": [{"block": "upper", "velocity": along.tolist()}], "time": {"end": 0.02}, "history": {"every": 0.002, "rigid": ["upper"]}}  # fmt: skip
    h = case.run(f"slides_{angle}", recipe, deck).history
    case.check(f"block that slides at {angle} degrees: its speed at the end [m/s]", sum(along[c] * h[f"upper_velocity_{axis}"][-1] for c, axis in enumerate("xy")), 1, 1e-12)

# --- blocks that slide on over what their joint has absorbed ------------------------------------------------------------------
def slides_on(name, built_in, seam=0.0, skin=None, dimension=2, declared=True):
    """A block slides at 5 m/s and with a friction of 0.3 from one slab to the next, `seam` behind it, whose tops the mesh has `built_in` apart
    from it (below zero it lies in them)."""
    deep = [0.2] if dimension == 3 else []
    boxes = (("slab", [-0.4, -0.2], [0.7, 0.2], [7, 2]), ("slab", [0.3 + seam, -0.2], [0.7, 0.2], [7, 2]), ("block", [0, built_in], [0.2, 0.2], [3, 2]))
    recipe = {"dimension": dimension, "node_sets": {"base": {"block": "slab"}},
              "parts": [{"shape": "box", "block": block, "min": low + [0] * len(deep), "size": size + deep, "divisions": cells + [2] * len(deep)}
                        for block, low, size, cells in boxes]}  # fmt: skip
    contact = {"pairs": [{"blocks": ["*", "*"], "joint": "rough", "declared": declared}]}
    if skin:
        contact["skin"] = skin
    if not declared:
        contact["initial_overlap"] = "allow"
    deck = {"materials": {"rock": {"model": "linear_elastic", "density": 2000, "youngs_modulus": 1e10, "poisson_ratio": 0.2}},
            "blocks": {block: {"material": "rock"} for block in ("slab", "block")},
            "joints": {"rough": {"model": "linear", "normal_stiffness": 5e10, "friction": 0.3}}, "contact": contact, "gravity": [0, -10, 0],
            "conditions": [{"type": "fixed", "node_set": "base"}], "initial": [{"block": "block", "velocity": [5, 0, 0]}],
            "time": {"end": 0.08}, "history": {"every": 1e-3, "probes": [{"name": "block", "block": "block"}]}}  # fmt: skip
    run = case.run(name.replace(" ", "_"), recipe, deck, remainder=1e-3)
    h = run.history
    case.check(f"{name}: speed at the end [m/s]", h["block_velocity_x"][-1], 5 - 0.3 * 10 * h["time"][-1], 2e-3, relative=True)
    case.check(f"{name}: largest way up or down [m]", numpy.abs(h["block_displacement_y"]).max(), 0, 1e-5)
    return recipe, deck, run


slides_on("overlap of 3 mm", -0.003)
slides_on("overlap of 1 mm that is allowed", -0.001, declared=False)
slides_on("gap of 10 mm", 0.01)
slides_on("gap and seam of 10 mm", 0.01, 0.01)
slides_on("gap and seam of 10 mm with a skin of 30 mm", 0.01, 0.01, 0.03)
sliding = slides_on("overlap of 3 mm in space", -0.003, dimension=3)
case.same_bits("sliding", *sliding, ranks=3)

# --- walls that fall apart along joints which have absorbed gaps and overlaps of the mesh -----------------------------------
for across, up, speed in ((0.02, 0.02, 34), (0.04, 0.015, 30), (0.015, 0.04, 30), (-0.01, 0.02, 30), (-0.01, -0.01, 30)):
    top = 5 * (0.2 + up)
    recipe = {"dimension": 2, "node_sets": {"floor": {"block": "floor"}},
              "parts": [{"shape": "box", "block": "floor", "min": [-0.5, -0.2], "size": [3.5, 0.2], "divisions": [12, 1]},
                        *walls.brick_by_brick((0.4, 0.2), 5, 3, across, up),
                        {"shape": "box", "block": "bar", "min": [-0.9, 0.45 * top], "size": [0.8, 0.15], "divisions": [8, 2]}]}  # fmt: skip
    deck = {"materials": {"stone": {"model": "linear_elastic", "density": 2300, "youngs_modulus": 2e10, "poisson_ratio": 0.2}},
            "blocks": {block: {"material": "stone"} for block in ("floor", "bricks", "bar")},
            "joints": {"dry": {"model": "linear", "normal_stiffness": 2e10, "friction": 0.4}, "touch": {"model": "penalty", "friction": 0.4}},
            "contact": {"default_joint": "touch", "pairs": [{"blocks": ["bricks", block], "joint": "dry", "declared": True} for block in ("bricks", "floor")]},
            "gravity": [0, -9.81, 0], "conditions": [{"type": "fixed", "node_set": "floor", "components": ["x", "y"]}],
            "initial": [{"block": "bar", "velocity": [speed, 0, 0]}], "time": {"end": 0.15, "step_factor": 0.4}, "history": {"every": 1e-4}}  # fmt: skip
    name = f"wall with gaps of {1000 * across:g} and {1000 * up:g} mm in head and bed joints, struck at {speed} m/s"
    run = case.run(f"wall_{across}_{up}_{speed}", recipe, deck, energy=5e-3, remainder=3e-3)
    lost = run.history["contact_remainder"]
    in_play = run.history["kinetic"][0]
    case.check(f"{name}: largest gain within 0.1 ms over the energy", -numpy.diff(lost).min() / in_play, 0, 1e-3, kept="gain of contact within 0.1 ms")
case.same_bits("wall", recipe, deck, run, ranks=2, threads=2)
case.finish()
