"""A stone that loses a fixed part of its speed at each impact bounces in flights that form a geometric series, and rests after a time that is known."""

import math

import numpy
from coplanetest import ValidationCase
from coplanetest.rebound import restitution

case = ValidationCase(__file__)
G, HEIGHT, SIDE, DENSITY = 9.81, 0.05, 0.1, 2300.0
ZETA = 0.10  # of the stone as a whole
FALL = math.sqrt(2 * HEIGHT / G)
IMPACT = G * FALL


def height(times, e):
    """Of the stone that bounces off a rigid floor with Newton's restitution e [m]; nothing after the last impact."""
    found = numpy.where(times < FALL, HEIGHT - G * times**2 / 2, 0.0)
    begin, speed = FALL, e * IMPACT
    while speed > 1e-4 * IMPACT:
        flight = 2 * speed / G
        t = times - begin
        found = numpy.where((t >= 0) & (t < flight), speed * t - G * t**2 / 2, found)
        begin, speed = begin + flight, e * speed
    return found


def bounce(name, stiffness=1e11, step=0.4, end=None):
    """Restitution of each of the first impacts, time at which it rests, worst difference of the height over the height of fall; run and seconds."""
    recipe, deck = case.load("mesh.yaml"), case.load()
    deck["joints"]["spring"]["normal_stiffness"] = stiffness
    deck["contact"]["damping"] = {"normal": ZETA * math.sqrt(2)}  # of the surface, which has half of the mass (V24)
    deck["time"].update(step_factor=step, maximum_step=1e-5 * step / 0.4, **({"end": end} if end else {}))
    run, spent = case.timed(name, recipe, deck, load=DENSITY * SIDE**2 * G)
    h = run.history
    t, y, v = h["time"], HEIGHT + h["stone_displacement_y"], h["stone_velocity_y"]
    exact = height(t, restitution(ZETA))
    # Impacts: between two lines of the history the stone turns from down to up. Its speeds there are those of free flight on either side.
    speeds = []
    for i in numpy.flatnonzero((v[:-1] < 0) & (v[1:] > 0)):
        before, after = i - 3, i + 4
        if before > 0 and after < len(t):
            down, up = math.sqrt(max(v[before] ** 2 + 2 * G * y[before], 0)), math.sqrt(max(v[after] ** 2 + 2 * G * y[after], 0))
            speeds.append((down, up))
    ratios = [up / down for down, up in speeds[:5]]
    return ratios, numpy.sqrt(numpy.mean((y - exact) ** 2)) / HEIGHT, y, t, run, spent


e = restitution(ZETA)
rest = FALL + 2 * e * IMPACT / G / (1 - e)
ratios, off, y, t, run, spent = bounce("ball")
for n, ratio in enumerate(ratios, start=1):
    case.check(f"restitution of impact {n}", ratio, e, 0.02, relative=True)
case.check("impacts that were found", len(ratios), 5, 0)
case.check("height over time: root mean square of the difference over the height of fall", off, 0, 0.02)
case.check("largest height after the end of the series, over the height of fall", numpy.max(numpy.abs(y[t > rest * 1.02])) / HEIGHT, 0, 1e-3)
case.picture(run, "--color", "velocity", "--shares", "0", "0.17", "0.33", "0.5", "0.67", "1", "--strip", "6", "--planes", "none", "--size", "170", "200")
if case.full:
    for stiffness in (1e10, 1e11):
        for step in (0.8, 0.4, 0.2, 0.1):
            ratios, _, _, _, _, spent = bounce(f"stiffness_{stiffness:g}_{step}", stiffness, step, end=0.15)
            case.study("restitution of the first impact", f"joint of {stiffness / 1e9:g} GPa/m, steps of {step}", ratios[0], e, spent)
case.finish()
