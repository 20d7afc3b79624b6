"""V56: a brick wall comes to rest under its weight and stays; gaps and overlaps of the mesh do not matter."""

import copy
import sys

import numpy
from coplanetest import Case, walls

case = Case("V56", __file__)
g = 9.81
length, course, courses, bricks = 0.64, 0.32, 6, 8
recipe = case.load("mesh.yaml")


def brick_by_brick(across, up):
    """The same wall of single boxes, apart by `across` and `up` [m]; below zero they overlap."""
    return dict(recipe, parts=[recipe["parts"][0], *walls.brick_by_brick((length, course), courses, bricks, across, up)])


def planes(run, number):
    """Closure and slip path [m] of all planes at one of the times, by the four numbers that name their faces."""
    columns = run.planes(number)
    keys = zip(*(columns[name] for name in ("lower_element", "lower_side", "higher_element", "higher_side")))
    return dict(zip(keys, zip(columns["closure"], columns["slip"])))


def stand(name, mesh, deck, **tolerances):
    """Runs; returns the final displacements of the bricks, in the order of the mesh."""
    run = case.run(name, mesh, deck, **tolerances)
    weight = bricks * courses * length * course * 2300 * g
    results = run.results
    reaction = -results.nodal("contact_force")[results.nodes_of("floor"), 1].sum()
    case.check(f"{name}: reaction of the floor [N/m]", reaction, weight, 1e-4, relative=True)
    energy = run.history["kinetic"][-1] / (weight * courses * course)
    case.check(f"{name}: kinetic energy at the end over m g H", energy, 0, 1e-8)
    # From the end of the damping on, nothing creeps: step 0 is the start, 1 the end of the damping, 2 the end.
    before, after = planes(run, 1), planes(run, 2)
    # A plane that is in one step only has no closure in the other: corners of bricks lie on each other by slivers of 1e-10 m.
    none = (0.0, 0.0)
    moved = numpy.abs([numpy.subtract(after.get(key, none), before.get(key, none)) for key in before.keys() | after.keys()])
    case.check(f"{name}: largest change of closure without damping [m]", moved[:, 0].max(), 0, 1e-6)
    case.check(f"{name}: largest slip without damping [m]", moved[:, 1].max(), 0, 1e-6)
    return results.nodal("displacement")[results.nodes_of("bricks")]


deck = case.load()
stand("wall", recipe, deck)

reference = stand("exact", brick_by_brick(0, 0), deck)
largest = numpy.max(numpy.abs(reference))
for name, up in (("gaps", 1e-5), ("overlaps", -1e-5)):
    moved = stand(name, brick_by_brick(0, up), deck)
    case.check(f"{name} in the bed joints: displacements, over the largest", numpy.max(numpy.abs(moved - reference)) / largest, 0, 1e-6)

if "all" in sys.argv[1:]:
    # Head joints too. Bricks that are apart lie on less of each other: 1e-5 of 0.32 m.
    for name, gap in (("all_gaps", 1e-5), ("all_overlaps", -1e-5)):
        moved = stand(name, brick_by_brick(gap, gap), deck)
        case.check(f"{name}: displacements, over the largest", numpy.max(numpy.abs(moved - reference)) / largest, 0, 2e-5 / 0.32)

    # Contact damping alone for 1 s, then 1 s without; closure curve of dry joints.
    slow = copy.deepcopy(deck)
    slow["joints"]["dry"] = {"model": "closure_curve", "initial_stiffness": 1e11, "maximum_closure": 2e-4, "shear_stiffness": 5e10, "friction": 0.6}
    stand("curve", recipe, slow)
    slow = copy.deepcopy(deck)
    slow["damping"] = {"mass": 4, "until": 1.0}
    slow["time"]["end"] = 2.0
    slow["output"]["times"] = [1.0]
    # In 120 703 cycles rounding adds up to 1.03e-12 of the momentum that gravity gives.
    stand("contact_damping", recipe, slow, momentum=2e-12)
case.finish()
