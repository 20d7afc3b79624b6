"""Maxwell elements beside the law of a block: decay of free oscillations, resonance of a column of soil, the energy that they take, the step."""

import json
import pathlib
import re

import numpy
from coplanetest import Case, program

case = Case("maxwell_damping", __file__)
density, poisson, low, high, ratio = 1800.0, 0.3, 0.5, 20.0, 0.02


# --- the elements, by the rule of the manual: relaxation frequencies in even steps of their logarithm, shares by least squares --------------------


def elements_of(ratio, low, high, count=3):
    """(shares, relaxation times [s], least and largest ratio in the band)."""
    omega = 2 * numpy.pi * numpy.geomspace(low, high, 81)
    best = None
    for trial in range(1, 201):
        places = numpy.arange(count) / (count - 1) - 0.5
        times = 1 / (2 * numpy.pi * numpy.sqrt(low * high) * (high / low) ** (places * 1.5 * trial / 200))
        x = omega[:, None] * times
        shares = numpy.linalg.lstsq((x - 2 * ratio * x**2) / (1 + x**2), numpy.full(len(omega), 2 * ratio), rcond=None)[0]
        ratios = (shares * x / (1 + x**2)).sum(1) / (1 + (shares * x**2 / (1 + x**2)).sum(1)) / 2
        off = max(abs(ratios - ratio))
        if shares.min() > 0 and (best is None or off < best[0]):
            best = off, shares, times, ratios.min(), ratios.max()
    return best[1:]


shares, times, least, largest = elements_of(ratio, low, high)


def factor(s):
    """Modulus over that at rest, for exp(s t)."""
    return 1 + sum(w * s * t / (1 + s * t) for w, t in zip(shares, times, strict=True))


# --- free oscillations of an element --------------------------------------------------------------------------------------------------------------------------

square = {"dimension": 2, "parts": [{"shape": "box", "block": "soil", "size": [1, 1], "divisions": [1, 1]}],
          "node_sets": {"all": {}, "base": {"where": {"y": 0}}, "top": {"where": {"y": 1}}}}  # fmt: skip
bulk_over_shear = 2 * (1 + poisson) / (3 * (1 - 2 * poisson))


def damping(**more):
    return {"ratio": ratio, "low": low, "high": high, **more}


def oscillator(frequency, axis, volumetric=False, cycles=12):
    """The top moves along x (shear) or y; half of the mass, and the modulus G or K + 4 G/3 that gives this frequency at rest."""
    modulus = 0.5 * density * (2 * numpy.pi * frequency) ** 2
    shear = modulus if axis == "x" else modulus / (bulk_over_shear + 4 / 3)
    other = {"type": "fixed", "node_set": "all", "components": ["y" if axis == "x" else "x"]}
    return {
        "materials": {"soil": {"model": "linear_elastic", "density": density, "poisson_ratio": poisson, "youngs_modulus": shear * 2 * (1 + poisson)}},
        "blocks": {"soil": {"material": "soil", "damping": damping(volumetric=volumetric)}},
        "contact": {"enabled": False}, "viscosity": {"linear": 0, "quadratic": 0},
        "conditions": [{"type": "fixed", "node_set": "base"}, other],
        "initial": [{"block": "soil", "velocity_field": ["1e-4*y" if axis == "x" else 0, "1e-4*y" if axis == "y" else 0, 0]}],
        "time": {"end": cycles / frequency, "maximum_step": 2e-3 / frequency},
        "history": {"every": 2e-3 / frequency, "probes": [{"name": "top", "node_set": "top"}]},
    }  # fmt: skip


def decay_of(run, axis):
    """Decay over circular frequency, from the peaks of the velocity of the top after the first cycles, in which the elements come to swing."""
    t, v = run.history["time"], numpy.abs(run.history[f"top_velocity_{axis}"])
    tops = [i for i in range(1, len(v) - 1) if v[i - 1] < v[i] >= v[i + 1]]
    times, heights = [], []
    for i in tops:
        a, b, c = numpy.polyfit(t[i - 1 : i + 2] - t[i], v[i - 1 : i + 2], 2)
        times.append(t[i] - b / (2 * a))
        heights.append(c - b * b / (4 * a))
    times, heights = numpy.array(times[6:]), numpy.array(heights[6:])
    return -numpy.polyfit(times, numpy.log(heights), 1)[0] / (numpy.pi / numpy.mean(numpy.diff(times)))


def exact_decay(frequency, share):
    """From the root of s^2 + w^2 (1 - share + share factor(s)) = 0, share: the part of the modulus that is damped."""
    omega = 2 * numpy.pi * frequency
    s = 1j * omega * (1 + 0.05j)
    for _ in range(100):
        s = 1j * omega * numpy.sqrt(1 - share + share * factor(s))
    return -s.real / s.imag


