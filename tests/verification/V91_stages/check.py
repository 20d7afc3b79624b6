"""V91: stages: a column of blocks before and after the upper ones are removed, and after they are added."""

import json
import math
import pathlib

import numpy
from coplanetest import Case, conforming, differences, documents, program

case = Case("V91", __file__)
density, gravity, modulus = 2000.0, 10.0, 1e10
weight = density * gravity  # of one block of 1 m x 1 m, per metre [N]

# --- meshes: three blocks of 1 m, one above the other, four elements high ---------------------------------------------------


def column(name, shared, sunk=0.0):
    """With common nodes or each with nodes of its own; the upper block lies so deep in the middle one [m]."""
    points, quads, sides = [], {}, {"floor": [], "base_top": [], "crest": []}
    for b, block in enumerate(("base", "middle", "top")):
        first = len(points)
        if shared and b:
            first -= 2  # the upper two nodes of the block below
        for row in range(5):
            if row or not (shared and b):
                points += [(x, b + row / 4 - (sunk if block == "top" else 0)) for x in (0.0, 1.0)]
        quads[block] = [(first + 2 * r, first + 2 * r + 1, first + 2 * r + 3, first + 2 * r + 2) for r in range(4)]
        if b == 0:
            sides["floor"], sides["base_top"] = [(first, first + 1)], [(first + 8, first + 9)]
    sides["crest"] = [(first + 8, first + 9)]
    conforming.write(name, points, quads, sides)


column("shared.e", True)
column("apart.e", False)
for sunk in (0.02, 0.2):  # of elements of 0.25 m
    column(f"sunk_{sunk:g}.e", False, sunk)

relax = {"kinetic": True, "until_force_ratio": 1e-9}


def deck(mesh, stages, height, blocks=("base", "middle", "top"), **changes):
    """A column of so many metres in equilibrium with its weight at the start."""
    stress = {"stress": [0, -weight * height, 0, 0, 0, 0], "stress_gradient": [0, weight, 0, 0, 0, 0]}
    return {
        "mesh": f"../{mesh}.e",
        "materials": {"rock": {"model": "linear_elastic", "density": density, "youngs_modulus": modulus, "poisson_ratio": 0.0}},
        "blocks": {block: {"material": "rock"} for block in ("base", "middle", "top")},
        "joints": {"bed": {"model": "linear", "normal_stiffness": 1e11, "friction": 0.5}},
        "contact": {"pairs": [{"blocks": ["*", "*"], "joint": "bed", "declared": True}]},
        "conditions": [{"type": "fixed", "node_set": "floor"}],
        "initial": [{"block": block, **stress} for block in blocks],
        "gravity": [0, -gravity, 0],
        "damping": relax,
        "time": {"end": 1, "fixed_step": 2e-5},
        "stages": stages,
        "history": {"probes": [{"name": "foot", "node_set": "floor", "reaction": True}, {"name": "upper", "node_set": "base_top"}]
                    + [{"name": block, "block": block, "variables": ["stress_yy", "strain_yy"]} for block in ("base", "middle", "top")]
                    + [{"name": "low", "point": [0.5, 0.1, 0], "variables": ["stress_yy", "density"]}]},
        **changes,
    }


still = {"name": "still", "until": 2e-3}


def same_bits(name, problem, run):
    """On three ranks, in every line of the history too; and where the mesh is dealt out anew again and again."""
    case.same_bits(name, None, problem, run, ranks=3)
    again = case.attempt(f"{name}_rebalanced", None, {**problem, "partition": {"rebalance": "always", "rebalance_every": 37}}, ranks=2)
    case.check_equal(f"{name}: state hash with rebalancing", again.state_hash, run.state_hash)
    for folder in (f"{name}_again", f"{name}_rebalanced"):
        case.check_equal(f"{folder}: history differs", pathlib.Path(folder, "run.csv").read_bytes() != run.bytes_of("run.csv"), False)


