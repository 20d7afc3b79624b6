"""V19: Hertz' line contact of an elastic cylinder on a rigid flat."""

import math

import numpy
from coplanetest import Case

case = Case("V19", __file__)
run = case.run("pressed", case.load("mesh.yaml"), case.load(), energy=2e-3)
planes = run.planes()
touching = planes["area"] > 0
x, pressure, area = planes["Points"][touching, 0], planes["normal_traction"][touching], planes["area"][touching]
radius, modulus, cell = 0.05, 200e9 / (1 - 0.3**2), 67e-6

# What presses it is what the planes carry. A line load P flattens 2 b with b^2 = 4 P R / (pi E*).
load = float(numpy.sum(pressure * area))
half_width = math.sqrt(4 * load * radius / (math.pi * modulus))
peak = math.sqrt(load * modulus / (math.pi * radius))
case.check_within("line load [N/m]", load, 0.9e6, 1.1e6)
case.check("peak pressure over Hertz'", pressure.max() / peak, 1, 0.05)
case.check("half width less Hertz' [m]", 0.5 * (x.max() - x.min() + cell) - half_width, 0, cell)
inside = numpy.abs(x) < 0.8 * half_width
ellipse = peak * numpy.sqrt(1 - (x[inside] / half_width) ** 2)
case.check("pressure less the ellipse over the peak", numpy.max(numpy.abs(pressure[inside] - ellipse)) / peak, 0, 0.05)
case.check("left and right alike", abs(numpy.sum(pressure * area * x)) / (load * half_width), 0, 1e-3)
case.finish()
