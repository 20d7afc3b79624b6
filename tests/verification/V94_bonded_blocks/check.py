"""V94: a bar whose elements are bonded at all their faces is pulled apart at a weak section."""

import numpy
from coplanetest import Case

case = Case("V94", __file__)
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
with open(run.path("run_fragments.csv")) as file:
    rows = [line.split(",") for line in file.read().splitlines()[1:]]
pieces = [int(float(row[3])) for row in rows if row[0] == rows[-1][0]]
case.check_equal("elements of the fragments at the end", sorted(pieces)[-2:], [32, 32])
case.same_bits("bar", recipe, deck, run, joints=joints)
case.finish()
