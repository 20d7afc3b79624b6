"""Depth of penetration into concrete of 40 MPa against the formula of Forrestal et al. 1994."""

import copy
import os
import pathlib
import sys

import numpy
from coplanetest import ValidationCase

sys.path.append(str(pathlib.Path(os.environ["COPLANE_SOURCE"], "exodus_inputs/perforation")))
from slab import forrestal  # noqa: E402


class Shots(ValidationCase):
    def conservation(self, name, run, deck, energy=1e-3, **_):
        h = run.history
        self.check(f"{name}: energy balance", numpy.max(numpy.abs(h["error"])) / h["kinetic"][0], 0, energy, kept="energy balance")


case = Shots(__file__)
recipe, deck = (case.load(f"exodus_inputs/perforation/{part}.yaml") for part in ("mesh", "deck"))

def shoot(name, speed, end, size=6e-3):
    mesh, changed = copy.deepcopy(recipe), copy.deepcopy(deck)
    mesh["parts"][0]["lines"]["y"] = {"ends": [-0.7, 0], "divisions": [round(0.7 / size)]}
    mesh["parts"][0]["lines"]["x"]["divisions"] = [round(0.048 / size), round(15 * 6e-3 / size)]
    if size < 6e-3:
        mesh["parts"][1]["across"] = 8
    changed["materials"]["pseudo_cap"] = {"set": "concrete_c40"}
    changed["initial"][0]["velocity"] = [0, -speed, 0]
    changed["time"]["end"] = end
    changed["output"]["every"] = end / 4
    run, spent = case.timed(name, mesh, changed)
    return -run.history["tip_displacement_y"].min() - 2e-4, run, spent


for speed, end in ((450, 1.8e-3),) if not case.full else ((300, 1.4e-3), (450, 1.8e-3), (600, 2.2e-3)):
    depth, run, spent = shoot(f"v{speed}", speed, end)
    case.check(f"{speed} m/s: depth [m]", depth, forrestal(speed), 0.12, relative=True)
    if speed == 450:
        case.picture(run, "--color", "damage", "--shares", "0", "0.25", "1", "--strip", "3", "--planes", "none", "--mirror", "--window", "-0.2", "0.2", "-0.4", "0.16", "--size", "360", "500")
if case.full:
    for size in (8e-3, 6e-3, 4e-3):
        depth, _, spent = shoot(f"v300_{1e3 * size:.0f}mm", 300, 1.4e-3, size)
        case.study("300 m/s: depth [m]", f"{1e3 * size:.0f} mm", depth, forrestal(300), spent)
case.finish()
