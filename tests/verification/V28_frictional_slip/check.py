"""V28: a joint that slips clips shear waves and turns a part of their energy into heat."""

import copy
import math

import numpy
from coplanetest import Case, waves

case = Case("V28", __file__)
density, modulus, poisson = 2650.0, 60e9, 0.25
impedance = math.sqrt(density * modulus / (2 * (1 + poisson)))  # of shear waves
strength, tone, width = 1e6, 50.0, 10.0  # [Pa], [Hz], [m]
recipe = case.load("mesh.yaml")


def deck_of(amplitude):
    """One period of a sine along y; nothing moves along x, so the pressure on the joint stays."""
    deck = case.load()
    period = 1 / tone
    pulse = f"t < {period!r} ? {amplitude!r} * sin(2*_pi*t/{period!r}) : 0"
    deck["conditions"] = [
        {"type": "fixed", "node_set": "all", "components": ["x"]},
        {"type": "velocity", "node_set": "start", "components": ["y"], "value": [0, pulse, 0]},
        {"type": "fixed", "node_set": "end"},
    ]
    return deck


listed = {0.25: (0.11165, 0.48173, 0.40662), 0.5: (0.39100, 0.17301, 0.43599),
          0.75: (0.74170, 0.03029, 0.22801), 0.9: (0.92828, 0.00305, 0.06868)}
# The incident wave: the strip in one piece. It is linear, so one run serves all amplitudes.
whole_deck, whole_recipe = deck_of(1.0), copy.deepcopy(recipe)
whole_recipe["parts"] = [{**recipe["parts"][0], "size": [138, 10], "divisions": [345, 1]}]
for part in ("joints", "contact"):
    whole_deck.pop(part)
whole_deck["blocks"].pop("right")
whole_deck["initial"].pop()
unit = case.run("whole", whole_recipe, whole_deck).history

for r, table in listed.items():
    name = f"r_{r}"
    amplitude = strength / r / impedance
    deck = deck_of(amplitude)
    whole = {column: amplitude * unit[column] for column in ("front_velocity_y", "behind_velocity_y")}
    run = case.run(name, recipe, deck)
    if r == 0.5:
        case.same_bits(name, recipe, deck, run)
        case.check("amplitude for r = 0.5 [m/s]", amplitude, 0.250785, 1e-5, relative=True)
    h = run.history
    t = h["time"]
    incident = waves.energy(t, whole["front_velocity_y"])
    passed = waves.energy(t, h["behind_velocity_y"]) / incident
    reflected = waves.energy(t, h["front_velocity_y"] - whole["front_velocity_y"]) / incident
    # Energy of the incident wave: Z v^2 through the width.
    lost = h["contact_friction"][-1] / (impedance * incident * width)
    # Clipped sine: with a = asin r, in parts of the mean square.
    a = math.asin(r)
    rest = math.pi / 2 - a
    exact_passed = 4 / math.pi * (a / 2 - math.sin(2 * a) / 4 + r * r * rest)
    exact_reflected = 4 / math.pi * (rest / 2 + math.sin(2 * a) / 4 - 2 * r * math.cos(a) + r * r * rest)
    exact = (exact_passed, exact_reflected, 1 - exact_passed - exact_reflected)
    for what, value, formula, number in zip(("passed", "reflected", "lost"), (passed, reflected, lost), exact, table):
        case.check(f"{name}: {what}, formula against the table", formula, number, 1e-5)
        case.check(f"{name}: {what} part of the energy", value, formula, 0.02, relative=True)
    clipped = numpy.clip(whole["behind_velocity_y"], -strength / impedance, strength / impedance)
    error = math.sqrt(waves.energy(t, h["behind_velocity_y"] - clipped) / incident)
    case.check(f"{name}: wave behind the joint against the clipped one, root mean square", error, 0, 0.02)
case.finish()
