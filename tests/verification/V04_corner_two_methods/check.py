"""A corner is pushed into a fixed face, by Simple Common Planes and by Cundall's common plane."""

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
    depth, simple = push(f"simple_{angle}", theta)
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
            f"bars_{dimension}d_{method}", {"dimension": dimension, "parts": parts}, {**bars, "contact": {"method": method}}
        )
        for method in ("simple_common_plane", "common_plane")
    }
    simple, classic = runs["simple_common_plane"], runs["common_plane"]
    case.check_within(f"bars {dimension}d: largest stored energy [J]", max(simple.history["contact_stored"]), 1, numpy.inf)
    for field in ("displacement", "velocity"):
        expected = simple.results.nodal(field)
        error = numpy.max(numpy.abs(classic.results.nodal(field) - expected)) / numpy.max(numpy.abs(expected))
        case.check(f"bars {dimension}d: {field}, both methods", error, 0, 1e-10)
case.finish()
