"""Slip on the joints: the lower half of the rock with the chamber in its middle, points of planes coloured by slip."""
import coplane_pictures as cp
from paraview.simple import Clip

run = cp.Run()
rock = run.blocks()
below = Clip(Input=rock, ClipType="Plane")
below.ClipType.Origin, below.ClipType.Normal = [0, 0.001, 0], [0, 1, 0]
times = run.nearest(1e-3, 2.5e-3)
slip = cp.slipping(run, 1e-5)
top = 1e3 * cp.percentile(slip, "slip", times[-1:], 99)
millimetres = cp.computed(slip, "slip_mm", "1000*slip", "Point Data")
for time in times:
    picture = cp.Picture(run, time, size=(1000, 800), camera=([9, 15, 17], [0, -1.2, 0], [0, 1, 0]))
    picture.solid(below, cp.BRICK, opacity=0.25, edge=[0.75, 0.73, 0.7])
    picture.points(millimetres, "slip_mm", (0, top), "slip [mm]", size=7)
    picture.save("slip")
    picture = cp.Picture(run, time, size=(1000, 800), camera=([9, 15, 17], [0, -1.2, 0], [0, 1, 0]))
    picture.surface(below, "velocity", (0, cp.percentile(rock, "velocity", [time], 99.5)), "speed [m/s]", edges=False)
    picture.save("speed")
