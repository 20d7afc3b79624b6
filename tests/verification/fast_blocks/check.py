"""Blocks that collide at the speed of waves, flat with an offset and turned: contact makes no energy, and nothing passes through."""

import itertools
import sys

import numpy
from coplanetest import Case, rotation

case = Case("fast_blocks", __file__)
modulus, ratio, density, gap = 1e9, 0.25, 1000.0, 0.01
wave = (modulus * (1 - ratio) / ((1 + ratio) * (1 - 2 * ratio)) / density) ** 0.5


def turn_left(dimension):
    """Turns the left block about its centre, edges and corner ahead, and puts it a gap away from the right one again."""
    by = rotation((0, 12, 17) if dimension == 3 else 17)[:dimension, :dimension]

    def change(x):
        x = x.copy()
        left = x[:, 0] < -gap / 2
        center = x[left].mean(axis=0)
        x[left] = (x[left] - center) @ by.T + center
        x[left, 0] -= x[left, 0].max() + gap
        return x

    return change


def collide(dimension, cells, speed, turned, step_factor=None):
    """A block of `cells` elements along each edge is thrown at one at rest, at `speed` times that of P waves."""
    where = {"left": [-1 - gap, 0.1, 0.07], "right": [0, 0, 0]}
    parts = [
        {"shape": "box", "block": name, "min": place[:dimension], "size": [1] * dimension, "divisions": [cells] * dimension}
        for name, place in where.items()
    ]
    deck = {
        "materials": {"soft": {"model": "neo_hookean", "density": density, "youngs_modulus": modulus, "poisson_ratio": ratio}},
        "blocks": {"left": {"material": "soft"}, "right": {"material": "soft"}},
        "initial": [{"block": "left", "velocity": [speed * wave, 0, 0]}],
        "time": {"end": 3 / wave},
        "history": {"probes": [{"name": "left", "block": "left"}, {"name": "right", "block": "right"}]},
    }
    if step_factor:
        deck["time"]["step_factor"] = step_factor
    name = f"{dimension}d_{cells}_{speed}_{'turned' if turned else 'flat'}_{step_factor or 'usual'}"
    run = case.attempt(
        name, {"dimension": dimension, "parts": parts}, deck, change_mesh=turn_left(dimension) if turned else None
    )
    # Faces that lie deeper in bodies than contact can bear, at speeds above that of waves: refused, and told so.
    if run.code == 6 and "faster than waves run in them" in run.output:
        return None
    case.check_equal(f"{name}: exit code", run.code, 0, "nothing stopped it")
    if run.code:
        return None
    h = run.history
    apart = h["right_velocity_x"][-1] - h["left_velocity_x"][-1]
    case.check_within(f"{name}: velocity apart over that of the throw", apart / (speed * wave), 0.02, 1)
    return numpy.max(numpy.abs(h["contact_remainder"])) / h["kinetic"][0]


# Of the energy, at the usual step and at a fourth of it, by dimension and whether a block is turned.
tolerances = {(2, False): (1.5e-2, 3e-3), (2, True): (1e-2, 2e-3), (3, False): (1.5e-2, 3e-3), (3, True): (5e-3, 5e-3)}
meshes = (2, 3, 4) if "all" in sys.argv else (2, 4)
refused = 0
for dimension, turned in itertools.product((2, 3), (False, True)):
    scene = f"{dimension}D, {'turned' if turned else 'flat'}: contact remainder over the energy"
    usual, short = [], []
    for cells, speed in itertools.product(meshes, (0.3, 0.8, 1.3)):
        both = [collide(dimension, cells, speed, turned, step_factor) for step_factor in (None, 0.2)]
        refused += sum(remainder is None for remainder in both)
        if None not in both:
            usual.append(both[0])
            short.append(both[1])
    case.check(f"{scene}, largest of {len(usual)}", max(usual), 0, tolerances[dimension, turned][0])
    case.check(f"{scene}, at a fourth of the step", max(short), 0, tolerances[dimension, turned][1])
    case.check_within(f"{scene}, mean at a fourth of the step over mean", sum(short) / sum(usual), 0, 0.5)
case.check_within("collisions that were refused", refused, 0, 2)

case.finish()
