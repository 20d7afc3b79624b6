#!/usr/bin/env python3
"""Draws docs/user/pictures/damping.svg: what contact damping does to a standing, a sliding and a rebounding body.

    docs/user/pictures/draw-damping.py build/bin [FILE]
    docs/user/pictures/draw-damping.py build/bin table

Runs coplane_mesh and coplane from the given folder, about three minutes. "table" prints the table of docs/user/contact.md in place of
drawing. Needs the Python standard library only.
"""
import csv
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

PICTURE = Path(__file__).resolve().parent / "damping.svg"
FRACTIONS = (0, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5)
GRAVITY, DENSITY = 9.81, 2000
ON_SLAB = """dimension: 2
parts:
  - {shape: box, block: slab, min: [0, -0.05], max: [1.2, 0], divisions: [23, 1]}
  - {shape: box, block: block, min: [0.1, 0], size: [0.2, 0.1], divisions: [4, 2]}
node_sets: {slab: {block: slab}}
"""
BARS = """dimension: 2
parts:
  - {shape: box, block: slab, min: [-1, 0], size: [1, 0.05], divisions: [20, 1]}
  - {shape: box, block: block, min: [0, 0], size: [1, 0.05], divisions: [20, 1]}
"""
DECK = """title: contact damping
mesh: mesh.e
materials: {{solid: {{model: linear_elastic, density: 2000, youngs_modulus: 50e6, poisson_ratio: 0.2}}}}
blocks: {{slab: {{material: solid}}, block: {{material: solid}}}}
joints: {{touch: {{model: penalty, friction: {friction}, stiffness_fraction: {fraction}}}}}
contact: {{default_joint: touch, damping: {{normal: {zeta}, shear: {zeta}}}}}
history: {{every: {every}, probes: [{{name: block, block: block}}]}}
output: {{every: 1e9}}
time: {{end: {end}}}
{more}
"""
FIXED = "conditions: [{{type: fixed, node_set: slab}}]\ngravity: [{:.6f}, {:.6f}, 0]\n"


