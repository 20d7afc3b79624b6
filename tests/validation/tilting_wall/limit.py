"""Load multipliers of walls of rigid dry stones by limit analysis: linear programs over the forces in the joints, without a finite element."""

import math

import numpy

FRICTION = 0.65  # of the walls of Ferris and Tin-Loi [-]
STONE = (0.4, 0.175)  # of their walls: length and height [m]
PIERS_FRICTION, PIERS_STONE = math.tan(math.radians(26)), (0.25, 1.5 / 27)  # of the wall of piers


def _courses(*rows):
    return [row for count, row in rows for _ in range(count)]


def walls():
    """The six walls of M. C. Ferris and F. Tin-Loi (2001): courses from below, lengths of stones in stones; a negative length is an opening."""
    five, halves = [1.0] * 5, [0.5, 1, 1, 1, 1, 0.5]
    four, four_halves = [1.0] * 4, [0.5, 1, 1, 1, 0.5]
    three, three_halves = [1.0] * 3, [0.5, 1, 1, 0.5]
    seven, seven_halves = [1.0] * 7, [0.5, *[1] * 6, 0.5]
    door = [[0.5, 1, -1, 1, 0.5], [1, 0.5, -1, 0.5, 1]]
    two_doors = [[1, -1, 1, -1, 1], [0.5, 0.5, -1, 0.5, 0.5, -1, 0.5, 0.5]]
    tall_doors = [[1, -1, 1], [0.5, 0.5, -1, 0.5, 0.5]]
    wide_doors = [[0.5, 1, -1, 1, 1, -1, 1, 0.5], [1, 0.5, -1, 0.5, 1, 0.5, -1, 0.5, 1]]
    open_five = lambda pair: [*pair, *pair, pair[0]]  # noqa: E731
    return {
        "wall 1": [halves, five] * 3,
        "wall 2": [halves, five] * 5,
        "wall 3": [four, four_halves, four, *open_five(door), four, four_halves, four],
        "wall 4": [halves, five, halves, *open_five(two_doors), halves, five, halves],
        "wall 5": [three_halves, three, three_halves, *open_five(tall_doors), three_halves, three, three_halves, *open_five(tall_doors), three_halves, three, three_halves],
        "wall 6": [seven_halves, seven, seven_halves, seven, *open_five(wide_doors), seven, seven_halves, seven, *open_five(wide_doors), seven, seven_halves, seven, seven_halves],
    }


def piers():
    """The wall of the tests of LACT3 (Y. Hua and others, 2025): a slender and a broad pier, a lintel of three stones' length over the door between, and a slit beside the slender one."""
    odd, even = [1, -1, 1, 0.5, -2, 0.5, 1, 1], [0.5, 0.5, -1, 0.5, 1, -2, 1, 1, 0.5]
    return [[1.0] * 8, [0.5, 0.5, -1, 0.5, *[1.0] * 5, 0.5], *[odd, even] * 11, [1, -1, 1, 3, 1, 1], [0.5, *[1.0] * 7, 0.5], [1.0] * 8]


def stones(courses, stone=STONE):
    """(x, y, length) of each stone [m]; stone: length and height of a whole one [m]."""
    found = []
    for row, lengths in enumerate(courses):
        x = 0.0
        for length in lengths:
            if length > 0:
                found.append((x * stone[0], row * stone[1], length * stone[0]))
            x += abs(length)
    return found


def joints(found, height):
    """Rows (stone that is pushed along the normal, the other or -1 for the table, two ends of the joint, normal) [m]; height: of a course [m]."""
    rows = []
    for i, (x, y, length) in enumerate(found):
        if y == 0:
            rows.append((i, -1, (x, 0.0), (x + length, 0.0), (0.0, 1.0)))
        for j, (u, v, width) in enumerate(found):
            low, high = max(x, u), min(x + length, u + width)
            if abs(v + height - y) < 1e-9 and high - low > 1e-9:
                rows.append((i, j, (low, y), (high, y), (0.0, 1.0)))
            if abs(v - y) < 1e-9 and abs(u + width - x) < 1e-9:
                rows.append((i, j, (x, y), (x, y + height), (1.0, 0.0)))
    return rows


def least(cost, equations, right, steps=80):
    """The x >= 0 with `equations` x = `right` that has the least cost: Mehrotra's predictor and corrector, dense."""
    a, b, c = equations, right, cost
    normal = a @ a.T + 1e-12 * numpy.eye(len(b))
    x = a.T @ numpy.linalg.solve(normal, b)
    y = numpy.linalg.solve(normal, a @ c)
    s = c - a.T @ y
    x, s = x + max(-1.5 * x.min(), 0) + 1, s + max(-1.5 * s.min(), 0) + 1
    for _ in range(steps):
        primal, dual, gap = b - a @ x, c - a.T @ y - s, x @ s / len(x)
        if numpy.abs(primal).max() < 1e-6 and numpy.abs(dual).max() < 1e-8 and gap < 1e-8:
            return x
        weight = x / s
        matrix = (a * weight) @ a.T
        matrix[numpy.diag_indices(len(b))] += 1e-14 * numpy.abs(matrix).max()

        def step(products):
            dy = numpy.linalg.solve(matrix, primal + a @ (weight * dual - products / s))
            ds = dual - a.T @ dy
            return products / s - weight * ds, dy, ds

        def reach(values, change):
            down = change < 0
            return min(1.0, (-values[down] / change[down]).min(initial=numpy.inf))

        dx, dy, ds = step(-x * s)
        after = (x + reach(x, dx) * dx) @ (s + reach(s, ds) * ds) / len(x)
        dx, dy, ds = step(-x * s - dx * ds + (after / gap) ** 3 * gap)
        x, y, s = x + 0.99 * reach(x, dx) * dx, y + 0.99 * reach(s, ds) * dy, s + 0.99 * reach(s, ds) * ds
    raise ArithmeticError("the linear program did not converge")


def multiplier(courses, friction=FRICTION, stone=STONE):
    """The largest part of its weight that a wall bears to the side.

    Equilibrium of every stone under its weight and that part of it to the side; in every joint forces at its two ends that push and lie within the cone of friction. The multiplier is that of stones
    that climb as they slide (the associated rule of flow); by the static theorem stones that do not climb, as Coulomb's, bear no more.
    """
    found = stones(courses, stone)
    rows = joints(found, stone[1])
    matrix = numpy.zeros((3 * len(found), 4 * len(rows) + 1))
    for k, (one, other, first, second, normal) in enumerate(rows):
        along = numpy.array([normal[1], -normal[0]])
        for i, (at, side) in enumerate([(first, 1), (first, -1), (second, 1), (second, -1)]):
            force = numpy.array(normal) + side * friction * along
            for which, sign in ((one, 1), (other, -1)):
                if which < 0:
                    continue
                x, y, length = found[which]
                arm = numpy.array(at) - (x + length / 2, y + stone[1] / 2)
                matrix[3 * which : 3 * which + 3, 4 * k + i] += sign * numpy.array([*force, (arm[0] * force[1] - arm[1] * force[0]) / stone[0]])
    weights = numpy.array([length / stone[0] for _, _, length in found])  # of a stone
    matrix[0::3, -1] = weights
    right = numpy.zeros(len(matrix))
    right[1::3] = weights
    cost = numpy.zeros(matrix.shape[1])
    cost[-1] = -1
    return float(least(cost, matrix, right)[-1])
