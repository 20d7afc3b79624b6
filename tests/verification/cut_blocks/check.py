"""Blocks that joints cut out of a domain: counts, volumes, areas, equilibrium."""

import json
import math
import pathlib
import re
import sys

import numpy
from coplanetest import Case, meshes
from coplanetools import program

case = Case("cut blocks", __file__)
full = "all" in sys.argv[1:]
if not pathlib.Path(program.binary("coplane_mesh_blocks")).exists():
    print("skipped: built without Gmsh, Voro++ or Assimp, so there is no `coplane_mesh blocks`")
    sys.exit(77)


def cut(name, recipe):
    """Makes the mesh; returns what the program said, and what it says of the mesh."""
    mesh = pathlib.Path(f"{name}.e").resolve()
    said = program.make_mesh({"seed": 3, **recipe}, str(mesh))
    found = re.search(r"(\d+) parts between joints, of (\S+) to (\S+) m", said)
    joints = {joint: float(area) for joint, area in re.findall(r"^joint '(.*)': (\S+) m", said, re.M)}
    blocks = {block: float(size) for block, size in re.findall(r"block \d+ '(.*?)': .*(?:area|volume) (\S+) m", said)}
    return {"said": said, "mesh": mesh, "parts": int(found[1]), "least": float(found[2]), "most": float(found[3]), "joints": joints, "blocks": blocks,
            "bodies": int(re.search(r"(\d+) bodies that share no node", said)[1])}


def close(what, values, references, tolerance):
    """Each of several numbers; the largest difference counts."""
    case.check(what, max(abs(value - reference) for value, reference in zip(values, references)), 0, tolerance)


def lone_faces(made):
    """Faces of joints without a partner: none may be."""
    return len(re.findall("have no partner", made["said"]))


# --- sets at right angles: everything is counted ------------------------------------------------------------
flat = {"dimension": 2, "domain": {"box": {"min": [0, 0], "max": [8, 6]}}, "elements": {"size": 0.5},
        "joints": {"steep": {"set": {"angle": 90, "spacing": 2, "through": [2, 0]}}, "level": {"set": {"angle": 0, "spacing": 1.5, "through": [0, 1.5]}}}}
solid = {"dimension": 3, "domain": {"box": {"min": [0, 0, 0], "max": [8, 6, 4]}}, "elements": {"size": 1},
         "joints": {"x": {"set": {"dip": 90, "dip_direction": 90, "spacing": 2, "through": [2, 0, 0]}},
                    "y": {"set": {"dip": 90, "dip_direction": 0, "spacing": 2, "through": [0, 2, 0]}},
                    "z": {"set": {"dip": 0, "dip_direction": 0, "spacing": 2, "through": [0, 0, 2]}}}}
for name, recipe, count, size, areas in (("flat", flat, 16, 3, {"steep": 18, "level": 24}), ("solid", solid, 24, 8, {"x": 72, "y": 64, "z": 48})):
    for shape in ("simplices", "cubes"):
        made = cut(f"{name}_{shape}", {**recipe, "elements": {**recipe["elements"], "shape": shape}})
        what = f"{name}, {shape}"
        case.check_equal(f"{what}: blocks, bodies", [made["parts"], made["bodies"]], [count, count])
        close(f"{what}: volume of each", [made["least"], made["most"]], [size, size], 1e-9 * size)
        close(f"{what}: areas of joints", [made["joints"][joint] for joint in areas], list(areas.values()), 1e-9 * 72)
        case.check(f"{what}: volume of the mesh", made["blocks"]["rock"], count * size, 1e-9 * count * size)
        case.check_equal(f"{what}: faces without partner", lone_faces(made), 0)

# --- the same seed, the same file; another, other blocks -----------------------------------------------------
scattered = {"dimension": 3, "domain": {"box": {"min": [0, 0, 0], "max": [6, 5, 4]}}, "elements": {"size": 1},
             "joints": {"bedding": {"set": {"dip": 15, "dip_direction": 200, "spacing": 1.5, "spacing_scatter": 0.3, "fisher": 200}},
                        "cross": {"set": {"dip": 80, "dip_direction": 100, "spacing": 2, "fisher": 100}}}}
once, again, other = cut("once", scattered), cut("again", scattered), cut("other", {**scattered, "seed": 4})
summary = [made["said"].replace(made["mesh"].name, "") for made in (once, again, other)]
case.check_equal("the same seed: everything said is the same", summary[0] == summary[1], True)
case.check_equal("another seed: other blocks", summary[0] != summary[2], True)
for made, name in ((once, "scattered"), (other, "another seed")):
    case.check(f"{name}: volume", made["blocks"]["rock"], 120, 1e-7)
    case.check_equal(f"{name}: faces without partner", lone_faces(made), 0)

