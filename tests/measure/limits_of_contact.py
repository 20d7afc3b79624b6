#!/usr/bin/env python3
"""What contact does not do right yet, measured: joints that are crushed in an impact.

    python3 tests/measure/limits_of_contact.py BUILD/bin

Prints the table behind a limit in docs/user/contact.md; takes a minute. When it is mended, its problem becomes a check.
"""

import os
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from coplanetest import Case

# A brick falls on mortar, which it crushes beyond its peak.
GAP = 1e-4
BRICK = {"dimension": 2, "node_sets": {"ground": {"block": "base", "where": {"y": -0.1}}}, "parts": [
    {"shape": "box", "block": "base", "min": [-0.2, -0.1], "size": [0.4, 0.1], "divisions": [8, 2]},
    {"shape": "box", "block": "brick", "min": [-0.1, GAP], "size": [0.2, 0.1], "divisions": [4, 2]}]}  # fmt: skip
MORTAR = {"model": "mortar", "normal_stiffness": 5e10, "tensile_strength": 0.3e6, "tension_energy": 20, "cohesion": 0.4e6, "shear_energy": 130, "friction": 0.7,
          "compressive_strength": 11e6, "compression_energy": 5e3, "peak_crushing": 9e-5}  # fmt: skip


def falling_brick(speed, weight_of_shear, loss, step_factor):
    return {
        "materials": {"clay": {"model": "linear_elastic", "density": 2000, "youngs_modulus": 1e10, "poisson_ratio": 0.2}},
        "blocks": {name: {"material": "clay"} for name in ("base", "brick")},
        "initial": [{"block": "brick", "velocity": [0, -speed, 0]}],
        "conditions": [{"type": "fixed", "node_set": "ground"}],
        "joints": {"bed": {**MORTAR, "shear_in_crushing": weight_of_shear, "stiffness_loss": loss}},
        "contact": {"default_joint": "bed"},
        "time": {"end": 1.5e-3, "step_factor": step_factor},
        "history": {"probes": [{"name": "brick", "block": "brick"}]},
    }


def main():
    os.environ["COPLANE_BIN"] = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        case = Case("limits of contact", __file__)
        print("| brick falls on mortar [m/s] | `shear_in_crushing` | `stiffness_loss` | `step_factor` | largest closure [mm] | contact remainder over the first energy |\n|---|---|---|---|---|---|")
        for speed, weight_of_shear, loss in ((4, 0, 0), (10, 0, 0), (10, 9, 0), (10, 0, 0.5), (10, 9, 0.5)):
            for step_factor in (0.8, 0.2, 0.05):
                h = case.attempt(f"brick_{speed}_{weight_of_shear}_{loss}_{step_factor}", BRICK, falling_brick(speed, weight_of_shear, loss, step_factor)).history
                closure = -1e3 * (h["brick_displacement_y"].min() + GAP)
                print(f"| {speed} | {weight_of_shear} | {loss} | {step_factor} | {closure:.3f} | {h['contact_remainder'][-1] / h['kinetic'][0]:.4f} |")


main()
