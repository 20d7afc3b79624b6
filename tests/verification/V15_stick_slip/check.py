"""V15: a slowly pulled block sticks while the force grows, then slips under constant friction."""

import numpy
from coplanetest import Case

case = Case("V15", __file__)
g, area, friction, speed, start = 9.81, 0.4, 0.5, 2e-4, 0.012
weight = 2000 * (0.4 * 0.1 + 0.4 * 0.05) * g  # of block and driver, per metre of depth [N]
# Spring, joint and the block's own shear in series [N/m]: k_s A, k_s A, G A / h.
stiffness = 1 / (1 / (1e8 * area) + 1 / (1e10 * area) + 1 / (25e9 * area / 0.1))

recipe, deck = case.load("mesh.yaml"), case.load()
run = case.run("constant", recipe, deck)
beginning = {**deck, "time": {"end": 0.01}}
case.same_bits("beginning", recipe, beginning, case.run("beginning", recipe, beginning))
h, results = run.history, run.results
nodes = results.nodes_of("slab")
t = results.times
force = numpy.array([results.nodal("contact_force", step)[nodes].sum(axis=0) for step in range(len(t))])
settled = (t > 0.011)
case.check("normal force on the slab [N]", -numpy.mean(force[settled, 1]), weight, 1e-3, relative=True)
strength = friction * weight
# The pull acts at the top of the block, so its leading edge carries more; the trailing edge begins to slip at 0.57 of the strength.
ramp = settled & (force[:, 0] > 0.1 * strength) & (force[:, 0] < 0.5 * strength) & (t < start + strength / (stiffness * speed))
slope = numpy.polyfit(t[ramp], force[ramp, 0], 1)[0]
case.check_within("moments in the ramp", int(numpy.sum(ramp)), 10, 1000)
case.check("rate of the force while all sticks [N/s]", slope, stiffness * speed, 0.01, relative=True)
slipping = t > start + 1.2 * strength / (stiffness * speed)
case.check_within("moments of slip", int(numpy.sum(slipping)), 15, 1000)
case.check("force while it slips, largest [N]", numpy.max(force[slipping, 0]), strength, 1e-3, relative=True)
case.check("force while it slips, mean [N]", numpy.mean(force[slipping, 0]), strength, 1e-3, relative=True)
late = h["time"] > start + 1.2 * strength / (stiffness * speed)
slid = h["block_displacement_x"][late][-1] - h["block_displacement_x"][late][0]
work = h["contact_friction"][late][-1] - h["contact_friction"][late][0]
case.check("friction work over distance slid [N]", work / slid, strength, 0.01, relative=True)
case.finish()
