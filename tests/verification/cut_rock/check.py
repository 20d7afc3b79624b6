"""Rock in one piece, cut by crossing joint sets, stays at rest under its initial stress."""

import copy
import pathlib
import re

import numpy
from coplanetest import Case
from coplanetools import program

case = Case("cut rock", __file__)
example = "exodus_inputs/cut_rock_2d/"
recipe, joints = case.load(example + "mesh.yaml"), case.load(example + "joints.yaml")
stiffness = 2e10  # of the joints [Pa/m]; a stress of 2 MPa closes them by 1e-4 m
closure = 2e6 / stiffness


def at_rest(deck):
    """The example without its pulse: the whole border is fixed."""
    deck = copy.deepcopy(deck)
    del deck["mesh"]  # each run makes its own
    deck["conditions"] = [{"type": "fixed", "node_set": side} for side in recipe["node_sets"]]
    return deck


def moved(run):
    return numpy.max(numpy.abs(run.results.nodal("displacement")))


def still(name, recipe, joints, deck, bodies, faces):
    """Nothing moves, so the balances are measured with what is there: the energy of the joints, and
    the impulse of the stress on a section of 10 m (per metre of depth).
    """
    run = case.attempt(name, recipe, deck, joints=joints)
    case.check_equal(f"{name}: exit code", run.code, 0)
    h = run.history
    stored, impulse = h["contact_stored"][0], 2e6 * 10 * deck["time"]["end"]
    case.check(f"{name}: energy balance", numpy.max(numpy.abs(h["error"])) / stored, 0, 1e-12, kept="energy balance")
    momentum = max(numpy.max(numpy.abs(h[f"momentum_error_{axis}"])) for axis in "xyz")
    case.check(f"{name}: momentum", momentum / impulse, 0, 1e-12, kept="momentum")
    case.check(f"{name}: missed contacts", int(numpy.max(h["missed"])), 0, 0, kept="missed contacts")
    text = pathlib.Path(run.path("split.txt")).read_text()
    case.check_equal(f"{name}: bodies after the cut", int(re.search(r"became (\d+)", text)[1]), bodies)
    found = re.findall(r"^joint .* (\d+) faces$", text, re.M)
    case.check_equal(f"{name}: faces cut", sum(int(count) for count in found), faces)
    case.check_equal(f"{name}: planes that stick, at the start and the end", [int(h["stick"][i]) for i in (0, -1)], [faces] * 2)
    # Nothing but rounding: forces of 1e6 N to 16 digits on stiffnesses of 1e10 N/m give 1e-20 m in a step.
    case.check(f"{name}: largest displacement [m] (joints are closed by {closure:g} m)", moved(run), 0, 1e-12)
    return run


deck = at_rest(case.load(example + "rock.yaml"))
deck["output"] = {"every": 1}
deck["time"] = {"end": 1e-2}

# 6 x 4 blocks: 5 joints of 16 faces, 3 of 24.
run = still("quadrilaterals", recipe, joints, deck, 24, 5 * 16 + 3 * 24)
case.same_bits("quadrilaterals", recipe, deck, run, joints=joints)
case.check_equal("results keep the joints' side sets", run.results.side_sets, ["steep", "bedding"])

triangles = copy.deepcopy(recipe)
triangles["parts"][0]["split"] = "triangles"
still("triangles", triangles, joints, deck, 24, 5 * 16 + 3 * 24)

# Without the declaration the joints carry nothing at first, and the blocks move by about the closure.
careless = copy.deepcopy(deck)
del careless["contact"]["pairs"][0]["declared"]
loose = case.run("undeclared", recipe, careless, joints=joints, energy=1e-2)
case.check_within("undeclared: largest displacement over the closure", moved(loose) / closure, 0.1, 100)

