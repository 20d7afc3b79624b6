"""Pictures of the wall that the bar strikes: tensile strength of the bricks with the mesh, and points of contact as black dots.

The bar comes from z < 0: the camera looks at the wall's back, from the side, so that the bar is seen past the edge.
"""
import coplane_pictures as cp

run = cp.Run()
bricks, bar = run.blocks("bricks"), run.blocks("bar")
strength = cp.computed(bricks, "strength", "4*(1-damage)")
# White where nothing is left of the strength.
WHITE = [(0, 1, 1, 1), (0.04, 1, 1, 1), (0.4, 0.75, 0.86, 0.95), (2, 0.35, 0.6, 0.82), (4, 0.1, 0.25, 0.55)]
VIEW = {"size": (1200, 675), "camera": ([13.5, 6.6, 8.5], [0.4, 3.1, -0.9], [0, 1, 0])}
for time in run.nearest(0, 0.0013, 0.0183, 0.041):
    picture = cp.Picture(run, time, **VIEW)
    picture.surface(strength, "strength", (0, 4), "tensile strength [MPa]", points=WHITE)
    picture.solid(bar, cp.STEEL, edge=[0.2, 0.24, 0.3])
    picture.save("wall")
    picture = cp.Picture(run, time, **VIEW)
    picture.solid(bricks, cp.BRICK, opacity=0.12, edge=[0.6, 0.6, 0.6])
    picture.solid(bar, cp.STEEL, opacity=0.35, edge=[0.6, 0.6, 0.6])
    picture.dots()
    picture.save("contacts")

# The paper's times in one picture.
files = []
times = run.nearest(0, 0.0013, 0.0183, 0.041)
for time in times:
    picture = cp.Picture(run, time, size=(640, 480), camera=([13.6, 6.6, 8.6], [-0.1, 2.9, -0.5], [0, 1, 0]))
    picture.surface(strength, "strength", (0, 4), "tensile strength [MPa]", points=WHITE, bar=time == times[-1])
    picture.solid(bar, cp.STEEL, edge=[0.2, 0.24, 0.3])
    files.append(picture.save("strip"))
cp.strip(files, f"{run.pictures}/strip.png", 2)
