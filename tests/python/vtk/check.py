"""Objects of VTK made of results and planes, against VTK's own reader of Exodus and the files (README.md).

Usage: check.py [pyvista]
"""

import importlib.util
import pathlib
import sys

import numpy

wanted = "pyvista" if "pyvista" in sys.argv[1:] else "vtkmodules"
if not importlib.util.find_spec(wanted):
    print(f"SKIPPED: there is no {wanted} for {sys.executable}; nothing was tested")
    sys.exit(77)

from coplanetest import Case  # noqa: E402

import coplane  # noqa: E402

case = Case("vtk", __file__)
soft = {"model": "j2", "density": 2700, "youngs_modulus": 70e9, "poisson_ratio": 0.33, "yield_stress": 100e6, "hardening_modulus": 100e6}
hard = {"model": "linear_elastic", "density": 7850, "youngs_modulus": 200e9, "poisson_ratio": 0.3}
DENSITY = {"target": 2700, "striker": 7850}


def scene(dimension, split, rate):
    """A block that is eroded by a faster one of other elements."""
    box = {"shape": "box", "block": "striker", "min": [-0.0113, 2e-5, -0.0113][:dimension], "size": [0.02, 0.04, 0.02][:dimension],
           "divisions": [4, 6, 4][:dimension], "split": split}  # fmt: skip
    target = {"shape": "box", "block": "target", "min": [-0.05, -0.04, -0.03][:dimension], "size": [0.1, 0.04, 0.06][:dimension],
              "divisions": [12, 6, 6][:dimension]}  # fmt: skip
    deck = {"materials": {"soft": soft, "hard": hard},
            "blocks": {"target": {"material": "soft", "erosion": {"plastic_strain": 0.3, "volume_ratio": [0.1, 5]}}, "striker": {"material": "hard"}},
            "initial": [{"block": "striker", "velocity": [0, -rate, 0]}], "time": {"end": 3e-5}, "output": {"every": 1e-5}}  # fmt: skip
    return {"dimension": dimension, "parts": [target, box]}, deck


def attempt(name, recipe, deck, ranks=1):
    ended = case.attempt(name, recipe, deck, ranks)
    if ended.code:
        sys.exit(ended.output)
    return coplane.open(name)


flat = attempt("flat", *scene(2, "triangles", 400))
recipe, deck = scene(3, "tetrahedra", 400)
space = attempt("space", recipe, deck)
deck["output"]["file_per_rank"] = True
ranks = attempt("ranks", recipe, deck, 2)

if wanted == "pyvista":
    import pyvista

    for run in (flat, space):
        wrapped, points = pyvista.wrap(run.vtk(-1)), pyvista.wrap(run.planes.vtk(-1))
        case.check_equal(f"{run.folder}: pyvista's grid and points", (type(wrapped).__name__, type(points).__name__), ("UnstructuredGrid", "PolyData"))
        case.check_equal(f"{run.folder}: its arrays", bool(numpy.array_equal(wrapped.point_data["displacement"][:, 0], run.results.nodal("displacement_x"))), True)
    case.finish()
    sys.exit()

from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: E402
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet  # noqa: E402
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter  # noqa: E402
from vtkmodules.vtkIOIOSS import vtkIOSSReader  # noqa: E402


def array(data, name):
    found = data.GetArray(name)
    return None if found is None else vtk_to_numpy(found)


def corners(grid):
    """The points of each cell, one after the other, and where those of each begin."""
    cells = grid.GetCells()
    return vtk_to_numpy(cells.GetConnectivityArray()), vtk_to_numpy(cells.GetOffsetsArray())


def of_vtk(run, step, deformed):
    """A grid for each block, by VTK's reader."""
    reader = vtkIOSSReader()
    reader.AddFileName(str(run.results_path))
    reader.UpdateInformation()
    for selection in (reader.GetElementBlockSelection(), reader.GetNodeBlockFieldSelection(), reader.GetElementBlockFieldSelection()):
        selection.EnableAllArrays()
    reader.SetApplyDisplacements(deformed)
    reader.UpdateTimeStep(float(run.results.times[step]))
    found = reader.GetOutputDataObject(0)
    # The reader has names in small letters.
    grids = {found.GetMetaData(number).Get(vtkCompositeDataSet.NAME()): found.GetPartition(number, 0) for number in range(found.GetNumberOfPartitionedDataSets())}
    return [grids[name] for name in run.results.blocks]


def compare(run, step, deformed):
    """Names of what is not the same, to the last bit, block by block."""
    wrong, fields = set(), set()
    for name, theirs in zip(run.results.blocks, of_vtk(run, step, deformed)):
        ours = run.vtk(step, name, deformed, dead=True)
        at, places = corners(theirs)
        own_at, own_places = corners(ours)
        if not numpy.array_equal(places, own_places) or not numpy.array_equal(vtk_to_numpy(theirs.GetCellTypesArray()), vtk_to_numpy(ours.GetCellTypesArray())):
            wrong.add(f"cells of {name}")
            continue
        if not numpy.array_equal(vtk_to_numpy(theirs.GetPoints().GetData())[at], vtk_to_numpy(ours.GetPoints().GetData())[own_at]):
            wrong.add(f"points of {name}")
        for kind, data, own, rows, own_rows in (("node", theirs.GetPointData(), ours.GetPointData(), at, own_at),
                                                ("element", theirs.GetCellData(), ours.GetCellData(), slice(None), slice(None))):  # fmt: skip
            for number in range(data.GetNumberOfArrays()):
                field = data.GetArrayName(number).rstrip("_")  # VTK 9.1 leaves it behind names of vectors
                field = f"{kind}_id" if field == "ids" else field
                if field in ("object_id", "attribute"):  # of blocks, and body_id once more
                    continue
                fields.add(f"{kind} {field}")
                values, own_values = vtk_to_numpy(data.GetArray(number))[rows], array(own, field)
                if values.ndim > 1 and values.shape[1] == 2:  # in two dimensions; ours have a third component of 0
                    values = numpy.column_stack([values, numpy.zeros(len(values))])
                if own_values is None or not numpy.array_equal(values, own_values[own_rows]):
                    wrong.add(f"{field} of {name}")
    return sorted(wrong), fields


