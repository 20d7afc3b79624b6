"""A column of drums on ground that moves: it falls, or rocks and stays."""

import numpy

from coplanetools import Example

example = Example()
h = example.history
# Rigid drums: no element is computed, so there is no hourglass energy; planes hold what is stored.
# Beyond the coarse size the column falls on the ground with its drums: contact gains 0.14 % of the energy there. How that goes with the step is not known.
example.balances(hourglass=0, remainder=(-1e-3, 1e-3))
ground = 9 / (2 * numpy.pi) if not example.variant else 2 / (2 * numpy.pi)
if example.size == "coarse":
    example.check_within("drop of the capital [m]", -float(h["capital_displacement_z"].min()), -0.1, 0.1)
    example.check_within("capital behind the ground [m]", float((h["plate_displacement_x"] - h["capital_displacement_x"]).max()), 0.3, 1.5)
else:
    example.check("way of the ground [m]", float(h["plate_displacement_x"][-1]), ground, 1e-3, relative=True)
    if example.variant:
        # It rocks on one edge, then on the other, and each swing is smaller than the one before: a lean of its width would topple it.
        example.check_within("largest drop of the capital [m]", -float(h["capital_displacement_z"].min()), -0.001, 0.01)
        lean = numpy.abs(h["capital_displacement_x"] - h["plate_displacement_x"])
        example.check_within("largest lean [m]", float(lean.max()), 0.1, 0.6)
        example.check_within("largest lean in the second half of the time over the largest", float(lean[len(lean) // 2:].max() / lean.max()), 0.1, 0.98)
    else:
        example.check_within("drop of the capital at the end [m]", -float(h["capital_displacement_z"][-1]), 2.5, numpy.inf)
example.finish()
