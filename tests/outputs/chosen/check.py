"""What a deck chooses to be written: variables of the results, planes nearest to points, points on a line, extremes over sets of nodes."""

import copy
import os

import numpy
from coplanetest import Case, differences

case = Case("chosen outputs", __file__)
deck, recipe = case.load("tests/outputs/contact_fields/deck.yaml"), case.load("tests/outputs/contact_fields/mesh.yaml")
pressure, normal_stiffness, shear_stiffness, friction, speed = 1e6, 10e9, 5e9, 0.3, 0.1
closure = pressure / normal_stiffness
deck["conditions"][2]["value"] = [speed, 0, 0]  # the upper block is drawn over the lower one
deck["history"]["probes"] = [
    {"name": "near", "plane": [0.4, 1.0, 0]},
    {"name": "bed", "plane": [0.4, 1.0, 0], "joint": "bed"},
    {"name": "none", "plane": [0.4, 1.0, 0], "joint": "unused"},
    {"name": "row", "between": [[0, 2], [1, 2]], "count": 4, "variables": ["stress_yy", "strain_yy"]},
    {"name": "head", "point": [1, 2, 0], "relative_to": "row_1"},
    {"name": "roof", "node_set": "upper", "relative_to": "ground"},
    {"name": "ground", "block": "lower", "variables": ["strain_xy"]},
    {"name": "upper", "node_set": "upper", "variables": ["displacement_y", "velocity", "contact_pressure", "contact_slip"]},
]
full = copy.deepcopy(deck)
run = case.run("full", recipe, full, energy=2e-2)
h = run.history

# --- the nearest plane ---------------------------------------------------------------------------------------------------------
planes = run.planes(-1)
place = numpy.array([0.4 + h["row_1_displacement_x"][-1], 1.0])  # the point goes with the upper block, whose node is nearest to it
distance = numpy.hypot(*(planes["Points"][:, :2] - place).T)
nearest = numpy.flatnonzero((planes["lower_element"] == h["near_lower_element"][-1]) & (planes["higher_element"] == h["near_higher_element"][-1]))
case.check_equal("plane: it is one of the file", len(nearest), 1)
nearest = int(nearest[0])
case.check("plane: the others are further off, but for what the block has sunk [m]", distance[nearest], distance.min(), 1e-3)
case.check("plane: distance [m]", h["near_distance"][-1], distance[nearest], 1e-3)
for what, of_file in (("closure", planes["closure"]), ("gap", planes["gap"]), ("slip", planes["slip"]), ("normal_traction", planes["normal_traction"]), ("area", planes["area"]),
                      ("shear_traction", numpy.linalg.norm(planes["shear_traction"], axis=1)), ("state", planes["state"]), ("lower_element", planes["lower_element"])):  # fmt: skip
    case.check(f"plane: {what} is that of the file", h[f"near_{what}"][-1], float(of_file[nearest]), 1e-12 * max(1.0, abs(float(of_file[nearest]))))
    case.check_equal(f"plane of the joint: {what} is the same", bool((h[f"near_{what}"] == h[f"bed_{what}"]).all()), True)
t = h["time"][-1]
case.check("plane: normal traction [Pa]", h["near_normal_traction"][-1], pressure, 0.3, relative=True)  # the drawn block tilts
case.check("plane: shear over normal traction", h["near_shear_traction"][-1] / h["near_normal_traction"][-1], friction, 1e-9)
case.check("plane: slip [m]", h["near_slip"][-1], speed * t - friction * pressure / shear_stiffness, 0.05, relative=True)
case.check_equal("plane of a joint without planes: state", sorted(set(h["none_state"].tolist())), [0.0])
case.check_equal("plane of a joint without planes: distance", bool(numpy.isnan(h["none_distance"]).all()), True)

# --- slivers: the upper block reaches over the next face below by less than a thousandth of it --------------------------------------------
wide, corner = copy.deepcopy(recipe), copy.deepcopy(deck)
wide["parts"][0].update(max=[2, 1], divisions=[8, 4])
wide["parts"][1].update(max=[1.0001, 2], divisions=[4, 4])
corner["conditions"][2]["value"] = [0, 0, 0]
corner["history"]["probes"] = [{"name": "corner", "plane": [1, 1, 0]}]
beside = case.run("sliver", wide, corner, energy=2e-2)
slivers = beside.planes(-1)
case.check_equal("sliver: there is one, nearer than any other plane", bool(numpy.min(numpy.abs(slivers["Points"][:, 0] - 1)) < 1e-3), True)
case.check_within("sliver: the probe passes over it, to the middle of a face [m]", float(beside.history["corner_distance"][-1]), 0.1, 0.2)

