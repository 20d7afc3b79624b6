"""V24: a block bounces off a linear contact, without and with damping."""

import copy
import math
import sys

import numpy
from coplanetest import Case, tellings

case = Case("V24", __file__)
length, density, modulus, stiffness, speed = 0.1, 2300.0, 33e9, 1e9, 1.0
frequency = math.sqrt(stiffness / (density * length))  # of the rigid block [rad/s]
# An elastic bar, free at its top, on a spring at its base: beta L tan(beta L) = k L / E, of which the first root
# gives omega = sqrt(k/m) (1 - epsilon/6), epsilon = k L / E.
elastic = frequency * (1 - stiffness * length / modulus / 6)

deck = case.load()
run = case.run("elastic", case.load("mesh.yaml"), deck, remainder=1e-3)
h = run.history
touching = h["time"][numpy.flatnonzero(h["stick"] + h["slip"])]
case.check("time in contact [s]", touching[-1] - touching[0], math.pi / elastic, 0.01, relative=True)
case.check("largest closure [m]", -numpy.min(h["base_displacement_y"]), speed / frequency, 0.01, relative=True)
case.check("restitution", h["block_velocity_y"][-1] / speed, 1, 0.01)
# A closure taken half a step too early would feed energy in at a rate of omega^2 dt / 2.
case.check("drift of the energy", numpy.max(numpy.abs(h["error"])) / h["kinetic"][0], 0, 1e-3)


def restitution(zeta):
    """Of a rigid mass on a spring k and a dashpot 2 zeta sqrt(k m) that push but never pull.

    In units of 1/frequency, with w^2 = 1 - zeta^2: x = exp(-zeta t) sin(w t) / w. The force vanishes, and the mass
    leaves, when tan(w t) = -2 zeta w / (1 - 2 zeta^2); its speed is then exp(-zeta t). (A dashpot that may
    pull until the closure is zero would give exp(-pi zeta / w).)
    """
    w = math.sqrt(1 - zeta**2)
    return math.exp(-zeta / w * (math.pi - math.atan2(2 * zeta * w, 1 - 2 * zeta**2)))


# Damping is a fraction of critical for what moves with the surfaces: half of the element behind each. A block that is one
# element high has so many times that mass, and feels zeta over the root: quadrilaterals 2, triangles 4, tetrahedra 6, in
# one element or in several, in one part or cut into flush ones, in space and as a disc. The anvil is made so heavy that
# it does not count.
deck["materials"]["anvil"]["density"] = 2.3e9
# A dashpot takes the velocity half a step before its force: an error of first order, 1.4 % at 0.8 and zeta 0.6.
deck["time"]["step_factor"] = 0.4


def block(parts=1, elements=1, dimension=2, simplices=False):
    """The block, one element high, in flush parts; the slab starts where the block does in a body of revolution."""
    mesh = case.load("mesh_element.yaml")
    width, depth = 0.1 / parts, [0.1] * (dimension - 2)
    mesh["dimension"] = dimension
    slab = mesh["parts"][1]
    slab["min"], slab["size"], slab["divisions"] = [slab["min"][0], -0.1, *[-0.1] * len(depth)], [0.3, 0.1, *[0.3] * len(depth)], [1] * dimension
    mesh["parts"] = [{"shape": "box", "block": "block", "min": [i * width, 0, *[0] * len(depth)], "size": [width, 0.1, *depth], "divisions": [elements, 1, *[elements] * len(depth)],
                      **({"split": "tetrahedra" if depth else "triangles"} if simplices else {})} for i in range(parts)] + [slab]  # fmt: skip
    return mesh


def disc():
    mesh = block(elements=4)
    mesh["parts"][1].update(min=[0, -0.1], size=[0.3, 0.1])
    return mesh


for zeta, name, mesh, masses, kind in (
    (0.05, "one element", block(), 2, {}),
    (0.21545, "one element", block(), 2, {}),
    (0.21545, "four elements", block(elements=4), 2, {}),
    (0.21545, "four parts", block(4), 2, {}),
    (0.21545, "triangles", block(elements=4, simplices=True), 4, {}),
    (0.21545, "hexahedra", block(elements=2, dimension=3), 2, {}),
    (0.21545, "tetrahedra", block(elements=2, dimension=3, simplices=True), 6, {}),
    (0.21545, "a disc", disc(), 2, {"geometry": "axisymmetric"}),
    (0.6, "one element", block(), 2, {}),
):
    if tellings.wanted() and name != "one element":
        continue
    run = case.run(f"damped_{zeta}_{name.replace(' ', '_')}", mesh, {**deck, **kind, "contact": {**deck["contact"], "damping": {"normal": zeta * math.sqrt(masses)}}})
    h = run.history
    e = restitution(zeta)
    told = f"zeta {zeta}, {name}"
    case.check(f"restitution, {told}", h["block_velocity_y"][-1] / speed, e, 0.01, relative=True)
    case.check(f"damping work, {told} [J]", h["contact_damping"][-1], (1 - e**2) * h["kinetic"][0], 0.02, relative=True)
    # Work of the dashpot by the velocity before its force alone would leave a gain of first order in the step.
    case.check(f"contact remainder, {told}, over the energy", h["contact_remainder"][-1] / h["kinetic"][0], 0, 2e-4)