def ends_at_rest(name, run, stages):
    for stage in stages:
        case.check_equal(f"{name}: stage '{stage}' ends at rest", f"stage '{stage}' ends at cycle" in run.output and run.output.split(
            f"stage '{stage}' ends")[1].split("\n")[0].count("s, at rest:"), 1)


# --- the upper blocks are removed: one, then the other ----------------------------------------------------------------------

dig = [still, {"name": "first", "until": 0.5, "at_rest": True, "remove": ["top"]}, {"name": "second", "at_rest": True, "remove": ["middle"]}]
runs = {}
for mesh in ("shared", "apart"):
    name, problem = f"dig_{mesh}", deck(mesh, dig, 3)
    run = case.run(name, None, problem, energy=1e-6)
    runs[mesh] = problem, run
    h = run.history
    stages = [h["time"] <= 2e-3 * (1 + 1e-9), h["eroded_elements"] == 4, h["eroded_elements"] == 8]
    before, first, second = (numpy.flatnonzero(stage) for stage in stages)
    case.check(f"{name}: nothing moves before [m]", numpy.max(numpy.abs(h["top_displacement_y"][before])), 0, 1e-15)
    ends_at_rest(name, run, ("first", "second"))
    for what, at, left in (("three blocks", before[-1], 3), ("two", first[-1], 2), ("one", second[-1], 1)):
        case.check(f"{name}: {what}: force of the floor [N]", h["foot_reaction_y"][at], left * weight, 1e-8, relative=True)
        # The base is relieved of so many blocks: the same stress everywhere.
        case.check(f"{name}: {what}: rise of the base [m]", h["upper_displacement_y"][at], (3 - left) * weight / modulus, 1e-5, relative=left < 3)
    case.check(f"{name}: mass that has left [kg]", h["eroded_mass"][-1], 2 * density, 1e-12, relative=True)
    same_bits(name, problem, run)

# --- blocks come in: the middle one, then the one above, each at rest on what has settled before -----------------------------

fill = [still, {"name": "first", "until": 0.5, "at_rest": True, "add": ["middle"], "zero_displacements": True},
        {"name": "second", "at_rest": True, "add": ["top"], "zero_displacements": True}]  # fmt: skip
name, problem = "fill", deck("shared", fill, 1, ("base",))
problem["contact"] = {"enabled": False}
run = case.run(name, None, problem, energy=1e-6)
h = run.history
begins = [numpy.searchsorted(h["time"], 2e-3 * (1 + 1e-9)), None, len(h["time"])]
case.check(f"{name}: nothing moves before [m]", numpy.max(numpy.abs(h["upper_displacement_y"][: begins[0]])), 0, 1e-15)
case.check(f"{name}: force of the floor before [N]", h["foot_reaction_y"][begins[0] - 1], weight, 1e-12, relative=True)
case.check(f"{name}: force of the floor at the end [N]", h["foot_reaction_y"][-1], 3 * weight, 1e-5, relative=True)
# The last displacements are those under the last block: the base and the middle are shortened by its weight, and it is by its own.
case.check(f"{name}: settlement of the base [m]", h["upper_displacement_y"][-1], -weight / modulus, 1e-5, relative=True)
results = run.results
stress = {block: results.element(block, "stress_yy") for block in ("base", "middle", "top")}
for block, above in (("base", 2.0), ("middle", 1.0), ("top", 0.0)):
    exact = [-weight * (above + 1 - (row + 0.5) / 4) for row in range(4)]
    case.check(f"{name}: stress of {block}, farthest from its weight [Pa]", numpy.max(numpy.abs(stress[block] - exact)), 0, 1e-5 * weight)
# So are their strains; the one above has counted since it came in, free of stress and after displacements were zeroed.
strain = {block: results.element(block, "strain_yy") for block in ("base", "middle", "top")}
for block in ("base", "middle"):
    case.check(f"{name}: strain of {block} under the last block, farthest", numpy.max(numpy.abs(strain[block] * modulus / weight + 1)), 0, 2e-5)
