"""Forms of elements of bodies of revolution: Lame's cylinder up to incompressibility, and a plate in bending."""

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
case.finish()
