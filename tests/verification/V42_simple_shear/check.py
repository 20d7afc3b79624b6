"""V42: stress in simple shear to gamma = 4 under the three objective rates. `all`: every shape and form."""

import math
import sys

from coplanetest import Case

case = Case("V42", __file__)
shear_modulus = 200e9 / 2.6


def jaumann(gamma):
    return math.sin(gamma), 1 - math.cos(gamma)


def green_naghdi(gamma):
    b = math.atan(gamma / 2)
    c, s, log = math.cos(2 * b), math.sin(2 * b), math.log(math.cos(b))
    return 2 * ((2 * b - math.tan(b)) * c - 2 * s * log), 4 * (c * log + b * s - math.sin(b) ** 2)


exact = {"hughes_winget": jaumann, "jaumann": jaumann, "green_naghdi": green_naghdi}
shapes = {
    "quadrilateral": ("2d", None, ("one_point", "full_integration")),
    "triangles": ("2d", "triangles", ("one_point",)),
    "hexahedron": ("3d", None, ("one_point", "full_integration")),
    "tetrahedra": ("3d", "tetrahedra", ("one_point",)),
}
if "all" not in sys.argv:
    shapes = {"quadrilateral": ("2d", None, ("one_point",)), "hexahedron": ("3d", None, ("full_integration",))}
for shape, (dimension, split, elements) in shapes.items():
    for element in elements:
        for rate in exact:
            recipe, deck = case.load(f"mesh_{dimension}.yaml"), case.load()
            if split:
                recipe["parts"][0]["split"] = split
            deck["blocks"]["cell"].update(element=element, objective_rate=rate)
            if rate == "jaumann":  # the length of the stress grows by the square of the angle in every step
                deck["time"]["fixed_step"] = 5e-8
            name = f"{shape}_{element}_{rate}"
            run = case.run(name, recipe, deck, energy=1e-2)
            for step in (1, 2, 3):
                gamma = 4000 * run.results.times[step]
                # Stretches exp(+-asinh(gamma/2)), the axis of the longer at half of atan2(2, gamma) to the shear.
                stretch, twice = math.asinh(gamma / 2), math.atan2(2, gamma)
                for component, value in (("xy", stretch * math.sin(twice)), ("xx", stretch * math.cos(twice)), ("yy", -stretch * math.cos(twice))):
                    strain = run.results.element("cell", f"strain_{component}", step)[0]
                    case.check(f"{name}: strain {component} at {round(gamma)}", strain, value, 1e-11)
                for component, value in zip(("xy", "xx"), exact[rate](gamma)):
                    stress = run.results.element("cell", f"stress_{component}", step)[0] / shear_modulus
                    case.check(f"{name}: stress {component} over G at {round(gamma)}", stress, value, 1e-3 * max(abs(value), 1))
case.finish()
