"""Pictures of a wall that a bar strikes, from Coplane's results.

    xvfb-run -a pvbatch wall_pictures.py wall.e wall_planes.pvd pictures 0 0.0013 0.0183

writes for each time [s] (the nearest step that the file holds)
    pictures/wall_<time in us>us.png      bricks coloured by a variable, with the edges of the mesh; the bar in steel colour
    pictures/contacts_<time in us>us.png  the points of contact as black dots in the transparent wall, as in Vorobiev 2006
The wall lies in x = -3.2..3.2, y = 0..6.4 (up), z = 0..0.64 m and is hit from z < 0: the camera looks at its back, from the
side, so that the bar is seen past the edge. Tested with ParaView 5.11.

The reader moves the mesh by the nodal variable `displacement` by itself: no Warp By Vector here, it would move it twice.
"""
import argparse
import os

import numpy
from paraview import servermanager
from paraview.simple import *  # noqa: F403 (the customary form of ParaView scripts)
from vtk.util.numpy_support import vtk_to_numpy

paraview.simple._DisableFirstRenderCameraReset()

STEEL = [0.45, 0.52, 0.60]
BRICK = [0.85, 0.82, 0.76]
SIZE = [1600, 900]
LIGHT = (0.45, 0.6)  # ambient and diffuse: faces seen at a slant shall not be dark
TITLES = {
    "von_mises": "von Mises stress [Pa]",
    "displacement": "displacement [m]",
    "velocity": "velocity [m/s]",
    "pressure": "pressure [Pa]",
    "equivalent_plastic_strain": "equivalent plastic strain",
}


def arguments():
    parser = argparse.ArgumentParser(description="Pictures of a wall that a bar strikes.")
    parser.add_argument("results", help="Exodus file of coplane")
    parser.add_argument("planes", help="contact planes, .pvd")
    parser.add_argument("folder", help="where the pictures go")
    parser.add_argument("times", nargs="+", type=float, help="[s]")
    parser.add_argument("--color", default="von_mises",
                        help="element variable, or a nodal vector, of which the length is shown (default: von_mises)")
    parser.add_argument("--max", type=float, help="upper end of the colours; default: 98 %% of all values at all times lie below")
    parser.add_argument("--bar", default="bar", help="element block shown in steel colour (default: bar)")
    return parser.parse_args()


def only(results, names):
    """A reader, the names of all element blocks, and the chosen ones as one grid."""
    reader = IOSSReader(FileName=[results])
    reader.UpdatePipelineInformation()
    present = list(reader.ElementBlocks)
    reader.ElementBlocks = [name for name in names if name in present]
    return reader, present, MergeBlocks(Input=reader, MergePoints=0)


def association(source, variable):
    if source.PointData.GetArray(variable):
        return "POINTS"
    if source.CellData.GetArray(variable):
        return "CELLS"
    raise SystemExit(f"The results have no variable '{variable}'; choose one of "
                     f"{', '.join(list(source.PointData.keys()) + list(source.CellData.keys()))}.")


def values_of(source, kind, variable, time):
    """Numbers, or lengths of vectors, at one time."""
    source.UpdatePipeline(time)
    data = servermanager.Fetch(source)
    attributes = data.GetPointData() if kind == "POINTS" else data.GetCellData()
    array = vtk_to_numpy(attributes.GetArray(variable))
    return numpy.linalg.norm(array, axis=1) if array.ndim > 1 else array


def nearest(times, wanted):
    return min(times, key=lambda t: abs(t - wanted))


def new_view():
    view = CreateView("RenderView")
    view.ViewSize = SIZE
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.OrientationAxesVisibility = 0
    view.CameraFocalPoint = [0.4, 3.1, -0.9]
    view.CameraPosition = [13.5, 6.6, 8.5]
    view.CameraViewUp = [0, 1, 0]
    view.CameraViewAngle = 30
    return view


