"""Collapse of an arch of rigid stones that do not slide: the least horizontal share of its weight with which four hinges move, by virtual work."""

import itertools
import math

import numpy


def arch(stones, thickness, radius=10.0, fixed=0):
    """Weights and centres of the stones of a semicircle, and its joints as pairs of points (intrados, extrados), from the right springing; fixed: stones at each end that cannot move, and are left out."""
    inner, outer, step = radius * (1 - thickness / 2), radius * (1 + thickness / 2), math.pi / stones
    middle = 2 / 3 * (outer**3 - inner**3) / (outer**2 - inner**2) * math.sin(step / 2) / (step / 2)
    angles = step * numpy.arange(stones + 1)
    ends = numpy.stack([numpy.cos(angles), numpy.sin(angles)], axis=1)
    between = step * (numpy.arange(stones) + 0.5)
    centres = middle * numpy.stack([numpy.cos(between), numpy.sin(between)], axis=1)
    free = slice(fixed, stones - fixed)
    return numpy.ones(stones - 2 * fixed), centres[free], numpy.stack([inner * ends, outer * ends], axis=1)[fixed : stones + 1 - fixed]


def multiplier(stones, thickness, fixed=0):
    """Least share of the weight that acts along +x and makes the arch fall, and the hinges: [(joint, "intrados" or "extrados")].

    Hinges at joints a < b < c < d, in turns at intrados and extrados; the parts between them turn about instantaneous centres. A mechanism counts if each joint
    opens on the side that has no hinge.
    """
    weights, centres, joints = arch(stones, thickness, fixed=fixed)
    sums = numpy.concatenate([[0], numpy.cumsum(weights)])
    moments = numpy.concatenate([numpy.zeros((1, 2)), numpy.cumsum(weights[:, None] * centres, axis=0)])
    best = (math.inf, None)
    for first in (0, 1):
        sides = [first, 1 - first, first, 1 - first]
        for where in itertools.combinations(range(len(joints)), 4):
            p = [joints[joint, side] for joint, side in zip(where, sides)]
            # Spins w1, w2, w3 of the parts a-b, b-c, c-d: velocities agree at b and c, d rests. Two equations in w2/w1, w3/w1.
            ab, bc, cd = p[1] - p[0], p[2] - p[1], p[3] - p[2]
            determinant = bc[0] * cd[1] - bc[1] * cd[0]
            if abs(determinant) < 1e-9:
                continue
            w2 = -(ab[0] * cd[1] - ab[1] * cd[0]) / determinant
            w3 = -(bc[0] * ab[1] - bc[1] * ab[0]) / determinant
            # Work of the weights per unit w1: vertical and horizontal, v = w (-(y - y0), x - x0) about a hinge that moves.
            work, base = numpy.zeros(2), numpy.zeros(2)
            for w, (low, high), start, end in zip((1.0, w2, w3), zip(where, where[1:]), p, p[1:]):
                mass, moment = sums[high] - sums[low], moments[high] - moments[low]
                arm = moment - mass * start
                work += mass * base + w * numpy.array([-arm[1], arm[0]])
                base = base + w * numpy.array([-(end - start)[1], (end - start)[0]])
            if abs(work[0]) < 1e-9:
                continue
            sign = 1 if work[0] > 0 else -1  # the load along +x does work
            share = work[1] / work[0]  # what the load gives is what lifting the weight takes
            if not 0 < share < best[0]:
                continue
            # Relative spins at a, b, c, d, anticlockwise is positive: with its hinge at the intrados a joint opens outside where the part behind it turns faster.
            relative = numpy.array([1.0, w2 - 1.0, w3 - w2, -w3]) * sign
            opens = [r > 0 if side == 0 else r < 0 for r, side in zip(relative, sides)]
            if all(opens):
                best = (share, [(joint, ("intrados", "extrados")[side]) for joint, side in zip(where, sides)])
    return best


if __name__ == "__main__":
    for t in (0.11, 0.12, 0.15, 0.2):
        print(t, multiplier(27, t))
