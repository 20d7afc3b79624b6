"""Contact planes: the series `<name>_planes.pvd` and its files `.vtp`."""

import base64
import pathlib
import re
import xml.etree.ElementTree

import numpy

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


def joint_names(path):
    """Names that the field `joint` counts, from 0."""
    for array in xml.etree.ElementTree.parse(path).iter("Array"):
        if array.get("Name") == "joint_names":
            return bytes(map(int, array.text.split())).decode().split("\0")[:-1]
    return []


class Planes:
    """The contact planes of a run over time: `planes[step]` is a pandas DataFrame with a line for each plane. Its columns have the
    names of the file, vectors `_x, _y, _z` at their end; `x, y, z` is the point of contact and `joint` the name of the joint card.
    """

    def __init__(self, series, run=None):
        """FileNotFoundError when the series is not of the run with the identity `run`."""
        self.path = pathlib.Path(series)
        with open(self.path, encoding="utf-8") as file:
            found = re.search(r"<!-- coplane run (\w+) -->", file.read(200))
        if run and found and found.group(1) != run:
            raise FileNotFoundError(f"{self.path}: is of another run ({found.group(1)}) than the record ({run}), and is left out.")
        sets = list(xml.etree.ElementTree.parse(self.path).iter("DataSet"))
        self.times = numpy.array([float(item.get("timestep")) for item in sets])
        self.files = [self.path.parent / item.get("file") for item in sets]

    def __len__(self):
        return len(self.files)

    def __getitem__(self, step):
        pandas = needs("pandas", "A table of planes")
        columns = {}
        for name, values in planes(self.files[step]).items():
            stem = "" if name == "Points" else name + "_"
            if values.ndim == 1:
                columns[name] = values
            elif values.shape[1] == 3:
                columns.update({stem + axis: values[:, i] for i, axis in enumerate("xyz")})
        table = pandas.DataFrame({name: values for name, values in columns.items() if name not in ("connectivity", "offsets")})
        table["joint"] = numpy.array(joint_names(self.files[step]), object)[table["joint"]]
        table.attrs["time"] = self.times[step]
        return table

    def at(self, time):
        """The planes of the step that is nearest to a time [s]."""
        return self[int(numpy.argmin(numpy.abs(self.times - time)))]

    def vtk(self, step=-1):
        """The planes of a step as a vtkPolyData, which pyvista.wrap takes."""
        reader = needs("vtkmodules.vtkIOXML", "An object of VTK").vtkXMLPolyDataReader()
        reader.SetFileName(str(self.files[step]))
        reader.Update()
        return reader.GetOutput()