def run(programs, folder, mesh, **values):
    """The columns of the history."""
    (folder / "mesh.yaml").write_text(mesh)
    (folder / "run.yaml").write_text(DECK.format(**{"fraction": 1, **values}))
    for command in (["coplane_mesh", "make", "mesh.yaml", "-o", "mesh.e"], ["coplane", "run.yaml"]):
        done = subprocess.run([programs / command[0], *command[1:]], cwd=folder, capture_output=True, text=True)
        if done.returncode:
            sys.exit(done.stdout + done.stderr)
    with open(folder / "run.csv") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    return {name.split("[")[0].strip(): [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def slope(angle):
    return FIXED.format(GRAVITY * math.sin(angle), -GRAVITY * math.cos(angle))


def walk_of(programs, folder, zeta, safety, fraction):
    """How far a block walks down a slope within the last 0.7 s of 1 s [mm]."""
    h = run(programs, folder, ON_SLAB, zeta=zeta, fraction=fraction, friction=0.6, every=1e-2, end=1, more=slope(math.atan(0.6 / safety)))
    x = h["block_displacement_x"]
    return 1e3 * (x[-1] - x[min(i for i, t in enumerate(h["time"]) if t >= 0.3)])


def table(programs):
    dampings = (0, 0.1, 0.2, 0.3, 0.5)
    print("| safety factor | fraction |", *(f"{zeta:g} |" for zeta in dampings))
    print("|---" * (2 + len(dampings)) + "|")
    for safety in (1.2, 1.05):
        for fraction in (0.5, 1, 2):
            walks = []
            for zeta in dampings:
                with tempfile.TemporaryDirectory() as name:
                    walks.append(walk_of(programs, Path(name), zeta, safety, fraction))
            print(f"| {safety:g} | {fraction:g} |", *("0 |" if abs(walk) < 1e-4 else f"{walk:.2g} |" if walk < 10 else f"{walk:.0f} |" for walk in walks), flush=True)


def measure(programs, zeta):
    """Walk of a standing block in its last 0.7 s [mm]; friction work of a sliding one over mu N s; rebound of equal bars."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        walk = walk_of(programs, folder, zeta, 1.2, 1)
        angle = math.radians(30)
        h = run(programs, folder, ON_SLAB, zeta=zeta, friction=0.3, every=1e-2, end=0.5, more=slope(angle))
        force = 0.3 * DENSITY * 0.2 * 0.1 * GRAVITY * math.cos(angle)
        work = h["contact_friction"][-1] / (force * h["block_displacement_x"][-1])
        moving = "initial: [{block: slab, velocity: [0.1, 0, 0]}, {block: block, velocity: [-0.1, 0, 0]}]\n"
        h = run(programs, folder, BARS, zeta=zeta, friction=0, every=1e-4, end=0.03,
                more=moving + "viscosity: {linear: 0, quadratic: 0}\n")
        return walk, work, h["block_velocity_x"][-1] / 0.1


WIDTH, HEIGHT, PANEL, LEFT, TOP, BOTTOM = 820, 300, 220, 50, 46, 250
PANELS = (
    ("a standing block, safety 1.2: walk in 0.7 s [mm]", 0, (0, 1e-4, 1e-2, 1, 100), lambda v: math.log10(max(abs(v), 1e-4)), (-4, 2)),
    ("a sliding block: friction work over \u03bcNs", 1, (0.9, 0.95, 1), lambda v: v, (0.9, 1.02)),
    ("equal elastic bars: rebound", 2, (0.9, 0.95, 1), lambda v: v, (0.9, 1.02)),
)


def draw(points, file):
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" font-size="12">',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    for p, (title, column, marks, scale, (low, high)) in enumerate(PANELS):
        left = LEFT + p * (PANEL + 45)
        x_of = lambda zeta: left + PANEL * zeta / 0.5
        y_of = lambda value: BOTTOM - (BOTTOM - TOP) * (scale(value) - low) / (high - low)
        out.append(f'<text x="{left}" y="{TOP - 20}" font-size="11">{title}</text>')
        out.append(f'<rect x="{left}" y="{TOP}" width="{PANEL}" height="{BOTTOM - TOP}" fill="none" stroke="#888"/>')
        for mark in marks:
            if p == 0 and mark == 0:
                continue
            label = f"{mark:g}" if p or mark > 1e-4 else "\u2264 0.0001"
            out.append(f'<text x="{left - 4}" y="{y_of(mark) + 4:.1f}" text-anchor="end" font-size="10">{label}</text>')
            out.append(f'<path d="M{left} {y_of(mark):.1f}h{PANEL}" stroke="#ddd"/>')
        for zeta in (0, 0.1, 0.2, 0.3, 0.4, 0.5):
            out.append(f'<text x="{x_of(zeta):.1f}" y="{BOTTOM + 15}" text-anchor="middle" font-size="10">{zeta:g}</text>')
        path = " ".join(f"{x_of(z):.1f},{y_of(v[column]):.1f}" for z, v in points)
        out.append(f'<polyline points="{path}" fill="none" stroke="#2a5db0" stroke-width="2"/>')
        out += [f'<circle cx="{x_of(z):.1f}" cy="{y_of(v[column]):.1f}" r="3" fill="#2a5db0"/>' for z, v in points]
        out.append(f'<text x="{left + PANEL / 2}" y="{BOTTOM + 32}" text-anchor="middle">\u03b6, normal and shear</text>')
    out.append("</svg>")
    file.write_text("\n".join(out) + "\n")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    os.environ.setdefault("OMPI_ALLOW_RUN_AS_ROOT", "1")
    os.environ.setdefault("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
    if sys.argv[2:] == ["table"]:
        table(Path(sys.argv[1]).resolve())
        return
    points = []
    for zeta in FRACTIONS:
        points.append((zeta, measure(Path(sys.argv[1]).resolve(), zeta)))
        print(zeta, *(f"{v:.4g}" for v in points[-1][1]), flush=True)
    draw(points, Path(sys.argv[2]) if len(sys.argv) > 2 else PICTURE)


if __name__ == "__main__":
    main()
