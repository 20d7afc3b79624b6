#!/usr/bin/env python3
"""What a conforming joint asks of hourglass control: both ways of computing forces, all forms of hexahedra.

    python3 tests/measure/joint_hourglass.py BUILD/bin

A cube on a cube of 0.2 m, 4 x 4 x 4 elements each, whose faces match across a joint; nearly without viscosity. *Twisted*: pressed with 1 MPa, and turned
about the normal of the joint by a velocity. *Rim*: pressed, at rest, from an initial stress, with free sides. *Rocked*: the upper one turns about an edge.
"""

import argparse
import os
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import numpy
from coplanetest import Case

PRESSURE = 1e6
ROCK = {"model": "linear_elastic", "density": 2500, "youngs_modulus": 2e10, "poisson_ratio": 0.2}


def scene(name, forces, element):
    size, count = [0.2] * 3, [4] * 3
    recipe = {
        "dimension": 3,
        "parts": [{"shape": "box", "block": block, "min": [0, 0, z], "size": size, "divisions": count} for block, z in (("lower", 0), ("upper", 0.2))],
        "node_sets": {"base": {"block": "lower", "where": {"z": 0}}},
        "side_sets": {"top": {"block": "upper", "where": {"z": 0.4}}},
    }
    deck = {
        "materials": {"rock": ROCK}, "blocks": {b: {"material": "rock", "element": element} for b in ("lower", "upper")},
        "joints": {"tight": {"model": "linear", "normal_stiffness": 4e11, "shear_stiffness": 2e11, "friction": 0.6}},
        "contact": {"forces": forces, "pairs": [{"blocks": ["lower", "upper"], "joint": "tight", "declared": True}]},
        "conditions": [{"type": "fixed", "node_set": "base"}, {"type": "pressure", "side_set": "top", "value": PRESSURE}],
        "initial": [{"block": b, "stress": [0, 0, -PRESSURE, 0, 0, 0]} for b in ("lower", "upper")],
        "viscosity": {"linear": 0, "quadratic": 0}, "time": {"end": 5e-3}, "output": {"planes": False}, "history": {"every": 2e-5},
    }  # fmt: skip
    if name == "twisted":
        deck["initial"][1] |= {"velocity": [0, 0, 0], "angular_velocity": [0, 0, 1.0], "center": [0.1, 0.1, 0.2]}
    if name == "rocked":
        deck["initial"][1] |= {"velocity": [0, 0, 0], "angular_velocity": [0, 0.5, 0], "center": [0.2, 0.1, 0.2]}
    return recipe, deck


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("program")
    os.environ["COPLANE_BIN"] = str(pathlib.Path(arguments.parse_args().program).resolve())
    print("| scene | element | forces | largest velocity over that of a wave of 1 MPa | hourglass over energy in play | remainder over energy in play |\n|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        case = Case("joint and hourglass", __file__)
        for name in ("twisted", "rim", "rocked"):
            for element in ("one_point", "assumed_strain", "full_integration"):
                for forces in ("common_normal", "potential"):
                    run = case.attempt(f"{name}_{element}_{forces}", *scene(name, forces, element))
                    if run.code != 0:
                        sys.exit(run.output)
                    h = run.history
                    kinetic, mass = numpy.max(h["kinetic"]), 2 * ROCK["density"] * 0.2**3
                    speed = numpy.sqrt(2 * kinetic / mass) / (PRESSURE / numpy.sqrt(ROCK["density"] * ROCK["youngs_modulus"]))
                    energy = max(kinetic, numpy.max(numpy.abs(h["external_work"])))
                    lost = h["contact_remainder"][numpy.argmax(numpy.abs(h["contact_remainder"]))] / energy
                    hourglass = numpy.max(numpy.abs(h["hourglass"])) / energy
                    rests = speed < 1e-9
                    print(f"| {name} | {element} | {forces} | {speed:.1e} | {'–' if rests else f'{hourglass:.1e}'} | {'–' if rests else f'{lost:.1e}'} |", flush=True)


main()