case.check(f"{name}: strain of the last block, farthest from that of its stress", numpy.max(numpy.abs(strain["top"] * modulus - stress["top"])) / weight, 0, 2e-5)
case.check_equal(f"{name}: a block that is not there has no strain", bool((results.element("top", "strain_yy", 0) == 0).all()), True)
ends_at_rest(name, run, ("first", "second"))
same_bits(name, problem, run)
again = case.attempt(f"{name}_results", None, problem, ranks=2)
case.check_equal(f"{name}: differences of the results on 2 ranks", differences(run.path("run.e"), again.path("run.e")), [])

# Probes: the element nearest to a point, and the least and the largest of a block with their places.
case.check_equal(f"{name}: stress at a point is that of the lowest element", float(h["low_stress_yy"][-1]), float(stress["base"][0]))
case.check(f"{name}: density there [kg/m^3]", h["low_density"][-1], density, 1e-5, relative=True)
case.check(f"{name}: the node that is nearest is held [m]", numpy.max(numpy.abs(h["low_displacement_y"])), 0, 1e-15)
for which, row in (("least", 0), ("largest", 3)):  # compression is negative
    case.check_equal(f"{name}: {which} stress of the base", float(h[f"base_stress_yy_{which}"][-1]), float(stress["base"][row]))
    case.check(f"{name}: its height [m]", h[f"base_stress_yy_{which}_place_y"][-1], (row + 0.5) / 4, 1e-5)
    case.check_equal(f"{name}: its element", int(h[f"base_stress_yy_{which}_element"][-1]), int(results.ids_of("base")[row]))
case.check_equal(f"{name}: a block that is not there has none", bool(numpy.isnan(h["top_stress_yy_least"][0])), True)

# --- what comes in is loaded: the pressure on it acts from then on, and goes through a restart ----------------------------------

load = 1e5
name = "loaded"
stages = [still, {"name": "filled", "at_rest": True, "add": ["middle", "top"]}]
loaded = deck("shared", stages, 1, ("base",), contact={"enabled": False})
loaded["conditions"] = [*loaded["conditions"], {"type": "pressure", "side_set": "crest", "value": load}]
run_loaded = case.run(name, None, loaded, energy=1e-6)
ends_at_rest(name, run_loaded, ("filled",))
begins = numpy.flatnonzero(run_loaded.history["time"] <= 2e-3 * (1 + 1e-9))[-1]
case.check(f"{name}: force of the floor before [N]", run_loaded.history["foot_reaction_y"][begins], weight, 1e-12, relative=True)
case.check(f"{name}: force of the floor at the end [N]", run_loaded.history["foot_reaction_y"][-1], 3 * weight + load, 1e-5, relative=True)
# Without zeroing the base counts from the start, where its own weight was on it; the others since they came in.
for block, before in (("base", 1.0), ("middle", 0.0), ("top", 0.0)):
    exact = run_loaded.results.element(block, "stress_yy") + before * weight * (1 - (numpy.arange(4) + 0.5) / 4)
    found = run_loaded.results.element(block, "strain_yy") * modulus
    case.check(f"{name}: strain of {block}, farthest from that of what has come upon it", numpy.max(numpy.abs(found - exact)) / (3 * weight + load), 0, 2e-5)
same_bits(name, loaded, run_loaded)

# --- a block a thousand times as stiff comes in while the others vibrate: it limits the step from the start on ------------------

