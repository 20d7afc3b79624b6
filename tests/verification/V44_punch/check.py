"""V44: limit load of Prandtl's punch with elements that lock and elements that do not. `all`: every form, and elements of half the size."""

import math
import sys

import numpy
from coplanetest import Case

case = Case("V44", __file__)
cohesion = 1e6 / math.sqrt(3)
exact = (2 + math.pi) * cohesion
h = 1 / 8

# Name, split, element, hourglass control, tolerance of the limit pressure (None: limits, or only reported).
runs = (
    ("quadrilaterals", None, "one_point", {"stiffness": 0, "viscosity": 0.1}, 0.05),
    ("quadrilaterals_hourglass_stiffness", None, "one_point", {}, 0.05),
    ("quadrilaterals", None, "assumed_strain", None, 0.05),
    ("quadrilaterals", None, "full_integration", None, 0.05),
    ("quadrilaterals", None, "full_integration_plain", None, None),
    ("triangles", "triangles", "nodal_pressure", None, 0.05),
    ("triangles", "triangles", "one_point", None, "report"),
)
if "all" not in sys.argv:
    runs = [run for run in runs if run[0].startswith("quadrilaterals") and run[2] not in ("full_integration", "assumed_strain")]
    h *= 2
for shape, split, element, hourglass, tolerance in runs:
    recipe, deck = case.load("mesh.yaml"), case.load()
    recipe["parts"][0]["divisions"] = [round(5 / h), round(3 / h)]
    if split:
        recipe["parts"][0]["split"] = split
    deck["blocks"]["ground"]["element"] = element
    if hourglass:
        deck["blocks"]["ground"]["hourglass"] = hourglass
    name = f"{shape}_{element}"
    run = case.run(name, recipe, deck, energy=1e-2, momentum=1e-11)
    history = run.history
    # Mean force of the last fifth of the way from the work of the prescribed motion. The field of a punch whose last node
    # moves and whose next one does not is half an element wider.
    last = history["time"] > 0.32
    work, way = history["external_work"][last], -history["punch_displacement_y"][last]
    force = (work[-1] - work[0]) / (way[-1] - way[0])
    pressure = force / (1 + h / 2)
    if tolerance:
        report = tolerance == "report"
        case.check(
            f"{name}: limit pressure over the cohesion", pressure / cohesion, exact / cohesion, 0.05, relative=True, report=report
        )
    else:
        case.check_within(f"{name}: limit pressure over the exact one, locks", pressure / exact, 1.1, 4)
    early = (history["time"] > 0.24) & (history["time"] < 0.32)
    work, way = history["external_work"][early], -history["punch_displacement_y"][early]
    before = (work[-1] - work[0]) / (way[-1] - way[0])
    if tolerance == 0.05:
        case.check(f"{name}: rise of the load over the last fifth", force / before, 1, 0.02)
case.finish()
