"""Rows of blocks whose bonds resist bending: moments of one joint, sags and loads of collapse of cantilevers, flight."""

import copy

import numpy
from coplanetest import Case

case = Case("bent_rows", __file__)
deck = case.load()
bond, density = deck["joints"]["bond"], deck["materials"]["rock"]["density"]
kn, ks = bond["normal_stiffness"], bond["shear_ratio"] * bond["normal_stiffness"]
strength, size = bond["tensile_strength"], 0.1


def row(faces, depth=None):
    """A recipe: blocks one behind the other along x, the first of them held; faces[i] of block i across its height, and none of
    their nodes shared."""
    parts = []
    for i, across in enumerate(faces):
        part = {"shape": "box", "block": "row" if i else "held", "min": [i * size, 0], "size": [size, size], "divisions": [1, across]}
        if depth:
            part.update(min=[i * size, 0, 0], size=[size, size, depth], divisions=[1, across, 1])
        parts.append(part)
    return {"dimension": 3 if depth else 2, "parts": parts}


# --- one joint: the end block is turned, and free to move along -----------------------------------------------------
def softening(joint):
    """Opening and traction of a bond's most open point, from the strength on."""
    d = numpy.linspace(0, 1, 20001)
    if joint["model"] == "mortar":
        d = d * 7 * joint["tension_energy"] / strength
        left = numpy.exp(-d * strength / joint["tension_energy"])
    else:
        d = d * 2 * joint["tension_energy"] / strength
        left = 1 - d * strength / (2 * joint["tension_energy"])
    return strength * left / kn + d, strength * left


def bent(joint):
    """Angle and moment of one face that carries k c where it is closed and k_t c where it is open: without a force the closed
    part of its height is sqrt(k_t / k) of the open one."""
    opening, traction = softening(joint)
    root = numpy.sqrt(traction / (kn * opening))
    angle, moment = opening * (1 + root) / size, size**2 * traction / (3 * (1 + root))
    return numpy.append(0, angle), numpy.append(0, moment)


def of_faces(joint, count, angles):
    """Moments of a section of that many faces, each of which carries by its own most open point: the axis about which a section is
    turned by an angle is where its force is zero."""
    opening, traction = softening(joint)
    edges = size * numpy.arange(count + 1) / count
    bottom, top = edges[:-1], edges[1:]
    worst, axis, moments = numpy.zeros(count), size / 2, []

    def section(angle, axis):
        """Force over the angle, moment over it, and the most open point of each face."""
        most = numpy.maximum(worst, angle * (top - axis))
        left = numpy.interp(most, opening, traction, left=0, right=0)
        slope = numpy.where(most < opening[0], kn, left / numpy.maximum(most, opening[0]))
        middle = numpy.clip(axis, bottom, top)
        above = lambda n: (top - axis) ** n - (middle - axis) ** n
        below = lambda n: (middle - axis) ** n - (bottom - axis) ** n
        return [(slope * above(n) + kn * below(n)).sum() / n for n in (2, 3)] + [most]

    for angle in angles:
        low, high = 0.0, size
        for _ in range(50):
            axis = (low + high) / 2
            if section(angle, axis)[0] > 0:
                low = axis  # more of it is open than the rest can press
            else:
                high = axis
        _, moment, worst = section(angle, axis)
        moments.append(angle * moment)
    return numpy.array(moments)


def turned(name, faces, joint, last, same_bits=False):
    """The run, and its angles: the spin grows within 0.04 s, so that nothing rings."""
    one = copy.deepcopy(deck)
    one["joints"]["bond"] = joint
    one["gravity"], one["damping"] = [0, 0, 0], {"mass": 100}
    end, grows = 0.2, 0.04
    spin = last / (end - grows / 2)
    one["time"]["end"], one["history"]["every"] = end, 2e-4
    one["conditions"].append({"type": "rigid_motion", "block": "row", "angular_velocity": [0, 0, f"{spin}*min(t/{grows},1)"]})
    run = case.run(name, row(faces), one, load=strength * size)
    if same_bits:
        case.same_bits(name, row(faces), one, run)
        fracture = run.history["contact_fracture"]
        softening = run.history["time"][fracture < 0.5 * fracture[-1]][-1]
        case.restarts(name, row(faces), one, run, softening, ranks=2)
    t = run.history["time"]
    return run, spin * numpy.where(t < grows, t**2 / (2 * grows), t - grows / 2)


