"""Nodal mass scaling: steps, added masses, states of rest, free flight, books of what is added in a run, what is refused."""

import json
import math
import pathlib

import numpy
from coplanetest import Case, documents, program

case = Case("mass_scaling", __file__)
density, young = 2000.0, 2e9
speed = math.sqrt(young / density)
factor = 0.8  # time.step_factor

# A bar with one thin element in its middle, pressed until it is at rest: u = p L / E, sigma = -p. With nu = 0 an element
# of the length h has the stable step h / c, and gives rho h w / 2 to each of its ends.
recipe, deck = case.load("mesh_press.yaml"), case.load("deck_press.yaml")
free = case.run("press_free", recipe, deck)
lengths = numpy.diff(numpy.unique(numpy.round(free.results.coordinates[:, 0], 12)))
natural = factor * numpy.min(lengths) / speed
deck["time"]["mass_scaling"] = {"step": float(6 * natural), "limit": 0.1}
run = case.run("press", recipe, deck)
h = run.history
case.check("press: first step without scaling [s]", free.history["dt"][1], natural, 1e-6, relative=True)
case.check("press: largest error of steps over the given one", numpy.max(numpy.abs(h["dt"][1:-1] / (6 * natural) - 1)), 0, 1e-12)
own = density * lengths * 0.2 / 2
needed = own * (6 * natural * speed / (factor * lengths)) ** 2


def at_ends(of):
    return numpy.append(of, 0) + numpy.append(0, of)


added = numpy.sum(numpy.maximum(0, at_ends(needed) - at_ends(own)))
case.check("press: added mass at the start [kg]", h["bar_added_mass"][0], added, 1e-6, relative=True)
case.check_within("press: added mass over that of the bar", h["bar_added_mass"][-1] / (density * 1.005 * 0.2), 0.05, 0.1)
for name, one in (("free", free), ("scaled", run)):
    moved = one.history["end_displacement_x"][-1]
    case.check(f"press, {name}: displacement of the end [m]", moved, -1e5 * 1.005 / young, 2e-4, relative=True)
    stress = one.results.element("bar", "stress_xx")
    case.check(f"press, {name}: largest error of the stress over p", numpy.max(numpy.abs(stress / -1e5 - 1)), 0, 1e-3)
# The middle of the bar is a little heavier, so it swings a little more slowly: not quite six times fewer cycles.
case.check_within("press: cycles without scaling over those with it", free.history["cycle"][-1] / h["cycle"][-1], 5, 6.5)
case.same_bits("press", recipe, deck, run)
deck["time"]["mass_scaling"]["limit"] = 0.05
refused = case.attempt("press_beyond", recipe, deck)
case.check_equal("press, a limit that is too low: exit code", refused.code, 6)
case.check_equal("press, a limit that is too low: names block and key", "time.mass_scaling.limit = 0.05: block 'bar' 0.0" in refused.output, True)

# A body of equal elements: all masses grow by one ratio, (step / own step)^2. Gravity acts on the mass that it has by
# itself, so it falls by g / ratio; its velocity across stays what it is.
recipe, deck = case.load("mesh_flight.yaml"), case.load("deck_flight.yaml")
free = case.run("flight_free", recipe, deck)
own = free.history["dt"][1]
deck["time"]["mass_scaling"] = {"step": float(2 * own), "limit": 3.1}
run = case.run("flight", recipe, deck)
h = run.history
mass, t = density * 0.4 * 0.3 * 0.2, h["time"][-1]
case.check("flight: step over that without scaling", h["dt"][1] / own, 2, 1e-12)
case.check("flight: mass added [kg]", h["body_added_mass"][-1], 3 * mass, 1e-8, relative=True)
for axis, way in (("x", 3 * t), ("y", 2 * t), ("z", -0.5 * 10 / 4 * t**2)):
    case.check(f"flight: way along {axis} [m]", h[f"body_displacement_{axis}"][-1], way, 1e-7, relative=True)
case.check("flight: velocity along x [m/s]", h["body_velocity_x"][-1], 3, 1e-12, relative=True)
case.check("flight: momentum of what is added, along x [N s]", h["body_added_momentum_x"][-1], 3 * mass * 3, 1e-8, relative=True)
# At the start masses are 2.7e-8 below those of the end; why was not looked for.
case.check("flight: its kinetic energy at the start [J]", h["body_added_kinetic"][0], 0.5 * 3 * mass * 13, 1e-7, relative=True)
case.check("flight: kinetic energy at the start [J]", h["kinetic"][0], 0.5 * 4 * mass * 13, 1e-7, relative=True)
case.same_bits("flight", recipe, deck, run)

# Two bars meet: planes make nodes stiffer, and masses are raised in the run. What comes in moves with its node: it is
# booked as an impulse and as external work.
recipe, deck = case.load("mesh_meet.yaml"), case.load("deck_meet.yaml")
free = case.run("meet_free", recipe, deck)
step = 4 * numpy.min(free.history["dt"][1:])
deck["time"]["mass_scaling"] = {"step": float(step), "limit": 20}
run = case.run("meet", recipe, deck, energy=5e-3)
h = run.history
total = h["left_added_mass"] + h["right_added_mass"]
case.check_equal("meet: masses are raised in the run", bool(total[-1] > total[0] * 1.01), True)
case.check_equal("meet: masses never fall", bool(numpy.all(numpy.diff(total) >= -1e-12 * total[-1])), True)
case.check_equal("meet: the step is never below the given one", bool(numpy.min(h["dt"][1:-1]) >= step * (1 - 1e-12)), True)
case.check_equal("meet: the bars have met", bool(numpy.max(h["stick"] + h["slip"]) > 0), True)
case.check("meet: work of what is added, over the energy in play", (h["external_work"][-1]) / numpy.max(h["kinetic"]), 0, 0.5)
case.same_bits("meet", recipe, deck, run)

# Restarted on other ranks while masses are being raised, and rebalanced again and again: the same bits.
end, name = deck["time"]["end"], "meet_restarted"
first = {**deck, "time": {**deck["time"], "end": 0.3 * end}, "checkpoint": {"at_end": True}}
stopped = case.attempt(name, recipe, first)
case.check_equal("meet: exit code of the first part", stopped.code, 0)
documents.save({"mesh": "mesh.e", **deck}, f"{name}/run.yaml")
code, output = program.run_program(["run.yaml", "--restart"], name, ranks=2)
case.check_equal("meet: exit code of the restart", code, 0)
case.check_equal("meet: state hash of the restart", json.loads(pathlib.Path(name, "run.run-s0002.json").read_text())["state_hash"], run.state_hash)
again = case.attempt("meet_rebalanced", recipe, {**deck, "partition": {"rebalance": "always", "rebalance_every": 29}}, ranks=2)
case.check_equal("meet: state hash with rebalancing", again.state_hash, run.state_hash)

# Where waves should leave or enter, added mass sends them back.
recipe, deck = case.load("mesh_press.yaml"), case.load("deck_press.yaml")
deck["conditions"] = [{"type": "absorbing", "side_set": "right"}]
deck["time"] = {"end": 1e-4, "mass_scaling": {"step": float(2 * natural)}}
refused = case.attempt("waves", recipe, deck)
case.check_equal("absorbing side: exit code", refused.code, 3)
case.check_equal("absorbing side: the message says why and names the key", "sends them back" in refused.output and "with_waves" in refused.output, True)
deck["time"]["mass_scaling"]["with_waves"] = True
case.check_equal("absorbing side, with_waves: exit code", case.attempt("waves_forced", recipe, deck).code, 0)
case.finish()
