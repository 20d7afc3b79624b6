"""V23: two bars of different impedance meet, and a pulse crosses from one to the other."""

import numpy
from coplanetest import Case, waves

case = Case("V23", __file__)
z_left, z_right, speed, wave, length = 40e6, 12.5e6, 2.0, 5000.0, 1.0
# The stress is the same on both sides, and so is the velocity: z_left (V - v) = z_right v.
stress = speed * z_left * z_right / (z_left + z_right)
common = stress / z_right
case.check("stress, formula against the table [Pa]", stress, 19.0476e6, 50)
case.check("velocity, formula against the table [m/s]", common, 1.52381, 5e-6)

for name, area in (("2d", 0.03), ("3d", 0.03**2)):
    recipe, deck = case.load("mesh.yaml" if name == "2d" else "mesh_3d.yaml"), case.load()
    run = case.run(name, recipe, deck)
    if name == "2d":
        case.same_bits(name, recipe, deck, run)
    results, h = run.results, run.history
    nodes = results.nodes_of("right")
    # Until the wave comes back from the free ends, after 2 L / c = 400 microseconds.
    steps = [i for i, t in enumerate(results.times) if 50e-6 <= t <= 350e-6]
    force = numpy.mean([results.nodal("contact_force", i)[nodes, 0].sum() for i in steps])
    # Thirty samples of a force that rings with the end nodes on the contact, more so the stiffer it is.
    case.check(f"{name}: stress while they touch [Pa]", force / area, stress, 0.02, relative=True)
    window = (h["time"] >= 50e-6) & (h["time"] <= 350e-6)
    case.check(f"{name}: velocity of the interface [m/s]", numpy.mean(h["interface_velocity_x"][window]), common, 0.01, relative=True)
    # Momentum goes over at the rate of stress times area.
    rate = numpy.polyfit(h["time"][window], h["right_velocity_x"][window], 1)[0] * 2500 * length
    case.check(f"{name}: momentum passed on over time and area [Pa]", rate, stress, 0.01, relative=True)

# --- a pulse through a joint that holds -------------------------------------------------------------
# A stress s_I sends T s_I on and R s_I back, T = 2 z_right / (z_left + z_right), R = T - 1; velocities are
# stress / z to the right and -stress / z to the left. The joint is so stiff that it passes in 0.5 microseconds.
recipe, deck = case.load("mesh.yaml"), case.load("deck_pulse.yaml")
# Probes 0.3 m to both sides: the incident pulse passes the front one in 140 to 240 microseconds, the reflected one in 260 to 360.
run = case.run("pulse", recipe, deck)
case.same_bits("pulse", recipe, deck, run)
h = run.history
t, front, behind = h["time"], h["front_velocity_x"], h["behind_velocity_x"]
case.check("pulse: planes that open", int(numpy.max(h["open"])), 0, 0)
passed = 2 * z_right / (z_left + z_right)
incident, reflected = front[t < 250e-6], -front[t > 250e-6]
case.check("pulse: transmitted over incident stress", waves.peak(behind) * z_right / (waves.peak(incident) * z_left), passed, 0.01, relative=True)
case.check("pulse: reflected over incident stress", -waves.peak(-reflected) / waves.peak(incident), passed - 1, 0.01, relative=True)
case.check("pulse: transmission, formula against the table", passed, 0.476190, 5e-7)
case.check("pulse: reflection, formula against the table", passed - 1, -0.523810, 5e-7)
energy = (waves.energy(t[t > 250e-6], reflected) * z_left + waves.energy(t, behind) * z_right) / (waves.energy(t[t < 250e-6], incident) * z_left)
case.check("pulse: energy of both over the incident", energy, 1, 0.01)
case.finish()
