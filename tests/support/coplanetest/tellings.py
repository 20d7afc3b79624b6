"""Any run of a check told in other words, with its answers taken back to the words of the check.

With COPLANE_TOLD_AS in the environment, Case.attempt tells the mesh and the deck of every run in those words, and what the check reads of it
(history, fields on nodes and elements, planes) is in the words that it knows. Besides, every run leaves `seen.npz` with the motion that was seen,
and `told.json`, which says whether it was told: tests/metamorphic/retell.py compares the two. Conservation is asked of the run as it is.
"""

import copy
import dataclasses
import json
import os
import pathlib
import re
import shutil

import numpy
from coplane import tables
from coplane.exodus import Results, Series, files_of

from coplanetools import EndedRun

from . import meshes
from .frames import rotation, turned_deck
from .meshes import CannotTell
from .units import deck_in, factor_of

# Fields and columns: units of what a name says no more about, for runs in other units.
_UNITS = {"displacement": "m", "velocity": "m/s", "contact_force": "N", "contact_traction": "Pa", "contact_pressure": "Pa", "contact_closure": "m",
          "contact_gap": "m", "contact_slip": "m", "stress": "Pa", "von_mises": "Pa", "pressure": "Pa", "density": "kg/m^3",
          "side_normal_traction": "Pa", "side_shear_traction": "Pa", "side_closure": "m", "side_gap": "m", "side_slip": "m", "time_step": "s"}  # fmt: skip
_PLANES = {"Points": "m", "normal": "-", "force": "N", "shear_traction": "Pa", "normal_traction": "Pa", "area": "m^2", "overlap": "m^2", "closure": "m",
           "maximum_closure": "m", "gap": "m", "offset": "m", "slip": "m", "opening": "m", "shearing": "m", "work": "J", "stored": "J", "friction": "J",
           "hysteresis": "J", "fracture": "J", "damping": "J", "remainder": "J"}  # fmt: skip
_SPINS = ("spin", "angular_momentum", "angular_impulse", "angular_momentum_error", "reaction_moment")
# Nodal fields of which nodes that are there several times have each a share.
_SHARED = ("contact_force",)


@dataclasses.dataclass
class Told:
    """A problem in other words, and the way back."""

    mesh: meshes.Mesh
    deck: dict
    matrix: numpy.ndarray = dataclasses.field(default_factory=lambda: numpy.eye(3))
    offset: tuple = (0.0, 0.0, 0.0)
    drift: tuple = (0.0, 0.0, 0.0)
    units: tuple = (1.0, 1.0, 1.0)  # what 1 m, 1 s and 1 kg are called
    restarted: bool = False
    depth: float = 0.0  # of a slice, at whose middle planes lie

    def factor(self, unit):
        """Of a quantity with this unit. Forces, masses and energies of a plane problem are those of a depth of one unit of length."""
        factor = factor_of(unit, self.units)
        flat = self.mesh.dimension == 2 and self.deck.get("geometry") != "axisymmetric"
        return factor / self.units[0] if flat and unit in ("J", "N", "kg", "N*s", "N*m", "N*m*s", "m^2") else factor


# --- the words ---------------------------------------------------------------------------------------------------------------------------


def _frame(mesh, deck, matrix=None, offset=(0.0, 0.0, 0.0), drift=(0.0, 0.0, 0.0)):
    matrix = numpy.eye(3) if matrix is None else matrix
    return Told(meshes.moved(mesh, matrix, offset), turned_deck(deck, matrix, offset, drift), matrix, offset, drift)


def _level(mesh, vector):
    """A vector of a plane problem lies in the plane."""
    return tuple(vector) if mesh.dimension == 3 else (*vector[:2], 0.0)


def turned(mesh, deck):
    """By odd angles about the origin."""
    return _frame(mesh, deck, rotation(17.3 if mesh.dimension == 2 else [17.3, -31.7, 23.9]))


def quarter(mesh, deck):
    """Axes change places: (x, y) to (-y, x); in space (x, y, z) to (y, z, x) as well."""
    turn = numpy.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    return _frame(mesh, deck, turn if mesh.dimension == 2 else turn @ numpy.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]))


