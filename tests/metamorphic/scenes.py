"""The contact cases that are told in other words. Each is a `Scene`: recipe and deck, the blocks that move, and the part that can be cut."""

import copy
import dataclasses

import numpy
from coplanetest import rotation
from coplanetest.retold import Problem

DENSITY, G = 2000.0, 9.81


@dataclasses.dataclass
class Scene:
    recipe: dict
    deck: dict
    movers: list  # blocks whose motion is compared
    slab: int  # position of the part that is cut into flush parts
    rider: int  # position of the part that is meshed finer or split
    along: int = 0  # axis along which the slab is cut
    scale: tuple = None  # length and speed against which differences count; none: the largest of the original
    frequency: float = 0.0  # of the bounce on the joint [rad/s]: a step of the slab makes a speed of the step times it
    mesh: float = 1e-2  # bound of what another mesh may change
    finer: float = 1e-2  # the same of a rider that is meshed twice as fine
    thorough: bool = False  # told in every way also without `all`

    @property
    def dimension(self):
        return self.recipe["dimension"]

    def problem(self):
        return Problem(copy.deepcopy(self.recipe), copy.deepcopy(self.deck))


def inertia(n):
    """By how much n elements in a row, with masses at the nodes, have more moment of inertia than 2 n: 1 + 2 / n^2 over 1 + 1 / (2 n^2), less 1."""
    return (1 + 2 / n**2) / (1 + 1 / (2 * n**2)) - 1


def box(block, low, size, divisions, **other):
    return {"shape": "box", "block": block, "min": low, "size": size, "divisions": divisions, **other}


