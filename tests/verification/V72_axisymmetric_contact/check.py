"""V72: contact between bodies of revolution: two rings under pressure, and a cylinder on a cylinder."""

import math

import numpy
from coplanetest import Case

case = Case("V72", __file__)

# Lame: one ring of radii a and b under the pressure p from inside; radial stress where the rings meet.
a, r, b, p, height = 1.0, 1.5, 2.0, 1e6, 0.4
lame = p * a**2 / (b**2 - a**2)
joint = lame * (b**2 / r**2 - 1)
recipe, deck = case.load("mesh_rings.yaml"), case.load("deck_rings.yaml")
for name, split in (("quadrilaterals", None), ("triangles", "triangles")):
    for part in recipe["parts"]:
        part.pop("split", None)
        if split:
            part["split"] = split
    run = case.run(name, recipe, deck, energy=2e-3)
    planes = run.planes()
    touching = planes["area"] > 0
    pressure, area = planes["normal_traction"][touching], planes["area"][touching]
    mean = numpy.sum(pressure * area) / numpy.sum(area)
    case.check(f"{name}: pressure between the rings [Pa]", mean, joint, 0.02, relative=True)
    uneven = (pressure.max() - pressure.min()) / mean
    case.check(f"{name}: uneven by, over the mean", uneven, 0, 0.15 if split else 1e-9)
    case.check(f"{name}: area of contact [m^2]", numpy.sum(area), 2 * math.pi * r * height, 1e-4, relative=True)
    results = run.results
    outer = results.nodes_of("outer")
    force = numpy.sum(results.nodal("contact_force_x")[outer])
    case.check(
        f"{name}: sum of nodal forces over 2 pi r L p", force / (2 * math.pi * r * height * mean), 1, 1e-3
    )
    # u(b) = (1 - nu^2)/E (2 lame b) / ... in plane strain: (1+nu)/E [ (1-2nu) lame b + lame b ]
    outside = 1.3 / 200e9 * ((1 - 0.6) * lame * b + lame * b)
    case.check(f"{name}: motion of the outside [m]", run.history["outside_displacement_x"][-1], outside, 0.01, relative=True)
    if split is None:
        case.same_bits(name, recipe, deck, run)

# A uniform axial stress stays uniform across faces that do not match, as far as the axis.
column = case.run(
    "column", case.load("mesh_column.yaml"), case.load("deck_column.yaml"), energy=2e-3, load=math.pi * 1e5
)
for block in ("lower", "upper"):
    axial = column.results.element(block, "stress_yy")
    case.check(f"column: largest error of the axial stress, {block} [Pa]", numpy.max(numpy.abs(axial + 1e5)), 0, 1)
    for component in ("xx", "zz"):
        other = column.results.element(block, f"stress_{component}")
        case.check(f"column: largest stress {component}, {block} [Pa]", numpy.max(numpy.abs(other)), 0, 1)
planes = column.planes()
case.check(
    "column: force between the cylinders [N]", numpy.sum(planes["normal_traction"] * planes["area"]),
    math.pi * (1 + 0.3 * 1e5 / 50e6) ** 2 * 1e5, 1e-5, relative=True,
)


def beside_axis(points):
    """As meshers write it: R cos(pi / 2), with either sign."""
    points = points.copy()
    axis = numpy.flatnonzero(points[:, 0] == 0)
    points[axis, 0] = 6e-17 * (-1) ** axis
    return points


again = case.run("column_beside_axis", case.load("mesh_column.yaml"), case.load("deck_column.yaml"), energy=2e-3, load=math.pi * 1e5, change_mesh=beside_axis)
case.check_equal("column beside the axis by round-off: state hash", again.state_hash, column.state_hash)
case.finish()
