"""An elastic bar falls on a rigid floor, bounces, and bounces again (Doyen, Ern and Piperno 2011): times, pressure, velocity, height."""

import numpy
from coplanetest import ValidationCase

case = ValidationCase(__file__)
# The published bar falls 5 m under 10 m/s^2, with strains of a third. The problem is linear: fall and gravity are a thousandth here.
LENGTH, MODULUS, DENSITY, GRAVITY, FALL = 10.0, 900.0, 1.0, 1e-2, 5e-3
SPEED_OF_SOUND = (MODULUS / DENSITY) ** 0.5
CROSSING = LENGTH / SPEED_OF_SOUND  # of a wave, 1/3 s
FALLING = (2 * FALL / GRAVITY) ** 0.5  # 1 s, three crossings: the motion repeats itself after 16
IMPACT = GRAVITY * FALLING
FIRST, LEAVES, SECOND, FREE = FALLING, FALLING + 2 * CROSSING, 3 * FALLING + 2 * CROSSING, 3 * FALLING + 4 * CROSSING


def foot_in_flight(times):
    """Height of the lower end after the first impact: the flight of the centre of mass, and the vibration that the first impact leaves; 1000 modes."""
    t = numpy.atleast_1d(times)[:, None] - LEAVES
    wave = numpy.arange(1, 1001) * numpy.pi / LENGTH
    vibration = -2 * GRAVITY * LENGTH**2 / (3 * SPEED_OF_SOUND**2) + (4 * GRAVITY / (SPEED_OF_SOUND * wave) ** 2 * numpy.cos(SPEED_OF_SOUND * wave * t)).sum(axis=1)
    return FALL - GRAVITY / 2 * (t[:, 0] - FALLING) ** 2 + vibration


def bounce(name, elements, across=1):
    recipe, deck = case.load("mesh.yaml"), case.load()
    recipe["parts"][1]["divisions"] = [across, elements]
    run, spent = case.timed(name, recipe, deck)
    h = run.history
    t, velocity, height = h["time"], h["bar_velocity_y"], FALL + h["foot_displacement_y"]
    touching = (h["stick"] + h["slip"]) > 0
    middle = (FIRST + LEAVES) / 2
    first, second = t[touching & (t < LEAVES + FALLING)], t[touching & (t > LEAVES + FALLING)]
    # Push on the bar from its momentum: a straight line in time, rho c (v + g t), so its mean is the one in the middle.
    rows = (t > FIRST + 0.1 * CROSSING) & (t < LEAVES - 0.1 * CROSSING)
    slope = numpy.polyfit(t[rows] - middle, velocity[rows], 2)
    flying = (t > LEAVES + 0.1 * CROSSING) & (t < SECOND - 0.1 * CROSSING)
    after = t > FREE + 0.1
    # Velocities of the bar count from the end of its own contact, so that they do not hold its delay once more.
    found = dict(begin=first[0], duration=first[-1] - first[0], pressure=DENSITY * LENGTH * (slope[1] + GRAVITY), growth=2 * DENSITY * LENGTH * slope[0],
                 velocity=numpy.mean(velocity[flying] + GRAVITY * (t[flying] - first[-1])), second=second[0], end=second[-1],
                 flight=numpy.sqrt(numpy.mean((height[flying] - foot_in_flight(t[flying])) ** 2)) / FALL, last=numpy.mean(velocity[after] + GRAVITY * (t[after] - second[-1])),
                 vibration=h["internal"][after].mean() / (DENSITY * LENGTH * GRAVITY * FALL))  # fmt: skip
    return found, run, spent


exact = dict(begin=FIRST, duration=2 * CROSSING, pressure=DENSITY * SPEED_OF_SOUND * (IMPACT + GRAVITY * CROSSING), growth=DENSITY * SPEED_OF_SOUND * GRAVITY,
             velocity=IMPACT, second=SECOND, end=FREE, flight=0.0, last=IMPACT, vibration=0.0)  # fmt: skip
words = dict(begin="first touch [s]", duration="first time in contact [s]", pressure="pressure on the floor in the middle of it [Pa]", growth="growth of the pressure [Pa/s]",
             velocity="upward velocity of the bar after the first impact [m/s]", second="second touch [s]", end="end of the second contact [s]",
             flight="lower end between the impacts: root mean square of the difference over the height of fall", last="upward velocity after the second impact [m/s]",
             vibration="strain energy after the second impact over the energy of the fall")  # fmt: skip
found, run, spent = bounce("bar", 100)
for key, tolerance in dict(begin=0.01, duration=0.03, pressure=0.01, growth=0.02, velocity=0.01, second=0.02, end=0.02, flight=0.03, last=0.02, vibration=0.01).items():
    case.check(words[key], found[key], exact[key], tolerance, relative=exact[key] != 0)
case.picture(run, "--color", "velocity", "--times", "0", "1.1666", "1.3333", "2.6666", "5.3", "--strip", "5", "--planes", "none", "--size", "160", "500")
if case.full:
    for elements in (100, 200, 400):
        found, run, spent = bounce(f"elements_{elements}", elements)
        for key in exact:
            case.study(words[key], f"{elements} along the bar", found[key], exact[key] if exact[key] else None, spent)
case.finish()
