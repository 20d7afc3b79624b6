"""V93: a mortar joint between two blocks is crushed, unloaded, crushed again, sheared and tilted. The blocks move as rigid bodies."""

import copy
import math
import sys

import numpy
from coplanetest import Case, program

case = Case("V93", __file__)
full = "all" in sys.argv[1:]
meshes = {2: case.load("mesh.yaml"), 3: case.load("mesh_3d.yaml")}
# Supports that press with up to 1e6 N for 0.1 s give 1e5 times the momentum of the blocks; rounding is relative to that.
rounding = {"momentum": 1e-8, "angular": 1e-9}
areas = {2: 0.1, 3: 0.01}  # [m^2]; per metre of depth in two dimensions
base = case.load()
card = base["joints"]["bed"]
f_m, G, k_p, kn, ks = (card[key] for key in ("compressive_strength", "compression_energy", "peak_crushing", "normal_stiffness", "shear_stiffness"))
length = G / f_m / (5 / 6 - 0.1 + 0.4**2)  # 75 / 67 G / f_m


def strength(k):
    """f(k): a parabola from a third, a parabola to a half, an exponential to a tenth of the strength."""
    if k <= k_p:
        return f_m * (1 / 3 + 2 / 3 * math.sqrt(2 * k / k_p - (k / k_p) ** 2))
    if k <= k_p + length:
        return f_m * (1 - 0.5 * ((k - k_p) / length) ** 2)
    return f_m * (0.1 + 0.4 * math.exp(-(k - k_p - length) / (0.4 * length)))


def work(k):
    """Of the inelastic closure [J/m^2]."""
    x = numpy.linspace(0, 1, 200001) ** 2 * k  # the curve starts vertically
    f = numpy.array([strength(one) for one in x])
    return float(numpy.sum(0.5 * (f[1:] + f[:-1]) * numpy.diff(x)))


def crushing(closure):
    """k of first loading to a closure, by halving k + f(k) / k_n = closure."""
    low, high = 0.0, closure
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if middle + strength(middle) / kn < closure else (low, middle)
    return low if closure > f_m / 3 / kn else 0.0


def law(closures, loss):
    """Compression along a path of closures."""
    most, tractions = 0.0, []
    for c in closures:
        most = max(most, c)
        k = crushing(most)
        if k == 0:
            tractions.append(max(0.0, kn * c))
            continue
        f, rest = strength(k), (1 - loss) * k
        tractions.append(max(0.0, f * (c - rest) / (most - rest)))
    return numpy.array(tractions)


def changed(legs, bonded=True, tilted=False, forces="potential", **joint):
    """The deck with the upper block moved through legs of constant velocity, [(vx, vy, duration)]; tilted: its left end stays."""
    deck = copy.deepcopy(base)
    deck["joints"]["bed"].update(joint)
    deck["contact"]["pairs"][0]["declared"] = bonded
    deck["contact"]["forces"] = forces
    expressions = []
    for axis in (0, 1):
        text, end = "0", sum(leg[2] for leg in legs)
        for leg in reversed(legs):
            text = f"t < {end!r} ? {leg[axis]!r} : ({text})"
            end -= leg[2]
        expressions.append(text)
    deck["conditions"].append({"type": "velocity", "node_set": "right" if tilted else "upper", "value": expressions + [0]})
    if tilted:
        deck["conditions"].append({"type": "fixed", "node_set": "left"})
    deck["time"]["end"] = sum(leg[2] for leg in legs)
    return deck


def through(closures, speed=0.05):
    return [(0, -math.copysign(speed, b - a), abs(b - a) / speed) for a, b in zip(closures, closures[1:])]


def tractions(run, dimension):
    """Contact force on the upper block over the area, at the times of the results; rows of the history at these times."""
    upper = run.results.nodes_of("upper")
    force = numpy.array([run.results.nodal("contact_force", s)[upper].sum(axis=0) for s in range(len(run.results.times))])
    return force / areas[dimension], numpy.searchsorted(run.history["time"], run.results.times * (1 - 1e-12))


def loses_little(name, h, tolerance):
    """Of the contact's own balance, and nothing that was lost comes back."""
    case.check(f"{name}: remainder over the work", numpy.max(numpy.abs(h["contact_remainder"])) / numpy.max(h["external_work"]), 0, tolerance)
    lost = h["contact_hysteresis"]
    case.check(f"{name}: hysteresis that came back, over all", min(numpy.min(numpy.diff(lost)), 0) / lost[-1], 0, 1e-12)


