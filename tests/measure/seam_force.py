#!/usr/bin/env python3
"""The force on a block that is led over the flush seam of two slabs, as a table.

    python3 tests/measure/seam_force.py BUILD/bin > docs/theory/pictures/seam-force.csv

All bodies are rigid, in the plane. The block, 0.2 m long, sinks in by a millimetre and is then led along at 1 m/s; the slabs are so heavy that they stay, and
what they gain of momentum is the force. Columns: how far the front of the block is past the seam [m]; forces on the block along its way and upwards, over the
load that its bottom bears on one slab (stiffness times closure times length) [-]. docs/theory/pictures/draw-potential.py draws it. Takes some seconds. The
deck has only keys that the first release knows, too.
"""

import os
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import numpy
from coplanetest import Case

LENGTH, CLOSURE, STIFFNESS, BEFORE_SEAM = 0.2, 1e-3, 1e8, 0.03
SINKING, SPEED, EVERY = 5e-3, 1.0, 1e-4
SLAB_DENSITY = 1e12


def box(block, low, size, divisions):
    return {"shape": "box", "block": block, "min": low, "size": size, "divisions": divisions}


RECIPE = {
    "dimension": 2,
    "parts": [box("left", [-0.4, -0.1], [0.4, 0.1], [8, 2]), box("right", [0.0, -0.1], [0.4, 0.1], [8, 2]),
              box("rider", [-BEFORE_SEAM - LENGTH, 0.0], [LENGTH, 0.1], [4, 2])],
}  # fmt: skip


def deck(way):
    stone = {"model": "linear_elastic", "density": 2000.0, "youngs_modulus": 1e10, "poisson_ratio": 0.2}
    return {
        "materials": {"stone": stone, "heavy": {**stone, "density": SLAB_DENSITY}},
        "blocks": {"left": {"material": "heavy", "rigid": True}, "right": {"material": "heavy", "rigid": True}, "rider": {"material": "stone", "rigid": True}},
        "joints": {"law": {"model": "linear", "normal_stiffness": STIFFNESS}},
        "contact": {"default_joint": "law"},
        "time": {"end": SINKING + way / SPEED, "maximum_step": 2e-5, "energy_tolerance": 1e9},
        "conditions": [{"type": "rigid_motion", "block": "rider", "angular_velocity": [0, 0, 0],
                        "velocity": [f"t < {SINKING} ? 0 : {SPEED}", f"t < {SINKING} ? {-CLOSURE / SINKING} : 0", 0]}],
        "output": {"planes": False},
        "history": {"every": EVERY, "probes": [{"name": name, "block": name} for name in ("left", "right", "rider")]},
    }  # fmt: skip


def forces(case, places):
    """Forces along and upwards over the load, each the mean from half way to the place before to half way to the next."""
    run = case.attempt("led", RECIPE, deck(BEFORE_SEAM + float(places[-1]) + 0.01))
    if run.code not in (0, 6):
        sys.exit(run.output[-2000:])
    h = run.history
    front, load = h["rider_displacement_x"] - BEFORE_SEAM, STIFFNESS * CLOSURE * LENGTH
    later = h["time"] > SINKING + 2 * EVERY
    ends = numpy.concatenate([[1.5 * places[0] - 0.5 * places[1]], 0.5 * (places[1:] + places[:-1]), [1.5 * places[-1] - 0.5 * places[-2]]])
    times = numpy.interp(ends, front[later], h["time"][later])
    for axis in "xy":
        momentum = SLAB_DENSITY * 0.4 * 0.1 * (h[f"left_velocity_{axis}"] + h[f"right_velocity_{axis}"])
        yield -numpy.diff(numpy.interp(times, h["time"], momentum)) / numpy.diff(times) / load


def main():
    places = numpy.unique(numpy.concatenate([numpy.arange(-0.02, 0.2601, 5e-3), numpy.arange(-4e-3, 12.1e-3, 4e-4), numpy.arange(0.196, 0.2121, 4e-4)]).round(7))
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        along, up = forces(Case("seam force", __file__), places)
    print("front_past_seam,along,up")
    for row in zip(places, along, up):
        print(",".join(f"{value + 0.0:.4f}" for value in row))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    os.environ["COPLANE_BIN"] = os.path.abspath(sys.argv[1])
    main()