if tellings.wanted():  # bounces of one block are what is told in other words
    case.finish()
    sys.exit()

# --- curves that are passed within a step ---------------------------------------------------------
# Two squares of four elements meet; the bodies close the whole curve in one step or less. With half of the time error at
# most they keep what is theirs, less the loss of the curve, whatever the step.
squares = {"dimension": 2, "parts": [{"shape": "box", "block": block, "min": [0, low], "size": [0.4, 0.4], "divisions": [2, 2]} for block, low in (("lower", -0.4002), ("upper", 0.0))]}
laws = {
    "closure_curve": {"model": "closure_curve", "initial_stiffness": 1e10, "maximum_closure": 1e-4},
    "table": {"model": "table", "closures": [5e-5, 1e-4, 1.5e-4], "tractions": [5e5, 2e6, 6e6]},
}
for name, law in laws.items():
    for v in (1.0, 5.0):
        lost = {}
        for factor in (0.8, 0.1):
            told = f"{name}, {v:g} m/s, step factor {factor}"
            deck = {
                "materials": {"rock": {"model": "linear_elastic", "density": 2600, "youngs_modulus": 30e9, "poisson_ratio": 0}},
                "blocks": {"lower": {"material": "rock"}, "upper": {"material": "rock"}}, "joints": {"curve": law}, "contact": {"default_joint": "curve"},
                "initial": [{"block": "lower", "velocity": [0, v, 0]}, {"block": "upper", "velocity": [0, -v, 0]}],
                "viscosity": {"linear": 0, "quadratic": 0}, "time": {"end": 1e-3 + 2e-4 / v, "step_factor": factor}, "history": {"every": 1e-9},
            }  # fmt: skip
            h = case.run(f"{name}_{v:g}_{factor}", squares, deck, remainder=0.05).history
            energy = (h["kinetic"] + h["internal"] + h["hourglass"] + h["contact_stored"]) / h["kinetic"][0]
            lost[factor] = h["contact_hysteresis"][-1] / h["kinetic"][0]
            case.check(f"{told}: largest energy over that at the start, less 1", energy.max() - 1, 0, 2e-3)
            case.check(f"{told}: fall of the hysteresis over the energy", max(0.0, -numpy.diff(h["contact_hysteresis"]).min()) / h["kinetic"][0], 0, 1e-14)
            case.check(f"{told}: what is lost, without the hysteresis", 1 - energy[-1] - lost[factor], 0, 0.03 if factor == 0.8 else 3e-3)
        case.check(f"{name}, {v:g} m/s: hysteresis at a step factor of 0.8 over that at 0.1", lost[0.8] / lost[0.1], 1, 1e-9)

# Uneven closures on a curve that gets a hundred times as stiff: the upper square is turned by 1e-4 over its width; in space, too.
for dimension in (2, 3):
    more = [0.0] * (dimension - 2)
    turned = {"dimension": dimension, "parts": [
        {"shape": "box", "block": block, "min": [0, low, *more], "size": [0.4] * dimension, "divisions": [2] * dimension, **({"rotate": [*more, *more, 0.0143] if more else 0.0143} if low == 0 else {})}
        for block, low in (("lower", -0.4004), ("upper", 0.0))]}  # fmt: skip
    steep = copy.deepcopy(deck)
    steep["joints"] = {"curve": {**laws["closure_curve"], "stiffness_cap": 1e12}}
    steep["time"] = {"end": 1e-3}
    h = case.run(f"steep_{dimension}", turned, steep, remainder=0.1, energy=5e-3).history
    energy = (h["kinetic"] + h["internal"] + h["hourglass"] + h["contact_stored"]) / h["kinetic"][0]
    case.check(f"steep curve, turned, {dimension}D: largest energy over that at the start, less 1", energy.max() - 1, 0, 0.02)
    case.check(f"steep curve, turned, {dimension}D: fall of the hysteresis over the energy", max(0.0, -numpy.diff(h["contact_hysteresis"]).min()) / h["kinetic"][0], 0, 1e-14)
    case.check_within(f"steep curve, turned, {dimension}D: hysteresis over the energy", h["contact_hysteresis"][-1] / h["kinetic"][0], 1e-5, 0.1)
case.finish()
