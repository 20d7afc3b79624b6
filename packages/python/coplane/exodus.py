"""Exodus files through netCDF4: meshes and results, one file or the files of a run together."""

import pathlib
import re

import netCDF4
import numpy


def _text(row):
    return b"".join(numpy.asarray(row).tolist()).split(b"\0")[0].decode()


class Results:
    """One file. `step` counts output steps, from 0; -1 is the last."""

    def __init__(self, path):
        self.path = str(path)
        self.file = netCDF4.Dataset(path)
        self.file.set_auto_mask(False)
        self.times = self._values("time_whole", float)
        axes = [axis for axis in "xyz" if f"coord{axis}" in self.file.variables]
        self.dimension = len(axes)
        self.coordinates = numpy.stack([self.file[f"coord{axis}"][:] for axis in axes], axis=1)
        self.nodal_names = self._names("name_nod_var")
        self.element_names = self._names("name_elem_var")
        self.side_names = self._names("name_sset_var")
        self.global_names = self._names("name_glo_var")
        self.blocks = self._names("eb_names")
        self.node_sets = self._names("ns_names")
        self.side_sets = self._names("ss_names")

    def _names(self, variable):
        return [_text(row) for row in self._values(variable, "S1")]

    def _values(self, variable, kind, step=None):
        """What a variable holds; nothing when it is not there: sets and blocks of which a rank has nothing have none."""
        if variable not in self.file.variables:
            return numpy.zeros(0, kind)
        return self.file[variable][:] if step is None else self.file[variable][step]

    def _ids(self, variable, count):
        ids = self._values(variable, int)
        return ids if len(ids) else numpy.arange(1, count + 1)

    @property
    def run(self):
        """Identity of the run that wrote the file; empty for a mesh."""
        found = [re.fullmatch(r"coplane run (\w+)", _text(row)) for row in self._values("info_records", "S1")[:1]]
        return found[0].group(1) if found and found[0] else ""

    @property
    def node_ids(self):
        return self._ids("node_num_map", len(self.coordinates))

    @property
    def element_ids(self):
        return self._ids("elem_num_map", len(self.file.dimensions["num_elem"]))

    @property
    def block_ids(self):
        """Of the blocks in their order."""
        return self._ids("eb_prop1", len(self.blocks))

    def ids_of(self, block):
        """Ids of the elements of a block: blocks stand one after the other in the file."""
        counts = [len(self.connectivity(name)) for name in self.blocks]
        place = self.blocks.index(block)
        return self.element_ids[sum(counts[:place]) :][: counts[place]]

    def nodal(self, name, step=-1):
        """One value per node; a vector's stem gives all its components."""
        if name in self.nodal_names:
            return self._values(f"vals_nod_var{self.nodal_names.index(name) + 1}", float, step)
        return numpy.stack([self.nodal(f"{name}_{axis}", step) for axis in "xyz"[: self.dimension]], axis=1)

    def element(self, block, name, step=-1):
        """One value per element of a block."""
        number = self.element_names.index(name) + 1
        return self._values(f"vals_elem_var{number}eb{self.blocks.index(block) + 1}", float, step)

    def side(self, side_set, name, step=-1):
        """One value per side of a side set."""
        number = self.side_names.index(name) + 1
        return self._values(f"vals_sset_var{number}ss{self.side_sets.index(side_set) + 1}", float, step)

    def attribute(self, block, name):
        """An attribute of the elements of a block, such as `body_id`: one value per element; None when the block has none of this name."""
        number = self.blocks.index(block) + 1
        names = self._names(f"attrib_name{number}")
        return self.file[f"attrib{number}"][:, names.index(name)] if name in names else None

    def whole(self, name):
        """A global variable, such as `time_step`: one value per step."""
        return self.file["vals_glo_var"][:, self.global_names.index(name)]

    def connectivity(self, block):
        """Positions of nodes, from 0."""
        connected = self._values(f"connect{self.blocks.index(block) + 1}", int)
        return connected.reshape(len(connected), -1) - 1

    def sides(self, side_set):
        """Element id and number of the side, from 1, for every side of a set."""
        number = self.side_sets.index(side_set) + 1
        elements = self._values(f"elem_ss{number}", int)
        return numpy.stack([self.element_ids[elements - 1], self._values(f"side_ss{number}", int)], axis=1)

    def set_nodes(self, node_set):
        """Positions of the nodes of a node set, from 0."""
        return self._values(f"node_ns{self.node_sets.index(node_set) + 1}", int) - 1

    def nodes_of(self, block):
        return numpy.unique(self.connectivity(block))

    def centres(self, block):
        """Middles of the elements in the reference state."""
        return self.coordinates[self.connectivity(block)].mean(axis=1)


