"""V84: factors of safety and load multipliers by coplane.capacity, against closed forms: a block on an incline, a wedge with water on its planes."""

import math
import pathlib

from coplanetest import Case, documents, program

from coplane import Deck, RunFailed, capacity, run as run_deck

case = Case("V84", __file__)
g = 9.81


def deck_in(name, recipe, deck):
    """The deck as a file in a folder of its own, with its mesh; read with its comments and paths."""
    folder = pathlib.Path(name)
    folder.mkdir(exist_ok=True)
    documents.save({"title": name, **recipe}, folder / "mesh.yaml")
    program.make_mesh(folder / "mesh.yaml", folder / "mesh.e")
    documents.save({"mesh": "mesh.e", **deck}, folder / "run.yaml")
    return Deck.read(folder / "run.yaml")


def check_bracket(name, found, exact, tolerance=0.01):
    print(found)
    case.check(f"{name}: factor", found.value, exact, tolerance, relative=True)
    case.check_within(f"{name}: width of the bracket over the factor", (found.high - found.low) / found.low, 0, 0.01)
    case.check_equal(f"{name}: it holds below and collapses above", all(t["collapsed"] == (t["factor"] >= found.high) for t in found.trials), True)


def told(what, error, call, *words):
    """A call raises this error, and its text has these words."""
    try:
        call()
        text = "no error"
    except error as raised:
        text = str(raised)
    case.check_equal(f"{what}: told of", [word for word in words if word not in text], [])


# --- decks with less strength --------------------------------------------------------------------------

strong = Deck.from_text("""
define: {phi: 30}
joints:
  plane: {model: linear, normal_stiffness: 1e9, friction: 0.6, dilation: 0.5, cohesion: 1e5}  # stays
  named: {model: penalty, friction: tan(phi*_pi/180)}
  other: {model: penalty, friction: 0.6}
  barton: {model: barton_bandis, residual_friction: 0.5}
materials:
  rock: {model: mohr_coulomb, cohesions: [4e6, 2e6], frictions: [0.8, 0.4], dilation: 0.3, tensile_strength: 1e6}
""")
half = capacity.weakened(strong, 2.0, joints=["plane", "named"], materials=["rock"])
for path, value in {
    "joints.plane.friction": 0.3, "joints.plane.cohesion": 5e4, "joints.plane.dilation": 0.3, "joints.plane.normal_stiffness": 1e9,
    "joints.named.friction": "(tan(phi*_pi/180))/2.0", "joints.other.friction": 0.6, "materials.rock.cohesions": [2e6, 1e6],
    "materials.rock.frictions": [0.4, 0.2], "materials.rock.dilation": 0.2, "materials.rock.tensile_strength": 1e6,
}.items():  # fmt: skip
    case.check_equal(f"weakened by 2: {path}", half[path], value)
case.check_equal("the deck itself stays", (strong["joints.plane.friction"], "# stays" in half.text), (0.6, True))
told("no cards", ValueError, lambda: capacity.weakened(strong, 2.0), "joints=")
told("a law without such strengths", ValueError, lambda: capacity.weakened(strong, 2.0, joints=["barton"]), "joints.barton (barton_bandis)", "cohesion")
told("a card that is not there", KeyError, lambda: capacity.weakened(strong, 2.0, joints=["plain"]), "joints.plain")

# --- a block on an incline: tan(phi) / tan(alpha) -----------------------------------------------------

angle, friction = math.radians(25), 0.6
soft = {"model": "linear_elastic", "density": 2000, "youngs_modulus": 50e6, "poisson_ratio": 0}
incline = {
    "materials": {"soft": soft},
    "blocks": {"slab": {"material": "soft"}, "block": {"material": "soft"}},
    "joints": {"rough": {"model": "penalty", "friction": friction, "stiffness_fraction": 0.5}},
    "contact": {"default_joint": "rough", "damping": {"normal": 0.2, "shear": 0.2}},
    "conditions": [{"type": "fixed", "node_set": "slab"}],
    "gravity": [g * math.sin(angle), -g * math.cos(angle), 0],
    "damping": {"mass": 60, "until": 0.2},
    "time": {"end": 0.7},
    "history": {"every": 2e-3, "probes": [{"name": "block", "block": "block"}]},
}
slide = capacity.Moves("block", limit=1e-3, since=0.3)
recipe = case.load("tests/verification/V14_incline/mesh.yaml")
deck = deck_in("incline", recipe, incline)
found = capacity.factor_of_safety(deck, slide, joints=["rough"])
check_bracket("block on an incline", found, friction / math.tan(angle))

# Ends that do not enclose it, failures, names.
still = capacity.Moves("block", limit=1e6, since=0.3)
told("no collapse", ValueError, lambda: capacity.factor_of_safety(deck, still, joints=["rough"]), "still holds at 22.781")
told("an end that is none", ValueError, lambda: capacity.bracket(lambda f: deck, slide, 2.0, 1.0), "0 < low < high")
told("a probe that is not there", KeyError, lambda: capacity.factor_of_safety(deck, capacity.Moves("top", 1e-3), joints=["rough"]), "'top'", "block")
told("a deck without the number", ValueError, lambda: capacity.load_multiplier(deck, slide), "define.multiplier")
told("tilted towards down", ValueError, lambda: capacity.tilted(deck, 1.0, towards=(0, 1, 0)), "right angles")
# From 0.5 s on gravity has no value: the run fails. A block that slides by then has collapsed; the failure of one that holds is told.
broken = deck.copy()
broken["gravity.0"] = f"t > 0.5 ? sqrt(-1) : {g * math.sin(angle)}"
failed = capacity.bracket(lambda factor: capacity.weakened(broken, 2.0, joints=["rough"]) if factor > 1 else deck, slide, 1.0, 1.005)
case.check_equal("a trial that collapsed before it failed", [(t["code"], t["collapsed"]) for t in failed.trials], [(0, False), (6, True)])
told("a run that fails and has not collapsed", RunFailed, lambda: capacity.bracket(lambda factor: broken, slide, 1.0, 2.0), "exit code")

