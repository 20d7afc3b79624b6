"""V24: a block bounces off a linear contact, without and with damping."""

import math

import numpy
from coplanetest import Case
from coplanetest.rebound import restitution

case = Case("V24", __file__)
length, density, modulus, stiffness, speed = 0.1, 2300.0, 33e9, 1e9, 1.0
frequency = math.sqrt(stiffness / (density * length))  # of the rigid block [rad/s]
# An elastic bar, free at its top, on a spring at its base: beta L tan(beta L) = k L / E, of which the first root
# gives omega = sqrt(k/m) (1 - epsilon/6), epsilon = k L / E.
elastic = frequency * (1 - stiffness * length / modulus / 6)

deck = case.load()
run = case.run("elastic", case.load("mesh.yaml"), deck, remainder=1e-3)
h = run.history
touching = h["time"][numpy.flatnonzero(h["stick"] + h["slip"])]
case.check("time in contact [s]", touching[-1] - touching[0], math.pi / elastic, 0.01, relative=True)
case.check("largest closure [m]", -numpy.min(h["base_displacement_y"]), speed / frequency, 0.01, relative=True)
case.check("restitution", h["block_velocity_y"][-1] / speed, 1, 0.01)
# A closure taken half a step too early would feed energy in at a rate of omega^2 dt / 2.
case.check("drift of the energy", numpy.max(numpy.abs(h["error"])) / h["kinetic"][0], 0, 1e-3)

# Damping is a fraction of critical for what moves with the surfaces, half of an element: a block of one element as a
# whole feels zeta / sqrt(2). The anvil is made so heavy that it does not count.
deck["materials"]["anvil"]["density"] = 2.3e9
# A dashpot takes the velocity half a step before its force: an error of first order, 1.4 % at 0.8 and zeta 0.6.
deck["time"]["step_factor"] = 0.4
for zeta in (0.05, 0.21545, 0.6):
    deck["contact"]["damping"] = {"normal": zeta * math.sqrt(2)}
    run = case.run(f"damped_{zeta}", case.load("mesh_element.yaml"), deck)
    h = run.history
    e = restitution(zeta)
    case.check(f"restitution, zeta {zeta}", h["block_velocity_y"][-1] / speed, e, 0.01, relative=True)
    case.check(f"damping work, zeta {zeta} [J]", h["contact_damping"][-1], (1 - e**2) * h["kinetic"][0], 0.02, relative=True)
    # Work of the dashpot by the velocity before its force alone would leave a gain of first order in the step.
    case.check(f"contact remainder, zeta {zeta}, over the energy", h["contact_remainder"][-1] / h["kinetic"][0], 0, 2e-4)
case.finish()
