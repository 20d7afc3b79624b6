#!/usr/bin/env python3
"""Draws docs/theory/pictures/classic-corners.svg: corners under Cundall's common plane and under Simple Common Planes.

    build/bin/coplane_classic_corner_table | docs/theory/pictures/draw-classic.py [FILE]

Reads the table of forces from the standard input. Needs the Python standard library only.
"""
import csv
import math
import sys
from pathlib import Path

PICTURE = Path(__file__).resolve().parent / "classic-corners.svg"
WIDTH, HEIGHT = 820, 380
LEFT, RIGHT, TOP, BOTTOM = 60, 490, 40, 320  # chart
ANGLES, RATIOS = (20, 180), (1, 4.25)
SECTION, SHADOW = "#2a5db0", "#c05a00"


def x_of(angle):
    return LEFT + (RIGHT - LEFT) * (angle - ANGLES[0]) / (ANGLES[1] - ANGLES[0])


def y_of(ratio):
    return BOTTOM - (BOTTOM - TOP) * (ratio - RATIOS[0]) / (RATIOS[1] - RATIOS[0])


def text(x, y, words, **style):
    attributes = "".join(f' {name.replace("_", "-")}="{value}"' for name, value in style.items())
    return f'<text x="{x:.1f}" y="{y:.1f}"{attributes}>{words}</text>'


def line(x1, y1, x2, y2, **style):
    attributes = "".join(f' {name.replace("_", "-")}="{value}"' for name, value in style.items())
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}"{attributes}/>'


def chart(rows):
    parts = []
    for angle in range(30, 181, 30):
        parts.append(line(x_of(angle), TOP, x_of(angle), BOTTOM, stroke="#ddd"))
        parts.append(text(x_of(angle), BOTTOM + 18, f"{angle}°", text_anchor="middle"))
    for ratio in (1, 4 / 3, 2, 3, 4):
        dashes = {"stroke_dasharray": "2 4"} if ratio == 4 / 3 else {}
        parts.append(line(LEFT, y_of(ratio), RIGHT, y_of(ratio), stroke="#888" if dashes else "#ddd", **dashes))
        parts.append(text(LEFT - 6, y_of(ratio) + 5, "4/3" if dashes else f"{ratio}", text_anchor="end"))
    parts.append(line(LEFT, BOTTOM, RIGHT, BOTTOM, stroke="#000"))
    parts.append(line(LEFT, BOTTOM, LEFT, TOP, stroke="#000"))
    parts.append(text((LEFT + RIGHT) / 2, BOTTOM + 42, "interior angle of the corner", text_anchor="middle"))
    parts.append(text(LEFT - 40, TOP - 16, "force of the simple planes / force of the classic plane"))
    for column, colour in (("ratio_penetrating", SECTION), ("ratio_full", SHADOW)):
        flat = " ".join(f"{x_of(float(r['angle'])):.1f},{y_of(float(r[column])):.1f}" for r in rows
                        if r["kind"] == "corner2d")
        parts.append(f'<polyline points="{flat}" fill="none" stroke="{colour}" stroke-width="2"/>')
        for row in rows:
            at = x_of(float(row["angle"])), y_of(float(row[column]))
            if row["kind"] == "corner3d":
                parts.append(f'<circle cx="{at[0]:.1f}" cy="{at[1]:.1f}" r="3.5" fill="white" stroke="{colour}"/>')
            elif row["kind"] == "cube":
                parts.append(f'<rect x="{at[0] - 5:.1f}" y="{at[1] - 5:.1f}" width="10" height="10" fill="{colour}"/>')
    legend = x_of(81), TOP + 18
    entries = ((SECTION, "line", "2D, penetrating area / section"), (SECTION, "circle", "3D, three faces, same areas"),
               (SHADOW, "line", "2D, whole area / shadow"), (SHADOW, "circle", "3D, three faces, same areas"),
               ("#555", "square", "corner of a cube"))
    parts.append(f'<rect x="{legend[0] - 10:.1f}" y="{legend[1] - 16:.1f}" width="256" height="112" fill="white" stroke="#ccc"/>')
    for i, (colour, mark, words) in enumerate(entries):
        x, y = legend[0], legend[1] + 20 * i
        if mark == "line":
            parts.append(line(x, y, x + 24, y, stroke=colour, stroke_width=2))
        elif mark == "circle":
            parts.append(f'<circle cx="{x + 12:.1f}" cy="{y:.1f}" r="3.5" fill="white" stroke="{colour}"/>')
        else:
            parts.append(f'<rect x="{x + 7:.1f}" y="{y - 5:.1f}" width="10" height="10" fill="{colour}"/>')
        parts.append(text(x + 34, y + 5, words))
    return parts


