"""One block on an incline stands, slides, topples, or does both, as the chart of Wyllie and Mah says; data of the 3DEC manual."""

import math

import numpy
from coplanetest import ValidationCase

case = ValidationCase(__file__)
GRAVITY, WIDTH, SLOPE = 10.0, 10.0, math.radians(40)  # [m/s^2], [m], [rad]


def put(name, height, degrees, size=2.5, end=4.0, **joint):
    """Slip of the block down the slope and its turn forward, both after damping has ended [m, rad]; run and seconds."""
    recipe, deck = case.load("mesh.yaml"), case.load()
    recipe["parts"][0]["divisions"] = [round(100 / size), 1]
    recipe["parts"][1].update(size=[WIDTH, height], divisions=[round(WIDTH / size), max(1, round(height / size))])
    recipe["node_sets"]["head"]["where"]["y"] = height
    deck["gravity"] = [f"{-GRAVITY * math.sin(SLOPE)!r}*min(t, 1)", f"{-GRAVITY * math.cos(SLOPE)!r}*min(t, 1)", 0]
    deck["joints"]["base"].update(friction=math.tan(math.radians(degrees)), **joint)
    deck["time"]["end"] = end
    run, spent = case.timed(name, recipe, deck, load=2000 * WIDTH * height * GRAVITY)
    h = run.history
    turn = numpy.arctan2(h["foot_displacement_x"] - h["head_displacement_x"], h["head_displacement_y"] - h["foot_displacement_y"] + height)
    at = int(numpy.searchsorted(h["time"], 2.0))
    return -(h["foot_displacement_x"][-1] - h["foot_displacement_x"][at]), turn[-1] - turn[at], run, spent


def needed(height):
    """Friction angle that the pivot of a block of this height needs to topple without slipping, at the start [degrees].

    About its lower corner it turns with 3 g sin(slope - delta) / (4 R), tan(delta) = width / height; force along the slope over that normal to it.
    """
    half, delta = math.hypot(WIDTH, height) / 2, math.atan(WIDTH / height)
    turning = 3 * GRAVITY * math.sin(SLOPE - delta) / (4 * half)
    return math.degrees(math.atan((GRAVITY * math.sin(SLOPE) - turning * height / 2) / (GRAVITY * math.cos(SLOPE) + turning * WIDTH / 2)))


def least_stiffness(height):
    """Of a bed of springs without tension on which the block stands, slope 40 degrees [Pa/m]: it turns by th, the weight's arm about the lower corner falls from a0 to a0 - z th
    (z: height of the centre above the corner), and the strip of width 3 arm / cos(slope) has to bear it: th arm^2 = 2 W cos^3(slope) / (9 k), which is possible up to th = a0 / (3 z).
    """
    arm = (WIDTH * math.cos(SLOPE) - height * math.sin(SLOPE)) / 2
    up = (height * math.cos(SLOPE) + WIDTH * math.sin(SLOPE)) / 2
    weight = 2000 * WIDTH * height * GRAVITY
    return 2 * weight * math.cos(SLOPE) ** 3 / 9 / (arm / (3 * up) * (2 * arm / 3) ** 2)


STIFF = dict(normal_stiffness=1e9, shear_stiffness=1e9)
# Of the manual: what stands, slides and topples; on a bed that is a hundred times stiffer than the manual's.
slip, turn, run, spent = put("stable", 10, 40.1, **STIFF)
case.check_within("stable: slip from 2 to 4 s [m]", abs(slip), 0, 1e-4)
case.check_within("stable: turn [rad]", abs(turn), 0, 1e-4)
slip, turn, run, spent = put("sliding", 5, 20, **STIFF)
# Damped until 2 s the block slides with v' = a - 20 v; then freely for 2 s.
a = GRAVITY * (math.sin(SLOPE) - math.tan(math.radians(20)) * math.cos(SLOPE))
case.check("sliding: slip from 2 to 4 s [m]", slip, a * 2 + a / 20 * 2, 0.02, relative=True)
case.check_within("sliding: turn [rad]", abs(turn), 0, 1e-4)
slip, turn, run, spent = put("toppling", 25, 40, **STIFF)
case.check_within("toppling: turn [rad]", turn, 0.2, math.inf)
case.check_within("toppling: slip of the lower corner over the way of the head", abs(slip) / (25 * turn), 0, 0.02)
case.picture(run, "--times", "0", "2", "3", "3.5", "4", "--strip", "5", "--planes", "none", "--window", "-25", "18", "-4", "28", "--size", "300", "230")
# Both: the chart has that wherever slope > friction and tan(slope) > width / height. Bodies do both only if the pivot slips and friction still turns them.
case.check_equal("a pivot of 24 degrees slips, and turns the block", math.degrees(math.atan(WIDTH / 25)) < 24 < needed(25), True)
slip, turn, run, spent = put("both", 25, 24, **STIFF)
case.check_within("both: turn [rad]", turn, 0.1, math.inf)
case.check_within("both: slip [m]", slip, 0.1, math.inf)
slip, turn, run, spent = put("chart_both", 14, 20, **STIFF)
case.check_within("14 m high, 20 degrees (the chart: slides and topples): turn [rad]", abs(turn), 0, 0.01)
slip, turn, run, spent = put("chart_both_30", 25, 30, **STIFF)
case.check_within("25 m high, 30 degrees (the chart: slides and topples): slip over the way of the head", abs(slip) / (25 * turn), 0, 0.02)

# The stiffness of the manual, 10 MPa/m, on a bed that is not four springs at corners: the block of 10 m sinks in at its edge, and goes.
case.check_within("least stiffness of a bed for the block of 10 m [MPa/m]", least_stiffness(10) / 1e6, 40, 42)
slip, turn, run, spent = put("manual_stiffness", 10, 40.1)
case.check_within("stable block on 10 MPa/m: turn from 2 to 4 s [rad]", turn, 0.05, math.inf)
case.other("stable block on 10 MPa/m: turn from 2 to 4 s [rad]", "3DEC manual: it stands", 0.0)

if case.full:
    for size in (5.0, 2.5, 1.25):
        slip, turn, run, spent = put(f"toppling_{size}", 25, 40, size, **STIFF)
        case.study("toppling: turn from 2 to 4 s [rad]", f"{size} m", turn, None, spent)
        slip, turn, run, spent = put(f"sliding_{size}", 5, 20, min(size, 5.0), **STIFF)
        case.study("sliding: slip from 2 to 4 s [m]", f"{size} m", slip, a * 2 + a / 20 * 2, spent)
    for stiffness in (1e7, 3e7, 5e7, 1e8, 1e9):
        slip, turn, run, spent = put(f"stable_{stiffness:g}", 10, 42, normal_stiffness=stiffness, shear_stiffness=stiffness)
        case.study("10 m high, friction of 42 degrees: turn from 2 to 4 s [rad]", f"bed of {stiffness / 1e6:g} MPa/m", turn, None, spent)
case.finish()