def write_time(view, time):
    label = Text(Text=f"t = {1e3 * time:.2f} ms")
    display = Show(label, view)
    display.Color = [0, 0, 0]
    display.FontSize = 24
    display.WindowLocation = "Upper Left Corner"
    return label


def in_one_color(shown, color):
    # ColorBy(shown, None) of ParaView 5.11 fails where nothing was coloured before.
    shown.ColorArrayName = ["POINTS", ""]
    shown.AmbientColor = shown.DiffuseColor = color


def picture_of_bricks(bricks, bar, kind, variable, top, time, file):
    view = new_view()
    view.ViewTime = time
    shown = Show(bricks, view)
    shown.Representation = "Surface With Edges"
    shown.EdgeColor = [0.35, 0.35, 0.35]
    shown.Ambient, shown.Diffuse = LIGHT
    ColorBy(shown, (kind, variable, "Magnitude") if kind == "POINTS" else (kind, variable))
    colors = GetColorTransferFunction(variable)
    colors.ApplyPreset("Linear YGB 1211g", True)
    colors.RescaleTransferFunction(0.0, top)
    shown.SetScalarBarVisibility(view, True)
    scale = GetScalarBar(colors, view)
    scale.Title = TITLES.get(variable, variable)
    scale.ComponentTitle = ""
    scale.TitleColor = scale.LabelColor = [0, 0, 0]
    scale.WindowLocation = "Lower Right Corner"
    steel = Show(bar, view)
    steel.Representation = "Surface With Edges"
    steel.EdgeColor = [0.2, 0.24, 0.3]
    steel.Ambient, steel.Diffuse = LIGHT
    in_one_color(steel, STEEL)
    label = write_time(view, time)
    SaveScreenshot(file, view, ImageResolution=SIZE)
    Delete(label)
    Delete(view)


def picture_of_contacts(bricks, bar, planes, time, file):
    view = new_view()
    view.ViewTime = time
    for source, color, opacity in ((bricks, BRICK, 0.12), (bar, STEEL, 0.35)):
        shown = Show(source, view)
        shown.Representation = "Surface With Edges"
        shown.EdgeColor = [0.6, 0.6, 0.6]
        in_one_color(shown, color)
        shown.Opacity = opacity
    planes.UpdatePipeline(time)
    if planes.GetDataInformation().GetNumberOfPoints() > 0:
        dots = Show(planes, view)
        dots.Representation = "Points"
        in_one_color(dots, [0, 0, 0])
        dots.PointSize = 4
        dots.RenderPointsAsSpheres = 1
    label = write_time(view, time)
    SaveScreenshot(file, view, ImageResolution=SIZE)
    Delete(label)
    Delete(view)


def main():
    options = arguments()
    os.makedirs(options.folder, exist_ok=True)
    reader, names, bar = only(options.results, [options.bar])
    if options.bar not in names:
        raise SystemExit(f"{options.results} has no element block '{options.bar}'; it has {', '.join(names)}. Use --bar.")
    _, _, bricks = only(options.results, [name for name in names if name != options.bar])
    bricks.UpdatePipeline()
    kind = association(bricks, options.color)
    times = sorted({nearest(reader.TimestepValues, time) for time in options.times})
    top = options.max
    if top is None:
        top = max(numpy.percentile(values_of(bricks, kind, options.color, time), 98) for time in times) or 1.0

    series = PVDReader(FileName=options.planes)
    # Planes that carry traction: the others are open joints.
    active = Threshold(Input=series, Scalars=["POINTS", "area"], LowerThreshold=0.0, UpperThreshold=0.0,
                       ThresholdMethod="Above Upper Threshold")
    for time in times:
        stamp = f"{round(1e6 * time):06d}us.png"
        picture_of_bricks(bricks, bar, kind, options.color, top, time, os.path.join(options.folder, "wall_" + stamp))
        picture_of_contacts(bricks, bar, active, time, os.path.join(options.folder, "contacts_" + stamp))
        print(f"t = {time:.6g} s: {options.folder}/wall_{stamp}, {options.folder}/contacts_{stamp}")


main()
