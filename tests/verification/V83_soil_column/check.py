"""V83: a column of soil under a rigid base that a record shakes: the motion of the top and the shear force of the base against the exact
transfer functions of the shear beam, and against d'Alembert's solution."""

import pathlib

import numpy
from coplanetest import Case

from coplane import Deck, record
from coplane.documents import parse, text

case = Case("V83", __file__)
height, speed, density, width = 20.0, 200.0, 1800.0, 0.5  # [m], [m/s], [kg/m^3], [m]
transit = height / speed


def write_at2(path, step=0.005, count=1600):
    """A made-up station: waves of 0.8 to 6 Hz under an envelope, in units of g, with the drift of an instrument."""
    t = numpy.arange(count) * step
    waves = sum(amplitude * numpy.sin(2 * numpy.pi * f * t + phase)
                for f, amplitude, phase in ((0.8, 1, 0), (1.3, 1.5, 1), (2.1, 2, 2.4), (2.6, 1.5, 4), (3.7, 1, 0.3), (5.9, 0.6, 5)))  # fmt: skip
    values = 0.04 * waves * numpy.sin(numpy.pi * t / t[-1]) ** 2 + 2e-3 * (1 + t)
    lines = "\n".join("".join(f"{value:15.7E}" for value in values[start : start + 5]) for start in range(0, count, 5))
    path.write_text("PEER NGA STRONG MOTION DATABASE RECORD\nmade up, station 0, 090\nACCELERATION TIME SERIES IN UNITS OF G\n"
                    f"NPTS= {count:6}, DT= {step:7.4f} SEC\n{lines}\n")  # fmt: skip


station = pathlib.Path("station.AT2")
write_at2(station)
ground = record.read(station).scaled(peak=2.0).corrected()
print(ground)
times, base = numpy.array(ground.velocity_table()["times"]), numpy.array(ground.velocity_table()["values"])
case.check("record: velocity at its end [m/s]", ground.velocity[-1], 0, 1e-12)
case.check("record: displacement at its end [m]", ground.displacement[-1], 0, 1e-12)

# --- exact answers, at even times ----------------------------------------------------------------------

step = 1e-3
fine = numpy.arange(0, 65.536, step)
ground_motion = numpy.interp(fine, times, base)


def dalembert():
    """Velocity of the top and force on the base, without damping: at the base up(t) + up(t - 2 H/c) = v(t), as the free top sends waves back
    unchanged; the top moves with 2 up(t - H/c), and the stress at the base is rho c (up(t - 2 H/c) - up(t))."""
    delay = round(2 * transit / step)
    up = ground_motion.copy()
    for i in range(delay, len(up)):
        up[i] -= up[i - delay]
    down = numpy.concatenate([numpy.zeros(delay), up[:-delay]])
    top = numpy.concatenate([numpy.zeros(delay // 2), 2 * up[: -(delay // 2)]])
    return top, density * speed * width * (up - down)


def transfer(alpha):
    """The same with a drag of alpha times mass and velocity: top over base is 1/cos(k H), force over velocity of the base i w rho/... tan(k H),
    k^2 = (w^2 - i w alpha)/c^2. The record is followed by rest until all has died away."""
    w = 2 * numpy.pi * numpy.fft.rfftfreq(len(fine), step)
    k = numpy.sqrt(w**2 - 1j * w * alpha) / speed
    spectrum = numpy.fft.rfft(ground_motion)
    shear_modulus = density * speed**2
    # u = U cos(k (H - y)) exp(i w t): u'(0) = k U sin(k H); the base carries -G u'(0) of the column, from velocity i w u.
    with numpy.errstate(divide="ignore", invalid="ignore"):
        force = numpy.where(w > 0, -shear_modulus * k * numpy.tan(k * height) / (1j * w), 0)
    return numpy.fft.irfft(spectrum / numpy.cos(k * height), len(fine)), width * numpy.fft.irfft(spectrum * force, len(fine))


def shaken(alpha):
    deck = Deck.from_text(text(case.load()))
    if alpha:
        deck["damping.mass"] = alpha
    ground.shake(deck, "base", axis="x")
    return parse(deck.text)


def largest_difference(name, what, run, column, exact, tolerance):
    history = run.history
    reference = numpy.interp(history["time"], fine, exact)
    difference = numpy.max(numpy.abs(history[column] - reference)) / numpy.max(numpy.abs(reference))
    case.check(f"{name}: {what}, largest difference over the largest value", difference, 0, tolerance)


for name, alpha, within, (top, force) in (("undamped", 0, 0.015, dalembert()), ("damped", 2.0, 2e-3, transfer(2.0))):
    run = case.run(name, case.load("mesh.yaml"), shaken(alpha))
    if alpha:
        case.restarts(name, case.load("mesh.yaml"), shaken(alpha), run, 0.5 * run.history["time"][-1])  # within the record
    case.check_within(f"{name}: the top moves more than the ground, by", numpy.max(numpy.abs(top)) / numpy.max(numpy.abs(base)), 2, 20)
    largest_difference(name, "velocity of the base", run, "base_velocity_x", ground_motion, 1e-3)
    largest_difference(name, "velocity of the top", run, "top_velocity_x", top, within)
    largest_difference(name, "force of the base", run, "base_reaction_x", force, within)
case.finish()
