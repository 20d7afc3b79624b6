#!/usr/bin/env python3
"""Contact of one revision of the program beside another, in tables: seams, corners, tumbling bodies, inclines.

    python3 tests/measure/contact_tables.py BEFORE/bin AFTER/bin [TABLE ...] > tables.md
    python3 tests/measure/contact_tables.py BEFORE/bin AFTER/bin examples [NAME/SIZE/VARIANT ...] > examples.md

With - for BEFORE/bin only the other program runs. Without names: all tables but the examples, some ten minutes on one core without the
boxes, which take longer than all others; so do the examples at size S. Works in a folder contact_tables of the working folder. Decks give
only keys that both revisions know.
"""

import itertools
import math
import os
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import numpy
from coplanetest import Case, examples

DENSITY, G = 2000.0, 9.81
SOFT = {"model": "linear_elastic", "density": DENSITY, "youngs_modulus": 1e8, "poisson_ratio": 0.2}
HARD = {**SOFT, "youngs_modulus": 4e9}


def box(block, low, size, divisions, **other):
    return {"shape": "box", "block": block, "min": low, "size": size, "divisions": divisions, **other}


class Runs:
    """The same run with both programs."""

    def __init__(self, folders):
        self.folders = folders
        self.case = Case("contact tables", __file__)
        self.count = 0

    def both(self, recipe, deck, **mesh):
        """Without a program before, its place has the run of the other one, whose cells `table` leaves out."""
        found = []
        for which, folder in enumerate(self.folders):
            if folder is None:
                continue
            os.environ["COPLANE_BIN"] = folder
            mine = {**deck, "time": dict(deck["time"])}
            self.count += 1
            run = self.case.attempt(f"{self.count}_{which}", recipe, mine, **mesh)
            found.append(run if run.code in (0, 6) else sys.exit(run.output[-2000:]))
        return found if len(found) == 2 else 2 * found


def lost(run):
    """What contact made or lost that no law accounts for, at most, over the energy in play."""
    h = run.history
    in_play = max(numpy.max(h["kinetic"]), numpy.max(numpy.abs(h["external_work"])))
    return float(numpy.max(numpy.abs(h["contact_remainder"])) / in_play)


def ended(run):
    return "" if run.code == 0 else f" (stopped with {run.code})"


def table(title, head, rows):
    print(f"\n## {title}\n\n| {' | '.join(head)} |\n|{'---|' * len(head)}")
    for row in rows:
        cells = ["–" if None in folders and name.endswith("before") else cell for name, cell in zip(head, row)]
        if not (None in folders and "before" in row):
            print(f"| {' | '.join(str(cell) for cell in cells)} |", flush=True)


def per_cent(value):
    return f"{100 * value:.3g} %"


