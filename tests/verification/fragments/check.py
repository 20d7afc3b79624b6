"""Fragments that fly and tumble fast: a search comes before anything can touch that the last one did not take (README.md)."""

import random
import sys

from coplanetest import Case

case = Case("fragments", __file__)
many = "all" in sys.argv[1:]
COMPUTATION = 6


def scene(seed):
    """Eight blocks of random sizes, one in three a thin plate, thrown at each other, each with a spin of its own."""
    rng = random.Random(seed)
    parts, initial = [], []
    for k in range(8):
        size = [rng.uniform(0.3, 0.9) for _ in range(3)]
        if rng.random() < 0.3:
            size[rng.randrange(3)] = 0.08
        center = [1.5 * (k >> axis & 1) for axis in (2, 1, 0)]
        parts.append({"shape": "box", "block": f"b{k}", "min": [-s / 2 for s in size], "max": [s / 2 for s in size],
                      "divisions": [rng.choice([1, 2, 3]) for _ in range(3)], "rotate": [rng.uniform(0, 90) for _ in range(3)],
                      "about": [0, 0, 0], "offset": center})
        speed = rng.choice([20, 100, 400])
        initial.append({"block": f"b{k}", "velocity": [(0.75 - c) * speed + rng.uniform(-0.2, 0.2) * speed for c in center],
                        "angular_velocity": [rng.uniform(-speed, speed) for _ in range(3)], "center": center})
    deck = {"materials": {"rock": {"model": "linear_elastic", "density": 2500, "youngs_modulus": 3e10, "poisson_ratio": 0.2}},
            "blocks": {f"b{k}": {"material": "rock"} for k in range(8)},
            "joints": {"touch": {"model": "penalty", "friction": rng.choice([0, 0.5])}}, "contact": {"default_joint": "touch", "search_every": "auto"},
            "initial": initial, "time": {"end": 0.01, "step_factor": 0.4}, "history": {"every": 1e-3}}
    return {"dimension": 3, "parts": parts}, deck


carried = refused = large = missed = 0
for seed in range(200 if many else 10):
    recipe, deck = scene(seed)
    run = case.attempt(f"scene_{seed}", recipe, deck)
    # Where thin plates are struck too fast for contact the program says so, and ends.
    if run.code == COMPUTATION and "too fast for the waves" in run.output:
        refused += 1
        continue
    if not case.check_equal(f"scene {seed}: exit code", run.code, 0):
        print(run.output[-2000:])
        continue
    h = run.history
    if not many or h["missed"].max() == 0:
        case.conservation(f"scene_{seed}", run, deck, energy=1e-2)
    missed += int(h["missed"].max())
    remainder = h["contact_remainder"][-1] / h["kinetic"][0]
    large += abs(remainder) > 1e-2
    if not many:
        case.check(f"scene {seed}: contact remainder over the energy", remainder, 0, 1e-2)
    carried += h["contact_friction"][-1] > 0 or abs(h["kinetic"][-1] / h["kinetic"][0] - 1) > 0.05
    if seed == 0:
        case.same_bits("scene_0", recipe, deck, run, ranks=2)
        case.same_bits("scene_0", recipe, deck, run, ranks=1, threads=2)
        often = case.attempt("scene_0_often", recipe, {**deck, "contact": {**deck["contact"], "search_every": 1}})
        case.check_within("scene 0: searches when they are needed over those of every cycle", h["searches"][-1] / often.history["searches"][-1], 0, 0.25)
case.check_within("scenes in which something was struck", carried, (150 if many else 7), float("inf"))
case.check_within("contacts missed in all scenes", missed, 0, 0)
if many:
    case.check_within("scenes with a contact remainder above 1e-2 of the energy", large, 0, 5)
case.check_within("scenes that are refused: too fast", refused, 0, 10 if many else 1)
case.finish()
