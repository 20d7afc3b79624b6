"""V57: a steel ball hits a dry brick wall; momentum and energy are accounted for, friction only takes."""

import re

import numpy
from coplanetest import Case

case = Case("V57", __file__)
recipe, deck = (case.load(f"exodus_inputs/ball_wall_2d/{name}.yaml") for name in ("mesh", "deck"))
run = case.run("hit", recipe, deck)
beginning = {**deck, "time": {"end": 5e-4}}
case.same_bits("beginning", recipe, beginning, case.run("beginning", recipe, beginning))
h = run.history
energy = h["kinetic"][0]
masses = {name: float(value) for name, value in re.findall(r"block '(\w+)' .*mass (\S+) kg", run.output)}
case.check("mass of the ball [kg]", masses["ball"], 50, 0.05, relative=True)
case.check("energy at the start [J]", energy, masses["ball"] * 25 / 2, 1e-6, relative=True)
# What the ball loses the bricks and the base get: the impulse of the fixed base and of gravity is recorded.
gained = masses["bricks"] * h["bricks_velocity_x"][-1] - h["impulse_x"][-1]
lost = masses["ball"] * (5 - h["ball_velocity_x"][-1])
case.check("momentum that the ball lost, found in the wall and the base [N s]", gained, lost, 1e-3, relative=True)
case.check_within("speed of the ball at the end [m/s]", h["ball_velocity_x"][-1], -5, 4.5)
case.check_within("friction work over the energy of the ball", h["contact_friction"][-1] / energy, 0.01, 1)
case.check("smallest increment of friction work, not negative [J]", min(0, numpy.min(numpy.diff(h["contact_friction"]))), 0, 1e-12)
case.check_within("contact remainder over the energy of the ball", h["contact_remainder"][-1] / energy, -1e-3, 0.05)
total = sum(h[name] for name in ("kinetic", "internal", "hourglass", "viscous", "contact_stored", "contact_friction", "contact_remainder"))
case.check("sum of all terms less external work over the energy of the ball, worst",
           numpy.max(numpy.abs(total - h["external_work"] - energy)) / energy, 0, 0.01)
case.check("planes deeper than the limit", int(numpy.max(h["too_deep"])), 0, 0)
case.finish()