def deck_of(title, modulus, stiffness, end, step, blocks, friction=0.0, damping=0.0, poisson=0.2, fixed="slab", gravity=True, **other):
    deck = {
        "title": title,
        "materials": {"soft": {"model": "linear_elastic", "density": DENSITY, "youngs_modulus": modulus, "poisson_ratio": poisson}},
        "blocks": {block: {"material": "soft"} for block in blocks},
        "joints": {"law": {"model": "linear", "normal_stiffness": stiffness, "friction": friction}},
        "contact": {"default_joint": "law", "damping": {"normal": damping}},
        # Halves of steps: no line of the history hangs on the last bit of the time.
        "time": {"end": (round(end / step) - 0.5) * step, "fixed_step": step},
        "output": {"planes": False},
        "history": {"every": (round(end / step) // 100 + 0.5) * step, "probes": [{"name": block, "block": block} for block in blocks if block != "slab"]},
        **other,
    }
    if fixed:
        deck["conditions"] = [{"type": "fixed", "node_set": fixed}]
    if gravity:
        deck["gravity"] = [0.0, -G, 0.0]
    return deck


def slide(dimension, friction):
    """A block slides on a fixed slab, 2 m/s, over half its length and more."""
    if dimension == 2:
        parts = [box("slab", [0.0, -0.1], [2.1, 0.1], [42, 1]), box("rider", [0.1, 0.0], [0.4, 0.1], [5, 2])]
        velocity, end = [2.0, 0.0, 0.0], 0.5
    else:
        parts = [
            box("slab", [0.0, -0.1, -0.15], [1.05, 0.1, 0.6], [14, 1, 5]), box("rider", [0.1, 0.0, 0.0], [0.3, 0.1, 0.2], [4, 2, 3]),
        ]
        velocity, end = [2.0, 0.0, 0.3], 0.25
    recipe = {"dimension": dimension, "parts": parts, "node_sets": {"slab": {"block": "slab"}}}
    deck = deck_of("a block slides on a slab", 1e8, 1e7, end, 8e-5, ["slab", "rider"], friction, damping=0.5,
                   initial=[{"block": "rider", "velocity": velocity}])
    return Scene(recipe, deck, ["rider"], 0, 1, frequency=(1e7 / (DENSITY * 0.1)) ** 0.5, thorough=dimension == 2 and friction > 0)


def corner(dimension, friction, end=0.03, spin=3.0, height=0.005):
    """A tilted block, turning, is thrown with a corner on a slab, where the slab is cut in two."""
    angles = [0, 0, 30] if dimension == 2 else [20, 0, 30]
    lowest = 0.1 * numpy.abs(rotation(angles)[1][:dimension]).sum()
    center = [0.0, height + float(lowest), 0.0]
    omega = [0.0, 0.0, spin] if dimension == 2 else [2.0, -1.0, spin]
    rider = box("rider", [-0.1] * dimension, [0.2] * dimension, [4, 4] if dimension == 2 else [3, 3, 3],
                rotate=30 if dimension == 2 else angles, about=[0.0] * dimension, offset=center[:dimension])
    slab = box("slab", [-0.7, -0.1], [1.4, 0.1], [14, 1]) if dimension == 2 else box("slab", [-0.7, -0.1, -0.5], [1.4, 0.1, 1.0], [14, 1, 7])
    parts = [slab, rider]
    recipe = {"dimension": dimension, "parts": parts, "node_sets": {"slab": {"block": "slab"}}}
    velocity = [1.0, -2.0, 0.0] if dimension == 2 else [1.0, -2.0, 0.4]
    deck = deck_of("a corner is thrown on a slab", 4e9, 5e8, end, 1.2e-5, ["slab", "rider"], friction,
                   initial=[{"block": "rider", "velocity": velocity, "angular_velocity": omega, "center": center}])
    # Friction at a corner acts at one point of each face, so that it depends on the faces; a slab of triangles has other ones.
    return Scene(recipe, deck, ["rider"], 0, 1, mesh=5e-2 if friction else 1e-2, finer=inertia(4 if dimension == 2 else 3),
                 thorough=dimension == 3 and friction > 0)


def stack(dimension, rest):
    """Three blocks on a slab, under their weight: at rest from the start, with declared joints and stresses in equilibrium; or the weight
    begins to act on joints that are met, and damping leads to rest.
    """
    names = ["one", "two", "three"]
    if dimension == 2:
        parts = [box("slab", [-0.7, -0.1], [1.4, 0.1], [14, 1])]
        parts += [box(name, [-0.2, 0.2 * i], [0.4, 0.2], [4, 2]) for i, name in enumerate(names)]
    else:
        parts = [box("slab", [-0.7, -0.1, -0.3], [1.4, 0.1, 0.6], [14, 1, 6])]
        parts += [box(name, [-0.2, 0.2 * i, -0.1], [0.4, 0.2, 0.2], [4, 2, 2]) for i, name in enumerate(names)]
    recipe = {"dimension": dimension, "parts": parts, "node_sets": {"slab": {"block": "slab"}}}
    deck = deck_of("a stack of blocks", 1e8, 1e9, 0.06, 1e-4, ["slab", *names], 0.5, poisson=0.0)
    if rest:
        deck["contact"]["pairs"] = [{"blocks": ["*", "*"], "declared": True}]
        deck["initial"] = [{"block": name, "stress": [0.0] * 6, "stress_gradient": [0.0, DENSITY * G, 0.0, 0.0, 0.0, 0.0],
                            "stress_axis": [0.0, 1.0, 0.0], "stress_point": [0.0, 0.6, 0.0]} for name in ("slab", *names)]
    else:
        deck["damping"] = {"mass": 500.0}
    closure = 3 * 0.2 * DENSITY * G / 1e9  # of the lowest joint, and the speed of a fall from that height
    # The mean displacement of nodes with masses is that of the body to rho g h^2 / (6 E) in elements of height h.
    # At rest: the traction of a declared joint is the mean of the stresses in both elements, whose middles are off by h / 8 together where one
    # is half as high; what is not in equilibrium swings out twice as far.
    mesh = 2 * (0.1 / 8) / 0.6 if rest else DENSITY * G * 0.1**2 / (6 * 1e8) / closure
    return Scene(recipe, deck, names, 0, 2, scale=(closure, (2 * G * closure) ** 0.5), mesh=mesh, finer=mesh, thorough=dimension == 2 and not rest)


def bars(dimension):
    """Two equal bars meet: each takes over the velocity of the other."""
    if dimension == 2:
        parts = [box("left", [-1.0, -0.05], [1.0, 0.1], [20, 2]), box("right", [0.0, -0.05], [1.0, 0.1], [20, 2])]
    else:
        parts = [
            box("left", [-1.0, -0.05, -0.05], [1.0, 0.1, 0.1], [20, 2, 2]), box("right", [0.0, -0.05, -0.05], [1.0, 0.1, 0.1], [20, 2, 2]),
        ]
    recipe = {"dimension": dimension, "parts": parts}
    deck = deck_of("two bars meet", 1e9, 2e10, 5e-3, 1e-5, ["left", "right"], poisson=0.0, fixed=None, gravity=False,
                   initial=[{"block": "left", "velocity": [1.0, 0.0, 0.0]}, {"block": "right", "velocity": [-1.0, 0.0, 0.0]}])
    # Bulk viscosity and the front, which is some elements long, take a share of the motion that halves with the elements.
    return Scene(recipe, deck, ["left", "right"], 0, 1, along=1, mesh=2e-2, finer=2e-2, thorough=dimension == 3)


def spin(dimension, friction, gap=1e-6):
    """A plate turns about the vertical on a slab, over the middle, falling from a hair above it; in 2D a block tumbles over
    it and hits it with several corners.
    """
    if dimension == 2:
        scene = corner(2, friction, end=0.12, spin=-15.0, height=0.02)
        scene.deck["title"] = "a block tumbles over slabs"
        scene.finer *= 2  # two hits
        return scene
    parts = [
        box("slab", [-0.42, -0.1, -0.35], [0.84, 0.1, 0.7], [14, 1, 7]), box("rider", [-0.13, gap, -0.1], [0.3, 0.1, 0.2], [4, 2, 3]),
    ]
    recipe = {"dimension": 3, "parts": parts, "node_sets": {"slab": {"block": "slab"}}}
    deck = deck_of("a plate turns over slabs", 1e8, 1e7, 0.2, 8e-5, ["slab", "rider"], friction, damping=0.5,
                   initial=[{"block": "rider", "velocity": [0.3, 0.0, 0.1], "angular_velocity": [0.0, 10.0, 0.0], "center": [0.02, 0.05, 0.0]}])
    return Scene(recipe, deck, ["rider"], 0, 1, frequency=(1e7 / (DENSITY * 0.1)) ** 0.5, finer=inertia(2))


SCENES = {
    "slide_2d": lambda: slide(2, 0.0),
    "slide_2d_rough": lambda: slide(2, 0.3),
    "slide_3d": lambda: slide(3, 0.0),
    "slide_3d_rough": lambda: slide(3, 0.3),
    "corner_2d": lambda: corner(2, 0.0),
    "corner_2d_rough": lambda: corner(2, 0.5),
    "corner_3d": lambda: corner(3, 0.0),
    "corner_3d_rough": lambda: corner(3, 0.5),
    "rest_2d": lambda: stack(2, True),
    "rest_3d": lambda: stack(3, True),
    "settle_2d": lambda: stack(2, False),
    "settle_3d": lambda: stack(3, False),
    "bars_2d": lambda: bars(2),
    "bars_3d": lambda: bars(3),
    "tumble_2d": lambda: spin(2, 0.3),
    "spin_3d": lambda: spin(3, 0.0),
    "spin_3d_rough": lambda: spin(3, 0.3),
}
