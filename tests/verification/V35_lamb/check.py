"""V35: Lamb's problem, the surface of a half-space under a vertical force that comes up suddenly."""

import math

import numpy
from coplanetest import Case

case = Case("V35", __file__)
recipe, deck = case.load("mesh.yaml"), case.load()
rock = deck["materials"]["granite"]
shear = rock["youngs_modulus"] / 2 / (1 + rock["poisson_ratio"])
speed = float(numpy.sqrt(shear / rock["density"]))
FORCE, LOADED, RISE = 1e6, 0.4, 0.3  # [N]; radius of the loaded disc [m]; rise of the force, in units of r / c_s at the receiver

# Pekeris 1955, Poisson's ratio 1/4: w mu r / F of a step, over T = c_s t / r, positive along the force. The Rayleigh wave comes at
# T = sqrt(gamma).
GAMMA = 0.75 + numpy.sqrt(3) / 4


def of_step(t):
    near = numpy.sqrt(3 * numpy.sqrt(3) + 5) / numpy.sqrt(numpy.abs(GAMMA - t**2))
    first = 6 - numpy.sqrt(3 / numpy.abs(t**2 - 1 / 4)) - near
    first += numpy.sqrt(3 * numpy.sqrt(3) - 5) / numpy.sqrt(numpy.abs(t**2 + numpy.sqrt(3) / 4 - 3 / 4))
    return numpy.select(
        [t < 1 / numpy.sqrt(3), t < 1, t < numpy.sqrt(GAMMA)],
        [0 * t, first / (32 * numpy.pi), (6 - near) / (16 * numpy.pi)],
        3 / (8 * numpy.pi),
    )


def exact(times, rise):
    """Of a force that comes up as sin^2: the step's answer, convolved with the rate of the force."""
    n = 200_000
    tau = (numpy.arange(n) + 0.5) / n * rise
    rate = numpy.pi / (2 * rise) * numpy.sin(numpy.pi * tau / rise)
    return numpy.array([numpy.mean(rate * of_step(t - tau)) * rise for t in times])


# The formula itself: values of the table, continuous at T = 1, and the static displacement.
for t, value in ((0.7, -0.0030487), (0.9, -0.0090722), (1.05, -0.1045142), (1.2, 0.1193662)):
    case.check(f"formula at T = {t}", of_step(numpy.array([t]))[0], value, 1e-7)

receiver = recipe["node_sets"]["receiver"]["where"]["x"]
rise_time = RISE * receiver / speed
deck["conditions"][0]["value"] = f"{FORCE / (math.pi * LOADED**2)!r}*(t<{rise_time!r} ? sin({math.pi / 2 / rise_time!r}*t)^2 : 1)"
deck["time"] = {"end": 1.45 * receiver / speed, "step_factor": 0.6}
run = case.run("force", recipe, deck, energy=5e-3)
case.same_bits("force", recipe, deck, run)
h = run.history
t = h["time"] * speed / receiver
found = -h["receiver_displacement_y"] * shear * receiver / FORCE
chosen = (t > 0.4) & (t < 1.4)
expected = exact(t[chosen], RISE)
error = found[chosen] - expected
largest = numpy.abs(expected).max()
case.check("largest error over the largest displacement", numpy.abs(error).max() / largest, 0, 0.1)
case.check("root of the mean square error over the largest displacement", numpy.sqrt(numpy.mean(error**2)) / largest, 0, 0.05)
case.check("static displacement at the end", found[chosen][-1], 3 / (8 * numpy.pi), 0.05, relative=True)
down, when = found[chosen].min(), t[chosen][numpy.argmin(found[chosen])]
case.check("deepest uplift before the Rayleigh wave", down, expected.min(), 0.1, relative=True)
case.check("when it comes, in r / c_s", when, t[chosen][numpy.argmin(expected)], 0.02, relative=True)
case.finish()
