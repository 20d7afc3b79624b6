#!/usr/bin/env python3
"""Draws the pictures of docs/theory/contact-potential.md: potential-pair.svg, potential-strip.svg, seam-force.svg and plane-life.svg.

    docs/theory/pictures/draw-potential.py [FILE]
    docs/theory/pictures/draw-potential.py --numbers

The curves are the formulas of that page; forces at a seam are those of seam-force.csv beside this, which tests/measure/seam_force.py makes of a run. Needs the
Python standard library only. With a FILE: only the picture of that name, there. With --numbers: what the page says of a strip, as the formulas give it; draws nothing.
"""
import csv
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
# Of packages/contact/src/coplane_contact/ContactEnergy.hpp, by the same names.
WAY_OUT_FROM = 0.25
WAY_OUT_TO = 1
WIDENING = 2
WIDEST = 0.5
PART = 5
COS_OPPOSED = 0.004  # the default of contact.cos_opposed
FIRST, SECOND, SHARED, OLD, GREY = "#2a5db0", "#c05a00", "#2c8a4b", "#a00", "#777"


def attributes(style):
    return "".join(f' {name.replace("_", "-")}="{value}"' for name, value in style.items())


def text(x, y, words, **style):
    return f'<text x="{x:.1f}" y="{y:.1f}"{attributes(style)}>{words}</text>'


def line(x1, y1, x2, y2, **style):
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}"{attributes({"stroke": "#000", **style})}/>'


def path(points, closed=False, **style):
    kind = "polygon" if closed else "polyline"
    return f'<{kind} points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in points)}"{attributes({"fill": "none", **style})}/>'


def arrow(x1, y1, x2, y2, **style):
    length = math.hypot(x2 - x1, y2 - y1)
    ux, uy = (x2 - x1) / length, (y2 - y1) / length
    head = [(x2, y2), (x2 - 9 * ux - 4 * uy, y2 - 9 * uy + 4 * ux), (x2 - 9 * ux + 4 * uy, y2 - 9 * uy - 4 * ux)]
    colour = style.get("stroke", "#000")
    return line(x1, y1, x2 - 8 * ux, y2 - 8 * uy, **style) + path(head, closed=True, fill=colour)


def picture(width, height, parts):
    return "\n".join(
        [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}"'
         ' font-family="Helvetica, Arial, sans-serif" font-size="14">',
         "  <!-- Made by docs/theory/pictures/draw-potential.py; do not edit. -->",
         f'  <rect width="{width}" height="{height}" fill="white"/>'] + ["  " + part for part in parts] + ["</svg>", ""])  # fmt: skip


class Chart:
    """Axes in a frame: left, top, right, bottom in pixels; limits and ticks of both axes."""

    def __init__(self, frame, x_limits, y_limits, x_ticks, y_ticks, x_name, y_name):
        self.frame, self.x_limits, self.y_limits = frame, x_limits, y_limits
        left, top, right, bottom = frame
        self.parts = []
        for value, words in x_ticks:
            self.parts += [line(self.x(value), top, self.x(value), bottom, stroke="#ddd"), text(self.x(value), bottom + 18, words, text_anchor="middle")]
        for value, words in y_ticks:
            self.parts += [line(left, self.y(value), right, self.y(value), stroke="#ddd"), text(left - 6, self.y(value) + 5, words, text_anchor="end")]
        self.parts += [line(left, bottom, right, bottom), line(left, bottom, left, top), text((left + right) / 2, bottom + 40, x_name, text_anchor="middle"),
                       text(left - 34, top - 12, y_name)]  # fmt: skip

    def x(self, value):
        return self.frame[0] + (self.frame[2] - self.frame[0]) * (value - self.x_limits[0]) / (self.x_limits[1] - self.x_limits[0])

    def y(self, value):
        return self.frame[3] - (self.frame[3] - self.frame[1]) * (value - self.y_limits[0]) / (self.y_limits[1] - self.y_limits[0])

    def curve(self, points, colour, **style):
        self.parts.append(path([(self.x(x), self.y(y)) for x, y in points], stroke=colour, stroke_width=2, **style))

    def legend(self, x, y, entries):
        """At x, y in pixels: (colour, dashes or None, words)."""
        for row, (colour, dashes, words) in enumerate(entries):
            style = {"stroke_dasharray": dashes} if dashes else {}
            self.parts += [line(x, y + 20 * row, x + 26, y + 20 * row, stroke=colour, stroke_width=2, **style), text(x + 34, y + 5 + 20 * row, words)]


