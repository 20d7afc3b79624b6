"""A disc is split along the loaded diameter (Brazilian test): the load at which a brittle bond opens, from end to end."""

import numpy
from coplanetest import ValidationCase

case = ValidationCase(__file__)
RADIUS, STRENGTH = 0.025, 3e6
SPLITS = numpy.pi * RADIUS * STRENGTH  # P = pi D t f_t / 2, t = 1 m [N/m]


def split(name, across=40, stiffness=5e13, end=8e-4, half=4.6, turn=0.0, bonded=False, most=1.5):
    """Load over P = pi D t f_t / 2 when the first plane opens and when half of the diameter is open, or half as much anywhere; half the arc that is pressed [rad]; run and seconds.

    `bonded`: all elements are, by bonds that soften, and none by the diameter alone. `most`: load at the end, about, over P.
    """
    recipe, deck, joints = case.load("mesh.yaml"), case.load(), case.load("joints.yaml")
    recipe["parts"][0].update(across=across, rotate=turn, about=[0, 0])
    for side, middle in (("upper", 90), ("lower", 270)):
        recipe["side_sets"][side]["where_own"]["angle"] = [middle - half, middle + half]
    joints["joints"]["diameter"]["planes"]["normal"] = [numpy.cos(numpy.radians(turn)).item(), numpy.sin(numpy.radians(turn)).item()]
    if bonded:
        joints = {"joints": {"bonds": {"every_face": "disc"}}}
        deck["joints"]["brittle"].update(model="mortar", shear_ratio=1, tension_energy=3, shear_energy=30, cohesion=12e6)
    top = most * numpy.pi * STRENGTH / 2 / numpy.radians(0.75 * half).item()  # enough to split it
    for condition in deck["conditions"]:
        condition["value"] = f"{top / end!r}*t"
    deck["time"]["end"] = end
    deck["output"]["every"] = end / 40
    deck["joints"]["brittle"]["normal_stiffness"] = stiffness
    run, spent = case.timed(name, recipe, deck, joints=joints)
    # The arc that is pressed: the outermost nodes of the faces of the side set.
    x = run.results.coordinates
    on = abs(numpy.hypot(x[:, 0], x[:, 1]) - RADIUS) < 1e-6
    angles = abs((numpy.arctan2(x[on, 1], x[on, 0]) - numpy.radians(90 + turn) + numpy.pi) % (2 * numpy.pi) - numpy.pi)
    arc = angles[angles < numpy.radians(half)].max()
    h = run.history
    load = 2 * top * h["time"] / end * RADIUS * numpy.sin(arc) / SPLITS
    opened = h["brittle_open_area"] / (2 * RADIUS)
    return dict(first=load[numpy.argmax(opened > 0)], half=load[numpy.argmax(opened > 0.5)]), arc, run, spent


def arc_factor(arc):
    """Load over pi D t f_t / 2 that brings the tension f_t to the centre when a pressure acts on two arcs of this half angle, radially.

    A pair of forces dP on a diameter gives the centre 2 dP/(pi D) across it and -6 dP/(pi D) along it (Hertz). Turned by phi this is 2 dP/(pi D) (1 - 4 sin^2 phi) across the middle of the arcs; the integral over the arcs is 2 p/pi (sin 2 arc - arc), and the load p D sin arc.
    """
    return numpy.sin(arc) / (numpy.sin(2 * arc) - arc)


found, arc, run, spent = split("disc")
case.check("load that opens the first plane over pi D t f_t / 2", found["first"], arc_factor(arc), 0.05, relative=True)
case.check("load that opens half of the diameter over pi D t f_t / 2", found["half"], arc_factor(arc), 0.05, relative=True)
turned, _, _, _ = split("turned", turn=33.0)
case.check("the same, disc and loads turned by 33 degrees: half of the diameter", turned["half"], found["half"], 0.01, relative=True)
# Elements bonded at all of their faces: nothing says where the crack has to run. The load grows as fast as above.
LOOSE = dict(across=20, half=9.3, stiffness=2.4e13, bonded=True, end=5.9e-4, most=1.18)
bonded, arc, _, _ = split("bonded", **LOOSE)
case.check("all elements bonded: load that opens half of a diameter over pi D t f_t / 2", bonded["half"], arc_factor(arc), 0.05, relative=True)
case.picture(run, "--color", "velocity", "--planes", "none", "--strip", "3", "--times", "0", "5.5e-4", "8e-4", "--size", "330", "300")
if case.full:
    for label, options in (("20 across", {}), ("20 across, turned by 33 degrees", {"turn": 33.0}), ("40 across", {"across": 40, "half": 4.6, "stiffness": 5e13})):
        bonded, arc, _, spent = split("bonded_again", **{**LOOSE, **options})
        case.study("all elements bonded: load that opens half of a diameter over pi D t f_t / 2", label, bonded["half"], arc_factor(arc), spent)
    for label, options in (("20 across", dict(across=20, half=9.3)), ("40 across", {}), ("80 across", {"across": 80}), ("40 across, loaded twice as fast", dict(end=4e-4)),
                           ("40 across, loaded half as fast", dict(end=1.6e-3)), ("40 across, bond of 10 TPa/m", dict(stiffness=1e13)), ("40 across, bond of 200 TPa/m", dict(stiffness=2e14))):  # fmt: skip
        found, arc, _, spent = split("again", **options)
        for key, words in (("first", "load that opens the first plane over pi D t f_t / 2"), ("half", "load that opens half of the diameter over pi D t f_t / 2")):
            case.study(words, label, found[key], arc_factor(arc), spent)
case.finish()