def _places(ids, wanted):
    """Where the wanted ids stand in ids, which may be in any order."""
    order = numpy.argsort(ids)
    return order[numpy.searchsorted(ids, wanted, sorter=order)]


class Series:
    """The results of a run as one file in one series of times, with the interface of Results: parts that restarts have written
    (`wall.e`, `wall.e-s0002`, ...) one after the other, and the files per rank of a part side by side. A part may have another number
    of files than the one before it. Nodes and elements stand as in the first file; of several files, in the order of their ids.
    """

    def __init__(self, parts):
        """parts: lists of paths, the files of each part."""
        self.parts = [[Results(path) for path in files] for files in parts]
        first = self.parts[0]
        self.dimension, self.blocks, self.node_sets, self.side_sets = (
            getattr(first[0], name) for name in ("dimension", "blocks", "node_sets", "side_sets"))
        self.nodal_names, self.element_names, self.side_names, self.global_names = (
            getattr(first[0], f"{name}_names") for name in ("nodal", "element", "side", "global"))
        # A file that is written just now may have a step more than the next one.
        counts = [min(len(file.times) for file in part) for part in self.parts]
        self.steps = [(part, step) for part, count in enumerate(counts) for step in range(count)]
        self.times = numpy.concatenate([part[0].times[:count] for part, count in zip(self.parts, counts)])
        self.node_ids = self._union(file.node_ids for file in first)
        self.coordinates = self._joined(first, self.node_ids, lambda file: file.node_ids, lambda file: file.coordinates)

    @staticmethod
    def _union(ids):
        ids = list(ids)
        return ids[0] if len(ids) == 1 else numpy.unique(numpy.concatenate(ids))

    @staticmethod
    def _joined(part, ids, ids_of, values_of):
        """Values of all files of a part, in the order of the ids."""
        found = None
        for file in part:
            own, values = ids_of(file), values_of(file)
            if found is None or found.shape[1:] != values.shape[1:] and len(values):
                found = numpy.zeros((len(ids), *values.shape[1:]), values.dtype)
            if len(values):
                found[_places(ids, own)] = values
        return found

    def _at(self, step):
        part, local = self.steps[step]
        return self.parts[part], local

    @property
    def element_ids(self):
        return numpy.concatenate([self.ids_of(block) for block in self.blocks])

    @property
    def block_ids(self):
        return self.parts[0][0].block_ids

    def ids_of(self, block):
        return self._union(file.ids_of(block) for file in self.parts[0])

    def nodal(self, name, step=-1):
        part, local = self._at(step)
        return self._joined(part, self.node_ids, lambda file: file.node_ids, lambda file: file.nodal(name, local))

    def element(self, block, name, step=-1):
        part, local = self._at(step)
        return self._joined(part, self.ids_of(block), lambda file: file.ids_of(block), lambda file: file.element(block, name, local))

    def attribute(self, block, name):
        files = [file for file in self.parts[0] if len(file.ids_of(block))]
        if any(file.attribute(block, name) is None for file in files):
            return None
        return self._joined(files, self.ids_of(block), lambda file: file.ids_of(block), lambda file: file.attribute(block, name))

    def connectivity(self, block):
        return self._joined(self.parts[0], self.ids_of(block), lambda file: file.ids_of(block),
                            lambda file: _places(self.node_ids, file.node_ids)[file.connectivity(block)])

    @staticmethod
    def _side_ids(sides):
        return sides[:, 0].astype(numpy.int64) * 8 + sides[:, 1]

    def sides(self, side_set):
        found = numpy.concatenate([file.sides(side_set) for file in self.parts[0]])
        return found if len(self.parts[0]) == 1 else found[numpy.argsort(self._side_ids(found))]

    def side(self, side_set, name, step=-1):
        part, local = self._at(step)
        return self._joined(part, self._side_ids(self.sides(side_set)), lambda file: self._side_ids(file.sides(side_set)),
                            lambda file: file.side(side_set, name, local))

    def whole(self, name):
        values = [part[0].whole(name) for part in self.parts]
        return numpy.array([values[part][step] for part, step in self.steps])

    def set_nodes(self, node_set):
        found = [_places(self.node_ids, file.node_ids[file.set_nodes(node_set)]) for file in self.parts[0]]
        return found[0] if len(found) == 1 else numpy.unique(numpy.concatenate(found))

    nodes_of, centres = Results.nodes_of, Results.centres


