"""V48: a bonded joint between two blocks is pulled and sheared apart: fracture energies and strengths."""

import copy

import numpy
from coplanetest import Case

case = Case("V48", __file__)
meshes = {2: case.load("mesh.yaml"), 3: case.load("mesh_3d.yaml")}
areas = {2: 0.1, 3: 0.01}  # [m^2]; per metre of depth in two dimensions
base = case.load()
bond = base["joints"]["bed"]


def drive(name, model, legs, dimension=2):
    """Moves the upper block as a rigid body through one or two legs of constant velocity: [(vx, vy, duration)].

    Returns the history, the path of the last leg [m], and the traction along it [Pa]: what the supports of the block gave, less
    its kinetic energy, over path and area.
    """
    deck = copy.deepcopy(base)
    deck["joints"]["bed"]["model"] = model
    expressions, axis = [], 0 if legs[-1][0] else 1
    for k in (0, 1):
        text, end = repr(legs[-1][k]), 0.0
        for leg in legs[:-1]:
            end += leg[2]
            text = f"t < {end!r} ? {leg[k]!r} : ({text})"
        expressions.append(text)
    deck["conditions"].append({"type": "velocity", "node_set": "upper", "value": expressions + [0]})
    deck["time"]["end"] = sum(leg[2] for leg in legs)
    # Supports that press with 1e5 N for 0.08 s give 4000 times the momentum of the blocks, in both directions; rounding is
    # relative to that.
    h = case.run(name, meshes[dimension], deck, momentum=1e-12 if len(legs) == 1 else 4e-9).history
    start = sum(leg[2] for leg in legs[:-1])
    rows = h["time"] > start + 3 * deck["time"]["fixed_step"]
    path = numpy.abs(h[f"upper_displacement_{'xy'[axis]}"])[rows]
    work = (h["external_work"] - h["kinetic"])[rows] / areas[dimension]
    return h, path, numpy.diff(work) / numpy.diff(path)


def area_under(path, traction):
    return float(numpy.sum(traction * numpy.diff(path)))


for model in ("mortar", "bilinear"):
    for dimension in (2, 3):
        name = f"{model}_{dimension}d"
        area = areas[dimension]
        # Pulled by 1 mm: 14 times G_I / f_t.
        h, path, traction = drive(f"{name}_tension", model, [(0, 0.02, 0.05)], dimension)
        case.check(f"{name}, tension: area under the curve [J/m^2]", area_under(path, traction), bond["tension_energy"], 0.01, relative=True)
        case.check(f"{name}, tension: fracture energy [J/m^2]", h["contact_fracture"][-1] / area, bond["tension_energy"], 0.01, relative=True)
        case.check(f"{name}, tension: peak [Pa]", traction.max(), bond["tensile_strength"], 0.01, relative=True)
        case.check(f"{name}, tension: traction at the end over the peak", traction[-1] / traction.max(), 0, 1e-3)
        if dimension == 3:
            continue
        # Sheared by 4 mm, 11 times G_II / c, without and with compression.
        for pressure in (0.0, 1e6):
            down = pressure / bond["normal_stiffness"]
            legs = ([(0, -0.02, down / 0.02)] if down else []) + [(0.05, 0, 0.08)]
            h, path, traction = drive(f"{name}_shear_{pressure:.0e}", model, legs, dimension)
            # As it was pressed in whole steps.
            friction = bond["friction"] * bond["normal_stiffness"] * -h["upper_displacement_y"][-1]
            if pressure:
                case.check(f"{name}: friction of the pressed joint [Pa]", friction, bond["friction"] * pressure, 0.01, relative=True)
            what = f"{name}, shear under {pressure:.0e} Pa"
            case.check(f"{what}: peak [Pa]", traction.max(), bond["cohesion"] + friction, 0.01, relative=True)
            case.check(f"{what}: traction at the end [Pa]", traction[-1], friction, 1e-3 * bond["cohesion"])
            case.check(f"{what}: fracture energy [J/m^2]", h["contact_fracture"][-1] / area, bond["shear_energy"], 0.01, relative=True)
            # The cohesive part: what is above friction, which slips all the way but for the elastic part.
            slip = path[-1] - friction / bond["shear_stiffness"]
            stored = friction**2 / (2 * bond["shear_stiffness"])
            cohesive = area_under(path, traction) - friction * slip - stored
            case.check(f"{what}: area under the cohesive part [J/m^2]", cohesive, bond["shear_energy"], 0.01, relative=True)

# A block slides over the seam of two that are bonded: it has never been bonded to either. With a card of its own, equal to that of
# the bed, the seam must do the same.
one = case.load("deck_seam.yaml")
two = copy.deepcopy(one)
two["joints"]["seam"] = dict(two["joints"]["bed"])
two["contact"]["pairs"][0]["joint"] = "seam"
seams = {cards: case.run(f"seam_{cards}", case.load("mesh_seam.yaml"), deck).history for cards, deck in (("one", one), ("two", two))}
h = seams["one"]
case.check("seam: contact remainder over the work of the drive", abs(h["contact_remainder"][-1]) / h["external_work"][-1], 0, 1e-4)
case.check_within("seam: friction work [J]", h["contact_friction"][-1], 1e3, 1e4)
for column in ("contact_friction", "contact_stored", "kinetic"):
    case.check(f"seam: {column}, one card against two [J]", float(numpy.max(numpy.abs(h[column] - seams["two"][column]))), 0, 0)

# --- damped bonds that are pulled apart: they carry while they are open, and count in the step ----
squares = {"dimension": 2, "parts": [{"shape": "box", "block": block, "min": [0, low], "size": [0.4, 0.4], "divisions": [2, 2]} for block, low in (("lower", -0.4), ("upper", 0.0))]}
for model, damping, v in (("mortar", 0, 1.5), ("mortar", 0.5, 1.5), ("mortar", 3, 1.5), ("bilinear", 3, 4.0)):
    deck = {
        "materials": {"brick": {"model": "linear_elastic", "density": 2600, "youngs_modulus": 30e9, "poisson_ratio": 0}},
        "blocks": {"lower": {"material": "brick"}, "upper": {"material": "brick"}},
        "joints": {"bed": {"model": model, "normal_stiffness": 1e11, "friction": 0.5, "tensile_strength": 3e6, "cohesion": 4e6, "tension_energy": 500, "shear_energy": 2000}},
        "contact": {"pairs": [{"blocks": ["*", "*"], "joint": "bed", "declared": True}], "damping": {"normal": damping, "shear": damping}},
        "initial": [{"block": "lower", "velocity": [0, -v, 0]}, {"block": "upper", "velocity": [0, v, 0]}],
        "viscosity": {"linear": 0, "quadratic": 0}, "time": {"end": 6e-3}, "history": {"every": 1e-9},
    }  # fmt: skip
    # Without damping the bond breaks within some ten steps: first order.
    h = case.run(f"pulled_{model}_{damping:g}", squares, deck, remainder=0.02 if damping else 0.06).history
    energy = (h["kinetic"] + h["internal"] + h["hourglass"] + h["contact_stored"]) / h["kinetic"][0]
    case.check(f"{model} pulled apart at {v:g} m/s, damping {damping:g}: largest energy over that at the start, less 1", energy.max() - 1, 0, 1e-4)
    case.check_within(f"{model} pulled apart, damping {damping:g}: fracture energy over that of the joint", h["contact_fracture"][-1] / (500 * 0.4), 0.02, 1.02)
case.finish()
