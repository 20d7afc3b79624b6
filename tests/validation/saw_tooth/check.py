"""Patton's saw teeth: shear over normal force of a joint with teeth of angle i is tan(phi + i) uphill, and the joint rises by tan(i)."""

import math

import numpy
from coplanetest import ValidationCase

case = ValidationCase(__file__)
TOOTH, HEIGHT, LENGTH = 0.1, 0.3, 0.5  # length of a tooth, height of each half, length of the joint [m]
NORMAL = 1e6 * LENGTH  # [N/m]


def shear(name, degrees, phi=30.0, along=4, rigid=True, normal_stiffness=1e11):
    """Shear over normal force and rise over way, means from 0.03 to 0.06 s; run and seconds. along: elements on a flank."""
    recipe, deck = case.load("mesh.yaml"), case.load()
    for part in recipe["parts"]:
        part["divisions"][0] = round(LENGTH / TOOTH * 2) * along
        part["divisions"][1] = 2 if rigid else 6 * along // 4 + 2
    slope = math.tan(math.radians(degrees))

    def teeth(x):
        at = numpy.mod(x[:, 0], TOOTH)
        x = x.copy()
        x[:, 1] += slope * numpy.minimum(at, TOOTH - at) * (1 - numpy.abs(x[:, 1]) / HEIGHT)
        return x

    deck["joints"]["flank"].update(friction=math.tan(math.radians(phi)), normal_stiffness=normal_stiffness, shear_stiffness=normal_stiffness / 2)
    run, spent = case.timed(name, recipe, deck, change_mesh=teeth, load=2 * NORMAL, remainder=0.05)
    h = run.history
    rows = h["time"] > 0.03
    way = h["upper_displacement_x"][rows]
    return h["upper_reaction_x"][rows].mean() / NORMAL, numpy.polyfit(way, h["upper_displacement_y"][rows], 1)[0], run, spent


for degrees in (0, 10, 20, 30):
    ratio, rise, run, spent = shear(f"teeth_{degrees}", degrees)
    case.check(f"teeth of {degrees} degrees, friction of 30: shear over normal force", ratio, math.tan(math.radians(30 + degrees)), 0.02, relative=True)
    case.check(f"teeth of {degrees} degrees, friction of 30: rise over way", rise, math.tan(math.radians(degrees)), 0.005)
    if degrees == 20:
        case.picture(run, "--shares", "1", "--planes", "arrows", "--size", "800", "500")
if case.full:
    for along in (1, 2, 4, 8):
        ratio, rise, run, spent = shear(f"along_{along}", 20, along=along)
        case.study("teeth of 20 degrees: shear over normal force", f"{along} on a flank", ratio, math.tan(math.radians(50)), spent)
        case.study("teeth of 20 degrees: rise over way", f"{along} on a flank", rise, math.tan(math.radians(20)), spent)
case.finish()