mortar = {**bond, "model": "mortar", "stiffness_loss": 1, "shear_energy": 3000}
for model, joint, last in (("bilinear", bond, 8e-3), ("mortar", mortar, 25e-3)):
    run, angle = turned(f"hinge_{model}", [1, 1], joint, last, same_bits=model == "bilinear")
    exact_angle, exact = bent(joint)
    moment = run.history["row_reaction_moment_z"]
    # Behind the largest angle less opening would need a larger moment: the joint snaps open.
    snaps = numpy.argmax(exact_angle)
    follows, after = angle < 0.99 * exact_angle[snaps], angle > 1.1 * exact_angle[snaps]
    error = abs(moment - numpy.interp(angle, exact_angle[: snaps + 1], exact[: snaps + 1]))
    case.check(f"one face, {model}: moment until it snaps, largest error over the peak", error[follows].max() / exact.max(), 0, 1e-2)
    case.check(f"one face, {model}: moment behind, over the peak", abs(moment[after]).max() / exact.max(), 0, 5e-3)
    case.check(f"one face, {model}: largest moment [N m]", moment.max(), exact.max(), 5e-3, relative=True)
    taken = numpy.sum(numpy.diff(exact_angle) * (exact[1:] + exact[:-1]) / 2)  # of the whole curve: nothing is stored at its end
    case.check(f"one face, {model}: fracture energy [J]", run.history["contact_fracture"][-1], taken, 5e-3, relative=True)

run, angle = turned("hinge_8", [8, 8], bond, 8e-3)
moment, exact = run.history["row_reaction_moment_z"], of_faces(bond, 8, numpy.maximum(angle, 1e-9))
case.check("eight faces: moment, mean error over the peak", abs(moment - exact).mean() / exact.max(), 0, 5e-3)
case.check("eight faces: largest moment [N m]", moment.max(), exact.max(), 5e-3, relative=True)

# --- elastic cantilevers: joints turn by M / (k_n I) and slip by V / (k_s A) -------------------------------------------
count = 7
arms = size * numpy.arange(count, 0, -1)  # from the joints to the end


def sag(gravity, height, width, of_inertia=1.0):
    """Of the free end."""
    weight = density * gravity * height * width
    turns = weight * arms**2 / 2 / (of_inertia * kn * width * height**3 / 12)
    slips = weight * arms / (ks * height * width)
    return (turns * arms).sum() + slips.sum()


def end_of(run, axis):
    """How far the free end has gone."""
    r = run.results
    last = r.coordinates[:, 0] > (count + 0.5) * size
    return r.nodal("displacement")[last, axis].mean()


for name, faces in (("one", [1] * 8), ("unequal", [1, 3, 2, 1, 1, 4, 3, 2])):
    run = case.run(f"row_{name}", row(faces), deck)
    case.check(f"row, faces {name}: sag of the end [m]", -end_of(run, 1), sag(10, size, 1), 2e-3, relative=True)
    if name == "unequal":
        case.same_bits(f"row_{name}", row(faces), deck, run, ranks=3)
