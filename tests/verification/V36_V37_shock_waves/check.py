"""V36: elastic and plastic waves in uniaxial strain; V37: strong shocks with an equation of state."""

import numpy
from coplanetest import Case

case = Case("V36", __file__)
recipe = case.load("mesh.yaml")


def driven(name, material, speed, end):
    deck = case.load()
    deck["materials"] = {"steel": material}
    deck["conditions"] = [
        {"type": "fixed", "node_set": "all", "components": ["y"]},
        {"type": "velocity", "node_set": "piston", "components": ["x"], "value": [speed, 0, 0]},
    ]
    deck["time"] = {"end": end}
    deck["output"]["every"] = end
    return case.run(name, recipe, deck)


def arrival(run, probe, speed):
    """When the probe first has this speed [s]."""
    v, time = run.history[f"{probe}_velocity_x"], run.history["time"]
    i = int(numpy.argmax(v >= speed))
    return numpy.interp(speed, v[i - 1 : i + 1], time[i - 1 : i + 1])


def between(run, speed):
    """Speed of the part of the wave with this particle speed, between the probes [m/s, Lagrangian]."""
    return 0.2 / (arrival(run, "second", speed) - arrival(run, "first", speed))


def behind(run, variable):
    """Mean over the elements near the piston, but for the first few, which the start heats too much."""
    return float(numpy.mean(run.results.element("strip", variable)[8:30]))


# --- V36: J2. M = K + 4G/3, HEL = Y M / 2G = 700 MPa at 15.2265 m/s; behind it waves run with the bulk
# modulus, or with K + 4/3 G H / (3 G + H) where it hardens.
E, nu, rho, Y = 200e9, 0.3, 7850.0, 400e6
K, G = E / (3 * (1 - 2 * nu)), E / (2 * (1 + nu))
elastic = ((K + 4 / 3 * G) / rho) ** 0.5
hel = Y * (K + 4 / 3 * G) / (2 * G)
at_hel = hel / (rho * elastic)
for name, hardening, speed in (("perfect", 0.0, 50.0), ("perfect_fast", 0.0, 100.0), ("hardening", 2e9, 50.0)):
    run = driven(
        name,
        {"model": "j2", "density": rho, "youngs_modulus": E, "poisson_ratio": nu, "yield_stress": Y,
         "hardening_modulus": hardening},
        speed, 80e-6,
    )
    # Plastic part: dsxx = (K + 4/3 G h) de with h = H / (3G + H).
    plastic = ((K + 4 / 3 * G * hardening / (3 * G + hardening)) / rho) ** 0.5
    stress = hel + rho * plastic * (speed - at_hel)
    case.check(f"{name}: stress behind the wave [Pa]", -behind(run, "stress_xx"), stress, 0.02, relative=True)
    case.check(f"{name}: speed of the precursor [m/s]", between(run, 0.5 * at_hel), elastic, 0.02, relative=True)
    case.check(f"{name}: speed of the plastic wave [m/s]", between(run, 0.5 * (at_hel + speed)), plastic, 0.02, relative=True)
    v, time = run.history["second_velocity_x"], run.history["time"]
    middle = 0.5 * (arrival(run, "second", 0.5 * at_hel) + arrival(run, "second", 0.5 * (at_hel + speed)))
    case.check(f"{name}: speed of the precursor's material [m/s]", numpy.interp(middle, time, v), at_hel, 0.02, relative=True)

# --- V37: Mie-Grueneisen, nearly without strength; a flyer of twice the piston's speed makes the same shock.
case.name = "V37"
for up in (250.0, 500.0):
    run = driven(
        f"shock_{up:g}",
        {"model": "j2", "density": rho, "youngs_modulus": E, "poisson_ratio": nu, "yield_stress": 1e6,
         "eos": "mie_grueneisen", "sound_speed": 4570, "shock_slope": 1.49, "grueneisen": 1.93},
        up, 75e-6,
    )
    Us = 4570 + 1.49 * up
    case.check(f"{up:g} m/s: pressure [Pa]", behind(run, "pressure"), rho * Us * up, 0.02, relative=True)
    case.check(f"{up:g} m/s: density [kg/m^3]", behind(run, "density"), rho * Us / (Us - up), 0.02, relative=True)
    case.check(f"{up:g} m/s: speed of the shock [m/s]", between(run, 0.5 * up), Us, 0.02, relative=True)
case.finish()
