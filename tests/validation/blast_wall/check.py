"""A free-standing wall under the blast wave of a charge: it rocks, slides and falls as a rigid body under Kingery and Bulmash's wave does."""

import math

import numpy
from coplanetest import ValidationCase

case = ValidationCase(__file__)
THICK, HIGH, DENSITY, G = 0.25, 2.0, 1900.0, 9.81
MASS = DENSITY * THICK * HIGH  # per metre
ABOUT_CENTRE = MASS * (THICK**2 + HIGH**2) / 12
CHARGE, CUBE_ROOT, WAITS = 100.0, 100 ** (1 / 3), 0.05  # [kg]; the wave reaches the wall 0.05 s after the start
FACES = 16

# --- the wave: Kingery and Bulmash 1984, hemispheres, from a scaled distance of 2.78 m/kg^(1/3) on; kPa, kPa ms and ms -----------

FITS = {
    "incident": (-0.214362789151, 1.35034249993, [2.78076916577, -1.6958988741, -0.154159376846, 0.514060730593, 0.0988534365274, -0.293912623038, -0.0268112345019,
                 0.109097496421, 0.00162846756311, -0.0214631030242, 0.0001456723382, 0.00167847752266]),
    "reflected": (-0.240657322658, 1.36637719229, [3.40283217581, -2.21030870597, -0.218536586295, 0.895319589372, 0.24989009775, -0.569249436807, -0.11791682383,
                  0.224131161411, 0.0245620259375, -0.0455116002694, -0.00190930738887, 0.00361471193389]),
    "incident impulse": (-1.94708846747, 2.40697745406, [1.67281645863, -0.384519026965, -0.0260816706301, 0.00595798753822, 0.014544526107, -0.00663289334734,
                         -0.00284189327204, 0.0013644816227]),
    "reflected impulse": (-0.246208804814, 1.33422049854, [2.70588058103, -0.949516092853, 0.112136118689, -0.0250659183287]),
    "arrival": (-0.202425716178, 1.37784223635, [-0.0591634288046, 1.35706496258, 0.052492798645, -0.196563954086, -0.0601770052288, 0.0696360270891, 0.0215297490092,
                -0.0161658930785, -0.00232531970294, 0.00147752067524]),
    "duration": (-3.53626218091, 3.46349745571, [0.686906642409, 0.0933035304009, -0.0005849420883, -0.00226884995013, -0.00295908591505, 0.00148029868929]),
}  # fmt: skip


def fitted(name, scaled):
    shift, factor, coefficients = FITS[name]
    return 10 ** numpy.polynomial.polynomial.polyval(shift + factor * math.log10(scaled), coefficients)


def decay(peak, impulse, duration):
    """(duration, b) of Friedlander's wave with that impulse: p T (b - 1 + exp(-b)) / b^2; straight and longer where that cannot be."""
    if impulse >= 0.5 * peak * duration:
        return 2 * impulse / peak, 0.0
    low, high = 1e-6, 50.0
    for _ in range(80):
        b = (low + high) / 2
        low, high = (b, high) if peak * duration * (b - 1 + math.exp(-b)) / b**2 > impulse else (low, b)
    return duration, low


class Wave:
    """Force on the front and its moment about the foot, per metre, at a time after the detonation; summed over the faces of the mesh, as the program has them."""

    def __init__(self, distance):
        self.rows = []
        for y in (numpy.arange(FACES) + 0.5) * HIGH / FACES:
            r = math.hypot(distance, y)
            z, cosine = r / CUBE_ROOT, distance / r
            for which, share in (("reflected", cosine**2), ("incident", 1 + cosine - 2 * cosine**2)):
                peak, impulse = 1e3 * fitted(which, z), fitted(f"{which} impulse", z) * CUBE_ROOT
                duration, b = decay(peak, impulse, 1e-3 * fitted("duration", z) * CUBE_ROOT)
                self.rows.append((y, share * peak, 1e-3 * fitted("arrival", z) * CUBE_ROOT, duration, b))
        self.rows = numpy.array(self.rows).T
        self.begins, self.ends = self.rows[2].min(), (self.rows[2] + self.rows[3]).max()

    def at(self, t):
        if t < self.begins or t > self.ends:
            return 0.0, 0.0
        y, peak, arrival, duration, b = self.rows
        s = (t - arrival) / duration
        p = numpy.where((s >= 0) & (s <= 1), peak * (1 - s) * numpy.exp(-b * s), 0) * HIGH / FACES
        return p.sum(), (p * y).sum()


