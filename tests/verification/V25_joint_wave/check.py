"""V25: one joint in a strip of granite passes, reflects and delays waves; V65: 2D equals a slice of 3D."""

import math
import sys

import numpy
from coplanetest import Case, waves

case = Case("V25", __file__)
full = "all" in sys.argv[1:]
density, modulus, poisson = 2650.0, 60e9, 0.25
shear_modulus = modulus / (2 * (1 + poisson))
impedance = {
    "P": math.sqrt(density * modulus * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))),
    "S": math.sqrt(density * shear_modulus),
}
speed = {wave: z / density for wave, z in impedance.items()}
tone, amplitude = 1000.0, 0.05  # [Hz], [m/s]
fine = 90 if full else 45  # elements in a wave; twice as many for the half sine, which has corners
# In wave lengths: what stands before the joint and behind it, and where the probes are. All of a burst of three
# periods, and the five periods for which a soft joint rings on, pass the probes before the ends answer.
length, away, periods = 4.8, 0.6, 13.4


def recipe_of(wave, joint, fine, slice=False):
    """With the joint, or the same strip in one piece."""
    size = speed[wave] / tone / fine
    number = round(length * fine)
    recipe = case.load("mesh.yaml")
    left, right = recipe["parts"]
    left.update(size=[number * size, size], divisions=[number, 1])
    right.update(left, block="right", min=[number * size, 0])
    if not joint:
        left.update(size=[2 * number * size, size], divisions=[2 * number, 1])
        recipe["parts"] = [left]
    probe = round(away * fine)
    recipe["node_sets"] = {
        "all": {},
        "start": {"where": {"x": 0}},
        "end": {"where": {"x": 2 * number * size}},
        "front": {"where": {"x": (number - probe) * size}},
        "behind": {"where": {"x": (number + probe) * size}},
    }
    if slice:
        recipe["dimension"] = 3
        for part in recipe["parts"]:
            part.update(min=part["min"] + [0], size=part["size"] + [1], divisions=part["divisions"] + [1])
    return recipe


def deck_of(wave, pulse, stiffness, fine, periods=periods):
    """P: particles move along the strip, which cannot bulge; S: they move across it only."""
    deck = case.load()
    axis = 0 if wave == "P" else 1
    value = [0, 0, 0]
    value[axis] = pulse
    deck["conditions"] = [
        {"type": "fixed", "node_set": "all", "components": ["y" if wave == "P" else "x"]},
        {"type": "velocity", "node_set": "start", "components": ["xy"[axis]], "value": value},
        {"type": "fixed", "node_set": "end"},
    ]
    deck["time"] = {"end": periods / tone, "fixed_step": 0.6 * speed[wave] / speed["P"] / fine / tone}  # the joint takes its part
    if stiffness:
        deck["joints"]["tight"]["normal_stiffness" if wave == "P" else "shear_stiffness"] = stiffness
    else:
        for part in ("joints", "contact"):
            deck.pop(part)
        deck["blocks"].pop("right")
        deck["initial"].pop()
    return deck


def records(name, wave, pulse, stiffness, ranks=False, **change):
    """Times and velocities in front of the joint and behind it."""
    change = {"fine": fine, **change}
    recipe, deck = recipe_of(wave, bool(stiffness), change["fine"]), deck_of(wave, pulse, stiffness, **change)
    run = case.run(name, recipe, deck)
    if ranks:
        case.same_bits(name, recipe, deck, run)
    h = run.history
    axis = "x" if wave == "P" else "y"
    if stiffness:
        case.check(f"{name}: planes that slip or open", int(numpy.max(h["slip"] + h["open"])), 0, 0)
    # The velocities of a line are those half a step later; what matters here is that all runs agree.
    return h["time"], h[f"front_velocity_{axis}"], h[f"behind_velocity_{axis}"], run


