"""A strip of pictures of the column."""
import coplane_pictures as cp

run = cp.Run()
drums, capital, plate = run.blocks("drums"), run.blocks("capital"), run.blocks("plate")
end = run.times[-1]
files = []
for time in run.nearest(0, 0.4, 0.8, 1.2, 1.6, 2.0, 2.4, end):
    picture = cp.Picture(run, time, size=(400, 360), camera=((2.5, -14, 4.2), (1.2, 0, 1.6), (0, 0, 1)), angle=26)
    picture.solid(plate, [0.7, 0.7, 0.7], edges=False)
    picture.solid(drums, cp.BRICK)
    picture.solid(capital, cp.STEEL)
    files.append(picture.save("column"))
cp.strip(files, f"{run.pictures}/strip.png", 4)
