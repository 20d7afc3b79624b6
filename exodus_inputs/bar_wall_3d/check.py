"""What must be true of the bar and the wall; docs/examples/bar-wall.md has the numbers.

Slivers may be deeper than the limit of penetration: where a brick turns, its front and the end of a brick in the next course oppose
each other a little, and a joint that is closed by a hair gives them a sliver of area. So planes count from 1 % of a face on.
"""

import numpy

from coplanetools import Example, documents

example = Example()
h, results = example.history, example.results
recipe = documents.load(example.folder / "mesh.yaml")["parts"][0]
size = recipe["brick"][0] / recipe["divisions"][0]
start, whole = h["initial"][-1], h["time"][-1] > 0.04

example.balances()
example.check_within("deepest penetration on more than 1 % of a face, over h", example.deepest(0.01 * size**2) / size, 0, 0.3)
bricks, courses = recipe["divisions"], recipe["courses"]
beds = (courses - 1) * 2 * recipe["length_in_bricks"] * (bricks[0] // 2) * bricks[2]
heads = (courses // 2) * (2 * recipe["length_in_bricks"] - 1) * bricks[1] * bricks[2]
example.check_equal("planes at t = 0: every face of every joint", int(h["planes"][0]), beds + heads)

forward = h["bar_velocity_z"]
fast, slow = (60, 5) if example.variant != "B" else (69, 20)
if whole:
    example.check_within("forward speed of the bar at the end [m/s]", float(forward[-1]), slow, fast)
example.check_within("largest gain of forward speed between two records [m/s]", float(numpy.diff(forward).max()), -5, 0.5)
example.check_within("friction work over initial energy", float(h["contact_friction"][-1] / start), 0.001, 0.9)
example.check_within("work of damage and plastic flow over initial energy", float(h["plastic"][-1] / start), 0.005, 0.9)
example.check_within("largest plastic strain of the bar", float(results.element("bar", "equivalent_plastic_strain").max()), 0, 0.05)

moved = results.nodal("displacement_z")
x, y, z = results.coordinates.T[:3]
nodes = results.nodes_of("bricks")
x, y, moved = x[nodes], y[nodes], moved[nodes]
middle = (numpy.abs(x) < 1) & (y > 2.2) & (y < 3.8)
corners = (numpy.abs(x) > 2.5) & (y < 1)
if whole:
    example.check_within("largest forward motion of bricks in the middle [m]", float(moved[middle].max()), 0.2, 10)
    example.check_within("motion of bricks at the lower corners [m]", float(numpy.abs(moved[corners]).max()), 0, 0.3)
    velocity = results.nodal("velocity_z")[nodes]
    example.check_within("fastest brick near the hole [m/s]", float(velocity[middle].max()), 5, 200)

# Damage starts where the bar strikes.
step = int(numpy.argmin(numpy.abs(results.times - 1.3e-3)))
damage, centre = results.element("bricks", "damage", step), results.centres("bricks")
near = (numpy.abs(centre[:, 0]) < 0.5) & (numpy.abs(centre[:, 1] - 3.25) < 0.5)
# With full integration it is the mean of eight points, and may round to a bit more than 1.
example.check_within("largest damage at the point of impact at 1.3 ms", float(damage[near].max()), 0.9, 1 + 1e-12)
ends = (numpy.abs(centre[:, 0]) > 2.5) & (centre[:, 1] < 1)
example.check_within("mean damage at the lower corners at 1.3 ms", float(damage[ends].mean()), 0, 0.2)
# The pressure wave, 3993 m/s, has reached all of the wall by then: 3.2 m take 0.8 ms.
stirred = numpy.linalg.norm(results.nodal("velocity", step), axis=1)[nodes]
example.check_within("share of the wall's nodes that move by then (> 1 mm/s)", float((stirred > 1e-3).mean()), 0.8, 1)
example.finish()