name = "stiff"
stiff = deck("shared", [still, {"name": "lined", "until": 4e-3, "add": ["top"]}], 2, ("base", "middle"), contact={"enabled": False})
stiff["materials"] = {**stiff["materials"], "steel": {**stiff["materials"]["rock"], "youngs_modulus": 1e3 * modulus}}
stiff["blocks"] = {**stiff["blocks"], "top": {"material": "steel"}}
stiff |= {"gravity": [0, -1.2 * gravity, 0], "damping": {}, "time": {"end": 4e-3}}
run_stiff = case.run(name, None, stiff, energy=1e-2)
h = run_stiff.history
first = numpy.flatnonzero(h["eroded"] != 0)[0]  # the cycle in which it comes, without forces of its own
through = 0.25 / math.sqrt(1e3 * modulus / density)  # a wave through one of its elements [s]
case.check_equal(f"{name}: steps after that are shorter than a wave takes through an element", bool(numpy.max(h["dt"][first + 1 :]) < through), True)

# --- a block comes in where another one is: that is told, once, with how deep; where faces only meet nothing is -----------------

for mesh, deep in (("apart", 0), ("sunk_0.02", 0.02), ("sunk_0.2", 0.2)):
    for ranks, declared in ((1, False), (3, False), (2, True)):
        meeting = deck(mesh, [still, {"name": "meets", "until": 3e-3, "add": ["top"]}], 2, ("base", "middle"), damping={}, time={"end": 3e-3})
        meeting["contact"]["pairs"][0]["declared"] = declared
        name = f"{mesh}_{ranks}_ranks"
        met = case.attempt(name, None, meeting, ranks=ranks)
        told = [line for line in met.output.splitlines() if "in each other" in line]
        case.check_equal(f"{name}: exit code, times told", [met.code, len(told)], [0, 1 if deep else 0])
        if told:
            case.check_equal(f"{name}: what is told", [words in told[0] for words in ("blocks 'middle' and 'top'", f"up to {deep:g} m deep")], [True, True])

# --- restarts in the middle of a stage and at its border, with what is to come changed -----------------------------------------

for what, problem, reference in (("dig", runs["apart"][0], runs["apart"][1]), ("fill", problem, run)):
    for place, cycle in (("border", 100), ("first stage", 130)):  # the stage that stands still ends at cycle 100
        name = f"{what}_{place.replace(' ', '_')}"
        until = (cycle + 4.5) * 2e-5
        # The last stage has begun when the run stops, the checkpoint is from before.
        short = [still, {**problem["stages"][1], "until": until}, problem["stages"][2]]
        stopped = case.attempt(name, None, {**problem, "stages": short, "time": {"end": until + 4e-5, "fixed_step": 2e-5}, "checkpoint": {"every_cycles": cycle}}, ranks=2)
        case.check_equal(f"{what}, {place}: exit code", stopped.code, 0)
        documents.save({**problem, "checkpoint": {"every_cycles": 100000}}, f"{name}/run.yaml")
        code, output = program.run_program(["run.yaml", "--restart"], name, ranks=3)
        case.check_equal(f"{what}, {place}: exit code of the restart", code, 0)
        case.check_equal(f"{what}, {place}: it says what differs", "stages.1.until was" in output, True)
        record = json.loads(pathlib.Path(name, "run.run-s0002.json").read_text()) if code == 0 else {"state_hash": output}
        case.check_equal(f"{what}, {place}: state hash", record["state_hash"], reference.state_hash)
        case.check_equal(f"{what}, {place}: history differs", stopped.bytes_of("run.csv") != reference.bytes_of("run.csv"), False)

# What is done cannot change any more, nor what the state holds.
for told, change in (("stages.1.remove.0 was top", {"stages": [still, {**dig[1], "remove": ["middle"]}, {**dig[2], "remove": ["top"]}]}),
                     ("materials.rock.density was 2000", {"materials": {"rock": {**problem["materials"]["rock"], "density": 2100.0}}})):  # fmt: skip
    documents.save({**runs["apart"][0], **change}, "dig_first_stage/run.yaml")
    code, output = program.run_program(["run.yaml", "--restart", "run.chk.0"], "dig_first_stage")
    case.check_equal(f"{told}: exit code", code, 9)
    case.check_equal(f"{told}: said", told in output, True)
case.finish()
