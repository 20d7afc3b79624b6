"""Joints of a table and of Barton and Bandis between blocks, in two and three dimensions, on meshes that match and that do not."""

import math
import sys

import numpy
from coplanetest import Case

case = Case("joint laws", __file__)
SIDE = 0.1  # of the joint [m]
AREA = {2: SIDE, 3: SIDE**2}  # per metre of depth in two dimensions [m^2]
MESHES = {
    "plane, matched": (2, (8, 1), (4, 1)),
    "plane, not matched": (2, (7, 1), (5, 1)),
    "solid, matched": (3, (4, 1, 2), (2, 1, 2)),
    "solid, not matched": (3, (5, 1, 3), (3, 1, 2)),
}
if "all" not in sys.argv[1:]:
    del MESHES["plane, not matched"], MESHES["solid, matched"]


def recipe(dimension, lower, upper):
    """The mesh with these divisions. A body with a third axis lies between z = 0 and 0.1; the lower block is 0.05 wider on each side."""
    made = case.load("mesh.yaml")
    for part, divisions in zip(made["parts"], (lower, upper)):
        part["divisions"] = list(divisions)
        if dimension == 3:
            over = 0.05 if part["block"] == "lower" else 0.0
            part["min"], part["size"] = [*part["min"], -over], [*part["size"], SIDE + 2 * over]
    return {**made, "dimension": dimension}


def legs_of(path):
    """A velocity as an expression of t: the legs [(velocity, duration)] one after the other."""
    text, end = "0", sum(duration for _, duration in path)
    for velocity, duration in reversed(path):
        text = f"t < {end!r} ? {velocity!r} : ({text})"
        end -= duration
    return text


def drive(name, mesh, joint, conditions, end, step, **options):
    dimension, lower, upper = mesh
    deck = case.load()
    deck["joints"] = {"joint": joint}
    deck["conditions"] += conditions
    deck["time"] = {"end": end, "fixed_step": step}
    deck["output"]["every"] = end / 150
    name = name.replace(",", "").replace(" ", "_")
    run = case.run(name, recipe(dimension, lower, upper), deck, **options)
    if "not_matched" in name:
        case.same_bits(name, recipe(dimension, lower, upper), deck, run, ranks=2)
    return run


# --- the laws, written again ------------------------------------------------------------------------

TABLE = {"model": "table", "closures": [1e-4, 2e-4, 2.5e-4], "tractions": [1e6, 4e6, 9e6], "stiffness_cap": 1e12, "shear_stiffness": 5e9, "friction": 0.6}
JRC, JCS, STRENGTH, RESIDUAL, PEAK = 10.0, 100e6, 150e6, 30.0, 1e-3  # [-], [Pa], [Pa], [degrees], [m]
ROUGH = {"model": "barton_bandis", "roughness": JRC, "wall_strength": JCS, "rock_strength": STRENGTH, "residual_friction": math.tan(math.radians(RESIDUAL)),
         "peak_slip": PEAK, "stiffness_cap": 1e13, "shear_stiffness": 2e10}  # fmt: skip
# Bandis, Lumsden and Barton 1983, MPa and mm.
aperture = JRC / 5 * (0.2 * STRENGTH / JCS - 0.1)
STIFFNESS = 1e9 * (-7.15 + 1.75 * JRC + 0.02 * JCS / 1e6 / aperture)
LIMIT = 1e-3 * (-0.296 - 0.0056 * JRC + 2.241 * (JCS / 1e6 / aperture) ** -0.245)


def table(c):
    """Traction at first loading, slope there (the steeper one at a point), and the work of loading to c, per area."""
    at, traction = numpy.array([0, *TABLE["closures"]]), numpy.array([0, *TABLE["tractions"]])
    slopes = numpy.diff(traction) / numpy.diff(at)
    i = min(int(numpy.searchsorted(at, c, side="right")) - 1, len(slopes) - 1)
    sigma = traction[i] + slopes[i] * (c - at[i])
    whole = sum(0.5 * (traction[j] + traction[j + 1]) * (at[j + 1] - at[j]) for j in range(i))
    return sigma, slopes[i], whole + 0.5 * (traction[i] + sigma) * (c - at[i])


def hyperbola(c):
    x = c / LIMIT
    return STIFFNESS * c / (1 - x), STIFFNESS / (1 - x) ** 2, STIFFNESS * LIMIT**2 * (-x - math.log1p(-x))


