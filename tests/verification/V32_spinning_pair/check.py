"""V32: two blocks under pressure, with a slanting joint that bears shear, spin together for ten turns."""

import math
import sys

import numpy
from coplanetest import Case, rotation, turned_deck

case = Case("V32", __file__)
lean, pressure = math.radians(15), 2e6


def slanted(coordinates, matrix=None):
    """The cut leans by 15 degrees, the ends stay as they are."""
    changed = coordinates.copy()
    changed[:, 0] += math.tan(lean) * coordinates[:, 1] * (1 - numpy.abs(coordinates[:, 0]) / 0.1)
    if matrix is not None:
        changed = changed @ matrix.T
    return changed


for name in ("2d", "3d") if "all" in sys.argv[1:] else ("2d",):
    recipe, deck = case.load("mesh.yaml" if name == "2d" else "mesh_3d.yaml"), case.load()
    change = slanted
    if name == "3d":  # about an axis that is none of the mesh's
        matrix = rotation([30, 20, 50])
        deck = turned_deck(deck, matrix)
        change = lambda coordinates: slanted(coordinates, matrix)
    beginning = {**deck, "time": {**deck["time"], "end": 0.01}}
    first = case.run(f"{name}_beginning", recipe, beginning, change_mesh=change)
    case.same_bits(f"{name}_beginning", recipe, beginning, first, change_mesh=change)
    run = case.run(name, recipe, deck, change_mesh=change)
    h = run.history
    case.check(f"{name}: planes that slip or open", int(numpy.max(h["slip"] + h["open"])), 0, 0)
    # Shear traction of the joint: total shear force over total area, at 20 moments of each turn.
    times, tau = run.results.times, []
    for step in range(len(times)):
        planes = run.planes(step)
        tau.append(numpy.linalg.norm((planes["shear_traction"] * planes["area"][:, None]).sum(axis=0)) / planes["area"].sum())
    tau, turn = numpy.array(tau), 2 * math.pi / 100
    at_rest = pressure * math.sin(lean) * math.cos(lean)
    case.check(f"{name}: shear traction at the start [Pa]", tau[0], at_rest, 1e-9, relative=True)
    momentum = numpy.sqrt(sum(h[f"angular_momentum_{axis}"] ** 2 for axis in "xyz"))

    # The pull of rotation takes a part b w^2 of the traction. It also bends the pair by a micrometre, so that the two pressures
    # have a lever and speed it up a little; w is known from the angular momentum, and with it that part.
    spin = numpy.interp(times, h["time"], momentum)
    pull = (at_rest - tau) * (spin[0] / spin) ** 2
    means = numpy.array([numpy.mean(pull[(times > (i + 1e-3) * turn) & (times < (i + 1 + 1e-3) * turn)]) for i in range(10)])
    drift = numpy.diff(means[2:]) / at_rest
    case.check(f"{name}: change of the shear traction over its value, worst turn of turns 4 to 10", numpy.max(numpy.abs(drift)), 0, 1e-6)
case.finish()
