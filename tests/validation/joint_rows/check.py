"""Half sines across 1, 2, 4, 8 and 16 equal joints: linear ones against transfer matrices, hyperbolic ones against the method of characteristics."""

import math
import pathlib
import sys

import numpy
from coplanetest import ValidationCase, waves

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import characteristics  # noqa: E402

case = ValidationCase(__file__)
density, modulus, poisson = 2650.0, 60e9, 0.25
impedance = math.sqrt(density * modulus * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson)))
speed = impedance / density
tone = 100.0  # [Hz]
length = speed / tone
stiffness = impedance * 2 * math.pi * tone  # k / (z omega) = 1
NUMBERS = (1, 2, 4, 8, 16)


def run(name, number, spacing, amplitude, per_wave=80, joint=None, pressed=True):
    """Peak behind `number` joints, spacing over the wave length, velocity of the half sine [m/s]; run and seconds."""
    size = length / per_wave
    before, pitch, last = round(1.2 * per_wave), round(spacing * per_wave), round(0.8 * per_wave)
    lengths = [before] + [pitch] * (number - 1) + [last]
    ends = numpy.concatenate([[0], numpy.cumsum(lengths)])
    parts = [{"shape": "box", "block": "rock", "min": [float(x * size), 0], "size": [n * size, size], "divisions": [int(n), 1]} for x, n in zip(ends, lengths)]
    probe = float((ends[-2] + 2) * size)
    recipe = {"dimension": 2, "parts": parts,
              "node_sets": {"all": {}, "start": {"where": {"x": 0}}, "end": {"where": {"x": float(ends[-1] * size)}}, "behind": {"where": {"x": probe}}}}
    deck = case.load()
    deck["joints"]["tight"] = joint or {"model": "linear", "normal_stiffness": stiffness, "shear_stiffness": 1e10, "friction": 0.6}
    if not pressed:
        del deck["initial"]
    deck["conditions"].append({"type": "velocity", "node_set": "start", "components": ["x"], "value": [waves.half_sine(amplitude, tone), 0, 0]})
    deck["time"] = {"end": float(probe / speed + 1.5 / tone), "fixed_step": 0.5 * size / speed}
    deck["history"] = {"probes": [{"name": "behind", "node_set": "behind"}]}
    deck["output"] = {"planes": False, "every": deck["time"]["end"] / 4}
    ended, spent = case.timed(name, recipe, deck, energy=2e-3)
    return waves.peak(ended.history["behind_velocity_x"]) / amplitude, ended, spent


fine = numpy.arange(1 << 15) / (1 << 11)  # 16 periods
half = numpy.where(fine < 0.5, numpy.sin(2 * math.pi * fine), 0)


def exact(number, spacing):
    """Peak behind linear joints of k / (z omega) = 1: transfer matrices, in units z = c = f = 1."""
    return float(numpy.max(waves.passed(fine, half, lambda f: waves.joints(f, number, 2 * math.pi, 1, 1, spacing))[: 4 << 11]))


# --- linear joints ----------------------------------------------------------------------------------
peaks = {}
for spacing in (0.05, 0.2) if case.full else (0.05,):
    for number in NUMBERS:
        found, _, spent = run(f"linear_{number}_{spacing}", number, spacing, 0.05)
        peaks[number, spacing] = found
        case.check(f"linear, {number} joints {spacing} wave lengths apart: |T|", found, exact(number, spacing), 0.01, relative=True)
# More joints may pass more, where they are close: what they throw to and fro arrives together.
case.check_within("linear: |T| of four joints over that of two, 0.05 wave lengths apart", peaks[4, 0.05] / peaks[2, 0.05], 1.0, 1.02)

# --- joints that close along a hyperbola --------------------------------------------------------------
most = 1e-3  # [m]
closing = {"model": "closure_curve", "initial_stiffness": stiffness, "maximum_closure": most, "shear_stiffness": 1e10, "friction": 0.6, "stiffness_cap": 1e14}
step = 0.02 / tone / 200


def published(number, amplitude, spacing, elastic):
    times = step * numpy.arange(round((2.0 + number * spacing) / tone / step))
    wave = amplitude * numpy.where(times < 0.5 / tone, numpy.sin(2 * math.pi * tone * times), 0)
    delay = round(spacing / tone / step)
    return float(numpy.max(characteristics.behind(wave, step, number, delay, impedance, lambda: characteristics.closing(stiffness, most, elastic))) / amplitude)


# The method itself against transfer matrices: a closure without limit is linear (joints that stay closed: one of them).
times = step * numpy.arange(round(2.0 / tone / step))
wave = numpy.where(times < 0.5 / tone, numpy.sin(2 * math.pi * tone * times), 0)
one = numpy.max(characteristics.behind(wave, step, 1, 1, impedance, lambda: characteristics.closing(stiffness, 1e9, True)))
case.check("characteristics against transfer matrices, one linear joint", one, exact(1, 0.1), 1e-3, relative=True)
for number, amplitude in ((1, 0.1), (1, 0.5), (1, 2.0), (2, 0.5), (4, 0.5)) if not case.full else [(n, v) for n in (1, 2, 4) for v in (0.1, 0.5, 2.0)]:
    found, ended, spent = run(f"hyperbola_{number}_{amplitude}", number, 0.05, amplitude, joint=closing, pressed=False)
    tangent, elastic = (published(number, amplitude, 0.05, kind) for kind in (False, True))
    name = f"hyperbola, {number} joints, {amplitude} m/s: |T|"
    case.check(name, found, tangent, 0.015, relative=True)
    case.other(name, "same curve for loading and unloading (Zhao and Cai)", elastic, tangent)
case.picture(ended, "--color", "velocity", "--shares", "0.6", "--planes", "none", "--size", "1200", "160")

if case.full:
    for per_wave in (20, 40, 80, 160):
        found, _, spent = run(f"linear_size_{per_wave}", 8, 0.05, 0.05, per_wave)
        case.study("linear, 8 joints 0.05 wave lengths apart: |T|", f"{per_wave} in a wave", found, exact(8, 0.05), spent)
        found, _, spent = run(f"hyperbola_size_{per_wave}", 4, 0.05, 0.5, per_wave, joint=closing, pressed=False)
        case.study("hyperbola, 4 joints, 0.5 m/s: |T|", f"{per_wave} in a wave", found, published(4, 0.5, 0.05, False), spent)
case.finish()
