"""Pictures of the wave, and of slip and opened joints, in the middle of the rock."""
import numpy

import coplane_pictures as cp

run = cp.Run()
rock = run.blocks()
times = run.times[:: max(1, len(run.times) // 5)][1:]
rock.UpdatePipeline(0)
low, high = numpy.array(rock.GetDataInformation().GetBounds()).reshape(3, 2).T
flat = high[2] - low[2] < 1e-9
middle, reach = (low + high) / 2, (high - low).max()
top = cp.percentile(rock, "velocity", times, 99.5)
for time in times:
    view = {"box": (low[0] - 0.02 * reach, high[0] + 0.2 * reach, low[1] - 0.02 * reach, high[1] + 0.02 * reach)} if flat else {
        "camera": (list(middle + reach * numpy.array([-1.1, 1.0, 1.8])), list(middle), [0, 1, 0])}
    picture = cp.Picture(run, time, size=(900, 720), **view)
    picture.surface(rock, "velocity", (0, top), "speed [m/s]", edges=False)
    if flat:
        slipping = cp.slipping(run, 1e-5)
        picture.dots(slipping, size=5, color=[0.8, 0.1, 0.1])
    picture.save("wave")
