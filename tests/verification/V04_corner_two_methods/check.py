"""A corner is pushed into a fixed face, by Simple Common Planes with both kinds of forces and by Cundall's common plane."""

import math

import numpy
from coplanetest import Case

case = Case("V04", __file__)
deck = case.load()
stiffness = deck["joints"]["spring"]["normal_stiffness"]
apart, side = 0.002, 1.0  # before the push; length of a side of the corner [m]


def recipe(theta):
    """A rhombus that stands on a corner of half-angle theta above a slab, one element each."""
    across, up = side * math.sin(theta), side * math.cos(theta)
    corners = [[0, apart], [across, apart + up], [0, apart + 2 * up], [-across, apart + up]]
    return {
        "dimension": 2,
        "parts": [
            {"shape": "box", "block": "slab", "min": [-5, -1], "size": [10, 1], "divisions": [1, 1]},
            {"shape": "quadrilateral", "block": "corner", "corners": corners, "divisions": [1, 1]},
        ],
        "node_sets": {"slab": {"block": "slab"}, "corner": {"block": "corner"}},
    }


def push(name, theta, **contact):
    """Depth of the corner and force on it, at the end of a run."""
    run = case.run(name, recipe(theta), {**deck, "contact": {**deck["contact"], **contact}})
    nodes = run.results.nodes_of("corner")
    depth = -run.results.nodal("displacement")[nodes, 1].mean() - apart
    force = run.results.nodal("contact_force")[nodes].sum(axis=0)
    case.check_within(f"{name}: depth [m]", depth, 0.0099, 0.0101)
    case.check(f"{name}: force along the face over that across", abs(force[0] / force[1]), 0, 1e-12)
    return depth, force[1]


for angle in (120, 90, 60):
    theta = math.radians(angle) / 2
    delta = (math.pi / 2 - theta) / 2
    # Two faces, the closure of each falls from d / cos(delta) to zero over d / (2 sin(delta)): energy and its slope.
    depth, potential = push(f"potential_{angle}", theta)
    expected = stiffness * depth**2 / (2 * math.cos(delta) ** 2 * math.sin(delta))
    case.check(f"{angle}: Simple Common Planes, forces of the potential [N]", potential, expected, 1e-10, relative=True)
    depth, simple = push(f"simple_{angle}", theta, forces="common_normal")
    expected = stiffness * depth**2 * math.cos(delta) / math.cos(theta)
    case.check(f"{angle}: Simple Common Planes [N]", simple, expected, 1e-10, relative=True)
    for search in ("candidates", "rotations"):
        depth, classic = push(f"{search}_{angle}", theta, method="common_plane", plane_search=search)
        expected = stiffness * depth**2 * math.tan(theta)
        case.check(f"{angle}: common plane by {search} [N]", classic, expected, 1e-10, relative=True)
    case.check(f"{angle}: ratio", simple / classic, math.cos(delta) / math.sin(theta), 1e-10, relative=True)
    depth, shadow = push(f"shadow_{angle}", theta, method="common_plane", area="full")
    expected = 2 * stiffness * side * depth * math.sin(theta)
    case.check(f"{angle}: common plane, whole shadow [N]", shadow, expected, 1e-10, relative=True)

# A corner that overlaps the slab at the start, so that its plane has an offset, is pushed and then rocks from one of its
# sides to the other: another pair of faces carries the plane then, and must know the offset.
sunk, pushed, tilt, square = 0.005, 0.005, math.radians(3), math.pi / 4


def rhombus(turn):
    """Corners of a square on its corner, turned, relative to that corner."""
    c, s, half = math.cos(turn), math.sin(turn), math.sqrt(0.5)
    plain = [(0, 0), (half, half), (0, 2 * half), (-half, half)]
    return numpy.array([[c * x - s * y, s * x + c * y] for x, y in plain])


start, end = rhombus(tilt), rhombus(-tilt)
rocking = recipe(square)
rocking["parts"][1]["corners"] = (start - [0, sunk]).tolist()
conditions = [{"type": "fixed", "node_set": "slab"}]
for n, (at, way) in enumerate(zip((start - [0, sunk]).tolist(), (end - start).tolist())):
    rocking["node_sets"][f"n{n}"] = {
        "block": "corner", "where": {"x": [at[0] - 0.1, at[0] + 0.1], "y": [at[1] - 0.1, at[1] + 0.1]}
    }
    # 10 ms down, 10 ms at rest, 10 ms turning, at rest again; pulses with the area 1.
    down, turn = "(200*max(0, 1 - abs(t - 0.005)/0.005))", "(200*max(0, 1 - abs(t - 0.025)/0.005))"
    value = [f"{way[0]}*{turn}", f"{way[1]}*{turn} - {pushed}*{down}", 0]
    conditions.append({"type": "velocity", "node_set": f"n{n}", "value": value})
rocks = {k: v for k, v in deck.items() if k != "initial"}
rocks |= {"conditions": conditions, "time": {"end": 0.031, "fixed_step": 2e-5}, "output": {"every": 1e-3}}
rocks["contact"] = {**deck["contact"], "method": "common_plane", "initial_overlap": "allow"}
run = case.run("rocking", rocking, rocks)
nodes = run.results.nodes_of("corner")
forces = [run.results.nodal("contact_force", step)[nodes, 1].sum() for step in range(len(run.results.times))]
before = forces[numpy.argmin(abs(run.results.times - 0.015))]
# The section of the right angle, half way down, when it is tilted.
section = (sunk + pushed) / 2 * (math.tan(square + tilt) + math.tan(square - tilt))
case.check("rocking: force before [N]", before, stiffness * pushed * section, 1e-9, relative=True)
case.check("rocking: force after, of the other side [N]", forces[-1], before, 1e-9, relative=True)
case.check_equal("rocking: planes", int(run.history["planes"][-1]), 2)
for ranks, threads in ((2, 1), (3, 2)):
    case.same_bits("rocking", rocking, rocks, run, ranks, threads)

# Bars whose faces match: both methods have the same planes.
bars = case.load("tests/verification/V21_equal_bars/deck.yaml")
for dimension, across in ((2, [5]), (3, [2, 2])):
    size = [1] + [0.07] * (dimension - 1)
    parts = [
        {"shape": "box", "block": block, "min": [x] + [0] * (dimension - 1), "size": size, "divisions": [50] + across}
        for block, x in (("left", -1), ("right", 0))
    ]
    runs = {
        method: case.run(
            f"bars_{dimension}d_{method}", {"dimension": dimension, "parts": parts}, {**bars, "contact": {"method": method, "forces": "common_normal"}}
        )
        for method in ("simple_common_plane", "common_plane")
    }
    simple, classic = runs["simple_common_plane"], runs["common_plane"]
    case.check_within(f"bars {dimension}d: largest stored energy [J]", max(simple.history["contact_stored"]), 0.1, numpy.inf)  # they did meet
    for field in ("displacement", "velocity"):
        expected = simple.results.nodal(field)
        error = numpy.max(numpy.abs(classic.results.nodal(field) - expected)) / numpy.max(numpy.abs(expected))
        case.check(f"bars {dimension}d: {field}, both methods", error, 0, 1e-10)
case.finish()
