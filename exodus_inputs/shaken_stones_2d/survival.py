#!/usr/bin/python3
"""How strong a shaking portal and tower survive: runs over the largest acceleration of the ground, drift of both, and what stands at the end.

    survival.py [FOLDER] [ACCELERATION ...]

FOLDER: where the runs go (default: survival). ACCELERATION: largest ones of the ground [m/s^2] (default: 1 to 4). About ten seconds each
on one core; writes survival.csv, and survival.png where matplotlib is there.
"""

import pathlib
import sys

import numpy

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from coplanetools import deck_of, program  # finds the Python package

import coplane

DEFAULT = [1, 1.5, 2, 2.25, 2.5, 2.75, 3, 4]
PROBES = {"portal": ("crown", 3.6), "tower": ("top", 6.0)}  # probe and its height [m]
FALLEN, LOST = 1.0, 0.2  # a crown that has come down by this [m], or is left this far over its height aside, has fallen


def outcome(history, structure):
    """Largest and last drift against the ground over the height [-], and whether it stands."""
    probe, height = PROBES[structure]
    drift = numpy.abs(history[f"{probe}_displacement_x"] - history["ground_displacement_x"]) / height
    return float(drift.max()), float(drift[-1]), bool(history[f"{probe}_displacement_y"][-1] > -FALLEN and drift[-1] < LOST)


def run(acceleration, folder):
    """The history of one run."""
    mesh = folder / "mesh.e"
    if not mesh.exists():
        program.make_mesh(str(HERE / "mesh.yaml"), str(mesh))
    deck = coplane.Deck.read(deck_of(HERE))
    deck["mesh"] = str(mesh.resolve())
    deck["define.a"] = acceleration
    return coplane.run(deck, folder / f"a_{acceleration:g}").columns


def draw(rows, path):
    try:
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plot
    except ImportError:
        return
    figure, axes = plot.subplots(figsize=(6, 3.6), layout="constrained")
    for name, color in (("portal", "#1f6fb4"), ("tower", "#b4461f")):
        mine = [row for row in rows if row[1] == name]
        axes.plot([row[0] for row in mine], [100 * min(row[2], 0.3) for row in mine], "-", color=color, label=name)
        for stands, marker in ((True, "o"), (False, "x")):
            axes.plot([row[0] for row in mine if row[4] is stands], [100 * min(row[2], 0.3) for row in mine if row[4] is stands], marker, color=color)
    axes.set(xlabel="largest acceleration of the ground [m/s²]", ylabel="largest drift [% of the height], 30 at most", title="o stands, x falls")
    axes.legend(frameon=False)
    figure.savefig(path, dpi=110)


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "survival")
    folder.mkdir(parents=True, exist_ok=True)
    rows = []
    print("| acceleration [m/s²] | portal: largest, last drift | | tower: largest, last drift | |\n|---|---|---|---|---|")
    for acceleration in [float(text) for text in sys.argv[2:]] or DEFAULT:
        history = run(acceleration, folder)
        found = {name: outcome(history, name) for name in PROBES}
        rows += [(acceleration, name, *found[name]) for name in PROBES]
        print(f"| {acceleration:g} | " + " | ".join(f"{100 * most:.2f} %, {100 * last:.2f} % | {'stands' if stands else 'falls'}" for most, last, stands in found.values())
              + " |", flush=True)  # fmt: skip
    (folder / "survival.csv").write_text("acceleration,structure,largest_drift,last_drift,stands\n"
                                         + "".join(",".join(map(str, row)) + "\n" for row in rows))  # fmt: skip
    draw(rows, folder / "survival.png")


if __name__ == "__main__":
    main()