# --- joints that end: the open share, the tips -----------------------------------------------------------------
made = cut("persistent", {"dimension": 2, "domain": {"box": {"min": [0, 0], "max": [30, 30]}}, "elements": {"size": 0.5},
                          "joints": {"a": {"set": {"angle": 0, "spacing": 0.5, "persistence": 0.6, "length": 4}}}, "slivers": {"stub": 0}})
case.check("persistent: share that is open", made["joints"]["a"] / (60 * 30), 0.6, 0.02)
case.check_equal("persistent: bodies", made["bodies"], 1)
made = cut("disc", {"dimension": 3, "domain": {"box": {"min": [0, 0, 0], "max": [6, 6, 6]}}, "elements": {"size": 1},
                    "joints": {"crack": {"planes": {"point": [3, 3, 3], "normal": [1, 1, 1], "disc": {"centre": [3, 3, 3], "radius": 2}}}}})
case.check("disc: area", made["joints"]["crack"], 4 * math.pi, 1e-4)  # six digits are printed
case.check_equal("disc: bodies, faces without partner", [made["bodies"], lone_faces(made)], [1, 0])

# --- openings ------------------------------------------------------------------------------------------------
hole = {"dimension": 2, "domain": {"polygon": [[0, 0], [20, 0], [20, 10], [10, 16], [0, 10]]}, "elements": {"size": 1},
        "openings": {"shaft": {"polygon": [[-1, -1], [1, -1], [1, 1], [-1, 1]], "at": [5, 5]}, "adit": {"horseshoe": [4, 4], "at": [14, 3], "keep": True, "size": 0.4}},
        "joints": {"level": {"planes": {"point": [0, 4], "normal": [0, 1]}}}}
made = cut("openings", hole)
case.check("openings: rock with what was cut out", made["blocks"]["rock"] + made["blocks"]["adit"] + 4, 260, 1e-3)  # six digits are printed
roof = 18  # sides, the least
case.check("openings: section that was kept", made["blocks"]["adit"], 8 + 0.5 * roof * 4 * math.sin(math.pi / roof), 1e-4)
case.check("openings: the joint ends at the shaft and goes on in the adit", made["joints"]["level"], 18, 1e-4)
tunnel = {**solid, "openings": {"tunnel": {"circle": 1, "path": [[-1, 3, 2], [9, 3, 2]]}}}
made = cut("tunnel", tunnel)
case.check("tunnel: volume, with the area of the circle", made["blocks"]["rock"], 192 - 8 * math.pi, 1e-3)

# --- slivers ---------------------------------------------------------------------------------------------------
near = {**flat, "joints": {"a": {"planes": [{"point": [4, 0], "normal": [1, 0]}, {"point": [4.03, 0], "normal": [1, 0]}]}}}
made = cut("slivers", near)
case.check_equal("slivers: parts, joined", [made["parts"], "1 slivers joined" in made["said"]], [2, True])
case.check_equal("slivers: the bridge is told with its place and meaning", [words in made["said"] for words in (
    "note: joint 'a': 6 of 12 m are not open (where slivers were joined to neighbours), the largest piece, of 6 m, at (4", "both sides hang together: rock bridges", "joint 'a': 6 m of 12 m asked for")], [True] * 3)
made = cut("slivers_kept", {**near, "slivers": {"volume": 0, "thickness": 0}})
case.check_equal("slivers kept: parts", made["parts"], 3)
case.check("slivers kept: the thin one", made["least"], 0.18, 1e-4)
case.check_equal("slivers kept: no bridge is told", ["are not open" in made["said"], "joint 'a': 12 m of 12 m asked for" in made["said"]], [False, True])

# --- joints that nearly meet: no flat elements ---------------------------------------------------------------------
broken = {"dimension": 3, "seed": 1, "domain": {"box": {"min": [0, 0, 0], "max": [10, 10, 10]}}, "elements": {"size": 1.2},
          "joints": {"bedding": {"set": {"dip": 20, "dip_direction": 90, "spacing": 2, "persistence": 0.8, "length": 4}},
                     "cross": {"set": {"dip": 75, "dip_direction": 200, "spacing": 2.5, "persistence": 0.8, "length": 4}}}}


def worst_shape(made):
    return float(re.search(r"worst shape (\S+)", made["said"])[1])


