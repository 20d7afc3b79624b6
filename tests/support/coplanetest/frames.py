"""The same problem seen in another frame."""

import copy
import math

import numpy


def rotation(angles):
    """About x, then y, then z [degrees]; one number: about z."""
    if numpy.isscalar(angles):
        angles = (0, 0, angles)
    matrix = numpy.eye(3)
    for axis, angle in enumerate(angles):
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        turn = numpy.eye(3)
        i, j = (axis + 1) % 3, (axis + 2) % 3
        turn[i, i] = turn[j, j] = c
        turn[i, j], turn[j, i] = -s, s
        matrix = turn @ matrix
    return matrix


def turned(recipe, deck, angles=0, offset=(0, 0, 0), velocity=(0, 0, 0)):
    """The same problem, turned about the origin, moved, and with `velocity` added to all.

    Returns recipe, deck and the matrix that takes vectors of the original to the new frame. Parts must
    not be turned or moved already.
    """
    recipe = copy.deepcopy(recipe)
    matrix = rotation(angles)
    dimension = recipe["dimension"]
    for part in recipe["parts"]:
        assert not {"rotate", "offset", "about"} & set(part)
        part["rotate"] = angles if dimension == 2 or not numpy.isscalar(angles) else [0, 0, angles]
        part["about"] = [0.0] * dimension
        part["offset"] = [float(value) for value in offset[:dimension]]
    for selection in list(recipe.get("node_sets", {}).values()) + list(recipe.get("side_sets", {}).values()):
        if "where" in selection:
            selection["where_own"] = selection.pop("where")
        if "normal" in selection:
            normal = matrix @ numpy.array((selection["normal"] + [0])[:3])
            selection["normal"] = [float(value) for value in normal[:dimension]]

    return recipe, turned_deck(deck, matrix, offset, velocity), matrix


def turned_deck(deck, matrix, offset=(0, 0, 0), velocity=(0, 0, 0)):
    """The deck of a problem whose mesh is turned (or mirrored) by the matrix, then moved, with `velocity` added to all."""
    deck = copy.deepcopy(deck)
    hand = round(numpy.linalg.det(matrix))  # spins are no vectors: a mirror turns them the other way

    def turn(vector):
        return [float(value) for value in matrix @ numpy.array(vector, float)]

    moving = {item["block"]: item for item in deck.get("initial", [])}
    if any(velocity):
        for block in deck["blocks"]:
            moving.setdefault(block, {"block": block})
    for item in moving.values():
        item["velocity"] = [
            v + float(w) for v, w in zip(turn(item.get("velocity", [0, 0, 0])), velocity)
        ]
        if "angular_velocity" in item:
            item["angular_velocity"] = [hand * value for value in turn(item["angular_velocity"])]
            item["center"] = [c + float(o) for c, o in zip(turn(item.get("center", [0, 0, 0])), offset)]
        for key in {"stress", "stress_gradient"} & set(item):
            xx, yy, zz, xy, yz, zx = item[key]
            stress = matrix @ numpy.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]]) @ matrix.T
            item[key] = [float(stress[i, j]) for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))]
        if "stress_gradient" in item:
            item["stress_axis"] = turn(item.get("stress_axis", [0, 1, 0]))
            item["stress_point"] = [c + float(o) for c, o in zip(turn(item.get("stress_point", [0, 0, 0])), offset)]
    if moving:
        deck["initial"] = list(moving.values())
    if "gravity" in deck:
        deck["gravity"] = turn(deck["gravity"])
    for condition in deck.get("conditions", []):
        if "normal" in condition:
            condition["normal"] = turn(condition["normal"])
        if condition["type"] == "fixed" and any(velocity):
            condition.update(type="velocity", value=[float(value) for value in velocity])
    return deck
