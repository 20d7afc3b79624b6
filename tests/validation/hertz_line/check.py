"""A cylinder and a ball pressed on a flat (Hertz): largest pressure and half width for the load that is carried; the same by CalculiX on the same meshes."""

import math
import sys

import numpy
from coplanetest import ValidationCase, calculix, meshes

case = ValidationCase(__file__)
RADIUS, MODULUS = 0.05, 200e9 / (1 - 0.3**2)
FOLDER = "tests/verification/V19_hertz_line/"
DOWN = 0.82 * 4e-5 / 2  # way of the flat top [m], as the deck prescribes it


def hertz(load, ball=False):
    """Half width [m] and largest pressure [Pa] for a load per length [N/m]; of a ball radius of the contact and largest pressure for a load [N]."""
    if ball:
        radius = (3 * load * RADIUS / (4 * MODULUS)) ** (1 / 3)
        return radius, 3 * load / (2 * math.pi * radius**2)
    return math.sqrt(4 * load * RADIUS / (math.pi * MODULUS)), math.sqrt(load * MODULUS / (math.pi * RADIUS))


def half_way(load, radii, pressures):
    """Pressure over Hertz' where a ball touches, nearest to half of the radius of contact."""
    radius, peak = hertz(load, ball=True)
    at = numpy.argmin(abs(numpy.asarray(radii) - radius / 2))
    return float(pressures[at] / (peak * math.sqrt(1 - (radii[at] / radius) ** 2)))


def right_half(path):
    """The mesh without what lies at x < 0, with a node set `axis`: the section of a ball."""
    mesh = meshes.read(path)
    for block in mesh.blocks:
        inside = mesh.points[block.nodes][:, :, 0].mean(axis=1) > 0
        block.attributes = {name: values[inside] for name, values in block.attributes.items()}
        block.nodes = block.nodes[inside]
    used = numpy.unique(numpy.concatenate([block.nodes.ravel() for block in mesh.blocks]))
    number = numpy.full(len(mesh.points), -1)
    number[used] = numpy.arange(len(used))
    for block in mesh.blocks:
        block.nodes = number[block.nodes]
    mesh.points = mesh.points[used]
    mesh.points[numpy.abs(mesh.points[:, 0]) < 1e-12, 0] = 0
    mesh.node_sets = {name: number[nodes][number[nodes] >= 0] for name, nodes in mesh.node_sets.items()}
    mesh.node_sets["axis"] = numpy.flatnonzero(mesh.points[:, 0] == 0)
    meshes.write(mesh, path)


def press(name, cell=67e-6, ball=False):
    recipe, deck = case.load(FOLDER + "mesh.yaml"), case.load(FOLDER + "deck.yaml")
    recipe["parts"][0]["fine"] = cell
    recipe["parts"][1].update(min=[-2e-3, -cell], size=[4e-3, cell], divisions=[2 * round(2e-3 / cell), 1])
    recipe["parts"][1].pop("max")
    if ball:
        deck["geometry"] = "axisymmetric"
        deck["conditions"].append({"type": "fixed", "node_set": "axis", "components": ["x"]})
    # Forces of rings along the axis cancel to round-off, not digit by digit: it adds up over thousands of cycles.
    run, spent = case.timed(name, recipe, deck, energy=2e-3, **({"edit_mesh": right_half, "momentum": 1e-11} if ball else {}))
    planes = run.planes()
    on = planes["area"] > 0
    x, pressure, area = planes["Points"][on, 0], planes["normal_traction"][on], planes["area"][on]
    load = float(numpy.sum(pressure * area))
    lines = sum(1 for part in ("deck.yaml", "mesh.yaml") for line in (case.source.parents[2] / FOLDER / part).read_text().splitlines() if line and line[0] != "#")
    if ball:
        return dict(load=load, width=x.max() + 0.5 * cell, peak=pressure.max(), half_way=half_way(load, x, pressure)), run, spent, lines
    return dict(load=load, width=0.5 * (x.max() - x.min() + cell), peak=pressure.max()), run, spent, lines


