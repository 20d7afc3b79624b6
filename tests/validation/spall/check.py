"""Spall of a concrete rod: the strength that the pull-back of its free end tells, against the strength that the law has, and against measured ones."""

import math

import numpy
from coplanetest import ValidationCase

DENSITY, MODULUS, STRENGTH = 2300.0, 33e9, 4e6  # of the set concrete_c40
SPEED = math.sqrt(MODULUS / DENSITY)
PEAK, LENGTH = 30e6, 0.25


class Rods(ValidationCase):
    def conservation(self, name, run, deck, energy=3e-3, **_):
        h = run.history
        self.check(f"{name}: energy balance", numpy.max(numpy.abs(h["error"])) / numpy.max(h["kinetic"]), 0, energy, kept="energy balance")


case = Rods(__file__)


def measured(rate):
    """Yu, Zhang and Gu 2025, at 3 to 55 per second [Pa]."""
    return (4.1 + 4.7 * math.log10(rate)) * 1e6


def spall(name, rates, largest=None, along=60, fracture_energy=None, peak=PEAK):
    """Strength by rho c dv / 2 [Pa], strain rate of the reflected wave [1/s], most damage; run, seconds, peak of the free end [m/s]."""
    recipe, deck = case.load("mesh.yaml"), case.load()
    recipe["parts"][0]["divisions"] = [max(2, round(along * 0.15)), along]
    deck["conditions"][0]["value"] = f"t < 8e-5 ? {peak!r}*(0.5 - 0.5*cos(2*_pi*t/8e-5)) : 0"
    if rates:
        deck["materials"]["concrete"]["rate_effects"] = True
    if largest:
        deck["materials"]["concrete"]["largest_rate"] = largest
    if fracture_energy:
        deck["materials"]["concrete"]["fracture_energy"] = fracture_energy
    run, spent = case.timed(name, recipe, deck)
    h = run.history
    t, v = h["time"], h["free_velocity_y"]
    top = int(numpy.argmax(v))
    # The first minimum behind the peak that is followed by a rise of 3 % of the peak.
    low = top
    for i in range(top, len(v)):
        if v[i] < v[low]:
            low = i
        elif v[i] > v[low] + 0.03 * v[top]:
            break
    strength = DENSITY * SPEED * (v[top] - v[low]) / 2
    slope = numpy.max(-numpy.gradient(v[top : low + 1], t[top : low + 1])) / (2 * SPEED)
    results = run.results
    damage = results.element("rod", "damage")
    return strength, slope, float(damage.max()), run, spent, v[top]


static, rate, damage, run, spent, top = spall("static", False)
case.check("peak of the free end over 2 P / (rho c)", top / (2 * PEAK / (DENSITY * SPEED)), 1, 0.08)
case.check("without effects of rate: strength by the pull-back against the measured relation [Pa]", static, measured(rate), 0.25, relative=True)
case.check_within("without effects of rate: most damage", damage, 0.8, 1)
case.picture(run, "--color", "damage", "--range", "0", "1", "--shares", "0", "0.5", "0.75", "1", "--strip", "4", "--mirror", "--planes", "none", "--size", "240", "520", "--window", "-0.05", "0.05", "-0.01", "0.27")
brittle, _, damage, _, _, _ = spall("brittle", False, fracture_energy=5)
case.check("without effects of rate, a fracture energy of 5 J/m^2: strength by the pull-back over that of the law", brittle / STRENGTH, 1, 0.2)
fast, rate, damage, run, spent, top = spall("rates", True)
case.check("with effects of rate: strength by the pull-back against the measured relation [Pa]", fast, measured(rate), 0.35, relative=True)
case.check_within("with effects of rate: most damage", damage, 0.8, 1)
beyond, rate, damage, run, spent, top = spall("beyond", True, 300)
case.check("with a largest_rate of 300/s: strength by the pull-back against the measured relation [Pa] (reported: too much)", beyond, measured(rate), 0.35, relative=True, report=True)
case.check("with a largest_rate of 300/s: most damage (reported: the rod does not break)", damage, 1, 0.2, report=True)
if case.full:
    for fracture_energy in (5, 15, 40, 120):
        found, rate, damage, run, spent, top = spall(f"energy_{fracture_energy}", False, fracture_energy=fracture_energy)
        case.study("strength by the pull-back, without effects of rate [Pa] (reference: of the law)", f"4.2 mm, fracture energy of {fracture_energy} J/m2", found, STRENGTH, spent)
    for rates, largest, words in ((False, None, "without effects of rate"), (True, None, "with effects of rate"), (True, 300, "with a largest_rate of 300/s")):
        tag = f"{rates}_{largest}"
        for peak in (8e6, 15e6, 30e6, 38e6):
            found, rate, damage, run, spent, top = spall(f"peak_{peak:g}_{tag}", rates, largest, peak=peak)
            case.study(f"strength by the pull-back, {words} [Pa] (reference: measured)", f"4.2 mm, pulse of {peak / 1e6:g} MPa", found, measured(rate), spent)
            case.study(f"most damage, {words}", f"4.2 mm, pulse of {peak / 1e6:g} MPa", damage, None, spent)
        for along in (30, 60, 120, 240):
            found, rate, damage, run, spent, top = spall(f"along_{along}_{tag}", rates, largest, along)
            case.study(f"strength by the pull-back, {words} [Pa] (reference: measured)", f"{1e3 * LENGTH / along:.1f} mm", found, measured(rate), spent)
case.finish()
