"""The same contact problem told in other words: see README.md. Arguments: a scene, and `all` for every way of telling it."""

import copy
import sys

import numpy
from coplanetest import Case, documents, retold

from scenes import SCENES

name = sys.argv[1]
everything = "all" in sys.argv[2:]
scene = SCENES[name]()
dimension = scene.dimension
case = Case(name, __file__)


# --- what is compared ----------------------------------------------------------------------------------------------------------------------


class Seen:
    """Motion of the movers, in the words of the original."""

    def __init__(self, problem, run):
        h = run.history
        self.times = h["time"] / problem.time
        self.motion, self.velocity = [], []
        for mover in scene.movers:
            for power, kept, found in ((0, "displacement", self.motion), (1, "velocity", self.velocity)):
                columns = numpy.stack([h[f"{mover}_{kept}_{axis}"] for axis in "xyz"[:dimension]], axis=1)
                found.append(problem.seen_vectors(columns, h["time"], power))
        results = run.results
        now = results.times[-1]
        self.nodal = problem.seen_vectors(results.nodal("displacement"), now, 0), problem.seen_vectors(results.nodal("velocity"), now, 1)
        if problem.order is not None:
            self.nodal = tuple(values[problem.order] for values in self.nodal)
        # Velocities of rigid bodies that come nearest to those of the nodes, at the corners of a box around each mover.
        corners = []
        places = results.coordinates @ problem.matrix[:dimension, :dimension] / problem.length
        velocities = problem.seen_vectors(results.nodal("velocity"), now, 1)
        for mover in scene.movers:
            nodes = results.nodes_of(mover)
            corners.append(rigid_corners(places[nodes], velocities[nodes]))
        self.corners = numpy.stack(corners)


def rigid_corners(places, velocities):
    """Velocities v + w x r at the corners of the bounding box, of the rigid motion that fits best."""
    r = places - places.mean(axis=0)
    mean = velocities.mean(axis=0)
    spins = [(0, 1)] if dimension == 2 else [(0, 1), (1, 2), (2, 0)]  # planes of rotation
    modes = numpy.zeros((len(spins), *r.shape))
    for mode, (i, j) in zip(modes, spins):
        mode[:, i], mode[:, j] = -r[:, j], r[:, i]
    omega = numpy.linalg.lstsq(modes.reshape(len(spins), -1).T, (velocities - mean).ravel(), rcond=None)[0]
    half = numpy.ptp(places, axis=0) / 2
    signs = numpy.array(numpy.meshgrid(*[[-1, 1]] * dimension)).reshape(dimension, -1).T
    field = numpy.zeros((len(signs), dimension))
    for w, (i, j) in zip(omega, spins):
        field[:, i] -= w * signs[:, j] * half[j]
        field[:, j] += w * signs[:, i] * half[i]
    return field + mean


def largest(a):
    return float(numpy.max(numpy.abs(a)))


def exact(told, bound, report=False):
    """Every recorded motion and every node at the end, over the largest there is."""
    seen = look(*told)
    if len(seen.times) != len(base.times):
        case.check_equal(f"{told[0]}: lines of the history", len(seen.times), len(base.times))
        return
    worst = max(
        max(largest(numpy.array(seen.motion) - base.motion) / length, largest(numpy.array(seen.velocity) - base.velocity) / speed),
        largest(seen.nodal[0] - base.nodal[0]) / length, largest(seen.nodal[1] - base.nodal[1]) / speed,
    )
    case.check(f"{told[0]}: difference of any motion", worst, 0, bound, report=report)


def near(told, bound, report=False, other=None):
    """Mean motion of the movers at all times, and their rigid motion at the end, over the largest there is."""
    seen, reference = look(*told), other or base
    apart = 0.0
    for mine, theirs in zip(seen.motion, reference.motion):
        for axis in range(min(mine.shape[1], theirs.shape[1])):
            apart = max(apart, largest(numpy.interp(reference.times, seen.times, mine[:, axis]) - theirs[:, axis]))
    case.check(f"{told[0]}: difference of displacements", apart / length, 0, bound, report=report)
    case.check(f"{told[0]}: difference of velocities at the end", largest(seen.corners - reference.corners) / speed, 0, bound, report=report)


