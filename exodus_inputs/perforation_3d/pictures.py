"""A strip of pictures of the damage in the quarter of the slab, seen from the axis."""
import coplane_pictures as cp

run = cp.Run()
slab, projectile = run.blocks("slab"), run.blocks("projectile")
end = run.times[-1]
files = []
for time in run.nearest(0.2 * end, 0.4 * end, 0.6 * end, end):
    picture = cp.Picture(run, time, size=(420, 400), camera=((-0.55, 0.25, -0.55), (0.09, -0.11, 0.09), (0, 1, 0)))
    last = time == run.nearest(end)[0]
    picture.surface(slab, "damage", (0, 1), bar=last, preset="Cool to Warm", edge=[0.5, 0.5, 0.5])
    picture.solid(projectile, cp.STEEL, edges=False)
    files.append(picture.save("damage"))
cp.strip(files, f"{run.pictures}/strip.png", 4)
