"""V85: a layer over an elastic half-space, into which waves enter through an absorbing base, against the exact transfer function; with the
reaction of a base that was fixed before; a base that is shaken by its acceleration."""

import json
import math
import pathlib

import numpy
from coplanetest import Case, conforming, program

case = Case("V85", __file__)
height, depth, size, gravity = 20.0, 10.0, 0.5, 10.0
soil, rock = (1800.0, 200.0), (2200.0, 800.0)  # density [kg/m^3], speed of shear waves [m/s]
poisson = 0.3
p_over_s = math.sqrt((2 - 2 * poisson) / (1 - 2 * poisson))
amplitude = 0.01  # of the wave that enters [m/s]

# --- mesh: one element wide, rock below y = 0 -------------------------------------------------------------------------------

rows = numpy.arange(-depth, height + size / 2, size)
points = [(x, float(y)) for y in rows for x in (0.0, size)]
elements = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(rows) - 1)]
last = len(points) - 2
conforming.write("column.e", points, {"rock": elements[: round(depth / size)], "soil": elements[round(depth / size) :]},
                 {"base": [(0, 1)], "top": [(last + 1, last)],
                  "all": [(2 * i, 2 * i + 2) for i in range(len(rows) - 1)] + [(2 * i + 3, 2 * i + 1) for i in range(len(rows) - 1)]})  # fmt: skip


def elastic(density, speed):
    return {"model": "linear_elastic", "density": density, "poisson_ratio": poisson, "youngs_modulus": density * speed**2 * 2 * (1 + poisson)}


def deck(conditions, end, **changes):
    return {
        "mesh": "../column.e",
        "materials": {"soil": elastic(*soil), "rock": elastic(*rock)},
        "blocks": {"soil": {"material": "soil"}, "rock": {"material": "rock"}},
        "contact": {"enabled": False},
        "conditions": conditions,
        "time": {"end": end},
        "history": {"every": 2e-3, "probes": [{"name": "top", "node_set": "top"}, {"name": "base", "node_set": "base"}]},
        **changes,
    }


def sine(frequency, start=0.0):
    """Begins smoothly, over two periods."""
    ramp = 2 / frequency
    return f"t < {start!r} ? 0 : {amplitude}*sin(2*_pi*{frequency!r}*(t - {start!r}))*(t < {start + ramp!r} ? 0.5 - 0.5*cos(_pi*(t - {start!r})/{ramp!r}) : 1)"


def amplitude_of(times, values, frequency):
    """Of the sine of this frequency in the last two periods."""
    late = times > times[-1] - 2 / frequency
    t = times[late]
    waves = numpy.stack([numpy.cos(2 * math.pi * frequency * t), numpy.sin(2 * math.pi * frequency * t), numpy.ones(len(t))], axis=1)
    return math.hypot(*numpy.linalg.lstsq(waves, values[late], rcond=None)[0][:2])


def check_factor(name, run, frequency, speed, column):
    h = run.history
    phase = 2 * math.pi * frequency * height / speed
    ratio = soil[0] * soil[1] / (rock[0] * rock[1])
    exact = 1 / math.hypot(math.cos(phase), ratio * math.sin(phase))
    found = amplitude_of(h["time"], h[column], frequency) / (2 * amplitude)
    case.check(f"{name}: surface over outcrop", found, exact, 0.01, relative=True)


# --- S waves, from the start --------------------------------------------------------------------------------------------------

resonance = soil[1] / (4 * height)
for share in (0.5, 1.0, 1.6):
    f = share * resonance
    end = 24 * 2 * height / soil[1] + 4 / f
    conditions = [{"type": "symmetry", "node_set": "all", "normal": [0, 1, 0]}, {"type": "absorbing", "side_set": "base", "incident": [sine(f), 0, 0]}]
    check_factor(f"S, {share} of the resonance", case.run(f"s_{share}", None, deck(conditions, end), energy=1e-4), f, soil[1], "top_velocity_x")

# --- P waves, after the weight has come to rest on a fixed base, which absorbs from then on ------------------------------------------