for frequency in (0.7, 3.0, 12.0):
    run = case.run(f"shear_{frequency}", square, oscillator(frequency, "x"), energy=1e-4)
    found = decay_of(run, "x")
    case.check(f"shear, {frequency} Hz: decay against the ratio asked for", found, ratio, 0.05, relative=True)
    case.check(f"shear, {frequency} Hz: decay against the root of the characteristic equation", found, exact_decay(frequency, 1), 0.005, relative=True)
    if frequency == 0.7:
        log = run.output
        told = re.search(r"give ([\d.e+-]+) to ([\d.e+-]+) of critical", log)
        case.check_equal("the log tells the ratios", told is not None, True)
        for name, text, reference in (("least", told.group(1), least), ("largest", told.group(2), largest)):
            case.check(f"{name} ratio in the band, as told", float(text), reference, 1e-3, relative=True)
        case.check("largest ratio in the band over that asked for", largest / ratio, 1, 0.03)
for volumetric in (False, True):
    name = "with dilatation" if volumetric else "deviator alone"
    run = case.run(f"axial_{'all' if volumetric else 'deviator'}", square, oscillator(3.0, "y", volumetric), energy=1e-4)
    share = 1 if volumetric else 4 / 3 / (bulk_over_shear + 4 / 3)
    case.check(f"axial, {name}: decay against the root", decay_of(run, "y"), exact_decay(3.0, share), 0.005, relative=True)

# --- energy: all that there was goes into the dashpots -----------------------------------------------------------------------------------------------------------

long = oscillator(3.0, "x", cycles=60)
run = case.run("long", square, long, energy=1e-4)
h = run.history
case.check("after 60 cycles: lost in the elements over the energy at the start", h["plastic"][-1] / h["kinetic"][0], 1, 1e-3)
case.same_bits("long", square, long, run, ranks=2, threads=2)
stopped = case.attempt("stopped", square, {**long, "time": {**long["time"], "end": 7.0}, "checkpoint": {"at_end": True}})
code, output = program.run_program(["run.yaml", "--restart", "--set", f"time.end={long['time']['end']!r}"], str(stopped.folder))
case.check_equal("restarted: exit code", code, 0)
record = json.loads(pathlib.Path(stopped.path("run.run-s0002.json")).read_text())
case.check_equal("restarted: state hash", record["state_hash"], run.state_hash)

# --- a column of soil on a rigid base, at its resonance and beside it ------------------------------------------------------------------------------------------------

height, speed, count = 20.0, 200.0, 40
column = {"dimension": 2, "parts": [{"shape": "box", "block": "soil", "size": [0.5, height], "divisions": [1, count]}],
          "node_sets": {"all": {}, "base": {"where": {"y": 0}}, "top": {"where": {"y": height}}}}  # fmt: skip
shear = density * speed**2


def shaken(frequency, end, **block):
    return {
        "materials": {"soil": {"model": "linear_elastic", "density": density, "poisson_ratio": poisson, "youngs_modulus": shear * 2 * (1 + poisson)}},
        "blocks": {"soil": {"material": "soil", **block}},
        "contact": {"enabled": False}, "viscosity": {"linear": 0, "quadratic": 0},
        "conditions": [{"type": "symmetry", "node_set": "all", "normal": [0, 1, 0]},
                       {"type": "velocity", "node_set": "base", "components": ["x"], "value": [f"1e-3*sin(2*_pi*{frequency!r}*t)*min(1, t/{4 / frequency!r})", 0, 0]}],
        "time": {"end": end},
        "history": {"every": 0.1 / frequency / 4, "probes": [{"name": "top", "node_set": "top"}]},
    }  # fmt: skip


def amplitude_of(run, frequency):
    t, v = run.history["time"], run.history["top_velocity_x"]
    late = t > t[-1] - 4 / frequency
    w = 2 * numpy.pi * frequency
    waves = numpy.stack([numpy.cos(w * t[late]), numpy.sin(w * t[late]), numpy.ones(late.sum())], axis=1)
    return float(numpy.hypot(*numpy.linalg.lstsq(waves, v[late], rcond=None)[0][:2])) / 1e-3


first = speed / (4 * height)
resonance = first * float(numpy.sqrt(factor(2j * numpy.pi * first).real))
for name, frequency in (("below", 0.8 * first), ("at", resonance), ("second", 3 * first)):
    run = case.run(f"column_{name}", column, shaken(frequency, 34.0, damping=damping()), energy=1e-3)
    omega = 2 * numpy.pi * frequency
    exact = 1 / abs(numpy.cos(omega * height / (speed * numpy.sqrt(factor(1j * omega)))))
    case.check(f"column, {frequency:.4g} Hz: top over base", amplitude_of(run, frequency), exact, 0.01, relative=True)

# --- the step ----------------------------------------------------------------------------------------------------------------------------------------------------------------

plain = case.run("plain", column, shaken(first, 1.0), energy=1e-3)
damped = case.run("damped", column, shaken(first, 1.0, damping=damping()), energy=1e-3)
shorter = float(plain.history["cycle"][-1] / damped.history["cycle"][-1])
case.check_within("step with elements over that without", shorter, 0.999 / (1 + float(shares.sum())) ** 0.5, 1)
case.finish()
