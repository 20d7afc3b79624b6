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
    scenes += [("square of 32 cells", 0.4, 32, 0.45, {}), ("cube of 10 cells", 0.4, 10, 0.45, {"dimension": 3}), ("nearly incompressible", 0.6, 20, 0.495, {})]
for name, least, cells, poisson, options in scenes:
    recipe, deck = pressed(least, cells, poisson, **options)
    run = case.run(name.replace(" ", "_"), recipe, deck, energy=5e-3, momentum=1e-11)  # round-off of ten thousand cycles
    h = run.history
    most = h["external_work"].max()
    case.check(f"{name}: internal energy at the end over the largest work", h["internal"][-1] / most, 0, 2e-3)
    case.check(f"{name}: least internal energy over that", min(h["internal"].min(), 0) / most, 0, 2e-3)
    case.check(f"{name}: hourglass energy at the end over that", h["hourglass"][-1] / most, 0, 2e-3)
    case.check(f"{name}: work at the end over that", h["external_work"][-1] / most, 0, 1e-2)
    if name in ("ring", "cube"):
        case.same_bits(name, recipe, deck, run, ranks=3, threads=2)

# --- elements that die ------------------------------------------------------------------------------------------------------
# A node is driven through a patch. What an element leaves to its nodes goes with it, and is booked.
for low in (0.3, 0.15):
    recipe = {"dimension": 2, "parts": [{"shape": "box", "block": "patch", "min": [0, 0], "size": [1, 1], "divisions": [8, 8], "split": "triangles"}],
              "node_sets": {"middle": {"where": {"x": 0.5, "y": 0.5}}, "end": {"where": {"x": [0.6, 1.0]}}}}  # fmt: skip
    deck = {"materials": {"rubber": {"model": "neo_hookean", "density": 1000, "youngs_modulus": 1e7, "poisson_ratio": 0.3}},
            "blocks": {"patch": {"material": "rubber", "element": "nodal_pressure", "erosion": {"volume_ratio": [low, 4]}}}, "contact": {"enabled": False}, "viscosity": {"linear": 0, "quadratic": 0},
            "conditions": [{"type": "fixed", "node_set": "end"}, {"type": "velocity", "node_set": "middle", "value": [5.0, 0, 0]}], "time": {"end": 0.0238, "energy_tolerance": 1e9}, "history": {"every": 1e-9}}  # fmt: skip
    run = case.run(f"dies_{low}", recipe, deck, energy=1)
    h = run.history
    death = int(numpy.argmax(h["eroded"] != 0))
    case.check_equal(f"elements below {low} of their volume: some die", death > 0, True)
    case.check(f"elements below {low} of their volume: jump of the energy balance as one dies, over the energy", (h["error"][death] - h["error"][death - 1]) / h["external_work"][death], 0, 1e-3)
case.same_bits(f"dies_{low}", recipe, deck, run, ranks=2, threads=2)

# --- ground under its weight --------------------------------------------------------------------------------------------------
# A stress that changes with place is in balance from the start.
for dimension in (2, 3):
    deep = [4.0] if dimension == 3 else []
    recipe = {"dimension": dimension, "parts": [{"shape": "box", "block": "soil", "min": [0] * dimension, "size": [5, 5, *deep], "divisions": [4, 5, 3][:dimension], "split": "triangles" if dimension == 2 else "tetrahedra"}],
              "node_sets": {"base": {"where": {"y": 0}}, "left": {"where": {"x": 0}}, "right": {"where": {"x": 5}}, **({"front": {"where": {"z": 0}}, "back": {"where": {"z": 4}}} if deep else {})}}  # fmt: skip
    rollers = {"left": "x", "right": "x", **({"front": "z", "back": "z"} if deep else {})}
    weight = 2000 * 9.81
    deck = {"materials": {"soil": {"model": "linear_elastic", "density": 2000, "youngs_modulus": 5e7, "poisson_ratio": 0.3}}, "blocks": {"soil": {"material": "soil", "element": "nodal_pressure"}}, "gravity": [0, -9.81, 0],
            "conditions": [{"type": "fixed", "node_set": "base"}, *({"type": "fixed", "node_set": name, "components": [axis]} for name, axis in rollers.items())], "contact": {"enabled": False},
            "initial": [{"block": "soil", "stress_point": [0, 5, 0], "stress_axis": [0, 1, 0], "stress_gradient": [0.4 * weight, weight, 0.4 * weight, 0, 0, 0]}], "time": {"end": 0.1}, "history": {"every": 1e-3}}  # fmt: skip
    if dimension == 2:  # a push: what stays with elements is a part of the state
        pushed = {**deck, "initial": [{**deck["initial"][0], "velocity": [0, -0.5, 0]}]}
        run = case.run("ground_pushed", recipe, pushed)
        case.same_bits("ground_pushed", recipe, pushed, run, ranks=3)
        case.restarts("ground_pushed", recipe, pushed, run, 0.05)
    run = case.attempt(f"ground_{dimension}", recipe, deck)  # nothing moves: there is nothing that balances could be compared with
    case.check_equal(f"ground in {dimension}D: exit code", run.code, 0)
    case.check(f"ground in {dimension}D: largest kinetic energy [J]", run.history["kinetic"].max(), 0, 1e-20)
case.finish()
