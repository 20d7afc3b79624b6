"""V30: two turning blocks collide corner first and part; V58: the same in other frames."""

import math
import sys

import numpy
from coplanetest import Case, rotation, turned_deck

case = Case("V30", __file__)
full = "all" in sys.argv[1:]
centers = {"2d": [0.1, 0.12, 0], "3d": [0.12, 0.12, 0.05]}  # of the second block


def problem(dimension, center=None, friction=0.5):
    recipe, deck = case.load("mesh.yaml" if dimension == "2d" else "mesh_3d.yaml"), case.load()
    center = center or centers[dimension]
    recipe["parts"][1]["offset"] = center[: recipe["dimension"]]
    deck["initial"][1]["center"] = center
    deck["joints"]["rough"]["friction"] = friction
    if dimension == "3d":
        deck["initial"][0].update(center=[-0.2, 0, 0], angular_velocity=[2, -3, 5])
        deck["initial"][1].update(angular_velocity=[-4, 1, -8])
    return recipe, deck


def changed(dimension, matrix=None, offset=(0, 0, 0)):
    """In 3D quadrilaterals of the surface are not flat, by up to a tenth of their size; then the frame."""

    def change(coordinates):
        moved = coordinates
        if dimension == "3d":
            x, y, z = coordinates.T
            wave = 3e-3 * numpy.sin(60 * x + 1) * numpy.sin(70 * y + 2) * numpy.sin(80 * z + 3)
            moved = coordinates + numpy.stack([wave, -wave, 0.5 * wave], axis=1)
        d = moved.shape[1]
        if matrix is not None:
            moved = moved @ matrix[:d, :d].T
        return moved + numpy.array(offset[:d], float)

    return change


def kept(run):
    """What is left as motion, strain and friction heat over the energy at the start. The rest is the contact remainder: the error of
    the time step, since forces have a potential, and shear whose area changes.
    """
    h = run.history
    return (h["kinetic"] + h["internal"] + h["hourglass"] + h["contact_stored"] + h["contact_friction"]) / h["kinetic"][0]


runs = {}
for dimension in ("2d", "3d"):
    recipe, deck = problem(dimension)
    change = changed(dimension)
    run = runs[dimension] = case.run(dimension, recipe, deck, change_mesh=change)
    case.same_bits(dimension, recipe, deck, run, change_mesh=change)
    h = run.history
    case.check_within(f"{dimension}: friction work over the initial energy", h["contact_friction"][-1] / h["kinetic"][0], 1e-3, 1)
    case.check(f"{dimension}: planes in contact at the end", int(h["stick"][-1] + h["slip"][-1]), 0, 0)
    case.check_within(f"{dimension}: energy and friction work over the initial energy, at the end", kept(run)[-1], 1 - 1e-4, 1 + 1e-4)
    case.check_within(f"{dimension}: the same, largest", numpy.max(kept(run)), 1.0, 1.0 + 1e-3)
    case.check(f"{dimension}: work of nodal forces over the initial energy",
               numpy.max(numpy.abs(h["nodal_error"])) / h["kinetic"][0], 0, 1e-12)
    # Without the couple the two forces of a plane may be a lever apart: angular momentum is then lost, visibly.
    # This shows that the check of conservation can fail.
    deck["contact"] |= {"couple": False, "forces": "common_normal"}
    h = case.run(f"{dimension}_no_couple", recipe, deck, change_mesh=change, angular=1).history
    lost = math.sqrt(sum(h[f"angular_momentum_error_{axis}"][-1] ** 2 for axis in "xyz"))
    whole = math.sqrt(sum(h[f"angular_momentum_{axis}"][0] ** 2 for axis in "xyz"))
    case.check_within(f"{dimension}: angular momentum lost without the couple, over the initial", lost / whole, 1e-5, 1)

# How much the remainder takes depends on how squarely corners meet; for the record.
if full:
    for dimension, center, friction in (
        ("2d", [0.1, 0.03, 0], 0.5), ("2d", [0.1, 0.03, 0], 0), ("2d", [0.1, -0.05, 0], 0.5), ("2d", [0.1, 0.08, 0], 0.5),
        ("3d", [0.12, 0.03, 0.02], 0), ("3d", [0.12, 0.03, 0.02], 0.5), ("3d", [0.12, 0.12, 0.02], 0.5),
    ):
        recipe, deck = problem(dimension, center, friction)
        name = f"{dimension} at {center}, friction {friction}"
        run = case.run(name.replace(" ", "_").replace(",", ""), recipe, deck, change_mesh=changed(dimension))
        case.check(f"{name}: energy and friction work over the initial energy, at the end", kept(run)[-1], 1, 0.05, report=True)
        case.check_within(f"{name}: the same, not gained", kept(run)[-1], 0, 1.0 + 1e-3)

# --- V58: other frames ------------------------------------------------------------------------------
case.name = "V58"
for dimension in ("2d", "3d"):
    plain = runs[dimension].results
    for frame, angles, offset, drift, tolerance in (
        ("turned", 30 if dimension == "2d" else [30, 20, 50], (0, 0, 0), (0, 0, 0), 1e-8),
        ("moved by 1 km", 0, (1000, -1000, 1000), (0, 0, 0), 1e-8),
        ("seen from 100 m/s", 0, (0, 0, 0), (100, -100, 100 if dimension == "3d" else 0), 1e-8),
    ):
        if dimension == "3d" and frame != "turned" and not full:
            continue
        recipe, deck = problem(dimension)
        matrix = rotation(angles)
        if dimension == "2d":
            offset = (*offset[:2], 0)
        deck = turned_deck(deck, matrix, offset, drift)
        run = case.run(f"{dimension}_{frame.split()[0]}", recipe, deck, change_mesh=changed(dimension, matrix, offset))
        results, d = run.results, plain.dimension
        for field, shift in (("displacement", numpy.array(drift[:d]) * results.times[-1]), ("velocity", numpy.array(drift[:d]))):
            back = (results.nodal(field) - shift) @ matrix[:d, :d]
            error = numpy.max(numpy.abs(back - plain.nodal(field))) / numpy.max(numpy.abs(plain.nodal(field)))
            case.check(f"{dimension} {frame}: {field}", error, 0, tolerance)
case.finish()