def mirrored(mesh, deck):
    return _frame(mesh, deck, numpy.diag([-1.0, 1.0, 1.0]))


def moved(mesh, deck):
    """By 1 km along each axis."""
    return _frame(mesh, deck, offset=_level(mesh, (1000.0, -1000.0, 1000.0)))


def drifting(mesh, deck):
    """Seen from 100 m/s."""
    return _frame(mesh, deck, drift=_level(mesh, (100.0, -100.0, 100.0)))


def renumbered(mesh, deck):
    """Nodes, elements, blocks and sets of the mesh, and blocks and joints of the deck, in other orders."""
    deck = copy.deepcopy(deck)
    for group in ("materials", "blocks", "joints"):
        if group in deck:
            deck[group] = dict(reversed(deck[group].items()))
    if "initial" in deck:
        deck["initial"] = deck["initial"][::-1]
    return Told(meshes.renumbered(mesh), deck)


def in_units(mesh, deck, factors):
    return Told(meshes.moved(mesh, numpy.eye(3), factor=factors[0]), deck_in(deck, factors), units=factors)


def powers_of_two(mesh, deck):
    return in_units(mesh, deck, (2.0**10, 2.0**7, 2.0**5))


def millimetres(mesh, deck):
    """mm, ms and g."""
    return in_units(mesh, deck, (1e3, 1e3, 1e3))


def restarted(mesh, deck):
    """Stopped at half of the time, and gone on with from the checkpoint."""
    return Told(mesh.as_it_is(), copy.deepcopy(deck), restarted=True)


def _shorter(deck, factor):
    """Steps for smaller elements."""
    deck = copy.deepcopy(deck)
    for key in ("fixed_step", "maximum_step"):
        if key in deck["time"]:
            deck["time"][key] *= factor
    return deck


def split(mesh, deck):
    """Triangles and tetrahedra for quadrilaterals and hexahedra."""
    deck = _shorter(deck, 0.25)
    for block in deck["blocks"].values():
        block.pop("element", None)
    return Told(meshes.split(mesh), deck)


def sliced(mesh, deck):
    """A layer of hexahedra, 1 m thick, between planes of symmetry."""
    if deck.get("geometry") == "axisymmetric":
        raise CannotTell("a body of revolution is no slice")
    if any(card.get("rigid") for card in deck["blocks"].values()):
        raise CannotTell("a plane of symmetry holds all nodes of a rigid body or none")
    deck = copy.deepcopy(deck)
    deck.setdefault("conditions", []).extend({"type": "symmetry", "node_set": name, "normal": [0, 0, 1]} for name in ("told_back", "told_front"))
    for condition in deck["conditions"]:
        if condition["type"] in ("fixed", "velocity", "displacement") and "components" not in condition:
            condition["components"] = ["x", "y"]
    return Told(meshes.extruded(mesh), deck, depth=1.0)


def cut(mesh, deck, block, axis, parts=2):
    """A block in flush parts across an axis."""
    return Told(meshes.cut(mesh, block, axis, parts), copy.deepcopy(deck))


def refined(mesh, deck, block):
    """The faces of one block half as large."""
    return Told(meshes.refined(mesh, block), _shorter(deck, 0.5))


def declared(mesh, deck):
    """All joints declared, that are met; none, where they are."""
    deck = copy.deepcopy(deck)
    pairs = deck.setdefault("contact", {}).get("pairs", [])
    if any(pair.get("declared") for pair in pairs):
        if any("stress" in item for item in deck.get("initial", [])):
            raise CannotTell("a joint that is met bears no initial stress")
        for pair in pairs:
            pair["declared"] = False
    else:
        deck["contact"]["pairs"] = [{**pair, "declared": True} for pair in pairs] + [{"blocks": ["*", "*"], "declared": True}]
    return Told(mesh.as_it_is(), deck)


WORDS = {f.__name__: f for f in (turned, quarter, mirrored, moved, drifting, renumbered, powers_of_two, millimetres, restarted, split, sliced, declared)}
WITH = {f.__name__: f for f in (cut, refined)}