at_one_point = copy.deepcopy(deck)
at_one_point["joints"]["bond"]["resists_bending"] = False
run = case.run("row_at_one_point", row([2] * 8), at_one_point)
case.check("row of bonds that carry at one point, two faces: sag [m]", -end_of(run, 1), sag(10, size, 1, 0.75), 2e-3, relative=True)
oblique = {**copy.deepcopy(deck), "gravity": [0, -10, 6]}
run = case.run("row_3d", row([1, 2] * 4, 0.15), oblique)
case.check("row in space: sag [m]", -end_of(run, 1), sag(10, size, 0.15), 2e-3, relative=True)
case.check("row in space: the same along z [m]", end_of(run, 2), sag(6, 0.15, size), 2e-3, relative=True)

# --- elastic elements: beam theory, shear of the rectangle, and what joints add -------------------------------------------
E, beams = deck["materials"]["rock"]["youngs_modulus"], 16
soft = copy.deepcopy(deck)
soft["blocks"] = {"row": {"material": "rock", "element": "assumed_strain"}, "held": {"material": "rock", "rigid": True}}
soft["joints"]["bond"] = {"model": "linear", "normal_stiffness": 5 * E / size, "shear_ratio": 0.4, "tensile_strength": 1e9, "cohesion": 1e9, "friction": 0.6, "resists_bending": True}
soft["damping"], soft["history"] = {"mass": 200}, {"every": 1e-3}
soft["time"]["end"], soft["output"]["every"] = 0.25, 0.25
length, weight, inertia = beams * size, density * 10 * size, size**3 / 12
arms = size * numpy.arange(beams, 0, -1)
turning = (weight * arms**3 / 2 / (5 * E / size * inertia)).sum()
bending = weight * length**4 / (8 * E * inertia)
slipping = weight * length**2 / 2 / (5 / 6 * E / 2 * size) + weight * arms.sum() / (0.4 * 5 * E / size * size)
run = case.run("beam", row([1] * (beams + 1)), soft)
r = run.results
sagged = -r.nodal("displacement")[r.coordinates[:, 0] > (beams + 0.5) * size, 1].mean()
case.check("beam of elastic elements: sag of the end [m]", sagged, bending + turning + slipping, 2e-3, relative=True)

# In free flight: bending waves, with all momenta.
free = copy.deepcopy(soft)
free["conditions"], free["gravity"] = [], [0, 0, 0]
del free["damping"], free["blocks"]["held"]
free["initial"] = [{"block": "row", "velocity_field": ["0.1*y", "2*x*(x-1.1)", 0]}]
free["time"]["end"] = free["output"]["every"] = 0.01
flying = row([1] * beams)
flying["parts"][0]["block"] = "row"
case.run("free", flying, free, energy=2e-3)

# --- collapse: the row bears 0.98 of the gravity at which the moment at its root is the largest, and not 1.02 of it --------
count, faces = 7, 4
arm = count * size
most = float(of_faces(bond, faces, numpy.linspace(1e-6, 8e-3, 4000)).max() / (density * size * arm**2 / 2))
falls = copy.deepcopy(deck)
grows = {"times": [0, 0.3, 0.6, 0.7], "values": [0, -0.98 * most, -0.98 * most, -1.02 * most]}
falls["gravity"], falls["time"]["end"] = [0, grows, 0], 1.0
run = case.run("falls", row([faces] * (count + 1)), falls, load=density * size * arm * 1.02 * most)  # its weight
h = run.history
stands = h["time"] < 0.6
shear = h["held_reaction_y"][-1] - density * size**2 * 1.02 * most  # less the weight of the held block
root = h["held_reaction_moment_z"][-1] - size / 2 * shear
case.check_within("row, 0.98 of the largest load: kinetic energy over that at the end", h["kinetic"][stands][-1] / h["kinetic"][-1], 0, 1e-6)
case.check_within("row, 0.98 of the largest load: work of fracture over that at the end", h["contact_fracture"][stands][-1] / h["contact_fracture"][-1], 0.01, 0.2)
case.check_within("row, 1.02 of the largest load: moment at the root over the largest one", root / (most * density * size * arm**2 / 2), -1e-3, 1e-3)
case.finish()
