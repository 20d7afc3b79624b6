"""V87: a cracked concrete beam with one bar against the transformed cracked section: rigid halves on a bed of springs, a row of elastic blocks,
and a beam that is struck: it comes to rest where its plastic hinge has taken the energy."""

import csv
import math
import pathlib

import numpy
from coplanetest import Case, turned

case = Case("V87", __file__)
height, depth = 0.4, 0.35  # of the beam, and of the bar below its top [m]; one metre out of the plane
steel, area = 200e9, 3.5e-3  # of the bar [Pa, m^2]
concrete = {"model": "linear_elastic", "density": 2400, "youngs_modulus": 30e9, "poisson_ratio": 0}  # plane strain is plane stress then
turn, ramp = 1e-3, 0.01  # of one end against the other [rad], in this time [s]
near = 0.5 * turn  # places and directions are those of the turned bodies


def exact(modulus, curvature):
    """Depth of the compressed zone [m], lever arm [m], force of the bar [N] and moment [N m] of a cracked section whose compressed fibres have this
    modulus: the moments of areas about the neutral axis are equal, x^2 / 2 = n A (d - x)."""
    n_area = steel / modulus * area
    x = -n_area + math.sqrt(n_area**2 + 2 * n_area * depth)
    arm, force = depth - x / 3, steel * area * curvature * (depth - x)
    return x, arm, force, force * arm


def deck_of(line, joints, pairs, **blocks):
    """The left end stands; the right one is turned and goes along x and y as it likes: there is no normal force and no shear."""
    rate = turn / ramp
    y = height - depth
    ends = [[line.pop("low"), y], [line.pop("high"), y]]
    return {
        "materials": {"concrete": concrete},
        "blocks": {"left": {"material": "concrete", "rigid": True}, "right": {"material": "concrete", "rigid": True}, **blocks},
        "joints": joints,
        "contact": {"pairs": pairs},
        "conditions": [
            {"type": "rigid_motion", "block": "left", "velocity": [0, 0, 0], "angular_velocity": [0, 0, 0]},
            {"type": "rigid_motion", "block": "right", "angular_velocity": [0, 0, f"t < {ramp} ? {rate}*(1 - cos(2*_pi*t/{ramp})) : 0"]},
        ],
        "lines": {"bar": {"points": ends, "area": area, "youngs_modulus": steel, **line}},
        "damping": {"kinetic": True, "from": ramp, "until_force_ratio": 1e-8},
        "time": {"end": 1, "end_at_rest": True},
        "output": {"every": 1},
        "history": {"every": 1e-4, "tables": ["lines"], "rigid": ["*"]},
    }


