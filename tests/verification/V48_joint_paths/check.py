"""V48 (and V12, V13 for one point): every joint law on the paths of exodus_inputs/joint_paths."""

import math
import os
import pathlib
import subprocess

import numpy
from coplanetest import Case, program, tables

case = Case("V48", __file__)
examples = pathlib.Path(os.environ["COPLANE_SOURCE"]) / "exodus_inputs/joint_paths"


def point(*arguments):
    done = subprocess.run(
        [program.binary("coplane_point"), *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    return done.returncode, done.stdout


class Path:
    """Columns of a path by their names without units."""

    def __init__(self, deck, name):
        self.name = f"{deck}, {name}"
        self.columns = tables.columns(f"{deck}_{name}.csv")

    def __getattr__(self, name):
        return self.columns[name]

    def check(self, what, value, reference, tolerance, relative=True):
        case.check(f"{self.name}: {what}", value, reference, tolerance, relative=relative)

    def energies(self, tolerance):
        """Work is stored or dissipated, and nothing dissipated ever comes back."""
        most = max(numpy.max(numpy.abs(self.work)), 1e-12)
        self.check("balance over work", numpy.max(numpy.abs(self.balance)) / most, 0, tolerance, relative=False)
        least = min(numpy.min(numpy.diff(getattr(self, part))) for part in ("friction", "fracture", "hysteresis"))
        self.check("dissipation that came back [J/m^2]", min(least, 0), 0, 0, relative=False)


def area(x, y):
    return float(numpy.sum(0.5 * (y[1:] + y[:-1]) * numpy.diff(x)))


# --- all decks run, and the list of them is complete -------------------------------------------------

decks = sorted(path.stem for path in examples.glob("*.yaml"))
known = ["barton_bandis", "bilinear", "closure_curve", "crushing", "friction", "linear", "mortar", "penalty", "points", "table"]
case.check_equal("decks", decks, known)
for deck in decks:
    code, output = point(examples / f"{deck}.yaml")
    case.check_equal(f"{deck}: exit code", code, 0)
    if code:
        print(output)

# --- closure curve (V12): k 1e11, c_m 2e-4 ------------------------------------------------------------

cycle = Path("closure_curve", "cycle")
loss = 1e11 * 2e-4**2 * (-0.8 - math.log1p(-0.8) - 0.32)
cycle.check("traction at half of c_m [Pa]", cycle.normal_traction[200], 20e6, 1e-12)
cycle.check("traction at .75 / 2 c_m, on the tangent [Pa]", cycle.normal_traction[300], 10e6, 1e-10)
cycle.check("traction at the residual closure [Pa]", cycle.normal_traction[400], 0, 1e-6, relative=False)
cycle.check("traction at .8 c_m [Pa]", cycle.normal_traction[600], 80e6, 1e-12)
cycle.check("hysteresis [J/m^2]", cycle.hysteresis[-1], loss, 1e-10)
cycle.check("stored at .8 c_m [J/m^2]", cycle.stored[600], 1280, 1e-10)
cycle.check("work [J/m^2]", cycle.work[-1], loss, 1e-3)
cycle.energies(1e-3)

# --- straight joints (V13) -----------------------------------------------------------------------------

shear = Path("linear", "shear")
drag = -shear.shear_traction_x
start = int(numpy.argmax(shear.normal_traction > 2e6 * (1 - 1e-9)))
stuck = (shear.slip_x < 2.35e-5) & (numpy.arange(len(drag)) <= start + 200) & (numpy.arange(len(drag)) >= start)
shear.check("stiffness before slip [Pa/m]", numpy.max(drag[stuck]) / numpy.max(shear.slip_x[stuck]), 5e10, 1e-10)
shear.check("strength [Pa]", numpy.max(drag), 1.2e6, 1e-10)
shear.check("strength after reversal [Pa]", -numpy.min(drag), 1.2e6, 1e-10)
# 1e-4 - 2.4e-5, then twice (way less 4.8e-5 of the spring): 7.6e-5 + 1.02e-4 + 5.2e-5.
shear.check("slip path [m]", shear.slip_path[-1], 2.3e-4, 1e-10)
shear.check("friction [J/m^2]", shear.friction[-1], 1.2e6 * 2.3e-4, 1e-10)
shear.energies(1e-10)

circle = Path("linear", "circle")
# The spring is a rope of length a whose end P goes around the circle in steps t and drags its other end Q along a
# circle of radius r: R^2 = r^2 + 2 a r sin(t/2) + a^2; its angle to the tangent has the cosine r cos(t/2) / R.
R, a, t = 1e-3, 2.4e-5, 2 * math.pi / 10000
h = a * math.sin(t / 2)
r = -h + math.sqrt(h * h + R * R - a * a)
angle = 2 * math.pi
tangent = numpy.array([-math.sin(angle), math.cos(angle)])
pull = -numpy.array([circle.shear_traction_x[-1], circle.shear_traction_y[-1]]) / 1.2e6
circle.check("strength around the circle [Pa]", numpy.min(circle.shear_traction[-9000:]), 1.2e6, 1e-10)
circle.check("cosine of the lag", float(pull @ tangent), r * math.cos(t / 2) / R, 1e-9)
circle.energies(1e-10)

tension = Path("linear", "tension")
tension.check("largest tension [Pa]", -numpy.min(tension.normal_traction), 1e6, 2e-3)
tension.check("fracture [J/m^2]", tension.fracture[-1], 5, 1e-10)
tension.check("traction when pressed again [Pa]", tension.normal_traction[-1], 1e6, 1e-10)
case.check_equal("linear, tension: broken", [tension.bonded[0], tension.bonded[-1]], [1, 0])
tension.energies(0.01)

press, slip = Path("penalty", "press_and_open"), Path("penalty", "shear")
press.check("stiffness [Pa/m]", press.normal_traction[-1] / press.closure[-1], 1e12, 1e-12)
press.check("stored [J/m^2]", press.stored[-1], 200, 1e-10)
press.energies(1e-3)
slip.check("strength [Pa]", numpy.max(slip.shear_traction), 3e6, 1e-10)
# 2e-5 less 6e-6 of the spring, then 4e-5 less 1.2e-5.
slip.check("friction [J/m^2]", slip.friction[-1], 3e6 * (1.4e-5 + 2.8e-5), 1e-10)
slip.energies(1e-10)

corner = Path("points", "corner")
corner.check("strength at the corner [Pa]", -corner.shear_traction_x[2000], 1.2e6, 1e-10)
# The spring turns like a dragged rope: after 1e-4 m across, its angle w has ln tan(w/2) fallen by 1e-4 / a.
lag = 2 * math.atan(math.exp(-1e-4 / 2.4e-5))
found = math.atan2(-corner.shear_traction_x[3000], -corner.shear_traction_y[3000])
corner.check("angle after the corner [rad]", found, lag, 0.01)
corner.check("traction when opened [Pa]", corner.shear_traction[-1], 0, 0, relative=False)
corner.energies(1e-3)

# --- table ------------------------------------------------------------------------------------------------

table = Path("table", "cycles")
table.check("traction at 1.5e-4 [Pa]", table.normal_traction[200], 2.5e6, 1e-12)
table.check("traction at 2.3e-4 [Pa]", table.normal_traction[600], 7e6, 1e-12)
table.check("traction beyond the last point [Pa]", table.normal_traction[1000], 14e6, 1e-12)
# Work to 3e-4: 50 + 250 + 325 + 575; given back 14e6^2 / 2e11.
table.check("hysteresis [J/m^2]", table.hysteresis[-1], 1200 - 980, 1e-10)
table.energies(1e-3)

# --- friction of speed, dilation --------------------------------------------------------------------------

for name, speed in (("slow", 1e-6), ("medium", 0.2), ("fast", 20)):
    path = Path("friction", name)
    mu = 0.4 + 0.3 * math.exp(-speed / 0.2)
    path.check("strength [Pa]", path.shear_traction[-1], mu * 2e6, 1e-9)
    path.energies(1e-9)
free, confined = Path("friction", "free"), Path("friction", "confined")
free.check("dilation [m]", free.offset[-1], 0.1 * 1e-3, 1e-3)
free.check("strength [Pa]", free.shear_traction[-1], 1.2e6, 1e-9)
free.check("rise of the gap [m]", free.gap[-1] + 2e-5, 1e-4, 1e-3)
free.energies(1e-3)
# The blocks give way: of 1e-4 m of dilation the joint (1e11 Pa/m) and they (1e10) take 1 : 10.
pressed = 2e6 + 1e-4 / (1 / 1e11 + 1 / 1e10)
confined.check("compression after dilation [Pa]", confined.normal_traction[-1], pressed, 1e-3)
confined.check("strength [Pa]", confined.shear_traction[-1], 0.6 * pressed, 1e-3)
confined.energies(1e-3)

# --- Barton-Bandis -----------------------------------------------------------------------------------------

mobilised = ([0.3, 0.6, 1, 2, 4, 10, 100], [0, 0.75, 1, 0.85, 0.7, 0.5, 0])
for name, sigma in (("low", 1e6), ("high", 10e6)):
    path = Path("barton_bandis", name)
    i = 8 * math.log10(100e6 / sigma)

    def strength(ratio):
        return sigma * math.tan(math.radians(30 + i * numpy.interp(ratio, *mobilised)))

    path.check("peak [Pa]", numpy.max(path.shear_traction), strength(1), 5e-3)
    path.check("slip at the peak [m]", path.slip_path[numpy.argmax(path.shear_traction)], 2e-3, 5e-3)
    path.check("last strength [Pa]", path.shear_traction[-1], strength(path.slip_path[-1] / 2e-3), 5e-3)
    s = numpy.linspace(0, path.slip_path[-1], 100001)
    slope = numpy.tan(numpy.radians(0.5 * i * numpy.interp(s / 2e-3, *mobilised)))
    path.check("dilation [m]", path.offset[-1], area(s, slope), 5e-3)
    path.energies(1e-3)
path = Path("barton_bandis", "confined")
rise = path.normal_traction[-1] - 1e6
path.check("rise of the compression over opening [Pa/m]", rise / (path.gap[-1] + 1e6 / (2e10 + 1e6 / 2e-4)), 1e9, 1e-6)
path.energies(1e-3)
path = Path("barton_bandis", "cycles")
# Bandis' estimate: k 15.35e9, c_m .2273574e-3.
x = 1.8e-4 / 2.273574e-4
path.check("largest compression [Pa]", numpy.max(path.normal_traction), 15.35e9 * 1.8e-4 / (1 - x), 1e-5)
path.energies(1e-3)

# --- cohesive joints (V48) -----------------------------------------------------------------------------------

ft, c, G1, G2, mu, kn, ks = 0.25e6, 0.35e6, 18, 125, 0.75, 8.2e10, 3.6e10
for deck in ("mortar", "bilinear"):
    pulled = Path(deck, "tension")
    pulled.check("peak of the tension [Pa]", -numpy.min(pulled.normal_traction), ft, 0.01)
    pulled.check("area under the tension [J/m^2]", area(pulled.gap, -pulled.normal_traction), G1, 0.01)
    pulled.check("fracture [J/m^2]", pulled.fracture[-1], G1, 0.01)
    pulled.energies(1e-3)
    at = int(numpy.searchsorted(pulled.gap, 1e-4))
    d = pulled.gap[at]
    if deck == "bilinear":
        df, d0 = 2 * G1 / ft, ft / kn
        curve = (1 - df * (d - d0) / (d * (df - d0))) * kn * d
    else:
        k = 1e-4
        for _ in range(50):  # d = f_t exp(-f_t k / G) / k_n + k
            k = d - ft * math.exp(-ft * k / G1) / kn
        curve = ft * math.exp(-ft * k / G1)
    pulled.check("tension at a gap of 0.1 mm [Pa]", -pulled.normal_traction[at], curve, 1e-6)
    for name, sigma in (("shear_0", 0), ("shear_1", 1e6)):
        sheared = Path(deck, name)
        peak = numpy.max(sheared.shear_traction)
        sheared.check("peak of the shear [Pa]", peak, c + mu * sigma, 0.01)
        sheared.check("last strength [Pa]", sheared.shear_traction[-1], mu * sigma, 1e-3 * c, relative=False)
        dragged = area(sheared.slip_x, -sheared.shear_traction_x)
        spring = (mu * sigma) ** 2 / (2 * ks)
        cohesive = dragged - mu * sigma * sheared.slip_path[-1] - spring
        sheared.check("area of the cohesive part [J/m^2]", cohesive, G2, 0.01)
        sheared.check("fracture [J/m^2]", sheared.fracture[-1], G2, 0.01)
        sheared.energies(1e-3)
    again = Path(deck, "cycle")
    again.check("compression when pressed after breaking [Pa]", again.normal_traction[-1], kn * 4e-6, 1e-9)
    again.check("fracture with unloading [J/m^2]", again.fracture[-1], G1, 0.01)
    again.energies(1e-3)
    mixed = Path(deck, "mixed")
    # Opening and slip wear one bond: the fractures of both modes, each over its own energy, add up to at most 1.
    wear = area(mixed.inelastic_opening, -mixed.normal_traction) / G1
    wear += area(mixed.inelastic_slip, mixed.shear_traction) / G2
    mixed.check("damage", mixed.damage[-1], 1, 0.01)
    mixed.check("sum of the modes' shares of their energies", wear, 1, 0.02)
    mixed.energies(1e-3)

# --- crushing: f_m 10.5 MPa, G_fc 5 kJ/m^2, k_p 0.09 mm, a tenth is left, C_ss 9 ------------------------------------------------

fm, Gc, kp = 10.5e6, 5e3, 9e-5
L = 75 / 67 * Gc / fm


def strength_at(k):
    after = fm * (1 - 0.5 * ((k - kp) / L) ** 2)
    rest = fm * (0.1 + 0.4 * numpy.exp(-(k - kp - L) / (0.4 * L)))
    before = fm * (1 / 3 + 2 / 3 * numpy.sqrt(numpy.maximum(2 * k / kp - (k / kp) ** 2, 0)))
    return numpy.where(k < kp, before, numpy.where(k < kp + L, after, rest))


crush = Path("crushing", "crush")
crush.check("peak [Pa]", numpy.max(crush.normal_traction), fm, 1e-4)
k = crush.closure - crush.normal_traction / kn
crush.check("compression against f(k), over its peak", numpy.max(numpy.abs(crush.normal_traction - strength_at(k))[k > 1e-7]) / fm, 0, 1e-9, relative=False)
peak = int(numpy.argmax(crush.normal_traction))
# The path ends where 2e-5 of the exponential is left; the strength's fall gives elastic energy back.
beyond = area(k[peak:], crush.normal_traction[peak:] - 0.1 * fm)
crush.check("area after the peak and above the residual [J/m^2]", beyond, Gc, 1e-3)
crush.check("hysteresis [J/m^2]", crush.hysteresis[-1], fm * kp * (1 / 3 + math.pi / 6) + Gc + 0.1 * fm * (k[-1] - kp), 1e-3)
crush.energies(1e-4)
for name, loss in (("cycle", 0), ("cycle_lost", 0.5)):
    cycle = Path("crushing", name)
    cycle.energies(1e-4)
    # Each stroke down goes along a line to (1 - loss) k.
    for stroke in (1, 3, 5):
        down = slice(2000 * stroke, 2000 * stroke + 40)
        slope = numpy.diff(cycle.normal_traction[down]) / numpy.diff(cycle.closure[down])
        f = cycle.normal_traction[2000 * stroke]
        k = cycle.closure[2000 * stroke] - f / kn
        cycle.check(f"slope of unloading {stroke} [Pa/m]", float(numpy.median(slope)), f / (f / kn + loss * k), 1e-6)
        cycle.check(f"straightness of unloading {stroke}", float(numpy.ptp(slope) / numpy.median(slope)), 0, 1e-6, relative=False)
lost = Path("crushing", "tension_lost")
lost.energies(1e-3)
for stroke in (1, 3):
    f, d = -lost.normal_traction[2000 * stroke], lost.gap[2000 * stroke]
    slope = (lost.normal_traction[2000 * stroke + 100] + f) / (d - lost.gap[2000 * stroke + 100])
    lost.check(f"slope of unloading {stroke} [Pa/m]", slope, f / (f / kn + 0.5 * (d - f / kn)), 1e-6)
for part in (5, 7, 9):
    sheared = Path("crushing", f"sheared_{part}")
    ellipse = numpy.sqrt(sheared.normal_traction**2 + 9 * sheared.shear_traction**2)
    sheared.check("compression before the shear, over the strength", sheared.normal_traction[20000] / fm, part / 10, 1e-4)
    # The compression falls meanwhile: at 0.5 of the strength friction takes over just before the peak.
    sheared.check("largest ellipse of the tractions, over the strength", numpy.max(ellipse) / fm, 1, 2e-3 if part == 5 else 1e-4)
    held = c + mu * sheared.normal_traction - sheared.shear_traction
    sheared.check("shear beyond friction and cohesion [Pa]", max(-numpy.min(held), 0), 0, 1e-6, relative=False)
    sheared.energies(2e-3)

# --- errors -----------------------------------------------------------------------------------------------------

linear = examples / "linear.yaml"
code, output = point()
case.check_equal("no deck: exit code", code, 2)
code, output = point(linear, "--set", "joints.rough.frictoin=0.5")
case.check_equal("misspelt key: exit code", code, 3)
case.check_equal("misspelt key: suggestion", "Did you mean 'friction'?" in output, True)
code, output = point(linear, "--set", "joint_paths.shear.joint=ruogh")
case.check_equal("unknown joint: exit code and text", [code, "is not a card in joints. Did you mean 'rough'?" in output], [3, True])
code, output = point(linear, "--set", "joint_paths.shear.output=no/such/folder.csv")
case.check_equal("no folder: exit code", code, 5)
# All that is wrong is told at once: of the deck, then of the file, with line and column.
pathlib.Path("bad.csv").write_text("time,gap,x,y\n1,0,0,0\n2,0, zero,0\n\n3,0,0\n0.5,0,0,0\n4,nan,0,0\n")
pathlib.Path("bad.yaml").write_text(
    "joints: {rough: {friction: 0.5}}\njoint_paths:\n  p: {type: points, joint: rough, file: bad.csv}\n"
)
code, output = point("bad.yaml", "--set", "elements={thickness: 1, modulus: 1e9}")
expected = ["bad.csv:3:6: slip in x = 'zero' is not a finite number [m]", "bad.csv:5:1: a row of 3 values", "bad.csv:6:1: the time 0.5 s comes after 1 s",
            "bad.csv:7:3: gap = 'nan' is not a finite number [m]"]
case.check_equal("bad rows: exit code and places", [code, [text in output for text in expected], output.count("bad.csv:")], [3, [True] * 4, 4])
code, output = point("bad.yaml")
elements = "bad.yaml:3:28: joint_paths.p.joint = 'rough' has a stiffness that comes from the elements"
case.check_equal("penalty without elements, and bad rows", [code, elements in output, [text in output for text in expected]], [3, True, [True] * 4])
if code != 3:
    print(output)
pathlib.Path("bad.csv").write_text("time,gap,x,y\n" + 30 * "a,b,c,d\n")
code, output = point("bad.yaml", "--set", "elements={thickness: 1, modulus: 1e9}")
case.check_equal("a file of another kind: exit code and lines", [code, output.count("bad.csv:"), "bad.csv: 10 more rows" in output], [3, 21, True])
code, output = point("bad.yaml", "--set", "elements={thickness: 1, modulus: 1e9}", "--set", "joint_paths.p.file=bad.cvs")
case.check_equal("a file that is not there", [code, "file = 'bad.cvs' cannot be read or is empty. There is a file 'bad.csv': is that meant?" in output], [3, True])

case.finish()