# --- crushed in three strokes --------------------------------------------------------------------------------------------

# Closures: while it hardens, while it softens, to what is left. Bonds are not pulled open between: what opens stays between the faces.
path = [0, 1.2e-4, 6e-5, 7e-4, 6.5e-4, 2.5e-3, 0]
runs = [("bonded_half_lost", 2, {"stiffness_loss": 0.5}), ("bonded", 3, {}), ("dry_half_lost", 3, {"bonded": False, "stiffness_loss": 0.5}),
        ("common_normal", 2, {"forces": "common_normal", "stiffness_loss": 0.5})]
if full:
    runs += [("bonded", 2, {}), ("dry", 2, {"bonded": False}), ("dry_half_lost", 2, {"bonded": False, "stiffness_loss": 0.5})]
kept = {}
for what, dimension, options in runs:
    name, loss = f"{what}_{dimension}d", options.get("stiffness_loss", 0)
    deck = changed(through(path), **options)
    kept[name] = run = case.run(name, meshes[dimension], deck, **rounding)
    h = run.history
    sigma, rows = tractions(run, dimension)
    closure = -h["upper_displacement_y"]
    expected = law(closure, loss)
    pressed = expected[rows] > 0  # apart, the bond pulls
    error = numpy.max(numpy.abs(sigma[pressed, 1] - expected[rows][pressed])) / f_m
    case.check(f"{name}: traction against the curve, over the strength", error, 0, 1e-8)
    case.check(f"{name}: largest traction [Pa]", sigma[:, 1].max(), f_m, 1e-4, relative=True)
    most = crushing(closure.max())
    lost = (work(most) - 0.5 * loss * strength(most) * most) * areas[dimension]
    case.check(f"{name}: hysteresis at the end [J]", h["contact_hysteresis"][-1], lost, 1e-6, relative=True)
    loses_little(name, h, 1e-5)

# --- pressed and sheared ----------------------------------------------------------------------------------------------------

for bonded in (True, False):
    for part in (0.2, 0.6, 0.85) if full else (0.2, 0.85):
        x = max((part - 1 / 3) * 1.5, 0)
        pressing = part * f_m / kn + k_p * (1 - math.sqrt(1 - x * x))
        name = f"sheared_{'bonded' if bonded else 'dry'}_{part}"
        run = case.run(name, meshes[2], changed([(0, -0.05, pressing / 0.05), (0.05, 0, 0.03)], bonded), **rounding)
        h = run.history
        force, _ = tractions(run, 2)
        sigma, tau = force[:, 1], -force[:, 0]
        ellipse = numpy.sqrt(sigma**2 + 9 * tau**2)
        strong = card["friction"] * part * f_m + (card["cohesion"] if bonded else 0)
        if strong > math.sqrt(1 - part**2) / 3 * f_m:
            case.check(f"{name}: largest ellipse of the tractions [Pa]", ellipse.max(), f_m, 0.01, relative=True)
        else:  # friction is met first, at the compression that hardening has left
            at = int(numpy.argmax(tau))
            case.check(f"{name}: largest shear [Pa]", tau[at], card["friction"] * sigma[at] + strong - card["friction"] * part * f_m, 0.02, relative=True)
            case.check_within(f"{name}: largest ellipse over the strength", ellipse.max() / f_m, 1 / 3, 0.7)
        case.check(f"{name}: beyond the ellipse", max(ellipse.max() / f_m - 1, 0), 0, 1e-6)
        beyond = tau - card["friction"] * sigma - (card["cohesion"] if bonded else 0)
        case.check(f"{name}: shear beyond friction and cohesion, over the strength", max(beyond.max(), 0) / f_m, 0, 5e-3)
        loses_little(name, h, 1e-5)

# --- pressed deep, lifted a little and slid on: the bed ahead is met nowhere anew ----------------------------------------------

