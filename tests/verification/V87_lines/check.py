"""V87: bolts and bars that cross blocks: pulled out of grout, torn, sheared, carrying a block, installed in a stage."""

import csv
import json
import math
import pathlib

import numpy
from coplanetest import Case, documents, program, turned

case = Case("V87", __file__)
modulus, area = 200e9, 5e-4  # a bar of steel
EA = modulus * area
rock = {"model": "linear_elastic", "density": 2500, "youngs_modulus": 20e9, "poisson_ratio": 0.2}


def table(run):
    """Lines of <run>_lines.csv by name of the line and number of the segment: arrays over time of every column."""
    with open(pathlib.Path(run.folder, "run_lines.csv")) as file:
        rows = list(csv.DictReader(file))
    found = {}
    for row in rows:
        found.setdefault((row["line"], int(row["segment"])), []).append(row)
    names = [name for name in rows[0] if name not in ("line", "segment")]
    return {key: {name.partition("[")[0]: numpy.array([float(row[name]) for row in lines]) for name in names} for key, lines in found.items()}


# --- pull-out: a head is pulled out of a block, both rigid, so that the bar and its grout are all that gives ---------------------

gap, length, grout = 0.1, 2.0, 2e9
slope = EA * math.sqrt(grout / EA) * math.tanh(math.sqrt(grout / EA) * length)
stiffness = 1 / (gap / EA + 1 / slope)  # of the head in series with the grout
mesh = {
    "dimension": 2,
    "parts": [
        {"shape": "box", "block": "head", "min": [-0.3, 0], "size": [0.3 - gap, 0.4], "divisions": [2, 2]},
        {"shape": "box", "block": "rock", "min": [0, 0], "size": [2.5, 0.4], "divisions": [7, 3]},
    ],
}


def pull(divisions, end, speed=0.01, **changes):
    """The head goes away along -x."""
    line = {"points": [[-gap, 0.17], [length, 0.17]], "segment_length": length / divisions, "free_length": gap, "area": area, "youngs_modulus": modulus}
    return {
        "materials": {"rock": rock},
        "blocks": {"head": {"material": "rock", "rigid": True}, "rock": {"material": "rock", "rigid": True}},
        "contact": {"enabled": False},
        "conditions": [
            {"type": "rigid_motion", "block": "head", "velocity": [-speed, 0, 0], "angular_velocity": [0, 0, 0]},
            {"type": "rigid_motion", "block": "rock", "velocity": [0, 0, 0], "angular_velocity": [0, 0, 0]},
        ],
        "lines": {"bolt": {**line, "grout": {"stiffness": grout}, **changes}},
        "time": {"end": end, "fixed_step": end / 400},
        "history": {"tables": ["lines"], "rigid": ["*"]},
    }


