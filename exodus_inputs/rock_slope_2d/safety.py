#!/usr/bin/python3
"""Factor of safety of the slope over the water in its tension crack, found two ways: by strength reduction with coplane, and by limit
equilibrium of the wedge as a rigid body (Hoek and Bray's plane failure).

    safety.py [FOLDER] [SHARE ...]

FOLDER: where the runs go (default: rock_slope in the working folder). SHARE: of the crack's depth that is full of water (default: 0, 0.5, 0.75). Takes about a minute
for each on one core.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from coplanetools import deck_of, program  # finds the Python package

from coplane import Deck, capacity

HEIGHT, FACE, DIP = 20.0, math.radians(60), math.radians(35)
CRACK = HEIGHT / math.tan(FACE) + 6
DEPTH = HEIGHT - CRACK * math.tan(DIP)
LENGTH = (HEIGHT - DEPTH) / math.sin(DIP)  # of the plane
FRICTION, COHESION = math.tan(math.radians(38)), 30e3  # of the plane [-, Pa]: those of deck.yaml, change them together


def loads(share, unit_weight=2600 * 9.81, water=9810.0):
    """Weight of the wedge, thrust of the water in the crack, uplift on the plane; per metre of slope [N/m]."""
    corners = [(0, 0), (CRACK, HEIGHT - DEPTH), (CRACK, HEIGHT), (HEIGHT / math.tan(FACE), HEIGHT)]
    area = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(corners, corners[1:] + corners[:1])) / 2
    head = share * DEPTH
    return area * unit_weight, water * head**2 / 2, water * head * LENGTH / 2


def forces_on_plane(share):
    """Effective normal force and shear force that hold the wedge [N/m]."""
    weight, thrust, uplift = loads(share)
    return weight * math.cos(DIP) - uplift - thrust * math.sin(DIP), weight * math.sin(DIP) + thrust * math.cos(DIP)


def limit_equilibrium(share, friction, cohesion):
    """(c A + (W cos p - U - V sin p) tan(phi)) / (W sin p + V cos p)."""
    normal, shear = forces_on_plane(share)
    return (cohesion * LENGTH + normal * friction) / shear


def acceleration(share, friction):
    """Of a wedge that slides, without the cohesion, which is broken then [m/s^2]."""
    normal, shear = forces_on_plane(share)
    return 9.81 * (shear - normal * friction) / loads(share)[0]


def strength_reduction(share, folder):
    """The Bracket of the factor."""
    mesh = folder / "mesh.e"
    if not mesh.exists():
        program.make_mesh(str(HERE / "mesh.yaml"), str(mesh))
    deck = Deck.read(deck_of(HERE))
    deck["mesh"] = str(mesh.resolve())
    deck["define.filled"] = share
    slides = capacity.Moves("brow", limit=2e-3, since=1.0)
    low = 0.9 * limit_equilibrium(share, FRICTION, COHESION)
    return capacity.factor_of_safety(deck, slides, joints=["plane"], low=low, high=low * 1.25, tolerance=0.01, folder=folder / f"filled_{share:g}")


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "rock_slope")
    folder.mkdir(parents=True, exist_ok=True)
    print("| share of the crack that is full | strength reduction | limit equilibrium | difference |\n|---|---|---|---|")
    for share in [float(text) for text in sys.argv[2:]] or [0.0, 0.5, 0.75]:
        found, exact = strength_reduction(share, folder), limit_equilibrium(share, FRICTION, COHESION)
        print(f"| {share:g} | {found.low:.3f} to {found.high:.3f} | {exact:.3f} | {100 * (found.value / exact - 1):+.1f} % |", flush=True)


if __name__ == "__main__":
    main()
