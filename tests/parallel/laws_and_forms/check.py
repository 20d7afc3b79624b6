"""V59, V60 for every law and every form of element: one run, bit for bit, on any ranks, threads and back end.

Usage: check.py 3d|2d|rings

A body for each law in one-point elements, and one for each further form, shape and objective rate. They strike each other in pairs, fast enough
to yield, crush or crack.
"""

import sys

from coplanetest import Case, differences, documents, program

dimension = sys.argv[1]
case = Case(f"V59 V60 laws {dimension}", __file__)
flat = dimension != "3d"

elastic = {"density": 2500, "youngs_modulus": 30e9, "poisson_ratio": 0.2}
LAWS = {
    "linear_elastic": {"model": "linear_elastic", **elastic},
    "fluid": {"model": "fluid", "density": 1000, "eos": "mie_grueneisen", "sound_speed": 1500, "shock_slope": 1.9, "grueneisen": 0.1},
    "j2": {"model": "j2", **elastic, "yield_stress": 2e7, "hardening_modulus": 1e9, "kinematic_modulus": 5e8},
    "j2_table": {"model": "j2", **elastic, "plastic_strains": [0, 0.01, 0.1], "yield_stresses": [2e7, 3e7, 4e7]},
    "drucker_prager": {"model": "drucker_prager", **elastic, "cohesion": 4e6, "friction": 0.5, "dilation": 0.1},
    "mohr_coulomb": {"model": "mohr_coulomb", "set": "clay_brick"},
    "ubiquitous_joints": {
        "model": "ubiquitous_joints", **elastic, "cohesion": 5e6, "friction": 0.7, "dilation": 0.1, "tensile_strength": 2e6,
        "shear_energy": 500, "fracture_energy": 50,
        "joint_normal": [0, 1, 0] if dimension == "rings" else [1, 2, 0] if flat else [1, 2, 3],
        "joint_cohesion": 1e6, "joint_friction": 0.45, "joint_dilation": 0.1, "joint_tensile_strength": 0.5e6,
    },
    "hoek_brown": {
        "model": "hoek_brown", **elastic, "intact_strength": 50e6, "intact_constant": 10, "gsi": 60, "dilation": 0.1,
        "residual_gsi": 30, "shear_energy": 5e3, "tensile_strength": 0.1e6, "fracture_energy": 20,
    },
    "johnson_cook": {"model": "johnson_cook", "set": "copper_ofhc"},
    "pseudo_cap": {"model": "pseudo_cap", "set": "concrete_c40"},
    "pseudo_cap_rates": {"model": "pseudo_cap", "set": "concrete_c40", "rate_effects": True, "crack_closure": True},
    "hjc": {"model": "hjc", "set": "concrete_hjc_48"},
    "jh2": {
        "model": "jh2", "density": 2350, "shear_modulus": 2.686e9, "bulk_moduli": [3.7356e9, 9e9, 22e9], "elastic_limit": 1.982e9,
        "elastic_limit_pressure": 1.374e9, "tensile_strength": 8e6, "intact_factor": 0.71, "intact_exponent": 0.55, "fractured_factor": 0.3,
        "fractured_exponent": 0.4, "largest_fractured_strength": 0.25, "rate_factor": 0.022, "damage_factor": 0.002, "damage_exponent": 1.2,
    },
    "kcc": {"model": "kcc", "set": "concrete_kcc_45", "rate_effects": True},
    # TNT with a hundredth of its pressures and a tenth of its speed: the front crosses most of the body.
    "jwl": {
        "model": "jwl", "density": 1630, "jwl_a": 3.712e9, "jwl_b": 3.231e7, "jwl_r1": 4.15, "jwl_r2": 0.95, "omega": 0.3,
        "detonation_energy": 7e7, "detonation_speed": 693, "detonation_pressure": 2.1e8,
    },
    "ideal_gas": {"model": "ideal_gas", "density": 1000, "heat_ratio": 1.4, "pressure": 1e5},
    "neo_hookean": {"model": "neo_hookean", "density": 1100, "youngs_modulus": 30e6, "poisson_ratio": 0.45},
}
RATES = [{"objective_rate": "jaumann"}, {"objective_rate": "green_naghdi"}]
FORMS = [{"element": name} for name in ("assumed_strain", "full_integration", "full_integration_plain")]
SIMPLICES = [{}, {"element": "nodal_pressure"}]

