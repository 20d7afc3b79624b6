"""Exodus results through netCDF4."""

import base64
import xml.etree.ElementTree

import netCDF4
import numpy


def _text(row):
    return b"".join(numpy.asarray(row).tolist()).split(b"\0")[0].decode()


class Results:
    def __init__(self, path):
        self.file = netCDF4.Dataset(path)
        self.file.set_auto_mask(False)
        self.times = self.file["time_whole"][:]
        axes = [axis for axis in "xyz" if f"coord{axis}" in self.file.variables]
        self.dimension = len(axes)
        self.coordinates = numpy.stack([self.file[f"coord{axis}"][:] for axis in axes], axis=1)
        self._nodal = self._names("name_nod_var")
        self._element = self._names("name_elem_var")
        self.blocks = self._names("eb_names")
        self.side_sets = self._names("ss_names")
        self._side = self._names("name_sset_var")

    def _names(self, variable):
        if variable not in self.file.variables:
            return []
        return [_text(row) for row in self.file[variable][:]]

    def nodal(self, name, step=-1):
        """One value per node; a vector's stem gives all its components."""
        if name in self._nodal:
            return self.file[f"vals_nod_var{self._nodal.index(name) + 1}"][step]
        return numpy.stack([self.nodal(f"{name}_{axis}", step) for axis in "xyz"[: self.dimension]], axis=1)

    def element(self, block, name, step=-1):
        """One value per element of a block."""
        number = self._element.index(name) + 1
        return self.file[f"vals_elem_var{number}eb{self.blocks.index(block) + 1}"][step]

    def side(self, side_set, name, step=-1):
        """One value per side of a side set."""
        number = self._side.index(name) + 1
        return self.file[f"vals_sset_var{number}ss{self.side_sets.index(side_set) + 1}"][step]

    def connectivity(self, block):
        """Positions of nodes, from 0."""
        return self.file[f"connect{self.blocks.index(block) + 1}"][:] - 1

    def nodes_of(self, block):
        return numpy.unique(self.connectivity(block))

    def centres(self, block):
        """Middles of the elements in the reference state."""
        return self.coordinates[self.connectivity(block)].mean(axis=1)


def planes(path):
    """Fields of the contact planes in a .vtp file, by name; `Points` are the points of contact."""
    fields = {}
    for array in xml.etree.ElementTree.parse(path).iter("DataArray"):
        data = base64.b64decode(array.text)[8:]  # behind the number of bytes
        kind = {"Float64": float, "Int64": numpy.int64, "Int32": numpy.int32, "UInt8": numpy.uint8}[array.get("type")]
        values = numpy.frombuffer(data, kind)
        parts = int(array.get("NumberOfComponents", 1))
        fields[array.get("Name")] = values.reshape(-1, parts) if parts > 1 else values
    return fields


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