made = cut("nearly_met", broken)
case.check_within("joints that nearly meet: worst shape", worst_shape(made), 0.05, 1)
close("joints that nearly meet: volume, faces without partner", [made["blocks"]["rock"], lone_faces(made)], [1000, 0], 1e-9)
made = cut("nearly_met_cubes", {**broken, "elements": {"size": 1.2, "shape": "cubes"}})
close("the same of cubes: volume, faces without partner", [made["blocks"]["rock"], lone_faces(made)], [1000, 0], 1e-9)
pressed = {**flat, "joints": {"a": {"planes": [{"point": [4, 0], "normal": [1, 0]}, {"point": [4.001, 0], "normal": [1, 0]}]}}, "slivers": {"volume": 0, "thickness": 0}}

# --- in the plane, too: a tunnel between two sets with scatter, whatever the seed ----------------------------------
tunnel_2d = {key: value for key, value in case.load("exodus_inputs/tunnel_2d/mesh.yaml").items() if key != "seed"}
seeds = 20 if full else 6
volumes, worths, before, lone = [], [], [], 0
for seed in range(1, seeds + 1):
    made = cut("tunnel_2d", {**tunnel_2d, "seed": seed})
    volumes.append(sum(made["blocks"].values()))
    worths.append(min(float(worth) for worth in re.findall(r"worst shape (\S+)", made["said"])))
    before.append(float(re.search(r"is worth \S+, was (\S+)", made["said"])[1]))
    lone += lone_faces(made)
case.check_within("tunnel, over seeds: worst shape", min(worths), 0.09, 1)
case.check_within("tunnel, over seeds: worst worth without mending", min(before), 0, 0.003)  # such a mesh is refused
case.check("tunnel, over seeds: area over that of the box", max(volumes, key=lambda area: abs(area - 1440)) / 1440, 1, 2e-6)
case.check_equal("tunnel, over seeds: faces without partner", lone, 0)
made = cut("tunnel_2d_cubes", {**tunnel_2d, "seed": 6, "elements": {**tunnel_2d["elements"], "shape": "cubes"}})
case.check("tunnel of quadrilaterals: area over that of the box", sum(made["blocks"].values()) / 1440, 1, 2e-6)
case.check_equal("tunnel of quadrilaterals: faces without partner", lone_faces(made), 0)

# --- an adit into a hill: its walls meet the facets of the ground anywhere ---------------------------------------
def ground(x, y):
    """The height of a slope [m]."""
    return 10 * (1 + math.tanh((x - 14) / 5)) + 0.5 * math.sin(y / 4)


def hill(file, along, across, base):
    """A solid below the slope, in STL: squares of 3 m, each two triangles."""
    def top(i, j):
        return (3 * i, 3 * j, ground(3 * i, 3 * j))

    def bottom(i, j):
        return (3 * i, 3 * j, base)

    facets = []
    for i in range(along):
        for j in range(across):
            facets += [(top(i, j), top(i + 1, j), top(i + 1, j + 1)), (top(i, j), top(i + 1, j + 1), top(i, j + 1))]
            facets += [(bottom(i, j), bottom(i + 1, j + 1), bottom(i + 1, j)), (bottom(i, j), bottom(i, j + 1), bottom(i + 1, j + 1))]
    border = [(i, 0) for i in range(along)] + [(along, j) for j in range(across)] + [(i, across) for i in range(along, 0, -1)] + [(0, j) for j in range(across, 0, -1)]
    for start, end in zip(border, border[1:] + border[:1]):
        facets += [(bottom(*start), bottom(*end), top(*end)), (bottom(*start), top(*end), top(*start))]
    rows = [f"facet normal 0 0 0\nouter loop\n" + "\n".join("vertex {:.6f} {:.6f} {:.6f}".format(*x) for x in facet) + "\nendloop\nendfacet" for facet in facets]
    pathlib.Path(file).write_text("solid hill\n" + "\n".join(rows) + "\nendsolid hill\n")


hill("hill.stl", 12, 10, -8)
made = cut("adit", {"dimension": 3, "domain": {"file": str(pathlib.Path("hill.stl").resolve())}, "elements": {"size": 2}, "node_sets": {"base": {"where": {"z": -8}}},
                    "openings": {"adit": {"horseshoe": [4, 4], "path": [[2, 15, 3.1], [30, 15, 3.1]]}}})
case.check_within("adit into a hill: worst shape", worst_shape(made), 0.05, 1)
case.check("adit into a hill: volume of elements over that of the solid", made["blocks"]["rock"] / made["most"], 1, 1e-3)

