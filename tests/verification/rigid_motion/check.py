"""Given motion of rigid bodies: places, reaction forces and moments against exact answers."""

import math

import numpy
from coplanetest import Case

case = Case("rigid_motion", __file__)

# A piston moves by 0.1 mm along a smooth course and stops; bar and joint are springs in series.
recipe, deck = case.load("mesh_piston.yaml"), case.load("deck_piston.yaml")
run = case.run("piston", recipe, deck)
h = run.history
way, young, joint, section = 1e-4, 2e9, 2e10, 0.2
pressure = way / (1 / young + 1 / joint)
case.check("piston: way [m]", -h["piston_displacement_x"][-1], way, 1e-3, relative=True)
case.check("piston: reaction force along x [N]", -h["piston_reaction_x"][-1], pressure * section, 2e-3, relative=True)
# The bar's middle and the piston's have the same height: no moment.
moment = numpy.abs(h["piston_reaction_moment_z"][-1]) / (pressure * section)
case.check("piston: arm of the reaction [m]", moment, 0, 1e-4)
stress = run.results.element("bar", "stress_xx")
case.check("piston: largest error of the axial stress over it", numpy.max(numpy.abs(stress + pressure)) / pressure, 0, 5e-3)
case.same_bits("piston", recipe, deck, run)

# Two plates of one block are two bodies: angle 20 t^2, moment 40 J, way t^2, force 2 M.
recipe, deck = case.load("mesh_wheel.yaml"), case.load("deck_wheel.yaml")
run = case.run("wheel", recipe, deck)
h = run.history
mass = 7850 * 0.4 * 0.2 * 0.1
inertia = mass * (0.4**2 + 0.2**2) / 12
for body in ("wheel_1", "wheel_2"):
    case.check(f"{body}: reaction force [N]", h[f"{body}_reaction_x"][-1], 2 * mass, 1e-9, relative=True)
    # the mean of a step's vectors, 40 t + (40 t)^3 dt^2 / 12
    case.check(f"{body}: reaction moment [N m]", h[f"{body}_reaction_moment_z"][-1], 40 * inertia, 1e-3, relative=True)
    case.check(f"{body}: spin at the end [1/s]", h[f"{body}_spin_z"][-1], 20, 1e-4, relative=True)
    case.check(f"{body}: way along x [m]", h[f"{body}_displacement_x"][-1], 0.25, 1e-9, relative=True)
angle, arm = 20 * 0.5**2, complex(-0.2, -0.1)
turned = arm * complex(math.cos(angle), math.sin(angle)) - arm
for axis, value in (("x", turned.real + 0.25), ("y", turned.imag)):
    case.check(f"corner: displacement {axis} [m]", h[f"corner_displacement_{axis}"][-1], value, 1e-9)
# The table of blocks has the energy of the bodies, not that of masses at the corners.
rows = [line.split(",") for line in open(run.path("run_blocks.csv"))]
kinetic = float(rows[-1][rows[0].index("kinetic[J]")])
case.check("kinetic energy of the block [J]", kinetic, 2 * (0.5 * mass * 1**2 + 0.5 * inertia * 20**2), 1e-3, relative=True)
case.check("the same as in the ledger", kinetic / h["kinetic"][-1], 1, 1e-14)
case.same_bits("wheel", recipe, deck, run)
case.finish()