# --- points on a line ------------------------------------------------------------------------------------------------------------
results = run.results
top = numpy.flatnonzero(results.coordinates[:, 1] == 2)
top = top[numpy.argsort(results.coordinates[top, 0])]
for k in range(4):
    for c, axis in enumerate("xy"):
        case.check(f"point {k + 1} of the line: displacement along {axis} [m]", h[f"row_{k + 1}_displacement_{axis}"][-1], float(results.nodal("displacement")[top[k], c]), 1e-15)
case.check_equal("points of the line have the variables", [f"row_{k}_stress_yy" in h for k in range(1, 5)], [True] * 4)

# --- motion against another probe --------------------------------------------------------------------------------------------------------
column = {name: numpy.array([h[f"{name}_{axis}"] for axis in "xy"]).T for name in ("row_1_displacement", "row_4_displacement", "head_displacement", "head_drift",
                                                                                   "row_1_velocity", "row_4_velocity", "head_velocity", "roof_displacement",
                                                                                   "roof_drift", "ground_displacement")}  # fmt: skip
for what in ("displacement", "velocity"):
    apart = column[f"row_4_{what}"] - column[f"row_1_{what}"]
    case.check(f"relative: {what} of the corner against the other one", numpy.abs(column[f"head_{what}"] - apart).max(), 0, 1e-18)
case.check("relative: drift of the corners, 1 m apart", numpy.abs(column["head_drift"] - column["head_displacement"]).max(), 0, 1e-18)
moved = results.nodal("displacement")
heights = results.coordinates[:, 1]
upper = numpy.arange(len(heights)) >= len(heights) - 16  # the upper block has the last 4 x 4
masses = numpy.array([0.25 if 0 < x < 1 else 0.125 for x in results.coordinates[~upper, 0]]) * [1.0 if 0 < y < 1 else 0.5 for y in heights[~upper]]
own = moved[upper].mean(axis=0) - (masses @ moved[~upper]) / masses.sum()
for c, axis in enumerate("xy"):
    case.check(f"relative: block against block along {axis} [m]", column["roof_displacement"][-1, c], own[c], 1e-15)
    case.check(f"relative: drift of the blocks, whose middles are 1 m apart, along {axis}", column["roof_drift"][-1, c], own[c], 1e-15)

# --- strain ------------------------------------------------------------------------------------------------------------------------------
strain = {c: results.element("upper", f"strain_{c}") for c in ("xx", "yy", "zz", "xy")}
quads = results.connectivity("upper")
for e, quad in enumerate(quads):
    # The gradient at the middle of a square from its corners, counter-clockwise from below on the left.
    rows = numpy.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) / (2 * (results.coordinates[quad[1], 0] - results.coordinates[quad[0], 0]))
    slope = numpy.eye(2) + moved[quad, :2].T @ rows
    stretches, axes = numpy.linalg.eigh(slope @ slope.T)
    exact = axes @ numpy.diag(0.5 * numpy.log(stretches)) @ axes.T
    for c, value in (("xx", exact[0, 0]), ("yy", exact[1, 1]), ("xy", exact[0, 1]), ("zz", 0.0)):
        case.check(f"strain {c} of element {e}", float(strain[c][e]), float(value), 1e-12)
middles = results.centres("upper")
nearest = numpy.argmin(numpy.hypot(middles[:, 0], middles[:, 1] - 2))
case.check("strain at a point is that of its element", h["row_1_strain_yy"][-1], float(strain["yy"][nearest]), 1e-18)
case.check("largest strain of a block", h["ground_strain_xy_largest"][-1], float(results.element("lower", "strain_xy").max()), 1e-18)

# --- extremes over a node set ------------------------------------------------------------------------------------------------------
nodes = numpy.flatnonzero(results.coordinates[:, 1] >= 1)
nodes = nodes[len(nodes) - 16 :]  # the upper block has the last 4 x 4
moved = results.nodal("displacement")
for name, values in (("displacement_y", moved[nodes, 1]), ("velocity", numpy.linalg.norm(results.nodal("velocity")[nodes], axis=1)),
                     ("contact_pressure", results.nodal("contact_pressure")[nodes]), ("contact_slip", results.nodal("contact_slip")[nodes])):  # fmt: skip
    for which, value, at in (("least", values.min(), values.argmin()), ("largest", values.max(), values.argmax())):
        column = f"upper_{name}_{which}"
        case.check(f"{column}", h[column][-1], float(value), 1e-12 * max(1.0, abs(float(value))))
        for c, axis in enumerate("xy"):
            case.check(f"{column}: place along {axis} [m]", h[f"{column}_place_{axis}"][-1], float((results.coordinates[nodes] + moved[nodes])[at, c]), 1e-12)
        case.check_equal(f"{column}: node", int(h[f"{column}_node"][-1]), int(nodes[at]) + 1)

