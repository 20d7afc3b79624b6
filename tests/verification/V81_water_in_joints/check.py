"""V81: water in joints: a submerged block, a wedge with water on its planes, uplift under a dam."""

import math

import numpy
from coplanetest import Case

case = Case("V81", __file__)
g, water = 9.81, 9810.0  # [m/s^2], [N/m^3]


def rock(density, poisson_ratio=0.2, youngs_modulus=1e9):
    return {"model": "linear_elastic", "density": density, "youngs_modulus": youngs_modulus, "poisson_ratio": poisson_ratio}


# --- a block under water, at rest from the start -------------------------------------------------------

depth, density = 3.0, 2000.0  # [m] of water over the floor, [kg/m^3]


def on_the_floor(unit_weight):
    """Under still water of this unit weight. The initial stress is that of water and weight together, the total one; the joint starts with what
    is left of it, the effective stress."""
    value = f"{unit_weight}*({depth} - y)"
    start = {
        "stress": [-unit_weight * depth, -unit_weight * (depth - 1) - density * g, 0, 0, 0, 0],
        "stress_gradient": [unit_weight, density * g, 0, 0, 0, 0],
    }
    return {
        "materials": {"rock": rock(density, poisson_ratio=0.0)},
        "blocks": {"floor": {"material": "rock"}, "stone": {"material": "rock"}},
        "joints": {"bed": {"model": "penalty", "friction": 0.5}},
        "contact": {"pairs": [{"blocks": ["floor", "stone"], "joint": "bed", "declared": True}]},
        "conditions": [{"type": "fixed", "node_set": "floor"}]
        + [{"type": "pressure", "side_set": side, "value": value} for side in ("left", "right", "top", "bed")],
        "initial": [{"block": block, **start} for block in ("floor", "stone")],
        "gravity": [0, -g, 0],
        "time": {"end": 0.05},
        "history": {"joints": ["bed"], "probes": [{"name": "stone", "block": "stone"}]},
    }


for name, unit_weight in (("dry", 0.0), ("submerged", water)):
    run = case.run(name, case.load("block.yaml"), on_the_floor(unit_weight))
    case.same_bits(name, case.load("block.yaml"), on_the_floor(unit_weight), run, ranks=3)
    history = run.history
    force = density * g - unit_weight
    case.check(f"{name}: force of the joint, weight less buoyancy, at the start [N]", history["bed_normal_force"][0], force, 1e-9, relative=True)
    case.check(f"{name}: force of the joint, farthest from that [N]", numpy.max(numpy.abs(history["bed_normal_force"] - force)), 0, 1e-6)
    moved = numpy.max(numpy.abs([history[f"stone_displacement_{axis}"] for axis in "xyz"]))
    case.check(f"{name}: moves [m]", moved, 0, 1e-12)

# --- a wedge on two planes, dry and with water ----------------------------------------------------------

# Seen along the line where the planes meet, each of them dips 45 degrees; the line plunges by `plunge`. Effective normal forces
# N = W cos(plunge)/sqrt 2 - U, so F = 2 N tan(phi)/(W sin(plunge)).
plunge, length = math.radians(30), 2.0
weight = 2000 * g * length  # section of 1 m^2 [N]
pressure = 4000.0  # at the upper end of the planes, falling to zero at the lower one [Pa]
uplift = pressure * length / 2  # on each plane [N]


def wedge(friction, wet, end, until):
    """The mesh lies along its planes; gravity is turned."""
    down = [g * math.sin(plunge), -g * math.cos(plunge) / math.sqrt(2), -g * math.cos(plunge) / math.sqrt(2)]
    fixed = [{"type": "fixed", "node_set": name} for name in ("ground", "wall")]
    wetted = [{"type": "pressure", "side_set": side, "value": f"{pressure}*(1 - x/{length})"} for side in ("below", "beside")]
    return {
        "materials": {"rock": rock(2000, poisson_ratio=0.0, youngs_modulus=50e6)},
        "blocks": {block: {"material": "rock"} for block in ("ground", "wall", "wedge")},
        "joints": {"plane": {"model": "penalty", "friction": friction, "stiffness_fraction": 0.5}},
        "contact": {"default_joint": "plane", "damping": {"normal": 0.2, "shear": 0.2}},
        "conditions": fixed + (wetted if wet else []),
        "gravity": down,
        "damping": {"mass": 60, "until": until},
        "time": {"end": end},
        "history": {"every": 2e-3, "probes": [{"name": "wedge", "block": "wedge"}]},
    }


