"""V94: bonded elements: a bar is pulled apart, a strip is sheared off, a bar of tetrahedra breaks."""

import copy

import numpy
from coplanetest import Case

case = Case("V94", __file__)


def pieces(run):
    """Elements of each fragment at the end."""
    with open(run.path("run_fragments.csv")) as file:
        rows = [line.split(",") for line in file.read().splitlines()[1:]]
    return sorted(int(float(row[3])) for row in rows if row[0] == rows[-1][0])


# --- mode I: a bar is pulled apart at a weak section -----------------------------------------------------------
deck, recipe, joints = case.load(), case.load("mesh.yaml"), case.load("joints.yaml")
area, length, E = 0.1, 0.4, deck["materials"]["rock"]["youngs_modulus"]
weak = deck["joints"]["weak"]
run = case.run("bar", recipe, deck, joints=joints)
h = run.history
force, path = -h["left_reaction_x"], h["right_displacement_x"]
elastic = (path > 1e-5) & (path < 2.5e-5)
# 16 layers and 15 springs in series.
softer = 1 / (1 + 15 * E / (length * weak["normal_stiffness"]))
case.check("stiffness over that of the rock", numpy.polyfit(path[elastic], force[elastic], 1)[0] * length / (E * area), softer, 1e-3, relative=True)
case.check("largest force over the area [Pa]", force.max() / area, weak["tensile_strength"], 0.03, relative=True)
case.check("fracture energy [J]", h["contact_fracture"][-1], weak["tension_energy"] * area, 0.01, relative=True)
case.check_equal("elements of the fragments at the end", pieces(run)[-2:], [32, 32])
case.same_bits("bar", recipe, deck, run, joints=joints)
case.restarts("bar", recipe, deck, run, h["time"][force.argmax()], joints=joints)  # where the bond begins to soften

# --- mode II: a strip is sheared off along a weak plane ----------------------------------------------------------
sheared, along = copy.deepcopy(deck), {"weak": {"planes": {"point": [0, 0.05], "normal": [0, 1]}}, "bonds": joints["joints"]["bonds"]}
weak = sheared["joints"]["weak"]
weak.update(tensile_strength=6e6, cohesion=4e6, shear_energy=200)
sheared["conditions"] = [{"type": "velocity", "node_set": side, "components": ["x", "y"], "value": ["0.025*min(t/0.0005,1)" if side == "upper" else 0, 0, 0]} for side in ("lower", "upper")]
sheared["conditions"] += [{"type": "velocity", "node_set": side, "components": ["y"], "value": [0, 0, 0]} for side in ("left", "right")]
sheared["history"]["probes"] = [{"name": "lower", "node_set": "lower", "reaction": True}, {"name": "upper", "node_set": "upper"}]
run = case.run("strip", case.load("mesh_shear.yaml"), sheared, joints={"joints": along}, load=0.4 * weak["cohesion"])
force = -run.history["lower_reaction_x"]
case.check("strip: largest force over the area [Pa]", force.max() / 0.4, weak["cohesion"], 0.03, relative=True)
case.check("strip: fracture energy [J]", run.history["contact_fracture"][-1], weak["shear_energy"] * 0.4, 0.01, relative=True)
case.check("strip: force at the end over the largest", abs(force[-1]) / force.max(), 0, 1e-2)
case.check_equal("strip: elements of the fragments at the end", pieces(run)[-2:], [32, 32])

# --- tetrahedra: wedges that lie on each other, whose surfaces do not go on in each other -------------------------
recipe = {"dimension": 3, "parts": [{"shape": "box", "block": "bar", "min": [0, 0, 0], "max": [0.4, 0.1, 0.1], "divisions": [4, 1, 1], "split": "tetrahedra"}],
          "node_sets": {"left": {"where": {"x": 0}}, "right": {"where": {"x": 0.4}}}}  # fmt: skip
broken = {
    "materials": {"rock": {"model": "linear_elastic", "density": 2500, "youngs_modulus": 30e9, "poisson_ratio": 0.2}},
    "blocks": {"bar": {"material": "rock"}},
    "joints": {"bond": {"model": "mortar", "normal_stiffness": 6e13, "shear_stiffness": 2.4e13, "tensile_strength": 3e6, "cohesion": 12e6, "friction": 0.7, "tension_energy": 10, "shear_energy": 40}},
    "contact": {"pairs": [{"joint_set": "bond", "joint": "bond", "declared": True}]},
    "conditions": [{"type": "velocity", "node_set": side, "components": ["x"], "value": [f"{speed}*min(t/1e-3,1)", 0, 0]} for side, speed in (("left", -0.02), ("right", 0.02))],
    "time": {"end": 3e-3},
}  # fmt: skip
run = case.attempt("tetrahedra", recipe, broken, joints={"joints": {"bond": {"every_face": "bar"}}})
if case.check_equal("tetrahedra: exit code", run.code, 0):
    h = run.history
    case.check("tetrahedra: contact remainder over the work done", numpy.max(numpy.abs(h["contact_remainder"])) / h["external_work"].max(), 0, 5e-3)
    case.check_within("tetrahedra: fracture energy over that of the section", h["contact_fracture"][-1] / (10 * 0.1**2), 0.9, 6)
case.finish()
