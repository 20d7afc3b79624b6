"""A step that is safe: stiff joints make no energy, fast bodies catch each other, and the default stiffness is stiff enough."""

import sys

import numpy
from coplanetest import Case

case = Case("safe_step", __file__)
quiet = {"linear": 0, "quadratic": 0}


def two_bars(cells, size, density, modulus, ratio, speed, joint=None, gap=0.0):
    """Two bars of square cells that meet at +-speed; they stay for 2 L / c and are watched for twice that."""
    length = cells * size
    wave = (modulus * (1 - ratio) / ((1 + ratio) * (1 - 2 * ratio)) / density) ** 0.5
    recipe = {
        "dimension": 2,
        "parts": [
            {"shape": "box", "block": "left", "min": [-length - gap, 0], "size": [length, size], "divisions": [cells, 1]},
            {"shape": "box", "block": "right", "min": [0, 0], "size": [length, size], "divisions": [cells, 1]},
        ],
    }
    deck = {
        "materials": {
            "solid": {"model": "linear_elastic", "density": density, "youngs_modulus": modulus, "poisson_ratio": ratio}
        },
        "blocks": {"left": {"material": "solid"}, "right": {"material": "solid"}},
        "initial": [{"block": "left", "velocity": [speed, 0, 0]}, {"block": "right", "velocity": [-speed, 0, 0]}],
        "time": {"end": gap / (2 * speed) + 4 * length / wave},
        "history": {"probes": [{"name": "left", "block": "left"}, {"name": "right", "block": "right"}]},
    }
    if joint:
        deck["joints"] = {"tight": {"model": "linear", "normal_stiffness": joint}}
        deck["contact"] = {"default_joint": "tight"}
    return recipe, deck


# --- Stiff joints: 4 to 140 times the elements in series -------------------------------------------------
granite = (40, 1.0, 2650.0, 60e9, 0.25, 0.1)
steel = (40, 0.05, 7850.0, 210e9, 0.3, 5.0)
for name, bars, joint, gap in (
    ("default", granite, None, 0),
    ("granite 3e11", granite, 3e11, 0),
    ("granite 5e11", granite, 5e11, 0),
    ("granite 1e12", granite, 1e12, 0),
    ("steel 5e13", steel, 5e13, 0),
    ("steel 1e13, gap of 1e-6 m", steel, 1e13, 1e-6),
    ("steel 1e13, gap of 1e-3 m", steel, 1e13, 1e-3),
):
    recipe, deck = two_bars(*bars, joint=joint, gap=gap)
    run = case.run(name.replace(" ", "_").replace(",", ""), recipe, deck)
    h = run.history
    remainder = h["contact_remainder"][-1] / h["kinetic"][0]
    case.check(f"{name}: contact remainder at the end over the energy", remainder, 0, 2.5e-3)
    case.check(f"{name}: velocity given back", -h["left_velocity_x"][-1] / bars[-1], 0.97, 0.015)

# --- The default against Hertz: a ball of 32 elements in its radius on a rigid plane ----------------------
cells, radius, depth = 32, 1.0, 0.01  # largest approach over the radius
density, modulus, ratio = 7850.0, 200e9, 0.3
stiff = modulus / (1 - ratio**2)
mass = 4 / 3 * numpy.pi * radius**3 * density
speed = (16 / 15 * stiff * radius**0.5 * (depth * radius) ** 2.5 / mass) ** 0.5


def to_ball(x, center, radius, flat):
    """The cube [-1, 1]^d about `flat` becomes a ball; what is far from it stays."""
    chosen = numpy.max(numpy.abs((x - flat) / 1.0001), axis=1) <= 1
    p = x[chosen] - flat
    r = numpy.max(numpy.abs(p), axis=1, keepdims=True)
    u = p / numpy.where(r > 0, r, 1)
    q = u**2
    if x.shape[1] == 2:
        s = u * numpy.sqrt(1 - q[:, ::-1] / 2)
    else:
        y, z = q[:, [1, 2, 0]], q[:, [2, 0, 1]]
        s = u * numpy.sqrt(1 - y / 2 - z / 2 + y * z / 3)
    s /= numpy.maximum(numpy.linalg.norm(s, axis=1, keepdims=True), 1e-300)
    moved = x.copy()
    moved[chosen] = center + radius * r * (r * s + 0.75 * (1 - r) * u)
    return moved