def look(words, problem):
    run = case.run(words.replace(" ", "_").replace(",", ""), problem.recipe, problem.deck, edit_mesh=problem.edit_mesh,
                   energy=1e-3, remainder=1e-3)
    return Seen(problem, run)


# --- other words ---------------------------------------------------------------------------------------------------------------------------


def cut(parts, open_by=0.0, step=0.0):
    """The slab (or the bar) in flush parts with the same grid lines, a hair open or alternately raised and lowered."""
    problem = scene.problem()
    whole = problem.recipe["parts"].pop(scene.slab)
    axis, up = scene.along, 1 - scene.along
    pieces = []
    for i in range(parts):
        piece = copy.deepcopy(whole)
        size = whole["size"][axis] / parts
        assert whole["divisions"][axis] % parts == 0
        piece["divisions"][axis] //= parts
        piece["size"][axis] = size
        # What stays shut lies at the middle: both halves give way to the gap.
        piece["min"][axis] = whole["min"][axis] + i * size + open_by * (i - (parts - 1) / 2)
        piece["min"][up] += step * (-1) ** i
        pieces.append(piece)
    problem.recipe["parts"][scene.slab : scene.slab] = pieces
    return problem


def meshed(part, finer=1, split=False):
    problem = scene.problem()
    chosen = problem.recipe["parts"][part]
    chosen["divisions"] = [finer * n for n in chosen["divisions"]]
    if split:
        chosen["split"] = "triangles" if dimension == 2 else "tetrahedra"
    return retold.without_fixed_step(problem)


original = scene.problem()
run = case.run("original", original.recipe, original.deck, edit_mesh=original.edit_mesh, energy=1e-3, remainder=1e-3)
base = Seen(original, run)
length, speed = scene.scale or (largest(base.motion), max(largest(base.velocity), largest(base.nodal[1])))
nodes = len(base.nodal[0])
plain = scene.problem()

mirror = numpy.diag([-1.0, 1.0, 1.0])
angles = 17.3 if dimension == 2 else [17.3, -31.7, 0]
far = (1000.0, -1000.0, 1000.0 if dimension == 3 else 0.0)
drift = (100.0, -100.0, 100.0 if dimension == 3 else 0.0)
backwards = list(range(len(original.recipe["parts"])))[::-1]

exact(("renumbered", retold.renumbered(plain, nodes)), 1e-9)
near(("blocks in another order", retold.reordered(plain, backwards)), 1e-9)
exact(("mirrored", retold.in_frame(plain, mirror)), 1e-9)
exact(("turned", retold.in_frame(plain, documents.rotation(angles))), 1e-8)
exact(("moved by 1 km", retold.in_frame(plain, offset=far)), 1e-8)
exact(("seen from 100 m/s", retold.in_frame(plain, velocity=drift)), 1e-8)
exact(("in mm, ms and g", retold.in_units(plain, 1e3, 1e3, 1e3)), 1e-9)
exact(("in units of powers of two", retold.in_units(plain, 2.0**10, 2.0**7, 2.0**5)), 0)
if scene.along == 0:
    for parts in (2, 7):
        near((f"{parts} flush slabs", cut(parts)), 1e-3)
        near((f"{parts} slabs a hair open", cut(parts, open_by=1e-6)), 1e-3)
    for step in (1e-6, 1e-5, 1e-4):
        near((f"7 slabs with steps of {step:g} m", cut(7, step=step)), 1e-3)
else:
    near(("2 flush strips", cut(2)), 1e-3)
near(("rider meshed twice as fine", meshed(scene.rider, 2)), 1e-2)
near(("slab meshed twice as fine", meshed(scene.slab, 2)), 1e-2)
near(("rider split", meshed(scene.rider, split=True)), 1e-2)
near(("slab split", meshed(scene.slab, split=True)), 1e-2)
case.finish()
