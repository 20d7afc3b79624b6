"""V95: a lining in rock whose meshes do not match along the joint between them: at rest and under pressure (Lame), with bonds and crushing, turning."""

import numpy
from coplanetest import Case

case = Case("V95", __file__)
a, b, c = 2.0, 2.3, 6.0  # radii: inside of the lining, the joint, far away [m]
young, poisson, density, stiffness = 2e10, 0.25, 2600.0, 2e10  # [Pa], [-], [kg/m^3], [Pa/m]
pressure, length = 1e6, 0.5  # [Pa], [m]
rock = {"model": "linear_elastic", "density": density, "youngs_modulus": young, "poisson_ratio": poisson}
slack = {"kinetic": True, "until_energy_ratio": 1e-10, "until_force_ratio": 1e-5}


def exact():
    """Displacements at a and on both sides of b, and the pressure there: u = A r + B / r in the lining and in the rock, which is held at c."""
    mu, bulk = young / (2 * (1 + poisson)), young / (2 * (1 + poisson) * (1 - 2 * poisson))  # bulk: lambda + mu

    def stress(r):
        return [2 * bulk, -2 * mu / r**2]

    # Unknown: A and B of the lining, of the rock, and q, the pressure in the joint.
    rows = [
        [*stress(a), 0, 0, 0],
        [*stress(b), 0, 0, 1],
        [0, 0, *stress(b), 1],
        [0, 0, c, 1 / c, 0],
        [b, 1 / b, -b, -1 / b, -1 / stiffness],
    ]
    A, B, C, D, q = numpy.linalg.solve(rows, [-pressure, 0, 0, 0, 0])
    return A * a + B / a, A * b + B / b, C * b + D / b, q


def lining(dimension, around, split=None):
    """A quarter; `around`: elements of the lining and of the rock along it."""
    parts = []
    for block, radii, radial, n in (("lining", (a, b), 3, around[0]), ("rock", (b, c), 10, around[1])):
        part = {"shape": "sector", "block": block, "inner_radius": radii[0], "outer_radius": radii[1], "from": 0, "to": 90, "divisions": [radial, n]}
        if block == "rock":
            part["bias"] = 4
        if dimension == 3:
            part["divisions"].append(2 if block == "lining" else 3)
            part["length"] = length
        if split:
            part["split"] = split
        parts.append(part)
    recipe = {
        "dimension": dimension, "parts": parts,
        "node_sets": {"x": {"where": {"x": 0}}, "y": {"where": {"y": 0}}, "far": {"where": {"radius": c}}, "inside": {"block": "lining", "where": {"radius": a}}},
        "side_sets": {"inside": {"block": "lining", "where": {"radius": a}}},
    }  # fmt: skip
    if dimension == 3:
        recipe["node_sets"] |= {"ends": {"where": {"z": 0}}, "other_ends": {"where": {"z": length}}}
    deck = {
        "materials": {"rock": rock}, "blocks": {block: {"material": "rock", "element": "one_point" if split else "assumed_strain"} for block in ("lining", "rock")},
        "joints": {"joint": {"model": "linear", "normal_stiffness": stiffness, "friction": 0.6}},
        "contact": {"pairs": [{"blocks": ["lining", "rock"], "joint": "joint", "declared": True}]},
        "conditions": [{"type": "symmetry", "node_set": axis, "normal": normal} for axis, normal in (("x", [1, 0, 0]), ("y", [0, 1, 0]))] + [{"type": "fixed", "node_set": "far"}],
        "viscosity": {"linear": 0, "quadratic": 0}, "time": {"end": 0.05, "end_at_rest": True}, "output": {"every": 0.05}, "history": {"every": 1e-3},
    }  # fmt: skip
    if dimension == 3:
        deck["conditions"] += [{"type": "symmetry", "node_set": name, "normal": [0, 0, 1]} for name in ("ends", "other_ends")]
    return recipe, deck


def of_lining(run, radius=a):
    """Displacement away from the axis of the nodes of the lining at a radius."""
    results = run.results
    nodes = numpy.array(results.nodes_of("lining"))
    nodes = nodes[numpy.abs(numpy.hypot(*results.coordinates[nodes, :2].T) - radius) < 1e-6]
    x = results.coordinates[nodes]
    return sum(results.nodal(f"displacement_{axis}")[nodes] * x[:, i] for i, axis in enumerate("xy")) / radius


