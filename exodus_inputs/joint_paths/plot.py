#!/usr/bin/env python3
"""Draws the paths of an example deck as one SVG picture, from the CSV files that coplane_point wrote.

Usage: plot.py <name of the deck without .yaml> [folder of the CSV files] [picture]
"""

import csv
import math
import pathlib
import sys

# name: panels of (heading, x column, y column, scales, axis texts, [(path, label)])
MM, MPA, UM = 1e3, 1e-6, 1e6
NORMAL = ("closure[m]", "normal_traction[Pa]")
TENSION = ("gap[m]", "tension")
SHEAR = ("slip_x[m]", "drag")
PANELS = {
    "linear": [
        ("Shear under 2 MPa, with reversal", SHEAR, (MM, MPA), ("slip [mm]", "shear [MPa]"), [("shear", "")]),
        ("Brittle bond", TENSION, (UM, MPA), ("gap [µm]", "tension [MPa]"), [("tension", "")]),
    ],
    "penalty": [
        ("Press, open, press", NORMAL, (UM, MPA), ("closure [µm]", "compression [MPa]"), [("press_and_open", "")]),
        ("Shear under 10 MPa", SHEAR, (MM, MPA), ("slip [mm]", "shear [MPa]"), [("shear", "")]),
    ],
    "closure_curve": [
        ("Load and unload", NORMAL, (MM, MPA), ("closure [mm]", "compression [MPa]"), [("cycles", "")]),
    ],
    "table": [
        ("Load and unload", NORMAL, (MM, MPA), ("closure [mm]", "compression [MPa]"), [("cycles", "")]),
    ],
    "friction": [
        (
            "Friction of speed, 2 MPa", SHEAR, (MM, MPA), ("slip [mm]", "shear [MPa]"),
            [("slow", "1e-6 m/s"), ("medium", "0.2 m/s"), ("fast", "20 m/s")],
        ),
        ("Dilation", SHEAR, (MM, MPA), ("slip [mm]", "shear [MPa]"), [("free", "free"), ("confined", "confined")]),
    ],
    "barton_bandis": [
        (
            "Direct shear", SHEAR, (MM, MPA), ("slip [mm]", "shear [MPa]"),
            [("low", "1 MPa"), ("high", "10 MPa"), ("confined", "from 1 MPa, confined")],
        ),
        (
            "Dilation", ("slip_x[m]", "offset[m]"), (MM, MM), ("slip [mm]", "dilation [mm]"),
            [("low", "1 MPa"), ("high", "10 MPa"), ("confined", "from 1 MPa, confined")],
        ),
    ],
    "points": [
        (
            "Around a corner", ("slip_x[m]", "slip_y[m]"), (MM, MM), ("slip in x [mm]", "slip in y [mm]"),
            [("corner", "")],
        ),
    ],
}
PANELS["crushing"] = [
    (
        "Crushed, unloaded, crushed again", NORMAL, (MM, MPA), ("closure [mm]", "compression [MPa]"),
        [("cycle", "no loss"), ("cycle_lost", "half lost")],
    ),
    (
        "Sheared at a closure", ("normal_traction[Pa]", "shear_traction[Pa]"), (MPA, MPA), ("compression [MPa]", "shear [MPa]"),
        [("sheared_5", "0.5 of the strength"), ("sheared_7", "0.7"), ("sheared_9", "0.9")],
    ),
]
for name in ("mortar", "bilinear"):
    PANELS[name] = [
        ("Tension with unloading", TENSION, (MM, MPA), ("gap [mm]", "tension [MPa]"), [("cycle", "")]),
        (
            "Shear", SHEAR, (MM, MPA), ("slip [mm]", "shear [MPa]"),
            [("shear_0", "no compression"), ("shear_1", "1 MPa")],
        ),
    ]
# What is shown, where it is not all: x from, x to, y from, y to.
LIMITS = {
    ("mortar", 0): (-0.01, 0.4, -0.3, 0.3),
    ("bilinear", 0): (-0.01, 0.2, -0.3, 0.3),
    ("mortar", 1): (0, 2, 0, 1.2),
    ("bilinear", 1): (0, 2, 0, 1.2),
}
COLOURS = ("#1b5e9b", "#c0392b", "#2e7d32")
WIDTH, HEIGHT, LEFT, BOTTOM, TOP, RIGHT = 380, 280, 58, 46, 34, 14


def column(rows, name):
    if name == "tension":
        return [-float(row["normal_traction[Pa]"]) for row in rows]
    if name == "drag":  # the traction opposes the slip: shown along it
        return [-float(row["shear_traction_x[Pa]"]) for row in rows]
    return [float(row[name]) for row in rows]


def ticks(low, high):
    raw = (high - low) / 4
    power = 10 ** math.floor(math.log10(raw))
    step = next(power * m for m in (1, 2, 5, 10) if power * m >= raw * 0.999)
    first = math.ceil(low / step - 1e-9)
    return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)]


