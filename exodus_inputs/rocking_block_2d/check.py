"""The block swings as a rigid one that turns about its corner; tests/verification/V51_rocking_block derives the numbers."""

import math

import numpy

from coplanetools import Example

WIDTH, HEIGHT, TILT = 0.3, 1.2, 0.5  # tilt at the start over the one that topples the block
example = Example()
h = example.history
example.balances(hourglass=0.08)
alpha = math.atan(WIDTH / HEIGHT)
across = h["head_displacement_x"] - h["foot_displacement_x"] + HEIGHT * math.sin(TILT * alpha)
up = h["head_displacement_y"] - h["foot_displacement_y"] + HEIGHT * math.cos(TILT * alpha)
turn = numpy.arctan2(across, up) / alpha
example.check("tilt at the start over the critical one", float(turn[0]), TILT, 1e-6)
upright = float(h["time"][numpy.argmax(turn < 0)])
example.check("time until the block stands upright [s]", upright, 0.3825, 0.04, relative=True)
if example.size != "coarse":
    # Housner's rigid block keeps 0.831 of its energy at each impact; one on a bed that gives way keeps more.
    swings = [float(turn[0])]
    for start in numpy.flatnonzero(numpy.diff(numpy.sign(turn))):
        rest = numpy.abs(turn[start + 1:])
        end = numpy.argmax(numpy.sign(turn[start + 1:]) != numpy.sign(turn[start + 1])) or len(rest)
        if rest[:end].max() > 0.05 and end < len(rest):
            swings.append(float(rest[:end].max()))
    print("swings over the critical tilt:", ", ".join(f"{swing:.3f}" for swing in swings))
    energy = [math.cos(alpha * (1 - swing)) - math.cos(alpha) for swing in swings]
    for number, (before, after) in enumerate(zip(energy, energy[1:]), 1):
        example.check_within(f"energy kept in impact {number}", after / before, 0.83, 1)
example.finish()
