"""What is the same seen in a mirror stays so: a quarter of a ball on a quarter of a tile, by four laws."""

import numpy
from coplanetest import Case, balls

case = Case("symmetry", __file__)

radius, size, thick = 0.02, 0.06, 0.02  # of the ball, half the width of the tile, its thickness [m]
cells, across, deep = 4, 12, 4

recipe = balls.on_tile(cells, across, deep, size, thick)


def mirrored(places):
    """For each place the index of the one with x and z exchanged."""
    index = {tuple(place): i for i, place in enumerate(places)}
    return numpy.array([index[(x, y, z)] for z, y, x in places])


def places_of(results, block):
    """Of the elements: the sum of the places of their corners, in an order that x and z share."""
    rows = results.connectivity(block)
    first = numpy.min([numpy.min(results.connectivity(name)) for name in ("ball", "tile")])
    corners = numpy.sort(results.coordinates[rows - first], axis=1)
    return numpy.sum(corners, axis=1)


steel = {"model": "j2", "density": 7850, "youngs_modulus": 200e9, "poisson_ratio": 0.3, "yield_stress": 800e6, "hardening_modulus": 1e9}
laws = {
    "j2": {"model": "j2", "density": 2700, "youngs_modulus": 70e9, "poisson_ratio": 0.3, "yield_stress": 300e6, "hardening_modulus": 1e8},
    "mohr_coulomb": {
        "model": "mohr_coulomb", "density": 2500, "youngs_modulus": 30e9, "poisson_ratio": 0.25, "cohesion": 10e6, "friction": 0.7,
        "dilation": 0.2, "tensile_strength": 4e6, "residual_cohesion": 1e6, "shear_energy": 1000, "fracture_energy": 100,
    },
    "hjc": {"set": "concrete_hjc_48"},
    "pseudo_cap": {"set": "concrete_c40"},
    "pseudo_cap with rates": {"set": "concrete_c40", "rate_effects": True},
}
for name, law in laws.items():
    deck = {
        "materials": {"steel": steel, "target": law},
        "blocks": {"ball": {"material": "steel"}, "tile": {"material": "target"}},
        "conditions": [
            {"type": "fixed", "node_set": "x", "components": ["x"]},
            {"type": "fixed", "node_set": "z", "components": ["z"]},
        ],
        "initial": [{"block": "ball", "velocity": [0, -200, 0]}],
        "time": {"end": 6e-5},
        "output": {"every": 1e-5},
        "history": {"every": 1e-6, "probes": [{"name": block, "block": block} for block in ("ball", "tile")]},
    }
    run = case.run(name.replace(" ", "_"), recipe, deck, change_mesh=balls.rounded(radius))
    h, results = run.history, run.results
    nodes = mirrored(results.coordinates)
    for block in ("ball", "tile"):
        x, z = (h[f"{block}_velocity_{axis}"] for axis in "xz")
        case.check(f"{name}: {block}, velocity along x less that along z, over the largest", numpy.max(numpy.abs(x - z)) / numpy.max(numpy.abs(x)), 0, 1e-9)
    moved = results.nodal("displacement")
    apart = numpy.max(numpy.abs(moved[nodes][:, ::-1] - moved)) / numpy.max(numpy.abs(moved))
    case.check(f"{name}: displacement less that of the mirrored node, over the largest", apart, 0, 1e-9)
    field = "damage" if name in ("hjc", "pseudo_cap", "pseudo_cap with rates") else "equivalent_plastic_strain"
    values = results.element("tile", field)
    elements = mirrored(places_of(results, "tile"))
    case.check_within(f"{name}: share of elements with {field}", numpy.mean(values > 1e-3), 0.05, 1)
    case.check(f"{name}: {field} less that of the mirrored element", numpy.max(numpy.abs(values[elements] - values)), 0, 1e-9)
case.finish()
