"""V10: a uniform pressure passes a joint between meshes that do not match, found by damping the motion."""

import copy

import numpy
from coplanetest import Case, turned

case = Case("V10", __file__)
deck = case.load()
pressure, stiffness = 1e5, 1e9
components = ("xx", "yy", "zz", "xy", "yz", "zx")


def stress_error(run, matrix, poisson):
    """Largest deviation from -p along the turned y axis, in any component of any element, over p."""
    results = run.results
    expected = -pressure * numpy.outer(matrix[:, 1], matrix[:, 1])
    if results.dimension == 2:  # plane strain: what keeps it from bulging out of the plane
        expected[2, 2] = -pressure * poisson
    worst = 0
    for block in ("lower", "upper"):
        for name in components:
            field = f"stress_{name}"
            if field not in results.element_names:
                continue
            i, j = ("xyz".index(axis) for axis in name)
            worst = max(worst, numpy.max(numpy.abs(results.element(block, field) - expected[i, j])))
    return worst / pressure


def closure(run, matrix):
    """Distance by which the faces overlap, from the mean motion of the nodes on both sides [m]."""
    results = run.results
    up = matrix[: results.dimension, 1]
    at_joint = numpy.abs(results.coordinates @ up) < 1e-9
    motion = results.nodal("displacement") @ up
    lower, upper = (numpy.intersect1d(results.nodes_of(block), numpy.flatnonzero(at_joint)) for block in ("lower", "upper"))
    return numpy.mean(motion[lower]) - numpy.mean(motion[upper])


def widening(run, matrix):
    """Area of the joint over that at the start: the faces bulge by Poisson's ratio."""
    results = run.results
    d = results.dimension
    before = results.coordinates
    at_joint = numpy.abs(before @ matrix[:d, 1]) < 1e-9
    after = (before + results.nodal("displacement"))[at_joint]
    across = [matrix[:d, axis] for axis in (0, 2)[: d - 1]]
    return numpy.prod([numpy.ptp(after @ axis) / numpy.ptp(before[at_joint] @ axis) for axis in across])


for dimension, angles in (("2d", 30), ("3d", [30, 20, 50])):
    for poisson in (0, 0.3):
        for split in (None, "triangles" if dimension == "2d" else "tetrahedra"):
            for turn in (False, True) if split is None else (True,):
                recipe, changed = case.load(f"mesh_{dimension}.yaml"), copy.deepcopy(deck)
                changed["materials"]["soft"]["poisson_ratio"] = poisson
                if split:
                    for part in recipe["parts"]:
                        part["split"] = split
                name = f"{dimension}_nu{poisson}" + (f"_{split}" if split else "") + ("_turned" if turn else "")
                recipe, changed, matrix = turned(recipe, changed, angles if turn else 0)
                run = case.run(name, recipe, changed)
                case.check(f"{name}: stress error over p", stress_error(run, matrix, poisson), 0, 1e-6)
                case.check(f"{name}: closure [m]", closure(run, matrix),
                           pressure / stiffness * widening(run, matrix), 1e-6, relative=True)
                # The damping force of this speed on a whole block is a millionth of the load.
                speed = 1e-6 * pressure / (deck["damping"]["mass"] * deck["materials"]["soft"]["density"])
                case.check(
                    f"{name}: largest speed at the end [m/s]", numpy.max(numpy.abs(run.results.nodal("velocity"))), 0, speed
                )
case.finish()
