"""V76: a free block that spins keeps its energy, and its vibrations do not grow.

Usage: check.py [all]
"""

import sys

import numpy
from coplanetest import Case

case = Case("V76", __file__)
FORMS = {
    "one point": {},
    "one point, stiff": {"hourglass": {"stiffness": 0.2}},
    "assumed strain": {"element": "assumed_strain"},
    "full integration": {"element": "full_integration"},
}
# Centre, spin [rad/s], and the small vibration: a part of the block has 0.5 m/s more.
MOTIONS = {
    "2d": ([1.1, 2.1, 0], [0, 0, 150], "0.5*(x>1.15)"),
    "3d": ([0.1, 0.1, 0.1], [60, -80, 100], "0.5*(x>0.15)*(z>0.1)"),
}

for dimension, (center, spin, kick) in MOTIONS.items():
    for form, options in FORMS.items():
        if form == "full integration" and "all" not in sys.argv[1:]:
            continue
        deck = case.load()
        deck["blocks"]["block"].update(options)
        deck["initial"] = [{"block": "block", "angular_velocity": spin, "center": center, "velocity_field": [kick, 0, 0]}]
        if dimension == "3d":
            deck["time"]["end"] = 0.1
        name = f"{dimension}, {form}"
        recipe = case.load(f"mesh_{dimension}.yaml")
        run = case.run(name.replace(", ", "_").replace(" ", "_"), recipe, deck)
        h = run.history
        energy = h["kinetic"][0]
        case.check_within(f"{name}: least hourglass energy over the whole", numpy.min(h["hourglass"]) / energy, -1e-6, 0)
        case.check_within(f"{name}: largest hourglass energy over the whole", numpy.max(h["hourglass"]) / energy, 0, 1e-4)
        whole = h["kinetic"] + h["internal"] + h["hourglass"]
        gained = numpy.max(whole - numpy.minimum.accumulate(whole)) / energy
        case.check(f"{name}: energy gained from any time to a later one, over the whole", gained, 0, 1e-6)
        case.check(f"{name}: energy lost, over the whole: that of the vibration", 1 - whole[-1] / energy, 0, 5e-4)
case.finish()
