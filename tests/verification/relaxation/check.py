"""Dynamic relaxation: a bar on a joint under its weight finds its state of rest, and stays there without damping."""

import numpy
from coplanetest import Case

case = Case("relaxation", __file__)
density, young, gravity, height, joint = 2000.0, 2e9, 10.0, 4.0, 1e9
# One dimension (Poisson's ratio 0): the joint closes by rho g H / k_n, the bar by rho g H^2 / (2 E).
closure = density * gravity * height / joint
shortening = density * gravity * height**2 / (2 * young)
weight = density * gravity * height

dampings = {
    "kinetic": {"kinetic": True, "until_energy_ratio": 1e-9, "until_force_ratio": 1e-4},
    "local": {"local": 0.7, "until_energy_ratio": 1e-12, "until_force_ratio": 1e-6},
}
for name, damping in dampings.items():
    deck = case.load()
    deck["damping"] = damping
    run = case.run(name, case.load("mesh.yaml"), deck)
    h = run.history
    ended = [line for line in run.output.splitlines() if "damping ends" in line]
    case.check_equal(f"{name}: damping has ended by its ratios", len(ended), 1)
    time = float(ended[0].split("t = ")[1].split(" ")[0])
    case.check_within(f"{name}: time at which it ended [s]", time, 0.01, 0.3)
    after = h["time"] > time + 2e-3
    # 4e-5 is the strain, by which the bar is no longer what it was.
    for probe, exact in (("base", closure), ("top", closure + shortening)):
        moved = -h[f"{probe}_displacement_y"][after]
        # Over the two faces of the row, and not over its three nodes: README.md.
        over_faces = (3 * moved - h[f"{probe}_middle_displacement_y"][after]) / 4
        case.check(f"{name}: {probe} has sunk by, mean [m]", numpy.mean(over_faces), exact, 2e-4, relative=True)
        case.check(f"{name}: {probe} moves on by, over that", numpy.ptp(moved) / exact, 0, 1e-3)
    stress = run.results.element("bar", "stress_yy")
    depth = height - run.results.centres("bar")[:, 1]
    error = numpy.max(numpy.abs(stress + density * gravity * depth)) / weight
    case.check(f"{name}: largest error of the axial stress over rho g H", error, 0, 1e-3)
    force = numpy.sum(run.results.nodal("contact_force_y")[run.results.nodes_of("bar")])
    case.check(f"{name}: force of the joint [N]", force, weight, 1e-3, relative=True)
    kinetic = numpy.max(numpy.abs(h["kinetic"][after])) / h["internal"][-1]
    case.check(f"{name}: kinetic energy without damping, over the internal one", kinetic, 0, 1e-6)
    # The loads do twice the work that is stored; damping takes the other half. The first kinetic energy, of mirrored
    # velocities, is not zero by a term of second order in the step.
    column, other = f"{name}_damping", "local_damping" if name == "kinetic" else "kinetic_damping"
    stored = h["internal"][-1] + h["contact_stored"][-1]
    case.check(f"{name}: work of the damping over the energy stored", (h[column][-1] - h["initial"][-1]) / stored, 1, 2e-3)
    case.check(f"{name}: the other column [J]", numpy.max(numpy.abs(h[other])), 0, 0)
    case.check(f"{name}: work of the damping after its end [J]", numpy.ptp(h[column][after]), 0, 0)
    case.same_bits(name, case.load("mesh.yaml"), deck, run)
    # The same, and nothing after it.
    deck["time"]["end_at_rest"] = True
    rest = case.run(f"{name}_to_rest", case.load("mesh.yaml"), deck)
    case.check(f"{name}, end_at_rest: end [s]", rest.history["time"][-1], time, 1e-6 * time)
    case.check(f"{name}, end_at_rest: last state of the results [s]", rest.results.times[-1], time, 1e-6 * time)
# Damping that ends by the time says how far the model is from rest.
deck = case.load()
deck["damping"] = {"local": 0.7, "until": 0.02}
deck["time"]["end"] = 0.03
deck["history"]["every"] = 0
told = case.attempt("early", case.load("mesh.yaml"), deck)
lines = [line for line in told.output.splitlines() if "damping ends by damping.until" in line]
case.check_equal("until: lines that tell of the end", len(lines), 1)
time, energy = (float(lines[0].split(word)[1].split(" ")[0]) for word in ("t = ", "Kinetic energy is "))
h = told.history
# The motion after the kick, between this cycle and the next.
at = numpy.argmin(abs(h["time"] - time))
ratios = [h["kinetic"][i] / (h["internal"][at] + h["contact_stored"][at]) for i in (at, at + 1)]
case.check_within("until: kinetic over internal energy when it ends", energy, 0.9 * min(ratios), 1.1 * max(ratios))
case.finish()