# --- a block that slides over seams ------------------------------------------------------------------------------
def slider(dimension, parts, gap, step, friction, damping, stiffness):
    """A block on a fixed slab in so many parts, 3 m/s; every second part is lower by `step`."""
    length, low = 2.1, [0.0, -0.1] if dimension == 2 else [0.0, -0.1, -0.15]
    slab = []
    for i in range(parts):
        size = [length / parts, 0.1] if dimension == 2 else [length / parts, 0.1, 0.6]
        divisions = [42 // parts, 1] if dimension == 2 else [28 // parts, 1, 5]
        slab.append(box("slab", [low[0] + i * (length / parts + gap), low[1] - step * (i % 2), *low[2:]], size, divisions))
    rider = box("rider", [0.1, 0.0], [0.4, 0.1], [5, 2]) if dimension == 2 else box("rider", [0.1, 0.0, 0.0], [0.4, 0.1, 0.2], [4, 2, 3])
    recipe = {"dimension": dimension, "parts": [*slab, rider], "node_sets": {"slab": {"block": "slab"}}}
    deck = {
        "materials": {"soft": SOFT}, "blocks": {block: {"material": "soft"} for block in ("slab", "rider")},
        "joints": {"law": {"model": "linear", "normal_stiffness": stiffness, "friction": friction}},
        "contact": {"default_joint": "law", "damping": {"normal": damping}},
        "time": {"end": 0.4}, "gravity": [0.0, -G, 0.0], "conditions": [{"type": "fixed", "node_set": "slab"}],
        "initial": [{"block": "rider", "velocity": [3.0, 0.0, 0.0]}], "output": {"planes": False},
        "history": {"every": 4e-3, "probes": [{"name": "rider", "block": "rider"}]},
    }
    return recipe, deck


def seams(runs, dimension):
    stiffnesses, parts = (1e7, 1e9), 7
    seams = [("flush", 0, 0), ("1e-6 m open", 1e-6, 0), ("1e-4 m open", 1e-4, 0), ("steps of 1e-6 m", 0, 1e-6), ("steps of 1e-5 m", 0, 1e-5),
             ("steps of 1e-4 m", 0, 1e-4)]
    if dimension == 3:
        seams = [seams[0], seams[2], seams[5]]
    rows = []
    for friction, damping, stiffness in itertools.product((0.0, 0.6), (0.0, 0.5), stiffnesses):
        whole = runs.both(*slider(dimension, 1, 0, 0, friction, damping, stiffness))
        for name, gap, step in seams:
            cut = runs.both(*slider(dimension, parts, gap, step, friction, damping, stiffness))
            cells = []
            for one, other in zip(whole, cut):
                way, speed = ([float(run.history[f"rider_{what}_x"][-1]) for run in (one, other)] for what in ("displacement", "velocity"))
                cells += [per_cent((way[1] - way[0]) / way[0]), f"{speed[1]:.4f} / {speed[0]:.4f}", f"{lost(other):.1e}"]
            rows.append([name, friction, damping, f"{stiffness:.0e}", *cells])
    table(f"A block slides over {parts} slabs, in {dimension}D: way against that on one slab, speed over seams / on one slab [m/s], remainder",
          ["seam", "friction", "damping", "stiffness [Pa/m]", *(f"{what}, {when}" for when in ("before", "after") for what in ("way", "speed", "remainder"))], rows)


# --- corners --------------------------------------------------------------------------------------------------
def corner(tilt, off, speed, rigid):
    """A square is thrown with a corner on two flush slabs, `off` beside their seam."""
    recipe = {
        "dimension": 2,
        "parts": [box("slab", [-0.6, -0.1], [0.6, 0.1], [6, 1]), box("slab", [0.0, -0.1], [0.6, 0.1], [6, 1]), box("rider", [0.0, 10.0], [0.2, 0.2], [4, 4])],
        "node_sets": {"slab": {"block": "slab"}},
    }

    def place(x):
        mine = x[:, 1] > 5
        c, s = math.cos(math.radians(tilt)), math.sin(math.radians(tilt))
        square = (x[mine] - [0.1, 10.1]) @ numpy.array([[c, s], [-s, c]])
        x[mine] = square - square[numpy.argmin(square[:, 1])] + [off, 1e-4 * speed]
        return x

    card = {"material": "hard", "rigid": True} if rigid else {"material": "hard"}
    deck = {
        "materials": {"hard": HARD}, "blocks": {"slab": {"material": "hard"}, "rider": card},
        "time": {"end": 0.01 + 0.02 / speed}, "conditions": [{"type": "fixed", "node_set": "slab"}],
        "initial": [{"block": "rider", "velocity": [0.3 * speed, -speed, 0.0]}], "viscosity": {"linear": 0, "quadratic": 0},
        "output": {"planes": False}, "history": {"every": 1e-4, "probes": [{"name": "rider", "block": "rider"}]},
    }
    return recipe, deck, place


def corners(runs):
    rows = []
    for rigid in (False, True):
        tilts, offs, speeds = (5, 15, 25, 35, 45, 60), (0.0, 1e-3, -5e-3), (0.5, 2.0, 8.0, 20.0)
        remainders, stops = ([], []), [0, 0]
        for tilt, off, speed in itertools.product(tilts, offs, speeds):
            recipe, deck, place = corner(tilt, off, speed, rigid)
            for which, run in enumerate(runs.both(recipe, deck, change_mesh=place)):
                remainders[which].append(lost(run))
                stops[which] += run.code != 0
        cells = []
        for which in (0, 1):
            r = numpy.array(remainders[which])
            cells += [f"{numpy.median(r):.1e}", f"{numpy.quantile(r, 0.9):.1e}", f"{numpy.max(r):.1e}", stops[which]]
        rows.append(["rigid" if rigid else "elastic", len(remainders[0]), *cells])
    table("Corners on two flush slabs: 6 tilts, 3 places, 4 speeds from 0.5 to 20 m/s; remainder over kinetic energy",
          ["square", "collisions", *(f"{what}, {when}" for when in ("before", "after") for what in ("median", "9 of 10 below", "largest", "stopped"))], rows)


def near_end(tilt, end):
    """A soft square falls with a corner on a rigid slab that ends so far to the left of it."""
    recipe, deck, place = corner(tilt, 0.0, 1.0, False)
    recipe["parts"][:2] = [box("slab", [-end, -0.1], [end + 0.6, 0.1], [6, 1])]
    deck["materials"]["hard"] = SOFT
    deck["blocks"]["slab"]["rigid"] = True
    deck["conditions"] = [{"type": "rigid_motion", "block": "slab", "velocity": [0, 0, 0], "angular_velocity": [0, 0, 0]}]
    deck["initial"][0]["velocity"] = [0.0, -1.0, 0.0]
    return recipe, deck, place


def ends(runs):
    rows = []
    for tilt in (-60, -40, -20, 20, 40):
        cells = []
        for end in (0.6, 9e-3, 3e-3):
            recipe, deck, place = near_end(tilt, end)
            cells.append([f"{lost(run):.1e}{ended(run)}" for run in runs.both(recipe, deck, change_mesh=place)])
        rows.append([tilt, *(cells[i][which] for which in (0, 1) for i in range(3))])
    table("A corner falls near the end of a slab, 1 m/s: remainder over kinetic energy, by the distance of the end",
          ["tilt [degrees]", *(f"{end}, {when}" for when in ("before", "after") for end in ("0.6 m", "9 mm", "3 mm"))], rows)


# --- bodies thrown on floors --------------------------------------------------------------------------------------
def thrown(shape, floor):
    sizes = {"cube": [0.2, 0.2, 0.2], "plank": [0.5, 0.06, 0.15]}
    if shape in sizes:
        size = sizes[shape]
        part = box("rider", [-s / 2 for s in size], size, [max(2, round(s / 0.08)) for s in size], rotate=[25, 10, 35], about=[0.0, 0.0, 0.0],
                   offset=[0.0, 0.5 * sum(size), 0.0])
    else:  # a wedge with a triangle as base, in tetrahedra; in a tetrahedron the upper triangle is small
        top = 1.0 if shape == "prism" else 0.05
        base = [[-0.15, 0.0, -0.1], [-0.15, 0.0, -0.1 + 0.01], [0.15, 0.0, 0.0], [0.0, 0.0, 0.2]]
        base = [[-0.15, 0.0, -0.1], [-0.02, 0.0, 0.15], [0.02, 0.0, 0.15], [0.15, 0.0, -0.1]]
        part = {"shape": "hexahedron", "block": "rider", "corners": base + [[top * x, 0.25, top * z] for x, _, z in base], "divisions": [2, 2, 2],
                "split": "tetrahedra", "rotate": [25, 10, 35], "about": [0.0, 0.0, 0.0], "offset": [0.0, 0.25, 0.0]}
    low, size = [-0.6, -0.1, -0.6], [1.2, 0.1, 1.2]
    floors = {
        "one slab": [box("slab", low, size, [8, 1, 8])],
        "four flush slabs": [box("slab", [x, -0.1, z], [0.6, 0.1, 0.6], [4, 1, 4]) for x in (-0.6, 0.0) for z in (-0.6, 0.0)],
        "slabs of other meshes": [box("slab", [-0.6, -0.1, -0.6], [0.6, 0.1, 1.2], [3, 1, 7]), box("slab", [0.0, -0.1, -0.6], [0.6, 0.1, 1.2], [5, 1, 4])],
        "steps of 1 mm": [box("slab", [x, -0.1 - 1e-3 * (x == 0), -0.6], [0.6, 0.1, 1.2], [4, 1, 8]) for x in (-0.6, 0.0)],
        "tetrahedra": [box("slab", low, size, [6, 1, 6], split="tetrahedra")],
    }
    recipe = {"dimension": 3, "parts": [*floors[floor], part], "node_sets": {"slab": {"block": "slab"}}}

    def place(x):
        mine = x[:, 1] > 1e-9
        x[mine, 1] += 2e-3 - x[mine, 1].min()
        return x

    deck = {
        "materials": {"hard": HARD}, "blocks": {block: {"material": "hard"} for block in ("slab", "rider")},
        "joints": {"law": {"model": "linear", "normal_stiffness": 5e9, "friction": 0.4}}, "contact": {"default_joint": "law"},
        "time": {"end": 0.03}, "gravity": [0.0, -G, 0.0], "conditions": [{"type": "fixed", "node_set": "slab"}],
        "initial": [{"block": "rider", "velocity": [1.0, -4.0, 0.5], "angular_velocity": [3.0, 5.0, -4.0], "center": [0.0, 0.2, 0.0]}],
        "output": {"planes": False}, "history": {"every": 3e-4, "probes": [{"name": "rider", "block": "rider"}]},
    }
    return recipe, deck, place


def floors(runs):
    rows = []
    for shape in ("cube", "plank", "prism", "tetrahedron"):
        for floor in ("one slab", "four flush slabs", "slabs of other meshes", "steps of 1 mm", "tetrahedra"):
            recipe, deck, place = thrown(shape, floor)
            rows.append([shape, floor, *(f"{lost(run):.1e}{ended(run)}" for run in runs.both(recipe, deck, change_mesh=place))])
    table("Bodies thrown on floors, 4 m/s, with spin and friction 0.4: remainder over kinetic energy", ["body", "floor", "before", "after"], rows)


# --- a box of blocks ------------------------------------------------------------------------------------------------
def tumbling(end, factor, start=0):
    """Nine blocks fly in a box without friction, damping or viscosity: all energy can come back. The law has an energy
    of its own, so that what is lost is lost by contact. `start`: which of several first motions.
    """
    walls = [box("walls", [-0.1, -0.1], [1.4, 0.1], [7, 1]), box("walls", [-0.1, 1.2], [1.4, 0.1], [7, 1]), box("walls", [-0.1, 0.0], [0.1, 1.2], [1, 6]),
             box("walls", [1.2, 0.0], [0.1, 1.2], [1, 6])]
    names, parts, initial = [], [], []
    for i, j in itertools.product(range(3), range(3)):
        name = f"block_{i}{j}"
        names.append(name)
        center = [0.2 + 0.4 * i, 0.2 + 0.4 * j]
        parts.append(box(name, [center[0] - 0.08, center[1] - 0.08], [0.16, 0.16], [2, 2], rotate=13.0 * (i + 2 * j), about=center))
        initial.append({"block": name, "velocity": [1.5 * math.cos(7 * i + 3 * j + start), 1.5 * math.sin(5 * i + 11 * j + start), 0.0],
                        "angular_velocity": [0.0, 0.0, 3.0 * math.cos(i - 2 * j)], "center": [*center, 0.0]})
    recipe = {"dimension": 2, "parts": [*walls, *parts], "node_sets": {"walls": {"block": "walls"}}}
    deck = {
        "materials": {"soft": {**SOFT, "model": "neo_hookean"}}, "blocks": {name: {"material": "soft"} for name in ("walls", *names)},
        "time": {"end": end, "step_factor": factor, "energy_tolerance": 1e9}, "conditions": [{"type": "fixed", "node_set": "walls"}], "initial": initial,
        "viscosity": {"linear": 0, "quadratic": 0}, "output": {"planes": False}, "history": {"every": end / 1000},
    }
    return recipe, deck


def boxes(runs):
    """One motion is no measure: each run goes another way after some bounces. So several of them; fewer where they are long."""
    rows = []
    for end, factor, motions in ((2, 0.8, 8), (2, 0.4, 8), (2, 0.2, 8), (2, 0.1, 4), (10, 0.8, 4), (10, 0.4, 4), (10, 0.2, 2)):
        found = [[], []]
        for start in range(motions):
            for which, run in enumerate(runs.both(*tumbling(end, factor, start))):
                found[which].append(lost(run))
        rows.append([end, factor, motions, *(f"{f(numpy.array(values)):.1e}" for values in found for f in (numpy.median, numpy.max))])
    table("Nine blocks in a box: remainder over the largest kinetic energy, of several first motions",
          ["time [s]", "step factor", "motions", *(f"{what}, {when}" for when in ("before", "after") for what in ("median", "largest"))], rows)


# --- inclines -----------------------------------------------------------------------------------------------------
def incline(parts):
    """A block slides down 30 degrees with friction 0.3 (gravity is turned)."""
    c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
    recipe, deck = slider(2, parts, 0, 0, 0.3, 0.5, 1e7)
    deck["gravity"] = [G * s, -G * c, 0.0]
    deck["initial"] = []
    deck["time"] = {"end": 0.6}
    return recipe, deck, 0.5 * G * (s - 0.3 * c) * 0.6**2


def inclines(runs):
    rows = []
    for parts in (1, 2, 7):
        recipe, deck, way = incline(parts)
        rows.append([parts, *(per_cent(float(run.history["rider_displacement_x"][-1]) / way - 1) for run in runs.both(recipe, deck))])
    table("A block slides down an incline: way against g (sin - friction cos) t^2 / 2", ["slabs", "before", "after"], rows)


# --- examples -----------------------------------------------------------------------------------------------------
SHOWN = ["rocking_block_2d/S", "arch_2d/S", "arch_2d/S/falls", "column_3d/S", "column_3d/S/stands", "ball_wall_2d/S", "projectile_wall_2d/S", "bar_wall_3d/S", "jointed_rock_2d/S",
         "explosion_3d/S"]  # fmt: skip
PARTS = ("contact_friction", "contact_hysteresis", "contact_fracture", "contact_damping")


def whole(deck):
    """Values in place of their names: the first release has no `define`."""
    named = {name: f"({value!r})" for name, value in deck.pop("define", {}).items()}

    def put(value):
        if isinstance(value, dict):
            return {key: put(item) for key, item in value.items()}
        if isinstance(value, list):
            return [put(item) for item in value]
        if isinstance(value, str):
            for name, number in named.items():
                value = re.sub(rf"(?<![\w.]){name}(?![\w(])", number, value)
        return value

    return put(deck) if named else deck


def largest(values):
    return float(values[numpy.argmax(numpy.abs(values))])


def shown(runs, names):
    rows = []
    for name in names:
        recipe, deck, _ = examples.sized(*name.split("/"))
        deck = whole(deck)
        deck["output"]["planes"] = False
        for when, run in zip(("before", "after"), runs.both(recipe, deck)):
            h, record = run.history, run.record
            in_play = max(h["initial"][-1], *(numpy.abs(h[column]).max() for column in ("kinetic", "internal", "external_work")))
            internal = numpy.abs(h["internal"]).max()
            parts = [f"{largest(h[part]) / in_play:.1e}" for part in PARTS if part in h]
            rows.append([name.replace("/", " "), when + ended(run), f"{largest(h['contact_stored']) / in_play:.1e}", *parts, f"{largest(h['contact_remainder']) / in_play:.1e}",
                         f"{100 * numpy.abs(h['hourglass']).max() / internal:.2g} %" if internal > 0 else "rigid", f"{record['wall_seconds']:.0f}"])  # fmt: skip
            print(f"{name} {when}: {rows[-1]}", file=sys.stderr, flush=True)
    table("Examples: parts of the work of contact and the remainder, each at its largest over the energy in play; hourglass energy over the largest internal one",
          ["example", "", "stored", "friction", "hysteresis", "fracture", "damping", "remainder", "hourglass", "seconds"], rows)  # fmt: skip


TABLES = {"seams_2d": lambda runs: seams(runs, 2), "seams_3d": lambda runs: seams(runs, 3), "corners": corners, "ends": ends, "floors": floors, "boxes": boxes,
          "inclines": inclines}
if __name__ == "__main__":
    folders = [None if folder == "-" else os.path.abspath(folder) for folder in sys.argv[1:3]]
    if len(folders) != 2:
        sys.exit(__doc__)
    wanted = sys.argv[3:] or [*TABLES]
    work = pathlib.Path("contact_tables")
    work.mkdir(exist_ok=True)
    os.chdir(work)
    if wanted[0] == "examples":
        os.environ["COPLANE_BIN"] = folders[1]
        names, wanted = wanted[1:] or SHOWN, ["examples"]
        TABLES["examples"] = lambda runs: shown(runs, names)
    for name in wanted:
        pathlib.Path(name).mkdir(exist_ok=True)
        os.chdir(name)
        TABLES[name](Runs(folders))
        os.chdir("..")
