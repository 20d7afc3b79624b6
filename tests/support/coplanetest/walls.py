"""Walls of single boxes, brick by brick."""


def brick_by_brick(brick, courses, bricks, across=0.0, up=0.0, divisions=(4, 2), block="bricks"):
    """Parts of a recipe: a wall in running bond on y = 0, of `bricks` whole bricks of the size `brick` in each course. They are apart
    by `across` in the courses and by `up` above and below, in the mesh; below zero they lie in each other."""
    length, course = brick
    parts = []
    for row in range(courses):
        starts = [(length + across) * i for i in range(bricks)]
        sizes = [length] * bricks
        if row % 2:
            half = length / 2
            starts = [0.0] + [half + across / 2 + (length + across) * i for i in range(bricks - 1)]
            starts.append(starts[-1] + length + across)
            sizes = [half] + [length] * (bricks - 1) + [half]
        for x, size in zip(starts, sizes):
            cells = [divisions[0] if size == length else divisions[0] // 2, divisions[1]]
            parts.append({"shape": "box", "block": block, "min": [x, (course + up) * row + up], "size": [size, course], "divisions": cells})
    return parts
