"""The wedge holds, or slides, as its factor of safety says; plane and crack bear what equilibrium wants."""

import importlib.util
import math
import pathlib

import numpy

from coplanetools import Example

spec = importlib.util.spec_from_file_location("safety", pathlib.Path(__file__).with_name("safety.py"))
safety = importlib.util.module_from_spec(spec)
spec.loader.exec_module(safety)

example = Example()
h = example.history
share = {"": 0.5, "dry": 0.0, "full": 1.0}[example.variant or ""]
factor = safety.limit_equilibrium(share, safety.FRICTION, safety.COHESION)
print(f"factor of safety by limit equilibrium: {factor:.3f}")
example.balances(hourglass=0.2 if factor < 1 else 0.05)  # a wedge that slides has little else
late = h["time"] >= 1.0
moved = numpy.hypot(*(h[f"brow_displacement_{axis}"][late] - h[f"brow_displacement_{axis}"][late][0] for axis in "xy")).max()
if factor > 1:
    example.check("moves after 1 s [m]", float(moved), 0, 1e-4)
    # The rock behind presses on the crack as well, by the weight that widens it.
    normal = safety.forces_on_plane(share)[0] - h["crack_normal_force"][-1] * math.sin(safety.DIP)
    example.check("normal force on the plane at the end, by equilibrium of the wedge [N]", float(h["plane_normal_force"][-1]), normal, 1e-3, relative=True)
else:
    # Water in the crack also tips it: the plane opens from behind and loses its cohesion there.
    free = 0.5 * safety.acceleration(share, safety.FRICTION) * 0.6**2
    example.check_within("way in the last 0.6 s over that of a rigid wedge without cohesion", float(moved) / free, 0.2, 1)
example.finish()
