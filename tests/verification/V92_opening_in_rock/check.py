"""V92: a circular opening in rock under initial stress: Kirsch's solution in elastic rock, the plastic ring in Mohr and Coulomb's, dug in steps."""

import math

import numpy
from coplanetest import Case, conforming

case = Case("V92", __file__)
a, far = 1.0, 20.0  # radius of the opening, half width of the model [m]
around = 16  # elements on the quarter of a circle


def mesh(name, rings, cores):
    """A quarter, x and y >= 0. A square in the middle, then rings of elements out to the circle of radius `a`, and on to that of radius `far`.
    cores: radii [m] at which the core ends, by name of its block; the square belongs to the first."""
    half = around // 2
    points, number = [], {}

    def add(key, x, y):
        if key not in number:
            number[key] = len(points)
            points.append((x, y))
        return number[key]

    side = 0.5 * min(cores.values()) if cores else 0.5
    step = side / half
    quads = {block: [] for block in (*cores, "rock")}
    first = next(iter(quads))
    for i in range(half):
        for j in range(half):
            quads[first].append([add(("s", p, q), p * step, q * step) for p, q in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))])

    def on_ring(k, radius, n):
        """Node k of the ring: on the square for radius None."""
        if radius is None:
            p, q = (half, k) if k <= half else (around - k, half)
            return add(("s", p, q), p * step, q * step)
        angle = 0.5 * math.pi * k / around
        x, y = radius * math.cos(angle), radius * math.sin(angle)
        return add(("r", n, k), 0.0 if k == around else x, 0.0 if k == 0 else y)

    radii = [None, *rings]
    for n in range(len(rings)):
        block = next((name for name, end in cores.items() if radii[n + 1] <= end * (1 + 1e-9)), "rock")
        for k in range(around):
            inner, outer = radii[n], radii[n + 1]
            quads[block].append([on_ring(k, inner, n), on_ring(k, outer, n + 1), on_ring(k + 1, outer, n + 1), on_ring(k + 1, inner, n)])
    place = numpy.array(points)
    edges = {"bottom": [], "left": [], "far": [], "wall": []}
    for quad in (q for block in quads.values() for q in block):
        for p, q in zip(quad, quad[1:] + quad[:1]):
            if place[p][1] == place[q][1] == 0:
                edges["bottom"].append((p, q))
            elif place[p][0] == place[q][0] == 0:
                edges["left"].append((p, q))
            elif min(numpy.hypot(*place[p]), numpy.hypot(*place[q])) > 0.999 * far:
                edges["far"].append((p, q))
            elif all(abs(numpy.hypot(*place[n]) - a) < 1e-9 for n in (p, q)) and (q, p) not in edges["wall"]:
                edges["wall"].append((p, q))
    conforming.write(name, points, quads, edges)


def geometric(start, end, count, first):
    """Radii beyond `start` up to `end` in geometric progression, the first of them `first` away."""
    low, high = 1.0, 3.0
    for _ in range(200):
        ratio = 0.5 * (low + high)
        low, high = (ratio, high) if first * sum(ratio**k for k in range(count)) < end - start else (low, ratio)
    radii = start + first * numpy.cumsum(ratio ** numpy.arange(count))
    return [*radii[:-1], end]


outside = geometric(a, far, 24, 0.06)


def deck(name, material, stress, cores, stages, end):
    return {
        "mesh": f"../{name}.e",
        "materials": {"rock": material},
        "blocks": {block: {"material": "rock", "element": "assumed_strain"} for block in (*cores, "rock")},
        "contact": {"enabled": False},
        "initial": [{"block": block, "stress": [*stress, 0, 0, 0]} for block in (*cores, "rock")],
        "conditions": [
            {"type": "symmetry", "node_set": "bottom", "normal": [0, 1, 0]},
            {"type": "symmetry", "node_set": "left", "normal": [1, 0, 0]},
            {"type": "traction", "side_set": "far", "value": [f"{stress[0]}*x/sqrt(x^2 + y^2)", f"{stress[1]}*y/sqrt(x^2 + y^2)", 0]},
        ],
        "damping": {"kinetic": True, "until_force_ratio": 1e-7},
        "time": {"end": end},
        "stages": stages,
        "output": {"planes": False},
        "history": {"every": 1e-3},
    }


def at_rest(name, run, stages):
    for stage in stages:
        told = [line for line in run.output.split("\n") if f"stage '{stage}' ends" in line]
        case.check_equal(f"{name}: stage '{stage}' ends at rest", len(told) == 1 and ", at rest:" in told[0], True)


def polar(run, block):
    """Radius and angle of the middles of a block's elements, and their stresses rr, tt, rt."""
    centres = run.results.centres(block)
    r, theta = numpy.hypot(*centres.T[:2]), numpy.arctan2(centres.T[1], centres.T[0])
    xx, yy, xy = (run.results.element(block, f"stress_{name}") for name in ("xx", "yy", "xy"))
    c, s = numpy.cos(theta), numpy.sin(theta)
    return r, theta, xx * c**2 + yy * s**2 + 2 * xy * c * s, xx * s**2 + yy * c**2 - 2 * xy * c * s, (yy - xx) * c * s + xy * (c**2 - s**2)


# --- elastic rock, one step: Kirsch ------------------------------------------------------------------------------------------