errors, forces = [], []
for divisions in (20, 40, 80):
    run = case.run(f"elastic_{divisions}", mesh, pull(divisions, 0.01))
    lines = table(run)
    force = lines["bolt", 1]["force"][-1]
    forces.append(force)
    errors.append(abs(force / (stiffness * 1e-4) - 1))
    case.check(f"pull-out, {divisions} segments: force [N]", force, stiffness * 1e-4, 7 / divisions**2, relative=True)
    case.check(f"pull-out, {divisions} segments: what holds the head [N]", -run.history["head_reaction_x"][-1], force, 1e-9, relative=True)
    case.check(f"pull-out, {divisions} segments: force at its end [N]", lines["bolt", divisions + 1]["force"][-1] / force, 0, 0.01)
    # Along the bar the force is sinh(lambda (L - x)) / sinh(lambda L) of that at the head.
    rate, middle = math.sqrt(grout / EA), lines["bolt", divisions // 4 + 2]
    x = length / divisions * (divisions // 4 + 0.5)
    case.check(f"pull-out, {divisions} segments: force inside over that at the head", middle["force"][-1] / force, math.sinh(rate * (length - x)) / math.sinh(rate * length), 0.02)
    case.check(f"pull-out, {divisions} segments: stored energy [J]", run.history["line_stored"][-1], force * 1e-4 / 2, 1e-6, relative=True)
case.check("pull-out: order", math.log2(errors[1] / errors[2]), 2, 0.1)
turned_mesh, turned_deck, matrix = turned(mesh, pull(40, 0.01), 27, offset=(3, -2, 0))
again = case.run("elastic_turned", turned_mesh, turned_deck, angular=1e-10)
case.check("pull-out, turned: force [N]", table(again)["bolt", 1]["force"][-1], forces[1], 1e-8, relative=True)

strength = 1e5
name, deck = "slipping", pull(20, 1.0, grout={"stiffness": grout, "strength": strength})
run = case.run(name, mesh, deck, load=strength * length)
h, lines = run.history, table(run)
case.check(f"{name}: force [N]", lines["bolt", 1]["force"][-1], strength * length, 1e-9, relative=True)
case.check(f"{name}: force in the middle [N]", lines["bolt", 11]["force"][-1], strength * (length - 0.95), 1e-9, relative=True)
# All that the head has been pulled with and is not stored is lost by slip.
pulled = numpy.trapz(lines["bolt", 1]["force"], 0.01 * lines["bolt", 1]["time"])
case.check(f"{name}: lost by slip [J]", h["line_bond"][-1], pulled - h["line_stored"][-1], 1e-6, relative=True)
case.check(f"{name}: remainder [J]", h["line_remainder"][-1], 0, 1e-9 * pulled)
case.same_bits(name, mesh, deck, run, ranks=2)

# --- a bar between its ends: elastic, plastic, torn ----------------------------------------------------------------------------

name = "torn"
bar = {"points": [[-gap, 0.2], [0.4, 0.2]], "attach": "ends", "area": 1e-3, "youngs_modulus": modulus, "yield_stress": 400e6, "hardening_modulus": 2e9, "rupture_strain": 0.02, "spacing": 2}
deck = pull(1, 2.0)
deck["lines"] = {"bar": bar}
run = case.run(name, mesh, deck, load=2e5)
h, lines = run.history, table(run)
strain = 0.01 * lines["bar", 1]["time"] / 0.5
tangent = 2e9 * modulus / (2e9 + modulus)
exact = numpy.where(strain < 400e6 / modulus, modulus * strain, 400e6 + tangent * (strain - 400e6 / modulus)) * area
whole = lines["bar", 1]["broken"] == 0
case.check(f"{name}: force over strain [N]", numpy.max(numpy.abs(lines["bar", 1]["force"] - exact)[whole]), 0, 1e-9 * exact[whole][-1])
case.check(f"{name}: strain when it tears", strain[whole][-1], 0.02, 1.01 * strain[1])
case.check(f"{name}: force after that [N]", lines["bar", 1]["force"][-1], 0, 0)
case.check(f"{name}: work of what pulled it is lost [J]", h["line_plastic"][-1] + h["line_rupture"][-1], numpy.trapz(exact[whole], strain[whole] * 0.5), 0.005, relative=True)
case.check(f"{name}: remainder [J]", h["line_remainder"][-1], 0, 1e-9 * h["line_plastic"][-1])

name = "struck"
deck["lines"] = {"bar": {**bar, "hardening_modulus": 0, "rate_exponent": 0.05, "reference_rate": 1e-3}}
run = case.run(name, mesh, deck, load=2e5)
h, lines = run.history, table(run)
strain = 0.01 * lines["bar", 1]["time"] / 0.5
whole = lines["bar", 1]["broken"] == 0
case.check(f"{name}: force of a bar that flows at 20 times the reference rate [N]", lines["bar", 1]["force"][whole][-1], area * 400e6 * 20**0.05, 1e-9, relative=True)
case.check(f"{name}: largest force [N]", lines["bar", 1]["force"].max(), area * 400e6 * 20**0.05, 1e-9, relative=True)
case.check(f"{name}: remainder [J]", h["line_remainder"][-1], 0, 1e-9 * h["line_plastic"][-1])
case.same_bits(name, mesh, deck, run, ranks=3)

# --- dowel: blocks slide on each other, once across the line, in two frames ------------------------------------------------------

name = "dowel"
deck = pull(20, 0.5, grout={"stiffness": grout}, dowel={"stiffness": 1e8, "strength": 1e5})
deck["lines"]["bolt"].pop("free_length")
deck["conditions"][0]["velocity"] = [0, 0.01, 0]
deck["lines"]["bolt"]["segment_length"] = 0.35
for frame, angle in (("", 0), ("_turned", 27)):
    problem = turned(mesh, deck, angle)
    run = case.run(name + frame, problem[0], problem[1], angular=1e-10, load=1e5)
    lines = table(run)["bolt", 1]  # the only segment over the gap
    slid = 0.01 * lines["time"]
    # Across the line: the bar turns by slid over the length between its points.
    along = 0.35
    across = slid * along / numpy.hypot(along, slid)
    case.check(f"{name}{frame}: elastic over sliding, then its strength [N]", numpy.max(numpy.abs(lines["dowel"] - numpy.minimum(1e8 * across, 1e5))), 0, 1e-4 * 1e5)
    head = numpy.array([run.history[f"head_reaction_{axis}"][-1] for axis in "xyz"]) @ problem[2]
    pulling = lines["force"][-1] * slid[-1] / numpy.hypot(along, slid[-1])
    side = 1e5 * along / numpy.hypot(along, slid[-1])
    # The bar pulls along itself, the dowel across it.
    case.check(f"{name}{frame}: what moves the head across [N]", head[1], pulling + side, 0.01, relative=True)
    case.check(f"{name}{frame}: lost [J]", run.history["line_dowel"][-1], 1e5 * (across[-1] - 1e5 / 1e8), 0.01, relative=True)
    case.check(f"{name}{frame}: remainder over what is lost", run.history["line_remainder"][-1] / run.history["line_dowel"][-1], 0, 1e-3)

# --- a bar that bends: the same, with hinges at both ends of the segment over the gap -----------------------------------------------

name, over, diameter, yield_stress = "bending", 0.15, 0.02, 400e6
deck = pull(20, 1.5, grout={"stiffness": grout, "strength": 1e4}, plate=True, diameter=diameter, yield_stress=yield_stress)
deck["lines"]["bolt"].pop("free_length")
deck["lines"]["bolt"].update(points=[[-0.25, 0.17], [2, 0.17]], segment_length=over)
deck["conditions"][0]["velocity"] = [0, 0.01, 0]
for frame, angle in (("", 0), ("_turned", 27)):
    problem = turned(mesh, deck, angle)
    run = case.run(name + frame, problem[0], problem[1], angular=1e-10, load=5e4)
    lines = table(run)["bolt", 2]  # from the face of the head into the rock
    slid = 0.01 * lines["time"]
    chord, turn = numpy.hypot(over, slid), numpy.arctan2(slid, over)
    most = yield_stress * area * 2 * diameter / (3 * math.pi) * (1 - (lines["force"] / (yield_stress * area)) ** 2)
    moment = numpy.minimum(EA * diameter**2 / 16 / over * turn, most)
    for end in "ab":
        case.check(f"{name}{frame}: moment over turn, then the plastic moment, at {end} [N m]", numpy.max(numpy.abs(lines[f"moment_{end}"] - moment)), 0, 1e-9 * most[-1])
    head = numpy.array([run.history[f"head_reaction_{axis}"][-1] for axis in "xyz"]) @ problem[2]
    case.check(f"{name}{frame}: what moves the head across [N]", head[1], lines["force"][-1] * slid[-1] / chord[-1] + 2 * moment[-1] * over / chord[-1] ** 2, 0.01, relative=True)
    case.check(f"{name}{frame}: lost by bending [J]", run.history["line_plastic"][-1], 2 * numpy.trapz(moment, turn) - moment[-1] ** 2 * over / (EA * diameter**2 / 16), 0.002, relative=True)
    case.check(f"{name}{frame}: remainder over what is lost", run.history["line_remainder"][-1] / run.history["line_plastic"][-1], 0, 1e-3)
    if not angle:
        case.same_bits(name, mesh, deck, run, ranks=2)

# --- a block hangs from a roof by one bolt -----------------------------------------------------------------------------------------

gravity = 10.0
hanging = {
    "dimension": 3,
    "parts": [
        {"shape": "box", "block": "roof", "min": [0, 0, 1.01], "size": [1, 1, 0.99], "divisions": [3, 3, 3]},
        {"shape": "box", "block": "block", "min": [0, 0, 0], "size": [1, 1, 1], "divisions": [3, 3, 3]},
    ],
    "node_sets": {"top": {"block": "roof", "where": {"z": 2}}},
}
weight = 2500 * gravity


def hung(line):
    return {
        "materials": {"rock": rock},
        "blocks": {"roof": {"material": "rock"}, "block": {"material": "rock"}},
        "conditions": [{"type": "fixed", "node_set": "top"}],
        "gravity": [0, 0, -gravity],
        "damping": {"kinetic": True, "until_force_ratio": 1e-8},
        "lines": {"bolt": {"area": area, "youngs_modulus": modulus, **line}},
        "time": {"end": 2, "end_at_rest": True},
        "history": {"every": 1e-3, "tables": ["lines"], "probes": [{"name": "top", "node_set": "top", "reaction": True}, {"name": "block", "block": "block"}]},
    }


axis = [[0.5, 0.5, 1.95], [0.5, 0.5, 0.05]]
kinds = {
    "grouted": {"points": axis, "segment_length": 0.19, "grout": {"stiffness": grout, "strength": 4e4}, "compression": False},
    "anchored": {"points": axis, "attach": "ends"},
    "perfect": {"points": axis, "attach": "perfect", "segment_length": 0.19},
}
for kind, line in kinds.items():
    name, problem = f"hanging_{kind}", hung(line)
    run = case.run(name, hanging, problem, angular=1e-10)
    lines = table(run)
    at_joint = [values["force"][-1] for (_, segment), values in sorted(lines.items()) if abs(values["z"][-1] - 1.005) < 0.1 or kind == "anchored"]
    case.check(f"{name}: greatest force where it leaves the roof [N]", max(at_joint), weight, 1e-6, relative=True)
    case.check(f"{name}: force of the roof's support [N]", run.history["top_reaction_z"][-1], weight * 1.99, 1e-6, relative=True)
    case.check(f"{name}: kinetic energy at the end [J]", run.history["kinetic"][-1], 0, 1e-6)
    case.same_bits(name, hanging, problem, run, ranks=3)
    if kind == "grouted":
        reference, grouted = run, problem

# Rebalanced again and again, and from a checkpoint on another number of ranks.
again = case.attempt("hanging_rebalanced", hanging, {**grouted, "partition": {"rebalance": "always", "rebalance_every": 29}}, ranks=2)
case.check_equal("hanging: state hash with rebalancing", again.state_hash, reference.state_hash)
half = 0.5 * float(reference.history["time"][-1])
name = "hanging_restarted"
stopped = case.attempt(name, hanging, {**grouted, "time": {"end": half}, "checkpoint": {"at_end": True}}, ranks=2)
case.check_equal("hanging: exit code of the first half", stopped.code, 0)
documents.save({"mesh": "mesh.e", **grouted}, f"{name}/run.yaml")
code, output = program.run_program(["run.yaml", "--restart"], name, ranks=3)
case.check_equal("hanging: exit code of the restart", code, 0)
case.check_equal("hanging: state hash of the restart", json.loads(pathlib.Path(name, "run.run-s0002.json").read_text())["state_hash"], reference.state_hash)
summary = json.loads(pathlib.Path("hanging_grouted", "run.run.json").read_text())["lines"][0]
case.check_equal("hanging: the record's greatest force is above what it ends with", summary["greatest_force_N"] > weight, True)

# --- the roof is taken away: what held the bolt there is gone, and the block falls -----------------------------------------------

name, problem = "roof_removed", hung(kinds["grouted"])
problem |= {"damping": {}, "time": {"end": 0.06}, "stages": [{"name": "hanging", "until": 0.03}, {"name": "falling", "remove": ["roof"]}]}
run = case.run(name, hanging, problem, angular=1e-10)
h, lines = run.history, table(run)
falls = h["time"] > 0.035
speed = h["block_velocity_z"][falls]
case.check(f"{name}: acceleration of the block [m/s^2]", (speed[-1] - speed[0]) / (h["time"][falls][-1] - h["time"][falls][0]), -gravity, 1e-6, relative=True)
case.check_equal(f"{name}: energy is lost with the hosts", bool(h["line_rupture"][-1] > 0), True)
case.same_bits(name, hanging, problem, run, ranks=2)

# --- installed in a stage and pretensioned there -----------------------------------------------------------------------------------

name, end, begins, jack = "in_a_stage", 0.4, 0.1, 5e4
problem = pull(1, end)
problem["stages"] = [{"name": "before", "until": begins}, {"name": "bolted"}]
problem["lines"] = {"anchor": {"points": [[-gap, 0.2], [0.4, 0.2]], "attach": "ends", "area": area, "youngs_modulus": modulus, "stage": "bolted", "pretension": jack, "pretension_time": 0.1}}
run = case.run(name, mesh, problem, load=4e5)
lines = table(run)["anchor", 1]
exact = jack * numpy.minimum((lines["time"] - begins) / 0.1, 1) + EA * 0.01 * (lines["time"] - begins) / 0.5
case.check(f"{name}: begins with its stage [s]", lines["time"][0], begins, 1.01 * end / 400)
case.check(f"{name}: force of pretension and motion [N]", numpy.max(numpy.abs(lines["force"] - exact)), 0, 1e-9 * exact[-1])
growing = lines["time"] < begins + 0.1 * (1 + 1e-9)
jacked = jack / EA * 0.5 * numpy.trapz(numpy.append(0, exact[growing]), numpy.append(begins, lines["time"][growing])) / 0.1
case.check(f"{name}: work of the jack [J]", run.history["line_pretension"][-1], jacked, 1e-6, relative=True)
case.finish()
