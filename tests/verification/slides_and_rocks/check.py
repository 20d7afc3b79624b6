"""Blocks that slide, rock and dilate on their joint: friction is that of what presses it, and nothing is left over."""

import itertools

from coplanetest import Case

case = Case("slides_and_rocks", __file__)
STONE = {"model": "linear_elastic", "density": 2000, "youngs_modulus": 1e9, "poisson_ratio": 0.2}
SHEAR = {"shear_stiffness": 5e9, "friction": 0.6}
LAWS = {
    "linear": {"model": "linear", "normal_stiffness": 5e9, **SHEAR},
    "table": {"model": "table", "closures": [1e-4, 2e-4, 1e-3], "tractions": [2e5, 6e5, 6e6], **SHEAR},
    "penalty": {"model": "penalty", "friction": 0.6},
    "barton_bandis": {"model": "barton_bandis", "roughness": 10, "wall_strength": 80e6, "rock_strength": 100e6, "residual_friction": 0.5, "peak_slip": 1e-3, "shear_stiffness": 5e9},
    "closure_curve": {"model": "closure_curve", "initial_stiffness": 2e9, "maximum_closure": 1e-3, **SHEAR},
}


def block_on_base(dimension):
    third = [[0.3], [-0.15], [0.2], [-0.1]] if dimension == 3 else [[]] * 4
    many = [[3], [2]] if dimension == 3 else [[], []]
    return {
        "dimension": dimension,
        "parts": [
            {"shape": "box", "block": "base", "min": [-0.3, -0.1, *third[1]], "size": [0.8, 0.1, *third[0]], "divisions": [8, 2, *many[0]]},
            {"shape": "box", "block": "brick", "min": [-0.1, 0.0, *third[3]], "size": [0.2, 0.1, *third[2]], "divisions": [4, 2, *many[1]]},
        ],
        "node_sets": {"ground": {"block": "base", "where": {"y": -0.1}}},
    }


def deck_of(law, dilation, end):
    return {
        "materials": {"stone": STONE}, "blocks": {name: {"material": "stone"} for name in ("base", "brick")},
        "joints": {"bed": {**LAWS[law], **({"dilation": dilation} if dilation else {})}}, "contact": {"default_joint": "bed"},
        "conditions": [{"type": "fixed", "node_set": "ground"}], "viscosity": {"linear": 0, "quadratic": 0},
        "time": {"end": end, "energy_tolerance": 1e9}, "history": {"every": end / 100, "joints": ["bed"]}, "output": {"planes": False},
    }  # fmt: skip


# It is thrown on its bed, slides and rocks.
for law, dimension, dilation in itertools.product(LAWS, (2, 3), (0, 0.3)):
    if law == "barton_bandis" and dilation:  # it dilates by its roughness
        continue
    name = f"{law} in {dimension}D, dilation {dilation}"
    recipe, deck = block_on_base(dimension), deck_of(law, dilation, 6e-3)
    deck["gravity"] = [0, -300, 0]
    deck["initial"] = [{"block": "brick", "velocity": [2.0, -1.0, 0.3 * (dimension == 3)], "angular_velocity": [0, 0, 5.0], "center": [0, 0.05, 0]}]
    left = []
    for factor, impulses in ((0.8, "leapfrog"), (0.2, "leapfrog"), (0.8, "path"), (0.2, "path")):
        deck["contact"]["impulses"] = impulses
        deck["time"]["step_factor"] = factor
        folder = f"thrown_{law}_{dimension}_{dilation}_{factor}_{impulses}"
        run = case.run(folder, recipe, deck, energy=5e-3)
        left.append(run.history["contact_remainder"][-1] / run.history["kinetic"][0])
        if law == "table" and dilation and factor == 0.8:
            case.same_bits(folder, recipe, deck, run, ranks=2, threads=2)
    if law != "barton_bandis":  # whose strength is one of SI units
        case.check_equal(f"{name}: friction is a good part of the energy", bool(run.history["contact_friction"][-1] > 0.2 * run.history["kinetic"][0]), True)
    case.check(f"{name}: contact remainder over the first energy", left[0], 0, 8e-3)
    case.check(f"{name}: the same with a fourth of the step", left[1], 0, 2e-4)
    exact = law in ("linear", "penalty") and not dilation
    case.check(f"{name}, path: contact remainder over the first energy", left[2], 0, 3e-4 if exact else 2e-3)
    case.check(f"{name}, path: the same with a fourth of the step", left[3], 0, 2e-6 if exact else 2e-4)
case.finish()
