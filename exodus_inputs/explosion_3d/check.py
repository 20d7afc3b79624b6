"""What must be true of the explosion; docs/examples/explosion.md has the numbers."""

import numpy

from coplanetools import Example

example = Example()
h, results = example.history, example.results
# Gas strikes six walls flat, each all over in one step: an error of the step, 3.1 MJ as they meet, most of which comes back as they part.
example.balances(remainder=(-0.03, 0.03) if example.variant == "charge" else (-1e-3, 1e-3))

end = list(example.all_planes())[-1]
big = end["overlap"] > 0.01
distance = numpy.linalg.norm(end["Points"], axis=1)
slipped = end["slip"] > 1e-5
example.check_within("share of joints within 1.5 m that have slipped by more than 0.01 mm", float(slipped[big & (distance < 1.5)].mean()), 0.5, 1)
example.check_within("share of joints beyond 6 m that have", float(slipped[big & (distance > 6)].mean()), 0, 0.15)
example.check_within("longest slip [m]", float(max(h[f"{name}_largest_slip"].max() for name in ("bedding", "steep", "cross"))), 1e-4, 0.1)
friction = {name: h[f"{name}_friction"][-1] for name in ("bedding", "steep", "cross")}
source = "chemical" if example.variant == "charge" else "external_work"
example.check_within("work of friction over what the gas brings", float(sum(friction.values()) / h[source].max()), 0.005, 0.9)
if example.variant == "charge":
    # All of the TNT burns (7 GJ/m3 in 0.027 m3), and the products fill the chamber, which is 37 times as large as the charge.
    example.check_within("energy released over that of the charge", float(h["chemical"][-1] / (7e9 * 0.027)), 0.999, 1.001)
    example.check_within("volume of the products over that of the charge", float((1630 / results.element("charge", "density")).mean()), 33, 45)

# The model is symmetric about its three middle planes: so is the motion.
move, centre = results.nodal("displacement")[results.connectivity("rock")].mean(axis=1), results.centres("rock")
order = {tuple(numpy.round(place, 6)): i for i, place in enumerate(centre)}
for axis in range(3):
    sign = numpy.where(numpy.arange(3) == axis, -1, 1)
    partner = numpy.array([order[tuple(numpy.round(place, 6))] for place in centre * sign])
    error = numpy.abs(move - move[partner] * sign).max() / numpy.abs(move).max()
    example.check_within(f"asymmetry about {'xyz'[axis]} = 0 over the largest displacement", float(error), 0, 1e-9)

# The wave: nothing moves faster than the intact rock's pressure wave.
early = int(numpy.argmin(numpy.abs(results.times - 0.5e-3))) if example.size == "coarse" else int(numpy.argmin(numpy.abs(results.times - 1e-3)))
speed = numpy.linalg.norm(results.nodal("velocity", early), axis=1)
front = numpy.linalg.norm(results.coordinates, axis=1)
beyond = front > 0.87 + 5212.5 * results.times[early] * 1.02
if beyond.any():
    example.check_within("speed of what the wave cannot have reached, over the largest", float(speed[beyond].max() / speed.max()), 0, 0.005)
example.finish()
