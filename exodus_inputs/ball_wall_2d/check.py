"""A ball against a dry wall: all energy is found, friction only takes; tests/verification/V57_ball_on_wall looks closer."""

import re

import numpy

from coplanetools import Example

example = Example()
h = example.history
# Bricks of 2 x 2 elements bend by their hourglass modes.
example.balances(hourglass=0.15)
masses = {name: float(value) for name, value in re.findall(r"block '(\w+)' .*mass (\S+) kg", example.run.output)}
start = float(h["ball_velocity_x"][0])
gained = masses["bricks"] * h["bricks_velocity_x"][-1] - h["impulse_x"][-1]
lost = masses["ball"] * (start - h["ball_velocity_x"][-1])
example.check("momentum that the ball lost, found in wall and base [N s]", float(gained), float(lost), 2e-3, relative=True)
example.check_within("smallest increment of friction work over the ball's energy", float(numpy.diff(h["contact_friction"]).min() / h["kinetic"][0]),
                     -1e-9, numpy.inf)
example.check_within("friction work over the ball's energy", float(h["contact_friction"][-1] / h["kinetic"][0]), 0.01, 1)
example.check_within("speed of the ball at the end over that at the start", float(h["ball_velocity_x"][-1]) / start, -1, 0.9)
example.check_within("planes deeper than the limit", int(h["too_deep"].max()), 0, 0)
example.finish()