def as_it_is(mesh, deck):
    return Told(mesh.as_it_is(), copy.deepcopy(deck))


def wanted():
    """The function (mesh, deck) that COPLANE_TOLD_AS names; None without it. `cut:slab:0:7` and `refined:slab` name a block as well."""
    name = os.environ.get("COPLANE_TOLD_AS")
    if not name:
        return None
    if name == "as_it_is":
        return as_it_is
    word, *rest = name.split(":")
    if word in WORDS and not rest:
        return WORDS[word]
    arguments = [int(text) if text.isdigit() else text for text in rest]
    return lambda mesh, deck: WITH[word](mesh, deck, *arguments)


# --- the way back ------------------------------------------------------------------------------------------------------------------------


def retold(folder, deck):
    """Tells the problem of a folder with `mesh.e` and this deck as the environment wants it: None, or Told, whose mesh is then in its place and
    that of the check in `original.e`.
    """
    word = wanted()
    if word is None or not (folder / "mesh.e").exists():
        return None
    try:
        told = word(meshes.read(folder / "mesh.e"), deck)
    except (CannotTell, KeyError, StopIteration) as why:
        (folder / "told.json").write_text(json.dumps({"told": False, "why": str(why)}))
        if isinstance(why, KeyError) and "units" not in str(why) and not isinstance(why, CannotTell):
            raise
        told = as_it_is(meshes.read(folder / "mesh.e"), deck)
    else:
        (folder / "told.json").write_text(json.dumps({"told": True}))
    shutil.move(folder / "mesh.e", folder / "original.e")
    meshes.write(told.mesh, folder / "mesh.e")
    return told


class ToldRun(EndedRun):
    """A run that was told in other words, seen by its check; `raw` is the run as it is, `deck` its deck."""

    def __init__(self, folder, code, output, told):
        known = output
        for before, unit in (("mass", "kg"), (r"\bt =", "s")):
            known = re.sub(rf"({before}) (\S+) {unit}\b", lambda found, unit=unit: f"{found.group(1)} {float(found.group(2)) / told.factor(unit)!r} {unit}", known)
        super().__init__(folder, code, known)
        self.told, self.raw, self.deck = told, EndedRun(folder, code, output), told.deck

    @property
    def history(self):
        if self._history is None:
            self._history = _history(self.path("run.csv"), self.told, self.raw.mass)
        return self._history

    @property
    def results(self):
        if self._results is None:
            self._results = ToldResults(self.path("original.e"), self.path("run.e"), self.told)
        return self._results

    @property
    def series(self):
        return ToldPlanes(self.raw.series, self.told, self.results)

    def keep(self):
        """Leaves what moved in seen.npz."""
        kept = {}
        path = pathlib.Path(self.path("run.csv"))
        if path.exists():
            kept.update({name: values for name, values in self.history.items() if name == "time" or _stem(name)[0].endswith(("displacement", "velocity"))
                         or name in ("kinetic", "internal", "contact_stored", "contact_friction")})  # fmt: skip
        if pathlib.Path(self.path("run.e")).exists():
            for name in ("displacement", "velocity"):
                kept[f"nodes {name}"] = self.results.nodal(name)
            kept["nodes time"] = self.results.times[-1:]
            # How far from the origin of the run its nodes come: positions are known to 2^-53 of that.
            ran = self.results.ran
            kept["reach"] = numpy.max(numpy.abs(ran.coordinates) + numpy.abs(ran.nodal("displacement"))) / self.told.units[0]
        numpy.savez(self.path("seen.npz"), **kept)


def _stem(name):
    return (name[:-2], name[-1]) if name[-2:] in ("_x", "_y", "_z") else (name, "")


def _back(vectors, told, kind, unit, times):
    """Vectors (.., 3) of the run, in the words of the check."""
    found = numpy.array(vectors, float)
    drift = numpy.array(told.drift)
    if any(told.drift):
        if kind == "velocity":
            found = found - drift
        elif kind == "displacement":
            found = found - drift * numpy.expand_dims(times, -1)
    if not numpy.array_equal(told.matrix, numpy.eye(3)):
        found = found @ told.matrix
        if kind in _SPINS:
            found = found * round(numpy.linalg.det(told.matrix))
    return found / told.factor(unit)


