"""Common parts of picture scripts for ParaView (pvbatch): opening results, views, colours, dots of contact, saving.

    import coplane_pictures as cp
    run = cp.Run()                       # folders of results and pictures from the command line
    for time in run.nearest(0, 0.8e-3):
        picture = cp.Picture(run, time, size=(1200, 800), box=(0, 0.05, -0.15, 0.15))
        picture.surface(run.blocks("bricks"), color="damage", range=(0, 1))
        picture.dots()
        picture.save("damage")           # pictures/damage_000800us.png

The reader moves the mesh by the nodal variable `displacement` by itself: no Warp By Vector, it would move it twice. Dead elements
(`alive` = 0) are left out. Tested with ParaView 5.11.
"""
import glob
import math
import os
import sys

import numpy
from paraview import servermanager
from paraview.simple import *  # noqa: F403 (the customary form of ParaView scripts)
from vtk.util.numpy_support import vtk_to_numpy

import paraview.simple

paraview.simple._DisableFirstRenderCameraReset()

# Where the camera stands and what is up, by name, where y is up; x runs to the right in `front`, as in the plane of a flat mesh.
CAMERAS = {"front": ((0, 0, 1), (0, 1, 0)), "back": ((0, 0, -1), (0, 1, 0)), "left": ((-1, 0, 0), (0, 1, 0)), "right": ((1, 0, 0), (0, 1, 0)),
           "top": ((0, 1, 0), (0, 0, -1)), "bottom": ((0, -1, 0), (0, 0, 1)), "iso": ((1, 0.8, 1.6), (0, 1, 0))}
PALETTE = [(0.45, 0.52, 0.60), (0.85, 0.72, 0.55), (0.56, 0.68, 0.50), (0.75, 0.50, 0.46), (0.62, 0.55, 0.72), (0.50, 0.70, 0.74), (0.80, 0.78, 0.45),
           (0.70, 0.70, 0.70)]
STEEL, BRICK, EDGE, BLACK = [0.45, 0.52, 0.60], [0.85, 0.82, 0.76], [0.35, 0.35, 0.35], [0, 0, 0]
MOST_LETTERS = 24  # of the name of a block beside a picture
LIGHT = (0.45, 0.6)  # ambient and diffuse: faces seen at a slant shall not be dark


class Run:
    """Results `run.e`, with the parts that restarts have written and the files of ranks, and planes `run_planes.xmf3` or `.pvd` in a folder."""

    def __init__(self, results=None, pictures=None, stem="run", deformed=True, files=None, planes=None, names=None, lines=None):
        """files: all files of the results, planes and lines: the series, in place of those in the folder. names: of the blocks as the mesh has them; the
        reader of ParaView writes them small, with _ for spaces."""
        self.folder = os.path.abspath(results or sys.argv[1])
        self.deformed = deformed
        self.pictures = pictures or sys.argv[2]
        os.makedirs(self.pictures, exist_ok=True)
        self.file = os.path.join(self.folder, stem + ".e")
        # All parts and ranks by their names: the reader seeks no files of ranks of other parts.
        self.files = files or sorted(glob.glob(glob.escape(self.file)) + glob.glob(glob.escape(self.file) + "[.-][s0-9]*"))
        self.reader = self._open()
        of_reader = list(self.reader.ElementBlocks)
        self.names = list(names) if names and len(names) == len(of_reader) else of_reader
        self._of_reader = dict(zip(self.names, of_reader))
        self.times = list(self.reader.TimestepValues)
        places = [os.path.join(self.folder, stem + "_planes" + end) for end in (".xmf3", ".pvd")]
        # Of a run that has changed its format, what was written last.
        self.planes_file = planes or max(filter(os.path.exists, places), key=os.path.getmtime, default=places[0])
        self.lines_file = lines or os.path.join(self.folder, stem + "_lines.pvd")

    def _open(self):
        reader = IOSSReader(FileName=self.files)
        reader.ApplyDisplacements = int(self.deformed)
        reader.UpdatePipelineInformation()
        return reader

    def nearest(self, *wanted):
        """The times of the file that are nearest to these, each once."""
        return sorted({min(self.times, key=lambda t: abs(t - time)) for time in wanted})

    def blocks(self, *names):
        """Living elements of these element blocks as one grid; without names: of all."""
        names = names or self.names
        for name in names:
            if name not in self.names:
                raise SystemExit(f"{self.file} has no element block '{name}'; it has {', '.join(self.names)}.")
        reader = self._open()
        reader.ElementBlocks = [self._of_reader[name] for name in names]
        grid = MergeBlocks(Input=reader, MergePoints=0)
        return Threshold(Input=grid, Scalars=["CELLS", "alive"], LowerThreshold=0.5, ThresholdMethod="Above Upper Threshold",
                         UpperThreshold=0.5)

    def has_planes(self):
        return os.path.exists(self.planes_file)

    def planes_reader(self):
        return PVDReader(FileName=self.planes_file) if self.planes_file.endswith(".pvd") else Xdmf3ReaderS(FileName=[self.planes_file])

    def has_lines(self):
        return os.path.exists(self.lines_file)

    def lines(self):
        """Segments of bolts, cables and bars."""
        return PVDReader(FileName=self.lines_file)

    def bounds(self, times, names=()):
        """x0, x1, y0, y1, z0, z1 of these bodies over these times; without names: of all."""
        found = []
        bodies = self.blocks(*names)
        for time in times:
            bodies.UpdatePipeline(time)
            found.append(bodies.GetDataInformation().GetBounds())
        return [(min if side % 2 == 0 else max)(box[side] for box in found) for side in range(6)]

    def planes(self, touching=True):
        """Planes as points; `touching`: only those that carry traction."""
        series = self.planes_reader()
        if not touching:
            return series
        return Threshold(Input=series, Scalars=["POINTS", "area"], LowerThreshold=1e-15, UpperThreshold=1e-15,
                         ThresholdMethod="Above Upper Threshold")


