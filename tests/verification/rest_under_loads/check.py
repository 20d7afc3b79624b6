"""A run ends at rest only when its loads change no more: a load that comes late, and one that never ceases to change."""

from coplanetest import Case

case = Case("rest_under_loads", __file__)
bar = "tests/verification/relaxation"
mesh = case.load(f"{bar}/mesh.yaml")
mesh["side_sets"] = {"lid": {"block": "bar", "where": {"y": 4}}}
density, gravity, height, joint = 2000.0, 10.0, 4.0, 1e9
weight = density * gravity * height
closure = weight / joint
dampings = {
    "kinetic": {"kinetic": True, "until_energy_ratio": 1e-9, "until_force_ratio": 1e-4},
    "local": {"local": 0.7, "until_energy_ratio": 1e-12, "until_force_ratio": 1e-6},
}
# A load in absolute time begins long after all has come to rest: the run ends at rest under it, and not before.
for name, damping in dampings.items():
    deck = case.load(f"{bar}/deck.yaml")
    deck["damping"] = damping
    deck["time"] = {"end": 4, "end_at_rest": True}
    table = {"times": [0, 0.35, 0.4, 3], "values": [0, 0, 0.1 * weight, 0.1 * weight]}
    deck["conditions"] += [{"type": "pressure", "side_set": "lid", "value": table}]
    run = case.run(name, mesh, deck)
    h = run.history
    case.check_within(f"{name}: the run ends at [s]", h["time"][-1], 0.4, 0.7)
    sunk = -h["base_displacement_y"][-1]
    case.check(f"{name}: base has sunk by [m]", sunk, 1.1 * closure, 1e-3, relative=True)
    told = "rest counts from t = 0.4 s on, when conditions.1 (run.yaml:" in run.output
    case.check_equal(f"{name}: the log says from when rest counts", told, True)
    case.same_bits(name, mesh, deck, run)
# What goes on changing is never at rest, and the log says so.
deck = case.load(f"{bar}/deck.yaml")
deck["damping"] = dampings["local"]
deck["time"] = {"end": 0.2, "end_at_rest": True}
deck["gravity"] = [0, "-10 - 1e-3*sin(300*t)", 0]
never = case.run("never", mesh, deck)
case.check("a load that goes on changing: end [s]", never.history["time"][-1], 0.2, 1e-3)
case.check_equal("a load that goes on changing: warned of", "gravity changes until t = 0.2 s, so" in never.output, True)
case.finish()
