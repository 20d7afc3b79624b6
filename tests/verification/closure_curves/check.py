"""Bodies that close a curve, or a table, within a step or so keep their energy, less what the curve takes."""

import numpy
from coplanetest import Case

case = Case("closure_curves", __file__)
LAWS = {
    "closure_curve": {"model": "closure_curve", "initial_stiffness": 1e10, "maximum_closure": 1e-4},
    "table": {"model": "table", "closures": [5e-5, 1e-4, 1.5e-4], "tractions": [5e5, 2e6, 6e6]},
}
MORTAR = {"model": "mortar", "normal_stiffness": 82e9, "shear_stiffness": 36e9, "friction": 0.6, "cohesion": 0.35e6, "tensile_strength": 0.25e6, "tension_energy": 18, "shear_energy": 125,
          "compressive_strength": 10.5e6, "compression_energy": 5e3, "peak_crushing": 9e-5, "stiffness_loss": 0.5}  # fmt: skip


def squares(dimension, gap, turn=0.0):
    """Two squares, or cubes, of two elements along an edge, one above the other, turned by so many degrees about the last axis."""
    more = [0.0] * (dimension - 2)
    rotate = [0.0, 0.0, turn] if more else turn
    parts = [{"shape": "box", "block": block, "min": [0, low, *more], "size": [0.4] * dimension, "divisions": [2] * dimension} for block, low in (("lower", -0.4 - gap), ("upper", 0.0))]
    return {"dimension": dimension, "parts": [parts[0], {**parts[1], "rotate": rotate}] if turn else parts}


def met(joint, speed, factor, end, **contact):
    return {
        "materials": {"rock": {"model": "linear_elastic", "density": 2600, "youngs_modulus": 30e9, "poisson_ratio": 0}},
        "blocks": {"lower": {"material": "rock"}, "upper": {"material": "rock"}}, "joints": {"curve": joint}, "contact": {"default_joint": "curve", **contact},
        "initial": [{"block": "lower", "velocity": [0, speed, 0]}, {"block": "upper", "velocity": [0, -speed, 0]}],
        "viscosity": {"linear": 0, "quadratic": 0}, "time": {"end": end, "step_factor": factor}, "history": {"every": 1e-9},
    }  # fmt: skip


def energies(h):
    """Of bodies and joints over that at the start; hysteresis over it."""
    return (h["kinetic"] + h["internal"] + h["hourglass"] + h["contact_stored"]) / h["kinetic"][0], h["contact_hysteresis"] / h["kinetic"][0]


def check(what, h, gain):
    energy, lost = energies(h)
    case.check(f"{what}: largest energy over that at the start, less 1", energy.max() - 1, 0, gain)
    case.check(f"{what}: fall of the hysteresis over the energy", max(0.0, -numpy.diff(lost).min()), 0, 1e-14)
    return energy[-1], lost[-1]


for law, joint in LAWS.items():
    for speed in (1.0, 5.0):
        lost = {}
        for factor in (0.8, 0.1):
            what = f"{law}, {speed:g} m/s, step factor {factor}"
            h = case.run(f"{law}_{speed:g}_{factor}", squares(2, 2e-4), met(joint, speed, factor, 1e-3 + 2e-4 / speed), remainder=0.05).history
            left, lost[factor] = check(what, h, 2e-3)
            case.check(f"{what}: what is lost beside the hysteresis", 1 - left - lost[factor], 0, 0.03 if factor == 0.8 else 3e-3)
        case.check(f"{law}, {speed:g} m/s: hysteresis at a step factor of 0.8 over that at 0.1", lost[0.8] / lost[0.1], 1, 1e-9)

# Crushing that takes stiffness: what the joint loses is a matter of how far the bodies get, which hangs on the step a little.
for dimension, speed, turn in ((2, 1.0, 0.0), (2, 5.0, 0.0), (2, 20.0, 0.0), (3, 5.0, 0.0143)):
    lost, left = {}, {}
    for factor in (0.8, 0.1):
        what = f"mortar, {dimension}D, {speed:g} m/s{', turned' if turn else ''}, step factor {factor}"
        recipe, deck = squares(dimension, 4e-4 if turn else 2e-4, turn), met(MORTAR, speed, factor, 1e-3 + 4e-4 / speed)
        run = case.run(f"mortar_{dimension}_{speed:g}_{factor}", recipe, deck, remainder=0.08)
        left[factor], lost[factor] = check(what, run.history, 2e-3)
        case.check(f"{what}: what is lost beside the hysteresis", 1 - left[factor] - lost[factor], 0, 0.04 if factor == 0.8 else 2e-3)
        if turn and factor == 0.8:
            case.same_bits("mortar", recipe, deck, run, ranks=2)
            case.restarts("mortar", recipe, deck, run, near=3e-4)
    case.check(f"{what.rsplit(',', 1)[0]}: hysteresis at a step factor of 0.8 over that at 0.1", lost[0.8] / lost[0.1], 1, 0.06)
    case.check(f"{what.rsplit(',', 1)[0]}: energy left at a step factor of 0.8 less that at 0.1", left[0.8] - left[0.1], 0, 0.04)

# Slow enough to stop within the curve: hysteresis hangs on how far that is, and the end is not known beforehand.
lost = {factor: check(f"closure_curve, 0.05 m/s, step factor {factor}", case.run(f"slow_{factor}", squares(2, 1e-5), met(LAWS["closure_curve"], 0.05, factor, 3e-3), remainder=0.05).history, 2e-3)[1] for factor in (0.8, 0.1)}
case.check("closure_curve, 0.05 m/s: hysteresis at a step factor of 0.8 over that at 0.1", lost[0.8] / lost[0.1], 1, 0.02)

# Uneven closures on a curve that gets a hundred times as stiff: the upper square is turned by 1e-4 over its width. A cycle closes five times the
# whole curve: what is lost (0.02 of the energy, 0.16 where joints are declared) hangs on where in a cycle they meet; nothing may be gained.
steep = {**LAWS["closure_curve"], "stiffness_cap": 1e12}
for name, dimension, forces in (("plane", 2, "potential"), ("space", 3, "potential"), ("common_normal", 3, "common_normal")):
    recipe, deck = squares(dimension, 4e-4, 0.0143), met(steep, 5.0, 0.8, 1e-3, forces=forces)
    run = case.run(f"steep_{name}", recipe, deck, remainder=0.1, energy=5e-3)
    _, lost = check(f"steep curve, turned, {name}", run.history, 0.02)
    case.check_within(f"steep curve, turned, {name}: hysteresis over the energy", lost, 1e-5, 0.1)
    if name == "space":
        case.same_bits("steep", recipe, deck, run, ranks=2)
        case.same_bits("steep_threads", recipe, deck, run, ranks=1, threads=2)
        case.restarts("steep", recipe, deck, run, near=3e-4)
case.finish()
