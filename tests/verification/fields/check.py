"""Tractions, pressures and velocities given by expressions of place and time, in a whole run."""

import numpy
from coplanetest import Case

case = Case("fields", __file__)
recipe, deck = case.load("mesh.yaml"), case.load()
# momentum: 1000 cycles in which supports and loads take up all forces of each other
run = case.run("fields", recipe, deck, energy=2e-3, momentum=1e-10)
results = run.results

# Poisson's ratio 0: every column carries the load of the middle of its own face, x = 0.25, 1.25, 2.25 and 3.25, 4.25 m.
for block, load in (("column", lambda x: 1e4 * (1 + x)), ("pushed", lambda x: -1e4 * (x - 2) * 2)):
    middle = numpy.floor(results.centres(block)[:, 0]) + 0.25
    error = results.element(block, "stress_yy") / load(middle) - 1
    case.check(f"{block}: largest error of the axial stress", numpy.max(numpy.abs(error)), 0, 1e-4)
    case.check_equal(f"{block}: columns with loads of their own", len(numpy.unique(middle)), 3 if block == "column" else 2)

# The boundary of the plate moves as u = (2e-3 (x - 10) + 1e-3 y, -1e-3 y) times 0.05 s: uniform strain inside.
h = 0.05
exx, eyy, exy = 2e-3 * h, -1e-3 * h, 0.5e-3 * h
young, poisson = 2e9, 0.25
shear = young / (2 * (1 + poisson))
lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
exact = {"xx": lame * (exx + eyy) + 2 * shear * exx, "yy": lame * (exx + eyy) + 2 * shear * eyy, "xy": 2 * shear * exy}
for component, value in exact.items():
    error = numpy.max(numpy.abs(results.element("plate", f"stress_{component}") - value)) / exact["xx"]
    # rotation and strain of 1e-4; the last step before t = 0.05 s ends up to a step later
    case.check(f"plate: largest error of stress {component} over stress xx", error, 0, 5e-3)
case.same_bits("fields", recipe, deck, run)
case.finish()
