"""Declared joints that are bent, in space: rough faults under stress and sheared, with and without bonds; and what is beside a joint, but no part of it."""

import copy
import math
import re

import numpy
from coplanetest import Case

case = Case("bent joints", __file__)
stiffness, pressure = 2e10, 1e6  # [Pa/m], [Pa]
rock = {"model": "linear_elastic", "density": 2600.0, "youngs_modulus": 2e10, "poisson_ratio": 0.25}
smooth = {"model": "linear", "normal_stiffness": stiffness, "friction": 0.0}
rough = {**smooth, "friction": 0.3}
bond = {**rough, "model": "bilinear", "tensile_strength": 1e6, "cohesion": 2e6, "tension_energy": 100, "shear_energy": 2000}


def remainder(run):
    h = run.history
    return numpy.abs(h["contact_remainder"]).max() / max(h["kinetic"].max(), numpy.abs(h["external_work"]).max(), h["contact_stored"].max())


# --- a fault between two blocks of 2 m ---------------------------------------------------------------------------------------


def fault(height, divisions, waves, law):
    """Waves of about a metre, or nodes at heights of chance."""
    sides = {"below": (-1.0, divisions[0]), "above": (0.0, divisions[1])}
    recipe = {
        "dimension": 3,
        "parts": [{"shape": "box", "block": block, "min": [0, 0, low], "size": [2, 2, 1], "divisions": [n, n, 3]} for block, (low, n) in sides.items()],
        "node_sets": {"bottom": {"where": {"z": -1}}, "top": {"where": {"z": 1}}, "x0": {"where": {"x": 0}}, "x1": {"where": {"x": 2}}, "y0": {"where": {"y": 0}}, "y1": {"where": {"y": 2}}},
        "side_sets": {"top": {"where": {"z": 1}}},
    }  # fmt: skip

    def bend(x):
        if waves:
            off = numpy.sin(2.1 * numpy.pi * x[:, 0] + 0.3) * numpy.sin(1.7 * numpy.pi * x[:, 1] + 0.7)
        else:  # the same on both sides
            off = 2 * numpy.modf(1e4 * numpy.abs(numpy.sin(13 * x[:, 0] + 29 * x[:, 1] + 1)))[0] - 1
        x[:, 2] += height * off * (1 - numpy.abs(x[:, 2]))
        return x

    held = [{"type": "symmetry", "node_set": node_set, "normal": [float(axis == node_set[0]) for axis in "xy"] + [float(node_set in ("bottom", "top"))]} for node_set in recipe["node_sets"]]
    deck = {
        "materials": {"rock": rock}, "blocks": {block: {"material": "rock"} for block in sides}, "joints": {"joint": law},
        "contact": {"pairs": [{"blocks": [*sides], "joint": "joint", "declared": True}]}, "conditions": held,
        "initial": [{"block": block, "stress": [-pressure, -pressure, -pressure, 0, 0, 0]} for block in sides],
        "viscosity": {"linear": 0, "quadratic": 0}, "time": {"end": 0.01}, "output": {"every": 0.01}, "history": {"every": 1e-4},
    }  # fmt: skip
    return recipe, deck, bend


def driven(deck, way=0.8, speed=2.0):
    """The top is pressed and led along the fault."""
    deck["conditions"] = [{"type": "fixed", "node_set": "bottom"}, {"type": "velocity", "node_set": "top", "components": ["x", "y"], "value": [f"{speed}*min(t/0.02, 1)", 0, 0]},
                          {"type": "pressure", "side_set": "top", "value": pressure}]  # fmt: skip
    deck["initial"] = [{"block": block, "stress": [0, 0, -pressure, 0, 0, 0]} for block in deck["blocks"]]
    deck["damping"], deck["contact"]["damping"] = {"mass": 20}, {"normal": 0.1, "shear": 0.1}
    deck["time"]["end"] = deck["output"]["every"] = way / speed + 0.02
    deck["history"]["every"] = deck["time"]["end"] / 200
    return deck


FAULTS = {"waves": (0.05, (6, 6), True), "waves, other meshes": (0.05, (6, 5), True), "chance": (0.03, (6, 6), False), "chance, other meshes": (0.03, (4, 5), False)}
for name, shape in FAULTS.items():
    for kind, law in (("", rough), (", bonded", bond)):
        recipe, deck, bend = fault(*shape, law)
        run = case.run(f"{name}{kind}", recipe, deck, change_mesh=bend)
        h = run.history
        case.check(f"{name}{kind}: contact remainder over what is stored in the joint", numpy.abs(h["contact_remainder"]).max() / h["contact_stored"][0], 0, 1e-6)
        moved = max(numpy.abs(run.results.nodal(f"displacement_{axis}")).max() for axis in "xyz")
        case.check(f"{name}{kind}: largest displacement over the closure", moved / (pressure / stiffness), 0, 0.1)