def tractions(curve, closures):
    """Along a path: the curve while the closure grows beyond all before, else its tangent there."""
    most, found = 0.0, []
    for c in closures:
        most = max(most, c)
        sigma, slope, _ = curve(most)
        found.append(max(0.0, sigma - slope * (most - c)))
    return numpy.array(found)


def roughness_angle(sigma, slip):
    """Of the mobilised roughness [degrees]; Barton 1982 between 0.3 and 4 of the peak slip."""
    share = numpy.interp(slip / PEAK, [0.3, 0.6, 1, 2, 4], [0, 0.75, 1, 0.85, 0.7])
    return min(share * JRC * math.log10(JCS / sigma), 70 - RESIDUAL) if sigma < JCS else 0.0


def rough_strength(sigma, slip):
    if slip < 0.3 * PEAK:
        return sigma * math.tan(math.radians(RESIDUAL) * slip / (0.3 * PEAK))
    return sigma * math.tan(math.radians(RESIDUAL + roughness_angle(sigma, slip)))


def sheared(sigma, normal, to, count=40000):
    """Slip along one way under a compression that `normal(rise)` gives: displacements, shear and normal tractions, rises. The elastic part is tau / k_s, the
    joint slips as far as its strength asks, and rises by the tangent of half of the roughness angle; small steps, each solved by bisection.
    """
    found, slip, rise = [], 0.0, 0.0
    for d in numpy.linspace(0, to, count):
        low, high = slip, max(slip, d)

        def after(s, slip=slip, rise=rise):
            lifted = rise + math.tan(math.radians(roughness_angle(sigma, 0.5 * (s + slip)) / 2)) * (s - slip)
            return lifted, normal(lifted)

        for _ in range(40):
            middle = (low + high) / 2
            if ROUGH["shear_stiffness"] * (d - middle) > rough_strength(after(middle)[1], middle):
                low = middle
            else:
                high = middle
        slip, (rise, sigma) = high, after(high)
        found.append((d, ROUGH["shear_stiffness"] * (d - slip), sigma, rise))
    return numpy.array(found).T


def recorded(run):
    """Rows of the history at the times of the results file, and the force of the joint on the upper block against its way there [N]."""
    nodes = run.results.nodes_of("upper")
    force = numpy.array([run.results.nodal("contact_force", state)[nodes, 0].sum() for state in range(len(run.results.times))])
    return numpy.searchsorted(run.history["time"], run.results.times * (1 - 1e-12)), -force


def moved(vx, vy, end, step):
    """The conditions of an upper block that moves as given and does not turn; the end and the step."""
    return [{"type": "rigid_motion", "block": "upper", "velocity": [vx, vy, 0], "angular_velocity": [0, 0, 0]}], end, step


# --- closing: load, unload, reload beyond, unload, further, open ---------------------------------------------

SPEED = 0.05
for law, joint, curve, turns in (
    ("table", TABLE, table, [1.5e-4, 0.9e-4, 2.3e-4, 1.9e-4, 3e-4, 0]),
    ("barton_bandis", ROUGH, hyperbola, [part * LIMIT for part in (0.5, 0.3, 0.7, 0.6, 0.8, 0)]),
):
    for words, mesh in MESHES.items():
        path = [(-math.copysign(SPEED, b - a), abs(b - a) / SPEED) for a, b in zip([0, *turns], turns)]
        area, name = AREA[mesh[0]], f"{law}, {words}"
        run = drive(f"{law} closing {words}", mesh, joint, *moved(0, legs_of(path), sum(leg[1] for leg in path), 5e-6),
                    remainder=1e-4, load=curve(max(turns))[0] * area)  # fmt: skip
        h = run.history
        closure = -h["upper_displacement_y"]
        expected = tractions(curve, closure)
        case.check(f"{name}: traction along the path, error over the largest", numpy.max(numpy.abs(h["joint_normal_force"] / area - expected)) / numpy.max(expected), 0, 1e-9)
        most = numpy.max(closure)
        sigma, slope, work = curve(most)
        case.check(f"{name}: hysteresis, per area [J/m^2]", h["contact_hysteresis"][-1] / area, work - 0.5 * sigma**2 / slope, 1e-4, relative=True)
        case.check(f"{name}: stored at the end [J]", h["contact_stored"][-1], 0, 1e-9)

