"""What erosion leaves goes on as mass points that faces stop: free fall, bounce, balances, same bits."""

import numpy
from coplanetest import Case

case = Case("debris", __file__)


def depths(x, elements, points):
    """How deep each point lies in a quadrilateral, over its size: its distance from the nearest side; 0: in none."""
    found = numpy.zeros(len(points))
    for element in elements:
        c = x[element]
        inside, distance = numpy.ones(len(points), bool), numpy.full(len(points), numpy.inf)
        for k in range(4):
            along = c[(k + 1) % 4] - c[k]
            away = (points - c[k]) @ numpy.array([-along[1], along[0]]) / numpy.linalg.norm(along)
            inside &= away > 0
            distance = numpy.minimum(distance, away)
        size = numpy.min(c.max(axis=0) - c.min(axis=0))
        found = numpy.where(inside, numpy.maximum(found, distance / size), found)
    return found


# Corners of a cube fall on a block.
recipe, deck = case.load("drop_mesh.yaml"), case.load("drop.yaml")
run = case.run("drop", recipe, deck, energy=3e-3)
case.same_bits("drop_two", recipe, deck, run)
h, results = run.history, run.results
case.check_equal("drop: points", int(h["debris_points"][-1]), 8)
cube = results.nodes_of("cube")
old = results.coordinates[cube]
start, gravity = numpy.array([0.5, 0.25, -10.0]), numpy.array([0, 0, -9.81])
worst, flying = 0.0, 0
for step, time in enumerate(results.times):
    fall = start * time + 0.5 * gravity * time**2
    free = old[:, 2] + fall[2] > 1e-4
    moved = results.nodal("displacement", step)[cube]
    flying += int(free.sum()) if time > 0 else 0
    worst = max(worst, float(numpy.abs(moved[free] - fall).max(initial=0)))
case.check_within("drop: places of points in free fall that are compared", flying, 12, float("inf"))
case.check("drop: farthest from free fall [m]", worst, 0, 1e-12 * 0.1)
speed = results.nodal("velocity", -1)[cube]
# What a body has that falls from its place to the face and is thrown back: the speed of the fall there, less that of the rise.
landing = numpy.sqrt(start[2] ** 2 + 2 * 9.81 * old[:, 2])
landed = (landing - 10) / 9.81
expected = landing - 9.81 * (results.times[-1] - landed)
case.check("drop: largest change of the speed by the bounce", float(numpy.abs(speed[:, 2] / expected - 1).max()), 0, 0.03)
case.check_equal("drop: points that rise", int(numpy.sum(speed[:, 2] > 0)), 8)
# Faces have no friction for points.
case.check("drop: largest change of the speed along the face [m/s]", float(numpy.abs(speed[:, :2] - start[:2]).max()), 0, 0.05)
case.check("drop: remainder of debris over the energy", h["debris_remainder"][-1] / h["kinetic"][0], 0, 5e-3)
case.check_within("drop: most that points store over the energy", h["debris_stored"].max() / h["kinetic"][0], 0.05, 1)

# A striker is crushed on a plate.
recipe, deck = case.load("striker_mesh.yaml"), case.load("striker.yaml")
inside = {}
for option in ("points", "none"):
    chosen = {**deck, "contact": {**deck["contact"], "debris": option}}
    run = case.run(f"striker_{option}", recipe, chosen, energy=3e-3, remainder=0.05)
    results = run.results
    x = results.coordinates + results.nodal("displacement", -1)
    living = {name: results.connectivity(name)[results.element(name, "alive", -1) > 0.5] for name in ("plate", "striker")}
    free = numpy.setdiff1d(numpy.concatenate([results.nodes_of(name) for name in living]), numpy.concatenate([e.ravel() for e in living.values()]))
    inside[option] = int(numpy.sum(depths(x, living["plate"], x[free]) > 0.5))
    if option == "points":
        h = run.history
        case.same_bits("striker_two", recipe, chosen, run)
        case.same_bits("striker_three", recipe, chosen, run, ranks=3, backend="serial")
        case.check_equal("striker: points in the table and in the results", int(h["debris_points"][-1]), len(free))
        case.check_within("striker: points", len(free), 10, 1000)
        case.check_within("striker: most points that touch at once", int(h["debris_touching"].max()), 3, 1000)
        case.check("striker: largest remainder of debris over the energy", float(numpy.abs(h["debris_remainder"]).max()) / h["kinetic"][0], 0, 5e-3)
case.check_equal("striker: points deeper in the plate than half an element", inside["points"], 0)
case.check_within("striker: the same without the option", inside["none"], 5, 1000)
case.finish()
