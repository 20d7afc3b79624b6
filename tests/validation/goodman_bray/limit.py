"""Limit equilibrium of toppling blocks after Goodman and Bray (1976), as Wyllie and Mah print it: forces from block to block, from the crest down."""

import math

HEIGHTS = [4.0 * n for n in range(1, 11)] + [34.0, 28.0, 22.0, 16.0, 10.0, 4.0]  # y_n [m], from the toe
WIDTH, DIP, STEP = 10.0, math.radians(30), 1.0  # of the blocks [m], of their bases [rad], from base to base [m]
UNIT_WEIGHT = 25e3  # [N/m^3]


def forces(tangent, a1=5.0, a2=5.2):
    """What block n pushes block n - 1 with [N/m], n = 1 first, and the ways in which the blocks are held: "stable", "topples" or "slides".

    tangent: of the friction angle, of bases and sides; a1, a2: what tops of sides lie below tops of blocks, downhill and uphill [m]. Each force is the
    larger one of those that keep the block from toppling and from sliding.
    """
    crest = HEIGHTS.index(max(HEIGHTS)) + 1
    pushed, result, ways = 0.0, [0.0] * len(HEIGHTS), [""] * len(HEIGHTS)
    for n in range(len(HEIGHTS), 0, -1):
        y = HEIGHTS[n - 1]
        weight = UNIT_WEIGHT * WIDTH * y
        above, below = (y - a2 if n >= crest else y), (y if n > crest else y - a1)  # arms M_n of what pushes, L_n of what holds
        turning = pushed * (above - WIDTH * tangent) + weight / 2 * (y * math.sin(DIP) - WIDTH * math.cos(DIP))
        topple = turning / below if turning > 0 else 0.0
        slide = pushed - weight * (math.cos(DIP) * tangent - math.sin(DIP)) / (1 - tangent**2)
        pushed = max(topple, slide, 0.0)
        ways[n - 1] = "stable" if pushed == 0 else "topples" if topple >= slide else "slides"
        result[n - 1] = pushed
    return result, ways


def limiting_tangent(**arms):
    """At which the toe block needs no force from outside."""
    low, high = 0.6, 0.95
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if forces(middle, **arms)[0][0] > 0 else (low, middle)
    return high


if __name__ == "__main__":
    t = limiting_tangent()
    print(t, math.degrees(math.atan(t)), limiting_tangent(a2=5.0))
    for n, (force, way) in enumerate(zip(*forces(t)), start=1):
        print(n, HEIGHTS[n - 1], f"{force / 1e3:.1f} kN/m", way)
