"""Every key of conditions, start, gravity and damping that the program lists changes what comes out of a run."""

import copy
import itertools
import re
import subprocess

from coplanetest import Case, program

case = Case("conditions_act", __file__)
recipe, plain = case.load("mesh.yaml"), case.load()

# One card for each type, and for each of its keys another value of that key.
conditions = {
    "fixed": ({"node_set": "base"}, {"node_set": "flank", "components": ["x"]}),
    "velocity": (
        {"node_set": "base", "value": [0, "0.1*t", 0]},
        {"node_set": "flank", "components": ["y"], "value": [0, "0.2*t", 0]},
    ),
    "acceleration": (
        {"node_set": "base", "value": [0, "0.1*t", 0]},
        {"node_set": "flank", "components": ["y"], "value": [0, "0.2*t", 0]},
    ),
    "displacement": (
        {"node_set": "base", "value": [0, "0.1*t", 0]},
        {"node_set": "flank", "components": ["y"], "value": [0, "0.2*t", 0]},
    ),
    "symmetry": ({"node_set": "base", "normal": [0, 1, 0]}, {"node_set": "flank", "normal": [1, 1, 0]}),
    "pressure": ({"side_set": "top", "value": 1e5}, {"side_set": "right", "value": "1e5*x"}),
    "traction": ({"side_set": "top", "value": [1e5, 0, 0]}, {"side_set": "right", "value": [1e5, "1e5*t", 0]}),
    "air_blast": (
        {"side_set": "top", "charge_mass": 0.1, "charge_place": [0.5, 3, 0]},
        {"side_set": "right", "charge_mass": 0.2, "charge_place": [1, 3, 0], "burst": "air", "detonation_time": 1e-3},
    ),
    "absorbing": ({"side_set": "top"}, {"side_set": "right", "incident": [0.1, 0, 0]}),
    "free_field": ({"side_set": "right"}, {"side_set": "left"}),
    "rigid_motion": (
        {"block": "tool", "velocity": [1, 0, 0]},
        {"block": "other", "components": ["x"], "velocity": [{"times": [0, 0.02], "values": [0, 1]}, 0, 0], "angular_velocity": [0, 0, 5]},
    ),
}
for kind, (_, others) in conditions.items():
    if kind != "rigid_motion":
        others.update({"from": 0.01, "until": 1e-3 if kind == "air_blast" else 0.01})  # a blast is over soon
start = (
    {"velocity": [1, 0, 0], "angular_velocity": [0, 0, 1], "stress": [1e5, 0, 0, 0, 0, 0], "stress_gradient": [0, 1e5, 0, 0, 0, 0]},
    {
        "block": "other", "velocity": [0, 1, 0], "angular_velocity": [0, 0, 2], "center": [0.5, 0, 0], "velocity_field": ["0.1*y", 0, 0],
        "stress": [0, 0, 0, 1e5, 0, 0], "stress_gradient": [1e5, 0, 0, 0, 0, 0], "stress_axis": [1, 0, 0], "stress_point": [0, 1, 0],
    },
)
loaded = {"gravity": [0, -10, 0], "conditions": [{"type": "fixed", "node_set": "base"}]}
damping = {  # a deck's damping, and another
    "mass": ({}, {"mass": "100*(t > 0.01)"}),
    "local": ({}, {"local": 0.5}),
    "kinetic": ({}, {"kinetic": True}),
    "from": ({"local": 0.5}, {"local": 0.5, "from": 0.01}),
    "until": ({"local": 0.5}, {"local": 0.5, "until": 0.01}),
    "until_energy_ratio": ({"kinetic": True}, {"kinetic": True, "until_energy_ratio": 1e6}),
    "until_force_ratio": ({"kinetic": True}, {"kinetic": True, "until_force_ratio": 1e6}),
}

numbers = itertools.count()
hashes = {}


def hash_of(what, deck):
    """Of the state at the end; equal decks run once."""
    text = repr(deck)
    if text not in hashes:
        run = case.attempt(f"run_{next(numbers)}", recipe, deck)
        case.check_equal(f"{what}: exit code", run.code, 0)
        hashes[text] = run.state_hash if run.code == 0 else f"failed: {what}"
    return hashes[text]


def differ(what, first, second):
    case.check_equal(f"{what}: changes the state", hash_of(what, first) != hash_of(what, second), True)


def with_condition(card):
    return {**plain, "conditions": [card]}


