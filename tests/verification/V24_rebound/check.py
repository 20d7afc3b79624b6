"""V24: a block bounces off a linear contact, without and with damping."""

import math

import numpy
from coplanetest import Case

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
    run = case.run(f"damped_{zeta}_{name.replace(' ', '_')}", mesh, {**deck, **kind, "contact": {**deck["contact"], "damping": {"normal": zeta * math.sqrt(masses)}}})
    h = run.history
    e = restitution(zeta)
    told = f"zeta {zeta}, {name}"
    case.check(f"restitution, {told}", h["block_velocity_y"][-1] / speed, e, 0.01, relative=True)
    case.check(f"damping work, {told} [J]", h["contact_damping"][-1], (1 - e**2) * h["kinetic"][0], 0.02, relative=True)
    # Work of the dashpot by the velocity before its force alone would leave a gain of first order in the step.
    case.check(f"contact remainder, {told}, over the energy", h["contact_remainder"][-1] / h["kinetic"][0], 0, 2e-4)
case.finish()
