"""A disc of bonded elements under two platens: strength by 2 P / (pi D t), crack, fragments."""

import numpy
from coplanetest import ValidationCase

case = ValidationCase(__file__)
RADIUS = 0.025


def split(name, across=24, turn=0.0, triangles=False, end=None, **bond):
    """Largest load over pi D t f_t / 2; fragments at the end: elements of each, the largest first; run and seconds.

    Bonds are 20 times as stiff as a layer of elements is thick.
    """
    recipe, deck, joints = case.load("mesh.yaml"), case.load(), case.load("joints.yaml")
    recipe["parts"][0].update(across=across, rotate=turn, about=[0, 0])
    if triangles:
        recipe["parts"][0]["split"] = "triangles"
    card = deck["joints"]["bond"]
    card["normal_stiffness"] = 20 * deck["materials"]["rock"]["youngs_modulus"] * across / (2 * RADIUS)
    card.update(bond)
    if end:
        for condition in deck["conditions"]:
            condition["value"][1] = condition["value"][1].replace("0.06", repr(0.06 * deck["time"]["end"] / end))
        deck["output"]["every"] *= end / deck["time"]["end"]
        deck["time"]["end"] = end
    run, spent = case.timed(name, recipe, deck, joints=joints)
    load = abs(run.history["lower_reaction_y"]).max()
    with open(run.path("run_fragments.csv")) as file:
        rows = [line.split(",") for line in file.read().splitlines()[1:]]
    pieces = sorted((int(float(row[3])) for row in rows if row[0] == rows[-1][0]), reverse=True)
    return load / (numpy.pi * RADIUS * card["tensile_strength"]), pieces, run, spent


strength, pieces, run, spent = split("disc")
print(strength, pieces, spent)
case.finish()