f, begin, wave = p_over_s * resonance, 2.0, 2.5
end = wave + 24 * 2 * height / (p_over_s * soil[1]) + 4 / f
sides = {"type": "fixed", "node_set": "all", "components": ["x"]}
problem = deck(
    [sides, {"type": "fixed", "node_set": "base", "components": ["y"]}], end, gravity=[0, -gravity, 0],
    damping={"kinetic": True, "until_force_ratio": 1e-11},
    stages=[{"name": "weight", "until": begin},
            {"name": "shaking", "set": {"damping": None, "conditions.1": {"type": "absorbing", "side_set": "base", "incident": [0, sine(f, wave), 0]}}}])  # fmt: skip
run = case.run("p_staged", None, problem, energy=1e-4)
check_factor("P, in stages", run, f, p_over_s * soil[1], "top_velocity_y")
h = run.history
between = (h["time"] > begin) & (h["time"] < wave)
case.check("P, in stages: speed of the base and the top before the wave [m/s]",
           float(max(abs(h[f"{place}_velocity_y"][between]).max() for place in ("base", "top"))), 0, 1e-9)  # fmt: skip
weight_sag = gravity * (soil[0] * height**2 / 2 / (soil[0] * (p_over_s * soil[1]) ** 2)
                        + (soil[0] * height * depth + rock[0] * depth**2 / 2) / (rock[0] * (p_over_s * rock[1]) ** 2))  # fmt: skip
case.check("P, in stages: settlement of the top by its weight [m]", -float(h["top_displacement_y"][between][-1]), weight_sag, 1e-3, relative=True)
case.same_bits("p_staged", None, problem, run, ranks=3)

# Restarted from before and after the base is released: what it carries comes from the checkpoint.
for name, checkpoint in (("weight", {"every_cycles": int(h["cycle"][h["time"] > 1.5][0])}), ("shaking", {"at_end": True})):
    stopped = case.attempt(f"p_stopped_in_{name}", None, {**problem, "time": {"end": 2.2}, "checkpoint": checkpoint})
    case.check_equal(f"stopped in stage {name}: exit code", stopped.code, 0)
    code, output = program.run_program(["run.yaml", "--restart", "--set", f"time.end={end!r}"], str(stopped.folder), ranks=2)
    case.check_equal(f"restarted in stage {name}: exit code", code, 0)
    record = json.loads(pathlib.Path(stopped.path("run.run-s0002.json")).read_text())
    case.check_equal(f"restarted in stage {name}: state hash", record["state_hash"], run.state_hash)

# --- the same by times of conditions instead of stages: no kick without a support lies between ----------------------------------

timed = {key: value for key, value in problem.items() if key != "stages"}
timed["conditions"] = [sides, {"type": "fixed", "node_set": "base", "components": ["y"], "until": begin},
                       {"type": "absorbing", "side_set": "base", "from": begin, "incident": [0, sine(f, wave), 0]}]  # fmt: skip
timed["damping"] = {"kinetic": True, "until": begin}
run = case.run("p_timed", None, timed, energy=1e-4)
between = (run.history["time"] > begin) & (run.history["time"] < wave)
case.check("P, by times: speed of the top before the wave [m/s]", float(abs(run.history["top_velocity_y"][between]).max()), 0, 1e-9)
check_factor("P, by times", run, f, p_over_s * soil[1], "top_velocity_y")

# --- a rigid base, by acceleration (a table with a scale) and by velocity -------------------------------------------------------------

times = numpy.linspace(0, 2, 801)
table = {"times": times.tolist(), "values": numpy.sin(2 * math.pi * 3 * times).tolist(), "scale": 0.5}
held = {"type": "symmetry", "node_set": "all", "normal": [0, 1, 0]}
tops = []
for name, kind, value in (("acceleration", "acceleration", table), ("velocity", "velocity", "0.5/(6*_pi)*(1 - cos(6*_pi*t))")):
    run = case.run(f"by_{name}", None, deck([held, {"type": kind, "node_set": "base", "components": ["x"], "value": [value, 0, 0]}], 2.0), energy=1e-4)
    tops.append(numpy.interp(times, run.history["time"], run.history["top_velocity_x"]))
case.check("base by acceleration and by velocity: largest difference of the top over its largest velocity",
           float(abs(tops[0] - tops[1]).max() / abs(tops[1]).max()), 0, 1e-3)  # fmt: skip
case.finish()
