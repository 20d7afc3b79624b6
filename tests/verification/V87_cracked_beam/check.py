"""V87: a cracked concrete beam with one bar against the transformed cracked section: rigid halves on a bed of springs, and a row of elastic blocks."""

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
errors = []
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
    errors.append(abs(turning / moment - 1))
    near = 0.8 / (faces * x / height) ** 2
    case.check(f"{name}: force of the bar [N]", pulled, force, near, relative=True)
    case.check(f"{name}: moment [N m]", turning, moment, near, relative=True)
    case.check(f"{name}: compressed zone [m]", zone, x, near, relative=True)
    case.check(f"{name}: moment over force, the lever arm [m]", turning / pulled, arm, near, relative=True)
again = case.run("halves_turned", *turned(mesh, deck, 27, offset=(3, -2, 0))[:2], load=force)
case.check("halves_turned: force of the bar [N]", measured(again)[0], pulled, 1e-6, relative=True)
case.same_bits(name, mesh, deck, run, ranks=2)

# --- a row of elastic blocks, cracked through between all of them --------------------------------------------------------------------

normal = 3e12  # of a crack that is closed [Pa/m]
errors = []
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
    errors.append(abs(turning / moment - 1))
    print(name, pulled / force - 1, turning / moment - 1, zone / x - 1, (turning / pulled) / arm - 1, varies)
case.finish()
