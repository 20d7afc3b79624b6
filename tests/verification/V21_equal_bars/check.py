"""V21: two equal bars meet (2D and 3D, all element types); V58: the same in other frames; V65: 2D equals a slice of 3D."""

import numpy
from coplanetest import Case, turned

case = Case("V21", __file__)
deck = case.load()
speed, modulus, density, length = 2.0, 200e9, 8000.0, 1.0
wave = (modulus / density) ** 0.5  # 5000 m/s, also in a bar with free sides: Poisson's ratio is 0
stress = density * wave * speed / 2  # each bar takes half the speed: 40 MPa


def plateau(run):
    """Mean of the contact stress between 50 and 350 microseconds [Pa], from what the right bar gained in
    that time. Samples of the force itself would catch its ringing now high, now low.
    """
    gained = numpy.interp([50e-6, 350e-6], run.history["time"], run.history["right_velocity_x"])
    return density * length * (gained[1] - gained[0]) / 300e-6


def touching_until(run):
    h = run.history
    return h["time"][numpy.flatnonzero(h["stick"] + h["slip"])[-1]]


runs = {}
# Split elements are stiffer: they take a shorter step.
for name, split, step in (
    ("2d", None, 1.25e-6),
    ("3d", None, 1.25e-6),
    ("2d_triangles", "triangles", 5e-7),
    ("3d_tetrahedra", "tetrahedra", 4e-7),
):
    recipe = case.load(f"mesh_{name[:2]}.yaml")
    if split:
        for part in recipe["parts"]:
            part["split"] = split
    run = case.run(name, recipe, {**deck, "time": {**deck["time"], "fixed_step": step}})
    runs[name] = run
    h = run.history
    case.check(f"{name}: stress while they touch [Pa]", plateau(run), stress, 0.02, relative=True)
    # The wave runs to the far end and back: 2 L / c. The contact's own compliance adds up to 2 %; it
    # is seen at the end of a step.
    case.check_within(
        f"{name}: end of contact [s]", touching_until(run), 2 * length / wave, 1.02 * 2 * length / wave + step
    )
    case.check(f"{name}: left bar's velocity [m/s]", h["left_velocity_x"][-1], 0, 0.01 * speed)
    case.check(f"{name}: right bar's velocity [m/s]", h["right_velocity_x"][-1], speed, 0.01 * speed)
    case.check(f"{name}: work of nodal forces over the initial energy", 
               numpy.max(numpy.abs(h["nodal_error"])) / h["kinetic"][0], 0, 1e-12)
    case.check(f"{name}: remainder of contact work over stored energy",
               numpy.max(numpy.abs(h["contact_remainder"])) / numpy.max(h["contact_stored"]), 0, 0.05, report=True)

# --- V58: other frames ------------------------------------------------------------------------------
case.name = "V58"
closure = stress / (2 * modulus / 0.02)  # of the penalty contact: 2 micrometres
for name, angles in (("2d", 30), ("3d", [30, 20, 50])):
    plain = runs[name].results
    time = plain.times[-1]
    for frame, change, tolerance in (
        ("turned", {"angles": angles}, 1e-8),
        # Positions are rounded to 1.1e-13 m at 1 km, which the closure feels; a few roundings add up.
        ("moved by 1 km", {"offset": (1000, -1000, 1000)}, 8 * numpy.spacing(1000.0) / closure),
        ("seen from 100 m/s", {"velocity": (100, -100, 100 if name == "3d" else 0)}, 1e-8),
    ):
        recipe, changed, matrix = turned(case.load(f"mesh_{name}.yaml"), deck, **change)
        results = case.run(f"{name}_{frame.split()[0]}", recipe, changed).results
        d = results.dimension
        drift = numpy.array(change.get("velocity", (0, 0, 0)))[:d]
        for field, shift in (("displacement", drift * results.times[-1]), ("velocity", drift)):
            # Back into the original frame: row vectors times the matrix are its transpose's work.
            back = (results.nodal(field) - shift) @ matrix[:d, :d]
            error = numpy.max(numpy.abs(back - plain.nodal(field))) / numpy.max(numpy.abs(plain.nodal(field)))
            case.check(f"{name} {frame}: {field}", error, 0, tolerance)

# --- V65: one layer of hexahedra between rollers is the plane problem -------------------------------
case.name = "V65"
rollers = [{"type": "symmetry", "node_set": side, "normal": [0, 0, 1]} for side in ("back", "front")]
# Hourglass stiffness depends on the thickness, and faces that do not match push their nodes unevenly by (closure / size)^2.
flat = {**deck, "blocks": {name: {**block, "hourglass": {"stiffness": 0}} for name, block in deck["blocks"].items()}}
plain = case.run("plane", case.load("mesh_2d.yaml"), flat).results
results = case.run("slice", case.load("mesh_slice.yaml"), {**flat, "conditions": rollers}).results
# Nodes of both bars stand at the joint: tell them apart by their block.
match = []
for block in plain.blocks:
    places = {tuple(numpy.round(plain.coordinates[n], 9)): n for n in plain.nodes_of(block)}
    match += [(n, places[tuple(numpy.round(results.coordinates[n, :2], 9))]) for n in results.nodes_of(block)]
in_slice, in_plane = numpy.array(match).T
for field in ("displacement", "velocity"):
    slice_field, plane_field = results.nodal(field)[in_slice], plain.nodal(field)[in_plane]
    error = numpy.max(numpy.abs(slice_field[:, :2] - plane_field)) / numpy.max(numpy.abs(plane_field))
    case.check(f"{field} of the slice", error, 0, 1e-10)
    case.check(f"{field} along z", numpy.max(numpy.abs(slice_field[:, 2])), 0, 0)
case.finish()
