"""V40: axial frequency of a free bar and first bending frequency of a cantilever."""

import math

import numpy
from coplanetest import Case

case = Case("V40", __file__)


def frequency(times, values, near):
    """Of the sine that fits a record best, to 1e-5 of `near`."""

    def rest(f):
        base = numpy.stack([numpy.cos(2 * math.pi * f * times), numpy.sin(2 * math.pi * f * times), numpy.ones_like(times)], 1)
        return numpy.linalg.lstsq(base, values, rcond=None)[1][0]

    low, high = 0.7 * near, 1.4 * near
    while high - low > 1e-5 * near:
        grid = numpy.linspace(low, high, 41)
        best = grid[numpy.argmin([rest(f) for f in grid])]
        low, high = best - (high - low) / 40, best + (high - low) / 40
    return 0.5 * (low + high)


# A free bar: c / 2L with c = 5000 m/s.
bars = (("2d", None, "one_point"), ("2d", None, "full_integration"), ("2d", "triangles", "nodal_pressure"),
        ("3d", None, "one_point"), ("3d", None, "assumed_strain"), ("3d", "tetrahedra", "nodal_pressure"))
for dimension, split, element in bars:
    recipe, deck = case.load(f"mesh_bar_{dimension}.yaml"), case.load("deck_bar.yaml")
    if split:
        recipe["parts"][0]["split"] = split
    deck["blocks"]["bar"]["element"] = element
    name = f"bar_{dimension}_{split or 'whole'}_{element}"
    h = case.run(name, recipe, deck).history
    found = frequency(h["time"], h["end_displacement_x"], 2500)
    case.check(f"{name}: frequency [Hz]", found, 2500, 0.005, relative=True)

# Euler and Bernoulli in plane strain, 1.8751^2 / (2 pi) sqrt(E h^2 / (12 rho (1 - nu^2))) / L^2, less 0.9 % for shear
# and rotatory inertia (Timoshenko, L/h = 10).
slender = 1.8751041**2 / (2 * math.pi) * math.sqrt(200e9 / (12 * 7850 * (1 - 0.3**2))) * 0.1
beams = (
    ("2d", (80, 8), "one_point", 0.02),
    ("2d", (40, 4), "one_point", 0.03),
    ("2d", (40, 4), "full_integration", 0.03),
    ("2d", (20, 2), "assumed_strain", 0.02),
    ("2d", (10, 1), "assumed_strain", 0.02),
    ("3d", (20, 2, 1), "assumed_strain", 0.02),
    ("3d", (10, 1, 1), "assumed_strain", 0.02),
)
for dimension, divisions, element, tolerance in beams:
    recipe, deck = case.load(f"mesh_{dimension}.yaml"), case.load()
    recipe["parts"][0]["divisions"] = list(divisions)
    deck["blocks"]["bar"]["element"] = element
    if dimension == "3d":
        deck["conditions"].append({"type": "symmetry", "node_set": "all", "normal": [0, 0, 1]})
    name = f"cantilever_{dimension}_{divisions[1]}_{element}"
    h = case.run(name, recipe, deck, energy=2e-3).history
    found = frequency(h["time"], h["end_displacement_y"], slender)
    case.check(f"{name}: frequency [Hz]", found, 0.991 * slender, tolerance, relative=True)
    share = numpy.max(h["hourglass"]) / numpy.max(h["kinetic"])
    if element == "one_point":
        case.check(f"{name}: hourglass energy over the energy", share, 0, 0.05)
case.finish()
