"""A strip of pictures of the wave, and slip on the joints at the end where any slipped."""
import numpy

import coplane_pictures as cp

run = cp.Run()
rock = run.blocks()
rock.UpdatePipeline(0)
low, high = numpy.array(rock.GetDataInformation().GetBounds()).reshape(3, 2).T
flat = high[2] - low[2] < 1e-9
middle, reach = (low + high) / 2, (high - low).max()
end = run.times[-1]
times = run.nearest(0.2 * end, 0.4 * end, 0.6 * end, end)
top = cp.percentile(rock, "velocity", times, 99.5)


def picture(time, bar, size=(460, 460)):
    margin = 0.35 if bar else 0.02
    view = {"box": (low[0] - 0.02 * reach, high[0] + margin * reach, low[1] - 0.02 * reach, high[1] + 0.08 * reach)} if flat else {
        "camera": (list(middle + reach * numpy.array([-1.1, 1.0, 1.8])), list(middle), [0, 1, 0])}
    return cp.Picture(run, time, size=(round(size[0] * (1.3 if bar and flat else 1)), size[1]), **view)


files = []
for time in times:
    last = time == times[-1]
    shot = picture(time, last)
    shot.surface(rock, "velocity", (0, top), "speed [m/s]", edges=False, bar=last)
    files.append(shot.save("wave"))
cp.strip(files, f"{run.pictures}/wave.png", 4)

slip = cp.slipping(run, 1e-5)
slip.UpdatePipeline(end)
if flat and slip.GetDataInformation().GetNumberOfPoints():
    millimetres = cp.computed(slip, "slip_mm", "1000*slip", "Point Data")
    shot = picture(end, True, (640, 620))
    shot.solid(rock, [0.96, 0.95, 0.93], edge=[0.85, 0.84, 0.82])
    most = 1e3 * cp.percentile(slip, "slip", [end], 99)
    shot.points(millimetres, "slip_mm", (0, most), "slip [mm]", size=5, points=cp.dark(most))
    shot.save("slip")