# --- the wall: rigid, its foot in touch, with friction --------------------------------------------------


def rates(state, load, friction):
    """Of (way of the foot, its speed, tilt, spin). The foot holds while friction suffices, else it slides away from the charge."""
    _, speed, turn, spin = state
    rx, ry = -THICK / 2 * math.cos(turn) + HIGH / 2 * math.sin(turn), THICK / 2 * math.sin(turn) + HIGH / 2 * math.cos(turn)
    force, moment = load
    own = moment - force * HIGH / 2  # of the pressure about the centre
    along, down = force * math.cos(turn), force * math.sin(turn)

    def reaction(acceleration, up):  # friction and normal force for a foot that moves so, and a spin that changes so
        return along - MASS * (acceleration + up * ry - spin**2 * rx), MASS * (G - up * rx - spin**2 * ry) + down

    up = (own + ry * (along + MASS * spin**2 * rx) + rx * (MASS * (G - spin**2 * ry) + down)) / (ABOUT_CENTRE + MASS * (rx**2 + ry**2))
    if turn <= 0 and up <= 0:
        return (0, 0, 0, 0)  # it stands
    held, normal = reaction(0, up)
    if speed == 0 and abs(held) <= friction * normal:
        return (0, 0, spin, up)
    way = math.copysign(1, speed if speed else held)
    # Sliding: f = way mu N, N = M (g - up rx - spin^2 ry) + down.
    plain = MASS * (G - spin**2 * ry) + down
    lever = way * friction * ry + rx
    up = (own + lever * plain) / (ABOUT_CENTRE + lever * MASS * rx)
    normal = plain - MASS * up * rx
    return (speed, (along - way * friction * normal) / MASS - up * ry + spin**2 * rx, spin, up)


def rigid(distance, friction, end=3.0):
    """Times after the arrival, tilts [rad], ways of the foot [m], and whether it falls; by the method of Runge and Kutta."""
    wave = Wave(distance)
    t, state = wave.begins, numpy.zeros(4)
    found = [(0.0, 0.0, 0.0)]
    while t < wave.begins + end:
        step = 2e-4 if t < wave.ends else 1e-3
        k = []
        for part in (0, 0.5, 0.5, 1):
            k.append(numpy.array(rates(state + part * step * k[-1] if k else state, wave.at(t + part * step), friction)))
        before = state[1]
        state = state + step * (k[0] + 2 * k[1] + 2 * k[2] + k[3]) / 6
        if before > 0 and state[1] <= 0:
            state[1] = 0  # the foot has come to rest
        t += step
        found.append((t - wave.begins, state[2], state[0]))
        if state[2] > math.atan(THICK / HIGH):
            return *numpy.array(found).T, True
        if t > wave.ends and state[3] <= 0:
            return *numpy.array(found).T, False
    return *numpy.array(found).T, False


def critical(friction):
    """The largest distance at which it falls [m]."""
    low, high = 20.0, 150.0
    for _ in range(17):  # to 1 mm
        middle = (low + high) / 2
        low, high = (middle, high) if rigid(middle, friction)[3] else (low, middle)
    return low


# --- runs ------------------------------------------------------------------------------------------------


