"""Two elastic bars collide (Wolff and Bucher 2013): time in contact, stress, velocities and energy; the same by CalculiX."""

import sys

import numpy
from coplanetest import ValidationCase, calculix

case = ValidationCase(__file__)
SPEED, LENGTH = 1e-3, 10.0  # E = rho = 1, so c = 1 and the stress is the velocity. Published: 0.1, strains of a tenth


def pushed(times, velocity):
    """Mean contact stress from what the right bar gains between 3 and 17 s: a straight line through its mean velocity [Pa]."""
    rows = (times > 3) & (times < 17)
    return float(LENGTH * numpy.polyfit(times[rows], velocity[rows], 1)[0])


def ours(name, size, speed=SPEED):
    recipe, deck = case.load("mesh.yaml"), case.load()
    for part in recipe["parts"]:
        part["divisions"] = [round(LENGTH / size), 2, 2]
    for state, sign in zip(deck["initial"], (1, -1)):
        state["velocity"][0] = sign * speed
    run, spent = case.timed(name, recipe, deck)
    h = run.history
    touching = h["time"][numpy.flatnonzero(h["stick"] + h["slip"])[-1]]
    stress = pushed(h["time"], h["right_velocity_x"])
    lines = sum(1 for part in ("deck.yaml", "mesh.yaml") for line in (case.source / part).read_text().splitlines() if line and line[0] != "#")
    return dict(touching=touching, stress=stress, velocity=h["right_velocity_x"][-1], energy=h["kinetic"][-1] / h["kinetic"][0]), run, spent, lines


def theirs(name, size, step):
    """The same by CalculiX: alpha method, contact of surface to surface with a penalty of 50 E per unit of length."""
    deck = calculix.Input()
    n = round(LENGTH / size)
    points, first = deck.box("L", (-LENGTH, 0, 0), (0, 1, 1), (n, 2, 2))
    _, second = deck.box("R", (0, 0, 0), (LENGTH, 1, 1), (n, 2, 2))
    section, velocity = deck.bystander((0, 50, 0), 1.0, "ONE")
    deck.say(f"""
        *MATERIAL, NAME=ONE
        *ELASTIC
        1., 0.
        *DENSITY
        1.
        *SOLID SECTION, ELSET=EL, MATERIAL=ONE
        *SOLID SECTION, ELSET=ER, MATERIAL=ONE
        {section}
        *SURFACE INTERACTION, NAME=TOUCH
        *SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
        50.
        *CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE
        SLx1, SRx0
        *INITIAL CONDITIONS, TYPE=VELOCITY
        {velocity}
        NL, 1, {SPEED}
        NR, 1, {-SPEED}
        *STEP, NLGEOM, INC=1000000
        *DYNAMIC, DIRECT
        {step}, 30.
        *NODE PRINT, NSET=NR, FREQUENCY={max(1, round(0.25 / step))}
        U
        *NODE PRINT, NSET=NLx1, FREQUENCY={max(1, round(0.25 / step))}
        U
        *END STEP""")
    spent = deck.run(name)
    if spent is None:
        return None, None, len(deck.own)
    tables = calculix.printed(name)
    times = numpy.array([at for _, which, at, _ in tables if which == "NR"])
    # Mean displacement by the trapezoidal weights of the nodes: of a bar of equal elements.
    shape = points.reshape(3, 3, n + 1, 3)[..., 0]
    weights = numpy.ones_like(shape)
    weights[:, :, [0, -1]] /= 2
    weights[[0, -1]] /= 2
    weights[:, [0, -1]] /= 2
    weights = (weights / weights.sum()).ravel()
    mean = numpy.array([weights @ rows[:, 1] for _, which, _, rows in tables if which == "NR"])
    gap = numpy.array([rows[rows[:, 0] == second + 0, 1][0] for _, which, _, rows in tables if which == "NR"]) - numpy.array(
        [rows[0, 1] for _, which, _, rows in tables if which == "NLX1"])
    velocity = numpy.gradient(mean, times)
    touching = times[numpy.flatnonzero(gap < 1e-5 * SPEED)[-1]]
    return dict(touching=touching, stress=pushed(times, velocity), velocity=float(velocity[times > 25].mean())), spent, len(deck.own)


exact = dict(touching=2 * LENGTH, stress=SPEED, velocity=SPEED)
words = dict(touching="end of contact [s]", stress="stress while they touch [Pa]", velocity="velocity of the right bar afterwards [m/s]")
found, run, spent, lines = ours("bars", 0.2)
case.check("end of contact [s]", found["touching"], 20.0, 0.02, relative=True)
case.check("stress while they touch [Pa]", found["stress"], SPEED, 0.02, relative=True)
case.check("velocity of the right bar afterwards [m/s]", found["velocity"], SPEED, 0.02, relative=True)
strained, run, _, _ = ours("published_speed", 0.2, 0.1)
case.check("at the published 0.1 m/s: end of contact [s]", strained["touching"], 20.0, 0.03, relative=True)
case.check("at the published 0.1 m/s: stress [Pa]", strained["stress"], 0.1, 0.05, relative=True)
case.picture(run, "--color", "velocity", "--shares", "0", "0.17", "0.5", "1", "--strip", "1", "--planes", "none", "--camera", "front", "--size", "1000", "150")
for key in exact:
    case.other(words[key], "Coplane, 50 elements along a bar", found[key], exact[key], spent, lines)
if not calculix.found():
    print("CalculiX was not tried: ccx is not installed (apt-get install calculix-ccx)", file=sys.stderr)
elif case.full:
    for label, size, step in (("CalculiX 2.20, implicit, 50 elements, step 0.05", 0.2, 0.05), ("CalculiX 2.20, implicit, 50 elements, step 0.2", 0.2, 0.2)):
        got, spent, lines = theirs("calculix_" + label.split(", ", 1)[1].replace(", ", "_").replace(" ", "_"), size, step)
        for key in exact if got else ():
            case.other(words[key], label, got[key], exact[key], spent, lines)
        if not got:
            case.other("the run", label, "ended with an error", None, None, lines)
if case.full:
    for size in (1.0, 0.5, 0.2, 0.1):
        found, run, spent, lines = ours(f"size_{size}", size)
        for key in exact:
            case.study(words[key], f"{round(LENGTH / size)} along a bar", found[key], exact[key], spent)
        case.study("kinetic energy afterwards over that before", f"{round(LENGTH / size)} along a bar", found["energy"], 1.0, spent)
case.finish()
