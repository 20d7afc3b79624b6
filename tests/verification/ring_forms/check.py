"""Forms of elements of bodies of revolution: Lame's cylinder up to incompressibility, a plate in bending, and a ring that closes."""

import numpy
from coplanetest import Case

case = Case("ring_forms", __file__)

# u(a) = (1 + nu)/E p a^2 / (b^2 - a^2) ((1 - 2 nu) a + b^2 / a) in plane strain.
a, b, p, young = 1.0, 2.0, 1e6, 200e9
forms = (
    ("one_point", None, 0.02),
    ("assumed_strain", None, 0.02),
    ("full_integration", None, 0.02),
    ("full_integration_plain", None, None),
    ("nodal_pressure", "triangles", 0.02),
)
for poisson in (0.3, 0.499):
    exact = (1 + poisson) / young * p * a**2 / (b**2 - a**2) * ((1 - 2 * poisson) * a + b**2 / a)
    for form, split, tolerance in forms:
        recipe, deck = case.load("mesh_cylinder.yaml"), case.load("deck_cylinder.yaml")
        if split:
            recipe["parts"][0]["split"] = split
        deck["materials"]["steel"]["poisson_ratio"] = poisson
        deck["blocks"]["ring"]["element"] = form
        name = f"cylinder_{form}_{poisson}"
        run = case.run(name, recipe, deck, energy=2e-3)
        opened = run.history["bore_displacement_x"][-1]
        report = tolerance is None and poisson > 0.4
        case.check(f"{name}: motion of the bore over Lame's", opened / exact, 1, tolerance or 0.02, report=report)
        if form != "one_point" and poisson == 0.3:
            case.same_bits(name, recipe, deck, run)

# Mindlin's plate, clamped: w = q R^4 / (64 D) + q R^2 / (4 k G h), k = 5/6.
radius, thickness, pressure, poisson = 1.0, 0.1, 1e5, 0.3
stiffness = young * thickness**3 / (12 * (1 - poisson**2))
shear = 5 / 6 * young / (2 * (1 + poisson)) * thickness
exact = pressure * radius**4 / (64 * stiffness) + pressure * radius**2 / (4 * shear)
for form in ("assumed_strain", "one_point", "full_integration"):
    deck = case.load("deck_plate.yaml")
    deck["blocks"]["plate"]["element"] = form
    run = case.run(f"plate_{form}", case.load("mesh_plate.yaml"), deck, energy=2e-3)
    deflection = -run.history["middle_displacement_y"][-1]
    case.check(
        f"plate_{form}: deflection over Mindlin's", deflection / exact, 1, 0.03, report=form != "assumed_strain"
    )

# A soft ring flies to its axis: rho v^2 is ten times its modulus, and its bore would be on the other side after 20 microseconds. Its inner
# nodes come to the axis and stop; of the energy goes what their radial motion had. Steps are small: what stops a node within one is of the
# first order (8e-3 of the energy with a factor of 0.2, 1.6e-3 with 0.05, 5e-5 with 0.01).
bore, speed, density = 2e-3, 100.0, 1000.0
recipe = {
    "dimension": 2,
    "parts": [{"shape": "box", "block": "ring", "min": [bore, 0], "size": [4e-3, 4e-3], "divisions": [4, 4]}],
    "node_sets": {"bore": {"where": {"x": bore}}, "rim": {"where": {"x": 6e-3}}},
}
deck = {
    "geometry": "axisymmetric",
    "materials": {"soft": {"model": "neo_hookean", "density": density, "youngs_modulus": 1e6, "poisson_ratio": 0.3}},
    "blocks": {"ring": {"material": "soft"}},
    "contact": {"enabled": False},
    "initial": [{"block": "ring", "velocity": [-speed, 0, 0]}],
    "time": {"end": 3e-5, "step_factor": 0.05},
    "output": {"every": 1e-5},
    "history": {"every": 2e-7, "probes": [{"name": name, "node_set": name} for name in ("bore", "rim")]},
}
run = case.run("closing_ring", recipe, deck, energy=2e-3)
h = run.history
least = bore + numpy.min(h["bore_displacement_x"])
case.check_within("closing ring: least radius of its bore over the first", least / bore, -1e-9, 1e-3)
case.check_within("closing ring: work of the axis over the kinetic energy at the start", h["external_work"][-1] / h["kinetic"][0], -0.5, -0.01)
case.check("closing ring: radius of its bore at the end over the first", (bore + h["bore_displacement_x"][-1]) / bore, 0, 0.2)
case.same_bits("closing_ring", recipe, deck, run)

# Faces on the axis have no area: what acts on them does nothing, and a rod that flies along its axis goes on.
recipe["parts"][0].update(min=[0, 0], size=[4e-3, 8e-3])
recipe["node_sets"] = {}
recipe["side_sets"] = {"axis": {"where": {"x": 0}}}
deck["initial"][0]["velocity"] = [0, speed, 0]
deck["conditions"] = [{"type": "traction", "side_set": "axis", "value": [1e6, 1e6, 0]}, {"type": "absorbing", "side_set": "axis"}]
deck["history"]["probes"] = [{"name": "ring", "block": "ring"}]
run = case.run("loads_on_the_axis", recipe, deck)
case.check("loads on the axis: speed at the end over that at the start", run.history["ring_velocity_y"][-1] / speed, 1, 1e-12)
case.finish()
