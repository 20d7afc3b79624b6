#!/usr/bin/env python3
"""Balances of contact in the examples that tests have run, as a table.

    python3 tests/measure/examples_table.py BUILD

Reads histories and records of the tests paper.* and gallery.* below the build folder. Remainder: its largest size over the largest of kinetic, internal and
stored contact energy.
"""

import csv
import json
import pathlib
import sys

print("| example | elements | cycles | searches | planes | remainder | hourglass over internal | missed | seconds |")
print("|---|---|---|---|---|---|---|---|---|")
for folder in sorted(pathlib.Path(sys.argv[1]).glob("tests/*/run")):
    name = folder.parent.name
    if not name.startswith(("paper.", "gallery.")) or not (folder / "run.run.json").exists():
        continue
    with open(folder / "run.csv", newline="") as file:
        lines = list(csv.DictReader(file))
    record = json.loads((folder / "run.run.json").read_text())

    def largest(column):
        return max((float(line[column + "[J]"]) for line in lines), key=abs)

    internal, sizes = abs(largest("internal")), record["sizes"]
    scale = max(abs(largest("kinetic")), internal, abs(largest("contact_stored")))
    hourglass = f"{100 * largest('hourglass') / internal:.0f} %" if internal > 0 else "rigid"
    cells = [name.split(".", 1)[1], sizes["elements"], sizes["cycles"], sizes["searches"], max(int(line["planes"]) for line in lines),
             f"{largest('contact_remainder') / scale:.1e}", hourglass, lines[-1]["missed"], f"{record['wall_seconds']:.0f}"]
    print("| " + " | ".join(str(cell) for cell in cells) + " |")
