"""Free-field sides: ground under waves from below stays one-dimensional between them, whatever its law; a hill in level ground moves as in ground
three times as wide."""

import json
import math
import pathlib

import numpy
from coplanetest import Case, conforming, program

case = Case("free_field_sides", __file__)
soil, rock = (1800.0, 200.0), (2200.0, 800.0)  # density [kg/m^3], speed of shear waves [m/s]
poisson, gravity, amplitude = 0.3, 10.0, 0.01


def elastic(density, speed, **more):
    return {"model": "linear_elastic", "density": density, "poisson_ratio": poisson, "youngs_modulus": density * speed**2 * 2 * (1 + poisson), **more}


def pulse(start, frequency, size=amplitude):
    """One period of a sine under a bell."""
    s = f"(t - {start!r})*{frequency!r}"
    return f"t > {start!r} && {s} < 2 ? {size!r}*sin(2*_pi*{s})*(0.5 - 0.5*cos(_pi*{s})) : 0"


def column_mesh(name, columns, depth=10.0, height=20.0, size=0.5):
    """Rock below y = 0, soil above it."""
    x, y = numpy.arange(columns + 1) * size, numpy.arange(-depth, height + size / 2, size)
    points, at = conforming.grid(x, y)
    rows, split = len(y) - 1, round(depth / size)
    cells = [[(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for i in range(columns)] for j in range(rows)]
    middle = columns // 2
    conforming.write(name, points, {"rock": sum(cells[:split], []), "soil": sum(cells[split:], [])},
                     {"base": [(at(i, 0), at(i + 1, 0)) for i in range(columns)],
                      "left": [(at(0, j + 1), at(0, j)) for j in range(rows)],
                      "right": [(at(columns, j), at(columns, j + 1)) for j in range(rows)],
                      "top_left": [(at(1, rows), at(0, rows))], "top_middle": [(at(middle + 1, rows), at(middle, rows))] if columns > 1 else [(at(1, rows), at(0, rows))],
                      "all": [(at(0, j + 1), at(0, j)) for j in range(rows)] + [(at(columns, j), at(columns, j + 1)) for j in range(rows)]})  # fmt: skip


def deck(mesh, conditions, end, soil_law=None, **changes):
    return {
        "mesh": f"../{mesh}",
        "materials": {"soil": soil_law or elastic(*soil), "rock": elastic(*rock)},
        "blocks": {"soil": {"material": "soil"}, "rock": {"material": "rock"}},
        "contact": {"enabled": False},
        "conditions": conditions,
        "time": {"end": end},
        "history": {"every": 2e-3, "probes": [{"name": "left", "node_set": "top_left"}, {"name": "middle", "node_set": "top_middle"}]},
        **changes,
    }


def sides(*names):
    return [{"type": "free_field", "side_set": name} for name in names]


def base(x, y=0):
    return {"type": "absorbing", "side_set": "base", "incident": [x, y, 0]}


def largest(values):
    return float(numpy.max(numpy.abs(values)))


def spread(run, axes="xy"):
    """Largest difference of the velocities of a corner and the middle of the top over the largest velocity."""
    h = run.history
    return max(largest(h[f"left_velocity_{a}"] - h[f"middle_velocity_{a}"]) for a in axes) / max(largest(h[f"middle_velocity_{a}"]) for a in axes)


def uneven(run):
    """Largest difference of the final displacements of nodes at one height over the largest displacement."""
    u, x = run.results.nodal("displacement"), run.results.coordinates
    up = run.results.coordinates.shape[1] - 1 if numpy.ptp(x[:, -1]) > 0 else 1
    heights = numpy.round(x[:, up], 6)
    return max(numpy.ptp(u[heights == y], axis=0).max() for y in numpy.unique(heights)) / largest(u)


# --- S waves: the wide model against the column of V85, which has the exact transfer function ---------------------------------------

column_mesh("narrow.e", 1)
column_mesh("wide.e", 6)
wave, end = pulse(0.05, 2.5), 2.0
narrow = case.run("s_narrow", None, deck("narrow.e", [{"type": "symmetry", "node_set": "all", "normal": [0, 1, 0]}, base(wave)], end), energy=1e-4)
wide_deck = deck("wide.e", [base(wave), *sides("left", "right")], end)
wide = case.run("s_wide", None, wide_deck, energy=1e-4)
peak = largest(narrow.history["middle_velocity_x"])
case.check_within("S: the top moves more than the outcrop, by", peak / (2 * amplitude), 1.2, 10)
case.check_equal("S: cycles of the wide model, as of the column", int(wide.history["cycle"][-1]), int(narrow.history["cycle"][-1]))
for place in ("left", "middle"):
    case.check(f"S: {place} of the top against the column, over its peak",
               largest(wide.history[f"{place}_velocity_x"] - narrow.history["middle_velocity_x"]) / peak, 0, 1e-9)  # fmt: skip
# Shear turns the soil by v / c, so vertical motion is of second order: (v / c)^2 c over v.
case.check("S: vertical velocity of the wide model over the peak", largest(wide.history["left_velocity_y"]) / peak, 0, peak / soil[1])
case.check("S: unevenness of the wide model", uneven(wide), 0, 1e-9)
case.same_bits("s_wide", None, wide_deck, wide, ranks=2, threads=2)
case.same_bits("s_wide", None, wide_deck, wide, ranks=3)
quiet = case.run("s_absorbing", None, deck("wide.e", [base(wave), *({"type": "absorbing", "side_set": s} for s in ("left", "right"))], end), energy=1e-4)
case.check_within("S: with absorbing sides instead, difference of the middle over the peak",
                  largest(quiet.history["middle_velocity_x"] - narrow.history["middle_velocity_x"]) / peak, 0.1, 2)  # fmt: skip

# A base that is shaken as a whole: the column has the same. It is held vertically, the wide model moves by the second order of the strain.
shaken = {"type": "velocity", "node_set": "base", "value": [pulse(0.05, 2.5, 0.02), 0, 0]}
rigid_narrow = case.run("rigid_narrow", None, deck("narrow.e", [{"type": "symmetry", "node_set": "all", "normal": [0, 1, 0]}, shaken], end), energy=1e-4)
rigid_wide = case.run("rigid_wide", None, deck("wide.e", [shaken, *sides("left", "right")], end), energy=1e-4)
case.check("S, rigid base: the middle of the top against the column, over its peak",
           largest(rigid_wide.history["middle_velocity_x"] - rigid_narrow.history["middle_velocity_x"]) / largest(rigid_narrow.history["middle_velocity_x"]), 0, 1e-7)  # fmt: skip

# --- after the weight: P and S together, with a law that flows ---------------------------------------------------------------------------

begin, enters, end = 1.5, 1.6, 2.6
flowing = {"model": "j2", "density": soil[0], "poisson_ratio": poisson, "youngs_modulus": soil[0] * soil[1] ** 2 * 2 * (1 + poisson), "yield_stress": 1.3e5,
           "hardening_modulus": 5e6}  # fmt: skip
held = [{"type": "fixed", "node_set": s, "components": ["x"]} for s in ("left", "right")]


def staged(mesh, end, law, x, y=0, side="free_field", change=None):
    """The weight on a fixed base between sides that are held, then waves."""
    return deck(
        mesh, [*held, {"type": "fixed", "node_set": "base", "components": ["y"]}], end, law, gravity=[0, -gravity, 0],
        damping={"kinetic": True, "until_force_ratio": 1e-11},
        stages=[{"name": "weight", "until": begin},
                {"name": "shaking", "set": {"damping": None, "conditions.2": base(x, y), "conditions.0": {"type": side, "side_set": "left"},
                                            "conditions.1": {"type": side, "side_set": "right"}}}])  # fmt: skip


problem = staged("wide.e", end, flowing, pulse(enters, 2.5, 0.3), pulse(enters, 4.0, 0.1))
flow = case.run("staged", None, problem, energy=1e-3)
h = flow.history
between = (h["time"] > begin) & (h["time"] < enters)
case.check("weight, P and S, flow: speed before the waves [m/s]", max(largest(h[f"{p}_velocity_{a}"][between]) for p in ("left", "middle") for a in "xy"), 0, 1e-8)
case.check_within("weight, P and S, flow: plastic work over internal energy", float(h["plastic"][-1] / h["internal"][-1]), 0.05, 1)
case.check("weight, P and S, flow: corner against middle of the top", spread(flow), 0, 1e-7)
case.check("weight, P and S, flow: unevenness", uneven(flow), 0, 1e-7)
case.same_bits("staged", None, problem, flow, ranks=3)

# Restarted from before and after the free field begins.
for name, stop in (("weight", {"every_cycles": int(h["cycle"][h["time"] > 1.0][0])}), ("shaking", {"at_end": True})):
    stopped = case.attempt(f"stopped_in_{name}", None, {**problem, "time": {"end": 1.9}, "checkpoint": stop})
    case.check_equal(f"stopped in stage {name}: exit code", stopped.code, 0)
    code, output = program.run_program(["run.yaml", "--restart", "--set", f"time.end={end!r}"], str(stopped.folder), ranks=2)
    case.check_equal(f"restarted in stage {name}: exit code", code, 0)
    record = json.loads(pathlib.Path(stopped.path("run.run-s0002.json")).read_text())
    case.check_equal(f"restarted in stage {name}: state hash", record["state_hash"], flow.state_hash)

# --- a block of ground in space ----------------------------------------------------------------------------------------------------------------

box = {"dimension": 3, "parts": [{"shape": "box", "block": "soil", "size": [2, 3, 10], "divisions": [2, 3, 10]}],
       "side_sets": {"left": {"where": {"x": 0}}, "right": {"where": {"x": 2}}, "front": {"where": {"y": 0}}, "back": {"where": {"y": 3}}, "base": {"where": {"z": 0}}},
       "node_sets": {"top_left": {"where": {"x": 0, "y": 0, "z": 10}}, "top_middle": {"where": {"x": 1, "y": 1, "z": 10}}}}  # fmt: skip
space = deck("", [{**base(pulse(0.02, 5.0)), "incident": [pulse(0.02, 5.0), pulse(0.05, 4.0), pulse(0.03, 10.0)]}, *sides("left", "right", "front", "back")], 0.6)
space = {**{key: value for key, value in space.items() if key != "mesh"}, "materials": {"soil": elastic(*soil)}, "blocks": {"soil": {"material": "soil"}}}
run = case.run("space", box, space, energy=1e-3)
case.check("in space: corner against middle of the top", spread(run, "xyz"), 0, 1e-9)
case.check("in space: unevenness", uneven(run), 0, 1e-9)
t = run.history["time"]
exact = [2 * amplitude * math.sin(2 * math.pi * s) * (0.5 - 0.5 * math.cos(math.pi * s)) if 0 < (s := (v - 0.02 - 10 / soil[1]) * 5.0) < 2 else 0.0 for v in t]
case.check("in space: S wave at the surface, twice that which entered, largest difference over the peak",
           largest(run.history["middle_velocity_x"] - exact) / largest(exact), 0, 0.03)  # fmt: skip
case.same_bits("space", box, space, run, ranks=2)

# --- a hill: in ground three times as wide nothing comes back ------------------------------------------------------------------------------------------

depth, rise, crest, foot = 40.0, 20.0, 20.0, 60.0


def hill_mesh(name, half, size=4.0, rows=10):
    x = numpy.arange(-half, half + size / 2, size)
    surface = rise * numpy.clip((foot - abs(x)) / (foot - crest), 0, 1)
    points = [(float(a), float(-depth + (depth + s) * j / rows)) for j in range(rows + 1) for a, s in zip(x, surface, strict=True)]
    columns = len(x) - 1
    at = lambda i, j: j * len(x) + i  # noqa: E731
    near = lambda a: int(numpy.argmin(abs(x - a)))  # noqa: E731
    conforming.write(name, points, {"rock": [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for j in range(rows) for i in range(columns)]},
                     {"base": [(at(i, 0), at(i + 1, 0)) for i in range(columns)],
                      "left": [(at(0, j + 1), at(0, j)) for j in range(rows)], "right": [(at(columns, j), at(columns, j + 1)) for j in range(rows)],
                      **{place: [(at(near(a) + 1, rows), at(near(a), rows))] for place, a in (("crest", 0), ("foot", foot), ("level", 100.0))}})  # fmt: skip


hill_mesh("hill.e", 120.0)
hill_mesh("hill_wide.e", 360.0)
places = ("crest", "foot", "level")
begin, enters, end = 3.0, 3.1, 5.0
speed = 400.0


def hill(mesh, side, wave):
    problem = staged(mesh, end, None, wave, side=side)
    return {**problem, "materials": {"rock": elastic(2200.0, speed)}, "blocks": {"rock": {"material": "rock"}},
            "history": {"every": 4e-3, "probes": [{"name": p, "node_set": p} for p in places]}}  # fmt: skip


wave = pulse(enters, 4.0)
runs = {name: case.run(name, None, hill(mesh, side, wave), energy=1e-3)
        for name, mesh, side in (("hill", "hill.e", "free_field"), ("hill_wide", "hill_wide.e", "free_field"), ("hill_absorbing", "hill.e", "absorbing"))}  # fmt: skip
h = runs["hill"].history
between = (h["time"] > begin) & (h["time"] < enters)
case.check("hill: speed before the wave [m/s]", max(largest(h[f"{p}_velocity_{a}"][between]) for p in places for a in "xy"), 0, 1e-8)
times = numpy.arange(enters, 4.9, 4e-3)


def motion(name, place, axis):
    history = runs[name].history
    return numpy.interp(times, history["time"], history[f"{place}_velocity_{axis}"])


peak = 2 * amplitude
for place in places:
    differences = {name: max(largest(motion(name, place, a) - motion("hill_wide", place, a)) for a in "xy") / peak for name in ("hill", "hill_absorbing")}
    case.check(f"hill, {place}: difference from ground three times as wide, over twice the wave that enters", differences["hill"], 0, 0.1)
    case.check_within(f"hill, {place}: the same with absorbing sides, over it", differences["hill_absorbing"] / differences["hill"], 3, 1000)
case.same_bits("hill", None, hill("hill.e", "free_field", wave), runs["hill"], ranks=2, threads=2)
case.finish()