def hertz(fractions, steps=20000):
    """Times at which these fractions of the change of velocity are over."""
    period = 3 * depth * radius / speed
    x, v, t, done = 0.0, speed, [], []
    for i in range(steps):
        v -= 4 / 3 * stiff * radius**0.5 * max(x, 0) ** 1.5 / mass * period / steps
        x += v * period / steps
        t.append(period * (i + 1) / steps)
        done.append((speed - v) / (2 * speed))
    return numpy.interp(fractions, done, t)


recipe = {
    "dimension": 2,
    "parts": [
        {"shape": "box", "block": "ball", "min": [0, 99], "size": [1, 2], "divisions": [cells, 2 * cells]},
        {"shape": "box", "block": "floor", "min": [0, -0.2], "size": [0.75, 0.2], "divisions": [24, 6]},
    ],
    "node_sets": {"axis": {"block": "ball", "where": {"x": 0}}, "floor": {"block": "floor"}},
}
deck = {
    "geometry": "axisymmetric",
    "materials": {
        "steel": {"model": "linear_elastic", "density": density, "youngs_modulus": modulus, "poisson_ratio": ratio}
    },
    "blocks": {"ball": {"material": "steel"}, "floor": {"material": "steel"}},
    "conditions": [
        {"type": "fixed", "node_set": "axis", "components": ["x"]},
        {"type": "fixed", "node_set": "floor"},
    ],
    "initial": [{"block": "ball", "velocity": [0, -speed, 0]}],
    "viscosity": quiet,
    "time": {"end": 1.3 * 2.9432 * depth * radius / speed},
    "history": {"every": 2.9432 * depth * radius / speed / 400, "probes": [{"name": "ball", "block": "ball"}]},
}
run = case.run(
    "hertz", recipe, deck, change_mesh=lambda x: to_ball(x, numpy.array([0, radius]), radius, numpy.array([0, 100.0]))
)
t, v = run.history["time"], run.history["ball_velocity_y"]
force = mass * numpy.convolve(numpy.gradient(v, t), numpy.ones(9) / 9, "same").max()
done = (v - v[0]) / (v[-1] - v[0])
duration = numpy.diff(numpy.interp([0.02, 0.98], done, t))[0]
case.check("Hertz: largest force [N]", force, 4 / 3 * stiff * radius**0.5 * (depth * radius) ** 1.5, 0.05, relative=True)
case.check("Hertz: from 2 to 98 % of the impulse [s]", duration, numpy.diff(hertz([0.02, 0.98]))[0], 0.05, relative=True)
case.check("Hertz: rebound", v[-1] / speed, 1, 0.01)

# --- The default in a fast impact on a coarse mesh --------------------------------------------------------
# Steel, 800 m/s; a ball of 30 mm radius, a plate of 20 mm. Coarse, 3 elements in the radius and 2 in the plate: contact that is
# four times as stiff moves the plate by no more than 5 %, so what is left is the mesh's. Less coarse, 5 in the radius, against 9, six
# times the elements; `check.py fine` computes that anew.
times, reference = [30e-6, 50e-6, 100e-6], [174.46, 262.70, 395.17]  # momentum of the plate [N s]


def sphere_on_plate(cells, contact=None):
    radius, width, thickness = 0.03, 0.18, 0.02
    across = round(width * cells / radius)
    recipe = {
        "dimension": 3,
        "parts": [
            {"shape": "box", "block": "ball", "min": [-1, -1, 99], "size": [2, 2, 2], "divisions": [2 * cells] * 3},
            {
                "shape": "box",
                "block": "plate",
                "min": [-width / 2, -width / 2, -thickness],
                "size": [width, width, thickness],
                "divisions": [across, across, round(thickness * cells / radius)],
            },
        ],
    }
    steel = {
        "model": "j2",
        "density": 7850,
        "youngs_modulus": 200e9,
        "poisson_ratio": 0.3,
        "yield_stress": 800e6,
        "hardening_modulus": 1e9,
    }
    deck = {
        "materials": {"steel": steel},
        "blocks": {"ball": {"material": "steel"}, "plate": {"material": "steel"}},
        "initial": [{"block": "ball", "velocity": [0, 0, -800]}],
        "time": {"end": 1.1e-4},
        "history": {"every": 1e-6, "probes": [{"name": "plate", "block": "plate"}]},
    }
    if contact:
        deck["joints"] = {"stiffer": {"model": "penalty", "stiffness_fraction": contact}}
        deck["contact"] = {"default_joint": "stiffer"}
    place, flat = numpy.array([0, 0, radius + 2e-3]), numpy.array([0, 0, 100.0])
    run = case.run(f"plate_{cells}" + (f"_{contact}" if contact else ""), recipe, deck, change_mesh=lambda x: to_ball(x, place, radius, flat))
    weight = 7850 * width**2 * thickness
    return numpy.interp(times, run.history["time"], -weight * run.history["plate_velocity_z"])


