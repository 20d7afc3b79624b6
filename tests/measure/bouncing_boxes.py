#!/usr/bin/env python3
"""Nine soft blocks in a box: what contact makes or loses by either way of giving impulses, in a table.

    python3 tests/measure/bouncing_boxes.py BUILD/bin [--end 10] [--factors 0.8,0.4,0.2] [--motions 12]

Blocks fly without friction, damping and viscosity (contact_tables.py, `tumbling`); each of the first motions goes another way after some bounces.
With the defaults it takes ten minutes on one core. The figures stand in docs/developer/contact-before-after.md.
"""

import argparse
import os
import pathlib

from contact_tables import Case, lost, numpy, tumbling


def spent():
    """By runs so far [s]."""
    return os.times().children_user + os.times().children_system


parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("programs", type=pathlib.Path, help="folder of the programs")
parser.add_argument("--end", type=float, default=10, help="time to end at [s]")
parser.add_argument("--factors", type=lambda text: [float(x) for x in text.split(",")], default=[0.8, 0.4, 0.2], help="values of time.step_factor")
parser.add_argument("--motions", type=int, default=12, help="how many first motions")
given = parser.parse_args()
os.environ["COPLANE_BIN"] = str(given.programs.resolve())
case = Case("bouncing boxes", __file__)
columns = [f"{what}, {impulses}" for impulses in ("leapfrog", "path") for what in ("median", "largest", "processor time of a run [s]")]
print(f"| time [s] | step factor | motions | {' | '.join(columns)} |\n|{'---|' * (3 + len(columns))}")
for factor in given.factors:
    row = [f"{given.end:g}", factor, given.motions]
    for impulses in ("leapfrog", "path"):
        found, begun = [], spent()
        for start in range(given.motions):
            recipe, deck = tumbling(given.end, factor, start)
            run = case.attempt(f"{impulses}_{factor:g}_{start}", recipe, {**deck, "contact": {"impulses": impulses}})
            found.append(lost(run) if run.code == 0 else float("inf"))
        row += [f"{numpy.median(found):.1e}", f"{max(found):.1e}", f"{(spent() - begun) / given.motions:.1f}"]
    print(f"| {' | '.join(str(cell) for cell in row)} |", flush=True)
