"""V74: the momentum that a blast wave gives to a plate, its energy, and what is refused."""

import copy

import numpy
from coplanetest import Case

case = Case("V74", __file__)
recipe, plain = case.load("mesh.yaml"), case.load()
area = 0.01  # of a face [m^2]
middles = (numpy.arange(10) + 0.5) * 0.1 - 0.5


def polynomial(coefficients, x):
    return sum(c * x**i for i, c in enumerate(coefficients))


def hemisphere_reflected(z):
    """Scaled reflected impulse [Pa s / kg^(1/3)], of Kingery and Bulmash."""
    u = -0.246208804814 + 1.33422049854 * numpy.log10(z)
    return 10 ** polynomial([2.70588058103, -0.949516092853, 0.112136118689, -0.0250659183287], u)


def sphere_reflected(z):
    u = -0.204004553231 + 1.37882996018 * numpy.log10(z)
    return 10 ** polynomial([2.55875660396, -0.903118886091, 0.101771877942, -0.0242139751146], u)


def hemisphere_incident(z):
    """The same of the incident wave, by Swisdak's simplified fits."""
    x = numpy.log(z)
    near = polynomial([5.465, -0.308, -1.464, 1.362, -0.432], x)
    return numpy.exp(numpy.where(z < 2.38, near, polynomial([5.2749, -0.4677, -0.2499, 0.0588, -0.00554], x)))


def impulse(charge, mass, x, direction, reflected, incident):
    """On the face at x whose normal is `direction` along x, sum over its elements [N s]."""
    total = 0
    for y in middles:
        for z in middles:
            way = numpy.array([charge - x, -y, -z])
            distance = numpy.linalg.norm(way)
            cosine = direction * way[0] / distance
            scaled = numpy.array(distance / mass ** (1 / 3))
            share = cosine**2 if cosine > 0 else 0
            rest = 1 + cosine - 2 * cosine**2 if cosine > 0 else 1
            total -= direction * area * mass ** (1 / 3) * (share * reflected(scaled) + rest * incident(scaled))
    return float(total)


def deck_with(*cards, end=0.02):
    deck = copy.deepcopy(plain)
    deck["conditions"] = [{"type": "air_blast", **card} for card in cards]
    deck["time"]["end"] = end
    deck["output"]["every"] = end
    return deck


def run(name, deck):
    """The impulse of the loads [N s]."""
    result = case.run(name, recipe, deck, energy=1e-6)
    h = result.history
    return result, numpy.array([h[f"impulse_{axis}"][-1] for axis in "xyz"])


near, got = run("near", plain)
case.check("near, 5 m from 100 kg: impulse [N s]", got[0], impulse(-5, 100, 0, -1, hemisphere_reflected, hemisphere_incident), 0.01, relative=True)
case.check("near: impulse across, over that along", numpy.abs(got[1:]).max() / got[0], 0, 1e-12)
case.same_bits("near", recipe, plain, near)

far = {"side_set": "front", "charge_mass": 1, "charge_place": [-20, 0, 0], "detonation_time": -0.048}
_, got = run("far", deck_with(far, end=0.012))
reference = impulse(-20, 1, 0, -1, hemisphere_reflected, hemisphere_incident)
case.check("far, 20 m from 1 kg: impulse [N s]", got[0], reference, 2e-3, relative=True)

_, got = run("air", deck_with({**far, "burst": "air", "detonation_time": -0.05}, end=0.012))
# Incident impulses of spheres matter with 0.1 %: two thirds of those of hemispheres.
case.check("far, in free air: impulse [N s]", got[0],
           impulse(-20, 1, 0, -1, sphere_reflected, lambda z: 0.68 * hemisphere_incident(z)), 2e-3, relative=True)

_, got = run("back", deck_with({**far, "side_set": "back"}, end=0.013))
case.check("on the face that is turned away: impulse [N s]", got[0], impulse(-20, 1, 0.1, 1, hemisphere_reflected, hemisphere_incident), 0.01, relative=True)

_, got = run("both", deck_with(far, {**far, "side_set": "back", "charge_place": [20.1, 0, 0]}, end=0.012))
case.check("between two charges: impulse over that of one", numpy.abs(got).max() / reference, 0, 1e-12)

for what, card, text in (
    ("too near", {**far, "charge_place": [-0.15, 0, 0]}, "accepted for burst: surface: 0.178 to 40 m/kg^(1/3)"),
    ("too far", {**far, "charge_place": [-41, 0, 0], "burst": "air"}, "accepted for burst: air: 0.147 to 40 m/kg^(1/3)"),
):
    refused = case.attempt(what.replace(" ", "_"), recipe, deck_with(card), options=("--check",))
    case.check_equal(f"{what}: exit code and text", [refused.code, text in " ".join(refused.output.split())], [3, True])
case.finish()
