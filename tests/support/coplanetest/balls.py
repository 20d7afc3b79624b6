"""A quarter of a ball on a quarter of a tile, in hexahedra that x and z share to the last bit."""

import numpy


def on_tile(cells, across, deep, half, thick):
    """Recipe: a tile of 2 `half` x `thick` x 2 `half`, its top at y = 0, and a box far above it, which `rounded` makes a ball of.
    Node sets x and z lie on the planes of symmetry."""
    return {
        "dimension": 3,
        "parts": [
            {"shape": "box", "block": "ball", "min": [0, 99, 0], "size": [1, 2, 1], "divisions": [cells, 2 * cells, cells]},
            {"shape": "box", "block": "tile", "min": [0, -thick, 0], "size": [half, thick, half], "divisions": [across, deep, across]},
        ],
        "node_sets": {"x": {"where": {"x": 0}}, "z": {"where": {"z": 0}}},
    }


def rounded(radius, above=1e-4):
    """Makes of the box a quarter of a ball of that radius, so far above the tile; for change_mesh."""

    def moved(x):
        chosen = x[:, 1] > 50
        p = x[chosen] - [0, 100, 0]
        r = numpy.max(numpy.abs(p), axis=1, keepdims=True)
        u = p / numpy.where(r > 0, r, 1)
        q = u**2
        y, z = q[:, [1, 2, 0]], q[:, [2, 0, 1]]
        s = u * numpy.sqrt(1 - (y + z) / 2 + y * z / 3)
        points = x.copy()
        points[chosen] = [0, radius + above, 0] + radius * r * (r * s + 0.75 * (1 - r) * u)
        return points

    return moved
