"""The left bar hands over all of its momentum: one-dimensional theory."""

from coplanetools import Example

example = Example()
example.balances()
example.check("velocity of the left bar at the end [m/s]", float(example.history["left_velocity_x"][-1]), 0, 0.01)
example.check("velocity of the right bar at the end [m/s]", float(example.history["right_velocity_x"][-1]), 2, 0.01)
example.finish()
