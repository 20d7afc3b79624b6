"""coplane.capacity and times of records, without runs (README.md)."""

import pathlib
import re

import numpy
from coplanetest import Case

from coplane import Deck, capacity, record

case = Case("capacity", __file__)


def told(what, call, *words):
    try:
        call()
        text = "no error"
    except (ValueError, KeyError) as error:
        text = str(error.args[0])
    case.check_equal(f"{what}: told of", [word for word in words if word not in text], [])
    case.check_equal(f"{what}: no name from within", re.findall(r"^(weakened|tilted|bracket|factor_of_safety): ", text), [])


def curve(load):
    return capacity.Curve(numpy.arange(3.0), numpy.arange(3.0), numpy.array(load), 9.0, False).capacity


case.check_equal("mirrored loads", [curve([-0.1, 2.0, 1.0]), curve([0.1, -2.0, -1.0])], [2.0, -2.0])

deck = Deck({
    "gravity": [0, 0, -9.81],
    "joints": {"j": {"model": "linear", "friction": 0.8, "dilation": 0.3}},
    "materials": {"brick": {"set": "clay_brick"}, "name": "clay_brick"},
    "stages": [{"name": "a"}, {"name": "b", "set": {"joints.j.friction": 0.5, "joints.j.cohesion": "c"}}, {"name": "c", "set": {"joints.j": {"friction": 0.4}}}],
})  # fmt: skip
half = capacity.weakened(deck, 2.0, joints=["j"])
case.check_equal("stages: divided", half["stages"][1]["set"], {"joints.j.friction": 0.25, "joints.j.cohesion": "(c)/2.0"})
case.check_equal("stages: a whole card", half["stages"][2]["set"], {"joints.j": {"friction": 0.2}})
case.check_equal("the card, and dilation below all frictions", [half["joints.j.friction"], half["joints.j.dilation"]], [0.4, 0.2])
for name in ("brick", "name"):
    told(f"library: {name}", lambda name=name: capacity.weakened(deck, 2.0, materials=[name]), f"materials.{name}", "clay_brick", "Write")

# What a run would not find is told before one is made: the deck has no mesh.
deck["joints.j2"] = {"model": "penalty", "friction": 0.5}
deck["define"] = {"end": 1.5}
deck["time"] = {"end": "end"}
deck["blocks"] = {"stone": {"material": "brick", "rigid": True}}
deck["history"] = {"probes": [{"name": "brow", "node_set": "brow"}, {"name": "line", "between": [[0, 0, 0], [1, 0, 0]], "count": "end"}], "rigid": ["*"]}
told("no card", lambda: capacity.weakened(deck, 2.0, joints=["jj"]), "joints.jj", "no such card", "j, j2", "Did you mean j?")
told("no card: of materials", lambda: capacity.weakened(deck, 2.0, materials=["stone"]), "materials.stone", "brick, name")
told("no cards", lambda: capacity.weakened(deck, 2.0), "name the joint cards", "joints=['plane']")
for what, criterion, words in (
    ("no probe", capacity.Moves("brown", 1e-3), ["'brown'", "brow, line_1, stone", "Did you mean brow?"]),
    ("no probe: one of two", capacity.Moves(["brow", "line"], 1e-3), ["'line'", "line_1"]),
    ("since beyond the end", capacity.Moves("brow", 1e-3, since=1.5), ["since = 1.5 s", "time.end = 1.5 s"]),
    ("since in a deck that fits", capacity.Moves(["brow", "line_2", "stone", "stone_3"], 1e-3, since=1.4), []),
):
    told(what, lambda criterion=criterion: criterion.demand(deck), *words)
    if words:
        told(f"{what}: before a run", lambda criterion=criterion: capacity.factor_of_safety(deck, criterion, joints=["j"], folder="none"), *words)
case.check_equal("nothing was run", pathlib.Path("none").exists(), False)
told("ends", lambda: capacity.bracket(lambda factor: deck, capacity.Moves("brow", 1e-3), 2.0, 1.0), "low = 2.0, high = 1.0")

case.check_equal("tilted from z", capacity.tilted(deck, 1.0)["gravity"][1], 0.0)
for what, path, value, words in (
    ("an expression", "gravity", [0, "-9.81*t", 0], ["gravity", "numbers"]),
    ("oblique", "gravity", [1, -9.81, 0], ["right angles", "towards"]),
    ("a stage", "stages", [{"set": {"gravity": [0, -1, 0]}}], ["stages.0.set.gravity"]),
):
    other = deck.copy()
    other[path] = value
    told(f"tilted: {what}", lambda other=other: capacity.tilted(other, 1.0), *words)

for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("min", 60.0), ("h", None)):
    path = pathlib.Path(f"{unit}.csv")
    path.write_text(f"t[{unit}],a[g]\n0,0\n1,1\n2,0\n")
    if size is None:
        told("times in hours", lambda path=path: record.read(path), "t[h]", "accepted units")
    else:
        case.check(f"times in {unit}", record.read(path).times[-1], 2 * size, 1e-15)
case.finish()
