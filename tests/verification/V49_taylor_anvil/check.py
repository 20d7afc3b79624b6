"""V49: Taylor's rods, von Mises and Johnson-Cook, on a plane of symmetry and on an anvil through contact.

Usage: check.py [all]
"""

import sys

import numpy
from coplanetest import Case

case = Case("V49", __file__)
full = "all" in sys.argv[1:]


def strike(name, material, speed, length, radius, divisions, anvil=None, again=False, triangles=False):
    """Runs a rod on a plane of symmetry (anvil None) or through a joint on a fixed anvil. Returns its final length, largest
    radius, radius at a fifth of the old length, most plastic strain, and how far the rim of the foot lies above the rest.
    """
    recipe, deck = case.load("mesh.yaml"), case.load()
    recipe["parts"][0].update(size=[radius, length], divisions=divisions)
    if triangles:
        recipe["parts"][0]["split"] = "triangles"
        deck["blocks"]["rod"] = {"element": "nodal_pressure"}
    deck["geometry"] = "axisymmetric"
    deck["blocks"]["rod"]["material"] = material
    deck["initial"] = [{"block": "rod", "velocity": [0, -speed, 0]}]
    if anvil is None:
        del recipe["parts"][1], recipe["node_sets"]["anvil"]
        deck["contact"] = {"enabled": False}
        deck["conditions"] = [{"type": "fixed", "node_set": "foot", "components": ["y"]}]
        deck["materials"].pop("anvil")
    else:
        deck["blocks"]["anvil"] = {"material": "anvil"}
        deck["conditions"] = [{"type": "fixed", "node_set": "anvil"}]
        deck["joints"] = {"foot": {"model": "linear", "normal_stiffness": 5e14, "shear_stiffness": 0, **anvil}}
        deck["contact"] = {"pairs": [{"blocks": ["rod", "anvil"], "joint": "foot", "declared": True}]}
    run = case.run(name, recipe, deck, energy=2e-3)
    if again:
        case.same_bits(name, recipe, deck, run)
    return run, Shape(run, length)


class Shape:
    def __init__(self, run, length):
        results = run.results
        rod = results.nodes_of("rod")
        old = results.coordinates[rod]
        new = old + results.nodal("displacement")[rod]
        # Radius and height, in either dimension.
        r, y = (new[:, 0], new[:, 1]) if results.dimension == 2 else (numpy.hypot(new[:, 0], new[:, 1]), new[:, 2])
        before = old[:, 0] if results.dimension == 2 else numpy.hypot(old[:, 0], old[:, 1])
        side = before > before.max() * (1 - 1e-6)
        order = numpy.argsort(y[side])
        self.length = y.max() - y.min()
        self.radius = r.max()
        self.waist = numpy.interp(0.2 * length, y[side][order], r[side][order])
        self.strain = results.element("rod", "equivalent_plastic_strain").max()
        self.lift = y[side].min() - y.min()
        h = run.history
        case.check(f"{run.folder.split('/')[-1]}: hourglass energy over internal", h["hourglass"][-1] / h["internal"][-1], 0, 0.05)


# --- Copper of von Mises: lengths in metres, limits are those between published codes.
copper = ("copper", 227.0, 32.4e-3, 3.2e-3)
divisions = [8, 80] if full else [6, 60]
_, plane = strike("plane", *copper, divisions)
shapes = {"plane": plane}
if full:
    deck = case.load()
    deck["materials"] = {"copper": deck["materials"]["copper"]}
    deck["blocks"]["rod"]["material"] = "copper"
    deck["contact"] = {"enabled": False}
    deck["initial"] = [{"block": "rod", "velocity": [0, 0, -227]}]
    deck["conditions"] = [{"type": "symmetry", "node_set": "foot", "normal": [0, 0, 1]}]
    run = case.run("plane_3d", case.load("mesh_3d.yaml"), deck, energy=2e-3)
    shapes["plane_3d"] = Shape(run, 32.4e-3)
for name, shape in shapes.items():
    case.check_within(f"{name}: final length [m]", shape.length, 21.2e-3, 21.7e-3)
    case.check_within(f"{name}: radius of the foot [m]", shape.radius, 6.8e-3, 7.25e-3)
    case.check_within(f"{name}: most plastic strain", shape.strain, 2.4, 3.3)

# Triangles of average nodal pressure: neighbours must not trade volume while copper flows, until one has collapsed.
run, triangles = strike("triangles", *copper, divisions, triangles=True)
case.check("triangles: length over that of quadrilaterals", triangles.length / plane.length, 1, 0.01)
case.check("triangles: radius over that of quadrilaterals", triangles.radius / plane.radius, 1, 0.02)


def ring_volumes(x, corners):
    (ax, ay), (bx, by), (cx, cy) = (x[corners[:, k]].T for k in range(3))
    return ((bx - ax) * (cy - ay) - (cx - ax) * (by - ay)) * (ax + bx + cx)


mesh = run.results  # sections
corners = mesh.connectivity("rod")
ratio = ring_volumes(mesh.coordinates[:, :2] + mesh.nodal("displacement")[:, :2], corners) / ring_volumes(mesh.coordinates[:, :2], corners)
case.check_within("triangles: least volume over the first one", ratio.min(), 0.7, 1)
case.check_within("triangles: most volume over the first one", ratio.max(), 1, 1.3)

# The anvil as a body. A joint that holds tension is the plane of symmetry; without tension the foot comes off, because the
# waves from its rim meet on the axis as tension of more than 1 GPa after 4 us, and the rim curls up.
_, bonded = strike("bonded", *copper, divisions, anvil={"tensile_strength": 1e12, "cohesion": 1e12})
for what in ("length", "radius", "strain"):
    case.check(
        f"bonded: {what} over that on the plane", getattr(bonded, what) / getattr(plane, what), 1, 0.02 if what == "strain" else 0.01
    )
run, dry = strike("dry", *copper, divisions, anvil={})
case.check("dry: length over that on the plane", dry.length / plane.length, 1, 0.01)
case.check("dry: radius over that on the plane", dry.radius / plane.radius, 1, 0.01, report=True)
case.check_within("dry: the rim lies above the middle of the foot [m]", dry.lift, 5e-5, 5e-4)
case.check_within("dry: area of the foot that is off, at most", max(run.history["open"]), 1, numpy.inf)

# --- Against measured rods, (README: why copper is given more room).
measured = {"copper_ofhc": (190.0, 16.2e-3, 13.5e-3, 10.1e-3, 0.08), "iron_armco": (221.0, 19.8e-3, 13.7e-3, 8.6e-3, 0.05)}
for name, (speed, length, foot, waist, tolerance) in measured.items():
    _, rod = strike(name, name, speed, 25.4e-3, 3.81e-3, [10, 66] if full else [6, 40], again=name == "copper_ofhc")
    case.check(f"{name}: final length [m]", rod.length, length, tolerance, relative=True)
    case.check(f"{name}: diameter of the foot [m]", 2 * rod.radius, foot, tolerance, relative=True)
    case.check(f"{name}: diameter at a fifth of the length [m]", 2 * rod.waist, waist, tolerance, relative=True)
if full:
    _, rod = strike("steel_4340", "steel_4340", 343.0, 25.4e-3, 3.81e-3, [6, 40])
    case.check("steel_4340: final length [m]", rod.length, 21.5e-3, 0.05, relative=True, report=True)
    case.check("steel_4340: diameter of the foot [m]", 2 * rod.radius, 11.1e-3, 0.05, relative=True, report=True)
case.finish()