tried = set()
for kind, (card, other) in conditions.items():
    card = {"type": kind, **card}
    differ(f"conditions.type: {kind}", plain, with_condition(card))
    tried.add(("conditions.<index>.type", kind))
    for key, value in other.items():
        changed = {**card, key: value}
        differ(f"conditions.{key} of {kind}", with_condition(card), with_condition(changed))
        tried.add((f"conditions.<index>.{key}", kind))

first, second = start
for key, value in second.items():
    card = {"block": "soft", **first}
    if key == "block":  # a rigid one carries no stress
        card = {"block": "soft", "velocity": [1, 0, 0]}
    differ(f"initial.{key}", {**plain, "initial": [card]}, {**plain, "initial": [{**card, key: value}]})
    tried.add((f"initial.<index>.{key}", ""))
differ("gravity", plain, {**plain, "gravity": [0, "-10*t", 0]})
tried.add(("gravity", ""))
for key, (before, after) in damping.items():
    decks = [{**plain, **copy.deepcopy(loaded), **({"damping": d} if d else {})} for d in (before, after)]
    differ(f"damping.{key}", *decks)
    tried.add((f"damping.{key}", ""))

# What cannot act is told, before the run, too; each by words that no other has.
words = {"late": "pressure acts from 1 s on", "blast late": "arrives at 'top' at 1.0", "blast early": "has left 'top' at -0.9",
         "unlit": "reaches the explosive at ", "far": "m from the nearest middle of an element", "rigid": "'soft' is rigid: nothing is computed",
         "die": "elements are beyond a limit of erosion at the start"}  # fmt: skip
blast = {"type": "air_blast", "side_set": "top", "charge_mass": 0.1, "charge_place": [0.5, 3, 0]}
charge = {**plain, "blocks": {**plain["blocks"], "soft": {"material": "tnt", "hourglass": {"stiffness": 0, "viscosity": 0.1}}}, "initial": []}


def lit(**keys):
    return {**charge, "materials": {**plain["materials"], "tnt": {"set": "tnt", **keys}}}


def with_erosion(step):
    return {**plain, "blocks": {**plain["blocks"], "soft": {**plain["blocks"]["soft"], "erosion": {"stable_step": step}}}}


for what, deck, told in (
    ("pressure after the end", with_condition({"type": "pressure", "side_set": "top", "value": 1e5, "from": 1}), ["late"]),
    ("pressure", with_condition({"type": "pressure", "side_set": "top", "value": 1e5, "from": 0.01}), []),
    ("blast after the end", with_condition({**blast, "detonation_time": 1}), ["blast late"]),
    ("blast before the start", with_condition({**blast, "detonation_time": -1}), ["blast early"]),
    ("blast", with_condition(blast), []),
    ("charge lit after the end", lit(lighting_points=[[0, 0]], lighting_times=[0.5]), ["unlit"]),
    ("charge lit in millimetres", lit(lighting_points=[[500, 500]]), ["unlit", "far"]),
    ("charge lit", lit(lighting_points=[[0, 0]]), []),
    ("charge that is rigid", {**lit(lighting_points=[[0, 0]]), "blocks": {**plain["blocks"], "soft": {"material": "tnt", "rigid": True}}}, ["rigid"]),
    ("elements beyond a limit", with_erosion(1), ["die"]),
    ("elements within a limit", with_erosion(1e-12), []),
):
    for ranks in (1, 2):
        run = case.attempt(f"idle_{what.replace(' ', '_')}_{ranks}", recipe, deck, ranks=ranks, options=["--check"])
        case.check_equal(f"{what}, {ranks} ranks: exit code", run.code, 0)
        case.check_equal(f"{what}, {ranks} ranks: what is told", [kind for kind, text in words.items() if text in run.output], told)

# The list is the program's own.
reference = subprocess.run([program.binary("coplane"), "--help-deck"], stdout=subprocess.PIPE, text=True, check=True).stdout
listed = set()
for path, _, kinds in re.findall(r"(?m)^(\S+)( +\(type: (.*)\))?$", reference):
    if re.match(r"(conditions|initial)\.<index>\.|damping\.|gravity$", path):
        every = list(conditions) if path == "conditions.<index>.type" else [""]
        listed.update((path, kind) for kind in (kinds.split(", ") if kinds else every))
case.check_equal("keys that the program lists and that are not tried", sorted(listed - tried), [])
case.check_equal("keys that are tried and that the program does not list", sorted(tried - listed), [])
case.check_within("keys that act", len(listed & tried), 40, 200)
case.finish()