def sketch(x0, y0, title, planes):
    """A right-angled corner, `depth` deep in a face; planes: ends of the areas, from the surface point above the apex."""
    depth, arm = 56, 96
    parts = [f'<rect x="{x0 - 130:.1f}" y="{y0:.1f}" width="260" height="{depth + 14}" fill="#cfe0f5"/>',
             f'<polygon points="{x0:.1f},{y0 + depth:.1f} {x0 + arm:.1f},{y0 + depth - arm:.1f} {x0 - arm:.1f},{y0 + depth - arm:.1f}"'
             ' fill="#f8dcc0" fill-opacity="0.75"/>',
             f'<polyline points="{x0 - arm:.1f},{y0 + depth - arm:.1f} {x0:.1f},{y0 + depth:.1f} {x0 + arm:.1f},{y0 + depth - arm:.1f}"'
             ' fill="none" stroke="#345"/>',
             line(x0 - 130, y0, x0 + 130, y0, stroke="#345")]
    for (ax, ay), (bx, by) in planes(depth):
        longer = 22 / math.hypot(bx - ax, by - ay)
        dx, dy = longer * (bx - ax), longer * (by - ay)
        parts.append(line(x0 + ax - dx, y0 + ay - dy, x0 + bx + dx, y0 + by + dy, stroke="#a00", stroke_dasharray="5 3"))
        parts.append(line(x0 + ax, y0 + ay, x0 + bx, y0 + by, stroke="#2c8a4b", stroke_width=4))
        parts.append(f'<circle cx="{x0 + (ax + bx) / 2:.1f}" cy="{y0 + (ay + by) / 2:.1f}" r="3.5" fill="#000"/>')
    parts.append(text(x0, y0 - 52, title, text_anchor="middle"))
    return parts


def classic_plane(depth):
    """Parallel to the face, half way down: as wide as the corner is there."""
    return [((-depth / 2, depth / 2), (depth / 2, depth / 2))]


def simple_planes(depth):
    """Half way between the face and each side of the corner; they begin where these meet."""
    delta = math.radians(22.5)
    length = depth * math.cos(delta) / math.cos(math.radians(45))
    x, y = depth - length * math.cos(delta), length * math.sin(delta)
    return [((depth, 0), (x, y)), ((-depth, 0), (-x, y))]


def picture(rows):
    parts = chart(rows)
    parts += sketch(665, 110, "classic: one plane, section half way down", classic_plane)
    parts += sketch(665, 275, "simple: one plane for each side", simple_planes)
    return "\n".join(
        [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}"'
         ' font-family="Helvetica, Arial, sans-serif" font-size="14">',
         f'  <rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>'] + ["  " + part for part in parts] + ["</svg>", ""])


if __name__ == "__main__":
    table = list(csv.DictReader(sys.stdin))
    if not table:
        sys.exit("draw-classic: no table on the standard input; pipe build/bin/coplane_classic_corner_table into it")
    Path(sys.argv[1] if len(sys.argv) > 1 else PICTURE).write_text(picture(table))