# --- the formulas of the page -------------------------------------------------------------------------------------------------
def smooth(z):
    """0 below 0, 1 above 1, between them z^2 (3 - 2 z): phi."""
    z = min(max(z, 0.0), 1.0)
    return z * z * (3 - 2 * z)


def smoother(z):
    """The same with two vanishing derivatives at both ends, z^3 (10 - 15 z + 6 z^2): chi."""
    z = min(max(z, 0.0), 1.0)
    return z**3 * (10 - 15 * z + 6 * z * z)


def way_out(ratio):
    """chi of rho = V^2 / (S b), for an even closure w / 2c."""
    return smoother((ratio - WAY_OUT_FROM) / (WAY_OUT_TO - WAY_OUT_FROM))


def opposition(xi, relative_depth):
    """phi of xi = -n0 n1, for an even closure of so much of the faces' size."""
    wanted = (WIDENING * relative_depth) ** 2
    width = math.sqrt((2 * COS_OPPOSED) ** 2 + wanted / (1 + wanted / WIDEST**2))
    return smooth((xi - COS_OPPOSED) / width)


def hardened(z):
    """Pressure over stiffness times depth limit of an even closure z = c / depth limit: d/dz of H z^2 / 2."""
    rest = z**4 / (1 + z**4)
    return z * (1 + PART * rest) + 0.5 * z * z * PART * 4 * z**3 / (1 + z**4) ** 2


def bottom(width):
    """Energy over k c^3 and length of a bottom of closure c that is so many c wide, between two edges."""
    return 0.5 * width * way_out(width / 2)


def front(width):
    """The same of the front of that bottom: its closure is that width, it is as high as c."""
    return 0.5 * width * width * way_out(1 / (2 * width))


def seam(width):
    """Of a block that slides over a seam: what both have there less what its bottom gives up on the first slab."""
    return bottom(width) + front(width) - 0.5 * width


def strip_numbers():
    """Extremes of the strip by its width in c: [(name, unit of the value, value, width)]."""
    step = 1e-4
    widths = [i * step for i in range(1, round(3 / step))]

    def largest(f):
        return max((f(w), w) for w in widths)

    def slope(w):
        return (seam(w + step / 2) - seam(w - step / 2)) / step

    deepest, where = largest(lambda w: -seam(w))
    return [("front where it begins to fall", "k c^3", front(0.5), 0.5), ("front, largest", "k c^3", *largest(front)), ("front after its end", "k c^3", front(2), 2),
            ("over a seam, largest rise", "k c^3", *largest(seam)), ("over a seam, depth of the trough", "k c^3", deepest, where),
            ("over a seam, largest pull", "k c^2", *largest(lambda w: -slope(w))), ("over a seam, largest brake", "k c^2", *largest(slope))]  # fmt: skip