young, poisson = 10e9, 0.25
elastic = {"model": "linear_elastic", "density": 2600, "youngs_modulus": young, "poisson_ratio": poisson}
horizontal, vertical = -5e6, -10e6
stress = [horizontal, vertical, poisson * (horizontal + vertical)]
mesh("kirsch.e", [0.75, a, *outside], {"core": a})
stages = [{"name": "rock", "until": 1e-4}, {"name": "dug", "at_rest": True, "remove": ["core"]}]
problem = deck("kirsch", elastic, stress, ["core"], stages, 1)
run = case.run("kirsch", None, problem, energy=1e-5, load=-(horizontal + vertical) * far)
at_rest("kirsch", run, ["dug"])
mean, half = 0.5 * (horizontal + vertical), 0.5 * (horizontal - vertical)
r, theta, rr, tt, rt = polar(run, "rock")
q, two = a / r, 2 * theta
exact = {
    "rr": mean * (1 - q**2) + half * (1 - 4 * q**2 + 3 * q**4) * numpy.cos(two),
    "tt": mean * (1 + q**2) - half * (1 + 3 * q**4) * numpy.cos(two),
    "rt": -half * (1 + 2 * q**2 - 3 * q**4) * numpy.sin(two),
}
near = r < 4 * a
for name, found in (("rr", rr), ("tt", tt), ("rt", rt)):
    case.check(f"kirsch: stress {name} within 4 a, farthest from Kirsch over the vertical one [-]",
               numpy.max(numpy.abs(found - exact[name])[near]) / abs(vertical), 0, 0.01)  # fmt: skip
# Displacements by the opening, at its wall in plane strain.
results = run.results
place, moved = results.coordinates, results.nodal("displacement")
compliance = a * (1 + poisson) / young
exact = {"side": compliance * (mean + half * (3 - 4 * poisson)), "roof": compliance * (mean - half * (3 - 4 * poisson))}
for axis, name in enumerate(exact):
    node = numpy.argmin(numpy.hypot(place[:, axis] - a, place[:, 1 - axis]))
    case.check(f"kirsch: displacement of the {name} [m]", moved[node, axis], exact[name], 0.01 * abs(exact["roof"]))
case.check("kirsch: mass that has left over that of a quarter circle [-]", run.history["eroded_mass"][-1] / (2600 * math.pi / 4 * a**2), 1, 2e-3)
case.same_bits("kirsch", None, problem, run, ranks=3)
case.restarts("kirsch", None, problem, run, 0.7 * run.history["time"][-1])  # on the way to rest without the core

# --- Mohr and Coulomb's rock under equal stresses: the support falls to nothing in steps ------------------------------------------

pressure, cohesion, slope = 10e6, 1.5e6, math.tan(math.radians(30))
factor = (1 + math.sin(math.radians(30))) / (1 - math.sin(math.radians(30)))  # passive pressure coefficient
shift = 2 * cohesion * math.sqrt(factor) / (factor - 1)  # cohesion as a pressure [Pa]
plastic = {"model": "mohr_coulomb", "density": 2600, "youngs_modulus": young, "poisson_ratio": poisson, "cohesion": cohesion, "friction": slope, "dilation": 0.0}
steps = [0.6, 0.4, 0.3, 0.2, 0.1, 0.05, 0.0]  # support over initial pressure
stages = [{"name": "rock", "until": 1e-4}]
for share in steps:
    stages.append({"name": f"support {share}", "until": 0.1 * (len(stages) + 1), "at_rest": True, "set": {"conditions.3.value": share * pressure}})
stages[1]["remove"] = ["core"]
problem = deck("kirsch", plastic, [-pressure] * 3, ["core"], stages, 0.1 * (len(stages) + 1))
problem["conditions"].append({"type": "pressure", "side_set": "wall", "value": 0})
run = case.run("mohr_coulomb", None, problem, energy=1e-5, load=2 * pressure * far)
at_rest("mohr_coulomb", run, [f"support {share}" for share in steps])
ring = a * ((2 / (factor + 1)) * (pressure + shift) / shift) ** (1 / (factor - 1))
edge = 2 * (pressure + shift) / (factor + 1) - shift  # radial stress at the edge of the ring
r, theta, rr, tt, rt = polar(run, "rock")
inner = r < ring
exact_rr = -numpy.where(inner, shift * (r / a) ** (factor - 1) - shift, pressure - (pressure - edge) * (ring / r) ** 2)
exact_tt = -numpy.where(inner, factor * shift * (r / a) ** (factor - 1) - shift, pressure + (pressure - edge) * (ring / r) ** 2)
near = (r < 4 * a) & (numpy.abs(r - ring) > 0.1 * a)  # the hoop stress has an edge there
for name, found, exact in (("rr", rr, exact_rr), ("tt", tt, exact_tt)):
    case.check(f"mohr_coulomb: stress {name} within 4 a, farthest from the closed form over the initial one [-]",
               numpy.max(numpy.abs(found - exact)[near]) / pressure, 0, 0.03)  # fmt: skip
yielded = run.results.element("rock", "equivalent_plastic_strain") > 1e-8
# The outer radius of the last ring of elements that have yielded, along three rays.
radii = numpy.array([a, *outside])
rings = numpy.searchsorted(radii, r)
reach = [radii[rings[yielded & (abs(theta - angle) < 0.5 * math.pi / around)].max()] for angle in (math.pi / 8, math.pi / 4, 3 * math.pi / 8)]
size = numpy.diff(radii)[numpy.searchsorted(radii, ring) - 1]
case.same_bits("mohr_coulomb", None, problem, run, ranks=2)
case.check("mohr_coulomb: radius of the plastic ring, by elements that have yielded [m]", float(numpy.mean(reach)), ring, size)
case.finish()
