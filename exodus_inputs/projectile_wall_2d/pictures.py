"""Pictures of the projectile and the wall, as the paper's Figures 2 and 3: the wall's thickness runs to the right."""
import coplane_pictures as cp

run = cp.Run()
bricks, steel = run.blocks("bricks"), run.blocks("projectile")
strength = cp.computed(bricks, "strength", "4*(1-damage)")
VIEW = {"size": (1100, 700), "box": (-0.12, 0.35, -0.15, 0.15)}
# White where nothing is left of the strength.
WHITE = [(0, 1, 1, 1), (0.04, 1, 1, 1), (0.4, 0.75, 0.86, 0.95), (2, 0.35, 0.6, 0.82), (4, 0.1, 0.25, 0.55)]
for time in run.nearest(0, 0.2e-3, 0.4e-3, 0.8e-3, 2e-3):
    picture = cp.Picture(run, time, **VIEW)
    picture.solid(bricks, cp.BRICK, edge=[0.6, 0.58, 0.54])
    picture.solid(steel, cp.STEEL)
    picture.dots(run.planes(touching=False) if time == 0 else None, size=5)
    picture.save("contacts")
    picture = cp.Picture(run, time, **VIEW)
    picture.surface(strength, "strength", (0, 4), "tensile strength [MPa]", points=WHITE, edge=[0.5, 0.5, 0.5])
    picture.solid(steel, cp.STEEL)
    picture.save("strength")

# A strip like the paper's Figure 2.
files = []
for time in run.nearest(0, 0.8e-3, 2e-3):
    picture = cp.Picture(run, time, size=(560, 520), box=(-0.11, 0.28, -0.155, 0.17))
    picture.solid(bricks, cp.BRICK, edge=[0.6, 0.58, 0.54])
    picture.solid(steel, cp.STEEL)
    picture.dots(run.planes(touching=False) if time == 0 else None, size=4)
    files.append(picture.save("strip"))
cp.strip(files, f"{run.pictures}/strip.png", 3)