# --- pictures ----------------------------------------------------------------------------------------------------------------------
def pair():
    """Two edges that lie in each other, tilted by the same angle against their common plane."""
    turn, half = math.radians(9), 135
    lower = ((150 - half, 158 + half * math.tan(turn)), (150 + half, 158 - half * math.tan(turn)))
    upper = ((205 - half, 158 - half * math.tan(turn)), (205 + half, 158 + half * math.tan(turn)))
    (ax, ay), (bx, by) = lower
    (cx, cy), (dx, dy) = upper
    plane = 158
    crossing = [x for x in range(16, 340) if (upper[0][1] + (x - cx) * math.tan(turn)) > (lower[0][1] - (x - ax) * math.tan(turn))]
    left, right = max(min(crossing), cx, ax), min(max(crossing), bx, dx)
    parts = [path([(ax, ay), (bx, by), (bx, 250), (ax, 250)], closed=True, fill="#cfe0f5"),
             path([(cx, cy), (dx, dy), (dx, 62), (cx, 62)], closed=True, fill="#f8dcc0", fill_opacity=0.75),
             line(ax, ay, bx, by, stroke=FIRST, stroke_width=3), line(cx, cy, dx, dy, stroke=SECOND, stroke_width=3),
             line(5, plane, 350, plane, stroke=GREY, stroke_dasharray="6 4"), line(left, plane, right, plane, stroke=SHARED, stroke_width=5)]  # fmt: skip
    for x in range(int(left) + 8, int(right), 16):
        parts.append(line(x, ay - (x - ax) * math.tan(turn), x, cy + (x - cx) * math.tan(turn), stroke=SHARED, stroke_width=1))
    parts += [arrow(60, plane, 60, plane - 70), text(66, plane - 60, "n", font_style="italic"),
              arrow(112, 164, 112 + 60 * math.sin(-turn), 164 - 60 * math.cos(turn), stroke=FIRST), text(84, 112, "n<tspan font-size='10' dy='3'>0</tspan>", fill=FIRST),
              arrow(312, 175, 312 + 60 * math.sin(-turn), 175 + 60 * math.cos(turn), stroke=SECOND),
              text(312, 232, "n<tspan font-size='10' dy='3'>1</tspan>", fill=SECOND), text(176, 204, "Ω, closure c(p)", fill=SHARED), text(20, 242, "face 0", fill=FIRST),
              text(262, 80, "face 1", fill=SECOND), text(289, plane - 6, "common plane", fill=GREY, font_size=12)]  # fmt: skip

    phi = Chart((420, 40, 600, 230), (0, 1), (0, 1), [(v, f"{v:g}") for v in (0, 0.5, 1)], [(v, f"{v:g}") for v in (0, 0.5, 1)], "ξ = −n₀·n₁", "opposition φ")
    for depth, dashes, colour in ((0.0, "2 3", GREY), (0.1, "6 3", FIRST), (0.4, "none", SECOND)):
        phi.curve([(i / 200, opposition(i / 200, depth)) for i in range(201)], colour, stroke_dasharray=dashes)
    phi.legend(500, 175, [(GREY, "2 3", "c/l → 0"), (FIRST, "6 3", "0.1"), (SECOND, None, "0.4")])

    penalty = Chart((680, 40, 860, 230), (0, 1), (0, 6), [(0, "0"), (0.5, "0.5"), (1, "1")], [(v, str(v)) for v in (0, 2, 4, 6)], "c / depth limit", "pressure / (k · depth limit)")
    penalty.curve([(i / 100, hardened(i / 100)) for i in range(101) if hardened(i / 100) <= 6], SECOND)
    penalty.curve([(0, 0), (1, 1)], GREY, stroke_dasharray="2 3")
    penalty.legend(700, 60, [(SECOND, None, "penalty"), (GREY, "2 3", "k c")])
    return picture(890, 285, parts + phi.parts + penalty.parts)


def strip():
    """A block with an even closure c whose front is w past the open seam of two slabs: bottom on the second slab, front before the hidden side of it."""
    parts = [f'<rect x="20" y="150" width="120" height="90" fill="#cfe0f5" stroke="{FIRST}"/>', f'<rect x="150" y="150" width="170" height="90" fill="#cfe0f5" stroke="{FIRST}"/>',
             f'<rect x="40" y="60" width="170" height="108" fill="#f8dcc0" fill-opacity="0.75" stroke="{SECOND}"/>',
             f'<rect x="150" y="150" width="60" height="18" fill="{SHARED}" fill-opacity="0.6"/>',
             line(150, 140, 150, 110, stroke=GREY), line(210, 190, 210, 110, stroke=GREY, stroke_dasharray="2 3"), arrow(190, 118, 209, 118), arrow(170, 118, 151, 118), text(174, 112, "w"),
             arrow(250, 130, 250, 149), arrow(250, 188, 250, 169), line(205, 168, 265, 168, stroke=GREY, stroke_dasharray="2 3"), text(258, 164, "c"),
             arrow(95, 40, 175, 40), text(105, 32, "way"), text(30, 228, "first slab"), text(205, 228, "second slab")]  # fmt: skip
    chart = Chart((430, 40, 820, 230), (0, 4), (0, 4), [(v, str(v)) for v in range(5)], [(v, str(v)) for v in range(5)], "w / c", "energy / (½ k c³)")
    ratios = [i / 100 for i in range(1, 401)]
    chart.curve([(w, 2 * bottom(w)) for w in ratios], FIRST, stroke_dasharray="6 3")
    chart.curve([(w, 2 * front(w)) for w in ratios], SECOND, stroke_dasharray="6 3")
    chart.curve([(w, 2 * (bottom(w) + front(w))) for w in ratios], SHARED)
    chart.curve([(w, w + w * w) for w in ratios if w + w * w <= 4], OLD, stroke_dasharray="2 3")
    chart.curve([(0, 0), (4, 4)], GREY, stroke_dasharray="2 3")
    chart.legend(850, 80, [(OLD, "2 3", "both count: no way out (χ = 1)"), (SHARED, None, "both, with χ"), (FIRST, "6 3", "of it the bottom"), (SECOND, "6 3", "of it the front"),
                            (GREY, "2 3", "bottom alone, χ = 1")])  # fmt: skip
    return picture(1100, 285, parts + chart.parts)


