"""The main job to its end, and what must be true of it (README.md beside this file)."""

import base64
import json
import os
import pathlib
import sys
from xml.etree import ElementTree

import numpy

from coplanetest.program import Run, make_mesh, run_program

inputs = pathlib.Path(os.environ["COPLANE_SOURCE"]) / "exodus_inputs/bar_wall_3d"
folder = pathlib.Path("run")
folder.mkdir(exist_ok=True)
make_mesh(str(inputs / "mesh.yaml"), str(folder / "bar_wall_3d.e"))
arguments = [str(inputs / "wall.yaml"), "--backend", "serial",
             "--set", f"mesh={(folder / 'bar_wall_3d.e').resolve()}",
             "--set", "output.results=run.e", "--set", "history.file=run.csv"]
code, output = run_program(arguments, str(folder), ranks=2, timeout=1150)
print("\n".join(output.splitlines()[-40:]))
run = Run(folder, code, output)
failures = 0


def deepest(folder, area):
    """Largest closure of all planes that cover at least this area, over all output steps [m]."""
    most = 0.0
    for name in sorted(folder.glob("run_planes_*.vtp")):
        root = ElementTree.parse(name).getroot()
        header = 8 if root.get("header_type") == "UInt64" else 4
        column = {
            array.get("Name"): numpy.frombuffer(base64.b64decode(array.text.strip())[header:], dtype="<f8")
            for array in root.iter("DataArray") if array.get("Name") in ("area", "closure")
        }
        large = column["area"] > area
        if large.any():
            most = max(most, column["closure"][large].max())
    return most


def check(quantity, value, low, high):
    global failures
    passed = bool(low <= value <= high)
    failures += not passed
    print(json.dumps({"case": "bar_wall", "quantity": quantity, "value": float(value), "accepted": [low, high], "passed": passed}))


check("exit code", code, 0, 0)
history = run.history
start = history["initial"][-1]
check("energy balance over initial energy", numpy.abs(history["error"]).max() / start, 0, 0.02)
check("contact remainder over initial energy", history["contact_remainder"].max() / start, 0, 0.05)
check("contact remainder is a loss", history["contact_remainder"].min() / start, -1e-3, 0.05)
mass_speed = 4019.2 * 70
error = max(numpy.abs(history[f"momentum_error_{axis}"]).max() for axis in "xyz")
check("momentum with impulses over initial momentum", error / mass_speed, 0, 1e-10)
check("deepest penetration on more than 1 % of a face [m]", deepest(folder, 0.01 * 0.16**2), 0, 0.3 * 0.16)
check("contacts missed", history["missed"][-1], 0, 0)
check("forward speed of the bar at the end", history["bar_velocity_z"][-1], 5, 60)

results = run.results
last = len(results.times) - 1
moved = results.nodal("displacement_z", last)
x, y, z = results.coordinates.T[:3]
bricks = (z >= -1e-9) & (z <= 0.64 + 1e-9)
middle = bricks & (numpy.abs(x) < 1) & (y > 2.2) & (y < 3.8)
corners = bricks & (numpy.abs(x) > 2.5) & (y < 1)
check("largest forward motion of bricks in the middle", moved[middle].max(), 0.2, 10)
check("motion of bricks at the lower corners", numpy.abs(moved[corners]).max(), 0, 0.2)
check("friction work over initial energy", history["contact_friction"][-1] / start, 0.05, 0.9)
sys.exit(1 if failures else 0)