# With cohesion besides: (c A + N tan(phi)) / T. The ends of the search lie on one side, and are moved.
cohesion, weight = 800.0, 2000 * g * 0.2 * 0.1
both = {**incline, "joints": {"rough": {**incline["joints"]["rough"], "cohesion": cohesion}}}
exact = (cohesion * 0.2 + weight * math.cos(angle) * friction) / (weight * math.sin(angle))
check_bracket("with cohesion", capacity.factor_of_safety(deck_in("cohesion", recipe, both), slide, joints=["rough"], low=0.7, high=1.1), exact)

# --- a wedge with water on its planes (V81) ------------------------------------------------------------

plunge, length, pressure = math.radians(30), 2.0, 4000.0
weight, uplift, friction = 2000 * g * length, pressure * length / 2, 0.7
down = [g * math.sin(plunge), -g * math.cos(plunge) / math.sqrt(2), -g * math.cos(plunge) / math.sqrt(2)]
wedge = {
    **incline,
    "blocks": {block: {"material": "soft"} for block in ("ground", "wall", "wedge")},
    "joints": {"rough": {"model": "penalty", "friction": friction, "stiffness_fraction": 0.5}},
    "conditions": [{"type": "fixed", "node_set": name} for name in ("ground", "wall")]
    + [{"type": "pressure", "side_set": side, "value": f"{pressure}*(1 - x/{length})"} for side in ("below", "beside")],
    "gravity": down,
    "time": {"end": 1.1},
    "history": {"every": 2e-3, "probes": [{"name": "wedge", "block": "wedge"}]},
}
exact = 2 * (weight * math.cos(plunge) / math.sqrt(2) - uplift) * friction / (weight * math.sin(plunge))
deck = deck_in("wedge", case.load("tests/verification/V81_water_in_joints/wedge.yaml"), wedge)
# Near its limit it swings on for half a second: looked at after that.
found = capacity.factor_of_safety(deck, capacity.Moves("wedge", limit=1e-3, since=0.6), joints=["rough"], low=1.2, high=1.8)
check_bracket("wedge with water", found, exact)

# --- load multipliers of a block on level ground: it slides at tan(phi) ----------------------------------

friction = 0.4
level = {
    **incline,
    "define": {"multiplier": 0.1},
    "joints": {"rough": {"model": "penalty", "friction": friction, "stiffness_fraction": 0.5}},
    "gravity": [f"{g}*multiplier*min(t/0.1, 1)", -g, 0],
}
found = capacity.load_multiplier(deck_in("pushed", recipe, level), slide, low=0.2, high=0.8)
check_bracket("block pushed by a share of its weight", found, friction)

# The same from one run each: a table that tilts by 5 degrees/s, and a force that grows.
start, rate, limit = 0.3, 10.0, 2e-4
resting = {**level, "gravity": [0, -g, 0], "time": {"end": start + 3.0}}
del resting["define"]
tilting = capacity.tilted(deck_in("tilted", recipe, resting), rate, start=start)
ended = run_deck(tilting, folder="tilted/out")
curve = capacity.curve(ended, "block", lambda t: rate * (t - start), limit, since=start)
print(curve)
growth = math.radians(rate)  # of the multiplier tan(angle), nearly
late = math.degrees(growth * (6 * limit / (g * growth)) ** (1 / 3))
case.check_equal("tilted: it collapses", curve.collapsed, True)
case.check("tilted: angle at collapse, less that of the time to get to the limit [degrees]", curve.capacity - late, math.degrees(math.atan(friction)), 0.3)

# Pushed by a given displacement: the largest reaction is the capacity.
driven = {
    **resting,
    "damping": {"mass": 60},
    "time": {"end": start + 1.0},
    "conditions": [
        {"type": "displacement", "node_set": "slab", "components": ["x"], "value": [f"-1e-3*max(0, t - {start})^2", 0, 0]},
        {"type": "fixed", "node_set": "slab", "components": ["y"]},
        {"type": "fixed", "node_set": "back", "components": ["x"]},
    ],
    "history": {"every": 2e-3, "probes": [{"name": "slab", "node_set": "slab"}, {"name": "back", "node_set": "back", "reaction": True}]},
}
held = {**recipe, "node_sets": {**recipe["node_sets"], "back": {"block": "block", "where": {"x": 0.1}}}}
ended = run_deck(deck_in("driven", held, driven))
curve = capacity.curve(ended, "slab", "back_reaction_x", 1.0, since=start)
print(curve)
case.check("driven: largest force over the weight", curve.capacity / (2000 * g * 0.2 * 0.1), friction, 5e-3, relative=True)
case.check_equal("driven: no collapse within 1 m", curve.collapsed, False)
case.finish()
