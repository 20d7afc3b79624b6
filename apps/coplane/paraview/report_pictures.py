"""The first and the last state of any run, coloured by von Mises stress, for `coplane report`: folder of results, of pictures, name of the run."""
import sys

import coplane_pictures as cp

run = cp.Run(stem=sys.argv[3])
bodies = run.blocks()
bodies.UpdatePipeline(run.times[0])
x0, x1, y0, y1, z0, z1 = bodies.GetDataInformation().GetBounds()
middle, size = [(x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2], max(x1 - x0, y1 - y0, z1 - z0)
top = cp.percentile(bodies, "von_mises", run.nearest(run.times[-1]))
for time in run.nearest(run.times[0], run.times[-1]):
    if z1 > z0:
        view = {"camera": ([middle[0] + size, middle[1] - 1.6 * size, middle[2] + 0.8 * size], middle, [0, 0, 1])}
    else:
        view = {"box": (x0 - 0.1 * size, x1 + 0.1 * size, y0 - 0.1 * size, y1 + 0.1 * size)}
    picture = cp.Picture(run, time, size=(900, 600), **view)
    picture.surface(bodies, "von_mises", (0, top), "von Mises [Pa]")
    if run.has_planes():
        picture.dots(size=3)
    picture.save("state")
