"""The same contact problem told in other words: see README.md. Arguments: a scene, and `all` for every way of telling it of every scene."""

import copy
import itertools
import sys

import numpy
from coplanetest import Case, retold, rotation

from scenes import SCENES, spin

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
        d = results.dimension  # a slice of a plane problem has one more
        places = results.coordinates @ problem.matrix[:d, :d] / problem.length
        velocities = problem.seen_vectors(results.nodal("velocity"), now, 1)
        for mover in scene.movers:
            nodes = results.nodes_of(mover)
            corners.append(rigid_corners(places[nodes], velocities[nodes]))
        self.corners = numpy.stack(corners)


def rigid_corners(places, velocities):
    """Velocities v + w x r at the corners of the bounding box, of the rigid motion that fits best."""
    r = places - places.mean(axis=0)
    mean = velocities.mean(axis=0)
    d = r.shape[1]
    spins = [(0, 1)] if d == 2 else [(0, 1), (1, 2), (2, 0)]  # planes of rotation
    modes = numpy.zeros((len(spins), *r.shape))
    for mode, (i, j) in zip(modes, spins):
        mode[:, i], mode[:, j] = -r[:, j], r[:, i]
    omega = numpy.linalg.lstsq(modes.reshape(len(spins), -1).T, (velocities - mean).ravel(), rcond=None)[0]
    half = numpy.ptp(places, axis=0) / 2
    signs = numpy.array([signs[::-1] for signs in itertools.product((-1, 1), repeat=d)])  # those of a plane problem first
    field = numpy.zeros((len(signs), d))
    for w, (i, j) in zip(omega, spins):
        field[:, i] -= w * signs[:, j] * half[j]
        field[:, j] += w * signs[:, i] * half[i]
    return field + mean


def largest(a):
    return float(numpy.max(numpy.abs(a)))


def exact(words, problem, bound, report=False, other=None):
    """Every recorded motion and every node at the end, over the largest there is."""
    seen, reference = look(words, problem), other or base
    if not case.check_equal(f"{words}: lines of the history", len(seen.times), len(reference.times), kept="lines of the history"):
        return
    worst = max(
        largest(numpy.array(seen.motion) - reference.motion) / length, largest(numpy.array(seen.velocity) - reference.velocity) / speed,
        largest(seen.nodal[0] - reference.nodal[0]) / length, largest(seen.nodal[1] - reference.nodal[1]) / speed,
    )
    case.check(f"{words}: any motion", worst, 0, bound, report=report)


def near(words, problem, bound, velocity_bound=None, report=False, other=None):
    """Mean motion of the movers at all times, and their rigid motion at the end, over the largest there is."""
    seen, reference = look(words, problem, report), other or base
    apart = 0.0
    for mine, theirs in zip(seen.motion, reference.motion):
        for axis in range(theirs.shape[1]):
            apart = max(apart, largest(numpy.interp(reference.times, seen.times, mine[:, axis]) - theirs[:, axis]))
    case.check(f"{words}: displacement", apart / length, 0, bound, report=report)
    # A slice in 3D has its corners twice.
    corners = seen.corners[:, : reference.corners.shape[1], : reference.corners.shape[2]]
    case.check(f"{words}: velocity", largest(corners - reference.corners) / speed, 0, velocity_bound or bound, report=report)


def look(words, problem, report=False):
    folder = words.replace(" ", "_").replace(",", "")
    run = case.run(folder, problem.recipe, problem.deck, edit_mesh=problem.edit_mesh, energy=1e-3, remainder=None if report else 1e-3)
    if report:
        h = run.history
        lost = largest(h["contact_remainder"]) / max(largest(h["kinetic"]), largest(h["external_work"]))
        case.check(f"{words}: contact remainder", lost, 0, 1e-3, report=True)
    return Seen(problem, run)


# --- other words ---------------------------------------------------------------------------------------------------------------------------


def cut(parts, open_by=0.0, step=0.0):
    """The slab (or the bar) in flush parts with the same grid lines, a hair open, or every second one lower by twice the step."""
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
        piece["min"][up] -= 2 * step * (i % 2)
        pieces.append(piece)
    problem.recipe["parts"][scene.slab : scene.slab] = pieces
    return problem


def searched(problem, every):
    problem.deck["contact"]["search_every"] = every
    return problem


def meshed(part, finer=1, split=False):
    problem = scene.problem()
    chosen = problem.recipe["parts"][part]
    chosen["divisions"] = [finer * n for n in chosen["divisions"]]
    if split:
        chosen["split"] = "triangles" if dimension == 2 else "tetrahedra"
    return retold.without_fixed_step(problem)


def sliced(thickness):
    """The plane problem as hexahedra, one element thick [m], between planes of symmetry. Bulk viscosity and hourglass control measure
    an element by its volume^(1/dimension), and are switched off in both. Contact measures faces that turn by their area^(1/2): where some
    do, a slice as thick as they are long knows them as the plane problem does.
    """
    flat, thick = scene.problem(), scene.problem()
    thick.recipe["dimension"] = 3
    for part in thick.recipe["parts"]:
        part["min"], part["size"], part["divisions"] = [*part["min"], 0.0], [*part["size"], thickness], [*part["divisions"], 1]
        if "rotate" in part:
            part.update(rotate=[0, 0, part["rotate"]], about=[*part["about"], 0.0], offset=[*part["offset"], 0.0])
    thick.recipe.setdefault("node_sets", {}).update(back={"where": {"z": 0}}, front={"where": {"z": thickness}})
    conditions = thick.deck.setdefault("conditions", [])
    conditions += [{"type": "symmetry", "node_set": name, "normal": [0, 0, 1]} for name in ("back", "front")]
    for problem in (flat, thick):
        problem.deck["viscosity"] = {"linear": 0, "quadratic": 0}
        for block in problem.deck["blocks"].values():
            block["hourglass"] = {"stiffness": 0}
    return flat, thick


