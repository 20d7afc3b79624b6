"""The same problem told in other words: other numbers of nodes and blocks, other frames, other units.

A `Problem` is a recipe, a deck and what is done to the mesh file. Functions take one and return another; `seen` of the new one takes what
its run measured back to the words of the original: vectors through a matrix, a velocity, an offset, and units.
"""

import copy
import dataclasses
import typing

import numpy

from . import meshes
from .frames import turned_deck
from .units import deck_in


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


def _edit(change):
    """A function of the path of a mesh file, of one that takes and returns a Mesh."""

    def edit(path):
        meshes.write(change(meshes.read(path)), path)

    return edit


# --- other words -----------------------------------------------------------------------------------------------------------------------


def renumbered(problem, nodes):
    """Nodes, elements, blocks and sets shuffled."""
    return problem.copy(edit=(*problem.edit, _edit(meshes.renumbered)), order=meshes.shuffled(nodes))


def reordered(problem, parts):
    """Blocks in another order: `parts` are positions in the recipe. Nodes are numbered by part."""
    told = problem.copy()
    told.recipe["parts"] = [told.recipe["parts"][i] for i in parts]
    return told


def in_frame(problem, matrix=None, offset=(0, 0, 0), velocity=(0, 0, 0)):
    """Turned (or mirrored) about the origin by the matrix, then moved, with a common velocity."""
    matrix = numpy.eye(3) if matrix is None else matrix
    deck = turned_deck(problem.deck, matrix, offset, velocity)
    return problem.copy(deck=deck, edit=(*problem.edit, _edit(lambda mesh: meshes.moved(mesh, matrix, offset))), matrix=matrix, drift=tuple(velocity))


def in_units(problem, length, time, mass):
    """Numbers of the deck and the mesh in other units: `length` is what 1 m is called, and so on."""
    deck = deck_in(problem.deck, (length, time, mass))
    edit = (*problem.edit, _edit(lambda mesh: meshes.moved(mesh, numpy.eye(3), factor=length)))
    return problem.copy(deck=deck, edit=edit, length=length, time=time, mass=mass)


def without_fixed_step(problem):
    """The step follows the mesh."""
    told = problem.copy()
    del told.deck["time"]["fixed_step"]
    return told