# --- cells -------------------------------------------------------------------------------------------------------
for name, recipe, total in (("cells_2d", flat, 48), ("cells_3d", {**solid, "elements": {"size": 1.5}}, 192)):
    made = cut(name, {**recipe, "joints": {"grains": {"voronoi": {"cells": 20, "relaxations": 5}}}, "slivers": {"volume": 0, "thickness": 0}})
    case.check_equal(f"{name}: cells, bodies", [made["parts"], made["bodies"]], [20, 20])
    case.check(f"{name}: volume", made["blocks"]["rock"], total, 1e-4)
    case.check_equal(f"{name}: faces without partner", lone_faces(made), 0)

# --- solids from files -----------------------------------------------------------------------------------------
corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
lines = []
for number, group in enumerate(("lower", "upper")):
    lines += [f"o {group}", *(f"v {2 * x} {y} {z + number}" for x, y, z in corners), *("f " + " ".join(str(k + 1 + 8 * number) for k in face) for face in faces)]
pathlib.Path("two.obj").write_text("\n".join(lines) + "\n")
stones = {"dimension": 3, "domain": {"file": str(pathlib.Path("two.obj").resolve()), "joint": "mortar", "block": "stone"}, "elements": {"size": 0.5}}
made = cut("stones", stones)
case.check_equal("stones of a file: parts, bodies", [made["parts"], made["bodies"]], [2, 2])
close("stones of a file: volume, mortar", [made["blocks"]["stone"], made["joints"]["mortar"]], [4, 2], 1e-6)
made = cut("stones_cut", {**stones, "joints": {"crack": {"planes": {"point": [1, 0, 0], "normal": [1, 0, 0]}}}})
case.check_equal("stones with a crack: bodies", made["bodies"], 4)
close("stones with a crack: areas", [made["joints"]["crack"], made["joints"]["mortar"]], [2, 2], 1e-6)


# --- without joints: a solid of a file, a box with an opening ---------------------------------------------------
pathlib.Path("one.obj").write_text("\n".join(lines[: 1 + 8 + 6]) + "\n")
made = cut("whole", {"dimension": 3, "domain": {"file": str(pathlib.Path("one.obj").resolve())}, "elements": {"size": 0.5}})
case.check_equal("a solid without joints: parts, bodies", [made["parts"], made["bodies"]], [1, 1])
case.check("a solid without joints: volume", made["blocks"]["rock"], 2, 1e-6)
for shape in ("simplices", "cubes"):
    made = cut(f"bored_{shape}", {"dimension": 2, "domain": flat["domain"], "elements": {"size": 0.5, "shape": shape}, "openings": {"hole": {"circle": 1, "at": [4, 3]}}})
    case.check(f"a hole without joints, {shape}: area", made["blocks"]["rock"], 48 - math.pi, 1e-3)
made = cut("kept", {"dimension": 3, "domain": solid["domain"], "elements": {"size": 1}, "openings": {"tunnel": {"circle": 1, "path": [[-1, 3, 2], [9, 3, 2]], "keep": True}}})
case.check_equal("an opening that is kept, without joints: bodies", made["bodies"], 1)
case.check("an opening that is kept, without joints: volume", made["blocks"]["rock"] + made["blocks"]["tunnel"], 192, 1e-3)

# --- polygons of a code for fracture networks --------------------------------------------------------------------
pathlib.Path("polygons.dat").write_text("nPolygons: 2\n4 {-1, -1, 2} {9, -1, 2} {9, 7, 2} {-1, 7, 2} \n3 {4, -20, 0} {4, 3, 30} {4, 26, 0} \n")
made = cut("polygons", {**solid, "joints": {"network": {"file": str(pathlib.Path("polygons.dat").resolve())}}})
case.check_equal("polygons of a network: bodies", made["bodies"], 4)
case.check("polygons of a network: area", made["joints"]["network"], 48 + 24, 1e-3)

# --- an assembly of COMPAS, its support a block of its own ----------------------------------------------------
def block_of(group):
    """A block of 2 x 1 x 1 as compas_dem writes it."""
    mesh = {"vertex": {str(k): {"x": 2 * x, "y": y, "z": z + group} for k, (x, y, z) in enumerate(corners)}, "face": {str(f): list(face) for f, face in enumerate(faces)}}
    return {"dtype": "compas_dem.elements/Block", "data": {"transformation": None, "geometry": {"dtype": "compas.datastructures/Mesh", "data": mesh}, "is_support": group == 0}}