def measured(run):
    """At the end: force of the bar in the middle [N], moment [N m], depth of the compressed zone [m] if all that gives is between the ends, and how
    much the force varies along the bar."""
    with open(pathlib.Path(run.folder, "run_lines.csv")) as file:
        rows = list(csv.DictReader(file))
    forces = numpy.array([float(row["force[N]"]) for row in rows if row["cycle"] == rows[-1]["cycle"]])
    # The ends close where the right one, which turns about its middle, has not moved along x.
    x = height / 2 - run.history["right_displacement_x"][-1] / turn
    return forces[len(forces) // 2], run.history["right_reaction_moment_z"][-1], x, numpy.ptp(forces) / forces.mean()


# --- two rigid halves: the joint between them is the compressed concrete, the bar is free between its ends ---------------------------

gauge, bed = 0.2, 1e11  # length of the bar [m]; stiffness of the joint [Pa/m]
x, arm, force, moment = exact(bed * gauge, turn / gauge)
for faces in (20, 40):
    name = f"halves_{faces}"
    mesh = {
        "dimension": 2,
        "parts": [
            {"shape": "box", "block": "left", "min": [-0.15, 0], "size": [0.15, height], "divisions": [5, faces]},
            {"shape": "box", "block": "right", "min": [0, 0], "size": [0.15, height], "divisions": [5, faces]},
        ],
    }
    deck = deck_of(
        {"low": -gauge / 2, "high": gauge / 2, "attach": "ends"},
        {"bed": {"model": "linear", "normal_stiffness": bed, "shear_stiffness": bed, "friction": 0.6}},
        [{"blocks": ["left", "right"], "joint": "bed"}],
    )
    run = case.run(name, mesh, deck, load=force)
    pulled, turning, zone, _ = measured(run)
    case.check(f"{name}: force of the bar [N]", pulled, force, near, relative=True)
    case.check(f"{name}: moment [N m]", turning, moment, near, relative=True)
    case.check(f"{name}: compressed zone [m]", zone, x, near, relative=True)
    case.check(f"{name}: moment over force, the lever arm [m]", turning / pulled, arm, near, relative=True)
again = case.run("halves_turned", *turned(mesh, deck, 27, offset=(3, -2, 0))[:2], load=force)
case.check("halves_turned: force of the bar [N]", measured(again)[0], pulled, 1e-8, relative=True)
case.same_bits(name, mesh, deck, run, ranks=2)

# --- a row of elastic blocks, cracked through between all of them --------------------------------------------------------------------

normal = 3e12  # of a crack that is closed [Pa/m]
for blocks in (6, 12):
    name, width, faces = f"row_{blocks}", 0.6 / blocks, 40
    # A crack and half a block on both of its sides give, and the bar from middle to middle. At the ends half a block is missing.
    modulus = 1 / (1 / concrete["youngs_modulus"] + 1 / (normal * width))
    x, arm, force, moment = exact(modulus, turn / ((blocks + 1) * width))
    end = 1 / (1 / normal + width / 2 / concrete["youngs_modulus"])
    mesh = {
        "dimension": 2,
        "parts": [
            {"shape": "box", "block": "left", "min": [-0.1, 0], "size": [0.1, height], "divisions": [3, faces]},
            {"shape": "rock", "block": "row", "blocks": [blocks, 1], "size": [width, height], "divisions": [24 // blocks, faces]},
            {"shape": "box", "block": "right", "min": [0.6, 0], "size": [0.1, height], "divisions": [3, faces]},
        ],
    }
    deck = deck_of(
        {"low": -width / 2, "high": 0.6 + width / 2, "attach": "perfect", "segment_length": width},
        {
            "crack": {"model": "linear", "normal_stiffness": normal, "shear_stiffness": normal, "friction": 0.6},
            "end": {"model": "linear", "normal_stiffness": end, "shear_stiffness": end, "friction": 0.6},
        },
        [{"blocks": ["row", "row"], "joint": "crack"}, {"blocks": ["left", "row"], "joint": "end"}, {"blocks": ["right", "row"], "joint": "end"}],
        row={"material": "concrete"},
    )
    run = case.run(name, mesh, deck, load=force)
    pulled, turning, zone, varies = measured(run)
    case.check(f"{name}: force of the bar in the middle [N]", pulled, force, 2e-3, relative=True)
    case.check(f"{name}: moment [N m]", turning, moment, 2e-3, relative=True)
    case.check(f"{name}: compressed zone [m]", zone, x, 2e-3, relative=True)
    case.check(f"{name}: moment over force, the lever arm [m]", turning / pulled, arm, 2e-3, relative=True)
    case.check(f"{name}: change of the force along the bar", varies, 0, 3e-3)

# --- struck: two halves that turn about their supports are stopped by the plastic hinge between them ----------------------------------

span, speed, yields, area, bed, pivot = 2.0, 3.0, 400e6, 1e-3, 1e12, 0.38  # [m], spin [rad/s], [Pa], [m^2], [Pa/m], height of the supports [m]


def hinge(rotation):
    """Moment of the hinge [N m]."""
    x, arm, force, moment = exact(bed * gauge, rotation / gauge)
    if force < yields * area:
        return moment
    x = math.sqrt(2 * yields * area / (bed * rotation))  # bed * rotation * x^2 / 2 balances the bar
    return yields * area * (depth - x / 3)


name = "struck"
mesh = {
    "dimension": 2,
    "parts": [
        {"shape": "box", "block": "left", "min": [-span / 2, 0], "size": [span / 2, height], "divisions": [10, 20]},
        {"shape": "box", "block": "right", "min": [0, 0], "size": [span / 2, height], "divisions": [10, 20]},
    ],
    "node_sets": {
        "left": {"block": "left", "where": {"x": -span / 2, "y": pivot}},
        "right": {"block": "right", "where": {"x": span / 2, "y": pivot}},
        "middle": {"block": "left", "where": {"x": 0, "y": pivot}},
    },
}
y = height - depth
deck = {
    "materials": {"stiff": {**concrete, "youngs_modulus": 300e9}},  # bends by next to nothing
    "blocks": {"left": {"material": "stiff", "element": "assumed_strain"}, "right": {"material": "stiff", "element": "assumed_strain"}},
    "joints": {"bed": {"model": "linear", "normal_stiffness": bed, "shear_stiffness": bed, "friction": 0.6}},
    "contact": {"pairs": [{"blocks": ["left", "right"], "joint": "bed"}]},
    "conditions": [{"type": "fixed", "node_set": "left"}, {"type": "fixed", "node_set": "right", "components": ["y"]}],
    "initial": [
        {"block": "left", "angular_velocity": [0, 0, -speed], "center": [-span / 2, pivot, 0]},
        {"block": "right", "angular_velocity": [0, 0, speed], "center": [span / 2, pivot, 0]},
    ],
    "lines": {"bar": {"points": [[-gauge / 2, y], [gauge / 2, y]], "attach": "ends", "area": area, "youngs_modulus": steel, "yield_stress": yields}},
    "time": {"end": 0.012},
    "output": {"every": 1},
    "history": {"every": 2e-5, "tables": ["lines"], "probes": [{"name": "middle", "node_set": "middle"}]},
}
run = case.run(name, mesh, deck, load=1e5)
h = run.history
mass = concrete["density"] * height * span / 2
about = mass * ((span**2 / 4 + height**2) / 12 + span**2 / 16 + (pivot - height / 2) ** 2)
energy = about * speed**2  # of both
case.check(f"{name}: energy at the start [J]", h["kinetic"][0], energy, 0.01, relative=True)
rotations = numpy.linspace(0, 0.06, 60001)[1:]
works = numpy.cumsum([hinge(one) for one in rotations]) * (rotations[1] - rotations[0])
rest = float(numpy.interp(energy, works, rotations))  # rotation of the hinge that takes it all [rad]
at = int(numpy.argmin(h["middle_displacement_y"]))
case.check(f"{name}: deflection when it comes to rest [m]", -h["middle_displacement_y"][at], rest / 2 * span / 2, 0.01, relative=True)
case.check(f"{name}: kinetic energy then, over that at the start", h["kinetic"][at] / energy, 0, 0.005)
stretched = rest * (depth - math.sqrt(2 * yields * area / (bed * rest))) - yields / steel * gauge
case.check(f"{name}: lost in the bar then [J]", h["line_plastic"][at], yields * area * stretched, 0.01, relative=True)
case.check(f"{name}: lost in the bar then, over the energy at the start", h["line_plastic"][at] / energy, 1, 0.05)
case.same_bits(name, mesh, deck, run, ranks=2)
case.restarts(name, mesh, deck, run, h["time"][at // 2])  # while the bar yields
case.finish()
