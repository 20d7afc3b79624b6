#!/usr/bin/env python3
"""Draws docs/developer/packages.svg from packages/PackagesList.cmake and packages/*/cmake/Dependencies.cmake.

    packages/cmake/draw-packages.py [FILE]

A package stands one level above the highest package that it uses. A dependency that another one implies is not drawn: the
picture shows the least set of arrows from which all declared ones follow. Needs the Python standard library only.
"""
import sys
from pathlib import Path

sys.dont_write_bytecode = True
from declared import PACKAGES, declared, packages_bottom_to_top

PICTURE = PACKAGES.parent / "docs" / "developer" / "packages.svg"
BOX_WIDTH, BOX_HEIGHT = 120, 34
COLUMN, ROW, MARGIN = 150, 96, 30


def reachable(start, uses):
    found, todo = set(), list(uses[start])
    while todo:
        package = todo.pop()
        if package not in found:
            found.add(package)
            todo += uses[package]
    return found


def picture():
    packages = packages_bottom_to_top()
    uses = {package: declared(package)["PACKAGES"] for package in packages}
    level = {}
    for package in packages:  # bottom to top, so the levels of what it uses are known
        level[package] = 1 + max((level[other] for other in uses[package]), default=-1)
    arrows = [(package, other) for package in packages for other in uses[package]
              if not any(other in reachable(third, uses) for third in uses[package])]

    rows = [[p for p in packages if level[p] == i] for i in range(max(level.values()) + 1)]
    width = 2 * MARGIN + COLUMN * max(len(row) for row in rows) - (COLUMN - BOX_WIDTH)
    height = 2 * MARGIN + ROW * (len(rows) - 1) + BOX_HEIGHT
    place = {}
    for i, row in enumerate(rows):
        left = (width - COLUMN * len(row) + COLUMN - BOX_WIDTH) / 2
        for k, package in enumerate(row):
            place[package] = (left + k * COLUMN, height - MARGIN - BOX_HEIGHT - i * ROW)

    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
        'font-family="Helvetica, Arial, sans-serif" font-size="15">',
        "  <!-- Made by packages/cmake/draw-packages.py; do not edit. -->",
        '  <defs><marker id="arrow" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="8" markerHeight="8" orient="auto">'
        '<path d="M0 0 L10 5 L0 10 z" fill="#555"/></marker></defs>',
        f'  <rect width="{width}" height="{height}" fill="white"/>',
    ]
    for package, other in arrows:
        x1, y1 = place[package][0] + BOX_WIDTH / 2, place[package][1] + BOX_HEIGHT
        x2, y2 = place[other][0] + BOX_WIDTH / 2, place[other][1]
        lines.append(f'  <line x1="{x1:g}" y1="{y1:g}" x2="{x2:g}" y2="{y2:g}" stroke="#555" marker-end="url(#arrow)"/>')
    for package in packages:
        x, y = place[package]
        lines.append(f'  <rect x="{x:g}" y="{y:g}" width="{BOX_WIDTH}" height="{BOX_HEIGHT}" rx="5" fill="#e8eef7" stroke="#345"/>')
        lines.append(f'  <text x="{x + BOX_WIDTH / 2:g}" y="{y + BOX_HEIGHT / 2 + 5:g}" text-anchor="middle">{package}</text>')
    return "\n".join(lines + ["</svg>"]) + "\n"


def main():
    if len(sys.argv) > 2 or (sys.argv[1:] and sys.argv[1].startswith("-")):
        sys.exit(__doc__)
    Path(sys.argv[1] if sys.argv[1:] else PICTURE).write_text(picture())


main()
