"""A strip of pictures of the damage in the slab, with the half that is computed and its mirror image."""
import coplane_pictures as cp
from paraview.simple import Reflect

run = cp.Run()


def whole(block):
    return Reflect(Input=run.blocks(block), Plane="X", Center=0)


slab, projectile = whole("slab"), whole("projectile")
end = run.times[-1]
files = []
for time in run.nearest(0.2 * end, 0.4 * end, 0.6 * end, end):
    picture = cp.Picture(run, time, size=(420, 480), box=(-0.19, 0.19, -0.36, 0.08))
    last = time == run.nearest(end)[0]
    picture.surface(slab, "damage", (0, 1), bar=last, preset="Cool to Warm", edge=[0.5, 0.5, 0.5])
    picture.solid(projectile, cp.STEEL, edges=False)
    files.append(picture.save("damage"))
cp.strip(files, f"{run.pictures}/strip.png", 4)