def thin(points, tolerance=0.2):
    """Points from which the line is off by less than a fifth of a pixel (Douglas and Peucker)."""
    keep, spans = {0, len(points) - 1}, [(0, len(points) - 1)]
    while spans:
        first, last = spans.pop()
        (x0, y0), (x1, y1) = points[first], points[last]
        length = math.hypot(x1 - x0, y1 - y0)
        worst, where = tolerance, None
        for i in range(first + 1, last):
            x, y = points[i][0] - x0, points[i][1] - y0
            along = 0 if length == 0 else min(max((x * (x1 - x0) + y * (y1 - y0)) / length**2, 0), 1)
            off = math.hypot(x - along * (x1 - x0), y - along * (y1 - y0))
            if off > worst:
                worst, where = off, i
        if where is not None:
            keep.add(where)
            spans += [(first, where), (where, last)]
    return [points[i] for i in sorted(keep)]


def panel(deck, folder, number, spec, out):
    heading, columns, scales, texts, paths = spec
    series = []
    for path, label in paths:
        with open(folder / f"{deck}_{path}.csv") as file:
            rows = list(csv.DictReader(file))
        x, y = (column(rows, c) for c in columns)
        series.append((label, [(a * scales[0], b * scales[1]) for a, b in zip(x, y)]))
    xs = [a for _, points in series for a, _ in points]
    ys = [b for _, points in series for _, b in points]
    low_x, high_x, low_y, high_y = min(xs), max(xs), min(ys), max(ys)
    limits = LIMITS.get((deck, number), (None,) * 4)
    low_x, high_x, low_y, high_y = (b if b is not None else a for a, b in zip((low_x, high_x, low_y, high_y), limits))
    margin = 0.04 * (high_y - low_y)
    low_y, high_y = low_y - margin, high_y + margin
    left, top = number * WIDTH + LEFT, TOP
    wide, tall = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM

    def at(point):
        return (left + (point[0] - low_x) / (high_x - low_x) * wide, top + (high_y - point[1]) / (high_y - low_y) * tall)

    out.append(f'<text x="{left + wide / 2:.1f}" y="20" text-anchor="middle" font-weight="bold">{heading}</text>')
    out.append(f'<clipPath id="p{number}"><rect x="{left}" y="{top}" width="{wide}" height="{tall}"/></clipPath>')
    for value in ticks(low_x, high_x):
        x = at((value, low_y))[0]
        out.append(f'<path d="M{x:.1f} {top}V{top + tall}" stroke="#ddd"/>')
        out.append(f'<text x="{x:.1f}" y="{top + tall + 15}" text-anchor="middle">{value:g}</text>')
    for value in ticks(low_y, high_y):
        y = at((low_x, value))[1]
        out.append(f'<path d="M{left} {y:.1f}H{left + wide}" stroke="#ddd"/>')
        out.append(f'<text x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">{round(value, 12):g}</text>')
    out.append(f'<rect x="{left}" y="{top}" width="{wide}" height="{tall}" fill="none" stroke="#555"/>')
    out.append(f'<text x="{left + wide / 2:.1f}" y="{HEIGHT - 12}" text-anchor="middle">{texts[0]}</text>')
    middle = top + tall / 2
    out.append(
        f'<text transform="translate({left - 42} {middle:.1f}) rotate(-90)" text-anchor="middle">{texts[1]}</text>'
    )
    for k, (label, points) in enumerate(series):
        line = " ".join(f"{x:.1f},{y:.1f}" for x, y in thin([at(p) for p in points]))
        out.append(
            f'<polyline points="{line}" fill="none" stroke="{COLOURS[k]}" stroke-width="1.6" clip-path="url(#p{number})"/>'
        )
        if label:
            y = top + (18 + 15 * k if deck in ("mortar", "bilinear") else tall - 10 - 15 * (len(series) - 1 - k))
            out.append(f'<path d="M{left + wide - 24} {y - 4}h16" stroke="{COLOURS[k]}" stroke-width="2"/>')
            out.append(f'<text x="{left + wide - 28}" y="{y}" text-anchor="end">{label}</text>')


def main():
    if len(sys.argv) < 2 or sys.argv[1] not in PANELS:
        sys.exit(f"{__doc__}\nDecks: {', '.join(PANELS)}")
    deck = sys.argv[1]
    folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else ".")
    picture = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else f"{deck}.svg")
    specs = PANELS[deck]
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH * len(specs)}" height="{HEIGHT}" '
        f'viewBox="0 0 {WIDTH * len(specs)} {HEIGHT}" font-family="sans-serif" font-size="12" fill="#222">',
        '<rect width="100%" height="100%" fill="white"/>',
    ]
    for number, spec in enumerate(specs):
        panel(deck, folder, number, spec, out)
    out.append("</svg>")
    picture.write_text("\n".join(out) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