# --- table, dragged: sticks, slips, sticks back --------------------------------------------------------

PRESSED, DRAG = 1.5e-4, 8e-4
for words, mesh in MESHES.items():
    down, away = PRESSED / SPEED, DRAG / SPEED
    vx, vy = legs_of([(0.0, down), (SPEED, away), (-SPEED, away)]), legs_of([(-SPEED, down), (0.0, 2 * away)])
    area, name = AREA[mesh[0]], f"table, {words}"
    strength, stiffness = TABLE["friction"] * table(PRESSED)[0], TABLE["shear_stiffness"]
    run = drive(f"table drag {words}", mesh, TABLE, *moved(vx, vy, down + 2 * away, 1e-5), remainder=1e-4, load=2 * strength * area)
    h = run.history
    shear, force = 0.0, []
    for step in numpy.diff(h["upper_displacement_x"], prepend=0):
        shear = min(max(shear + stiffness * step, -strength), strength)
        force.append(shear)
    rows, found = recorded(run)
    pressed = h["time"][rows] > down
    case.check(f"{name}: shear traction against stick and slip, over the strength", numpy.max(numpy.abs(found / area - numpy.array(force)[rows])[pressed]) / strength, 0, 5e-3)
    slip = (DRAG - strength / stiffness) + (DRAG - 2 * strength / stiffness)
    case.check(f"{name}: friction work, per area [J/m^2]", h["contact_friction"][-1] / area, strength * slip, 2e-3, relative=True)

# --- rough joint, sheared: under constant load, and between blocks that cannot part ------------------------------

LOAD, TO = 2e6, 3e-3
constant = sheared(LOAD, lambda rise: LOAD, TO)
start = LOAD / (STIFFNESS + LOAD / LIMIT)  # closure under the load
confined = sheared(LOAD, lambda rise: hyperbola(start + rise)[0], 0.4 * TO)
for words, mesh in MESHES.items():
    area = AREA[mesh[0]]
    settle, speed = 0.02, 0.02
    name = f"barton_bandis, constant load, {words}"
    run = drive(f"barton_bandis constant {words}", mesh, ROUGH, [
        # Smoothly, as nothing damps what begins to sway; a joint that dilates does not either.
        {"type": "pressure", "side_set": "top", "value": f"{LOAD / 2}*(1 - cos({math.pi}*min(t/{settle / 2}, 1)))"},
        {"type": "rigid_motion", "block": "upper", "components": ["x", "z"], "velocity": [f"t < {settle} ? 0 : {speed}", 0, 0], "angular_velocity": [0, 0, 0]}],
        settle + TO / speed, 2e-5, remainder=1e-3, load=2 * LOAD * area)  # fmt: skip
    h, (rows, found) = run.history, recorded(run)
    late = h["time"][rows] > settle
    way, tau = h["upper_displacement_x"][rows][late], found[late] / area
    case.check(f"{name}: peak of the shear traction [Pa]", numpy.max(tau), rough_strength(LOAD, PEAK), 5e-3, relative=True)
    case.check(f"{name}: shear traction along the way, error over the peak", numpy.max(numpy.abs(tau - numpy.interp(way, *constant[:2]))) / numpy.max(constant[1]), 0, 0.02)
    case.check(f"{name}: rise [m]", h["upper_displacement_y"][-1] + start, constant[3][-1], 5e-3, relative=True)

    name = f"barton_bandis, confined, {words}"
    down, away = start / SPEED, 0.4 * TO / SPEED
    vx, vy = legs_of([(0.0, down), (SPEED, away)]), legs_of([(-SPEED, down), (0.0, away)])
    run = drive(f"barton_bandis confined {words}", mesh, ROUGH, *moved(vx, vy, down + away, 5e-6), remainder=1e-4, load=2 * numpy.max(confined[2]) * area)
    h, (rows, found) = run.history, recorded(run)
    late = h["time"][rows] > down
    way = h["upper_displacement_x"][rows][late]
    for what, force, row in (("compression", h["joint_normal_force"][rows][late], 2), ("shear traction", found[late], 1)):
        expected = numpy.interp(way, confined[0], confined[row])
        case.check(f"{name}: {what} along the way, error over the largest", numpy.max(numpy.abs(force / area - expected)) / numpy.max(expected), 0, 0.01)
case.finish()
