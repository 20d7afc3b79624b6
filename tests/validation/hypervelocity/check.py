"""A sphere of aluminium through a plate at speeds of space debris: the diameter of the hole, against a measured one and a scaling law."""

import copy

import numpy
from coplanetest import ValidationCase


class Shots(ValidationCase):
    def conservation(self, name, run, deck, energy=1e-3, **_):
        """Energy and momentum along the axis: with axes r and z there is no moment of momentum."""
        h = run.history
        self.check(f"{name}: energy balance", numpy.max(numpy.abs(h["error"])) / h["kinetic"][0], 0, energy, kept="energy balance")
        self.check(f"{name}: momentum along the axis", numpy.max(numpy.abs(h["momentum_error_y"])) / abs(h["momentum_y"][0]), 0, 1e-12, kept="momentum")


case = Shots(__file__)
recipe, deck = case.load("mesh.yaml"), case.load("deck.yaml")
RADIUS, GAP, THICKNESS, SOUND = 0.005, 2e-5, 0.004, 5300.0
MEASURED = 31.0e-3  # at 6.18 km/s [m]


def scaling(speed):
    """Hole in a plate of the sphere's metal, over the sphere [-]: 2.8 (v/c)^0.448 (t/d)^0.516 + 0.6."""
    return 2 * RADIUS * (2.8 * (speed / SOUND) ** (0.335 + 0.113) * (THICKNESS / (2 * RADIUS)) ** 0.516 + 0.6)


def rounded(x):
    """The box above the plate becomes the half section of a sphere."""
    x = numpy.array(x)
    sphere = x[:, 1] > GAP / 2
    a, b = x[sphere, 0] / RADIUS, (x[sphere, 1] - GAP) / RADIUS - 1
    x[sphere, 0] = RADIUS * a * numpy.sqrt(1 - b**2 / 2)
    x[sphere, 1] = GAP + RADIUS * (1 + b * numpy.sqrt(1 - a**2 / 2))
    return x


def shoot(name, speed, strain=2.0, finer=1):
    """Diameter of the hole at the end [m]; run and seconds."""
    mesh, changed = copy.deepcopy(recipe), copy.deepcopy(deck)
    for line in mesh["parts"][0]["lines"].values():
        line["divisions"] = [finer * n for n in line["divisions"]]
    mesh["parts"][1]["divisions"] = [finer * n for n in mesh["parts"][1]["divisions"]]
    for block in changed["blocks"].values():
        block["erosion"]["plastic_strain"] = strain
    changed["initial"][0]["velocity"] = [0, -speed, 0]
    run, spent = case.timed(name, mesh, changed, change_mesh=rounded)
    results = run.results
    plate = results.connectivity("plate")
    fragment, alive = results.element("plate", "fragment"), results.element("plate", "alive") > 0.5
    rim = numpy.argmax(results.coordinates[plate][:, :, 0].mean(axis=1))
    whole = numpy.unique(plate[(fragment == fragment[rim]) & alive])
    x = results.coordinates + results.nodal("displacement")
    return 2 * x[whole, 0].min(), run, spent


quantity = "hole at 6.18 km/s [m]"
hole, run, spent = shoot("v6180", 6180)
case.check(f"{quantity} (reported: we differ)", hole, MEASURED, 0.1, relative=True, report=True)
case.check_within(f"{quantity}, between the sphere and what was measured", hole, 2 * RADIUS, MEASURED)
case.other(quantity, "scaling law", scaling(6180), MEASURED)
case.picture(run, "--color", "von_mises", "--shares", "0", "0.1", "0.3", "1", "--strip", "4", "--planes", "none", "--mirror", "--window", "-0.03", "0.03", "-0.04", "0.015", "--size", "330", "320")
slow, run, _ = shoot("v3000", 3000)
case.check("hole at 3 km/s [m] (reported: we differ)", slow, scaling(3000), 0.1, relative=True, report=True)
case.check_within("hole at 3 km/s over that at 6.18 km/s", slow / hole, 0.65, 0.95)
rest = run.history["momentum_y"][-1] / run.history["momentum_y"][0]
case.check("3 km/s: momentum in the end over the first", rest, 1, 1e-9)
if case.full:
    for strain in (1.0, 8.0):
        found, _, _ = shoot(f"v6180_{strain:g}", 6180, strain)
        case.other(quantity, f"Coplane, elements die at a plastic strain of {strain:g}, not 2", found, MEASURED)
    for strain in (1.0, 2.0, 4.0):
        for size, finer in (("0.5 mm", 1), ("0.25 mm", 2)):
            found, _, spent = shoot(f"v3000_{strain:g}_{finer}", 3000, strain, finer)
            case.study(f"hole at 3 km/s [m], elements die at {strain:g}", size, found, scaling(3000), spent)
case.finish()