def blast(name, distance, friction=3.0, end=1.5, across=4, stiffness=1e11, solid=False):
    """Times after the arrival, tilts, ways of the foot, whether it falls; run and seconds."""
    recipe, deck = case.load("mesh.yaml"), case.load()
    wall = recipe["parts"][1]
    wall["divisions"] = [across, FACES]
    if solid:
        recipe["dimension"] = 3
        for part in recipe["parts"]:
            over = 0.2 if part["block"] == "ground" else 0
            part["min"], part["size"], part["divisions"] = [*part["min"], -0.25 - over], [*part["size"], 0.5 + 2 * over], [*part["divisions"], 2]
    deck["joints"]["bed"].update(friction=friction, normal_stiffness=stiffness, shear_stiffness=stiffness / 2)
    arrival = float(Wave(distance).begins)
    deck["conditions"][1].update(charge_place=[-distance, 0, 0], detonation_time=WAITS - arrival)
    deck["time"]["end"] = end
    deck["output"]["every"] = end / 6
    depth = 0.5 if solid else 1
    run, spent = case.timed(name, recipe, deck, load=60e3 * depth)
    h = run.history
    dx = h["top_displacement_x"] - h["toe_displacement_x"]
    turn = numpy.arctan2(dx, HIGH + h["top_displacement_y"] - h["toe_displacement_y"])
    return h["time"] - WAITS, turn, h["toe_displacement_x"], turn.max() > math.atan(THICK / HIGH), run, spent


limits = {friction: critical(friction) for friction in (3.0, 0.5)}
for friction, words in ((3.0, "it rocks"), (0.5, "it rocks and slides")):
    limit = limits[friction]
    times, turns, ways, falls = rigid(1.05 * limit, friction)
    for factor in (0.97, 1.03, 1.05):
        run = blast(f"friction_{friction}_{factor}", factor * limit, friction, end=1.5 if case.full or factor < 1.05 else 0.9)
        name = f"{words}, friction {friction}, charge at {factor} of {limit:.2f} m"
        case.check_equal(f"{name}: the wall falls", bool(run[3]), factor < 1)
        if factor == 1.05:
            case.check(f"{name}: largest tilt before it strikes back [rad]", run[1][run[0] < 1.2 * times[-1]].max(), turns.max(), 0.05, relative=True)
            at = run[0] <= times[-1]
            case.check(f"{name}: tilt until then, root mean square of the difference over the largest",
                       numpy.sqrt(numpy.mean((run[1][at] - numpy.interp(run[0][at], times, turns)) ** 2)) / turns.max(), 0, 0.05)  # fmt: skip
            if friction < 1:
                case.check(f"{name}: way of the foot [m]", run[2][at][-1], ways[-1], 0.15, relative=True)
            else:
                case.picture(run[4], "--shares", "0", "0.33", "0.67", "1", "--strip", "4", "--planes", "none", "--window", "-0.3", "1.2", "-0.1", "2.3", "--size", "230", "330")
limit = limits[3.0]
solid = blast("solid", 1.05 * limit, solid=True, across=2, end=0.7)
flat = blast("flat", 1.05 * limit, across=2, end=0.7)
case.check("in space, 0.5 m of the wall, charge at 1.05: largest tilt against the plane", solid[1].max(), flat[1].max(), 5e-3, relative=True)
if case.full:
    for across in (2, 4, 8, 16):
        run = blast(f"across_{across}", 1.05 * limit, across=across, end=0.9)
        case.study("charge at 1.05 of the limit: largest tilt [rad]", f"{across} across the foot", run[1].max(), rigid(1.05 * limit, 3.0)[1].max(), run[5])
    for stiffness in (1e9, 1e10, 1e11):
        run = blast(f"bed_{stiffness:g}", 1.05 * limit, stiffness=stiffness, end=0.9)
        case.study("charge at 1.05 of the limit: largest tilt [rad]", f"bed of {stiffness / 1e9:g} GPa/m", run[1].max(), rigid(1.05 * limit, 3.0)[1].max(), run[5])
case.finish()