for run, kinds in ((flat, [5, 9]), (space, [10, 12])):
    what = run.folder.name
    last = len(run.results.times) - 1
    for step, deformed in ((0, True), (last, True), (last, False)):
        wrong, fields = compare(run, step, deformed)
        case.check_equal(f"{what}, step {step}, {'displaced' if deformed else 'as at the start'}: differs from VTK's reader", wrong, [])
    # Nothing is compared that is not there, and nothing is there that is not compared.
    grid = run.vtk()
    own = {f"{kind} {data.GetArrayName(number)}" for kind, data in (("node", grid.GetPointData()), ("element", grid.GetCellData()))
           for number in range(data.GetNumberOfArrays())}  # fmt: skip
    case.check_equal(f"{what}: fields", sorted(own ^ fields), ["element block_id"])
    case.check_equal(f"{what}: kinds of cells", sorted(set(vtk_to_numpy(grid.GetCellTypesArray()).tolist())), kinds)

    alive = run.elements.alive.values[-1] > 0.5
    case.check_within(f"{what}: dead elements", int((~alive).sum()), 1, alive.size)
    case.check_equal(f"{what}: the living ones", bool(numpy.array_equal(array(grid.GetCellData(), "element_id"), run.elements.element.values[alive])), True)
    case.check_equal(f"{what}: all", run.vtk(dead=True).GetNumberOfCells(), alive.size)
    sizes = vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    size = array(sizes.GetOutput().GetCellData(), "Area" if what == "flat" else "Volume")
    case.check_within(f"{what}: smallest {'area' if what == 'flat' else 'volume'} of a cell", size.min(), 1e-12, 1)
    density = array(grid.GetCellData(), "density")
    ids = dict(zip(run.results.blocks, run.results.block_ids))
    of_block = array(grid.GetCellData(), "block_id")
    start = sizes.NewInstance()
    start.SetInputData(run.vtk(deformed=False))
    start.Update()
    first = array(start.GetOutput().GetCellData(), "Area" if what == "flat" else "Volume")
    # Volumes at the start times their density then are masses, and so are those of now; warped hexahedra are measured by VTK in its own way.
    for name in run.results.blocks:
        chosen = of_block == ids[name]
        case.check(f"{what}: mass of {name}", float((size * density)[chosen].sum()), float(first[chosen].sum()) * DENSITY[name], 2e-3, relative=True)
    case.check_equal(f"{what}: names of blocks", [grid.GetFieldData().GetAbstractArray("block_names").GetValue(i) for i in range(2)], run.results.blocks)
    case.check_equal(f"{what}: time", grid.GetFieldData().GetArray("TimeValue").GetValue(0), float(run.results.times[-1]))
    case.check_equal(f"{what}: components of stress", [grid.GetCellData().GetArray("stress").GetComponentName(i) for i in range(6)],
                     ["xx", "yy", "zz", "xy", "yz", "zx"])  # fmt: skip

    most = int(numpy.argmax([len(run.planes.fields(step)["area"]) for step in range(len(run.planes))]))
    cloud, table = run.planes.vtk(most), run.planes[most]
    case.check_equal(f"{what}: planes and their vertices", (cloud.GetNumberOfPoints(), cloud.GetNumberOfVerts()), (len(table),) * 2)
    case.check_equal(f"{what}: places of planes", bool(numpy.array_equal(vtk_to_numpy(cloud.GetPoints().GetData()), table[["x", "y", "z"]])), True)
    wrong = [name for name, values in run.planes.fields(most).items() if name != "Points" and not numpy.array_equal(array(cloud.GetPointData(), name), values)]
    case.check_equal(f"{what}: fields of planes that differ", (wrong, len(table) > 3), ([], True))

# Of files for each rank the same, in the order of the ids.
one, many = space.vtk(dead=True), ranks.vtk(dead=True)
for what, of in (("places", lambda grid: vtk_to_numpy(grid.GetPoints().GetData())), ("corners", lambda grid: corners(grid)[0]),
                 ("velocities", lambda grid: array(grid.GetPointData(), "velocity")), ("ids", lambda grid: array(grid.GetCellData(), "element_id")),
                 ("stress", lambda grid: array(grid.GetCellData(), "stress"))):  # fmt: skip
    case.check_equal(f"a file for each rank: {what}", bool(numpy.array_equal(of(one), of(many))), True)

try:
    flat.vtk(blocks="wall")
    told = ""
except KeyError as error:
    told = str(error)
case.check_equal("a block that is not there", [word for word in ("'wall'", "target, striker") if word not in told], [])
for step in (99, 1e-4):
    try:
        flat.vtk(step)
        told = ""
    except IndexError as error:
        told = str(error)
    case.check_equal(f"step {step}, which is not there", [word for word in (f"no step {step}", f"0 to {len(flat.results.times) - 1}") if word not in told], [])
case.finish()