def pressed(dimension, around, split=None, load=pressure, **joint):
    recipe, deck = lining(dimension, around, split)
    deck["joints"]["joint"] |= joint
    deck["conditions"].append({"type": "pressure", "side_set": "inside", "value": load})
    deck["damping"] = slack
    return recipe, deck


def short(deck):
    deck["time"] = {"end": 0.004}
    deck["output"]["every"], deck["history"]["every"] = 0.004, 1e-4
    return deck


inner, outer, of_rock, in_joint = exact()
stored = 0.5 * in_joint**2 / stiffness * 0.5 * numpy.pi * b  # in the joint, per metre [J]

# Nothing acts: nothing moves.
for name, dimension, around, split in (("rest", 2, (24, 16), None), ("rest_coarse", 2, (24, 6), None), ("rest_triangles", 2, (12, 8), "triangles"), ("rest_3d", 3, (12, 8), None),
                                       ("rest_tetrahedra", 3, (8, 6), "tetrahedra")):  # fmt: skip
    recipe, deck = lining(dimension, around, split)
    run = case.attempt(name, recipe, short(deck))
    case.check_equal(f"{name}: exit code", run.code, 0)
    case.check(f"{name}: kinetic energy [J]", run.history["kinetic"].max(), 0, 1e-15)
    case.check(f"{name}: energy in the joint [J]", run.history["contact_stored"].max(), 0, 1e-15)
    case.check_equal(f"{name}: the log tells of gaps that change along the faces", "absorb gaps that change along the faces, by up to" in " ".join(run.output.split()), True)

# Pressure inside: Lame.
meshes = {"matched": (2, (24, 24), None), "other": (2, (24, 16), None), "finer_rock": (2, (16, 24), None), "coarse_rock": (2, (24, 6), None), "matched_3d": (3, (12, 12), None),
          "other_3d": (3, (12, 8), None), "finer_rock_3d": (3, (8, 12), None), "triangles": (2, (24, 16), "triangles")}  # fmt: skip
for name, mesh in meshes.items():
    recipe, deck = pressed(*mesh)
    run = case.run(name, recipe, deck, remainder=1e-5)
    u = of_lining(run)
    bound = 5e-3 if mesh[2] else 1e-3
    for which, value in (("least", u.min()), ("largest", u.max())):
        case.check(f"{name}: inside of the lining, {which} displacement [m]", value, inner, bound, relative=True)
    depth = length if mesh[0] == 3 else 1
    case.check(f"{name}: energy in the joint [J]", run.history["contact_stored"][-1], stored * depth, 1e-2, relative=True)
    if name in ("other", "other_3d"):
        case.same_bits(name, recipe, deck, run)

# An initial stress and a pressure inside that hold each other: the joint begins with it.
for name, dimension, around, bound in (("stressed_matched", 2, (24, 24), 1e-9), ("stressed", 2, (24, 16), 1e-3), ("stressed_3d", 3, (12, 8), 4e-3)):
    recipe, deck = pressed(dimension, around)
    del deck["damping"]
    deck["initial"] = [{"block": block, "stress": [-pressure, -pressure, -pressure, 0, 0, 0]} for block in ("lining", "rock")]
    run = case.attempt(name, recipe, short(deck))  # hardly anything moves that could be conserved
    case.check_equal(f"{name}: exit code", run.code, 0)
    moved = max(numpy.abs(run.results.nodal(f"displacement_{axis}")).max() for axis in "xy")
    case.check(f"{name}: largest displacement over that of the pressure alone", moved / inner, 0, bound)