pathlib.Path("pile.json").write_text(json.dumps({"dtype": "compas_dem.models/BlockModel", "data": {"elements": {f"guid-{group}": block_of(group) for group in range(3)}}}))
pile = {**stones, "domain": {"file": str(pathlib.Path("pile.json").resolve()), "joint": "dry", "block": "stone", "supports": "base"}}
made = cut("assembly", pile)
case.check_equal("assembly of COMPAS: parts, bodies", [made["parts"], made["bodies"]], [3, 3])
close("assembly of COMPAS: volumes, joints", [made["blocks"]["stone"], made["blocks"]["base"], made["joints"]["dry"]], [4, 2, 4], 1e-6)


# --- sizes of elements by region ---------------------------------------------------------------------------------
def mean_edges(made, inside):
    """Mean length of the edges of elements whose middle `inside` takes, by their block and middle [m]."""
    mesh, lengths = meshes.read(made["mesh"]), []
    for block in mesh.blocks:
        corners_of = mesh.points[block.nodes]
        chosen = corners_of[inside(block.name, corners_of.mean(axis=1))]
        count = corners_of.shape[1]
        lengths += [numpy.linalg.norm(chosen[:, a] - chosen[:, b], axis=1) for a in range(count) for b in range(a)] if count == corners_of.shape[2] + 1 else []
    return float(numpy.concatenate(lengths).mean())


plate = {**flat, "joints": {"level": {"planes": {"point": [0, 3], "normal": [0, 1]}}}, "elements": {"size": 0.8, "growth": 0.5, "regions": [{"box": {"min": [2, 1], "max": [4, 4]}, "size": 0.1}]}}
made = cut("finer_box", plate)
case.check("finer in a box, 2D: mean edge over the size asked for", mean_edges(made, lambda block, x: (abs(x[:, 0] - 3) < 0.9) & (abs(x[:, 1] - 2.5) < 1.4)) / 0.1, 1, 0.1)
case.check("finer in a box, 2D: mean edge far from it over that of elements", mean_edges(made, lambda block, x: x[:, 0] > 6.2) / 0.8, 1, 0.2)
cube = {**solid, "joints": {"x": solid["joints"]["x"]}, "elements": {"size": 1, "growth": 0.6, "regions": {"box": {"min": [0, 0, 0], "max": [2, 2, 2]}, "size": 0.3}}}
made = cut("finer_corner", cube)
case.check("finer in a box, 3D: mean edge over the size asked for", mean_edges(made, lambda block, x: x.max(axis=1) < 1.8) / 0.3, 1.1, 0.25)
case.check_within("finer in a box, 3D: mean edge far from it over that of elements", mean_edges(made, lambda block, x: x[:, 0] > 6) / 1, 0.8, 1.2)
made = cut("finer_base", {**pile, "elements": {"size": 0.5, "growth": 1, "regions": [{"block": "base", "size": 0.12}]}})
case.check("finer in a block: mean edge over the size asked for", mean_edges(made, lambda block, x: numpy.full(len(x), block == "base")) / 0.12, 1.1, 0.25)
case.check_within("finer in a block: mean edge of the farthest stone over that of elements", mean_edges(made, lambda block, x: x[:, 2] > 2) / 0.5, 0.8, 1.2)
coarse = cut("as_coarse", {**pile, "elements": {"size": 0.5}})
case.check_within("the same without the region: mean edge of the base over that of elements", mean_edges(coarse, lambda block, x: numpy.full(len(x), block == "base")) / 0.5, 0.8, 1.2)


def refused(name, recipe, *words):
    try:
        said = cut(name, recipe)["said"]
    except program.ProgramFailed as failed:
        said = str(failed)
    case.check_equal(f"{name}: says what is wrong", [word for word in words if word not in said], [])


refused("elements that are flat", pressed, "slivers.shape", "(4", "exit code 4")
made = cut("flat_on_purpose", {**pressed, "slivers": {**pressed["slivers"], "shape": 0}})
case.check_equal("flat elements on purpose: parts", made["parts"], 3)

# A box of several shells in one group: a cavity, a stone in it, and another stone beside it; a face that is not plane.
def shell(low, size, count):
    """A cube, as lines of an OBJ file whose corners come after `count` others."""
    places = [[start + size * step for start, step in zip(low, corner)] for corner in corners]
    return [f"v {x} {y} {z}" for x, y, z in places] + ["f " + " ".join(str(k + 1 + count) for k in face) for face in faces]


shells = ["o all", *shell((0, 0, 0), 4, 0), *shell((0.5, 0.5, 0.5), 3, 8), *shell((1.5, 1.5, 1.5), 1, 16), *shell((6, 0, 0), 2, 24)]
pathlib.Path("shells.obj").write_text("\n".join(shells) + "\n")
lone = {"dimension": 3, "domain": {"file": str(pathlib.Path("shells.obj").resolve())}, "elements": {"size": 1}, "slivers": {"volume": 0, "thickness": 0},
        "joints": {"crack": {"planes": {"point": [1, 0, 1], "normal": [0, 0, 1]}}}}
