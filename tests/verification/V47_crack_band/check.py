"""V47: a bar that cracks in one element takes the fracture energy, whatever the size of its elements."""

from coplanetest import Case

case = Case("V47", __file__)
length, energy = 0.2, 120.0
for size in (0.005, 0.01, 0.02, 0.04):
    recipe = {
        "dimension": 3,
        "parts": [
            {"shape": "box", "block": "bar", "min": [0, 0, 0], "size": [length, size, size],
             "divisions": [round(length / size), 1, 1]},
        ],
        "node_sets": {
            "left": {"where": {"x": 0}}, "right": {"where": {"x": length}},
            "foot": {"where": {"y": 0}}, "back": {"where": {"z": 0}},
        },
    }
    deck = {
        "title": "a bar is torn",
        "blocks": {"bar": {"material": "concrete_c40"}},
        "contact": {"enabled": False},
        "viscosity": {"linear": 0, "quadratic": 0},
        "conditions": [
            {"type": "fixed", "node_set": "left", "components": ["x"]},
            {"type": "fixed", "node_set": "foot", "components": ["y"]},
            {"type": "fixed", "node_set": "back", "components": ["z"]},
            # 0.3 mm in the end, ten times the opening over which the strength falls to 1/e.
            {"type": "velocity", "node_set": "right", "components": ["x"], "value": ["0.03*min(t/0.002, 1)", 0, 0]},
        ],
        # A body force makes the stress rise towards the left end by more, from one element to the next,
        # than the pull adds while the news of a crack passes an element: only the first one cracks.
        "gravity": ["1000*min(t/0.002, 1)", 0, 0],
        "damping": {"mass": 2000},
        "time": {"end": 0.011},
        "output": {"every": 0.011, "planes": False},
        "history": {"every": 0},
    }
    run = case.run(f"{1000 * size:g}mm", recipe, deck)
    name = f"{1000 * size:g} mm"
    dissipated = run.history["plastic"][-1] / size**2
    case.check(f"{name}: dissipated per area [J/m^2]", dissipated, energy, 0.03, relative=True)
    damage = sorted(run.results.element("bar", "damage"))
    case.check(f"{name}: damage of the cracked element", damage[-1], 1, 0.01)
    case.check(f"{name}: damage of the next", damage[-2], 0, 0.01)
    if size == 0.01:
        case.same_bits("ranks", recipe, deck, run)
case.finish()