for time, momentum, stiffer in zip(times, sphere_on_plate(3), sphere_on_plate(3, contact=8)):
    case.check(f"sphere on coarse plate: momentum at {time * 1e6:.0f} us [N s]", momentum, stiffer, 0.05, relative=True)
fine = sphere_on_plate(9) if "fine" in sys.argv else reference
for time, momentum, expected in zip(times, sphere_on_plate(5), fine):
    case.check(f"sphere on plate: momentum at {time * 1e6:.0f} us [N s]", momentum, expected, 0.1, relative=True)

# --- The default between elastic cubes ----------------------------------------------------------------
recipe = {
    "dimension": 3,
    "parts": [
        {"shape": "box", "block": "left", "min": [-1, 0, 0], "size": [1, 1, 1], "divisions": [8, 8, 8]},
        {"shape": "box", "block": "right", "min": [0.01, 0, 0], "size": [1, 1, 1], "divisions": [8, 8, 8]},
    ],
}
deck = {
    "materials": {"soft": {"model": "linear_elastic", "density": 1000, "youngs_modulus": 1e9, "poisson_ratio": 0}},
    "blocks": {"left": {"material": "soft"}, "right": {"material": "soft"}},
    "initial": [{"block": "left", "velocity": [10, 0, 0]}],
    "viscosity": quiet,
    "time": {"end": 6e-3},
    "history": {"probes": [{"name": "left", "block": "left"}, {"name": "right", "block": "right"}]},
}
run = case.run("cubes", recipe, deck, energy=1e-3)
h = run.history
# Without Poisson's ratio the cubes are bars: they exchange their velocities, but for the ringing of their ends.
case.check("cubes: velocity of the one that was struck", h["right_velocity_x"][-1] / 10, 1, 0.03)
# All faces meet in one step: at most k (v dt)^2 / 8 is lost there, 5e-3.
case.check("cubes: contact remainder over the energy", h["contact_remainder"][-1] / h["kinetic"][0], 0, 5e-3)

# --- Faster than sound, and a plate of one element --------------------------------------------------------
# Caught, with the momentum of the mass that is struck, or stopped with the name of an element that is crushed.
wave = (200e9 * 0.7 / (1.3 * 0.4) / 7850) ** 0.5
for name, thick, speed in (
    ("v/c 0.3", 8, 0.3 * wave),
    ("v/c 1.3", 8, 1.3 * wave),
    ("v/c 5", 8, 5 * wave),
    ("plate of one element, 1 km/s", 1, 1000.0),
    ("plate of one element, 5 km/s", 1, 5000.0),
):
    recipe = {
        "dimension": 2,
        "parts": [
            {"shape": "box", "block": "block", "min": [-0.04, 0.005], "size": [0.08, 0.08], "divisions": [8, 8]},
            {"shape": "box", "block": "target", "min": [-0.2, -0.01 * thick], "size": [0.4, 0.01 * thick], "divisions": [40, thick]},
        ],
    }
    deck = {
        "materials": {
            "steel": {"model": "neo_hookean", "density": 7850, "youngs_modulus": 200e9, "poisson_ratio": 0.3}
        },
        "blocks": {"block": {"material": "steel"}, "target": {"material": "steel"}},
        "initial": [{"block": "block", "velocity": [0, -speed, 0]}],
        "time": {"end": max(0.1 / speed, 3 * 0.08 / wave)},  # waves have gone to and fro
        "history": {"probes": [{"name": "block", "block": "block"}, {"name": "target", "block": "target"}]},
    }
    run = case.attempt(name.replace(" ", "_").replace("/", "_").replace(",", ""), recipe, deck)
    h = run.history
    if run.code:
        case.check_equal(f"{name}: ends with code 6", run.code, 6)
        reasons = ("inside out", "too fast for the waves", "go through each other")
        case.check_equal(f"{name}: and says why", any(reason in run.output.replace("\n", " ") for reason in reasons), True)
        continue
    case.check_equal(f"{name}: no pair missed", int(h["missed"][-1]), 0)
    target, block = 0.4 * 0.01 * thick, 0.08**2
    passed = -h["target_velocity_y"][-1] * target / (speed * block)  # fraction of the block's momentum
    # From a plastic impact on what the block covers to an elastic one on all of the target.
    covered = 0.08 * 0.01 * thick
    least, most = covered / (covered + block), 2 * target / (target + block)
    case.check_within(f"{name}: fraction of the momentum that the target has", passed, least, most)
case.finish()
