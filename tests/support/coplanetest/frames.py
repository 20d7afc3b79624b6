"""The same problem seen in another frame."""

import copy
import math
import re

import numpy

from .meshes import CannotTell


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
    """The deck of a problem whose mesh is turned (or mirrored) by the matrix, then moved, with `velocity` added to all.

    Values may be numbers, expressions of t, x, y, z or tables. CannotTell: what has no words in the other frame.
    """
    deck = copy.deepcopy(deck)
    hand = round(numpy.linalg.det(matrix))  # spins are no vectors: a mirror turns them the other way
    drift = any(velocity)
    along = numpy.abs(matrix).max(axis=0) > 1 - 1e-12  # axes that become axes
    if deck.get("geometry") == "axisymmetric" and (not numpy.array_equal(matrix, numpy.eye(3)) or offset[0] or velocity[0]):
        raise CannotTell("the axis of a body of revolution stays where it is")
    damping = deck.get("damping", {})
    if drift and {"mass", "local", "kinetic"} & set(damping):
        raise CannotTell("damping brakes motion against the axes")
    if "local" in damping and not along.all():
        raise CannotTell("local damping brakes each component by itself")

    def turn(vector):
        if all(isinstance(value, (int, float)) for value in vector):
            return [float(value) for value in matrix @ numpy.array(vector, float)]
        return [_sum([_scaled(_replaced(value, places), factor) for factor, value in zip(row, vector)]) for row in matrix]

    def point(place):
        place = [*place, 0.0][:3] if len(place) == 2 else place
        return [float(c) + float(o) for c, o in zip(turn(place), offset)]

    # Places of the first frame in words of this one.
    places = {
        axis: _sum([_scaled(f"({name} - {float(o)!r})" if o else name, matrix[k, i]) for k, (name, o) in enumerate(zip("xyz", offset))])
        for i, axis in enumerate("xyz")
    }

    moving = {item["block"]: item for item in deck.get("initial", [])}
    if len(moving) < len(deck.get("initial", [])):
        raise CannotTell("a block has two items of initial state")
    if drift:
        for block in deck["blocks"]:
            moving.setdefault(block, {"block": block})
    for item in moving.values():
        item["velocity"] = [
            v + float(w) for v, w in zip(turn(item.get("velocity", [0, 0, 0])), velocity)
        ]
        if "angular_velocity" in item:
            item["angular_velocity"] = [hand * value for value in turn(item["angular_velocity"])]
            item["center"] = [c + float(o) for c, o in zip(turn(item.get("center", [0, 0, 0])), offset)]
        if "velocity_field" in item:
            item["velocity_field"] = turn(item["velocity_field"])
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
    for card in deck.get("materials", {}).values():
        if "joint_normal" in card:
            card["joint_normal"] = turn(card["joint_normal"])
        if "lighting_points" in card:
            card["lighting_points"] = [point(place)[: len(place)] for place in card["lighting_points"]]
    for card in deck.get("lines", {}).values():
        card["points"] = [point(place)[: len(place)] for place in card["points"]]
        if "copy_step" in card:
            card["copy_step"] = turn(card["copy_step"])
    for probe in deck.get("history", {}).get("probes", []):
        if "point" in probe:
            probe["point"] = point(probe["point"])
    conditions = []
    for condition in deck.get("conditions", []):
        conditions += _turned_condition(condition, matrix, velocity, turn, point, along, hand, places)
    if conditions:
        deck["conditions"] = conditions
    return deck


def _turned_condition(condition, matrix, velocity, turn, point, along, hand, places):
    """One condition in the other frame: a list, as some need several."""
    kind, drift = condition["type"], any(velocity)
    components = condition.get("components", ["x", "y", "z"])
    if drift and kind in ("absorbing", "air_blast"):
        raise CannotTell(f"{kind} is at rest")
    for key in ("normal", "value", "incident", "velocity"):
        if isinstance(condition.get(key), list):
            condition[key] = turn(condition[key])
        elif isinstance(condition.get(key), str):  # a pressure that depends on the place
            condition[key] = _replaced(condition[key], places)
    if "charge_place" in condition:
        condition["charge_place"] = point(condition["charge_place"])
    if isinstance(condition.get("angular_velocity"), list):
        condition["angular_velocity"] = [_scaled(value, hand) for value in turn(condition["angular_velocity"])]
    if kind == "symmetry" and drift and abs(numpy.dot(condition["normal"], velocity)) > 0:
        raise CannotTell("a plane of symmetry stays where it is")
    if len(components) < 3 and not numpy.array_equal(matrix, numpy.eye(3)):
        chosen = ["xyz".index(axis) for axis in components]
        if all(along[i] for i in chosen):
            components = sorted("xyz"[int(numpy.argmax(numpy.abs(matrix[:, i])))] for i in chosen)
            condition["components"] = components
        elif kind == "fixed" and not drift:
            return [{"type": "symmetry", "node_set": condition["node_set"], "normal": [float(v) for v in matrix[:, i]]} for i in chosen]
        else:
            raise CannotTell(f"{kind} of some components needs axes")
    if drift:
        if kind == "fixed":
            condition.update(type="velocity", value=[float(v) if axis in components else 0.0 for axis, v in zip("xyz", velocity)])
        elif kind in ("velocity", "displacement", "rigid_motion"):
            key = "velocity" if kind == "rigid_motion" else "value"
            if key in condition:
                common = [f"{float(v)!r}*t" if kind == "displacement" and v else float(v) for v in velocity]
                condition[key] = [_sum([value, v]) if axis in components else value for axis, value, v in zip("xyz", condition[key], common)]
    return [condition]


def _scaled(value, factor):
    """A number, expression or table times a number."""
    factor = float(factor)
    if isinstance(value, (int, float)):
        return float(value) * factor
    if factor == 0.0:
        return 0.0
    if factor == 1.0:
        return value
    if isinstance(value, dict):
        return {**value, "values": [v * factor for v in value["values"]]}
    return f"{factor!r}*({value})"


def _sum(values):
    """Sum of numbers and expressions, or one table."""
    values = [value for value in values if not (isinstance(value, (int, float)) and value == 0.0)]
    if not values:
        return 0.0
    if len(values) == 1:
        return values[0]
    if any(isinstance(value, dict) for value in values):
        raise CannotTell("the sum of a table and something else")
    if all(isinstance(value, (int, float)) for value in values):
        return float(sum(values))
    return " + ".join(f"({value!r})" if isinstance(value, (int, float)) else f"({value})" for value in values)


def _replaced(value, places):
    """An expression of x, y, z of the first frame in words of this one."""
    if not isinstance(value, str) or not re.search(r"\b[xyz]\b", value):
        return value
    return re.sub(r"\b[xyz]\b", lambda found: f"({places[found.group(0)]})", value)