for far in (0.015, 0.1):
    name = f"slid_{far}"
    mesh = copy.deepcopy(meshes[2])
    mesh["parts"][0].update(size=[0.28, 0.1], divisions=[7, 1])
    deck = changed([(0, -0.05, 0.06), (0, 0.05, 0.008), (5, 0, far / 5), (0, -0.05, 0.014)], bonded=False, shear_in_crushing=0, friction=0, cohesion=0)
    run = case.run(name, mesh, deck, **rounding)
    h = run.history
    loses_little(name, h, 1e-5)
    sigma, _ = tractions(run, 2)
    slides = (run.results.times > 0.068) & (run.results.times < 0.068 + far / 5)
    case.check(f"{name}: traction while it slides, over the strength", numpy.max(numpy.abs(sigma[slides])) / f_m, 0, 1e-9)
    case.check(f"{name}: traction at the end [Pa]", sigma[-1, 1], law([3e-3, 3.3e-3], 0)[-1], 1e-2, relative=True)
deck = changed([(0, -0.5, 0.006), (0, 0.5, 8e-4), (5, 0, 0.005), (0, -0.5, 1.4e-3)], bonded=False, shear_in_crushing=0, friction=0, cohesion=0)
run = case.run("slid_fast", mesh, deck, **rounding)
case.same_bits("slid_fast", mesh, deck, run, ranks=3)
case.restarts("slid_fast", mesh, deck, run, 0.0078)

# --- a toe: the joint is pressed at one end -----------------------------------------------------------------------------------

for dimension in (2, 3):
    for bonded in (True, False) if full else (dimension == 3,):
        name = f"tilted_{'bonded' if bonded else 'dry'}_{dimension}d"
        deck = changed(through([0, 4e-4, 2e-4, 1.5e-3, 0]), bonded, tilted=True, stiffness_loss=0.3)
        run = case.run(name, meshes[dimension], deck, **rounding)
        loses_little(name, run.history, 1e-3)
        name = f"{name}_fast"
        deck = changed(through([0, 4e-4, 2e-4, 1.5e-3, 0], 0.5), bonded, tilted=True, stiffness_loss=0.3)
        run = case.run(name, meshes[dimension], deck, **rounding)
        case.same_bits(name, meshes[dimension], deck, run)
        middle = [*"--set time.end=0.00241 --set checkpoint.at_end=true".split()]
        part = case.attempt(f"{name}_stopped", meshes[dimension], deck, 2, options=middle)
        code, output = program.run_program(["run.yaml", "--restart"], part.folder, 1)
        case.check_equal(f"{name}: exit codes of the parts", [part.code, code], [0, 0])
        case.check_equal(f"{name}: history of the parts differs", part.bytes_of("run.csv") != run.bytes_of("run.csv"), False)
# --- bricks that strike a bed tilted ----------------------------------------------------------------------------------------------

wide, tall, deep = 0.25, 0.12, 0.12  # [m]; in two dimensions 1 m deep
curve = numpy.concatenate([k_p * numpy.linspace(0, 1, 2000) ** 2, numpy.geomspace(k_p, 0.1, 4000)[1:]])
curve_closures = curve + numpy.array([strength(k) for k in curve]) / kn