def declared():
    problem = scene.problem()
    problem.deck["contact"]["pairs"] = [{"blocks": ["*", "*"], "declared": True}]
    return problem


# --- the list ------------------------------------------------------------------------------------------------------------------------------

original = scene.problem()
run = case.run("original", original.recipe, original.deck, edit_mesh=original.edit_mesh, energy=1e-3, remainder=1e-3)
base = Seen(original, run)
length, speed = scene.scale or (largest(base.motion), max(largest(base.velocity), largest(base.nodal[1])))
plain = scene.problem()
kind, rough, thrown = name.split("_")[0], name.endswith("rough"), name.split("_")[0] in ("corner", "tumble")

# Round-off: of numbers of order one it grows to 1e-9 in some thousand cycles. Coordinates of `reach` metres are known to reach / 2^53 only;
# 200 times that is allowed, which counts where closures are all that moves.
end = original.deck["time"]["end"]
km, drift = 1000.0, 100.0


def rounding(reach):
    return 1e-8 + 200 * reach * 2.0**-53 / length


mirror = numpy.diag([-1.0, 1.0, 1.0])
angles = 17.3 if dimension == 2 else [17.3, -31.7, 0]
frame = [1.0, -1.0, 1.0 if dimension == 3 else 0.0]
parts = range(len(original.recipe["parts"]))

if kind == "rest":
    still = max(largest(base.motion), largest(base.nodal[0])) / length, max(largest(base.velocity), largest(base.nodal[1])) / speed
    case.check("original: stays at rest", max(still), 0, 1e-9)
exact("turned", retold.in_frame(plain, rotation(angles)), 1e-8)
if everything or scene.thorough:
    exact("renumbered", retold.renumbered(plain, len(base.nodal[0])), 1e-9)
    near("blocks in another order", retold.reordered(plain, list(parts)[::-1]), 1e-9)
    exact("mirrored", retold.in_frame(plain, mirror), 1e-9)
    exact("moved by 1 km", retold.in_frame(plain, offset=[km * v for v in frame]), rounding(km))
    if "damping" not in plain.deck:  # mass damping brakes motion against the axes
        exact("seen from 100 m/s", retold.in_frame(plain, velocity=[drift * v for v in frame]), rounding(drift * end))
    exact("in mm, ms and g", retold.in_units(plain, 1e3, 1e3, 1e3), 1e-9)
    exact("in units of powers of two", retold.in_units(plain, 2.0**10, 2.0**7, 2.0**5), 1e-12)

# Flush parts with the same grid lines: all that differs are hidden edges. See README.md for the bounds.
flush = 1e-2 if rough and not thrown else 1e-3
if scene.along == 0:
    near("2 flush slabs", cut(2), flush)
    near("7 flush slabs", cut(7), flush)
    if kind == "slide":  # a search may come just when an edge of the block lies on a seam
        near("7 flush slabs, searched every cycle", searched(cut(7), 1), flush)
    if everything or scene.thorough:
        near("2 slabs a hair open", cut(2, open_by=1e-6), flush)
        near("7 slabs a hair open", cut(7, open_by=1e-6), flush)
        for step in (1e-6, 1e-5, 1e-4):
            lifted = 0.0 if kind == "rest" else 2 * step
            shaken = lifted / 0.1414 if thrown else 0.0 if kind == "rest" else lifted * scene.frequency / speed
            # What comes back from a slab that is lower by s is late by s (1 / v_in + 1 / v_out), thus lower by at most 2 s.
            near(f"7 slabs with steps of {2 * step:g} m", cut(7, step=step), flush + (2 if thrown else 1) * lifted / length, flush + shaken,
                 report=(kind == "tumble" and step > 1e-6) or (kind == "spin" and rough and step > 1e-5))
else:
    near("2 flush strips", cut(2), 1e-3)

if everything or scene.thorough:
    for words, part in (("rider", scene.rider), ("slab", scene.slab)):
        finer = scene.finer if part == scene.rider else scene.mesh
        near(f"{words} meshed twice as fine", meshed(part, 2), finer)
        near(f"{words} split", meshed(part, split=True), scene.mesh)

if (kind in ("bars", "settle", "slide") or name == "corner_2d") and dimension == 2 and not rough:
    flat, thick = sliced(0.05 if kind == "slide" else 1.0)  # the rider's ends and the slab have faces of 0.05 m
    near("slice of 3D", thick, 1e-8, other=look("plane to be sliced", flat))
if kind in ("bars", "settle"):
    near("joint declared", declared(), 1e-3)
if kind == "spin" and rough:  # round-off decides about gaps of exactly zero: README.md
    touching = spin(3, 0.3, gap=0.0).problem()
    first = look("touching at the start", touching)
    exact("touching at the start, turned", retold.in_frame(touching, rotation(angles)), 1e-8, report=True, other=first)
case.finish()
