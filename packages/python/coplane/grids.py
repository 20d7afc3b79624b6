"""Results and planes as objects of VTK, which pyvista.wrap takes as well."""

import numpy

from .needs import needs

# Ends of the components of vectors and of symmetric tensors, in the order in which VTK has them.
_VECTOR, _TENSOR = ("x", "y", "z"), ("xx", "yy", "zz", "xy", "yz", "zx")
# Cells of VTK by dimension and corners; corners are numbered as in Exodus.
_CELLS = {(2, 3): "VTK_TRIANGLE", (2, 4): "VTK_QUAD", (3, 4): "VTK_TETRA", (3, 8): "VTK_HEXAHEDRON"}


class _Vtk:
    """The modules of VTK that are wanted here."""

    def __init__(self):
        self.core = needs("vtkmodules.vtkCommonCore", "An object of VTK")
        self.model = needs("vtkmodules.vtkCommonDataModel", "An object of VTK")
        self.arrays = needs("vtkmodules.util.numpy_support", "An object of VTK")

    def array(self, values, name=None, components=()):
        found = self.arrays.numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
        if name:
            found.SetName(name)
        for place, end in enumerate(components):
            found.SetComponentName(place, end)
        return found

    def points(self, places):
        found = self.core.vtkPoints()
        found.SetData(self.array(places))
        return found

    def cells(self, corners):
        """Cells one after the other: corners has the points of those of each kind, (cell, corner)."""
        offsets = numpy.cumsum(numpy.concatenate([[0], *(numpy.full(len(some), some.shape[1]) for some in corners)]))
        found = self.model.vtkCellArray()
        ids = [self.arrays.numpy_to_vtkIdTypeArray(numpy.ascontiguousarray(values, numpy.int64), deep=True)
               for values in (offsets, numpy.concatenate([numpy.zeros(0), *(some.ravel() for some in corners)]))]  # fmt: skip
        found.SetData(*ids)
        return found

    def texts(self, name, values):
        found = self.core.vtkStringArray()
        found.SetName(name)
        for value in values:
            found.InsertNextValue(value)
        return found


def _grouped(names):
    """Components of vectors and tensors together: names of variables by the name of the field, with the ends of its components."""
    found = {}
    for name in names:
        stem, _, end = name.rpartition("_")
        for ends in (_VECTOR, _TENSOR):
            if end in ends and f"{stem}_{ends[0]}" in names:
                found[stem] = ends
                break
        else:
            found[name] = ()
    return found


def _field(ends, count, read, name, names):
    """Values of a field, (point or cell) or (point or cell, component); components that are not there are 0."""
    if not ends:
        return read(name)
    return numpy.stack([read(f"{name}_{end}") if f"{name}_{end}" in names else numpy.zeros(count) for end in ends], axis=1)


def place_of(step, count):
    """Position, from 0, of a step that is counted from 0, or from the end below 0."""
    try:
        return range(count)[step]
    except (IndexError, TypeError):
        raise IndexError(f"there is no step {step!r}; there are {count}: 0 to {count - 1}, or -1 for the last."
                         if count else "there is no step yet.") from None


def grid(series, step=-1, blocks=None, deformed=True, dead=False):
    """A step of the results as a vtkUnstructuredGrid, with all its fields; the text is that of Run.vtk."""
    vtk = _Vtk()
    step = place_of(step, len(series.times))
    blocks = series.blocks if blocks is None else [blocks] if isinstance(blocks, str) else list(blocks)
    for name in blocks:
        if name not in series.blocks:
            raise KeyError(f"the run has no block '{name}'; it has {', '.join(series.blocks)}")
    found = vtk.model.vtkUnstructuredGrid()
    # The third components of places and vectors in two dimensions are 0.
    places = numpy.zeros((len(series.coordinates), 3))
    places[:, : series.dimension] = series.coordinates
    if deformed:
        places[:, : series.dimension] += series.nodal("displacement", step)
    found.SetPoints(vtk.points(places))
    alive = {name: numpy.ones(len(series.ids_of(name)), bool) if dead else series.element(name, "alive", step) > 0.5 for name in blocks}
    corners = [series.connectivity(name)[alive[name]] for name in blocks]
    kinds = [getattr(vtk.model, _CELLS[series.dimension, some.shape[1]]) if len(some) else 0 for some in corners]
    found.SetCells(vtk.array(numpy.repeat(numpy.array(kinds, numpy.uint8), [len(some) for some in corners])), vtk.cells(corners))

    names = series.nodal_names
    for name, ends in _grouped(names).items():
        values = _field(ends, len(places), lambda one: series.nodal(one, step), name, names)
        found.GetPointData().AddArray(vtk.array(values, name, ends))
    found.GetPointData().SetGlobalIds(vtk.array(numpy.asarray(series.node_ids, numpy.int64), "node_id"))

    def joined(values_of):
        return numpy.concatenate([numpy.zeros(0), *(values_of(name)[alive[name]] for name in blocks)])

    names = series.element_names
    for name, ends in _grouped(names).items():
        values = _field(ends, sum(map(len, corners)), lambda one: joined(lambda block: series.element(block, one, step)), name, names)
        found.GetCellData().AddArray(vtk.array(values, name, ends))
    ids = dict(zip(series.blocks, series.block_ids))
    block_id = numpy.repeat([ids[name] for name in blocks], [len(some) for some in corners])
    found.GetCellData().AddArray(vtk.array(block_id.astype(numpy.int64), "block_id"))
    bodies = {name: series.attribute(name, "body_id") for name in blocks}
    if all(values is not None for values in bodies.values()):
        found.GetCellData().AddArray(vtk.array(joined(bodies.get), "body_id"))
    found.GetCellData().SetGlobalIds(vtk.array(joined(series.ids_of).astype(numpy.int64), "element_id"))

    data = found.GetFieldData()
    data.AddArray(vtk.array(series.times[step : step + 1], "TimeValue"))
    data.AddArray(vtk.array(numpy.array([ids[name] for name in blocks], numpy.int64), "block_ids"))
    data.AddArray(vtk.texts("block_names", blocks))
    return found


def cloud(planes, step=-1):
    """The planes of a step as a vtkPolyData of vertices; the text is that of Planes.vtk."""
    vtk = _Vtk()
    fields = planes.fields(step)
    places = fields.pop("Points")
    found = vtk.model.vtkPolyData()
    found.SetPoints(vtk.points(places))
    found.SetVerts(vtk.cells([numpy.arange(len(places)).reshape(-1, 1)]))
    for name, values in fields.items():
        found.GetPointData().AddArray(vtk.array(values, name, "xyz" if values.ndim > 1 else ()))
    found.GetFieldData().AddArray(vtk.array(planes.times[place_of(step, len(planes)) :][:1], "TimeValue"))
    found.GetFieldData().AddArray(vtk.texts("joint_names", planes.joint_names(step)))
    return found
