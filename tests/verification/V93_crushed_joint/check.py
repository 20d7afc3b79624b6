"""V93: a mortar joint between two blocks is crushed, unloaded, crushed again, sheared and tilted. The blocks move as rigid bodies."""

import copy
import math
import pathlib
import re
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
    # What is not bonded takes the crushing that the last cycle left: a cycle of 2e-7 m raises the traction by k_n times that.
    case.check(f"{name}: traction against the curve, over the strength", error, 0, 2.5e-3)
    case.check(f"{name}: largest traction [Pa]", sigma[:, 1].max(), f_m, 2e-3, relative=True)
    most = crushing(closure.max())
    lost = (work(most) - 0.5 * loss * strength(most) * most) * areas[dimension]
    case.check(f"{name}: hysteresis at the end [J]", h["contact_hysteresis"][-1], lost, 6e-3, relative=True)
    loses_little(name, h, 1e-3)

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
        case.check(f"{name}: beyond the ellipse", max(ellipse.max() / f_m - 1, 0), 0, 5e-3)
        beyond = tau - card["friction"] * sigma - (card["cohesion"] if bonded else 0)
        case.check(f"{name}: shear beyond friction and cohesion, over the strength", max(beyond.max(), 0) / f_m, 0, 5e-3)
        loses_little(name, h, 2e-3)

# --- a toe: the joint is pressed at one end -----------------------------------------------------------------------------------

for dimension in (2, 3):
    for bonded in (True, False) if full else (dimension == 3,):
        name = f"tilted_{'bonded' if bonded else 'dry'}_{dimension}d"
        deck = changed(through([0, 4e-4, 2e-4, 1.5e-3, 0]), bonded, tilted=True, stiffness_loss=0.3)
        run = case.run(name, meshes[dimension], deck, **rounding)
        loses_little(name, run.history, 5e-3)
        case.same_bits(name, meshes[dimension], deck, run)
        middle = [*"--set time.end=0.0241 --set checkpoint.at_end=true".split()]
        part = case.attempt(f"{name}_stopped", meshes[dimension], deck, 2, options=middle)
        code, output = program.run_program(["run.yaml", "--restart"], part.folder, 1)
        case.check_equal(f"{name}: exit codes of the parts", [part.code, code], [0, 0])
        case.check_equal(f"{name}: history of the parts differs", part.bytes_of("run.csv") != run.bytes_of("run.csv"), False)
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

# --- an impact that crushes the joint within some cycles is warned of, and not in small steps --------------------------------------

falling = {"dimension": 2, "node_sets": {"ground": {"block": "lower", "where": {"y": -0.1}}}, "parts": [
    {"shape": "box", "block": "lower", "min": [-0.2, -0.1], "size": [0.4, 0.1], "divisions": [8, 2]},
    {"shape": "box", "block": "upper", "min": [-0.1, 1e-4], "size": [0.2, 0.1], "divisions": [4, 2]}]}  # fmt: skip
said = {}
for factor, ranks in ((0.8, 1), (0.8, 2), (0.05, 1)):
    name = f"a brick falls, step_factor {factor}, {ranks} ranks"
    deck = {"materials": base["materials"], "blocks": base["blocks"], "initial": [{"block": "upper", "velocity": [0, -10, 0]}],
            "conditions": [{"type": "fixed", "node_set": "ground"}], "joints": {"bed": {**card, "shear_in_crushing": 0}}, "contact": {"default_joint": "bed"},
            "time": {"end": 1e-3, "step_factor": factor}}  # fmt: skip
    run = case.attempt(f"falls_{factor}_{ranks}", falling, deck, ranks=ranks)
    case.check_equal(f"{name}: exit code", run.code, 0)
    said[factor, ranks] = re.findall(r"WARNING: .* to be crushed, .*(?:\n  plane between .* times what its law takes)+", run.output)
    case.check_equal(f"{name}: warnings, with the worst planes", len(said[factor, ranks]), int(factor == 0.8))
case.check_equal("a brick falls: the same warning on one rank and two", said[0.8, 1] == said[0.8, 2], True)
warned = sorted(path.parent.name for path in pathlib.Path().glob("*/output.txt") if "to be crushed" in path.read_text())
case.check_equal("other runs with this warning", [name for name in warned if not name.startswith("falls_0.8")], [])

case.finish()
