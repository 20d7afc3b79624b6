"""A strip of pictures of the rocking block: one swing from side to side and back, in seven pictures."""
import coplane_pictures as cp

run = cp.Run()
block, floor = run.blocks("block"), run.blocks("floor")
files = []
for time in run.nearest(0, 0.25, 0.375, 0.5, 0.75, 1.0, 1.15):
    picture = cp.Picture(run, time, size=(230, 330), box=(-0.35, 0.65, -0.12, 1.31))
    picture.solid(floor, cp.STEEL, edges=False)
    picture.solid(block, cp.BRICK)
    if run.has_planes():
        picture.dots(size=7)
    files.append(picture.save("block"))
cp.strip(files, f"{run.pictures}/strip.png", 7)
