"""V94: bonded elements: a bar pulled apart, a strip sheared off, rows that are bent."""

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

# --- mode II: a strip is sheared off along a weak plane ----------------------------------------------------------
for bends in (False, True):
    name = "strip_bending" if bends else "strip"
    sheared, along = copy.deepcopy(deck), {"weak": {"planes": {"point": [0, 0.05], "normal": [0, 1]}}, "bonds": joints["joints"]["bonds"]}
    if bends:
        for joint in sheared["joints"].values():
            joint.update(resists_bending=True, stiffness_loss=1)
    sheared["joints"]["weak"].update(tensile_strength=6e6, cohesion=4e6, shear_energy=200)
    sheared["conditions"] = [{"type": "velocity", "node_set": side, "components": ["x", "y"], "value": ["0.025*min(t/0.0005,1)" if side == "upper" else 0, 0, 0]} for side in ("lower", "upper")]
    sheared["conditions"] += [{"type": "velocity", "node_set": side, "components": ["y"], "value": [0, 0, 0]} for side in ("left", "right")]
    sheared["history"]["probes"] = [{"name": "lower", "node_set": "lower", "reaction": True}, {"name": "upper", "node_set": "upper"}]
    run = case.run(name, case.load("mesh_shear.yaml"), sheared, joints={"joints": along}, load=0.4 * sheared["joints"]["weak"]["cohesion"])
    h, weak = run.history, sheared["joints"]["weak"]
    force, path = -h["lower_reaction_x"], h["upper_displacement_x"]
    case.check(f"{name}: largest force over the area [Pa]", force.max() / 0.4, weak["cohesion"], 0.03, relative=True)
    case.check(f"{name}: fracture energy [J]", h["contact_fracture"][-1], weak["shear_energy"] * 0.4, 0.01, relative=True)
    case.check(f"{name}: force at the end over the largest", abs(force[-1]) / force.max(), 0, 1e-2)
    case.check_equal(f"{name}: elements of the fragments at the end", pieces(run)[-2:], [32, 32])

# --- bending: rigid blocks that bonds alone hold together, so that the sag is that of the bonds ----------------------
row, hung, cuts = case.load("mesh_row.yaml"), case.load("deck_row.yaml"), case.load("joints_row.yaml")
bond, density = hung["joints"]["bond"], hung["materials"]["rock"]["density"]
arms = numpy.arange(0.1, 0.75, 0.1)[::-1]  # from the joints to the end: seven


def sag(gravity, height, width):
    """Of the end, by joints that turn by M / (k_n I) and slip by V / (k_s A)."""
    weight = density * gravity * height * width
    turns = weight * arms**2 / 2 / (bond["normal_stiffness"] * width * height**3 / 12)
    slips = weight * arms / (bond["shear_ratio"] * bond["normal_stiffness"] * height * width)
    return (turns * arms).sum() + slips.sum()


run = case.run("row", row, hung, joints=cuts)
case.check("row: sag of the end [m]", -run.history["end_displacement_y"][-1], sag(10, 0.1, 1), 2e-3, relative=True)
case.same_bits("row", row, hung, run, joints=cuts)
solid = copy.deepcopy(row)
solid["dimension"] = 3
for part, ends in zip(solid["parts"], ([0, 0.1], [0.1, 0.8])):
    part.update(min=[ends[0], 0, 0], max=[ends[1], 0.1, 0.15], divisions=[*part["divisions"], 1])
oblique = {**copy.deepcopy(hung), "gravity": [0, -10, 6]}
run = case.run("row_3d", solid, oblique, joints=cuts)
case.check("row in space: sag of the end [m]", -run.history["end_displacement_y"][-1], sag(10, 0.1, 0.15), 2e-3, relative=True)
case.check("row in space: the same along z [m]", run.history["end_displacement_z"][-1], sag(6, 0.15, 0.1), 2e-3, relative=True)
case.same_bits("row_3d", solid, oblique, run, joints=cuts)
at_one_point = copy.deepcopy(hung)
at_one_point["joints"]["bond"]["resists_bending"] = False
at_one_point["time"]["end"] = 0.1
run = case.run("row_at_one_point", row, at_one_point, joints=cuts)
case.check_within("bonds that carry at one point: sag after 0.1 s over that of the others", -run.history["end_displacement_y"][-1] / sag(10, 0.1, 1), 10, 100)