# (law, options of the block, whether its elements are triangles or tetrahedra)
bodies = [("neo_hookean", {}, False)] + [(law, {}, False) for law in LAWS if law not in ("neo_hookean", "jwl", "ideal_gas")]
bodies += [(law, options, False) for law in ("j2", "pseudo_cap") for options in RATES + FORMS if law == "j2" or "element" in options]
bodies += [(law, options, True) for law in ("j2", "pseudo_cap") for options in SIMPLICES]
bodies += [(law, {"element": "full_integration"}, False) for law in ("pseudo_cap_rates", "jh2", "kcc")]
bodies += [(law, options, False) for law in ("jwl", "ideal_gas") for options in ({}, {"element": "full_integration"})]
assert len(bodies) % 2 == 0  # pairs

size, pitch, inner = 0.01, 0.01002, 0.02
recipe = {"dimension": 2 if flat else 3, "parts": []}
deck = {
    "title": "every law and every form",
    "materials": LAWS,
    "blocks": {},
    "initial": [],
    "joints": {"touch": {"model": "penalty", "friction": 0.3}},
    "contact": {"default_joint": "touch", "search_every": 4},
    "history": {"tables": ["blocks"]},
}
if dimension == "rings":
    deck["geometry"] = "axisymmetric"
for i, (law, options, simplices) in enumerate(bodies):
    name = "_".join([law, *options.values(), *(["simplices"] if simplices else [])])
    low = inner if flat else 0
    part = {"shape": "box", "block": name, "min": [low, i * pitch], "size": [size, size], "divisions": [4, 3 + i % 2]}
    if not flat:
        part = {**part, "min": [0, i * pitch, 0], "size": [size] * 3, "divisions": [3, 2 + i % 2, 3]}
    if simplices:
        part["split"] = "triangles" if flat else "tetrahedra"
    recipe["parts"].append(part)
    deck["blocks"][name] = {"material": law, **options}
    if law == "jwl":
        deck["materials"]["jwl"].setdefault("lighting_points", []).append([low, (i + 0.5) * pitch] + ([] if flat else [0]))
    if law in ("fluid", "jwl", "ideal_gas") and not options:
        deck["blocks"][name]["hourglass"] = {"stiffness": 0, "viscosity": 0.1}
    # In pairs they strike each other, off the middle: one above the other does not move as fast along x.
    sign = 1 if i % 2 == 0 else -1
    deck["initial"].append({"block": name, "velocity": [sign * 4, sign * 20, 0 if flat else sign * 3]})
deck["time"] = {"end": 1.2e-5 if flat else 1.5e-5}
deck["output"] = {"every": deck["time"]["end"] / 2}

# Every model of the program has a body.
models = set(documents.load(program.schema("deck"))["properties"]["materials"]["additionalProperties"]["properties"]["model"]["enum"])
case.check_equal("models without a body", sorted(models - {LAWS[law]["model"] for law, _, _ in bodies}), [])
reference = case.run("reference", recipe, deck, energy=0.02)
h = reference.history
for what in ("plastic", "stick"):
    case.check_within(f"reference: {what}", max(h[what]), 1e-9, float("inf"))
for name, (law, _, _) in zip(deck["blocks"], bodies):
    if law == "jwl":
        burnt = reference.results.element(name, "burn_fraction")
        case.check_within(f"reference: {name}: burnt", burnt.mean(), 0.2, 0.99)
    elif law not in ("linear_elastic", "neo_hookean", "fluid", "ideal_gas"):
        strain = abs(reference.results.element(name, "equivalent_plastic_strain")).max()
        case.check_within(f"reference: {name}: plastic strain", strain, 1e-9, float("inf"))

for ranks, threads, backend in ((2, 1, "serial"), (3, 2, "threads"), (1, 2, "threads")):
    name = f"{ranks}x{threads}_{backend}"
    run = case.attempt(name, recipe, deck, ranks, threads, backend)
    if not case.check_equal(f"{name}: exit code", run.code, 0):
        print(run.output)
        continue
    case.check_equal(f"{name}: state hash", run.state_hash, reference.state_hash)
    case.check_equal(f"{name}: history differs", run.bytes_of("run.csv") != reference.bytes_of("run.csv"), False)
    case.check_equal(f"{name}: results that differ", differences(run.path("run.e"), reference.path("run.e")), [])
case.finish()
