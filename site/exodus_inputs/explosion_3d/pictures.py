"""Slip on the joints, in layers through the chamber: seen from above and from the side; and the speed of the rock."""
import coplane_pictures as cp
from paraview.simple import Clip, PointDatatoCellData, Threshold

run = cp.Run()
rock = run.blocks()
# Without slivers, which have the slip of their neighbours and carry nothing: faces share a quarter of a square metre in size S.
slip = Threshold(Input=cp.slipping(run, 1e-5), Scalars=["POINTS", "overlap"], LowerThreshold=0.01, UpperThreshold=0.01,
                 ThresholdMethod="Above Upper Threshold")
elements = PointDatatoCellData(Input=rock)
times = run.nearest(1e-3, run.times[-1])
top = 1e3 * cp.percentile(slip, "slip", times[-1:], 99)
millimetres = cp.computed(slip, "slip_mm", "1000*slip", "Point Data")


def layer(source, axis, half):
    """What lies within so much of the middle plane across this axis."""
    for side in (-1, 1):
        origin, normal = [0, 0, 0], [0, 0, 0]
        origin[axis], normal[axis] = side * half, side
        source = Clip(Input=source, ClipType="Plane")
        source.ClipType.Origin, source.ClipType.Normal = origin, normal
    return source


# Where the camera stands, and what is up.
VIEWS = {"from above": (1, [0, 40, 0], [0, 0, -1]), "from the side": (2, [0, 0, 40], [0, 1, 0])}
slips, speeds = [], []
for words, (axis, place, up) in VIEWS.items():
    # Joints in the layer, not those that bound it; of the blocks a thin slice, which does not hide them. Speeds of elements: those of
    # nodes are drawn on triangles, whose diagonals look like an asymmetry.
    blocks, joints = layer(elements, axis, 0.01), layer(millimetres, axis, 0.45)
    for time in times:
        last = time == times[-1]
        view = {"size": (560 if last else 460, 480), "camera": (place, [1.2 if last else 0, 0, 0], up), "angle": 21}
        picture = cp.Picture(run, time, **view)
        picture.text(words, "Upper Right Corner", 16)
        picture.solid(blocks, [0.93, 0.91, 0.87], edge=[0.8, 0.78, 0.74])
        picture.points(joints, "slip_mm", (0, top), "slip [mm]", size=6, points=cp.dark(top), bar=last)
        slips.append(picture.save("slip_" + str(axis)))
        picture = cp.Picture(run, time, **view)
        picture.surface(blocks, "velocity", (0, cp.percentile(rock, "velocity", times, 99.5)), "speed [m/s]", edges=False, bar=last)
        speeds.append(picture.save("speed_" + str(axis)))
cp.strip(slips, f"{run.pictures}/slip.png", 2)
cp.strip(speeds, f"{run.pictures}/speed.png", 2)
