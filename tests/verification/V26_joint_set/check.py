"""V26: waves cross sets of equal joints: amplitudes, speed, peaks of pulses; one search is enough."""

import math
import sys

import numpy
from coplanetest import Case, differences, waves

case = Case("V26", __file__)
full = "all" in sys.argv[1:]
density, modulus, poisson = 2650.0, 60e9, 0.25
impedance = math.sqrt(density * modulus * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson)))
speed = impedance / density
amplitude = 0.05  # [m/s]


def strip(before, number, spacing, behind, size):
    """Rock from x = 0, `number` joints `spacing` apart, the first at x = before. Lengths become whole numbers of
    elements of this size. Returns recipe and the places of the joints.
    """
    def part(x, elements):
        return {"shape": "box", "block": "rock", "min": [x * size, 0], "size": [elements * size, size], "divisions": [elements, 1]}

    first, pitch, last = (round(length / size) for length in (before, spacing, behind))
    places = [first + i * pitch for i in range(number)]
    parts = [part(0, first)]
    parts += [part(x, pitch) for x in places[:-1]]
    parts.append(part(places[-1], last) if number else part(first, last))
    if not number:
        parts = [part(0, first + last)]
    end = ((places[-1] if number else first) + last) * size
    return {
        "dimension": 2,
        "parts": parts,
        "node_sets": {"all": {}, "start": {"where": {"x": 0}}, "end": {"where": {"x": end}}},
    }, [x * size for x in places]


def run(name, recipe, pulse, stiffness, end, step, probes, search="once", **more):
    """`probes`: places by name."""
    deck = case.load()
    joints = len(recipe["parts"]) - 1
    if stiffness:
        deck["joints"]["tight"]["normal_stiffness"] = stiffness
    deck["contact"]["search_every"] = search
    deck["conditions"].append({"type": "velocity", "node_set": "start", "components": ["x"], "value": [pulse, 0, 0]})
    deck["time"] = {"end": end, "fixed_step": step}
    deck["history"] = {"probes": [{"name": probe, "node_set": probe} for probe in probes]}
    recipe["node_sets"].update({probe: {"where": {"x": float(x)}} for probe, x in probes.items()})
    run = case.run(name, recipe, deck, **more)
    h = run.history
    case.check(f"{name}: planes besides {joints} that stick", int(numpy.max(numpy.abs(h["stick"] - joints) + h["open"] + h["slip"])), 0, 0)
    case.check(f"{name}: searches", int(h["searches"][-1]), 1 if search == "once" else int(h["cycle"][-1]) + 1, 0)
    return run, recipe, deck


# --- amplitudes behind N joints ---------------------------------------------------------------------
# One smooth pulse holds all tones up to 600 Hz, from zero. Joints trap waves that leak out slowly; the strip is
# so long that what comes back from its ends arrives when that is over.
spacing, k, size = 1.0, 2e10, 0.25
step = 0.55 * size / speed  # the joints take their part of the stable step
pulse = waves.bump(amplitude, 3e-3)
table = {  # |T_N| as published for these joints: a check of the formula below
    (50, 10): 0.77743, (200, 1): 0.91735, (200, 5): 0.91292, (200, 10): 0.79319, (200, 20): 0.80813,
    (400, 1): 0.75523, (400, 5): 0.77779, (400, 10): 0.72989, (400, 20): 0.85173,
}
# From the arrival of the wave without joints [s]; twice that in the long form.
listen = {1: 12e-3, 5: 20e-3, 10: 30e-3, 20: 45e-3}
if full:
    listen = {number: 2 * time for number, time in listen.items()}


def bloch(f):
    """Phase from block to block: cos q = cos(k s) - chi sin(k s) [rad]."""
    a, chi = 2 * math.pi * f * spacing / speed, math.pi * f * impedance / k
    return math.acos(math.cos(a) - chi * math.sin(a)), chi


def amplitude_behind(f, number):
    q, chi = bloch(f)
    return 1 / math.hypot(1, chi * math.sin(number * q) / math.sin(q))


before = speed * max(listen.values()) / 2
results = {}
for number in (1, 5, 10, 20):
    recipe, places = strip(before, number, spacing, speed * listen[number] / 2 + 2, size)
    probe = places[-1] + spacing
    end = probe / speed + listen[number]
    name = f"joints_{number}"
    one, recipe, deck = run(name, recipe, pulse, k, end, step, {"behind": probe})
    results[number] = one.history["time"], one.history["behind_velocity_x"]
    if number == 10:
        case.same_bits(name, recipe, deck, one)
        again, _, _ = run("joints_10_every", recipe, pulse, k, end, step, {"behind": probe}, search=1)
        case.check_equal("10 joints: results that differ, searching every cycle", differences(again.path("run.e"), one.path("run.e")), [])
        case.check_equal("10 joints: state hash, searching every cycle", again.state_hash, one.state_hash)
