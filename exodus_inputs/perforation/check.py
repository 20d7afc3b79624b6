"""What must be true of a projectile and a slab, whatever the speed, the law and the size; docs/examples/perforation.md has the numbers."""

import re

import numpy

from coplanetools import Example
from slab import MEASURED, forrestal, numbers

example = Example()
h = example.history
speed = -h["projectile_velocity_y"]
of = numbers(example.run, example.folder)
impact, law = of["impact"], of["law"]

example.balances()
# A plane that unloads does work in the half step in which its element dies: a little less than nothing may be lost.
example.check_within("energy of planes of dead elements over the energy at the start", float(h["contact_eroded"][-1] / h["kinetic"][0]), -1e-6, 0.02)

# What the projectile loses the slab gets, with the nodes of its dead elements, and a rim that is held. Speeds are those half a step later.
masses = {name: float(value) for name, value in re.findall(r"block '(\w+)' .*mass (\S+) kg", example.run.output)}
example.check("mass of the projectile [kg]", of["of"] * masses["projectile"], 0.5, 0.01, relative=True)
lost, gained = masses["projectile"] * (impact - speed[-1]), h["impulse_y"][-1] - masses["slab"] * h["slab_velocity_y"][-1]
example.check("momentum that the projectile lost, found in the slab [N s]", float(gained), float(lost), 1e-3, relative=True)
example.check_within("largest gain of speed over the impact speed", float(numpy.maximum(0, numpy.diff(speed)).max()) / impact, 0, 0.01)
example.check_within("mass of dead elements over that of the slab", float(h["eroded_mass"][-1] / masses["slab"]), 0, 0.02)
if not of["slab"]:
    expected = forrestal(impact)
    print(f"{law}, {impact} m/s: depth {1e3 * of['depth']:.0f} mm, Forrestal {1e3 * expected:.0f} mm")
    example.check_within("speed at the end over the impact speed", float(speed[-1]) / impact, -0.05, 0.05)
    example.check_within("depth over Forrestal's", of["depth"] / expected, 0.5, 2)
elif of["of"] == 4 and example.size == "coarse":
    # Ends while the nose is in the slab.
    example.check_within("speed at the end over the impact speed", float(speed[-1]) / impact, 0.8, 0.98)
elif impact in MEASURED:
    late = speed[h["time"] > 0.95 * h["time"][-1]]
    example.check_within("change of speed in the last 5 % of the time [m/s]", float(late.max() - late.min()), 0, 3)
    print(f"{law}, {impact} m/s: residual speed {of['residual']:.0f} m/s, measured {MEASURED[impact]:.0f} m/s")
    # The page has what is reached; beyond these limits something has changed.
    low, high = (-60, 70) if law == "pseudo_cap" and not of["slow"] and not of["held"] and of["of"] == 1 else (-80, 160)
    example.check_within("residual speed less the measured one [m/s]", of["residual"] - MEASURED[impact], low, high)
example.finish()
