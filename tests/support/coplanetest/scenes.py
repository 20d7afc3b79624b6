"""Scenes in which much happens, for comparing runs of one of them bit by bit."""

import sys

NAMES = ("2d", "3d", "sliding", "erosion", "erosion_3d", "everything", "rigid", "rings", "joints", "detonation")


def scene_of(case, name):
    """Recipe, deck, recipe of joints or None, and columns of the history that must be above zero somewhere, because a comparison is
    worth something only if everything has happened. A history line every cycle; nine and more steps of results.
    """
    joints = None

    def of(folder, mesh="mesh.yaml", deck="deck.yaml"):
        return case.load(f"tests/{folder}/{mesh}"), case.load(f"tests/{folder}/{deck}")

    if name in ("2d", "3d"):
        recipe, deck = of("parallel/same_bits", "mesh_3d.yaml" if name == "3d" else "mesh_2d.yaml")
        velocity, end = ([5, -40, 90], 5e-4) if name == "3d" else ([100, 20, 0], 1.2e-4)
        deck["initial"] = [{"block": "bar", "velocity": velocity}]
        deck["time"] = {"end": end}
        deck["output"] = {"every": end / 9}
        happened = ["stick", "slip", "contact_friction", "contact_damping", "contact_hysteresis", "plastic", "open"]
    elif name == "sliding":
        recipe, deck = of("verification/V64_life_of_planes")
        deck["time"]["end"] = 0.09
        deck["output"] = {"every": 0.01}
        happened = ["slip", "contact_friction"]
    elif name in ("erosion", "erosion_3d"):
        recipe, deck = of("verification/erosion", "mesh_3d.yaml" if name == "erosion_3d" else "mesh.yaml")
        if name == "erosion_3d":
            deck["initial"][0]["velocity"] = [0, 0, -800]
            deck["time"]["end"] = 4e-5
        deck["output"]["every"] = deck["time"]["end"] / 9
        happened = ["eroded_elements", "contact_eroded", "eroded"]
    elif name == "everything":
        recipe, deck = of("parallel/restart", "mesh_everything.yaml", "everything.yaml")
        happened = ["eroded_elements", "contact_eroded", "contact_hysteresis", "contact_fracture", "contact_friction", "plastic",
                    "mass_damping", "local_damping", "contact_damping"]
    elif name == "rigid":
        recipe, deck = case.load("exodus_inputs/rocking_block_2d/mesh.yaml"), case.load("exodus_inputs/rocking_block_2d/deck.yaml")
        deck.pop("mesh", None)
        deck["blocks"]["block"]["rigid"] = True
        recipe["parts"][1].update(rotate=-3, about=[0.3, 0])
        deck["time"] = {"end": 0.02}
        deck["output"] = {"every": 0.02 / 9}
        happened = ["stick", "contact_damping"]
    elif name == "rings":
        recipe, deck = of("verification/V72_axisymmetric_contact", "mesh_rings.yaml", "deck_rings.yaml")
        deck["time"]["end"] = 5e-4
        deck["output"] = {"every": 5e-4 / 9}
        happened = ["contact_stored", "mass_damping"]
    elif name == "joints":
        recipe, deck = case.load("exodus_inputs/cut_rock_2d/mesh.yaml"), case.load("exodus_inputs/cut_rock_2d/rock.yaml")
        joints = case.load("exodus_inputs/cut_rock_2d/joints.yaml")
        del deck["mesh"]
        happened = ["stick", "contact_stored"]
    elif name == "detonation":
        recipe, deck = of("verification/V73_detonation")
        deck["time"]["end"] = 4e-6
        deck["output"]["every"] = 4e-6 / 9
        happened = ["chemical", "viscous"]
    else:
        raise ValueError(f"scene {name!r} is not one of {', '.join(NAMES)}")
    deck.setdefault("history", {})["every"] = 0
    if name != "everything":
        deck["history"]["tables"] = ["blocks"] if name == "detonation" else ["blocks", "pairs"]
    return recipe, deck, joints, happened


def straight_run(case, name):
    """Recipe, deck, recipe of joints, and the scene's run on one rank from start to end, in which everything has happened."""
    recipe, deck, joints, happened = scene_of(case, name)
    straight = case.attempt("straight", recipe, deck, joints=joints)
    if straight.code:
        sys.exit(straight.output)
    for what in happened:
        case.check_within(f"straight: {what}", float(max(straight.history[what])), 1e-9, float("inf"))
    return recipe, deck, joints, straight
