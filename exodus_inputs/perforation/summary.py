"""Several runs together: a table, and residual speeds over impact speeds beside the measured ones (perforation.png)."""

import pathlib
import sys

from coplanetools import EndedRun
from slab import MEASURED, forrestal, numbers

found = [(folder, numbers(EndedRun(folder, 0, ""), folder)) for folder in map(pathlib.Path, sys.argv[1:])]
several = len({of["size"] for _, of in found}) > 1
curves = {}
for folder, of in found:
    if of["slab"]:
        known = f"measured {MEASURED[of['impact']]:.0f} m/s" if of["impact"] in MEASURED else "not measured"
        print(f"{folder.name}: {of['impact']} m/s, residual {of['residual']:.0f} m/s, {known}")
        label = of["curve"] + (f", {1e3 * of['size']:.0f} mm" if several else "")
        curves.setdefault(label, []).append((of["impact"], of["residual"]))
    else:
        expected = forrestal(of["impact"])
        print(f"{folder.name}: {of['impact']} m/s, depth {1e3 * of['depth']:.0f} mm, Forrestal {1e3 * expected:.0f} mm, "
              f"{100 * (of['depth'] / expected - 1):+.0f} %")

if max(map(len, curves.values()), default=0) > 1:
    try:
        import matplotlib
    except ImportError:
        sys.exit("no plot: install python3-matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(5.6, 4), layout="constrained")
    axes.plot(*zip(*sorted(MEASURED.items())), "ks", label="Hanchak et al. 1992")
    for marker, curve in zip(("o-", "^-", "s-", "v--", "d--", "x--"), sorted(curves, reverse=True)):
        axes.plot(*zip(*sorted(curves[curve])), marker, label=curve, markersize=5)
    axes.plot([0, 1100], [0, 1100], ":", color="0.6")
    axes.set(xlabel="impact speed [m/s]", ylabel="residual speed [m/s]", xlim=(250, 1100), ylim=(-20, 1050))
    axes.legend(frameon=False)
    figure.savefig("perforation.png", dpi=110)
    print(pathlib.Path("perforation.png").resolve())
