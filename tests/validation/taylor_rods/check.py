"""Taylor's rods: length, foot and waist of rods that struck an anvil, against measured ones and other codes."""

import copy

import numpy
from coplanetest import ValidationCase

case = ValidationCase(__file__)
# Speed [m/s], length and radius of the rod, measured length, diameter of the foot, diameter at a fifth of the old length [m], tolerance.
MEASURED = {"copper_ofhc": (190.0, 25.4e-3, 3.81e-3, 16.2e-3, 13.5e-3, 10.1e-3, 0.08), "iron_armco": (221.0, 25.4e-3, 3.81e-3, 19.8e-3, 13.7e-3, 8.6e-3, 0.05),
            "steel_4340": (343.0, 25.4e-3, 3.81e-3, 21.5e-3, 11.1e-3, None, 0.05)}  # fmt: skip
recipe, deck = (case.load(f"tests/verification/V49_taylor_anvil/{part}.yaml") for part in ("mesh", "deck"))


def strike(name, material, speed, length, radius, across, friction=0.0, **joint):
    """Length, diameter of the foot and at a fifth of the old length [m]; run and seconds."""
    mesh, changed = copy.deepcopy(recipe), copy.deepcopy(deck)
    mesh["parts"][0].update(size=[radius, length], divisions=[across, round(across * length / radius)])
    changed["geometry"] = "axisymmetric"
    changed["initial"] = [{"block": "rod", "velocity": [0, -speed, 0]}]
    changed["blocks"]["rod"]["material"] = material
    if material != "copper":
        changed["materials"][material] = {"set": material}
    changed["blocks"]["anvil"] = {"material": "anvil"}
    changed["conditions"] = [{"type": "fixed", "node_set": "anvil"}]
    changed["joints"] = {"foot": {"model": "linear", "normal_stiffness": 5e14, "shear_stiffness": 5e13 if friction else 0, "friction": friction, **joint}}
    changed["contact"] = {"pairs": [{"blocks": ["rod", "anvil"], "joint": "foot", "declared": True}]}
    changed["output"] = {"every": 2e-5, "planes": False}
    run, spent = case.timed(name, mesh, changed, energy=2e-3)
    results = run.results
    rod = results.nodes_of("rod")
    old = results.coordinates[rod]
    new = old + results.nodal("displacement")[rod]
    side = old[:, 0] > radius * (1 - 1e-6)
    order = numpy.argsort(new[side, 1])
    return new[:, 1].max() - new[:, 1].min(), 2 * new[:, 0].max(), 2 * numpy.interp(0.2 * length, new[side, 1][order], new[side, 0][order]), run, spent


words = ("final length [m]", "diameter of the foot [m]", "diameter at a fifth of the length [m]")
for name, (speed, length, radius, *measured, tolerance) in MEASURED.items():
    *found, run, spent = strike(name, name, speed, length, radius, 6)
    for what, value, known in zip(words, found, measured):
        if known is not None:
            report = name == "steel_4340"
            case.check(f"{name}, {speed:.0f} m/s: {what}" + (" (reported: we differ)" if report else ""), value, known, tolerance, relative=True, report=report)
    if name == "iron_armco":
        case.picture(run, "--color", "equivalent_plastic_strain", "--mirror", "--shares", "0", "0.25", "0.5", "1", "--strip", "4", "--planes", "none", "--blocks", "rod",
                     "--window", "-0.008", "0.008", "-0.001", "0.027", "--size", "260", "440")  # fmt: skip
# Wilkins and Guinan's copper of von Mises: the range of published codes, which all have a plane of symmetry: the anvil holds on.
*found, run, spent = strike("copper_227", "copper", 227.0, 32.4e-3, 3.2e-3, 6, tensile_strength=1e12, cohesion=1e12)
case.check_within("copper of von Mises, 227 m/s: final length, between published codes [m]", found[0], 21.2e-3, 21.7e-3)
case.check_within("copper of von Mises, 227 m/s: radius of the foot, between published codes [m]", found[1] / 2, 6.8e-3, 7.25e-3)
if case.full:
    for name in ("copper_ofhc", "iron_armco"):
        speed, length, radius, *measured, _ = MEASURED[name]
        for across in (4, 8, 16):
            *found, run, spent = strike(f"{name}_{across}", name, speed, length, radius, across)
            for what, value, known in zip(words, found, measured):
                case.study(f"{name}: {what}", f"{across} through the radius", value, known, spent)
    speed, length, radius, *measured, _ = MEASURED["copper_ofhc"]
    *found, run, spent = strike("copper_rough", "copper_ofhc", speed, length, radius, 8, friction=0.1)
    for what, value, known in zip(words, found, measured):
        case.other(f"copper_ofhc: {what}", "Coplane, friction of 0.1 on the anvil", value, known, spent)
case.finish()