made = cut("shells", lone)
case.check_equal("shells of a group: bodies", made["bodies"], 5)  # the hollow one and that beside it are cut
close("shells of a group: volume, area", [made["blocks"]["rock"], made["joints"]["crack"]], [64 - 27 + 1 + 8, 16 - 9 + 4], 1e-6)
pathlib.Path("warped.obj").write_text("\n".join(shell((0, 0, 0), 4, 0)).replace("v 4 4 4", "v 4 4 5") + "\n")
made = cut("warped", {**lone, "domain": {"file": str(pathlib.Path("warped.obj").resolve())}})
case.check_within("a warped face: volume", made["blocks"]["rock"], 64 + 8 / 3 - 1e-6, 64 + 16 / 3 + 1e-6)  # by the diagonals
shaft = {**solid, "openings": {"shaft": {"polygon": [[-1, -0.5], [1, -0.5], [1, 0.5], [-1, 0.5]], "path": [[4, 3, -1], [4, 3, 5]]}}}
made = cut("shaft", {**shaft, "joints": {"z": solid["joints"]["z"]}})
close("a shaft: volume, area", [made["blocks"]["rock"], made["joints"]["z"]], [192 - 8, 48 - 2], 1e-4)

# Solids that reach into each other, with names that begin alike.
def pair(name, shift, size=2):
    """Two cubes of 2 m and of a size, the second one moved."""
    rows = ["g wall left", *shell((0, 0, 0), 2, 0), "g wall right", *shell((shift,) * 3, size, 8)]
    pathlib.Path(f"{name}.obj").write_text("\r\n".join(rows) + "\r\n")
    return {**stones, "domain": {**stones["domain"], "file": str(pathlib.Path(f"{name}.obj").resolve())}, "elements": {"size": 1}}


refused("solids that overlap", pair("overlap", 1), "'wall left' and 'wall right' by 1 m^3", "exit code 4")
refused("a solid in another", pair("within", 0.5, 1), "'wall left' and 'wall right' by 1 m^3", "exit code 4")
refused("a solid twice", pair("twice", 0), "'wall left' and 'wall right' by 8 m^3", "exit code 4")
pathlib.Path("open.obj").write_text("\n".join(lines[: 1 + 8 + 5]) + "\n")
refused("an open surface", {**stones, "domain": {**stones["domain"], "file": str(pathlib.Path("open.obj").resolve())}}, "is not closed", "belongs to 1 face", "exit code 4")
refused("a region of no block", {**pile, "elements": {"size": 0.5, "regions": {"block": "bse", "size": 0.1}}}, "has no block 'bse'", "base, stone", "exit code 3")
refused("a region that is coarser", {**flat, "elements": {"size": 0.5, "regions": {"box": {"min": [0, 0], "max": [1, 1]}, "size": 0.9}}}, "must be less than that of elements", "exit code 3")
pathlib.Path("no_blocks.json").write_text('{"vertices": []}')
refused("an assembly without blocks", {**pile, "domain": {**pile["domain"], "file": str(pathlib.Path("no_blocks.json").resolve())}}, "no blocks were found", "exit code 4")
pathlib.Path("left_open.obj").write_text(pathlib.Path("twice.obj").read_text().rstrip().rsplit("\n", 1)[0] + "\n")
refused("a group by its whole name", {**stones, "domain": {**stones["domain"], "file": str(pathlib.Path("left_open.obj").resolve())}}, "'wall right' is not closed", "exit code 4")
refused("elements in millimetres by mistake", {**solid, "elements": {"size": 0.001}}, "about 1.2e+12 elements", "elements.most", "exit code 3")
refused("more elements than allowed", {**flat, "elements": {"size": 0.5, "most": 100}}, "elements.most = 100", "exit code 3")
refused("no such file", {**stones, "domain": {**stones["domain"], "file": "missing.obj"}}, "missing.obj", "exit code 4")
refused("a joint outside", {**flat, "joints": {"a": {"planes": {"point": [0, 9], "normal": [0, 1]}}}}, "joints.a has no face inside", "exit code 3")
level = {"planes": {"point": [0, 4], "normal": [0, 1]}}
refused("two joints in one place", {**flat, "joints": {"a": level, "b": level}}, "joints.b lies wholly on joints that stand before it", "exit code 3")
refused("an opening outside", {**hole, "openings": {"far": {"circle": 1, "at": [50, 0]}}}, "openings.far has no part of the domain", "exit code 3")
refused("an opening in millimetres", {**hole, "openings": {"tunnel": {"circle": 3000, "at": [10, 5]}}}, "openings.tunnel is 6000 m wide and 6000 m high", "25.61 m from corner to corner", "All lengths are in metres", "exit code 3")
refused("a fine opening", {**hole, "openings": {"tunnel": {"circle": 3, "at": [10, 5], "size": 0.003}}}, "about 6284 sides", "elements.most_parts = 5000", "exit code 3")
made = cut("large_opening", {**flat, "openings": {"hall": {"polygon": [[0.5, 0.5], [7.5, 0.5], [7.5, 5.5], [0.5, 5.5]], "at": [0, 0]}}})
case.check_equal("an opening that takes most of the domain is told", "openings.hall, 7 m wide and 5 m high, takes 72.9 % of the domain" in made["said"], True)
refused("nothing left", {**flat, "openings": {"all": {"polygon": [[-1, -1], [9, -1], [9, 7], [-1, 7]], "at": [0, 0]}}}, "leave nothing", "exit code 3")
refused("two dimensions with a file", {**flat, "domain": {"file": "x.obj"}}, "domain.file", "exit code 3")

