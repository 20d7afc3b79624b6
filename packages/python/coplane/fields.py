"""Results as xarray Datasets. Nothing of a field is read before it is used."""

import numpy

from .needs import needs
from .units import attributes


def _lazy(xarray, shape, read):
    """An array over time whose steps are read when they are wanted; read(step) gives one."""
    indexing = xarray.core.indexing

    class Steps(xarray.backends.BackendArray):
        def __init__(self):
            self.shape, self.dtype = shape, numpy.dtype(float)

        def __getitem__(self, key):
            return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.BASIC, self.read)

        def read(self, key):
            steps = numpy.arange(self.shape[0])[key[0]]
            if numpy.ndim(steps) == 0:
                return read(int(steps))[key[1:]]
            chosen = [read(int(step))[key[1:]] for step in steps]
            return numpy.stack(chosen) if chosen else numpy.zeros((0, *self.shape[1:]))[(slice(None), *key[1:])]

    return indexing.LazilyIndexedArray(Steps())


def _dataset(series, dimension, names, read, coordinates):
    """read(name, step) gives a field; coordinates: arrays by name along the dimension, the first of them its ids."""
    xarray = needs("xarray", "A Dataset of fields")
    count = len(coordinates[dimension])
    shape = (len(series.times), count)
    variables = {name: xarray.Variable(("time", dimension), _lazy(xarray, shape, lambda step, name=name: read(name, step)), attributes(name))
                 for name in names}  # fmt: skip
    along = {name: (dimension, values, {"units": "m", "long_name": f"{name} at the start"} if name in "xyz" else {})
             for name, values in coordinates.items()}  # fmt: skip
    return xarray.Dataset(variables, {"time": ("time", series.times, {"units": "s"}), **along})


def nodes(series):
    """Fields on nodes: dimensions time and node; node is the id, x, y, z the place at the start."""
    places = {axis: series.coordinates[:, i] for i, axis in enumerate("xyz"[: series.dimension])}
    return _dataset(series, "node", series.nodal_names, series.nodal, {"node": series.node_ids, **places})


def elements(series, blocks=None):
    """Fields on the elements of some blocks, default all: dimensions time and element; x, y, z is the middle at the start, block the name
    of the block.
    """
    blocks = series.blocks if blocks is None else blocks
    middles = numpy.concatenate([series.centres(block) for block in blocks])
    names = numpy.repeat(numpy.array(blocks, object), [len(series.ids_of(block)) for block in blocks])

    def read(name, step):
        return numpy.concatenate([series.element(block, name, step) for block in blocks])

    return _dataset(series, "element", series.element_names, read, {
        "element": numpy.concatenate([series.ids_of(block) for block in blocks]), "block": names,
        **{axis: middles[:, i] for i, axis in enumerate("xyz"[: series.dimension])}})  # fmt: skip


def block(series, name):
    """The fields of one block, with `connectivity`: positions of the corners of its elements among the nodes, from 0."""
    return elements(series, [name]).assign(connectivity=(("element", "corner"), series.connectivity(name)))


def sides(series, name):
    """Fields on a side set: dimensions time and side; coordinates element (id) and number (of the side of that element, from 1)."""
    found = series.sides(name)
    return _dataset(series, "side", series.side_names, lambda variable, step: series.side(name, variable, step),
                    {"side": numpy.arange(len(found)), "element": found[:, 0], "number": found[:, 1]})  # fmt: skip


def whole(series):
    """Global variables over time: the time step and energies."""
    xarray = needs("xarray", "A Dataset of fields")
    return xarray.Dataset({name: ("time", series.whole(name), {"units": "J", **attributes(name)}) for name in series.global_names},
                          {"time": ("time", series.times, {"units": "s"})})  # fmt: skip