# Other laws: what they give on meshes that match.
bond = {"model": "bilinear", "tensile_strength": 1e6, "cohesion": 2e6, "tension_energy": 100, "shear_energy": 2000}
mortar = {"model": "mortar", "tensile_strength": 1e6, "cohesion": 2e6, "tension_energy": 100, "shear_energy": 2000, "compressive_strength": 2e7, "compression_energy": 5e4, "peak_crushing": 1e-4}
laws = {
    "bonded": (bond, pressure, 1e-3),
    "bent_bonds": ({**bond, "resists_bending": True}, pressure, 1e-3),
    "crushed": (mortar, 2e7, 1e-3),
}
for law, (card, load, bound) in laws.items():
    found = {}
    for kind in ("matched", "other", "finer_rock"):
        recipe, deck = pressed(*meshes[kind], load=load, **card)
        if law == "crushed":  # slowly, in many periods of the ring: damping would pass the closure of rest, or go by the signs of velocities
            del deck["damping"]
            deck["time"] = {"end": 0.025}
            deck["conditions"][-1]["value"] = f"{load}*(1 - cos(_pi*min(t/0.02, 1)))/2"
        run = case.run(f"{law}_{kind}", recipe, deck, remainder=1e-4)
        found[kind] = run
        if kind == "matched":
            continue
        same = of_lining(found["matched"]).mean()
        case.check(f"{law}, {kind}: inside of the lining, mean displacement over that of meshes that match", of_lining(run).mean() / same, 1, bound)
        if law == "crushed":
            case.check(f"{law}, {kind}: work of crushing over that of meshes that match", run.history["contact_hysteresis"][-1] / found["matched"].history["contact_hysteresis"][-1], 1, 1e-2)

# A whole ring that turns in the rock by 0.05 m, a third of a face of the lining: no energy is made or lost, whatever stops it.
for name, around, speed in (("turning_matched", (96, 96), 1.0), ("turning", (96, 64), 1.0), ("turning_coarse", (96, 24), 0.1)):
    recipe, deck = lining(2, around)
    for part in recipe["parts"]:
        part["to"] = 359.9
    recipe["node_sets"], recipe["side_sets"] = {"far": recipe["node_sets"]["far"]}, {}
    deck["joints"]["joint"]["friction"] = 0.0
    deck["conditions"] = [{"type": "fixed", "node_set": "far"}]
    deck["initial"] = [{"block": "lining", "angular_velocity": [0, 0, speed], "center": [0, 0, 0]}]
    deck["time"] = {"end": 0.05}
    run = case.run(name, recipe, deck)
    h = run.history
    case.check(f"{name}: contact remainder over the kinetic energy", numpy.abs(h["contact_remainder"]).max() / h["kinetic"][0], 0, 1e-3)

# A lining that a stage adds where a pressure on its wall has moved the rock already: its joint is closed as it lies then.
for name in ("matched", "other", "finer_rock"):
    for law, card in (("", {}), ("_bonded", bond)):
        recipe, deck = lining(*meshes[name])
        deck["joints"]["joint"] |= card
        recipe["side_sets"]["wall"] = {"block": "rock", "where": {"radius": b}}
        deck["conditions"].append({"type": "pressure", "side_set": "wall", "value": 2 * pressure})
        deck["damping"] = {"local": 0.5, "until_force_ratio": 1e-6}
        inside = {"type": "pressure", "side_set": "inside", "value": pressure}
        deck["stages"] = [{"name": "rock", "until": 0.1, "at_rest": True}, {"name": "lining", "add": ["lining"], "at_rest": True, "set": {f"conditions.{len(deck['conditions'])}": inside}}]
        deck["time"] = {"end": 0.2}
        deck["output"]["every"], deck["history"]["every"] = 0.2, 1e-3
        run = case.attempt(f"added{law}_{name}", recipe, deck)
        case.check_equal(f"added{law}_{name}: exit code", run.code, 0)
        u = of_lining(run)
        for which, value in (("least", u.min()), ("largest", u.max())):
            case.check(f"added{law}_{name}: inside of the lining, {which} displacement [m]", value, inner, 1e-3, relative=True)
        if name == "other" and not law:
            case.same_bits(f"added_{name}", recipe, deck, run)

# Forces along the common normal absorb the mean of a gap, and say so.
recipe, deck = lining(2, (24, 16))
deck["contact"]["forces"] = "common_normal"
run = case.attempt("common_normal", recipe, short(deck))
case.check_equal("common_normal: warns of joints of faces that are not parallel", "Forces along the common normal absorb only their means" in run.output, True)
case.finish()