def slipping(run, more_than):
    """Points of planes that have slipped by more than this [m]."""
    return Threshold(Input=run.planes_reader(), Scalars=["POINTS", "slip"], LowerThreshold=more_than,
                     UpperThreshold=more_than, ThresholdMethod="Above Upper Threshold")


def computed(source, name, expression, kind="Cell Data"):
    """The source with one more variable."""
    return Calculator(Input=source, AttributeType=kind, ResultArrayName=name, Function=expression)


def values(source, variable, time):
    """Numbers, or lengths of vectors, at one time."""
    source.UpdatePipeline(time)
    data = servermanager.Fetch(source)
    if data.GetNumberOfPoints() == 0:
        return numpy.zeros(0)
    attributes = data.GetPointData() if data.GetPointData().GetArray(variable) else data.GetCellData()
    array = vtk_to_numpy(attributes.GetArray(variable))
    return numpy.linalg.norm(array, axis=1) if array.ndim > 1 else array


def percentile(source, variable, times, share=98):
    """Below which this share of all values at all times lies."""
    found = [values(source, variable, time) for time in times]
    return max((numpy.percentile(some, share) for some in found if len(some)), default=0) or 1.0


# Colours by name, as shares of the range: what stands out on white; white where nothing is left.
PALETTES = {"dark": [(0, 0.55, 0.75, 0.92), (0.25, 0.2, 0.45, 0.75), (0.5, 0.45, 0.25, 0.6), (1, 0.7, 0.05, 0.1)],
            "white_to_blue": [(0, 1, 1, 1), (0.01, 1, 1, 1), (0.1, 0.75, 0.86, 0.95), (0.5, 0.35, 0.6, 0.82), (1, 0.1, 0.25, 0.55)]}
PRESETS = {"green_blue": "Linear YGB 1211g", "cool_warm": "Cool to Warm"}


def palette(name, low, high):
    """Colours (value, r, g, b) of a palette from one value to another."""
    return [(low + share * (high - low), *color) for share, *color in PALETTES[name]]


def dark(top):
    """Colours from 0 to this value that stand out on white, light blue to dark red."""
    return palette("dark", 0, top)


def round_length(most):
    """The largest of 1, 2, 5 times a power of ten that is not more."""
    power = 10 ** math.floor(math.log10(most))
    return max(factor * power for factor in (1, 2, 5) if factor * power <= most * (1 + 1e-9))


def letters_of(size):
    """The size of letters, as a share of that for 800 points of height."""
    return max(0.6, min(1.0, size[1] / 800))


def margin_for(size, names=(), bars=0):
    """Points of the screen that names of blocks, or colour bars, take at the right of a picture."""
    longest = max((min(len(name), MOST_LETTERS) for name in names), default=0)
    return round(min(0.45 * size[0], letters_of(size) * max(12.5 * longest + 12 if names else 0, 175 if bars else 0)))


def words_of_length(metres):
    for unit, size in (("km", 1e3), ("m", 1), ("mm", 1e-3)):
        if metres >= size:
            return f"{metres / size:g} {unit}"
    return f"{metres * 1e6:g} \u00b5m"


