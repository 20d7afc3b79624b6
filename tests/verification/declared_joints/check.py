"""Declared joints close what lies on each other, and nothing beside; they hold nothing where they carry nothing."""

import math
import sys

import netCDF4
import numpy
from coplanetest import Case

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
case.finish()
