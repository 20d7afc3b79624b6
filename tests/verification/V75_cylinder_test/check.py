"""V75: the cylinder test: TNT in a tube of copper, against Gurney's estimate with the energy of the products' isentrope."""

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
    if factor == 1:
        case.same_bits(name, mesh, deck, run)
change = ratios[2, 0.019] / ratios[1, 0.019]
case.check("speed at 19 mm: 16 over 8 elements", change, 1, 0.02)
case.finish()