for name in ("waves", "waves, other meshes"):
    for kind, law in (("smooth", smooth), ("rough", rough), ("bonded", bond)):
        recipe, deck, bend = fault(*FAULTS[name], law)
        run = case.run(f"{name}, sheared, {kind}", recipe, driven(deck), change_mesh=bend)
        case.check(f"{name}, sheared by 0.8 m, {kind}: contact remainder over the energy in play", remainder(run), 0, 1e-3, kept="contact remainder")
        planes = run.planes(-1)
        carry = (planes["area"] > 0) & (planes["bonded"] == 0)
        ratio = -planes["gap"][carry] / planes["closure"][carry]  # at the centre of pressure over the mean: 1 where even, 2 at a corner
        case.check_within(f"{name}, sheared by 0.8 m, {kind}: gap over closure of planes, least", ratio.min(), 0.99, 2.01)
        case.check_within(f"{name}, sheared by 0.8 m, {kind}: gap over closure of planes, largest", ratio.max(), 0.99, 2.01)
        if kind == "bonded":
            case.same_bits(f"{name}, sheared, {kind}", recipe, deck, run, change_mesh=bend)

# --- a joint of warped faces under gravity, up to free sides -------------------------------------------------------------------


def tilted(raised):
    recipe = {
        "dimension": 3,
        "parts": [{"shape": "box", "block": "low", "min": [0, 0, 0], "size": [1, 1, 0.7], "divisions": [3, 3, 2]}, {"shape": "box", "block": "up", "min": [0, 0, 0.7], "size": [1, 1, 0.3], "divisions": [3, 3, 2]}],
        "node_sets": {"bottom": {"where": {"z": 0}}},
    }  # fmt: skip

    def bend(x):
        inside = (numpy.abs(x[:, 0] - 0.5) < 0.4) & (numpy.abs(x[:, 1] - 0.5) < 0.4)
        part = numpy.where(x[:, 2] < 0.7, x[:, 2] / 0.7, (1 - x[:, 2]) / 0.3)
        x[:, 2] += part * (0.25 * (x[:, 0] - 0.5) + raised * inside)
        return x

    deck = {
        "materials": {"rock": rock}, "blocks": {block: {"material": "rock"} for block in ("low", "up")}, "joints": {"joint": {**rough, "friction": 0.6}},
        "contact": {"pairs": [{"blocks": ["low", "up"], "joint": "joint", "declared": True}]}, "conditions": [{"type": "fixed", "node_set": "bottom"}],
        "viscosity": {"linear": 0, "quadratic": 0}, "gravity": [0, 0, -10], "time": {"end": 0.01}, "output": {"every": 0.01}, "history": {"every": 1e-4},
    }  # fmt: skip
    return recipe, deck, bend


for raised in (0.0, 0.05, 0.1):
    recipe, deck, bend = tilted(raised)
    run = case.run(f"tilted, raised by {raised} m", recipe, deck, change_mesh=bend)
    case.check(f"tilted, raised by {raised} m: contact remainder over the energy in play", remainder(run), 0, 5e-3, kept="contact remainder")
    moved = max(numpy.abs(run.results.nodal(f"displacement_{axis}")).max() for axis in "xyz")
    case.check(f"tilted, raised by {raised} m: largest displacement [m]", moved, 0, 2e-5)

# --- what is beside a joint, but no part of it: declared or met, bodies do the same ---------------------------------------------


def sloped(angle):
    """A block on a bed that slopes down, or up, from where the block ends."""
    recipe = {"dimension": 2, "parts": [{"shape": "box", "block": "bed", "min": [-2, -2], "size": [3, 2], "divisions": [3, 2]}, {"shape": "box", "block": "block", "min": [-1, 0], "size": [1, 1], "divisions": [1, 1]}],
              "node_sets": {"bottom": {"where": {"y": -2}}, "back": {"block": "block", "where": {"x": -1}}}}  # fmt: skip

    def bend(x):
        x[:, 1] += numpy.where((x[:, 0] > 1e-9) & (x[:, 1] < 1e-9), x[:, 0] * math.tan(math.radians(angle)) * (x[:, 1] + 2) / 2, 0)
        return x

    soft = {**rock, "youngs_modulus": 1e8 if angle < 0 else 1e9}
    deck = {
        "materials": {"rock": soft}, "blocks": {block: {"material": "rock"} for block in ("bed", "block")}, "joints": {"joint": {"model": "linear", "normal_stiffness": soft["youngs_modulus"], "friction": 0.1}},
        "contact": {"damping": {"normal": 0.2, "shear": 0.2}, "pairs": [{"blocks": ["bed", "block"], "joint": "joint"}]}, "conditions": [{"type": "fixed", "node_set": "bottom"}],
        "gravity": [0, -9.81, 0], "time": {"end": 0.9}, "output": {"every": 0.9}, "history": {"every": 0.01},
    }  # fmt: skip
    if angle < 0:  # over the crest
        deck["initial"] = [{"block": "block", "velocity": [2, 0, 0]}]
    else:  # up the ramp
        deck["conditions"].append({"type": "velocity", "node_set": "back", "components": ["x"], "value": ["0.5*min(t/0.1, 1)", 0, 0]})
        deck["damping"] = {"mass": 4}
    return recipe, deck, bend