# --- chosen variables ----------------------------------------------------------------------------------------------------------------
few = copy.deepcopy(deck)
few["output"]["variables"] = ["stress", "strain", "velocity_x", "contact_slip"]
some = case.run("few", recipe, few, energy=2e-2)
case.check_equal("few: variables of nodes", sorted(some.results.nodal_names), sorted(["displacement_x", "displacement_y", "velocity_x", "contact_slip"]))
case.check_equal("few: variables of elements", sorted(some.results.element_names), sorted(["alive", *(f"{tensor}_{c}" for tensor in ("stress", "strain") for c in ("xx", "yy", "zz", "xy", "yz", "zx"))]))
case.check_equal("few: their values are those of the whole file", bool((some.results.nodal("contact_slip") == results.nodal("contact_slip")).all()), True)
case.check_equal("few: stress", bool((some.results.element("upper", "stress_yy") == results.element("upper", "stress_yy")).all()), True)
case.check_equal("few: state hash", some.state_hash, run.state_hash)

# --- the same on two ranks -------------------------------------------------------------------------------------------------------------
again = case.attempt("few_on_2_ranks", recipe, few, ranks=2)
case.check_equal("2 ranks: exit code", again.code, 0)
case.check_equal("2 ranks: differences of the results", differences(some.path("run.e"), again.path("run.e")), [])
case.check_equal("2 ranks: run.csv has the same bytes", some.bytes_of("run.csv") == again.bytes_of("run.csv"), True)

# --- what is not there -----------------------------------------------------------------------------------------------------------------
for name, key, told in (("misspelt", {"output": {"variables": ["von_mices"]}}, "Did you mean 'von_mises'?"),
                        ("no_node_variable", {"probes": [{"name": "a", "node_set": "upper", "variables": ["contact_presure"]}]}, "Did you mean 'contact_pressure'?"),
                        ("no_joint", {"probes": [{"name": "a", "plane": [0, 1, 0], "joint": "bet"}]}, "Did you mean 'bed'?"),
                        ("taken", {"probes": [{"name": "a", "between": [[0, 2], [1, 2]]}, {"name": "a_2", "block": "upper"}]}, "point 2 would be called 'a_2'"),
                        ("no_other", {"probes": [{"name": "a", "block": "upper", "relative_to": "a"}, {"name": "base", "block": "lower"}]}, "There is: base"),
                        ("relative_plane", {"probes": [{"name": "b", "block": "upper"}, {"name": "a", "plane": [0, 1, 0], "relative_to": "b"}]}, "relative_to belongs to probes of a motion"),
                        ("one_point", {"probes": [{"name": "a", "between": [[0, 2], [0, 2]]}]}, "two different points")):  # fmt: skip
    wrong = copy.deepcopy(deck)
    wrong["output"].update(key.get("output", {}))
    wrong["history"]["probes"] = key.get("probes", [])
    refused = case.attempt(name, recipe, wrong)
    case.check_equal(f"{name}: exit code", refused.code, 3)
    case.check_equal(f"{name}: is told '{told}'", told in refused.output, True)

# What the laws or the first line of the history refuse, --check refuses, too, and writes nothing.
for name, probes, told in (("law", [{"name": "a", "block": "upper", "variables": ["damage"]}], "'a' asks for 'damage'"),
                           ("one_place", [{"name": "a", "point": [0, 2, 0]}, {"name": "b", "point": [0.01, 2, 0], "relative_to": "a"}], "are in one place"),
                           ("one_name", [], "two columns would be called 'contact_stored[J]'")):  # fmt: skip
    wrong = copy.deepcopy(deck)
    wrong["history"]["probes"] = probes
    if name == "one_name":
        wrong["joints"]["contact"] = wrong["joints"].pop("unused")
    ends = [case.attempt(f"check_{name}_{len(options)}", recipe, wrong, ranks=2, options=options) for options in ([], ["--check"])]
    case.check_equal(f"{name}: exit codes of the run and of --check", [end.code for end in ends], [3, 3])
    case.check_equal(f"{name}: both say '{told}'", [told in end.output for end in ends], [True, True])
    left = sorted(os.listdir(ends[1].folder))
    case.check_equal(f"{name}: --check writes nothing", [file for file in left if file.startswith("run.") and file != "run.yaml"], [])
case.finish()
