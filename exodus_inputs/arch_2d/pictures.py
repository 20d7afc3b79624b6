"""A strip of pictures of the arch: stones and the points where they touch. Dots on one side of a joint only are hinges."""
import coplane_pictures as cp

run = cp.Run()
stones, springings = run.blocks("arch"), run.blocks("springings")
end = run.times[-1]
files = []
for time in run.nearest(0, 0.6 * end, 0.8 * end, end):
    picture = cp.Picture(run, time, size=(460, 300), box=(-12, 12, -2, 11.5))
    picture.solid(springings, cp.STEEL, edges=False)
    picture.solid(stones, cp.BRICK)
    if run.has_planes():
        picture.dots(size=6)
    files.append(picture.save("arch"))
cp.strip(files, f"{run.pictures}/strip.png", 4)
