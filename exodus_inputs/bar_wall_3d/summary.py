"""Several variants together: `full` has full integration in the bricks, and the bar keeps its speed within 2 % of that."""

import json
import pathlib
import sys

from coplanetools import Example

runs = {json.loads((pathlib.Path(folder) / "example.json").read_text())["variant"]: folder for folder in sys.argv[1:]}
if {"", "full"} <= set(runs):
    usual, full = (Example(runs[variant]) for variant in ("", "full"))
    usual.check("speed of the bar at the end, beside full integration [m/s]", usual.history["bar_velocity_z"][-1], full.history["bar_velocity_z"][-1], 0.02, relative=True)
    usual.finish()