def files_of(results, run=None):
    """Files of the run that wrote `wall.e`: for each part the shared one, or those of its ranks (`wall.e.2.0`), first ranks first. Parts
    of other runs are left out. FileNotFoundError when there is none, or the first part is not of the run with the identity `run`.
    """
    results = pathlib.Path(results)
    pattern = re.compile(re.escape(results.name) + r"(?:-s([0-9]+))?(?:\.([0-9]+)\.([0-9]+))?")
    found = {}
    for path in results.parent.iterdir() if results.parent.is_dir() else []:
        name = pattern.fullmatch(path.name)
        if name:
            part, ranks, rank = (int(text or 0) for text in name.groups())
            found.setdefault(part, {}).setdefault(ranks, []).append((rank, path))
    if 0 not in found:
        raise FileNotFoundError(f"{results}: there are no results of this name, neither one file nor one per rank ({results.name}.2.0).")
    parts = []
    for part in sorted(found):
        # An earlier run may have left what is shared, or files of other ranks.
        newest = max(found[part].values(), key=lambda files: max(path.stat().st_mtime for _, path in files))
        parts.append([path for _, path in sorted(newest)])
    found = Results(parts[0][0]).run
    if run and found != run:
        raise FileNotFoundError(f"{parts[0][0]}: is of another run ({found or 'without identity'}) than the record ({run}), and is left out.")
    run = found
    return [parts[0]] + [files for files in parts[1:] if Results(files[0]).run == run]


# Records of who ran what, when and how: the only things that may differ between equal runs.
_RECORDS = {"qa_records", "info_records"}


def differences(first, second):
    """Names of what differs between two results files, bit by bit, but for QA and info records."""
    with netCDF4.Dataset(first) as a, netCDF4.Dataset(second) as b:
        found = []
        for file in (a, b):
            file.set_auto_mask(False)
            file.set_auto_scale(False)
        if set(a.variables) - _RECORDS != set(b.variables) - _RECORDS:
            found.append(f"variables: {sorted(set(a.variables) ^ set(b.variables))}")
        for name in set(a.variables) & set(b.variables) - _RECORDS:
            x, y = a[name][:], b[name][:]
            if x.dtype != y.dtype or x.shape != y.shape or x.tobytes() != y.tobytes():
                found.append(name)
        for name in set(a.ncattrs()) | set(b.ncattrs()):
            if name not in a.ncattrs() or name not in b.ncattrs() or a.getncattr(name) != b.getncattr(name):
                found.append(f"attribute {name}")
        return sorted(found)


def series_differences(whole, parts):
    """Names of what differs between the steps of one file and the steps of a series of files, one after another, and
    between the meshes of the files.
    """
    found = []
    with netCDF4.Dataset(whole) as file:
        file.set_auto_mask(False)
        steps = {n: v[:] for n, v in file.variables.items() if "time_step" in v.dimensions}
        fixed = {n: v[:] for n, v in file.variables.items() if n not in steps and n not in _RECORDS}
    collected = {name: [] for name in steps}
    for part in parts:
        with netCDF4.Dataset(part) as file:
            file.set_auto_mask(False)
            for name, values in fixed.items():
                if name not in file.variables or file[name][:].tobytes() != values.tobytes():
                    found.append(f"{name} of {part}")
            for name in steps:
                collected[name].append(file[name][:])
    for name, values in steps.items():
        joined = numpy.concatenate(collected[name])
        if joined.shape != values.shape or joined.tobytes() != values.tobytes():
            found.append(name)
    return sorted(found)
