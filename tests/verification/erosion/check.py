"""A block loses elements where a faster one hits it: balances, contact behind the dead elements, same bits."""

import numpy
from coplanetest import Case

case = Case("erosion", __file__)


def depth_inside(results, step, striker, target):
    """How deep nodes of the striker's living surface lie in living elements of the target, over the element's size: from
    the faces of the element that no other living element has. Elements inside the body count as 1.
    """
    x = results.coordinates + results.nodal("displacement", step)
    elements = results.connectivity(target)[results.element(target, "alive", step) > 0.5]
    sides = (
        [[0, 1], [1, 2], [2, 3], [3, 0]] if results.dimension == 2
        else [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [0, 4, 7, 3], [0, 3, 2, 1], [4, 5, 6, 7]]
    )
    counts = {}
    for element in elements:
        for side in sides:
            key = tuple(sorted(element[side]))
            counts[key] = counts.get(key, 0) + 1
    nodes = numpy.unique(results.connectivity(striker)[results.element(striker, "alive", step) > 0.5])
    worst = 0.0
    for element in elements:
        corners = x[element]
        inside = numpy.all((x[nodes] > corners.min(axis=0)) & (x[nodes] < corners.max(axis=0)), axis=1)
        if not inside.any():
            continue
        points = x[nodes[inside]]
        free, within = [], numpy.ones(len(points), bool)
        for side in sides:
            c = x[element[side]]
            if results.dimension == 2:
                t = c[1] - c[0]
                normal = numpy.array([t[1], -t[0]])
            else:
                normal = numpy.cross(c[2] - c[0], c[3] - c[1])
            normal /= numpy.linalg.norm(normal)
            distance = (c.mean(axis=0) - points) @ normal
            within &= distance > 0
            if counts[tuple(sorted(element[side]))] == 1:
                free.append(distance)
        if within.any():
            size = numpy.min(corners.max(axis=0) - corners.min(axis=0))
            depth = numpy.min(free, axis=0)[within] / size if free else numpy.ones(1)
            worst = max(worst, float(numpy.max(depth)))
    return worst


for dimension, recipe, velocity, end in (
    ("2d", "mesh.yaml", [0, -400, 0], 1.2e-4),
    ("3d", "mesh_3d.yaml", [0, 0, -800], 6e-5),
):
    recipe, deck = case.load(recipe), case.load()
    deck["initial"][0]["velocity"] = velocity
    deck["time"]["end"] = end
    deck["output"]["every"] = end / 12
    run = case.run(dimension, recipe, deck, energy=3e-3, remainder=0.05)
    case.same_bits(dimension, recipe, deck, run)
    case.same_bits(f"{dimension}_three", recipe, deck, run, ranks=3, backend="serial")
    h, results = run.history, run.results
    start = h["kinetic"][0]
    case.check_within(f"{dimension}: elements that die", int(h["eroded_elements"][-1]), 20, 1000)
    alive = results.element("target", "alive")
    case.check_equal(f"{dimension}: dead elements in the results", int(numpy.sum(alive == 0)), int(h["eroded_elements"][-1]))
    case.check_equal(f"{dimension}: alive is 0 or 1", sorted(set(alive.tolist())), [0.0, 1.0])
    case.check_within(f"{dimension}: energy of dead elements over the initial energy", h["eroded"][-1] / start, 0.02, 1)
    case.check_within(f"{dimension}: the same of their planes", h["contact_eroded"][-1] / start, 1e-5, 0.1)
    case.check_within(f"{dimension}: contact gains nothing, remainder over the initial energy", h["contact_remainder"].min() / start, -1e-3, 1)
    # A burst would show as kinetic energy from nowhere; springing back gives some percent.
    growth = numpy.max(h["kinetic"] - numpy.minimum.accumulate(h["kinetic"])) / start
    case.check(f"{dimension}: largest growth of the kinetic energy over the initial one", growth, 0, 0.05)
    case.check(f"{dimension}: planes beyond the depth limit", int(h["too_deep"].max()), 0, 0)
    depths = [max(depth_inside(results, step, "striker", "target"), depth_inside(results, step, "target", "striker"))
              for step in range(len(results.times))]
    case.check_within(f"{dimension}: deepest node in the other block over the element's size", max(depths), 0, 0.6)
case.finish()
