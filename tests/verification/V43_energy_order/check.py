"""V43: the error of the energy balance falls with the square of the time step, for every form of element. `all`: every one."""

import math
import sys

import numpy
from coplanetest import Case

case = Case("V43", __file__)
forms = {
    "hexahedra": (None, ("one_point", "assumed_strain", "full_integration", "full_integration_plain")),
    "tetrahedra": ("tetrahedra", ("one_point", "nodal_pressure")),
    "ring": (None, ("one_point", "assumed_strain", "full_integration", "full_integration_plain")),
    "ring_of_triangles": ("triangles", ("one_point", "nodal_pressure")),
}
if "all" not in sys.argv:
    forms = {"hexahedra": (None, ("assumed_strain",)), "tetrahedra": ("tetrahedra", ("nodal_pressure",)), "ring": (None, ("full_integration",))}
for shape, (split, elements) in forms.items():
    ring = shape.startswith("ring")
    for element in elements:
        errors = []
        for step in (1e-6, 0.5e-6):
            recipe, deck = case.load("mesh_ring.yaml" if ring else "mesh.yaml"), case.load()
            if split:
                recipe["parts"][0]["split"] = split
            if ring:
                deck["geometry"] = "axisymmetric"
                deck["initial"][0]["velocity_field"][2] = 0
            deck["blocks"]["cube"]["element"] = element
            deck["time"]["fixed_step"] = step
            run = case.run(f"{shape}_{element}_{step:g}", recipe, deck)
            if step == 1e-6 and (shape == "hexahedra" or "all" in sys.argv):
                case.same_bits(f"{shape}_{element}", recipe, deck, run)
            errors.append(numpy.max(numpy.abs(run.history["error"])) / run.history["kinetic"][0])
        name = f"{shape}, {element}"
        case.check(f"{name}: order of the energy error", math.log2(errors[0] / errors[1]), 2, 0.2)
        case.check(f"{name}: error at 1 us over the energy", errors[0], 0, 1e-3)
case.finish()
