#!/usr/bin/env python3
"""How fast the bar behind the wall is with each form of elements in the bricks, over several starts.

    python3 tests/measure/bar_wall_forms.py BUILD/bin FOLDER [--size S] [--end 0.03] [--forms one_point assumed_strain full_integration] [--starts 8]

The example bar_wall_3d in one of its sizes, from starts at which the bar is moved aside and up by some centimetres: none of them is the mirror image of
another. Runs go to FOLDER, one for each form and start, and are not run again when they are there. Prints the table under "The form of the elements" in
docs/examples/bar-wall.md: means over the starts, in parentheses how far single starts scatter (standard deviation), and how far from full integration the
mean is, in all and from the same start at least and at most. Size S takes an hour of one core beside other
programs.
"""

import argparse
import json
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import numpy
from coplanetest import Case, examples
from coplanetools import EndedRun

# Of the bar: aside and up [m].
STARTS = [(0, 0), (0.02, 0), (0, 0.02), (0, -0.02), (0.03, 0.03), (0.05, -0.03), (0.04, 0.01), (0.01, -0.04)]
# Without a limit on the step no element turns inside out either; it costs more cycles.
CHANGES = {"full_integration": {"stable_step": 1e-6}}
AT = (0.01, 0.0183)


def ran(case, form, start, size, end):
    name = f"{size}-{form}-{start}"
    record = pathlib.Path(name, "run.run.json")
    if not record.exists() or json.loads(record.read_text())["ending"] != "completed":
        recipe, deck, _ = examples.sized("bar_wall_3d", size)
        recipe["parts"][1]["offset"] = [number + moved for number, moved in zip(recipe["parts"][1]["offset"], (*STARTS[start], 0))]
        deck["blocks"]["bricks"]["element"] = form
        deck["blocks"]["bricks"]["erosion"].update(CHANGES.get(form, {}))
        deck["time"]["end"] = end
        deck["output"] = {"results": "none", "planes": False}
        run = case.attempt(name, recipe, deck)
        if run.code:
            sys.exit(run.output[-2000:])
    h = EndedRun(name, 0, "").history
    speeds = [float(numpy.interp(time, h["time"], h["bar_velocity_z"])) for time in (*AT, end)]
    print(f"{name}: {', '.join(f'{speed:.2f}' for speed in speeds)} m/s, {int(h['cycle'][-1])} cycles", file=sys.stderr, flush=True)
    return speeds, int(h["cycle"][-1]), json.loads(record.read_text())["wall_seconds"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--size", default="S")
    parser.add_argument("--end", type=float, default=0.03)
    parser.add_argument("--forms", nargs="+", default=["one_point", "assumed_strain", "full_integration"])
    parser.add_argument("--starts", type=int, default=len(STARTS))
    options = parser.parse_args()
    os.environ["COPLANE_BIN"] = str(options.bin.resolve())
    options.folder.mkdir(parents=True, exist_ok=True)
    os.chdir(options.folder)
    case = Case("bar and wall, forms of elements", __file__)
    found = {form: [ran(case, form, start, options.size, options.end) for start in range(options.starts)] for form in options.forms}
    speeds = {form: numpy.array([of[0] for of in runs]) for form, runs in found.items()}
    times = [f"{1e3 * time:g} ms" for time in (*AT, options.end)]
    print(f"| bricks, size {options.size}, starts: {options.starts} | speed of the bar at {', '.join(times)} [m/s] | from full integration | cycles, seconds |\n|---|---|---|---|")
    for form, runs in found.items():
        several = options.starts > 1
        mean, scatter = speeds[form].mean(axis=0), speeds[form].std(axis=0, ddof=1) if several else None
        seen = [f"{m:.2f} ({s:.2f})" for m, s in zip(mean, scatter)] if several else [f"{m:.2f}" for m in mean]
        apart = "-"
        if form != "full_integration" and "full_integration" in found:
            each = 100 * (speeds[form] / speeds["full_integration"] - 1)
            whole = 100 * (mean / speeds["full_integration"].mean(axis=0) - 1)
            apart = ", ".join(f"{w:+.1f} %" + (f" ({low:+.1f} to {high:+.1f})" if several else "") for w, low, high in zip(whole, each.min(axis=0), each.max(axis=0)))
        cells = [f"`{form}`", ", ".join(seen), apart, ", ".join(f"{numpy.mean([of[n] for of in runs]):.0f}" for n in (1, 2))]
        print("| " + " | ".join(cells) + " |")


main()