# --- strength: the root breaks when its first fibre reaches it -----------------------------------------------------
limit = bond["tensile_strength"] * 0.1**2 / 6 / (density * 0.1 * 0.7**2 / 2)
for name, change in (("brittle", {}), ("bilinear", {"model": "bilinear", "tension_energy": 60, "shear_energy": 500})):
    broken = copy.deepcopy(hung)
    broken["joints"]["bond"].update(change)
    broken["gravity"] = [0, "-16*t", 0]
    broken["time"]["end"] = 2.0
    broken["history"].update(joints=["bond"], every=2e-4)
    run = case.run(f"row_{name}", row, broken, joints=cuts)
    h = run.history
    opened = h["time"][numpy.argmax(h["bond_open_area"] > 0)]
    if name == "brittle":
        case.check("brittle row: gravity that breaks the root [m/s^2]", 16 * opened, limit, 0.02, relative=True)
        case.check("brittle row: fracture energy: the open half of what bending stored [J]", h["contact_fracture"][numpy.argmax(h["contact_fracture"] > 0)], bond["tensile_strength"] ** 2 / bond["normal_stiffness"] * 0.1 / 12, 0.02, relative=True)
    else:
        # Its energy is 60 J/m^2 where the bond of one point would take 50 until it reaches its strength: next to brittle.
        case.check_within("bilinear row: gravity that breaks the root over that of the first fibre", 16 * opened / limit, 0.98, 1.25)

# --- elastic elements: the sag of a beam of the modulus E / (1 + E / (k_n h)) ---------------------------------------
beam = {"dimension": 2, "parts": [{"shape": "box", "block": "rock", "size": [1.6, 0.1], "divisions": [16, 1]}], "node_sets": {"held": {"where": {"x": 0}}, "end": {"where": {"x": 1.6}}}}
soft = copy.deepcopy(hung)
soft["blocks"] = {"rock": {"material": "rock", "element": "assumed_strain"}}
soft["joints"]["bond"].update(normal_stiffness=5 * E / 0.1, tensile_strength=1e9)
soft["contact"]["pairs"] = soft["contact"]["pairs"][:1]
soft["damping"], soft["time"]["end"] = {"mass": 200}, 0.3
run = case.run("beam", beam, soft, joints={"joints": {"bonds": {"every_face": "rock"}}})
weight, inertia = density * 10 * 0.1, 0.1**3 / 12
bending = weight * 1.6**4 / (8 * E * inertia)
arms = numpy.arange(0.1, 1.55, 0.1)
turning = (weight * arms**3 / 2 / (5 * E / 0.1 * inertia)).sum()
shear = weight * 1.6**2 / 2 / (5 / 6 * E / 2 * 0.1) + weight * arms.sum() / (0.4 * 5 * E / 0.1 * 0.1)
case.check("beam of elastic elements: sag of the end [m]", -run.history["end_displacement_y"][-1], bending + turning + shear, 0.01, relative=True)
case.check("of it by turning of the bonds, over E / (k_n h) of that of the beam", turning / bending, 0.2, 0.02)

# --- in free flight: bending waves, with all momenta ----------------------------------------------------------------
free = copy.deepcopy(soft)
del free["damping"]
free["conditions"], free["gravity"] = [], [0, 0, 0]
free["initial"] = [{"block": "rock", "velocity_field": ["0.1*y", "2*x*(x-1.1)", 0]}]
free["time"]["end"] = 0.02
case.run("free", beam, free, joints={"joints": {"bonds": {"every_face": "rock"}}}, energy=2e-3)
case.finish()