def seam_force():
    with open(HERE / "seam-force.csv", newline="") as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    length, depth_limit = 0.2, 0.6 * 0.05  # of the block and of its elements, in tests/measure/seam_force.py [m]
    ticks = [(v, str(v)) for v in (0, 50, 100, 150, 200, 250)]
    parts = []
    for left, kind, limits, marks, name in (
        (80, "along", (-0.2, 0.2), (-0.2, -0.1, 0, 0.1, 0.2), "force along the way / load"),
        (510, "up", (0, 1.25), (0, 0.25, 0.5, 0.75, 1, 1.25), "force upwards / load"),
    ):
        chart = Chart((left, 40, left + 340, 250), (-25, 265), limits, ticks, [(v, f"{v:g}".replace("-", "−")) for v in marks], "front past the seam [mm]", name)
        if kind == "along":
            ways = [-0.02, 0, depth_limit, 0.26]
            chart.curve([(1e3 * way, -min(max(way, 0), depth_limit) / length) for way in ways], OLD, stroke_dasharray="5 3")
            chart.legend(left + 105, 62, [(OLD, "5 3", "front as a pair by itself, χ = 1"), (SHARED, None, "computed")])
        chart.curve([(1e3 * row["front_past_seam"], row[kind]) for row in rows], SHARED)
        parts += chart.parts
    return picture(880, 305, parts)


def life():
    """States of a plane and what leads from one to another."""

    def state(x, y, words, below, colour, width=150):
        return [f'<rect x="{x - width / 2:.0f}" y="{y - 26}" width="{width}" height="52" rx="10" fill="{colour}" stroke="#345"/>', text(x, y - 4, words, text_anchor="middle", font_weight="bold"),
                text(x, y + 14, below, text_anchor="middle", font_size=12)]  # fmt: skip

    small = {"font_size": 12}
    parts = state(110, 60, "slot", "candidate of a search", "#eee")
    parts += state(470, 60, "carries", "stick or slip", "#d7efdd")
    parts += state(830, 60, "open", "keeps its history", "#eee")
    parts += state(470, 235, "refused", "deep, or hidden", "#f6d5d5")
    parts += state(830, 235, "missed", "no candidate any more", "#eee", 170)
    parts += state(110, 235, "gone", "what it stored is booked", "#fff", 170)
    parts += [arrow(186, 48, 394, 48), text(290, 39, "faces share a part with c &gt; 0;", text_anchor="middle", **small),
              text(290, 66, "takes over what neighbours on its", text_anchor="middle", **small), text(290, 81, "surface remember", text_anchor="middle", **small),
              arrow(546, 48, 754, 48), text(650, 39, "c &lt; 0, or nothing shared", text_anchor="middle", **small),
              arrow(754, 72, 546, 72), text(650, 90, "closes again", text_anchor="middle", **small),
              path([(150, 87), (150, 130), (440, 130), (440, 200)], stroke="#000"), arrow(440, 195, 440, 208),
              text(160, 122, "first overlap deep inside, or behind a hidden side", **small),
              path([(394, 222), (350, 222), (350, 170), (80, 170), (80, 95)], stroke="#000"), arrow(80, 100, 80, 87), text(90, 162, "faces share nothing: a slot again", **small),
              arrow(394, 247, 196, 247), text(295, 263, "no candidate any more", text_anchor="middle", **small),
              arrow(815, 87, 815, 208), text(808, 150, "no candidate", text_anchor="end", **small), arrow(845, 208, 845, 87), text(853, 150, "found", **small),
              text(853, 165, "again:", **small), text(853, 180, "woken", **small), path([(830, 262), (830, 285), (110, 285), (110, 270)], stroke="#000"),
              arrow(110, 275, 110, 262), text(640, 301, "for a second search no candidate, unless it is declared", text_anchor="middle", **small)]  # fmt: skip
    return picture(930, 315, parts)


PICTURES = {"potential-pair.svg": pair, "potential-strip.svg": strip, "seam-force.svg": seam_force, "plane-life.svg": life}
if __name__ == "__main__":
    if sys.argv[1:] == ["--numbers"]:
        for name, unit, value, width in strip_numbers():
            print(f"{name}: {value:.3f} {unit} at w = {width:.2f} c")
        sys.exit()
    for name, draw in PICTURES.items():
        if len(sys.argv) < 2 or Path(sys.argv[1]).name == name:
            Path(sys.argv[1] if len(sys.argv) > 1 else HERE / name).write_text(draw())