for name, angle in (("over a crest", -40), ("up a ramp", 30)):
    places = []
    for declared in (False, True):
        recipe, deck, bend = sloped(angle)
        deck["contact"]["pairs"][0]["declared"] = declared
        run = case.attempt(f"{name}, {'declared' if declared else 'met'}", recipe, deck, change_mesh=bend)
        case.check_equal(f"{name}, {'declared' if declared else 'met'}: exit code", run.code, 0)
        nodes = run.results.nodes_of("block")
        places.append(numpy.stack([run.results.nodal(f"displacement_{axis}")[nodes] for axis in "xy"]))
    case.check(f"{name}: largest difference of a displacement, declared or met [m]", numpy.abs(places[1] - places[0]).max(), 0, 5e-3)

# A layer that is thin for its faces: the bodies on both sides of it are no joint, whatever is declared.
for around in ((16, 16, 16), (16, 12, 20), (16, 9, 9, 16)):
    inside = []
    for pairs in ([["*", "*"]], [[], []]):
        radii = {"inner": (1.0, 1.5), "layer": (1.5, 1.52), "second": (1.52, 1.54), "outer": (1.52, 2.0)}
        if len(around) == 3:
            del radii["second"]
        else:
            radii["outer"] = (1.54, 2.0)
        pairs = pairs if len(pairs) == 1 else [[one, next_one] for one, next_one in zip([*radii], [*radii][1:])]
        recipe = {"dimension": 2, "parts": [{"shape": "sector", "block": block, "inner_radius": r[0], "outer_radius": r[1], "from": 0, "to": 90, "divisions": [1 if block in ("layer", "second") else 3, n]} for (block, r), n in zip(radii.items(), around)],
                  "node_sets": {"x": {"where": {"x": 0}}, "y": {"where": {"y": 0}}}, "side_sets": {"inside": {"block": "inner", "where": {"radius": 1.0}}}}  # fmt: skip
        deck = {
            "materials": {"rock": rock}, "blocks": {block: {"material": "rock"} for block in radii}, "joints": {"joint": {**rough, "normal_stiffness": 1e11}},
            "contact": {"pairs": [{"blocks": blocks, "joint": "joint", "declared": True} for blocks in pairs], "default_joint": "joint"},
            "conditions": [{"type": "symmetry", "node_set": axis, "normal": normal} for axis, normal in (("x", [1, 0, 0]), ("y", [0, 1, 0]))] + [{"type": "pressure", "side_set": "inside", "value": 1e5}],
            "damping": {"kinetic": True, "until_energy_ratio": 1e-10, "until_force_ratio": 1e-5}, "time": {"end": 0.05, "end_at_rest": True}, "output": {"every": 0.05}, "history": {"every": 1e-3},
        }  # fmt: skip
        run = case.run(f"layer {around}, {len(pairs)} items", recipe, deck)
        inside.append(run.results.nodal("displacement_x")[run.results.nodes_of("inner")].max())
    case.check(f"layer {around}: displacement inside with all pairs declared over that with those of the layers", inside[0] / inside[1], 1, 1e-6)

# One bent place of large faces is no reason to look farther elsewhere.
found = []
for kink in (0.0, 0.7):
    recipe = {
        "dimension": 3,
        "parts": [{"shape": "box", "block": block, "min": low, "size": size, "divisions": n} for block, low, size, n in (("a", [-2, 0, -2], [4, 1, 2], [4, 1, 2]), ("b", [-2, 0, 0], [4, 1, 2], [4, 1, 2]), ("c", [10, 0, -0.1], [1.2, 1.2, 0.1], [16, 16, 2]), ("d", [10, 0, 0], [1.2, 1.2, 0.1], [16, 16, 2]))],
    }  # fmt: skip

    def bend(x, kink=kink):
        x[:, 2] += numpy.where(x[:, 0] < 5, kink * numpy.maximum(x[:, 0], 0) * (1 - numpy.abs(x[:, 2]) / 2), 0)
        return x

    deck = {"materials": {"rock": rock}, "blocks": {block: {"material": "rock"} for block in "abcd"}, "joints": {"joint": rough}, "contact": {"pairs": [{"blocks": ["*", "*"], "joint": "joint", "declared": True}]},
            "time": {"end": 1e-5}, "output": {"every": 1e-5}, "history": {"every": 1e-5}}  # fmt: skip
    run = case.attempt(f"kink {kink}", copy.deepcopy(recipe), deck, change_mesh=bend)
    found.append(int(re.search(r"(\d+) candidate pairs", run.output).group(1)))
case.check("a kink elsewhere: candidate pairs over those without it", found[1] / found[0], 1, 0.05)
case.finish()
