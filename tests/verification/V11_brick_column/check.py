"""V11: a column of bricks under its own weight closes its joints as their law says."""

import numpy
from coplanetest import Case

case = Case("V11", __file__)
density, g, side, bricks = 2300.0, 9.81, 0.32, 20


k = 1e11
joints = {
    "linear": ({"model": "linear", "normal_stiffness": k}, None),
    "hyperbola": ({"model": "closure_curve", "initial_stiffness": k, "maximum_closure": 2e-4}, 2e-4),
    # Bent so much that a linear joint would be wrong by up to 22 %.
    "bent": ({"model": "closure_curve", "initial_stiffness": k, "maximum_closure": 5e-6, "stiffness_cap": 1e12}, 5e-6),
}
for height, number in ((1.0, 2.2563e-7), (6.4, 1.44403e-6)):
    case.check(f"linear: formula against the table, {height} m [m]", density * g * height / k, number, 1e-4, relative=True)
for height, number in ((1.0, 2.253757e-7), (6.4, 1.433681e-6)):
    s = density * g * height
    case.check(f"hyperbola: formula against the table, {height} m [m]", s / (k + s / 2e-4), number, 1e-6, relative=True)
for name, (card, most) in joints.items():
    for dimension in ("2d", "3d") if name == "hyperbola" else ("2d",):
        recipe, deck = case.load("mesh.yaml" if dimension == "2d" else "mesh_3d.yaml"), case.load()
        deck["joints"]["joint"] = {**card, "friction": 0.6}
        label = f"{name}_{dimension}"
        run = case.run(label, recipe, deck)
        if name == "hyperbola":
            case.same_bits(label, recipe, deck, run)
        planes = run.planes()
        above = bricks * side - planes["Points"][:, 1].round(3)  # height of the column above each plane
        case.check_equal(f"{label}: joints with planes", len(numpy.unique(above)), bricks)
        pressure = density * g * above
        exact = pressure / (k + pressure / most) if most else pressure / k
        worst = numpy.max(numpy.abs(planes["closure"] / exact - 1))
        case.check(f"{label}: closure over the law's under the weight above, worst of {len(above)} planes", 1 + worst, 1, 1e-3)
        bottom = above > bricks * side - side / 2
        closure = numpy.average(planes["closure"][bottom], weights=planes["area"][bottom])
        case.check(f"{label}: closure of the lowest joint [m]", closure, exact[bottom][0], 1e-3, relative=True)
        weight = density * g * bricks * side ** (2 if dimension == "2d" else 3)
        case.check(f"{label}: force on the base [N]", numpy.sum(planes["normal_traction"][bottom] * planes["area"][bottom]),
                   weight, 1e-3, relative=True)
        case.check(f"{label}: planes that slip or open", int(run.history["slip"][-1] + run.history["open"][-1]), 0, 0)
case.finish()