for name, wet in (("dry wedge", False), ("wet wedge", True)):
    normal = weight * math.cos(plunge) / math.sqrt(2) - (uplift if wet else 0)
    just = weight * math.sin(plunge) / (2 * normal)  # the friction of F = 1
    for factor in (0.98, 1.02):
        run = case.run(f"{name.replace(' ', '_')}_{factor}", case.load("wedge.yaml"), wedge(just * factor, wet, 0.9, 0.3))
        if wet and factor < 1:
            case.restarts("wet_wedge", case.load("wedge.yaml"), wedge(just * factor, wet, 0.9, 0.3), run, 0.4)
        time, speed = run.history["time"], run.history["wedge_velocity_x"]
        if factor < 1:
            late = time > 0.6
            acceleration = numpy.polyfit(time[late], speed[late], 1)[0]
            case.check(f"{name}, F = {factor}: acceleration [m/s^2]", acceleration, g * math.sin(plunge) * (1 - factor), 0.03, relative=True)
        else:
            case.check(f"{name}, F = {factor}: largest speed after 0.8 s [m/s]", numpy.max(numpy.abs(speed[time > 0.8])), 0, 5e-4)

# --- uplift under a dam --------------------------------------------------------------------------------

head, base, height, concrete = 9.0, 8.0, 10.0, 2400.0
ramp = "min(t/0.1, 1)"
deck = {
    "materials": {"rock": rock(2600), "concrete": rock(concrete)},
    "blocks": {"rock": {"material": "rock"}, "dam": {"material": "concrete"}},
    "joints": {"base": {"model": "linear", "normal_stiffness": 5e9, "shear_stiffness": 5e9, "friction": 0.75}},
    "contact": {"default_joint": "base", "damping": {"normal": 0.2, "shear": 0.2}},
    "conditions": [
        {"type": "fixed", "node_set": "foot"},
        {"type": "pressure", "side_set": "face", "value": f"{water}*({head} - y)*{ramp}"},
        {"type": "pressure", "side_set": "bed", "value": f"{water}*{head}*{ramp}"},
        {"type": "pressure", "side_set": "base", "value": f"{water}*{head}*(1 - x/{base})*{ramp}"},
    ],
    "gravity": [0, -g, 0],
    "damping": {"mass": 50},
    "time": {"end": 1.0},
    "output": {"planes": False},
    "history": {"every": 0, "joints": ["base"], "probes": [{"name": "foot", "node_set": "foot", "reaction": True}]},
}
run = case.run("dam", case.load("dam.yaml"), deck)
case.restarts("dam", case.load("dam.yaml"), deck, run, 0.05)  # while the water rises
history, results = run.history, run.results
thrust, uplift, own = water * head**2 / 2, water * head * base / 2, concrete * g * base * height
place = results.coordinates + results.nodal("displacement")
at_base = (results.coordinates[:, 1] == 0) & numpy.isin(numpy.arange(len(place)), numpy.unique(results.connectivity("dam")))
force = results.nodal("contact_force")[at_base]
case.check("dam: effective force of the base [N]", force[:, 1].sum(), own - uplift, 3e-4, relative=True)
case.check("dam: the same from the history [N]", history["base_normal_force"][-1], own - uplift, 3e-4, relative=True)
case.check("dam: shear force of the base [N]", -force[:, 0].sum(), thrust, 3e-4, relative=True)
moment = own * base / 2 + thrust * head / 3 - uplift * base / 3
case.check("dam: the force acts behind the heel by [m]", (place[at_base, 0] * force[:, 1]).sum() / force[:, 1].sum(), moment / (own - uplift), 1e-3, relative=True)
# What the foot of the rock carries is total: uplift pushes the rock as much as it lifts the dam.
ground = 2600 * g * 14 * 3
case.check("dam: reaction of the foot, up [N]", history["foot_reaction_y"][-1], own + ground + water * head * 3, 3e-4, relative=True)
case.check("dam: reaction of the foot, against the water [N]", history["foot_reaction_x"][-1], -thrust, 3e-4, relative=True)
case.finish()