def struck(dimension, tilt, velocity, end, many):
    """Velocity upwards and spins about x and z of a rigid brick that falls on springs, beside each other on the bed, each with the law of first loading.
    tilt: about x and z [degrees]."""
    places = [(numpy.arange(many) + 0.5) / many - 0.5, (numpy.arange(many // 2) + 0.5) / (many // 2) - 0.5 if dimension == 3 else numpy.zeros(1)]
    x, z = (a.ravel() for a in numpy.meshgrid(wide * places[0], deep * places[1], indexing="ij"))
    depth = deep if dimension == 3 else 1
    part, mass = wide * depth / x.size, base["materials"]["stone"]["density"] * wide * tall * depth
    inertia = mass / 12 * numpy.array([tall**2 + deep**2, wide**2 + tall**2])
    turned, spin, up = numpy.radians(tilt), numpy.zeros(2), -velocity
    most = (0.5 * wide * abs(math.tan(turned[1])) + (0.5 * deep * abs(math.tan(turned[0])) if dimension == 3 else 0)) + 1e-4
    height = most + 0.5 * tall * math.cos(turned[0]) * math.cos(turned[1])  # of the centre
    crushed, step = numpy.zeros(x.size), 2e-6
    for _ in range(round(end / step)):
        cosines, tangents = numpy.cos(turned), numpy.tan(turned)
        off_x, off_z = x - 0.5 * tall * math.sin(turned[1]), z + 0.5 * tall * math.sin(turned[0])  # from the middle of the bottom
        closures = 0.5 * tall * cosines[0] * cosines[1] - height - off_x * tangents[1] + off_z * tangents[0]
        over = numpy.abs(off_x) <= 0.5 * wide * cosines[1]
        if dimension == 3:
            over &= numpy.abs(off_z) <= 0.5 * deep * cosines[0]
        crushed = numpy.where(over, numpy.maximum(crushed, numpy.interp(closures, curve_closures, curve)), crushed)
        forces = part * kn * over * numpy.maximum(closures - crushed, 0)
        up += step * forces.sum() / mass
        spin += step / inertia * numpy.array([-(forces * z).sum(), (forces * x).sum()])
        turned = turned + step * spin
        height += step * up
    return up, spin[0], spin[1]


def brick_over(dimension, faces, tilt, blocks=("floor", "brick"), side=1):
    """Recipe of a brick over a bed, both with so many faces a side; side -1: mirrored in x."""
    about_x, about_z = math.radians(tilt[0]), math.radians(tilt[1])
    low = min(math.sin(about_z) * x + math.cos(about_z) * (-0.5 * tall * math.cos(about_x) - math.sin(about_x) * z)
              for x in (-0.5 * wide, 0.5 * wide) for z in ((-0.5 * deep, 0.5 * deep) if dimension == 3 else (0,)))  # fmt: skip
    flat = dimension == 2
    parts = {"floor": {"min": [-0.5 * wide, -0.1], "size": [wide, 0.1]},
             "brick": {"min": [-0.5 * wide, -0.5 * tall], "size": [wide, tall], "about": [0, 0] if flat else [0, 0, 0],
                       "rotate": side * tilt[1] if flat else [tilt[0], 0, side * tilt[1]], "offset": [0, 1e-4 - low] if flat else [0, 1e-4 - low, 0]}}  # fmt: skip
    for name, part in parts.items():
        part.update(shape="box", block=name, divisions=[faces, 1] if flat else [faces, 1, faces])
        if not flat:
            part["min"], part["size"] = [*part["min"], -0.5 * deep], [*part["size"], deep]
    return {"dimension": dimension, "parts": [parts[name] for name in blocks]}


def falling_brick(velocity, end):
    joint = {**card, "friction": 0, "cohesion": 0, "shear_in_crushing": 0}
    return {"materials": base["materials"], "blocks": {name: {"material": "stone", "rigid": True} for name in ("floor", "brick")}, "joints": {"bed": joint},
            "contact": {"default_joint": "bed"}, "initial": [{"block": "brick", "velocity": [0, -velocity, 0]}],
            "conditions": [{"type": "rigid_motion", "block": "floor", "velocity": [0, 0, 0], "angular_velocity": [0, 0, 0]}],
            "time": {"end": end, "fixed_step": 5e-6}, "output": {"every": end, "planes": False}, "history": {"every": end / 100, "rigid": ["brick"]}}  # fmt: skip


def motion(run):
    """Velocity upwards, and of ends by the spins about x and z."""
    h = run.history
    return numpy.array([h["brick_velocity_y"][-1], 0.5 * deep * h["brick_spin_x"][-1], 0.5 * wide * h["brick_spin_z"][-1]])


strikes = {2: [((0, 0.2), 4, 0.004), ((0, 1), 4, 0.004), ((0, 3), 4, 0.006), ((0, 1), 10, 0.005), ((0, 0.5), 2, 0.006)],
           3: [((0.2, 0.3), 4, 0.004), ((1, 2), 4, 0.005), ((2, 1), 10, 0.005)]}  # fmt: skip
allowed = {2: {1: 0.25, 2: 0.03, 4: 0.02}, 3: {1: 0.2, 2: 0.05, 4: 0.02}}
for dimension, runs in strikes.items():
    errors = {1: [], 2: [], 4: []}
    for tilt, velocity, end in runs:
        up, about_x, about_z = struck(dimension, tilt, velocity, end, 1000 if dimension == 2 else 80)
        expected = numpy.array([up, 0.5 * deep * about_x, 0.5 * wide * about_z])
        for faces in errors:
            name = f"strikes_{dimension}d_{tilt[0]}_{tilt[1]}_{velocity}_{faces}"
            # One face: when its second end is crushed, its middle is at once, which a step does not resolve.
            run = case.run(name, brick_over(dimension, faces, tilt), falling_brick(velocity, end), remainder=2e-3 if faces > 1 else 1e-2)
            errors[faces].append(numpy.sum(numpy.abs(motion(run) - expected)) / (dimension * velocity))
    for faces, of in errors.items():
        case.check(f"bricks strike tilted, {dimension}d, {faces} faces a side: mean error of velocities over that of the impact", numpy.mean(of), 0, allowed[dimension][faces])

for dimension, tilt, faces in ((2, (0, 1), 2), (3, (1, 2), 2)):
    name, velocity = f"strikes_again_{dimension}d", 4
    recipe, deck = brick_over(dimension, faces, tilt), falling_brick(velocity, 0.004)
    run = case.run(name, recipe, deck, remainder=2e-3)
    case.same_bits(name, recipe, deck, run)
    case.restarts(name, recipe, deck, run, 0.002)
    side = case.run(f"{name}_mirrored", brick_over(dimension, faces, tilt, side=-1), deck, remainder=2e-3)
    # A mirror keeps the spin about the axis across it and turns that along it over.
    case.check(f"{name}: mirrored, over the speed", numpy.max(numpy.abs(motion(side) - motion(run) * (1, 1, -1))) / velocity, 0, 1e-6)
    other = case.run(f"{name}_other_order", brick_over(dimension, faces, tilt, blocks=("brick", "floor")), deck, remainder=2e-3)
    case.check(f"{name}: the brick carries the crushing, over the speed", numpy.max(numpy.abs(motion(other) - motion(run))) / velocity, 0, 0.01 if dimension == 2 else 0.04)

# --- initial stress within the strength and beyond it ---------------------------------------------------------------------------

for factor in (0.9, 1.2):
    name = f"initial_{factor}"
    deck = changed([(0, 0, 1e-4)])
    deck["output"] = {"every": 1}
    deck["initial"] = [{"block": block, "stress": [0, -factor * f_m, 0, 0, 0, 0]} for block in deck["blocks"]]
    for ranks in (1, 2):
        run = case.attempt(f"{name}_{ranks}", meshes[2], deck, ranks=ranks)
        case.check_equal(f"{name}, {ranks} ranks: exit code", run.code, 0)
        case.check(f"{name}, {ranks} ranks: traction at the start [Pa]", numpy.max(numpy.abs(run.planes(0)["normal_traction"] - min(factor, 1) * f_m)), 0, 1e-9 * f_m)
        warned = f"{len(run.planes(0)['closure'])} planes of declared joints are under more initial compression"
        case.check_equal(f"{name}, {ranks} ranks: warning", warned in run.output, factor > 1)

# --- an impact that crushes the joint within some cycles takes what its law takes, whatever the step and the loss of stiffness ---------

falling = {"dimension": 2, "node_sets": {"ground": {"block": "lower", "where": {"y": -0.1}}}, "parts": [
    {"shape": "box", "block": "lower", "min": [-0.2, -0.1], "size": [0.4, 0.1], "divisions": [8, 2]},
    {"shape": "box", "block": "upper", "min": [-0.1, 1e-4], "size": [0.2, 0.1], "divisions": [4, 2]}]}  # fmt: skip
taken = {}
for factor, loss in ((0.8, 0.01), (0.05, 0.01), (0.8, 0), (0.8, 0.5), (0.05, 0.5)):
    name = f"a brick falls, stiffness_loss {loss}, step_factor {factor}"
    deck = {"materials": base["materials"], "blocks": base["blocks"], "initial": [{"block": "upper", "velocity": [0, -10, 0]}],
            "conditions": [{"type": "fixed", "node_set": "ground"}], "joints": {"bed": {**card, "shear_in_crushing": 0, "stiffness_loss": loss}},
            "contact": {"default_joint": "bed"}, "time": {"end": 1e-3, "step_factor": factor}}  # fmt: skip
    h = case.run(f"falls_{factor}_{loss}", falling, deck, remainder=0.01, momentum=1e-10, angular=1e-9).history
    taken[factor, loss] = h["contact_hysteresis"][-1] / h["kinetic"][0]
    case.check(f"{name}: remainder over the energy", numpy.max(numpy.abs(h["contact_remainder"])) / h["kinetic"][0], 0, 8e-3 if factor == 0.8 else 1e-4)
for loss in (0.01, 0.5):
    case.check(f"a brick falls, stiffness_loss {loss}: hysteresis with step_factor 0.8 over that with 0.05", taken[0.8, loss] / taken[0.05, loss], 1, 5e-3)

case.finish()