# --- where Gmsh fails ------------------------------------------------------------------------------------------------
# Gmsh 4.8 crashes with this one; other ways of meshing work.
bored = {"dimension": 3, "seed": 393, "domain": {"box": {"min": [0, 0, 0], "max": [5.4807588052599945, 5.7269581399261051, 6.9982190815347671]}}, "elements": {"size": 1.4239799131093636, "shape": "cubes"},
         "openings": {"t": {"circle": 1.0961517610519989, "path": [[2.7403794026299972, -1, 3.4991095407673836], [2.7403794026299972, 6.7269581399261051, 3.4991095407673836]], "keep": True}},
         "joints": {"j0": {"set": {"spacing": 3.4838192709716109, "spacing_scatter": 0, "dip": 79.547626306197742, "dip_direction": 13.726332488974267, "fisher": 100}},
                    "j1": {"set": {"spacing": 1.5296468428637251, "spacing_scatter": 0.3, "dip": 90, "dip_direction": 209.74487788776446, "fisher": 100, "persistence": 0.8, "length": 2.1676361633578547}},
                    "j2": {"set": {"spacing": 2.2288600269780328, "spacing_scatter": 0, "dip": 2.1037752204815163, "dip_direction": 355.00953954622577, "fisher": 100, "persistence": 0.8, "length": 1.70575277015907}}}}
made = cut("where_gmsh_crashes", bored)
box = bored["domain"]["box"]["max"]
case.check("where Gmsh crashes: volume over that of the box", (made["blocks"]["rock"] + made["blocks"]["t"]) / math.prod(box), 1, 1e-5)
case.check_equal("where Gmsh crashes: faces without partner", lone_faces(made), 0)
pathlib.Path("no time to cut.e").unlink(missing_ok=True)
refused("no time to cut", {**broken, "elements": {"size": 1.2, "time_limit": 0.1}}, "elements.time_limit = 0.1 s", "exit code 4")
case.check_equal("no time to cut: nothing is written", sorted(path.name for path in pathlib.Path(".").glob("no time to cut*")), [])

# --- hinges, units, what lies outside ----------------------------------------------------------------------------------
askew = {"dimension": 3, "domain": {"box": {"min": [0, 0, 0], "max": [8, 8, 8]}}, "openings": {"t": {"horseshoe": [3, 3], "path": [[0, 4, 2], [8, 4, 5]]}},
         "joints": {"a": {"set": {"dip": 30, "dip_direction": 0, "spacing": 3}}}, "elements": {"size": 1.2, "shape": "cubes"}}
made = cut("askew", askew)
case.check_equal("an opening that ends askew: the hinge is opened", "nodes were doubled, the first at (8, 4, 5) m" in made["said"], True)
refused("spacing a thousand times too small", {**solid, "joints": {"x": {"set": {"dip": 90, "dip_direction": 90, "spacing": 0.002}}}}, "joints.x.set: spacing = 0.002 m is not more than slivers.thickness", "exit code 3")
refused("too many parts", {**solid, "elements": {"size": 1, "most_parts": 20}}, "into about 23 parts", "elements.most_parts = 20", "exit code 3")
east, north = 512340, 4005120
moved = {**solid, "domain": {"box": {"min": [east, north, 0], "max": [east + 8, north + 6, 4]}}, "elements": {"size": 1, "regions": {"box": {"min": [0, 0, 0], "max": [2, 2, 2]}, "size": 0.3}},
         "joints": {"x": {"planes": [{"point": [place, north, 0], "normal": [1, 0, 0]} for place in (east + 2, 2)]}, "y": {"set": {"dip": 90, "dip_direction": 0, "spacing": 2000}}}}
