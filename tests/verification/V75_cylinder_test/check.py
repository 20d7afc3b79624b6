"""V75: the cylinder test: TNT in a tube of copper, against Gurney's estimate with the energy of the products' isentrope, and against
what fits measured walls."""

import numpy
from coplanetest import Case

case = Case("V75", __file__)

density, a, b, r1, r2, omega, energy = 1630, 371.2e9, 3.231e9, 4.15, 0.95, 0.3, 7e9
volume, pressure = 0.7317, 21e9  # behind the front
inner, outer, copper = 0.0127, 0.0153, 8960
constant = (pressure - a * numpy.exp(-r1 * volume) - b * numpy.exp(-r2 * volume)) * volume ** (1 + omega)


def gurney(expansion):
    """Radial speed of the tube when its outer radius has grown by that: all energy that the products have given away is kinetic,
    and their speed is linear in the radius."""
    area = outer**2 - inner**2  # of the tube, over pi: it stays
    v = ((outer + expansion) ** 2 - area) / inner**2
    left = a / r1 * numpy.exp(-r1 * v) + b / r2 * numpy.exp(-r2 * v) + constant / omega * v**-omega
    return numpy.sqrt(2 * (energy - left) / density / (copper * area / (density * inner**2) + 0.5))


def measured(expansion):
    """Short, Helm, Finger and Kamlet's fit of measured cylinder tests: speed of the wall [m/s] by moles and molar mass of the gas and the
    heat of detonation; those of TNT by Kamlet and Jacobs' rule, C7H5N3O6 to 2.5 H2O, 1.75 CO2, 1.5 N2 and carbon, heats of formation in kJ/mol."""
    moles, molar_mass = 5.75, 227.13  # of gas per mole of TNT; of TNT [g/mol]
    gas = (2.5 * 18.015 + 1.75 * 44.01 + 1.5 * 28.013) / moles
    heat = (2.5 * 241.8 + 1.75 * 393.5 - 63.2) / molar_mass  # [kJ/g]
    rho = 1e-3 * density
    product = moles / molar_mass * heat**0.5 * gas**0.5
    return 1e3 * 1.262 * rho**0.84 * product**0.54 * (1e3 * expansion) ** (0.212 - 0.065 * rho)


ratios = {}
for factor in (1, 2):
    mesh, deck = case.load("mesh.yaml"), case.load("deck.yaml")
    for part in mesh["parts"]:
        part["divisions"] = [factor * n for n in part["divisions"]]
    name = f"{8 * factor}"
    run = case.run(name, mesh, deck, energy=1e-3, remainder=3e-3)
    h = run.history
    for expansion in (0.0125, 0.019):
        speed = numpy.interp(expansion, h["wall_displacement_x"], h["wall_velocity_x"])
        ratios[factor, expansion] = speed / gurney(expansion)
        case.check_within(f"{name} elements in the radius: speed at {1e3 * expansion:g} mm over Gurney's", ratios[factor, expansion], 0.9, 1)
    for expansion, tolerance in ((0.006, 0.08), (0.0125, 0.05), (0.019, 0.05)):
        speed = numpy.interp(expansion, h["wall_displacement_x"], h["wall_velocity_x"])
        case.check(f"{name} elements in the radius: speed at {1e3 * expansion:g} mm over the fit of measured walls", speed / measured(expansion), 1, tolerance)
    if factor == 1:
        case.same_bits(name, mesh, deck, run)
change = ratios[2, 0.019] / ratios[1, 0.019]
case.check("speed at 19 mm: 16 over 8 elements", change, 1, 0.02)
case.finish()
