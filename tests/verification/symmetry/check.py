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


# --- half of a model, or a quarter, is the whole one: faces in a plane of symmetry are no surface -------------------------
elastic = {"model": "linear_elastic", "density": 7850, "youngs_modulus": 200e9, "poisson_ratio": 0.3}


def struck(dimension, cut, speed, friction=0.0, damping=0.0, forces="potential", turn=0.0, far=0.0):
    """A block strikes a slab in its middle, with a node of either where the planes of symmetry meet; `cut` along these axes, turned about the last one [rad], and moved along all axes [m]."""
    low = lambda half: [0 if c in cut else -half for c in range(dimension - 1)]
    cells = lambda n: [n // 2 if c in cut else n for c in range(dimension - 1)]
    recipe = {"dimension": dimension, "parts": [
        {"shape": "box", "block": "slab", "min": [*low(0.1), -0.03], "max": [0.1] * (dimension - 1) + [0], "divisions": [*cells(10), 3]},
        {"shape": "box", "block": "block", "min": [*low(0.023), 1e-5], "max": [0.023] * (dimension - 1) + [0.05], "divisions": [*cells(2), 2]}],
        "node_sets": {f"middle{c}": {"where": {"xyz"[c]: 0}} for c in cut}}  # fmt: skip
    c, s = numpy.cos(turn), numpy.sin(turn)
    normals = [[c, s, 0], [-s, c, 0]]
    deck = {
        "materials": {"steel": elastic}, "blocks": {"slab": {"material": "steel"}, "block": {"material": "steel"}},
        "joints": {"touch": {"model": "penalty", "friction": friction}}, "contact": {"default_joint": "touch", "forces": forces, "damping": {"normal": damping, "shear": damping}},
        "conditions": [{"type": "symmetry", "node_set": f"middle{i}", "normal": [float(x) for x in normals[i]]} for i in cut],
        "initial": [{"block": "block", "velocity": [0] * (dimension - 1) + [-speed] + [0] * (3 - dimension)}],
        "time": {"end": 4e-5, "fixed_step": 2e-7}, "output": {"every": 1e-5, "planes": False}, "history": {"every": 1e-6},
    }  # fmt: skip
    about = lambda x: x @ numpy.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + far
    return {"recipe": recipe, "deck": deck, "change_mesh": about if turn or far else None}


def apart(whole, part, blocks, turn=0.0):
    """Largest difference of velocities of nodes at the same place, over the largest velocity, at all results."""
    largest = 0
    key = lambda x: tuple(numpy.round(x * 1e7).astype(int))
    for block in blocks:
        nodes, own = (numpy.unique(run.results.connectivity(block)) for run in (whole, part))
        place = {key(x): n for n, x in zip(nodes, whole.results.coordinates[nodes])}
        same = [place[key(x)] for x in part.results.coordinates[own]]
        for step in range(1, len(whole.results.times)):
            v, its = whole.results.nodal("velocity", step), part.results.nodal("velocity", step)
            largest = max(largest, numpy.abs(v[same] - its[own]).max() / numpy.abs(v).max())
    return largest


for name, dimension, cuts, options, bound in (
    ("flat", 2, ([0],), {"speed": 300}, 1e-4),
    ("slow", 3, ([1], [0, 1]), {"speed": 30}, 1e-6),
    ("damped", 3, ([1], [0, 1]), {"speed": 30, "friction": 0.5, "damping": 0.3}, 1e-6),
    ("damped_flat", 2, ([0],), {"speed": 30, "damping": 0.3}, 1e-6),
    ("damped_common_normal", 3, ([1],), {"speed": 30, "damping": 0.3, "forces": "common_normal"}, 1e-6),
    ("fast", 3, ([1], [0, 1]), {"speed": 300, "friction": 0.5}, 3e-4),
    ("turned", 3, ([0, 1],), {"speed": 300, "turn": 0.3, "far": 1000.0}, 3e-4),
    ("common_normal", 3, ([1],), {"speed": 300, "forces": "common_normal"}, 3e-4),
):
    whole = case.run(f"{name}_whole", **struck(dimension, [], **options))
    for cut in cuts:
        part = case.run(f"{name}_cut_{len(cut)}", **struck(dimension, cut, **options))
        what = f"{name}: 1/{2**len(cut)} of the model, velocities less those of all of it, over the largest"
        case.check(what, apart(whole, part, ("slab", "block")), 0, bound)
    if name == "fast":
        problem = struck(dimension, cut, **options)
        case.same_bits("fast", **problem, run=part, ranks=3)
        case.same_bits("fast_threads", **problem, run=part, ranks=1, threads=2)
        case.restarts("fast", problem["recipe"], problem["deck"], part, near=1e-5)
        case.check_equal("fast: planes of symmetry that the log tells of", "beyond 2 planes of symmetry" in part.output, True)
        problem["deck"]["conditions"][0]["until"] = 1
        case.check_equal("one that ends: told by the log", "as it acts in a part of the run" in case.run("ends", **problem).output, True)

# A ball: its faces lean across the planes of symmetry, and beside these some would meet the images of others. What they lack falls with the mesh.
for cells, bound in ((2, 0.03), (4, 6e-4)):
    speed, runs = 30, {}
    for name, cut in (("whole", []), ("quarter", [0, 2])):
        low = [0 if c in cut else -1 for c in (0, 2)]
        n = lambda k: [k if c in cut else 2 * k for c in (0, 2)]
        (a, b), (across, along), (p, q) = low, n(cells), n(2 * cells)
        recipe = {"dimension": 3, "parts": [
            {"shape": "box", "block": "ball", "min": [a, 99, b], "max": [1, 101, 1], "divisions": [across, 2 * cells, along]},
            {"shape": "box", "block": "tile", "min": [a * size, -thick, b * size], "max": [size, 0, size], "divisions": [p, cells, q]}],
            "node_sets": {f"middle{c}": {"where": {"xyz"[c]: 0}} for c in cut}}  # fmt: skip
        deck = struck(3, [], speed)["deck"]
        deck["blocks"] = {"ball": {"material": "steel"}, "tile": {"material": "steel"}}
        deck["conditions"] = [{"type": "symmetry", "node_set": f"middle{c}", "normal": [float(c == i) for i in range(3)]} for c in cut]
        deck["initial"] = [{"block": "ball", "velocity": [0, -speed, 0]}]
        deck["time"], deck["history"] = {"end": 8e-5, "maximum_step": 1.5e-7}, {"every": 1e-6, "probes": [{"name": "ball", "block": "ball"}]}
        run = case.run(f"ball_{cells}_{name}", recipe, deck, change_mesh=balls.rounded(radius))
        runs[name] = run.history["ball_velocity_y"]
        if (cells, name) == (2, "quarter"):
            case.same_bits(f"ball_{cells}_{name}", recipe, deck, run, ranks=3, change_mesh=balls.rounded(radius))
    gone = numpy.abs(runs["quarter"] - runs["whole"]).max() / speed
    case.check(f"quarter of a ball, {cells} elements to its radius: speed less that of the whole, largest, over that at the start", gone, 0, bound)
case.finish()
