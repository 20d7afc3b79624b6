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

# --- friction that falls while it slips: a saw tooth ------------------------------------------------
# Block and spring swing about the force of fast slip: from mu_s N the force falls as far below mu_d N as it was above, to
# (2 mu_d - mu_s) N, sticks there, and grows again with stiffness times speed.
mass, rest, fast, speed, spring = 2e4 * 0.4 * 0.004, 0.7, 0.5, 3e-3, 1e6
weight = 2 * mass * g
deck = case.load()
deck["materials"]["stone"].update(density=2e4, youngs_modulus=1e9)
deck["joints"]["rough"] = {"model": "linear", "normal_stiffness": 1e9, "shear_stiffness": 1e11, "friction": rest,
                           "dynamic_friction": fast, "slip_speed": 5e-4}
deck["joints"]["spring"].update(normal_stiffness=1e8, shear_stiffness=spring)
deck["conditions"][1]["value"][0] = f"t < {start} ? 0 : {speed}"
deck["damping"] = {"mass": 1000, "until": 0.011}
deck["time"] = {"end": 1.0}
deck["output"] = {"every": 5e-4, "planes": False}
run = case.run("saw_tooth", case.load("mesh_flat.yaml"), deck)
results = run.results
nodes = results.nodes_of("driver")
t = results.times
pull = -numpy.array([results.nodal("contact_force", step)[nodes, 0].sum() for step in range(len(t))])
highest = [i for i in range(1, len(pull) - 1) if pull[i] > pull[i - 1] and pull[i] >= pull[i + 1] and pull[i] > 0.6 * weight]
lowest = [i for i in range(1, len(pull) - 1) if pull[i] < pull[i - 1] and pull[i] <= pull[i + 1] and t[i] > t[highest[0]] and pull[i] < 0.4 * weight]
case.check_equal("saw tooth: teeth", (len(highest), len(lowest)), (3, 3))
# Within 3 % of the strength at rest: the law falls over a speed of 0.5 mm/s, and block and joint keep ringing a little.
for i, (up, down) in enumerate(zip(highest, lowest)):
    case.check(f"saw tooth: force before slip {i + 1} over weight", pull[up] / weight, rest, 0.03 * rest)
    case.check(f"saw tooth: force after slip {i + 1} over weight", pull[down] / weight, 2 * fast - rest, 0.03 * rest)
grows = 1 / (1 / (spring * area) + 1 / (1e11 * area)) * speed / weight  # [1/s]
for i in (0, 1):
    between = (t > t[lowest[i]] + 0.01) & (t < t[highest[i + 1]] - 0.01)
    case.check(f"saw tooth: growth of the force before slip {i + 2} over weight [1/s]", numpy.polyfit(t[between], pull[between], 1)[0] / weight,
               grows, 0.01, relative=True)
case.finish()