def _history(path, told, mass):
    header, rows = tables.rows(path)
    raw = {tables.split(text): numpy.array([row[i] for row in rows]) for i, text in enumerate(header)}
    columns = {name: numpy.array(values, float) for (name, _), values in raw.items()}
    units = {name: unit for name, unit in raw}
    time = columns["time"]
    drift = numpy.array(told.drift)
    found = {}
    for name, values in columns.items():
        stem, axis = _stem(name)
        kind = next((k for k in (*_SPINS, "displacement", "velocity") if stem == k or stem.endswith("_" + k)), "")
        if not axis or name in ("time",):
            found[name] = values / told.factor(units[name])
            continue
        if name in found:
            continue
        vectors = numpy.stack([columns.get(f"{stem}_{a}", numpy.zeros_like(time)) for a in "xyz"], axis=1)
        if stem in ("momentum",) and any(told.drift):
            vectors = vectors - mass * drift
        elif stem in ("angular_momentum", "angular_impulse"):
            if any(told.drift):
                continue  # the centre of mass is not in the history
            vectors = vectors - numpy.cross(numpy.array(told.offset), numpy.stack([columns[f"{stem[8:]}_{a}"] for a in "xyz"], axis=1))
        vectors = _back(vectors, told, kind, units[name], time)
        found.update({f"{stem}_{a}": vectors[:, i] for i, a in enumerate("xyz") if f"{stem}_{a}" in columns})
    if any(told.drift):
        # Momenta are those half a step later; where lines are cycles, the kinetic energy lies between two of them, and at the start nothing has
        # pushed yet.
        momentum, impulse = (numpy.stack([columns[f"{name}_{a}"] for a in "xyz"], axis=1) for name in ("momentum", "impulse"))
        if numpy.all(numpy.diff(columns["cycle"]) == 1):
            momentum[1:] = (momentum[1:] + momentum[:-1]) / 2
        momentum[0] -= impulse[0]
        found["kinetic"] = columns["kinetic"] - momentum @ drift + mass * (drift @ drift) / 2
        found["initial"] = found["initial"] - columns["kinetic"][0] + found["kinetic"][0]
        found["external_work"] = columns["external_work"] - impulse @ drift
    return found


