"""A brick wall under pressure is sheared (walls J4D and J5D of Raijmakers and Vermeltfoort): load over displacement."""

import numpy
from coplanetest import ValidationCase

case = ValidationCase(__file__)
LENGTH, BRICK, COURSE, COURSES, THICKNESS = 0.99, 0.22, 0.0625, 16, 0.1  # [m]
PRESSURE, FRICTION, COHESION = 0.3e6, 0.75, 0.35e6
SETTLE, SHEAR, WAY = 0.03, 0.12, 3e-3  # [s, s, m]
# J4D as read off a plot by those who wrote the source: displacement [mm], load [kN], uncertain by 8 kN.
MEASURED = numpy.array([[0.2, 18], [0.4, 34], [0.7, 48], [1.0, 57], [1.4, 54], [1.8, 48], [2.2, 42], [2.6, 38]])


def wall(name, held, fine=1, shear=SHEAR, stiffness=1.0, until=WAY, crushed=None):
    """Displacement [mm], shear and vertical load [kN]. held: the upper beam is pushed down until the pressure is there and then kept at its height; else it bears a constant load. It never turns. until: way of the beam at the end [m]. crushed: keys of the cap of the joints."""
    recipe, deck = case.load("mesh.yaml"), case.load()
    for course in range(COURSES):
        x, width = 0.0, BRICK / (1 + course % 2)  # four bricks and a half, the half one in turns at the left and at the right
        while x < LENGTH - 1e-9:
            width = min(width, LENGTH - x)
            recipe["parts"].append({"shape": "box", "block": "bricks", "min": [x, course * COURSE], "size": [width, COURSE], "divisions": [fine * round(4 * width / BRICK), fine]})
            x, width = x + width, BRICK
    pushed = f"t < {SETTLE} ? 0 : {WAY / shear!r}*min((t - {SETTLE})/0.01, 1)"
    if held:  # the way down that gives the pressure was measured with the constant load
        motion = {"components": ["x", "y"], "velocity": [pushed, f"t < 0.02 ? -{held!r}/0.02 : 0", 0]}
    else:
        motion = {"components": ["x"], "velocity": [pushed, 0, 0]}
        deck["conditions"].append({"type": "traction", "side_set": "top", "value": [0, f"-{PRESSURE!r}*min(t/0.02, 1)", 0]})
    deck["conditions"].append({"type": "rigid_motion", "block": "upper", "angular_velocity": [0, 0, 0], **motion})
    deck["materials"]["brick"]["youngs_modulus"] *= stiffness
    deck["joints"]["bed"].update(crushed or {})
    deck["time"]["end"] = SETTLE + 0.005 + shear * until / WAY
    deck["output"]["times"] = [SETTLE, SETTLE + 0.005 + shear / 3]
    run, spent = case.timed(name, recipe, deck, load=PRESSURE * LENGTH)
    h = run.history
    moved = h["time"] > SETTLE
    smooth = numpy.ones(21) / 21  # waves of 2 ms
    curve = {"way": h["upper_displacement_x"] * 1e3, "shear": numpy.convolve(h["upper_reaction_x"], smooth, "same") * THICKNESS / 1e3,
             "vertical": numpy.convolve(h["lower_reaction_y"], smooth, "same") * THICKNESS / 1e3}  # fmt: skip
    sunk = -numpy.interp(SETTLE, h["time"], h["upper_displacement_y"])
    return {key: value[moved][:-11] for key, value in curve.items()}, sunk, run, spent


def at(curve, way):
    return float(numpy.interp(way, curve["way"], curve["shear"]))


free, sunk, _, free_seconds = wall("constant_load", None, until=WAY if case.full else 1.3e-3)
weight = PRESSURE * LENGTH * THICKNESS / 1e3
case.check("constant load: vertical load that the wall bears [kN]", numpy.mean(free["vertical"]), weight, 0.02, relative=True)
case.check_within("constant load: largest shear, between friction alone and friction and cohesion everywhere [kN]", free["shear"].max(), FRICTION * weight, FRICTION * weight + COHESION * LENGTH * THICKNESS / 1e3)
curve, _, run, spent = wall("held", sunk, until=WAY if case.full else 1.1e-3)
case.check("held: vertical load before it is sheared [kN]", curve["vertical"][0], weight, 0.03, relative=True)
for way, load in MEASURED if case.full else MEASURED[:4]:
    words = f"held: shear at {way:g} mm against J4D, read off a plot within 8 kN [kN]"
    case.check(words + ("" if way < 0.7 else " (reported: we differ)"), at(curve, way), load, 8, report=bool(way >= 0.7))
case.picture(run, "--color", "von_mises", "--times", "0.03", "0.075", "0.2", "--strip", "3", "--planes", "dots", "--dot-size", "3", "--no-edges", "--range", "0", "6e6", "--size", "330", "360")
if case.full:
    for way, load in MEASURED:
        case.other(f"shear at {way:g} mm [kN]", "Coplane, beam held at its height", at(curve, way), load, spent)
        case.other(f"shear at {way:g} mm [kN]", "Coplane, constant vertical load", at(free, way), load, free_seconds)
    # Joints that are crushed as in V93, with the numbers of these walls.
    capped, _, _, seconds = wall("crushed", sunk, crushed={"compressive_strength": 10.5e6, "compression_energy": 5e3, "peak_crushing": 9e-5})
    for way, load in MEASURED:
        case.other(f"shear at {way:g} mm [kN]", "Coplane, beam held, joints that crush at 10.5 MPa", at(capped, way), load, seconds)
    for label, options in (("4 x 1 in a brick", {}), ("8 x 2 in a brick", dict(fine=2)), ("4 x 1, sheared half as fast", dict(shear=2 * SHEAR)), ("4 x 1, bricks twice as stiff", dict(stiffness=2.0))):
        finer, _, _, seconds = wall("again", sunk, until=1.9e-3, **options)
        for way in (0.4, 0.7, 1.0, 1.8):
            case.study(f"held: shear at {way:g} mm [kN]", label, at(finer, way), dict(MEASURED.tolist())[way], seconds)
case.finish()
