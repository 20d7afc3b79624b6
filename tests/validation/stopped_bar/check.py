"""An elastic bar that is held at one end strikes a rigid stop in front of the other, again and again: periodic motion, exact by characteristics."""

import math

import numpy
from coplanetest import ValidationCase

case = ValidationCase(__file__)
LENGTH, MODULUS, DENSITY, SPEED, GAP = 10.0, 900.0, 1.0, 1e-2, 1.5e-3
WAVE = math.sqrt(MODULUS / DENSITY)
CROSSING, STRIKES = LENGTH / WAVE, GAP / SPEED  # of a wave, 1/3 s; the bar comes to the stop before the wave does, at 0.15 s
PERIOD = 3 * CROSSING + STRIKES  # without the stop: 4 crossings
PRESSURE = DENSITY * WAVE * SPEED


def end_of_the_bar(times):
    """Displacement of the right end [m].

    At the start all of the bar moves to the right. A wave of tension leaves the held end; the right end meets the stop and sends back a wave of pressure of the same strength. Where both have passed there is no stress and the
    velocity is reversed, so that the stop lets the bar go, without any wave, when the first one arrives. The end then moves back until the wave of pressure, which the held end throws back as such, comes to it.
    """
    t = numpy.mod(times, PERIOD)
    return SPEED * numpy.interp(t, [0, STRIKES, CROSSING, 2 * CROSSING + STRIKES, PERIOD], [0, STRIKES, STRIKES, -CROSSING, 0])


def strike(name, elements, across=1):
    recipe, deck = case.load("mesh.yaml"), case.load()
    recipe["parts"][0]["divisions"] = [elements, across]
    run, spent = case.timed(name, recipe, deck)
    h = run.history
    t, push = h["time"], h["stop_reaction_x"]
    touching = (h["stick"] + h["slip"]) > 0
    spells = [t[touching & (t > n * PERIOD - 0.2) & (t < n * PERIOD + 0.6)] for n in range(3)]
    middle = (t > STRIKES + 0.3 * (CROSSING - STRIKES)) & (t < CROSSING - 0.3 * (CROSSING - STRIKES))
    off = h["end_displacement_x"] - end_of_the_bar(t)
    whole = t < 3 * PERIOD
    energy = DENSITY * LENGTH * SPEED**2 / 2
    # After each period all of the bar moves as at the start, later by the delays of the contacts; what does not is the vibration that the fronts have left.
    last = numpy.abs(t - 3 * PERIOD) < 0.1 * CROSSING
    once = t < PERIOD / 2
    return dict(begin=spells[0][0], duration=spells[0][-1] - spells[0][0], pressure=abs(numpy.mean(push[middle])), impulse=abs(numpy.trapz(push[once], t[once])),
                second=spells[1][0], third=spells[2][0], path=numpy.sqrt(numpy.mean(off[whole] ** 2)) / GAP, first_path=numpy.sqrt(numpy.mean(off[t < PERIOD] ** 2)) / GAP,
                speed=h["bar_velocity_x"][last].max() / SPEED, strain=h["internal"][last].min() / energy), run, spent  # fmt: skip


exact = dict(begin=STRIKES, duration=CROSSING - STRIKES, pressure=PRESSURE, impulse=PRESSURE * (CROSSING - STRIKES), second=PERIOD + STRIKES, third=2 * PERIOD + STRIKES, path=0.0, first_path=0.0, speed=1.0, strain=0.0)
words = dict(begin="first touch [s]", duration="time in contact [s]", pressure="push on the stop in the middle of it [N]", impulse="impulse of the first contact [N s]", second="second touch [s]", third="third touch [s]",
             path="end of the bar, three periods: root mean square of the difference over the gap", first_path="end of the bar, first period: root mean square of the difference over the gap",
             speed="mean velocity after three periods, over that at the start", strain="strain energy after three periods, over the energy")  # fmt: skip
found, run, spent = strike("bar", 100)
for key, tolerance in dict(begin=0.01, duration=0.05, pressure=0.01, impulse=0.04, second=0.01, third=0.01, path=0.1, first_path=0.05, speed=0.05, strain=0.05).items():
    case.check(words[key], found[key], exact[key], tolerance, relative=exact[key] != 0)
case.picture(run, "--color", "velocity", "--times", "0", "0.15", "0.24", "0.3333", "0.65", "1.15", "--strip", "1", "--planes", "none", "--size", "1000", "130")
if case.full:
    errors = {}
    for elements in (100, 200, 400):
        found, run, spent = strike(f"elements_{elements}", elements)
        for key in exact:
            case.study(words[key], f"{elements} along the bar", found[key], exact[key] if exact[key] else None, spent)
            errors.setdefault(key, []).append(abs(found[key] - exact[key]))
    for key in ("duration", "impulse", "third", "path", "first_path", "strain"):
        slope = -numpy.polyfit(numpy.log([100, 200, 400]), numpy.log(errors[key]), 1)[0]
        case.study(f"order of convergence: {words[key].split(' [')[0]}", "100 to 400 along the bar", slope)
case.finish()
