"""Meshes of quadrilaterals whose blocks share nodes, by way of Gmsh's format and `coplane_mesh convert`."""

import pathlib
import subprocess

import numpy

from coplanetools import program


def grid(x, y):
    """Points of a grid and its cells by columns and rows: (points [n, 2], number of the point of column i, row j)."""
    points = numpy.array([(a, b) for b in y for a in x])
    return points, lambda i, j: j * len(x) + i


def write(path, points, blocks, sides):
    """An Exodus file. blocks: {name: [quadrilaterals]}, each four numbers of points, counter-clockwise; sides: {name: [edges]}, which become side
    and node sets."""
    names = [(1, i + 1, name) for i, name in enumerate(sides)] + [(2, i + 1, name) for i, name in enumerate(blocks)]
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
    lines += [f'{dimension} {tag} "{name}"' for dimension, tag, name in names]
    lines += ["$EndPhysicalNames", "$Entities", f"0 {len(sides)} {len(blocks)} 0"]
    lines += [f"{tag} 0 0 0 0 0 0 1 {tag} 0" for _, tag, _ in names]
    lines += ["$EndEntities", "$Nodes", f"1 {len(points)} 1 {len(points)}", f"2 1 0 {len(points)}"]
    lines += [str(n + 1) for n in range(len(points))] + [f"{x!r} {y!r} 0" for x, y in numpy.asarray(points, float).tolist()]
    total = sum(map(len, blocks.values())) + sum(map(len, sides.values()))
    lines += ["$EndNodes", "$Elements", f"{len(names)} {total} 1 {total}"]
    number = 0
    for dimension, kind, groups in ((1, 1, sides), (2, 3, blocks)):
        for tag, items in enumerate(groups.values(), 1):
            lines.append(f"{dimension} {tag} {kind} {len(items)}")
            for item in items:
                number += 1
                lines.append(" ".join(str(n) for n in (number, *(int(p) + 1 for p in item))))
    lines.append("$EndElements")
    source = pathlib.Path(path).with_suffix(".msh")
    source.write_text("\n".join(lines) + "\n")
    subprocess.run([program.binary("coplane_mesh"), "convert", str(source), "-o", str(path)], check=True, stdout=subprocess.DEVNULL)
