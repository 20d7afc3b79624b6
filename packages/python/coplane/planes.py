"""Contact planes over time: `<name>_planes.pvd` with its files `.vtp`, or `<name>_planes.vtkhdf`."""

import base64
import pathlib
import re
import xml.etree.ElementTree

import netCDF4
import numpy

from .grids import cloud, place_of
from .needs import needs


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


def joint_names(path, field="joint_names"):
    """Names that the field `joint` counts, from 0; with "line_names" those of the field `line` in files of lines."""
    for array in xml.etree.ElementTree.parse(path).iter("Array"):
        if array.get("Name") == field:
            return bytes(map(int, array.text.split())).decode().split("\0")[:-1]
    return []


class _VtpSteps:
    """The series `<name>_planes.pvd`: a file for each step."""

    def __init__(self, path):
        with open(path, encoding="utf-8") as file:
            found = re.search(r"<!-- coplane run (\w+) -->", file.read(200))
        self.run = found.group(1) if found else ""
        sets = list(xml.etree.ElementTree.parse(path).iter("DataSet"))
        self.times = numpy.array([float(item.get("timestep")) for item in sets])
        self.files = [path.parent / item.get("file") for item in sets]

    def fields(self, step):
        found = planes(self.files[step])
        return {name: values for name, values in found.items() if name not in ("connectivity", "offsets")}

    def joint_names(self, step):
        return joint_names(self.files[step])


class _VtkHdfSteps:
    """All steps in `<name>_planes.vtkhdf`. It is opened anew each time: a run that goes on may replace it."""

    def __init__(self, path):
        self.path = path
        with netCDF4.Dataset(path) as file:
            steps = file["VTKHDF/Steps"]
            self.run = str(file["VTKHDF"].Writer).split()[2]
            self.times = numpy.array(steps["Values"][: int(steps.NSteps)])
            self.first = numpy.array(steps["PointOffsets"][: len(self.times)])
            self.counts = numpy.array(file["VTKHDF/NumberOfPoints"][: len(self.times)])
            self.names = [str(name) for name in file["VTKHDF/FieldData/joint_names"][:]]

    def fields(self, step):
        rows = slice(self.first[step], self.first[step] + self.counts[step])
        with netCDF4.Dataset(self.path) as file:
            group = file["VTKHDF"]
            found = {"Points": numpy.array(group["Points"][rows])}
            found.update({name: numpy.array(values[rows]) for name, values in group["PointData"].variables.items()})
        return found

    def joint_names(self, step):
        return self.names


class Planes:
    """The contact planes of a run over time: `planes[step]` is a pandas DataFrame with a line for each plane. Its columns have the
    names of the file, vectors `_x, _y, _z` at their end; `x, y, z` is the point of contact and `joint` the name of the joint card.
    """

    def __init__(self, series, run=None):
        """From a .pvd or .vtkhdf. FileNotFoundError when the series is not of the run with the identity `run`."""
        self.path = pathlib.Path(series)
        self._steps = (_VtkHdfSteps if self.path.suffix == ".vtkhdf" else _VtpSteps)(self.path)
        if run and self._steps.run and self._steps.run != run:
            raise FileNotFoundError(f"{self.path}: is of another run ({self._steps.run}) than the record ({run}), and is left out.")
        self.times = self._steps.times

    def __len__(self):
        return len(self.times)

    def fields(self, step):
        """Fields of the planes of a step as arrays, by name; `Points` are the points of contact."""
        return self._steps.fields(place_of(step, len(self)))

    def joint_names(self, step):
        """Names that the field `joint` counts, from 0."""
        return self._steps.joint_names(place_of(step, len(self)))

    def __getitem__(self, step):
        pandas = needs("pandas", "A table of planes")
        columns = {}
        for name, values in self.fields(step).items():
            stem = "" if name == "Points" else name + "_"
            if values.ndim == 1:
                columns[name] = values
            elif values.shape[1] == 3:
                columns.update({stem + axis: values[:, i] for i, axis in enumerate("xyz")})
        table = pandas.DataFrame(columns)
        table["joint"] = numpy.array(self.joint_names(step), object)[table["joint"]]
        table.attrs["time"] = self.times[step]
        return table

    def at(self, time):
        """The planes of the step that is nearest to a time [s]."""
        return self[int(numpy.argmin(numpy.abs(self.times - time)))]

    def vtk(self, step=-1):
        """The planes of a step as a vtkPolyData of vertices, with all their fields, the names of joints as `joint_names` and the time
        as `TimeValue`. pyvista.wrap takes it.
        """
        return cloud(self, step)