class ToldResults(Results):
    """The mesh of the check, with what the run found on it."""

    def __init__(self, original, run, told):
        super().__init__(original)
        self.told = told
        self.ran = Series(files_of(run)) if told.restarted else Results(run)
        self.times = self.ran.times / told.units[1]
        for names in ("nodal_names", "element_names", "side_names", "global_names"):
            setattr(self, names, getattr(self.ran, names))
        here, there, weights = told.mesh.shares
        self._same = weights == 1.0
        self._here, self._there, self._weights = here, there, weights

    def _on_nodes(self, values, stem):
        """Sums of shares, or means over the nodes of the run that are this one."""
        found = numpy.zeros((len(self.coordinates), *values.shape[1:]))
        rows = slice(None) if stem in _SHARED else self._same
        weights = self._weights[rows].reshape(-1, *[1] * (values.ndim - 1))
        numpy.add.at(found, self._there[rows], values[self._here[rows]] * weights)
        if stem not in _SHARED:
            count = numpy.zeros(len(found))
            numpy.add.at(count, self._there[rows], 1.0)
            found /= count.reshape(-1, *[1] * (values.ndim - 1))
        return found

    def nodal(self, name, step=-1):
        stem, axis = _stem(name)
        if axis and f"{stem}_x" in self.nodal_names:
            return self.nodal(stem, step)[:, "xyz".index(axis)]
        if name in self.nodal_names:
            return self._on_nodes(self.ran.nodal(name, step), name) / self.told.factor(_UNITS.get(name, "-"))
        values = self.ran.nodal(name, step)
        vectors = numpy.zeros((len(values), 3))
        vectors[:, : values.shape[1]] = values
        vectors = _back(vectors, self.told, name, _UNITS[name], self.ran.times[step])
        return self._on_nodes(vectors[:, : self.dimension], name)

    def element(self, block, name, step=-1):
        first, mine = self.told.mesh.first(block), sum(len(self.connectivity(b)) for b in self.blocks[: self.blocks.index(block)])
        size = len(self.ran.connectivity(block))
        parents = self.told.mesh.parents[first : first + size] - mine

        def of(values):
            found, count = numpy.zeros(len(self.connectivity(block))), numpy.zeros(len(self.connectivity(block)))
            numpy.add.at(found, parents, values)
            numpy.add.at(count, parents, 1.0)
            return found / count

        if name.startswith("stress_"):
            pairs = ("xx", "yy", "zz", "xy", "yz", "zx")
            xx, yy, zz, xy, yz, zx = (self.ran.element(block, f"stress_{pair}", step) for pair in pairs)
            tensor = numpy.stack([numpy.stack(row, axis=-1) for row in ((xx, xy, zx), (xy, yy, yz), (zx, yz, zz))], axis=-2)
            if not numpy.array_equal(self.told.matrix, numpy.eye(3)):
                tensor = self.told.matrix.T @ tensor @ self.told.matrix
            i, j = ("xyz".index(axis) for axis in name[-2:])
            return of(tensor[:, i, j]) / self.told.factor("Pa")
        return of(self.ran.element(block, name, step)) / self.told.factor(_UNITS.get(name, "-"))

    def side(self, side_set, name, step=-1):
        values = self.ran.side(side_set, name, step) / self.told.factor(_UNITS.get(name, "-"))
        ran = self.ran.sides(side_set)
        mine = {tuple(side): i for i, side in enumerate(self.sides(side_set).tolist())}
        found, count = numpy.zeros(len(mine)), numpy.zeros(len(mine))
        for (element, number), value in zip(ran, values):
            at = mine[int(self.told.mesh.parents[element - 1]) + 1, int(self.told.mesh.sides_before[element - 1, number])]
            found[at] += value
            count[at] += 1
        return found / count


class ToldPlanes:
    """Contact planes with the elements and sides of the check's mesh, sorted as it would have them."""

    def __init__(self, series, told, results):
        self.ran, self.told, self.times, self.results = series, told, series.times / told.units[1], results
        self.joint_names = series.joint_names

    def __len__(self):
        return len(self.ran)

    def fields(self, step):
        told, found = self.told, dict(self.ran.fields(step))
        vectors = [name for name, values in found.items() if numpy.ndim(values) == 2 and values.shape[1] == 3]
        for name in vectors:
            values = numpy.array(found[name], float)
            if name == "Points":
                values = values - numpy.array(told.offset) - numpy.array(told.drift) * self.ran.times[step] - [0, 0, told.depth / 2]
            found[name] = _back(values, told, "", _PLANES[name], 0.0)
        for name, values in found.items():
            if name not in vectors and name in _PLANES:
                found[name] = values / told.factor(_PLANES[name])
        for end in ("lower", "higher"):
            elements, sides = found[f"{end}_element"] - 1, found[f"{end}_side"]
            found[f"{end}_side"] = told.mesh.sides_before[elements, sides]
            found[f"{end}_element"] = told.mesh.parents[elements] + 1
        ends = [numpy.stack([found[f"{end}_element"], found[f"{end}_side"]], axis=1) for end in ("lower", "higher")]
        swapped = (ends[0][:, 0] > ends[1][:, 0]) | ((ends[0][:, 0] == ends[1][:, 0]) & (ends[0][:, 1] > ends[1][:, 1]))
        for what in ("element", "side", "block"):
            low, high = found[f"lower_{what}"], found[f"higher_{what}"]
            found[f"lower_{what}"], found[f"higher_{what}"] = numpy.where(swapped, high, low), numpy.where(swapped, low, high)
        for name in ("normal", "force", "shear_traction"):
            found[name] = numpy.where(swapped[:, None], -found[name], found[name])
        order = numpy.lexsort([found[key] for key in ("higher_side", "higher_element", "lower_side", "lower_element")])
        return {name: values[order] for name, values in found.items()}
