"""V39: Sod's tube and Noh's wall: shocks in an ideal gas."""

import math

import numpy
from coplanetest import Case

case = Case("V39", __file__)


def profile(run, blocks):
    """Present centres, densities, pressures and speeds of the elements, from left to right."""
    r = run.results
    moved, speed = r.nodal("displacement")[:, 0] + r.coordinates[:, 0], r.nodal("velocity")[:, 0]
    x = numpy.concatenate([moved[r.connectivity(b)].mean(axis=1) for b in blocks])
    u = numpy.concatenate([speed[r.connectivity(b)].mean(axis=1) for b in blocks])
    fields = [numpy.concatenate([r.element(b, name) for b in blocks]) for name in ("density", "pressure")]
    order = numpy.argsort(x)
    return x[order], fields[0][order], fields[1][order], u[order]


def crossing(x, y, value):
    """Where y, which falls to the right, passes the value for the last time."""
    i = numpy.nonzero(y > value)[0][-1]
    return numpy.interp(-value, -y[i : i + 2], x[i : i + 2])


# --- Sod: pressures 1 and 0.1, densities 1 and 0.125, gamma 1.4, membrane at 0.5. The pressure behind the shock is the root
# of the sum of the speeds that the rarefaction and the shock give the gases.
gamma, time = 1.4, 0.2
left, right = (1.0, 1.0), (0.125, 0.1)
sound = math.sqrt(gamma * left[1] / left[0])


def behind_shock(p):
    a, b = 2 / ((gamma + 1) * right[0]), (gamma - 1) / (gamma + 1) * right[1]
    return (p - right[1]) * math.sqrt(a / (p + b))


def behind_rarefaction(p):
    return 2 * sound / (gamma - 1) * (1 - (p / left[1]) ** ((gamma - 1) / (2 * gamma)))


low, high = right[1], left[1]
for _ in range(100):
    p = 0.5 * (low + high)
    low, high = (p, high) if behind_shock(p) < behind_rarefaction(p) else (low, p)
u = behind_shock(p)
ratio = (gamma - 1) / (gamma + 1)
dense = right[0] * (p / right[1] + ratio) / (ratio * p / right[1] + 1)
thin = left[0] * (p / left[1]) ** (1 / gamma)
shock = 0.5 + time * u * dense / (dense - right[0])
contact = 0.5 + time * u
head, tail = 0.5 - time * sound, 0.5 + time * (u - sound * (p / left[1]) ** ((gamma - 1) / (2 * gamma)))

run = case.run("sod", case.load("mesh_sod.yaml"), case.load("deck_sod.yaml"), energy=2e-3)
x, density, pressure, speed = profile(run, ("left", "right"))
# Plateaus without the elements near their ends, in which the waves began or are spread.
expanded = (x > tail + 0.02) & (x < contact - 0.02)
shocked = (x > contact + 0.02) & (x < shock - 0.02)
both = expanded | shocked
for what, value, reference in (
    ("pressure between the waves", pressure[both].mean(), p),
    ("speed between the waves", speed[both].mean(), u),
    ("density behind the rarefaction", density[expanded].mean(), thin),
    ("density behind the shock", density[shocked].mean(), dense),
    ("place of the shock", crossing(x, speed, 0.5 * u), shock),
    ("place of the membrane", 0.5 + run.history["middle_displacement_x"][-1], contact),
):
    case.check(f"Sod: {what}", value, reference, 0.03, relative=True)
# In the fan the speed is linear in x: the line through its middle leads to both ends.
fan = (speed > 0.2 * u) & (speed < 0.8 * u) & (x < contact)
slope, start = numpy.polyfit(x[fan], speed[fan], 1)
case.check("Sod: head of the rarefaction", -start / slope, head, 0.03, relative=True)
case.check("Sod: tail of the rarefaction", (u - start) / slope, tail, 0.03, relative=True)
case.check("Sod: root mean square error of the pressure between the waves", numpy.std(pressure[both]) / p, 0, 0.03)
case.same_bits("sod", case.load("mesh_sod.yaml"), case.load("deck_sod.yaml"), run)

# --- Noh: speed 1 against a wall, no pressure, gamma 5/3: behind the shock density (gamma + 1) / (gamma - 1), pressure
# rho0 v (v + D), at rest; the shock runs with D = (gamma - 1) v / 2 away from the wall.
gamma, time = 5 / 3, 0.6
run = case.run("noh", case.load("mesh_noh.yaml"), case.load("deck_noh.yaml"), energy=2e-3)
x, density, pressure, speed = profile(run, ("gas",))
front = (gamma - 1) / 2 * time
behind = (x > 0.15 * front) & (x < 0.9 * front)  # the gas at the wall is heated too much
ahead = x > 1.15 * front
for what, value, reference in (
    ("density behind the shock", density[behind].mean(), (gamma + 1) / (gamma - 1)),
    ("pressure behind the shock", pressure[behind].mean(), (gamma + 1) / 2),
    ("place of the shock", crossing(x, density, 0.5 * (1 + 4)), front),
    ("density ahead", density[ahead].mean(), 1),
    ("speed ahead", speed[ahead].mean(), -1),
):
    case.check(f"Noh: {what}", value, reference, 0.03, relative=True)
case.check("Noh: largest speed behind the shock", numpy.max(numpy.abs(speed[behind])), 0, 0.03)
case.finish()