made = cut("on_a_map", moved)
case.check_equal("on a map: planes outside, spacing, regions outside, places", [words in made["said"] for words in ("joints.x: 1 of 2 lie wholly outside of the domain: plane 2", "joints.y.set: spacing = 2000 m is more than",
                                                                                       "the box of the region 1, from (0, 0, 0) to (2, 2, 2) m, lies outside", "x from 512340 to 512348 m")], [True] * 4)

# --- equilibrium under an initial stress ---------------------------------------------------------------------------
joint = {"model": "linear", "normal_stiffness": 2e10, "shear_stiffness": 2e10, "friction": 2}
closure = 2e6 / 2e10
material = {"model": "linear_elastic", "density": 2600, "youngs_modulus": 5e10, "poisson_ratio": 0.25}
outside = {side: {"where": {axis: place}} for side, axis, place in (("left", "x", 0), ("right", "x", 6), ("front", "y", 0), ("rear", "y", 5))}


def deck(recipe, declared=True):
    flat = recipe["dimension"] == 2
    return {"materials": {"granite": material}, "blocks": {"rock": {"material": "granite"}}, "joints": {"rough": joint},
            "contact": {"pairs": [{"joint_set": name, "joint": "rough", "declared": declared} for name in recipe["joints"]]},
            "initial": [{"block": "rock", "stress": [-3e6, -2e6, -2.5e6, 0.2e6, 0, 0] if flat else [-3e6, -2e6, -2.5e6, 0.2e6, 0.1e6, -0.3e6]}],
            "conditions": [{"type": "fixed", "node_set": side} for side in recipe["node_sets"]], "time": {"end": 5e-4}, "output": {"every": 1}}


at_rest = {
    "cells at rest": {"dimension": 2, "domain": {"box": {"min": [0, 0], "max": [6, 5]}}, "elements": {"size": 0.7, "shape": "cubes"}, "node_sets": outside,
                      "joints": {"grains": {"voronoi": {"cells": 12, "relaxations": 3}}}},
    "mended joints at rest": {**scattered, "node_sets": {**outside, "bottom": {"where": {"z": 0}}, "top": {"where": {"z": 4}}},
                              "joints": {name: {"set": {**joint["set"], "persistence": 0.8, "length": 3}} for name, joint in scattered["joints"].items()}},
    "scattered sets at rest": {**scattered, "node_sets": {**outside, "bottom": {"where": {"z": 0}}, "top": {"where": {"z": 4}}}},
}
for name, recipe in at_rest.items():
    run = case.attempt(name.replace(" ", "_"), recipe, deck(recipe))
    case.check_equal(f"{name}: exit code", run.code, 0)
    moved = numpy.max(numpy.abs(run.results.nodal("displacement")))
    case.check(f"{name}: largest displacement [m] (joints are closed by {closure:g} m)", moved, 0, 1e-12)
    case.check(f"{name}: missed contacts", int(numpy.max(run.history["missed"])), 0, 0, kept="missed contacts")
    case.check(f"{name}: energy balance", numpy.max(numpy.abs(run.history["error"])) / run.history["contact_stored"][0], 0, 1e-12, kept="energy balance")
    case.same_bits(name.replace(" ", "_"), recipe, deck(recipe), run)
# Faces of cubes are kites, no parallelograms: friction, too, has the nodal forces of a uniform stress in the elements there.
kites = {"dimension": 3, "seed": 2, "domain": {"box": {"min": [0, 0, 0], "max": [6, 5, 4]}}, "elements": {"size": 1.2, "shape": "cubes"}, "joints": {"grains": {"voronoi": {"cells": 15, "relaxations": 3}}},
         "node_sets": at_rest["scattered sets at rest"]["node_sets"]}
run = case.attempt("kites", kites, deck(kites))
case.check("cubes in space: largest displacement [m]", numpy.max(numpy.abs(run.results.nodal("displacement"))), 0, 1e-12)
loose = case.attempt("loose", at_rest["cells at rest"], deck(at_rest["cells at rest"], declared=False))
case.check_within("not declared: largest displacement over the closure", numpy.max(numpy.abs(loose.results.nodal("displacement"))) / closure, 0.1, 100)

case.finish()
