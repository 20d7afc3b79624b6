"""A corner is pushed into a fixed face: Simple Common Planes with both kinds of forces, beside Cundall's common plane."""

import csv
import math
import subprocess

from coplanetest import Case, program

case = Case("V04", __file__)
deck = case.load()
stiffness = deck["joints"]["spring"]["normal_stiffness"]
apart, side = 0.002, 1.0  # before the push; length of a side of the corner [m]
TABLE_DEPTH = 0.01  # of the corners in the table [m]
rows = subprocess.run([program.binary("coplane_classic_corner_table")], stdout=subprocess.PIPE, text=True, check=True).stdout
table = {int(row["angle"]): row for row in csv.DictReader(rows.splitlines()) if row["kind"] == "corner2d"}


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
    # The classic plane is no contact of whole runs: its forces are those of the table, for unit stiffness and its depth.
    row = table[angle]
    section = stiffness * float(row["classic_section"]) * (depth / TABLE_DEPTH) ** 2
    case.check(f"{angle}: common plane, section [N]", section, stiffness * depth**2 * math.tan(theta), 1e-10, relative=True)
    case.check(f"{angle}: ratio", simple / section, math.cos(delta) / math.sin(theta), 1e-10, relative=True)
    shadow = stiffness * float(row["classic_shadow"]) * depth / TABLE_DEPTH
    case.check(f"{angle}: common plane, shadow [N]", shadow, 2 * stiffness * side * depth * math.sin(theta), 1e-10, relative=True)
case.finish()