# Joints by the names of their sets, each with a law of its own; everything else is not declared.
named = copy.deepcopy(deck)
named["joints"]["stiff"] = {"model": "closure_curve", "initial_stiffness": 5e10, "maximum_closure": 1e-3, "friction": 0.7}
named["contact"]["pairs"] = [
    {"joint_set": "steep", "joint": "rough", "declared": True},
    {"joint_set": "bedding", "joint": "stiff", "declared": True},
]
by_set = still("by joint set", recipe, joints, named, 24, 5 * 16 + 3 * 24)
case.check_equal("by joint set: planes that exist", int(by_set.history["planes"][0]), 5 * 16 + 3 * 24)

# The cut rock twice in one mesh, side by side: both keep their joints, blocks and sets by name.
cut = str(pathlib.Path("cut.e").resolve())
program.make_mesh(recipe, str(pathlib.Path("whole.e").resolve()))
program.split_mesh(str(pathlib.Path("whole.e").resolve()), joints, cut)
both = {"dimension": 2, "meshes": [{"file": cut, "prefix": "near_"}, {"file": cut, "prefix": "far_", "offset": [20, 0]}]}
twins = copy.deepcopy(named)
names = ("near_", "far_")
twins["blocks"] = {name + "rock": card for name in names for card in named["blocks"].values()}
twins["contact"]["pairs"] = [{**pair, "joint_set": name + pair["joint_set"]} for name in names for pair in named["contact"]["pairs"]]
twins["initial"] = [{**card, "block": name + card["block"]} for name in names for card in named["initial"]]
twins["conditions"] = [{**card, "node_set": name + card["node_set"]} for name in names for card in named["conditions"]]
checked = case.attempt("merged, looked at", both, twins, options=("--check",))
case.check_equal("merged: exit code of --check", checked.code, 0)
merged = case.attempt("merged", both, twins)
case.check_equal("merged: exit code", merged.code, 0)
case.check_equal("merged: planes that exist, missed contacts", [int(merged.history["planes"][0]), int(numpy.max(merged.history["missed"]))], [2 * (5 * 16 + 3 * 24), 0])
case.check("merged: largest displacement [m]", moved(merged), 0, 1e-12)

# A joint of 4 m that ends inside the rock: the faces at its tips share the tips' nodes.
straight = copy.deepcopy(recipe)
for key in ("rotate", "about"):
    del straight["parts"][0][key]
crack = {"joints": {"crack": {"planes": {"point": [6, 0], "normal": [1, 0], "segment": [[6, 2], [6, 6]]}}}}
tip = copy.deepcopy(deck)
tip["contact"]["pairs"] = [{"joint_set": "crack", "joint": "rough", "declared": True}]
still("finite joint", straight, crack, tip, 1, 8)

# Three joint sets in a turned cube of 4 m: 2 x 2 x 2 blocks.
cube = {
    "dimension": 3,
    "parts": [{"shape": "box", "block": "rock", "size": [4, 4, 4], "divisions": [4, 4, 4], "rotate": [0, 0, 30], "about": [0, 0, 0]}],
    "node_sets": {
        **{side: {"where_own": {axis: 0}} for side, axis in (("left", "x"), ("bottom", "y"), ("back", "z"))},
        **{side: {"where_own": {axis: 4}} for side, axis in (("right", "x"), ("top", "y"), ("front", "z"))},
    },
}
sets = copy.deepcopy(joints)
for card in sets["joints"].values():
    card["planes"]["point"].append(0)
    card["planes"]["normal"].append(0)
sets["joints"]["level"] = {"planes": {"point": [0, 0, 2], "normal": [0, 0, 1]}}
solid = copy.deepcopy(deck)
solid["conditions"] = [{"type": "fixed", "node_set": side} for side in cube["node_sets"]]
solid["initial"] = [{"block": "rock", "stress": [-3e6, -2e6, -2.5e6, 0.2e6, 0.1e6, -0.3e6]}]
solid["time"] = {"end": 4e-3}
still("hexahedra", cube, sets, solid, 8, 3 * 16)
cube["parts"][0]["split"] = "tetrahedra"
still("tetrahedra", cube, sets, solid, 8, 3 * 32)

case.finish()
