"""What must be true of a pulse through two joint sets. All numbers are those of the deck and the recipes beside it."""

import math

import numpy

from coplanetools import Example, documents, waves

example = Example()
deck, recipe, joints = (documents.load(example.folder / name) for name in ("run.yaml", "mesh.yaml", "joints.yaml"))
rock, rough, part = deck["materials"]["granite"], deck["joints"]["rough"], recipe["parts"][0]
xx, yy, _, xy, *_ = deck["initial"][0]["stress"]
h, results = example.history, example.results

example.balances()
example.check_equal("searches, planes that slip, at most", (int(h["searches"].max()), int(h["slip"].max())), (1, 0))

# At the start every joint is closed by what the stress of the rock presses on it; and all of them stay.
start, *_, end = example.all_planes()
nx, ny = start["normal"][:, 0], start["normal"][:, 1]
closure = -(xx * nx**2 + yy * ny**2 + 2 * xy * nx * ny) / rough["normal_stiffness"]
error = numpy.abs(start["closure"] - closure).max() / closure.max()
example.check_within("closure at the start, off by, over the largest", float(error), 0, 1e-9)
whole = end["area"] > 0.9 * start["area"].min()  # corners of blocks overlap the next face but one by a hair
example.check_equal("joint faces at the start; at the end, and of them those that stick", [len(nx), int(whole.sum()), int((end["state"][whole] == 2).sum())],
                    [len(nx)] * 3)  # fmt: skip

# Until the middle feels the fixed sides, the pulse is a plane wave across the joints of one set. The exact solution for these knows
# nothing of the other set, whose joints let the rock give way sideways a little: 2 %.
poisson = rock["poisson_ratio"]
modulus = rock["youngs_modulus"] * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))
speed = math.sqrt(modulus / rock["density"])
length, height = part["size"]
spacing = joints["joints"]["steep"]["planes"]["spacing"]
turn = math.radians(part["rotate"])
along, across = numpy.array([math.cos(turn), math.sin(turn)]), numpy.array([-math.sin(turn), math.cos(turn)])
step, number = 1e-5, 1 << 13
fine = step * numpy.arange(number)
pulse = numpy.where(fine < 2.5e-3, 0.02 * numpy.sin(math.pi * fine / 2.5e-3), 0)
for place in (0.5 * spacing, 1.5 * spacing):  # before the first joint, and behind it
    nodes = numpy.linalg.norm(results.coordinates - place * along - height / 2 * across, axis=1) < 1e-6
    last = numpy.flatnonzero(results.times < math.hypot(place, height / 2) / speed)[-1]
    moved = float((results.nodal("displacement", last)[nodes] @ along).mean())
    velocity = waves.passed(fine, pulse, lambda f: waves.row_of_blocks(f, [place], round(length / spacing), rough["normal_stiffness"],
                                                                       rock["density"] * speed, speed, spacing)[0])  # fmt: skip
    exact = float(numpy.interp(results.times[last], fine, numpy.cumsum(velocity) * step))
    example.check(f"displacement at {place:g} m after {1e3 * results.times[last]:.2f} ms [m]", moved, exact, 0.04, relative=True)
example.finish()
