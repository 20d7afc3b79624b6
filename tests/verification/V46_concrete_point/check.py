"""V46: material laws at one point, through coplane_point and the decks of exodus_inputs/material_paths."""

import math
import os
import pathlib
import subprocess
import sys

import numpy
import yaml
from coplanetest import Case, program, tables

case = Case("V46", __file__)
examples = pathlib.Path(os.environ["COPLANE_SOURCE"]) / "exodus_inputs/material_paths"


def point(*arguments):
    done = subprocess.run(
        [program.binary("coplane_point"), *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    return done.returncode, done.stdout


class Path:
    """Columns of a path by their names without units; stresses in MPa, compression positive."""

    def __init__(self, deck, name):
        self.name = name if deck == "concrete_c40" else f"{deck} {name}"
        self.columns = tables.columns(f"{deck}_{name}.csv")
        self.axial = -self.stress_xx / 1e6
        self.shortening = -self.strain_xx

    def __getattr__(self, name):
        return self.columns[name]

    def check(self, what, value, reference, tolerance, relative=True):
        case.check(f"{self.name}: {what}", value, reference, tolerance, relative=relative)

    def table(self, what, x, y, pairs, tolerance=0.01):
        """Values of y where x, which rises, has reached those of the table."""
        for at, reference in pairs:
            i = int(numpy.argmax(x >= at - 1e-6 * abs(at)))
            self.check(f"{what} at {at:g} [MPa]", y[i], reference, tolerance)

    def dissipates(self):
        """Nothing that was dissipated ever comes back."""
        least = numpy.min(numpy.diff(self.dissipation))
        self.check("dissipation that came back [J/m^3]", min(least, 0), 0, 1e-9 * self.dissipation[-1], relative=False)


decks = sorted(path.stem for path in examples.glob("*.yaml"))
case.check_equal("decks", decks, ["ceramics", "clay_brick", "concrete_c40", "concrete_hjc", "concrete_kcc", "concrete_rates", "metals", "rock_masses", "rubber"])
for deck in decks:
    code, output = point(examples / f"{deck}.yaml")
    case.check_equal(f"{deck}: exit code", code, 0)
    if code:
        print(output)
    drawn = subprocess.run([sys.executable, str(examples / "plot.py"), deck, "."], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    case.check_equal(f"{deck}: exit code of plot.py", drawn.returncode, 0)
    picture = pathlib.Path(f"{deck}.svg").read_text() if drawn.returncode == 0 else drawn.stdout
    case.check_within(f"{deck}: curves in the picture", picture.count("<polyline"), 1, 100)

# --- pseudo-cap concrete: the table of docs/theory/materials.md ------------------------------------------

c40 = {path.stem[len("concrete_c40_") :]: Path("concrete_c40", path.stem[len("concrete_c40_") :])
       for path in pathlib.Path(".").glob("concrete_c40_*.csv")}
compression = c40["compression"]
peak = int(numpy.argmax(compression.axial))
compression.check("peak [MPa]", compression.axial[peak], 40, 0.005)
compression.check("strain at the peak", compression.shortening[peak], 1.2121e-3, 0.01)
compression.table(
    "stress", compression.shortening, compression.axial,
    [(0.002, 39.22), (0.005, 36.11), (0.01, 30.71), (0.02, 20.41), (0.05, 5.42)],
)
at = int(numpy.argmax(compression.shortening >= 0.005 - 1e-9))
compression.check("volume strain at 0.005", math.log(compression.volume_ratio[at]), 0.00235, 0.01)
large = c40["compression_large"]
large.table("stress", large.shortening, large.axial, [(0.002, 31.46), (0.005, 8.77), (0.01, 2.33)])

tension = c40["tension"]
tension.check("peak [MPa]", -min(tension.axial), 4, 0.005)
tension.table(
    "stress", tension.strain_xx, -tension.axial, [(0.001, 2.9535), (0.002, 2.0981), (0.004, 1.0660), (0.008, 0.2788)]
)
tension.check("energy times size at 0.012 [J/m^2]", tension.energy[-1] * 0.01, 117.8, 0.03)

for confinement, strength in ((2, 53.07), (5, 70.34), (10, 95.04), (20, 135.43), (50, 224.55), (100, 332.32), (200, 496.43)):
    path = c40[f"triaxial_{confinement}"]
    path.check("peak [MPa]", max(path.axial), strength, 0.005)
for confinement, compaction in ((20, 0.0097), (50, 0.030), (100, 0.049), (200, 0.068)):
    path = c40[f"triaxial_{confinement}"]
    path.check("compaction at the peak", path.compaction[int(numpy.argmax(path.axial))], compaction, 0.03)
c40["biaxial"].check("peak [MPa]", max(c40["biaxial"].axial), 46, 0.005)
c40["shear"].check("peak [MPa]", max(c40["shear"].stress_xy) / 1e6, 3.904, 0.005)

hydrostat = c40["hydrostat_far"]
shrinking = -numpy.log(hydrostat.volume_ratio)
table = [(0.002, 36.85), (0.004, 74.07), (0.01, 98.65), (0.02, 134.79), (0.04, 223.47), (0.06, 346.46), (0.08, 537.75),
         (0.10, 898.63), (0.12, 1624.8)]
hydrostat.table("pressure", shrinking, hydrostat.pressure / 1e6, table)
for strain, porosity in ((0.01, 0.07536), (0.04, 0.05037), (0.08, 0.01797), (0.12, 0.00048)):
    i = int(numpy.argmax(shrinking >= strain * (1 - 1e-6)))
    hydrostat.check(f"porosity at {strain:g}", hydrostat.porosity[i], porosity, 2e-5, relative=False)
back = c40["hydrostat"]
returned = -numpy.log(back.volume_ratio[801:])
back.table(
    "pressure on the way back", -returned, back.pressure[801:] / 1e6,
    [(-0.038, 168.80), (-0.036, 114.67), (-0.034, 61.08), (-0.032, 8.02)],
)
back.check("pressure at the end [MPa]", back.pressure[-1] / 1e6, -2.35, 0.01)
pulled = c40["hydrostatic_tension"]
pulled.check("peak [MPa]", -min(pulled.pressure) / 1e6, 4, 0.005)
pulled.table(
    "tension", numpy.log(pulled.volume_ratio), -pulled.pressure / 1e6, [(0.0005, 3.618), (0.001, 3.030), (0.002, 2.136)]
)
strain = c40["uniaxial_strain"]
sides = -strain.stress_yy / 1e6
strain.table("axial stress", strain.shortening, strain.axial,
             [(0.001, 36.71), (0.002, 73.52), (0.003, 110.41), (0.004, 131.69), (0.01, 157.2), (0.02, 203.8), (0.04, 310.6),
              (0.06, 447.1), (0.1, 1038)])
strain.table("lateral stress", strain.shortening, sides,
             [(0.001, 9.21), (0.002, 18.52), (0.003, 27.91), (0.004, 34.58), (0.01, 51.4), (0.02, 77.2), (0.04, 141.7),
              (0.06, 235.6), (0.1, 687)])
for path in c40.values():
    path.dissipates()

# --- the same concrete at rates: Malvar and Ross in tension, the CEB in compression -----------------------


def tensile_factor(rate, strength=40):
    d = 1 / (1 + 8 * strength / 10)
    return (rate / 1e-6) ** d if rate <= 1 else 10 ** (6 * d - 2) * (rate / 1e-6) ** (1 / 3)


def compressive_factor(rate, strength=40):
    a = 1 / (5 + 9 * strength / 10)
    if rate <= 30e-6:
        return 1.0
    return (rate / 30e-6) ** (1.026 * a) if rate <= 30 else 10 ** (6.156 * a - 2) * (rate / 30e-6) ** (1 / 3)


for rate in ("1e-6", "1e-3", "1", "10", "1000"):
    path = Path("concrete_rates", f"tension_{rate}")
    path.check("strength over ft", -min(path.axial) / 4, tensile_factor(float(rate)), 1e-6)
bounded = Path("concrete_rates", "tension_bounded")
bounded.check("strength over ft", -min(bounded.axial) / 4, tensile_factor(1), 1e-6)
for rate in ("1e-6", "1e-3", "1", "30", "100"):
    path = Path("concrete_rates", f"compression_{rate}")
    path.check("strength over fc", max(path.axial) / 40, compressive_factor(float(rate)), 0.005)
bounded = Path("concrete_rates", "compression_bounded")
bounded.check("strength over fc", max(bounded.axial) / 40, compressive_factor(30), 0.005)
# What is neither lost nor stored is the error of the steps; where the rate falls, strength falls in one step.
K0, G = 33e9 / (3 * 0.6), 33e9 / 2.4
for name in ("swing", "stop", "compression_100"):
    path = Path("concrete_rates", name)
    path.dissipates()
    stored = path.von_mises**2 / (6 * G) + path.pressure**2 / (2 * K0)
    lacking = numpy.max(numpy.abs(path.energy - path.dissipation - stored)) / path.energy[-1]
    path.check("energy neither lost nor stored, over all", lacking, 0, 2e-3, relative=False)

# --- Holmquist, Johnson and Cook --------------------------------------------------------------------------

# Root of s = 0.79 + 1.6 (s / 3)^0.61, the intact strength at the reference rate.
strength = 2.0
for _ in range(200):
    strength = 0.79 + 1.6 * (strength / 3) ** 0.61
intact = Path("concrete_hjc", "compression_intact")
intact.check("strength over fc", max(intact.axial) / 48, strength, 1e-3)
intact.check("root of the formula", strength, 2.0634, 1e-4)
quick = Path("concrete_hjc", "compression_fast")
peak = int(numpy.argmax(quick.axial))
rates = numpy.array([quick.columns[f"strain_{k}"][peak] - quick.columns[f"strain_{k}"][peak - 1] for k in ("xx", "yy", "zz")])
rate = math.sqrt(2 / 3 * float(numpy.sum((rates - rates.mean()) ** 2))) / (quick.time[peak] - quick.time[peak - 1])
for _ in range(200):
    strength = (0.79 + 1.6 * (strength / 3) ** 0.61) * (1 + 0.007 * math.log(rate))
quick.check("strength over fc", max(quick.axial) / 48, strength, 1e-3)
quick.check("rate of the deviator [1/s]", rate, 1000, 0.05)

# --- Karagozian and Case ----------------------------------------------------------------------------------

kcc_fc = 45.4
kcc_ft = 6.7 * math.sqrt(kcc_fc / 6894.757293e-6) * 6894.757293e-6
kcc = {path.stem[len("concrete_kcc_"):]: Path("concrete_kcc", path.stem[len("concrete_kcc_"):]) for path in pathlib.Path(".").glob("concrete_kcc_*.csv")}


def kcc_axial(confinement):
    """Root of q = a0 fc + p / (a1 + a2 p / fc), p = confinement + q / 3 [MPa]."""
    q = kcc_fc
    for _ in range(200):
        p = (confinement + q / 3) / kcc_fc
        q = kcc_fc * (0.2956 + p / (0.4463 + 0.0808 * p))
    return confinement + q


for name, confinement in (("compression", 0), ("triaxial_10", 10), ("triaxial_50", 50)):
    kcc[name].check("peak [MPa]", max(kcc[name].axial), kcc_axial(confinement), 1e-3)
kcc["biaxial"].check("peak over fc", max(kcc["biaxial"].axial) / kcc_fc, 1.15, 1e-3)
kcc["tension"].check("peak [MPa]", -min(kcc["tension"].axial), kcc_ft, 2e-3)
for name, width in (("tension", 0.01), ("tension_large", 0.1)):
    kcc[name].check("energy times size [J/m^2]", kcc[name].energy[-1] * width, 73 * kcc_fc**0.18, 2e-3)
rate = 10.0
delta = 1 / (1 + 0.8 * kcc_fc)
faster = 10 ** (6 * delta) * rate ** (1 / 3)
kcc["tension_fast"].check("peak [MPa]", -min(kcc["tension_fast"].axial), kcc_ft * faster, 2e-3)
# The published table is that of 6580 psi; pressures go with the bulk modulus, so with the root of the strength.
table_scale = math.sqrt(kcc_fc / (6580 * 6894.757293e-6))
hydrostat = kcc["hydrostat"]
compression = -numpy.log(hydrostat.volume_ratio)
loading = int(numpy.argmax(compression)) + 1
for strain, pounds in ((0.0043, 7411.48762), (0.0101, 11899.1774), (0.0305, 22608.4370), (0.0513, 34099.6426)):
    found = float(numpy.interp(strain, compression[:1001], hydrostat.pressure[:1001] / 1e6))
    hydrostat.check(f"pressure at {strain:g} [MPa]", found, pounds * 6894.757293e-6 * table_scale, 5e-3)
for path in kcc.values():
    path.dissipates()

# --- ceramics: the one-element tests of Johnson and Holmquist 1994 -----------------------------------------

# Pressure and von Mises stress on the way in, off the figure of the paper [GPa].
figure = {
    "b": [(0.5184, 0.6815), (1.1865, 1.6014), (1.7205, 2.0726), (2.5460, 2.1062), (3.2652, 1.9011), (3.9830, 1.5426), (4.6737, 1.0592),
          (5.4237, 0.4052), (6.1237, 0)],
    "c": [(0.4645, 0.6361), (1.1526, 1.5741), (1.8119, 2.1240), (2.4504, 2.2264), (3.2580, 2.2264), (4.0900, 2.0863), (4.6753, 1.9299),
          (5.2857, 1.7358), (6.0315, 1.4501), (6.5422, 1.5256), (7.1294, 1.5957)],
}
for which, bulking in (("a", 0.56), ("b", 0.72), ("c", 0.65)):
    path = Path("ceramics", f"case_{which}")
    crushed = int(numpy.argmin(path.strain_xx)) + 1
    case.check(f"jh2, case {which}: bulking pressure [GPa]", path.bulking_pressure[-1] / 1e9, bulking, 0.006)
    path.dissipates()
    # Of p = K (1/J - 1) + dp, from the deepest state down to no pressure; q^2 / 6G.
    i, K, G = crushed - 1, 130.95e9, 90.16e9
    free = 1 / (1 - path.bulking_pressure[i] / K)
    stored = K * (math.log(free / path.volume_ratio[i]) - 1 + path.volume_ratio[i] / free) + path.von_mises[i] ** 2 / (6 * G) * path.volume_ratio[i]
    path.check("energy neither lost nor stored, over all", (path.energy[i] - path.dissipation[i] - stored) / path.energy[i], 0, 2e-3, relative=False)
    for pressure, stress in figure.get(which, []):
        found = float(numpy.interp(pressure, path.pressure[:crushed] / 1e9, path.von_mises[:crushed] / 1e9))
        case.check(f"jh2, case {which}: von Mises stress at {pressure} GPa [GPa]", found, stress, 0.05)


def intact(limit, pressure_at_limit, tension, factor, exponent, pressure_over_stress, confinement=0.0):
    """Axial stress [Pa] at which the intact surface is reached: the pressure is confinement + (axial - confinement) pressure_over_stress."""
    over = 0.0
    for _ in range(500):
        over = 1.5 * (limit - pressure_at_limit) * factor * ((confinement + over * pressure_over_stress + tension) / pressure_at_limit) ** exponent
    return confinement + over


tough = (1.46e9 + 2e9 / 1.5, 1.46e9, 0.2e9, 0.93, 0.6, 1 / 3)
for name, confinement in (("compression", 0), ("confined", 0.5e9)):
    path = Path("ceramics", name)
    path.check("peak [MPa]", max(path.axial), intact(*tough, confinement) / 1e6, 1e-3)
    case.check_within(f"{name}: damage at the end, past the peak", float(path.damage[-1]), 1e-4, 0.5)
torn = Path("ceramics", "torn")
torn.check("energy lost over all, when nothing is borne", torn.dissipation[-1] / torn.energy[-1], 1, 0.01)
torn.check("stress at the end [MPa]", float(max(abs(torn.stress_xx[-1]), abs(torn.stress_yy[-1]))), 0, 1e-3, relative=False)
torn.dissipates()
hard = Path("ceramics", "case_c")
first = int(numpy.argmax(hard.damage > 0))
case.check("ceramic_jh2: Hugoniot elastic limit [GPa]", hard.axial[first - 1] / 1e3, 2.7933, 0.02, relative=True)
case.check("ceramic_jh2: pressure there [GPa]", hard.pressure[first - 1] / 1e9, 1.46, 0.02, relative=True)

# --- metals, brick, rubber: one number each from a closed form --------------------------------------------

kinematic = Path("metals", "kinematic")
i = 400  # strain 0.02: Y + Hk ep = E (e - ep)
ep = (200e9 * 0.02 - 300e6) / (210e9)
kinematic.check("stress at 0.02 [MPa]", kinematic.stress_xx[i] / 1e6, 300 + 10e3 * ep, 1e-6)
slow, fast = Path("metals", "slow"), Path("metals", "fast")
case.check("johnson_cook: heat is 0.9 of the plastic work", fast.temperature[-1] - 293,
           0.9 * fast.dissipation[-1] / (7830 * 477), 1e-3, relative=True)
rate = 1e4 * 2 / math.sqrt(3)
static = (792e6 + 510e6 * slow.equivalent_plastic_strain[20] ** 0.26)
case.check("johnson_cook: slow shear [MPa]", slow.von_mises[20] / 1e6,
           static * (1 - ((slow.temperature[19] - 293) / 1500) ** 1.03) / 1e6, 1e-6, relative=True)
hot = ((fast.temperature[19] - 293) / 1500) ** 1.03
plastic = (fast.equivalent_plastic_strain[20] - fast.equivalent_plastic_strain[19]) / (fast.time[20] - fast.time[19])
case.check("johnson_cook: rate of the fast shear [1/s]", plastic, rate, 0.02, relative=True)
case.check("johnson_cook: fast shear [MPa]", fast.von_mises[20] / 1e6,
           (792 + 510 * fast.equivalent_plastic_strain[20] ** 0.26) * (1 + 0.014 * math.log(plastic)) * (1 - hot), 1e-6, relative=True)
brick = Path("clay_brick", "tension")
brick.check("peak [MPa]", max(brick.stress_xx) / 1e6, 2, 0.005)
brick.check("energy times size [J/m^2]", brick.dissipation[-1] * 0.01, 60 * (1 - brick.stress_xx[-1] / 2e6), 0.01)
angle = math.atan(0.84)
crushed = Path("clay_brick", "compression")
crushed.check("peak [MPa]", max(crushed.axial), 2 * 4.66 * math.cos(angle) / (1 - math.sin(angle)), 0.01)
squeeze = Path("rubber", "squeeze")
J = squeeze.volume_ratio[-1]
K, G = 3e6 / 0.6, 3e6 / 2.8
squeeze.check("stress [MPa]", squeeze.stress_xx[-1] / 1e6,
              (K / 2 * (J - 1 / J) + 2 / 3 * G * J ** (-5 / 3) * (J * J - 1)) / 1e6, 1e-6)

# --- rock masses: Hoek and Brown 2002, Jaeger 1960 --------------------------------------------------------


def hoek_brown(gsi, confinement, strength=50.0, constant=10.0):
    """sigma_1 [MPa] of a rock mass without disturbance."""
    m, s = constant * math.exp((gsi - 100) / 28), math.exp((gsi - 100) / 9)
    a = 0.5 + (math.exp(-gsi / 15) - math.exp(-20 / 3)) / 6
    return confinement + strength * (m * confinement / strength + s) ** a


for confinement in (0, 5, 10):
    mass = Path("rock_masses", f"mass_{confinement}")
    mass.check("strength [MPa]", max(mass.axial), hoek_brown(45, confinement), 1e-6)
    mass.dissipates()
softening = Path("rock_masses", "softening")
softening.check("peak [MPa]", max(softening.axial), hoek_brown(75, 0), 1e-3)
softening.check("residual strength [MPa]", softening.axial[-1], hoek_brown(30, 0), 0.02)
softening.dissipates()


def jaeger(dip, confinement, cohesion=1.0, friction=0.45):
    """sigma_1 [MPa] at which planes slip whose dip is the angle between normal and load."""
    return confinement + 2 * (cohesion + confinement * friction) / ((1 - friction / math.tan(dip)) * math.sin(2 * dip))


steep, flat = Path("rock_masses", "steep_2"), Path("rock_masses", "flat_2")
slips = steep.plane_slip > 0
n = numpy.array([steep.plane_normal_x, steep.plane_normal_y])[:, slips]
xx, yy, xy = (getattr(steep, f"stress_{k}")[slips] / 1e6 for k in ("xx", "yy", "xy"))
traction = numpy.array([xx * n[0] + xy * n[1], xy * n[0] + yy * n[1]])
across = (traction * n).sum(axis=0)
along = numpy.linalg.norm(traction - across * n, axis=0)
steep.check("strength of the planes less what they bear, while they slip [MPa]",
            float(numpy.abs(along + 0.45 * across - 1).max()), 0, 1e-6, relative=False)
dip = math.acos(n[0, 0])
steep.check("dip when they slip [degrees]", math.degrees(dip), 60, 0.01, relative=False)
# Planes that slip turn a stress into the path, whose shear strains are held.
steep.check("strength when they slip [MPa]", -xx[0], jaeger(dip, 2), 1e-3)
steep.dissipates()
angle = math.atan(0.7)
passive = (1 + math.sin(angle)) / (1 - math.sin(angle))
flat.check("strength, of the matrix [MPa]", max(flat.axial), 2 * 5 * math.sqrt(passive) + 2 * passive, 1e-6)
flat.check("slip of planes too flat to slip", float(flat.plane_slip[-1]), 0, 0, relative=False)

# In an element of a mesh that is pressed the same way.
recipe = {
    "dimension": 3,
    "parts": [{"shape": "box", "block": "rock", "min": [0, 0, 0], "size": [1, 1, 1], "divisions": [1, 1, 1]}],
    "node_sets": {"all": {"block": "rock"}, "left": {"block": "rock", "where": {"x": 0}}, "right": {"block": "rock", "where": {"x": 1}}},
}
with open(examples / "rock_masses.yaml") as file:
    cards = yaml.safe_load(file)["materials"]
for name in ("mass", "steep"):
    pressed = Path("rock_masses", f"pressed_{name}")
    run = case.run(
        f"pressed_{name}",
        recipe,
        {
            "materials": {name: cards[name]},
            "blocks": {"rock": {"material": name}},
            "conditions": [
                {"type": "fixed", "node_set": "all", "components": ["y", "z"]},
                {"type": "fixed", "node_set": "left", "components": ["x"]},
                {"type": "velocity", "node_set": "right", "components": ["x"], "value": [-1, 0, 0]},
            ],
            "viscosity": {"linear": 0, "quadratic": 0},
            "time": {"end": 1 - math.exp(-0.02), "fixed_step": 1e-5},
        },
    )
    for component in ("xx", "yy") if name == "mass" else ("xx", "yy", "xy"):
        found = float(run.results.element("rock", f"stress_{component}")[0])
        case.check(f"pressed {name}: stress_{component} in a mesh [MPa]", found / 1e6, getattr(pressed, f"stress_{component}")[-1] / 1e6, 2e-3,
                   relative=True)

# --- what is refused --------------------------------------------------------------------------------------

pathlib.Path("wrong.yaml").write_text("material_paths:\n  a: {type: shear, material: concrete_c4, strains: [1e-3]}\n")
code, output = point("wrong.yaml")
case.check_equal("unknown material: exit code", code, 3)
case.check_equal("unknown material: the place is named", "wrong.yaml:2:" in output and "concrete_c4" in output, True)
code, output = point(examples / "concrete_c40.yaml", "--set", "materials.concrete_c40.tensile_strength=41e6")
case.check_equal("ft > fc: exit code", code, 3)
case.check_equal("ft > fc: what is accepted", "between 0 and a quarter of the compressive strength" in output, True)
case.finish()