# The strip in one piece, at the same places.
recipe, _ = strip(before, 0, spacing, 100, size)
probes = {f"behind_{number}": places[0] + number * spacing for number in (1, 5, 10, 20)}
whole, _, _ = run("whole", recipe, pulse, k, probes["behind_20"] / speed + 9e-3, step, probes)
for number in (1, 5, 10, 20):
    (t, v), (t_whole, v_whole) = results[number], (whole.history["time"], whole.history[f"behind_{number}_velocity_x"])
    for f in (50, 200, 400):
        exact = amplitude_behind(f, number)
        if (f, number) in table:
            case.check(f"{number} joints, {f} Hz: formula against the table", exact, table[f, number], 1e-5)
        matrices = abs(waves.joints(f, number, k, impedance, speed, spacing)[0])
        case.check(f"{number} joints, {f} Hz: formula against transfer matrices", exact, matrices, 1e-12)
        case.check(f"{number} joints, {f} Hz: |T|", abs(waves.spectrum(t, v, f) / waves.spectrum(t_whole, v_whole, f)), exact, 0.02, relative=True)

# --- phase speed inside a long set ------------------------------------------------------------------
# From the middle of block 5 to that of block 15 the wave lags by 10 q. What comes back from the last joint
# passes block 15 later than the end of the run.
number, first, last = 60, 5, 15
recipe, places = strip(spacing, number, spacing, 3 * spacing, size)
middles = {"near": places[first] + 0.5 * spacing, "far": places[last] + 0.5 * spacing}
one, _, _ = run("set", recipe, pulse, k, 42e-3, step, middles)
t, near, far = (one.history[c] for c in ("time", "near_velocity_x", "far_velocity_x"))
tones = numpy.arange(2.0, 401.0, 2.0)
turned = waves.phase(t, far, near, tones)
for f, listed in ((50, 2429.3), (200, 2413.4), (400, 2357.5)):
    exact = 2 * math.pi * f * spacing / bloch(f)[0]
    case.check(f"phase speed, {f} Hz: formula against the table [m/s]", exact, listed, 0.05)
    measured = 2 * math.pi * f * (last - first) * spacing / turned[numpy.flatnonzero(tones == f)[0]]
    case.check(f"phase speed, {f} Hz [m/s]", measured, exact, 0.01, relative=True)
slow = speed / math.sqrt(1 + density * speed**2 / (k * spacing))
measured = 2 * math.pi * 20 * (last - first) * spacing / turned[numpy.flatnonzero(tones == 20)[0]]
case.check("speed at low frequency (20 Hz) against c / sqrt(1 + M/(k s)) [m/s]", measured, slow, 0.01, relative=True)

# --- peaks of half sines ----------------------------------------------------------------------------
tone = 1000.0
length = speed / tone
size = length / 80
listed = {  # by chi and number of joints, at spacing / length = 0.05, 0.1, 0.2, 0.5
    (0.5, 2): (0.8879, 0.9054, 0.8185, 0.8185), (0.5, 4): (0.8939, 0.8836, 0.7329, 0.6873),
    (1, 2): (0.7413, 0.7211, 0.6112, 0.5946), (1, 4): (0.7236, 0.6770, 0.5670, 0.4158),
}
fine = numpy.arange(1 << 16) / (1 << 12)  # exact answers: 16 periods
half = numpy.where(fine < 0.5, numpy.sin(2 * math.pi * fine), 0)
for (chi, number), values in listed.items():
    for part, value in zip((0.05, 0.1, 0.2, 0.5), values):
        if not full and (part in (0.1, 0.5)) == (chi == 1):
            continue  # each second one; all of them in the long form
        name = f"chi {chi}, {number} joints, s/l {part}"
        stiffness = math.pi / chi  # Z = c = f = 1
        exact = numpy.max(waves.passed(fine, half, lambda f: waves.joints(f, number, stiffness, 1, 1, part))[: 4 << 12])
        case.check(f"{name}: exact peak against the table", exact, value, 1e-4)
        recipe, places = strip(1.5 * length, number, part * length, length, size)
        probe = places[-1] + 0.1 * length
        stiffness = 2 * math.pi * tone * impedance / (2 * chi)
        end = probe / speed + 1.8 / tone
        one, _, _ = run(name.replace(" ", "_").replace("/", ""), recipe, waves.half_sine(amplitude, tone), stiffness, end,
                        0.5 * size / speed, {"behind": round(probe / size) * size})
        case.check(f"{name}: peak", waves.peak(one.history["behind_velocity_x"]) / amplitude, exact, 0.02, relative=True)
case.finish()