def theirs(name, run, cell, ball=False):
    """CalculiX on the mesh of our run: plane strain (CPE4) or a body of revolution (CAX4), static, the same way of the top."""
    results, deck = run.results, calculix.Input()
    points = results.coordinates
    deck.mesh = ["*NODE, NSET=NALL", *(f"{i + 1}, {p[0]:.11e}, {p[1]:.11e}, 0." for i, p in enumerate(points))]
    number, sides = 0, {}
    for block in ("cylinder", "flat"):
        deck.mesh.append(f"*ELEMENT, TYPE={'CAX4' if ball else 'CPE4'}, ELSET=E{block}")
        sides[block] = []
        for corners in results.connectivity(block):
            number += 1
            deck.mesh.append(f"{number}, " + ", ".join(str(c + 1) for c in corners))
            for s in range(4):
                a, b = points[corners[s]], points[corners[(s + 1) % 4]]
                low = all(abs(p[0]) < 1.5e-3 and abs(math.hypot(p[0], p[1] - RADIUS) - RADIUS) < 1e-9 + 1e-3 * cell for p in (a, b))
                if (block == "cylinder" and low) or (block == "flat" and abs(a[1]) < 1e-12 and abs(b[1]) < 1e-12):
                    sides[block].append((number, s + 1))
        deck.mesh += [f"*SURFACE, NAME=S{block}", *(f"{e}, S{s}" for e, s in sides[block])]
    top = numpy.flatnonzero((numpy.abs(points[:, 1] - RADIUS) < 1e-9)) + 1
    flat = results.nodes_of("flat") + 1
    held = numpy.flatnonzero(points[:, 0] == 0) + 1 if ball else top  # across
    for words, nodes in (("TOP", top), ("FLAT", flat), ("HELD", held)):
        deck.mesh += [f"*NSET, NSET=N{words}", *(f"{n}," for n in nodes)]
    deck.say(f"""
        *MATERIAL, NAME=STEEL
        *ELASTIC
        200e9, 0.3
        *SOLID SECTION, ELSET=Ecylinder, MATERIAL=STEEL
        1.
        *SOLID SECTION, ELSET=Eflat, MATERIAL=STEEL
        1.
        *SURFACE INTERACTION, NAME=TOUCH
        *SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
        1.5e16
        *CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE
        Scylinder, Sflat
        *BOUNDARY
        NFLAT, 1, 2
        NHELD, 1, 1
        *STEP, NLGEOM, INC=1000
        *STATIC
        0.02, 1.
        *BOUNDARY
        NTOP, 2, 2, {-DOWN!r}
        *NODE PRINT, NSET=NTOP, TOTALS=ONLY, FREQUENCY=10000
        RF
        *CONTACT PRINT, FREQUENCY=10000
        CSTR
        *END STEP""")
    spent = deck.run(name, timeout=240)
    if spent is None:
        return None, None, len(deck.own)
    tables = calculix.printed(name)
    load = -next(rows[0, 1] for words, _, _, rows in tables if words.startswith("total force"))
    stresses = next(rows for words, _, _, rows in tables if words.startswith("contact stress"))
    pressed = set(stresses[stresses[:, 2] > 0, 0].astype(int))
    corners = numpy.concatenate([results.connectivity(block) for block in ("cylinder", "flat")])
    x = numpy.array([points[corners[e - 1][[s - 1, s % 4]], 0].mean() for e, s in sides["cylinder"] if e in pressed])
    if ball:
        # CalculiX makes a wedge of 2 degrees of it. The face at the axis, which is no quadrilateral then, gets no pressure, and the next one too much.
        pressure = [stresses[(stresses[:, 0] == e) & (stresses[:, 2] > 0), 2].mean() for e, _ in sides["cylinder"] if e in pressed]
        return dict(load=180 * load, width=x.max() + 0.5 * cell, half_way=half_way(180 * load, x, pressure)), spent, len(deck.own)
    return dict(load=load, width=0.5 * (x.max() - x.min() + cell), peak=stresses[:, 2].max()), spent, len(deck.own)


CELL = 67e-6 if case.full else 134e-6
found, run, spent, lines = press("pressed", CELL)
width, peak = hertz(found["load"])
case.check("largest pressure over Hertz'", found["peak"] / peak, 1, 0.05)
case.check("half width less Hertz' [m]", found["width"] - width, 0, CELL)
case.check_within("load that the planes carry [N/m]", found["load"], 0.9e6, 1.1e6)
case.picture(run, "--color", "von_mises", "--shares", "1", "--window", "-0.003", "0.003", "-0.0003", "0.004", "--blocks", "cylinder", "--size", "800", "620")
ball, ball_run, ball_spent, lines = press("ball", 134e-6, ball=True)
width, peak = hertz(ball["load"], ball=True)
case.check("ball: largest pressure over Hertz'", ball["peak"] / peak, 1, 0.05)
case.check("ball: radius of the contact less Hertz' [m]", ball["width"] - width, 0, 134e-6)


def tell(code, found, spent, lines, ball=False):
    width, peak = hertz(found["load"], ball)
    words = "ball: " if ball else ""
    if "peak" in found:
        case.other(f"{words}largest pressure over Hertz' of the load carried", code, found["peak"] / peak, 1.0, spent, lines)
    if ball:
        case.other("ball: pressure half way out over Hertz' of the load carried", code, found["half_way"], 1.0, spent, lines)
    case.other(f"{words}{'radius' if ball else 'half width'} over Hertz' of the load carried", code, found["width"] / width, 1.0, spent, lines)
    case.other(f"{words}load {'' if ball else 'per length '}for the same way of the top [N{'' if ball else '/m'}]", code, found["load"], None, spent, lines)


if case.full:
    tell("Coplane, cells of 67 um, dynamic with damping", found, spent, lines)
    tell("Coplane, cells of 134 um, dynamic with damping", ball, ball_spent, lines, ball=True)
if not calculix.found():
    print("CalculiX was not tried: ccx is not installed (apt-get install calculix-ccx)", file=sys.stderr)
elif case.full:
    theirs_found, spent, lines = theirs("calculix", run, 67e-6)
    if theirs_found:
        tell("CalculiX 2.20, the same mesh, static", theirs_found, spent, lines)
    else:
        case.other("the run", "CalculiX 2.20", "ended with an error", None, None, lines)
    theirs_found, spent, lines = theirs("calculix_ball", ball_run, 134e-6, ball=True)
    if theirs_found:
        tell("CalculiX 2.20, the same mesh, static", theirs_found, spent, lines, ball=True)
    else:
        case.other("ball: the run", "CalculiX 2.20", "ended with an error", None, None, lines)
if case.full:
    for cell in (134e-6, 67e-6):
        found, run, spent, lines = press(f"cell_{1e6 * cell:.0f}", cell)
        width, peak = hertz(found["load"])
        case.study("largest pressure over Hertz'", f"{1e6 * cell:.0f} um, {width / cell:.0f} in the half width", found["peak"] / peak, 1.0, spent)
        case.study("half width over Hertz'", f"{1e6 * cell:.0f} um, {width / cell:.0f} in the half width", found["width"] / width, 1.0, spent)
case.finish()
