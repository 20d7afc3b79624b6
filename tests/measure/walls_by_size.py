#!/usr/bin/env python3
"""What comes out of the bar and the wall, or of the projectile and the wall, at several sizes of elements, side by side.

    python3 tests/measure/walls_by_size.py RUN ...

RUN: folders of exodus_inputs/run.py, all of bar_wall_3d or all of projectile_wall_2d, run to their end: build/examples/bar_wall_3d/S and M, say. Prints the
tables under "Resolution" in docs/examples/bar-wall.md and projectile.md. Energies are over the initial one, or over what the projectile lost.
"""

import json
import pathlib
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "exodus_inputs"))
from coplanetools import EndedRun, documents


class Wall:
    """A run with its history and results."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.size = json.loads((self.folder / "example.json").read_text())["size"]
        if (end := json.loads((self.folder / "run.run.json").read_text())["ending"]) != "completed":
            sys.exit(f"{folder}: the run is {end}; run it to its end first")
        self.run = EndedRun(self.folder, 0, "")
        self.history, self.results = self.run.history, self.run.results
        brick = documents.load(self.folder / "mesh.yaml")["parts"][0]
        self.h = brick["brick"][0] / brick["divisions"][0]
        self.three = len(brick["divisions"]) == 3

    def at(self, column, time):
        return float(numpy.interp(time, self.history["time"], self.history[column]))

    def step(self, time):
        return int(numpy.argmin(numpy.abs(self.results.times - time)))

    def deepest(self):
        planes = [self.run.series.fields(step) for step in range(len(self.run.series))]
        large = [p["closure"][p["area"] > 0.01 * (self.h**2 if self.three else self.h)] for p in planes]
        return max(float(closures.max()) for closures in large if closures.size)

    def shared(self):
        h = self.history
        remainder = h["contact_remainder"][numpy.argmax(numpy.abs(h["contact_remainder"]))]
        yield "elements in the wall, cycles", f"{len(self.results.connectivity('bricks'))}, {int(h['cycle'][-1])}"
        yield "hourglass over largest internal energy", f"{numpy.abs(h['hourglass']).max() / numpy.abs(h['internal']).max():.2%}"
        yield "energy balance; contact remainder, over the initial energy", f"{numpy.abs(h['error']).max() / h['initial'][-1]:.1e}; {remainder / h['initial'][-1]:+.1e}"
        yield "deepest penetration over h", f"{self.deepest() / self.h:.2f}"
        yield "planes at the start, most; contacts missed", f"{int(h['planes'][0])}, {int(h['planes'].max())}; {int(h['missed'][-1])}"
        yield "dead elements, their mass [kg, or kg/m]", f"{int(h['eroded_elements'][-1])}, {h['eroded_mass'][-1]:.4g}"

    def bar(self):
        h, results, start = self.history, self.results, self.history["initial"][-1]
        nodes = results.nodes_of("bricks")
        x, y = results.coordinates[nodes].T[:2]
        middle, corners = (numpy.abs(x) < 1) & (y > 2.2) & (y < 3.8), (numpy.abs(x) > 2.5) & (y < 1)
        steps = [self.step(time) for time in (18.3e-3, 41e-3)]
        yield "speed of the bar at 1.3, 10, 18.3 and 41 ms [m/s]", ", ".join(f"{self.at('bar_velocity_z', t):.1f}" for t in (1.3e-3, 0.01, 18.3e-3, 0.041))
        yield "fastest brick at 18.3 and 41 ms [m/s]", ", ".join(f"{results.nodal('velocity_z', s)[nodes][middle].max():.0f}" for s in steps)
        yield "farthest brick in the middle [m]", ", ".join(f"{results.nodal('displacement_z', s)[nodes][middle].max():.2f}" for s in steps)
        yield "motion of the lower corners [mm]", ", ".join(f"{1e3 * numpy.abs(results.nodal('displacement_z', s)[nodes][corners]).max():.1f}" for s in steps)
        yield "friction", f"{h['contact_friction'][-1] / start:.1%}"
        for time in (18.3e-3, 41e-3):
            yield f"damage in living and in dead elements at {1e3 * time:g} ms", f"{self.at('plastic', time) / start:.1%}, {self.at('eroded', time) / start:.1%}"
        yield "bending that has flowed, at 10 and 41 ms", f"{self.at('plastic_bending', 0.01) / start:.2%}, {h['plastic_bending'][-1] / start:.2%}"
        yield "largest plastic strain of the bar", f"{results.element('bar', 'equivalent_plastic_strain').max():.3f}"

    def projectile(self):
        h, results = self.history, self.results
        speed = h["projectile_velocity_x"]
        lost = h["kinetic"][0] * (1 - (speed[-1] / speed[0]) ** 2)
        step = self.step(0.8e-3)
        damage, centre = results.element("bricks", "damage", step), results.centres("bricks")
        corners = (results.coordinates + results.nodal("displacement", step))[results.connectivity("bricks")]
        edges = numpy.linalg.norm(corners - numpy.roll(corners, 1, axis=1), axis=2).max(axis=1)
        alive = results.element("bricks", "alive", step) > 0.5
        yield "residual speed [m/s]", f"{speed[-1]:.2f}"
        yield "bending that has flowed", f"{h['plastic_bending'][-1] / lost:.1%}"
        yield "friction", f"{h['contact_friction'][-1] / lost:.1%}"
        yield "damage in living and in dead elements", f"{h['plastic'][-1] / lost:.1%}, {h['eroded'][-1] / lost:.1%}"
        yield "mean damage in front of the projectile", f"{damage[numpy.abs(centre[:, 1]) < 0.0125].mean():.2f}"
        yield "longest edge of a living damaged element [mm]", f"{1e3 * edges[alive & (damage > 0.99)].max():.1f}"

    def rows(self):
        yield from self.bar() if self.three else self.projectile()
        yield from self.shared()


walls = [Wall(folder) for folder in sys.argv[1:]]
print("| | " + " | ".join(f"{wall.size}, {1e3 * wall.h:g} mm" for wall in walls) + " |")
print("|---" * (len(walls) + 1) + "|")
for rows in zip(*(wall.rows() for wall in walls)):
    print(f"| {rows[0][0]} | " + " | ".join(value for _, value in rows) + " |")
