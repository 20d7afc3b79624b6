"""What the results, planes, joint columns and tables say of a joint under known pressure."""

import copy

import numpy
from coplanetest import Case, differences, tables

case = Case("contact fields", __file__)
pressure, normal_stiffness, shear_stiffness, friction = 1e6, 10e9, 5e9, 0.3
closure = pressure / normal_stiffness


def check_sums(name, run):
    """Tables against the history, in the last line."""
    h = run.history
    last = int(h["cycle"][-1])
    for file, columns in (
        ("run_blocks.csv", {"kinetic": "kinetic", "internal": "internal"}),
        ("run_pairs.csv", {"stored": "contact_stored", "friction": "contact_friction"}),
    ):
        found = tables.columns(run.path(file))
        for column, quantity in columns.items():
            total = found[column][found["cycle"] == last].sum()
            scale = max(abs(h["kinetic"][-1]), abs(h["internal"][-1]), abs(h["contact_stored"][-1]))
            case.check(f"{name}: {column} of {file}", total, h[quantity][-1], 1e-12 * scale)


deck = case.load()
recipe = case.load("mesh.yaml")

# At rest: every number is known. (Nothing moves, so there is no energy by which a balance could be judged.)
rest = case.attempt("rest", recipe, deck)
case.check_equal("rest: exit code", rest.code, 0)
results = rest.results
for step in (0, -1):
    for side_set in ("below", "above"):
        name = f"rest, step {step}, {side_set}"

        def side(variable):
            return results.side(side_set, f"side_{variable}", step)

        case.check_equal(f"{name}: sides stick", sorted(set(side("state").tolist())), [2.0])
        for what, value, scale in (
            ("normal_traction", pressure, pressure),
            ("shear_traction", 0, pressure),
            ("closure", closure, closure),
            ("gap", -closure, closure),
            ("slip", 0, closure),
            ("area_fraction", 1, 1),
        ):
            case.check(f"{name}: {what}", numpy.max(numpy.abs(side(what) - value)) / scale, 0, 1e-9)
case.check_equal("rest: sides of the top", sorted(set(results.side("top", "side_state").tolist())), [0.0])
at_joint = results.coordinates[:, 1] == 1
traction = results.nodal("contact_traction")[at_joint]
case.check("rest: traction at nodes", numpy.max(numpy.abs(numpy.abs(traction[:, 1]) - pressure)), 0, 1e-9 * pressure)
at_nodes = results.nodal("contact_closure")[at_joint]
case.check("rest: closure at nodes", numpy.max(numpy.abs(at_nodes - closure)), 0, 1e-9 * closure)

h = rest.history
case.check("rest: stick area [m^2]", h["bed_stick_area"][-1], 1, 1e-9)
case.check("rest: open area [m^2]", h["bed_open_area"][-1], 0, 1e-9)
case.check("rest: mean closure [m]", h["bed_mean_closure"][-1], closure, 1e-9, relative=True)
case.check("rest: normal force [N]", h["bed_normal_force"][-1], pressure, 1e-9, relative=True)
case.check("rest: force of a joint without planes [N]", h["unused_normal_force"][-1], 0, 0)
check_sums("rest", rest)

planes = rest.planes()
case.check("planes: largest closure so far", numpy.max(numpy.abs(planes["maximum_closure"] - closure)), 0, 1e-9 * closure)
case.check("planes: stored [J]", numpy.sum(planes["stored"]), 0.5 * pressure * closure, 1e-9, relative=True)
for which, block in (("lower", 1), ("higher", 2)):
    case.check_equal(f"planes: {which} block", numpy.unique(planes[f"{which}_block"]).tolist(), [block])
case.check_equal("planes: declared", numpy.unique(planes["declared"]).tolist(), [1])
case.check_equal("planes: name of their joint", rest.series.joint_names(-1)[planes["joint"][0]], "bed")

census = rest.record["census"]
case.check_equal("record: planes closed", census["declared_closed"], len(planes["joint"]))
case.check_equal("record: gaps of joints", census["joint_gaps"]["count"], len(planes["joint"]))

# The upper block is drawn over the lower one; its stress stays as it is.
sliding = copy.deepcopy(deck)
sliding["conditions"][2]["value"] = [0.1, 0, 0]
slide = case.run("slide", recipe, sliding, energy=2e-2)
results = slide.results
for side_set in ("below", "above"):
    normal, shear = (results.side(side_set, f"side_{what}_traction") for what in ("normal", "shear"))
    touching = results.side(side_set, "side_area_fraction") > 0
    case.check_equal(f"slide, {side_set}: state", sorted(set(results.side(side_set, "side_state").tolist())), [3.0])
    case.check(f"slide, {side_set}: shear over normal", numpy.max(numpy.abs(shear / normal / friction - 1)[touching]), 0, 1e-9)
h = slide.history
case.check_equal("slide: all slips", bool(h["bed_slip_area"][-1] > 0.99 and h["bed_stick_area"][-1] == 0), True)
case.check("slide: friction of the joint [J]", h["bed_friction"][-1], h["contact_friction"][-1], 0)
check_sums("slide", slide)

# The same on two ranks, in every byte that matters.
again = case.attempt("slide_on_2_ranks", recipe, sliding, ranks=2)
case.check_equal("2 ranks: exit code", again.code, 0)
case.check_equal("2 ranks: differences of the results", differences(slide.path("run.e"), again.path("run.e")), [])
for name in ["run.csv", "run_blocks.csv", "run_pairs.csv", *slide.planes_files()]:
    case.check_equal(f"2 ranks: {name} has the same bytes", slide.bytes_of(name) == again.bytes_of(name), True)
case.check_equal("2 ranks: census", again.record["census"], slide.record["census"])
case.finish()