class Picture:
    """One view at one time [s]. Flat: `box` (x0, x1, y0, y1) is what is seen. In space: `camera` (position, focal point, up). Or `camera` is one of
    CAMERAS, or the direction (x, y, z) from the bodies to it, with `bounds` of what shall be seen and the axis that is `up`, y or z,
    without perspective; `room` is left around them, and `margin` [points of the screen] at the right for names and colour bars."""

    def __init__(self, run, time, size=(1200, 800), box=None, camera=None, label=True, angle=30, bounds=None, up="y", room=1.2, margin=0):
        self.run, self.time, self.size, self.margin = run, time, list(size), margin
        self.bars = 0
        # Pictures of any run may be small; those of scripts choose their letters.
        self.letters = letters_of(size) if bounds else 1.0
        view = self.view = CreateView("RenderView")
        view.ViewSize = self.size
        view.UseColorPaletteForBackground = 0
        view.Background = [1, 1, 1]
        view.OrientationAxesVisibility = 0
        view.ViewTime = time
        if box:
            middle = [(box[0] + box[1]) / 2, (box[2] + box[3]) / 2]
            view.InteractionMode = "2D"
            view.CameraParallelProjection = 1
            view.CameraFocalPoint = middle + [0]
            view.CameraPosition = middle + [10 * (box[3] - box[2])]
            view.CameraViewUp = [0, 1, 0]
            view.CameraParallelScale = max((box[3] - box[2]) / 2, (box[1] - box[0]) / 2 * size[1] / size[0])
        elif bounds:
            self._look(camera, bounds, up, room)
        else:
            view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = camera
            view.CameraViewAngle = angle
        self.flat = bool(box) or bool(bounds) and bounds[5] <= bounds[4]
        if label:
            self.text(f"t = {1e6 * time:.4g} µs" if 0 < abs(time) < 1e-4 else f"t = {1e3 * time:.4g} ms")

    def _look(self, camera, bounds, axis_up, room):
        if isinstance(camera, str):
            toward, up = (numpy.array(vector, float) if axis_up == "y" else numpy.array([vector[0], -vector[2], vector[1]], float)
                          for vector in CAMERAS[camera])  # fmt: skip
        else:
            toward, up = numpy.array(camera, float), numpy.array([0, 1, 0] if axis_up == "y" else [0, 0, 1], float)
        toward /= numpy.linalg.norm(toward)
        right = numpy.cross(up, toward)
        right /= numpy.linalg.norm(right)
        up = numpy.cross(toward, right)
        sides = numpy.reshape(bounds, (3, 2))
        corners = numpy.array([[sides[axis, bit >> axis & 1] for axis in range(3)] for bit in range(8)])
        width, height = (numpy.ptp(corners @ axis) for axis in (right, up))
        middle = sides.mean(axis=1)
        view = self.view
        view.CameraParallelProjection = 1
        scale = 0.5 * room * max(height, width * self.size[1] / (self.size[0] - self.margin), 1e-300)
        middle = middle + self.margin * scale / self.size[1] * right
        view.CameraFocalPoint = list(middle)
        view.CameraPosition = list(middle + 3 * numpy.linalg.norm(numpy.ptp(sides, axis=1)) * toward)
        view.CameraViewUp = list(up)
        view.CameraParallelScale = scale
        if self.margin:
            self._blank_margin(scale, toward, right, up)

    def _blank_margin(self, scale, toward, right, up):
        """White before bodies that are wider than the bounds."""
        half = scale * self.size[0] / self.size[1]
        place = (numpy.array(self.view.CameraFocalPoint) + numpy.array(self.view.CameraPosition)) / 2
        corner = place + right * half * (1 - 2 * self.margin / self.size[0]) - up * 1.01 * scale
        sheet = Plane(Origin=list(corner), Point1=list(corner + right * 2.02 * half * self.margin / self.size[0]), Point2=list(corner + up * 2.02 * scale))
        shown = Show(sheet, self.view)
        shown.ColorArrayName = ["POINTS", ""]
        shown.AmbientColor = shown.DiffuseColor = [1, 1, 1]
        shown.Ambient, shown.Diffuse = 1.0, 0.0

    def scale_bar(self):
        """A length in the lower left corner; only where there is no perspective."""
        view = self.view
        focus, position, up = (numpy.array(vector) for vector in (view.CameraFocalPoint, view.CameraPosition, view.CameraViewUp))
        toward = (position - focus) / numpy.linalg.norm(position - focus)
        right = numpy.cross(up / numpy.linalg.norm(up), toward)
        half = numpy.array([view.CameraParallelScale * self.size[0] / self.size[1], view.CameraParallelScale])
        length = round_length(0.4 * half[0] * (1 - self.margin / self.size[0]))  # in a strip the same in all pictures
        first = focus + right * (-0.95 * half[0]) + numpy.cross(toward, right) * (-0.93 * half[1])
        first = first + toward * 0.5 * numpy.linalg.norm(position - focus)  # before everything
        shown = Show(Line(Point1=list(first), Point2=list(first + length * right)), view)
        shown.LineWidth, shown.ColorArrayName = 4, ["POINTS", ""]
        shown.AmbientColor = shown.DiffuseColor = BLACK
        shown.Ambient, shown.Diffuse = 1.0, 0.0
        display = Show(Text(Text=words_of_length(length)), view)
        display.Color, display.FontSize, display.WindowLocation, display.Position = BLACK, round(18 * self.letters), "Any Location", [0.025, 0.045]

    def bodies(self, names=(), opacity=1.0, legend=True, change=lambda source: source, edges=True):
        """Every block in a colour of its own, named at the right as far as there is room. change(source): what is drawn of each."""
        shown, line = [], 34 * self.letters / self.size[1]
        rows = max(1, int(0.95 / line) - 1)
        for place, name in enumerate(self.run.names):
            if names and name not in names:
                continue
            color = PALETTE[place % len(PALETTE)]
            source = change(self.run.blocks(name))
            source.UpdatePipeline(self.time)
            if source.GetDataInformation().GetNumberOfCells() == 0:
                continue
            self.solid(source, list(color), edges, opacity)
            shown.append((name, [0.8 * part for part in color]))
        if not legend:
            return
        if len(shown) > rows:
            shown[rows - 1:] = [(f"and {len(shown) - rows + 1} more", BLACK)]
        for place, (name, color) in enumerate(shown):
            display = Show(Text(Text=name if len(name) <= MOST_LETTERS else name[:MOST_LETTERS - 3] + "..."), self.view)
            display.Color, display.FontSize, display.WindowLocation = color, round(20 * self.letters), "Any Location"
            display.Bold, display.Position = 1, [1 - self.margin / self.size[0] if self.margin else 0.84, 0.97 - line * (place + 1)]

    def arrows(self, length, top, vector="force"):
        """Planes that carry traction as arrows of this length [m] where the vector is as large as `top`."""
        source = self.run.planes()
        source.UpdatePipeline(self.time)
        if source.GetDataInformation().GetNumberOfPoints() == 0:
            return
        glyphs = Glyph(Input=source, GlyphType="Arrow", OrientationArray=["POINTS", vector], ScaleArray=["POINTS", vector],
                       ScaleFactor=length / (top or 1), GlyphMode="All Points")
        self.solid(glyphs, [0.75, 0.1, 0.1], edges=False)

    def text(self, words, where="Upper Left Corner", size=24):
        display = Show(Text(Text=words), self.view)
        display.Color, display.FontSize, display.WindowLocation = BLACK, round(size * self.letters), where

    def _show(self, source, representation, opacity=1.0):
        shown = Show(source, self.view)
        shown.Representation = representation
        shown.Opacity = opacity
        shown.Ambient, shown.Diffuse = (1.0, 0.0) if self.flat else LIGHT
        return shown

    def solid(self, source, color, edges=True, opacity=1.0, edge=EDGE):
        """In one colour."""
        shown = self._show(source, "Surface With Edges" if edges else "Surface", opacity)
        shown.EdgeColor = edge
        # ColorBy(shown, None) of ParaView 5.11 fails where nothing was coloured before.
        shown.ColorArrayName = ["POINTS", ""]
        shown.AmbientColor = shown.DiffuseColor = color
        return shown

    def surface(self, source, color, range, title=None, preset="Linear YGB 1211g", edges=True, bar=True, points=None, edge=EDGE,
                invert=False, where="Lower Right Corner", representation=None):
        """Coloured by a variable. `points`: colours given as (value, r, g, b), ... instead of a preset."""
        source.UpdatePipeline(self.time)
        kind = "POINTS" if source.PointData.GetArray(color) else "CELLS"
        shown = self._show(source, representation or ("Surface With Edges" if edges else "Surface"))
        shown.EdgeColor = edge
        array = source.PointData.GetArray(color) if kind == "POINTS" else source.CellData.GetArray(color)
        if array is None:
            raise SystemExit(f"no variable '{color}' in {self.run.file}.")
        ColorBy(shown, (kind, color, "Magnitude") if array.GetNumberOfComponents() > 1 else (kind, color))
        colors = GetColorTransferFunction(color)
        if points:
            colors.RGBPoints = [number for point in points for number in point]
            colors.ColorSpace = "RGB"
        else:
            colors.ApplyPreset(preset, True)
            if invert:
                colors.InvertTransferFunction()
            colors.RescaleTransferFunction(*range)
        if bar:
            shown.SetScalarBarVisibility(self.view, True)
            scale = GetScalarBar(colors, self.view)
            scale.Title, scale.ComponentTitle = title or color, ""
            scale.TitleColor = scale.LabelColor = BLACK
            scale.WindowLocation = where
            if self.margin:
                self._beside(scale)
        return shown

    def _beside(self, scale):
        """A colour bar in the margin, the first above the second."""
        scale.AutomaticLabelFormat, scale.LabelFormat, scale.RangeLabelFormat = 0, "%.3g", "%.3g"
        scale.TitleFontSize = scale.LabelFontSize = round(18 * self.letters)
        scale.ScalarBarThickness = round(18 * self.letters)
        scale.WindowLocation, scale.ScalarBarLength = "Any Location", 0.38
        scale.Position = [1 - (self.margin - 10 * self.letters) / self.size[0], 0.54 if self.bars == 0 else 0.06]
        self.bars += 1

    def dots(self, source=None, size=4, color=BLACK):
        """Points of contact as black dots, as in the pictures of Vorobiev 2006."""
        source = source or self.run.planes()
        source.UpdatePipeline(self.time)
        if source.GetDataInformation().GetNumberOfPoints() == 0:
            return
        shown = self._show(source, "Points")
        shown.ColorArrayName = ["POINTS", ""]
        shown.AmbientColor = shown.DiffuseColor = color
        shown.PointSize = size
        # In the plane of a flat mesh some renderers hide spheres behind it.
        shown.RenderPointsAsSpheres = 0 if self.flat else 1
        shown.Ambient, shown.Diffuse = 1.0, 0.0

    def points(self, source, color, range, title, size=6, **more):
        """Points coloured by a variable."""
        source.UpdatePipeline(self.time)
        if source.GetDataInformation().GetNumberOfPoints() == 0:
            return
        shown = self.surface(source, color, range, title, representation="Points", **more)
        shown.PointSize = size
        shown.RenderPointsAsSpheres = 0 if self.flat else 1

    def lines(self, source, color, range, title, width=5, **more):
        """Segments of lines coloured by a variable of theirs."""
        source.UpdatePipeline(self.time)
        if source.GetDataInformation().GetNumberOfCells() == 0:
            return
        if self.flat:  # before the bodies, not in their plane
            toward = numpy.array(self.view.CameraPosition) - numpy.array(self.view.CameraFocalPoint)
            source = Transform(Input=source)
            source.Transform.Translate = list(0.01 * toward)
        shown = self.surface(source, color, range, title, representation="Surface", **more)
        shown.LineWidth = width
        shown.RenderLinesAsTubes = 0 if self.flat else 1

    def save(self, name):
        file = os.path.join(self.run.pictures, f"{name}_{round(1e6 * self.time):06d}us.png")
        SaveScreenshot(file, self.view, ImageResolution=self.size, CompressionLevel="9")
        print(f"t = {self.time:.6g} s: {file}", flush=True)
        Delete(self.view)
        return file


def strip(files, file, columns):
    """Pictures of one size beside each other, in rows of so many; the pictures themselves are removed."""
    from vtk import vtkImageAppend, vtkPNGReader, vtkPNGWriter

    def beside(images, axis):
        append = vtkImageAppend()
        append.SetAppendAxis(axis)
        for image in images:
            append.AddInputData(image)
        append.Update()
        return append.GetOutput()

    images = []
    for name in files:
        reader = vtkPNGReader()
        reader.SetFileName(name)
        reader.Update()
        images.append(reader.GetOutput())
        os.remove(name)
    rows = [beside(images[i:i + columns], 0) for i in range(0, len(images), columns)]
    writer = vtkPNGWriter()
    writer.SetFileName(file)
    writer.SetCompressionLevel(9)
    writer.SetInputData(beside(rows[::-1], 1))  # VTK counts rows from below
    writer.Write()
    print(file, flush=True)
