"""A model that lies far from the origin, at map coordinates, moves as one beside it: no motion is too small for its place."""

import numpy
from coplanetest import Case

case = Case("far_away", __file__)
PLACE = numpy.array([4.5e6, 5.2e6, 310.0])
ROCK = {"model": "linear_elastic", "density": 2400, "youngs_modulus": 3e10, "poisson_ratio": 0.2}
DIGITS = 2.0**-30  # what places are rounded to there [m]


def both(name, recipe, deck):
    """Runs of the deck at the origin and at the place. What is pressed slowly has 1e-6 of the impulse in its momentum, which is measured
    against its own."""
    place = PLACE[: recipe["dimension"]]
    near = case.run(f"{name}_near", recipe, deck, remainder=1e-3, momentum=1e-9, angular=1e-9)
    far = case.run(f"{name}_far", recipe, deck, momentum=1e-9, angular=1e-9, change_mesh=lambda x: x + place)
    return near, far


# --- a specimen that is pressed slowly between a wall and a platen -------------------------------------------------------
def pressed(speed, dimension=2, rigid=False, subcycled=False):
    deep = [0.2] if dimension == 3 else []

    def part(block, x, size, divisions):
        return {"shape": "box", "block": block, "min": [x, 0, 0][:dimension], "size": [size, 0.2, *deep], "divisions": divisions + [2] * len(deep)}

    recipe = {"dimension": dimension, "parts": [part("wall", 0, 0.1, [1, 2]), part("specimen", 0.1, 0.4, [6 if subcycled else 4, 3]), part("platen", 0.5, 0.1, [4 if subcycled else 1, 2])],
              "node_sets": {"wall": {"block": "wall"}, "platen": {"block": "platen"}}}  # fmt: skip
    push = {"type": "rigid_motion", "block": "platen", "velocity": [-speed, 0, 0]} if rigid else {"type": "velocity", "node_set": "platen", "value": [-speed, 0, 0]}
    deck = {"materials": {"rock": ROCK}, "blocks": {"wall": {"material": "rock"}, "specimen": {"material": "rock"}, "platen": {"material": "rock", "rigid": rigid}},
            "conditions": [{"type": "fixed", "node_set": "wall"}, push], "damping": {"mass": 2000}, "output": {"planes": False},
            "time": {"end": 0.01 if speed > 1e-4 else 0.03, **({"subcycling": {"levels": 3}} if subcycled else {})},
            "history": {"every": 1e-3, "probes": [{"name": "platen", "block": "platen"}, {"name": "wall", "node_set": "wall", "reaction": True}]}}  # fmt: skip
    return recipe, deck


for name, speed, options in (("a specimen", 1e-3, {}), ("a specimen, slowly", 2e-5, {}), ("a specimen in space", 1e-3, {"dimension": 3}), ("a rigid platen, slowly", 2e-5, {"rigid": True}),
                             ("substeps", 1e-3, {"subcycled": True}), ("substeps, slowly", 2e-5, {"subcycled": True})):  # fmt: skip
    folder = name.replace(" ", "_").replace(",", "")
    recipe, deck = pressed(speed, **options)
    near, far = both(folder, recipe, deck)
    h, f = near.history, far.history
    way = speed * f["time"][-1]
    case.check(f"{name}: way of the platen [m]", -f["platen_displacement_x"][-1], way, 2 * DIGITS)
    case.check(f"{name}: reaction of the wall far away over that at the origin", f["wall_reaction_x"][-1] / h["wall_reaction_x"][-1], 1, 2e-2 if speed < 1e-4 else 1e-3)
case.same_bits("substeps_slowly_far", recipe, deck, far, ranks=2, threads=2, change_mesh=lambda x: x + PLACE[:2])
case.restarts("substeps_slowly_far", recipe, deck, far, 0.5 * deck["time"]["end"], change_mesh=lambda x: x + PLACE[:2])

# --- the watch on the energy sees the same ----------------------------------------------------------------------------------
recipe, deck = pressed(1e-3)
deck["time"]["energy_tolerance"] = 1e-14  # less than round-off
for where, place in (("at the origin", 0 * PLACE[:2]), ("far away", PLACE[:2])):
    watched = case.attempt(f"watched_{where.replace(' ', '_')}", recipe, deck, change_mesh=lambda x: x + place)
    case.check_equal(f"{where}: exit code of a run that has to hold its energy to less than round-off", watched.code, 6)

# --- a rigid body that flies slowly and turns ---------------------------------------------------------------------------
recipe = {"dimension": 3, "parts": [{"shape": "box", "block": "body", "size": [0.3, 0.2, 0.1], "divisions": [3, 2, 1]}]}
deck = {"materials": {"rock": ROCK}, "blocks": {"body": {"material": "rock", "rigid": True}}, "time": {"end": 0.1, "fixed_step": 1e-5}, "output": {"planes": False},
        "initial": [{"block": "body", "velocity": [3e-6, -2e-6, 1e-6]}], "history": {"every": 0.01, "rigid": ["body"]}}  # fmt: skip
near, far = both("flies", recipe, deck)
for c, speed in zip("xyz", (3e-6, -2e-6, 1e-6)):
    case.check(f"a rigid body in flight: way along {c} [m]", far.history[f"body_displacement_{c}"][-1], 0.1 * speed, 2 * DIGITS)

# --- a block that slides down an incline --------------------------------------------------------------------------------
tangent = 0.5
recipe = {"dimension": 2, "parts": [{"shape": "box", "block": "slab", "min": [0, -0.2], "size": [2, 0.2], "divisions": [10, 1]}, {"shape": "box", "block": "block", "min": [0.3, 0], "size": [0.3, 0.3], "divisions": [2, 2]}],
          "node_sets": {"slab": {"block": "slab"}}}  # fmt: skip
deck = {"materials": {"rock": ROCK}, "blocks": {"slab": {"material": "rock"}, "block": {"material": "rock"}}, "joints": {"rough": {"model": "penalty", "friction": 0.3}},
        "contact": {"default_joint": "rough", "damping": {"normal": 0.2}}, "gravity": [10 * tangent, -10, 0], "conditions": [{"type": "fixed", "node_set": "slab"}],
        "time": {"end": 0.1}, "output": {"planes": False}, "history": {"every": 1e-3, "probes": [{"name": "block", "block": "block"}]}}  # fmt: skip
near, far = both("slides", recipe, deck)
case.check("a block on an incline: speed far away over that at the origin", far.history["block_velocity_x"][-1] / near.history["block_velocity_x"][-1], 1, 1e-3)
case.check("a block on an incline: speed far away [m/s]", far.history["block_velocity_x"][-1], 10 * (tangent - 0.3) * far.history["time"][-1], 2e-2, relative=True)
case.check_equal("a model far from the origin is warned of", "from the origin, where" in far.output, True)
case.finish()
