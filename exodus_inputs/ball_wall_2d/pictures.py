"""A strip of pictures of the wall: courses and the ball, and the points of contact."""
import coplane_pictures as cp

run = cp.Run()
bricks, base, ball = run.blocks("bricks"), run.blocks("base"), run.blocks("ball")
end = run.times[-1]
files = []
for time in run.nearest(0, 0.1 * end, 0.2 * end, 0.4 * end, 0.7 * end, end):
    picture = cp.Picture(run, time, size=(560, 300), box=(-0.6, 2.7, -0.15, 1.3))
    picture.solid(base, [0.7, 0.7, 0.7], edges=False)
    picture.solid(bricks, cp.BRICK, edge=[0.6, 0.58, 0.54])
    picture.solid(ball, cp.STEEL)
    if run.has_planes():
        picture.dots(size=4)
    files.append(picture.save("wall"))
cp.strip(files, f"{run.pictures}/strip.png", 3)
