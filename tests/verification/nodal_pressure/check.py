"""Triangles and tetrahedra with nodal pressure give back what an elastic law has taken, however far they are deformed and however fine they are."""

import math
import sys

import numpy
from coplanetest import Case

case = Case("nodal_pressure", __file__)
HALF = 0.02  # time of the way there, and of that back [s]


def pressed(least, cells, poisson, dimension=2, geometry=None, viscosity=True):
    """A square or a cube of rubber on a fixed base, whose top is led down to `least` of its height and back."""
    size, low = [0.1] * dimension, [0.0] * dimension
    if geometry == "axisymmetric":
        low[0] = 0.05
    base, top = ("z" if dimension == 3 else "y"), 0.1
    recipe = {"dimension": dimension, "parts": [{"shape": "box", "block": "rubber", "min": low, "size": size, "divisions": [cells] * dimension, "split": "triangles" if dimension == 2 else "tetrahedra"}],
              "node_sets": {"base": {"where": {base: 0}}, "top": {"where": {base: top}}}}  # fmt: skip
    way = f"-{0.5 * (1 - least) * top}*(1-cos({math.pi / HALF}*t))"
    deck = {"materials": {"rubber": {"model": "neo_hookean", "density": 1000, "youngs_modulus": 5e6, "poisson_ratio": poisson}}, "blocks": {"rubber": {"material": "rubber", "element": "nodal_pressure"}},
            "contact": {"enabled": False}, "conditions": [{"type": "fixed", "node_set": "base"}, {"type": "displacement", "node_set": "top", "value": [0, *([0] if dimension == 3 else []), way, *([0] if dimension == 2 else [])]}],
            "time": {"end": 2 * HALF, "energy_tolerance": 1e9}, "history": {"every": HALF / 50}}  # fmt: skip
    if geometry:
        deck["geometry"] = geometry
    if not viscosity:
        deck["viscosity"] = {"linear": 0, "quadratic": 0}
    return recipe, deck


scenes = [("square of 10 cells", 0.3, 10, 0.45, {}), ("square of 20 cells", 0.3, 20, 0.45, {}), ("the same without viscosity", 0.4, 20, 0.45, {"viscosity": False}), ("softer in volume", 0.3, 20, 0.3, {}),
          ("ring", 0.5, 12, 0.45, {"geometry": "axisymmetric"}), ("cube", 0.5, 6, 0.45, {"dimension": 3})]  # fmt: skip
if "all" in sys.argv[1:]:
    scenes += [("square of 32 cells", 0.4, 32, 0.45, {}), ("cube of 10 cells", 0.4, 10, 0.45, {"dimension": 3}), ("nearly incompressible", 0.4, 20, 0.495, {})]
for name, least, cells, poisson, options in scenes:
    recipe, deck = pressed(least, cells, poisson, **options)
    run = case.run(name.replace(" ", "_"), recipe, deck, energy=5e-3)
    h = run.history
    most = h["external_work"].max()
    case.check(f"{name}: internal energy at the end over the largest work", h["internal"][-1] / most, 0, 2e-3)
    case.check(f"{name}: least internal energy over that", min(h["internal"].min(), 0) / most, 0, 2e-3)
    case.check(f"{name}: hourglass energy at the end over that", h["hourglass"][-1] / most, 0, 2e-3)
    case.check(f"{name}: work at the end over that", h["external_work"][-1] / most, 0, 1e-2)
    if name in ("ring", "cube"):
        case.same_bits(name, recipe, deck, run, ranks=3, threads=2)
case.finish()
