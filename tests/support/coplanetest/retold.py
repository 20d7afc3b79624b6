"""The same problem told in other words: other numbers of nodes and blocks, other frames, other units.

A `Problem` is a recipe, a deck and what is done to the mesh file. Functions take one and return another; `seen` of the new one takes what
its run measured back to the words of the original: vectors through a matrix, a velocity, an offset, and units.
"""

import copy
import dataclasses
import typing

import netCDF4
import numpy

from .frames import turned_deck


@dataclasses.dataclass
class Problem:
    recipe: dict
    deck: dict
    edit: tuple = ()  # functions of the path of the mesh, one after the other
    matrix: numpy.ndarray = dataclasses.field(default_factory=lambda: numpy.eye(3))
    drift: tuple = (0.0, 0.0, 0.0)
    length: float = 1.0
    time: float = 1.0
    mass: float = 1.0
    order: typing.Optional[numpy.ndarray] = None  # node of this mesh for each node of the original

    def copy(self, **changes):
        return dataclasses.replace(self, **{"recipe": copy.deepcopy(self.recipe), "deck": copy.deepcopy(self.deck), **changes})

    def edit_mesh(self, path):
        for change in self.edit:
            change(path)

    def seen_vectors(self, vectors, times, power_of_time):
        """Displacements (power 0) or velocities (1) of the run (.., axis) at times (..) of the run, in the words of the original."""
        vectors = numpy.asarray(vectors, float)
        d = vectors.shape[-1]
        drift = numpy.array(self.drift[:d])
        common = drift if power_of_time else drift * numpy.expand_dims(numpy.asarray(times), -1)
        return (vectors - common) @ self.matrix[:d, :d] / self.length * self.time**power_of_time


# --- the mesh file ---------------------------------------------------------------------------------------------------------------------


def _coordinates(file):
    return [file[f"coord{axis}"] for axis in "xyz" if f"coord{axis}" in file.variables]


def moved_mesh(matrix, offset=(0, 0, 0), factor=1.0):
    """x -> factor (matrix x) + offset; a mirror also turns the order of the nodes of every element."""

    def edit(path):
        with netCDF4.Dataset(path, "a") as file:
            file.set_auto_mask(False)
            axes = _coordinates(file)
            d = len(axes)
            points = numpy.stack([axis[:] for axis in axes], axis=1)
            if not numpy.array_equal(matrix, numpy.eye(3)):
                points = points @ matrix[:d, :d].T
            points = points * factor + numpy.array(offset[:d], float)
            for axis, values in zip(axes, points.T):
                axis[:] = values
            if numpy.linalg.det(matrix) < 0:
                other = {3: [1, 0, 2], 8: [1, 0, 3, 2, 5, 4, 7, 6]}
                for name in [name for name in file.variables if name.startswith("connect")]:
                    nodes = file[name][:]
                    order = [1, 0, 3, 2] if nodes.shape[1] == 4 and d == 2 else other.get(nodes.shape[1], [1, 0, 2, 3])
                    file[name][:] = nodes[:, order]

    return edit


def shuffled_nodes(number, seed=1):
    """The node that gets the data of the i-th node of the original."""
    return numpy.random.default_rng(seed).permutation(number)


def shuffled_mesh(seed=1):
    """Nodes, and elements within their blocks, in random order. Meshes with node sets, without side sets."""

    def edit(path):
        with netCDF4.Dataset(path, "a") as file:
            file.set_auto_mask(False)
            assert not [name for name in file.variables if name.startswith("elem_ss")], "side sets are not renumbered"
            axes = _coordinates(file)
            new = shuffled_nodes(len(axes[0]), seed)
            for axis in axes:
                values = numpy.empty(len(new))
                values[new] = axis[:]
                axis[:] = values
            random = numpy.random.default_rng(seed + 1)
            for name in [name for name in file.variables if name.startswith("connect")]:
                nodes = new[file[name][:] - 1] + 1
                file[name][:] = nodes[random.permutation(len(nodes))]
            for name in [name for name in file.variables if name.startswith("node_ns")]:
                file[name][:] = numpy.sort(new[file[name][:] - 1] + 1)

    return edit


# --- other words -----------------------------------------------------------------------------------------------------------------------


def renumbered(problem, nodes):
    """Nodes and elements shuffled."""
    return problem.copy(edit=(*problem.edit, shuffled_mesh()), order=shuffled_nodes(nodes))


def reordered(problem, parts):
    """Blocks in another order: `parts` are positions in the recipe. Nodes are numbered by part."""
    told = problem.copy()
    told.recipe["parts"] = [told.recipe["parts"][i] for i in parts]
    return told


def in_frame(problem, matrix=None, offset=(0, 0, 0), velocity=(0, 0, 0)):
    """Turned (or mirrored) about the origin by the matrix, then moved, with a common velocity."""
    matrix = numpy.eye(3) if matrix is None else matrix
    deck = turned_deck(problem.deck, matrix, offset, velocity)
    return problem.copy(deck=deck, edit=(*problem.edit, moved_mesh(matrix, offset)), matrix=matrix, drift=tuple(velocity))


# Powers of length, time and mass in the keys of decks; every number must be known here.
_UNITS = {
    "density": (-3, 0, 1), "youngs_modulus": (-1, -2, 1), "normal_stiffness": (-2, -2, 1), "velocity": (1, -1, 0),
    "angular_velocity": (0, -1, 0), "center": (1, 0, 0), "gravity": (1, -2, 0), "end": (0, 1, 0), "fixed_step": (0, 1, 0),
    "maximum_step": (0, 1, 0), "every": (0, 1, 0), "stress": (-1, -2, 1), "stress_gradient": (-2, -2, 1), "stress_point": (1, 0, 0),
    "mass": (0, -1, 0), "until": (0, 1, 0),
}
_PURE = {"poisson_ratio", "friction", "normal", "shear", "linear", "quadratic", "stiffness", "stress_axis", "step_factor", "shear_ratio"}


def _rescaled(value, key, factors):
    if isinstance(value, dict):
        return {name: _rescaled(item, name, factors) for name, item in value.items()}
    if isinstance(value, list):
        return [_rescaled(item, key, factors) for item in value]
    if isinstance(value, bool) or not isinstance(value, (int, float)) or key in _PURE:
        return value
    powers = _UNITS[key]
    factor = 1.0
    for base, power in zip(factors, powers):
        factor *= base**power
    return value * factor


def in_units(problem, length, time, mass):
    """Numbers of the deck and the mesh in other units: `length` is what 1 m is called, and so on."""
    deck = _rescaled(problem.deck, None, (length, time, mass))
    edit = (*problem.edit, moved_mesh(numpy.eye(3), factor=length))
    return problem.copy(deck=deck, edit=edit, length=length, time=time, mass=mass)


def without_fixed_step(problem):
    """The step follows the mesh."""
    told = problem.copy()
    del told.deck["time"]["fixed_step"]
    return told
