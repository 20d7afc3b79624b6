"""What check.py and summary.py share: measured speeds, Forrestal's depths, the numbers of a run."""

import math
import pathlib

import numpy

from coplanetools import documents

MEASURED = dict(numpy.loadtxt(pathlib.Path(__file__).with_name("measured.csv"), delimiter=",", skiprows=2))


def forrestal(speed, strength=40e6, density=2300, mass=0.5, radius=0.0127, caliber=3):
    """Depth of a rigid ogive-nosed projectile in concrete [m] (Forrestal, Altman, Cargile and Hanchak, Int. J. Impact Engng 15
    (1994) 395-405): a crater 4 radii deep in which force grows linearly, then the tunnel with pi a^2 (R + N rho v^2).
    """
    resistance = 82.6 * (strength / 1e6) ** -0.544 * strength
    shape = (8 * caliber - 1) / (24 * caliber**2)
    crater = 4 * math.pi * radius**3
    tunnel = (mass * speed**2 - crater * resistance) / (mass + crater * shape * density)
    return (mass / (2 * math.pi * radius**2 * density * shape) * math.log(1 + shape * density * tunnel / resistance)
            + 4 * radius)


def numbers(run, folder):
    """Law, whether without effects of rate, whether the rim is held, size of elements near the path [m] (0 in three dimensions), impact and residual speed [m/s], largest depth of the tip [m],
    whether the slab is one that is perforated, how many such parts make the whole."""
    h = run.history
    deck, recipe = (documents.load(folder / name) for name in ("run.yaml", "mesh.yaml"))
    slab = recipe["parts"][0]
    thickness = slab["length"] if slab["shape"] == "sector" else -slab["lines"]["y"]["ends"][0]
    lines = slab.get("lines", {}).get("x")
    size = (lines["ends"][1] - lines["ends"][0]) / lines["divisions"][0] if lines else 0
    law = deck["blocks"]["slab"]["material"]
    held = any(condition.get("node_set") == "rim" for condition in deck.get("conditions", []))
    slow = law == "pseudo_cap" and not deck["materials"][law].get("rate_effects")
    curve = law + (", slow strengths" if slow else "") + (", rim held" if held else "")
    return {"law": law, "slow": slow, "held": held, "curve": curve, "size": size, "impact": round(-float(h["projectile_velocity_y"][0])),
            "residual": -float(h["projectile_velocity_y"][-1]), "depth": -float(h["tip_displacement_y"].min()),
            "slab": thickness < 0.2, "of": 4 if recipe["dimension"] == 3 else 1}
