"""V20: a ball bounces off a plane by Hertz' law, with the contact of the defaults. `fine`: 32 elements along the radius as well."""

import math
import sys

import numpy
from coplanetest import Case, meshes

case = Case("V20", __file__)
RADIUS, SPEED = 0.1, 20.0


def quarter(path):
    """Keeps what lies at x > 0, y > 0 of the ball; the plate stays whole. Nodes of the cuts are sets."""
    mesh = meshes.read(path)
    kept = []
    for block in mesh.blocks:
        centre = mesh.points[block.nodes].mean(axis=1)
        inside = (centre[:, 0] > 0) & (centre[:, 1] > 0) | (block.name != "ball")
        block.attributes = {name: values[inside] for name, values in block.attributes.items()}
        block.nodes = block.nodes[inside]
        kept.append(block.nodes.ravel())
    used = numpy.unique(numpy.concatenate(kept))
    number = numpy.full(len(mesh.points), -1)
    number[used] = numpy.arange(len(used))
    for block in mesh.blocks:
        block.nodes = number[block.nodes]
    mesh.points = mesh.points[used]
    ball = numpy.unique(next(block.nodes for block in mesh.blocks if block.name == "ball"))
    for axis, name in enumerate(("x0", "y0")):
        mesh.node_sets[name] = ball[numpy.abs(mesh.points[ball, axis]) < 1e-9 * RADIUS]
    meshes.write(mesh, path)


def hertz(stiffness, mass):
    """F = K d^1.5 stops and returns the mass: greatest force [N], and for how long the force is above a tenth of it [s]."""
    deepest = (1.25 * mass * SPEED**2 / stiffness) ** 0.4
    # dt = dd / v with v^2 = V^2 (1 - s^2.5), s = d / deepest; s = sin^0.8 keeps the integrand finite.
    angle = numpy.linspace(math.asin((0.1 ** (2 / 3)) ** 1.25), math.pi / 2, 2001)
    middle = 0.5 * (angle[1:] + angle[:-1])
    time = 2 * deepest / SPEED * numpy.sum(0.8 * numpy.sin(middle) ** -0.2) * (angle[1] - angle[0])
    return stiffness * deepest**1.5, time


def bounce(name, across):
    recipe, deck = case.load("mesh.yaml"), case.load()
    recipe["parts"][0]["across"] = across
    run = case.run(name, recipe, deck, edit_mesh=quarter, energy=1e-4, remainder=1e-3)
    h, steel = run.history, deck["materials"]["steel"]
    mass = 4 / 3 * math.pi * RADIUS**3 * steel["density"]
    stiffness = 4 / 3 * steel["youngs_modulus"] / (1 - steel["poisson_ratio"] ** 2) * math.sqrt(RADIUS)
    greatest, time = hertz(stiffness, mass)
    speed, at = h["ball_velocity_z"], h["time"]
    force = mass * numpy.diff(speed) / numpy.diff(at)
    above = numpy.flatnonzero(force > 0.1 * force.max())
    return {"greatest force": force.max() / greatest, "time above a tenth of it": (at[above[-1] + 1] - at[above[0]]) / time, "rebound": float(speed[-1] / SPEED)}


# The penalty is in series with the ball, and the surface is coarse: less force, more time.
for across, tolerances in ((32, (0.05, 0.05)), *(((64, (0.03, 0.04)),) if "fine" in sys.argv else ())):
    found = bounce(f"across_{across}", across)
    print(across, found)
    case.check(f"{across // 2} elements along the radius: greatest force over Hertz'", found["greatest force"], 1, tolerances[0])
    case.check(f"{across // 2} elements along the radius: time above a tenth of it over Hertz'", found["time above a tenth of it"], 1, tolerances[1])
    case.check_within(f"{across // 2} elements along the radius: speed after the impact over that before", found["rebound"], 0.95, 1)
case.finish()