# --- tone bursts ------------------------------------------------------------------------------------
# Amplitudes at the tone over those of the strip in one piece: all of the burst, and of what the joint makes
# of it, passes the probes before anything comes back from the ends.
stiffnesses = {"P": (1e10, 4.33949e10, 5e10, 1e11), "S": (1e10, 2.50542e10, 5e10)}
pulse = waves.tone_burst(amplitude, tone, 3)
for wave in "PS":
    t, front_whole, behind_whole, _ = records(f"{wave}_whole", wave, pulse, None)
    for k in stiffnesses[wave]:
        name = f"{wave}_{k:.3g}"
        _, front, behind, _ = records(name, wave, pulse, k, ranks=k == 5e10)
        chi = 2 * math.pi * tone * impedance[wave] / (2 * k)
        through = waves.ratio(t, behind, behind_whole, tone)
        back = waves.ratio(t, front - front_whole, front_whole, tone)
        case.check(f"{name}: |T|, chi {chi:.5f}", abs(through), 1 / math.hypot(1, chi), 0.01, relative=True)
        case.check(f"{name}: |R|", abs(back), chi / math.hypot(1, chi), 0.01, relative=True)
        case.check(f"{name}: lag behind the joint [degrees]", waves.lag(through), math.degrees(math.atan(chi)), 0.45)
        case.check(f"{name}: |T|^2 + |R|^2", abs(through) ** 2 + abs(back) ** 2, 1, 0.01)

# --- a step -----------------------------------------------------------------------------------------
# Behind the joint v0 (1 - exp(-2 k t / Z)). The front rises within 0.2 ms, a seventh of the time of the
# exponential; the answer to a rise is that to a step at its middle, but for (rise 2k/Z)^2/24 = 1e-3 of the rest.
k, rise = 1e10, 1e-4
rate = 2 * k / impedance["P"]
t, _, behind, _ = records("step", "P", waves.ramp(amplitude, rise), k)
arrival = (length + away) / tone + rise / 2
window = (t > arrival + 2 * rise) & (t < arrival + 3e-3)
expected = amplitude * (1 - numpy.exp(-rate * (t - arrival)))
case.check("step: behind the joint over v0 (1 - exp(-2 k t / Z)), worst of 3 ms",
           numpy.max(numpy.abs(behind - expected)[window]) / amplitude, 0, 0.01)

# --- half a sine ------------------------------------------------------------------------------------
# With a = w t: v_T / v0 = (sin a - chi cos a + chi exp(-a / chi)) / (1 + chi^2) until a = pi, then it decays.
angle = numpy.linspace(0, math.pi, 100001)
for chi, listed in ((0.25, 0.97031), (0.5, 0.90137), (1, 0.75620)):
    exact = numpy.max(numpy.sin(angle) - chi * numpy.cos(angle) + chi * numpy.exp(-angle / chi)) / (1 + chi**2)
    case.check(f"half sine, chi {chi}: exact peak against the table", exact, listed, 1e-5)
    k = 2 * math.pi * tone * impedance["P"] / (2 * chi)
    t, _, behind, _ = records(f"half_sine_{chi}", "P", waves.half_sine(amplitude, tone), k, fine=2 * fine, periods=7)
    case.check(f"half sine, chi {chi}: peak behind the joint over v0", waves.peak(behind) / amplitude, exact, 0.01, relative=True)

# --- V65: one layer of hexahedra between rollers is the plane problem -------------------------------
case.name = "V65"
for wave in "PS":
    name = f"{wave}_5e+10"
    # A hundred times stronger: positions are rounded to 1.8e-15 m, which would be 2e-10 of the displacements.
    deck = deck_of(wave, waves.tone_burst(100 * amplitude, tone, 3), 5e10, fine)
    for item in deck["initial"]:
        item["stress"] = [100 * value for value in item["stress"]]
    for block in deck["blocks"].values():
        block["hourglass"] = {"stiffness": 0}  # it depends on the thickness
    plane = case.run(f"{name}_plane", recipe_of(wave, True, fine), deck)
    deck["conditions"][0]["components"] += ["z"]
    slice = case.run(f"{name}_slice", recipe_of(wave, True, fine, slice=True), deck)
    for probe in ("front", "behind"):
        column = f"{probe}_velocity_{'x' if wave == 'P' else 'y'}"
        a, b = slice.history[column], plane.history[column]
        case.check(f"{name}_slice: {column}", numpy.max(numpy.abs(a - b)) / numpy.max(numpy.abs(b)), 0, 1e-10)
case.finish()
