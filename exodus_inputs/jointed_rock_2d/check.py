"""What must be true of waves in jointed rock, by variant; docs/examples/jointed-rock.md has the numbers."""

import math

import numpy

from coplanetest import Example, documents, waves

example = Example()
h, results, variant = example.history, example.results, example.variant
recipe = documents.load(example.folder / "mesh.yaml")
deck = documents.load(example.folder / "run.yaml")
density, modulus, poisson = 2650.0, 60e9, 0.25
wave_modulus = modulus * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))
shear_modulus = modulus / (2 * (1 + poisson))
speed, shear_speed = math.sqrt(wave_modulus / density), math.sqrt(shear_modulus / density)
impedance = density * speed
normal, shear = 2e10, 1e10  # of the joints [Pa/m]

# Prestressed joints hold nearly all of the energy in play, but none of it moves: the energy that came in counts too.
example.balances(hourglass=0.05, remainder=(-0.02, 0.02))
example.check_equal("searches", int(h["searches"].max()), 1 if variant != "every4" else int(math.ceil((h["cycle"][-1] + 1) / 4)))
example.check_equal("pairs: as many at the end as at the start", int(h["pairs"][-1]), int(h["pairs"][0]))


def transmission():
    """The records against the exact solution for a row of blocks."""
    places = [(name, selection["where"]["x"]) for name, selection in recipe["node_sets"].items()
              if name == "near" or name.startswith("after")]
    blocks = recipe["parts"][0]["blocks"][0]
    step, number = 2e-5, 1 << 14
    fine = step * numpy.arange(number)
    left = numpy.where(fine < 2.5e-3, 0.05 * numpy.sin(2 * math.pi * 200 * fine), 0)
    peaks = {}
    for place, (name, x) in enumerate(places):
        exact = waves.passed(fine, left, lambda f: waves.row_of_blocks(f, [x], blocks, normal, impedance, speed)[0])
        exact = numpy.where(fine <= h["time"][-1], exact, 0)
        record = h[f"{name}_velocity_x"]
        error = numpy.abs(record - numpy.interp(h["time"], fine, exact)).max() / 0.05
        example.check_within(f"{name}: record against the exact one, largest difference over the amplitude", float(error), 0, 0.03)
        example.check(f"{name}: peak [m/s]", float(waves.peak(record)), float(waves.peak(exact)), 0.02, relative=True)
        # Where the first rise reaches half of the first peak: the head.
        first = int(numpy.argmax(record > 0.5 * record.max()))
        peaks[x] = numpy.interp(0.5 * record.max(), record[first - 1 : first + 1], h["time"][first - 1 : first + 1])
        # Whole record, so reflections too: amplitude of tones over those of the left side.
        if name != "near":
            tones = (50, 100, 200)
            t = numpy.arange(0, h["time"][-1], step)
            measured = [abs(waves.spectrum(t, numpy.interp(t, h["time"], record), f)) for f in tones]
            wanted = [abs(waves.spectrum(t, numpy.interp(t, fine, exact), f)) for f in tones]
            for f, a, b in zip(tones, measured, wanted):
                example.check(f"{name}: amplitude at {f} Hz [m/s s]", float(a), float(b), 0.02, relative=True)
    (x0, t0), *_, (x1, t1) = sorted(peaks.items())
    slow = speed / math.sqrt(1 + wave_modulus / (normal * 1.0))
    example.check_within(f"speed of the head [m/s]; {slow:.0f} for long waves, {speed:.0f} in intact rock", (x1 - x0) / (t1 - t0),
                         0.95 * slow, 1.08 * slow)
    example.check_equal("planes that slip, ever", int(h["slip"].max()), 0)
    example.check_within("friction over work from outside", float(h["contact_friction"][-1] / h["external_work"].max()), 0, 1e-6)


if variant in ("", "every4", "c"):
    transmission()
elif variant == "a":
    law = deck["joints"]["tight"]
    k, most = law["initial_stiffness"], law["maximum_closure"]
    start, end = list(example.all_planes())[0], list(example.all_planes())[-1]
    # sigma = k c / (1 - c / c_m): closure under 2 MPa.
    example.check("closure at rest [m]", float(numpy.median(start["closure"])), 2e6 / (k + 2e6 / most), 1e-3, relative=True)
    closed = (end["declared"] == 1) & (end["closure"] < 0.999 * end["maximum_closure"]) & (end["area"] > 0.01)
    c = end["maximum_closure"][closed]
    tangent = k / (1 - c / most) ** 2
    exact = k * c / (1 - c / most) - tangent * (c - end["closure"][closed])
    error = numpy.abs(end["normal_traction"][closed] - exact).max() / 2e6
    example.check_within("planes that have unloaded", int(closed.sum()), 50, 1e6)
    example.check_within("tangent unloading: traction off by, over 2 MPa", float(error), 0, 1e-6)
    left = end["normal"][:, 0] ** 2 > 0.5
    first = end["declared"].astype(bool) & left & (end["Points"][:, 0] < 5.5)
    residual = end["closure"][first].mean() / start["closure"].mean() - 1
    example.check_within("closure of the first five joints after the wave, over that before", float(residual), 0.001, 1)
    example.check_within("work lost in hysteresis over work from outside", float(h["contact_hysteresis"][-1] / h["external_work"].max()), 0.005, 0.9)
elif variant == "b":
    end = list(example.all_planes())[-1]
    slipped = end["slip"] > 1e-5
    x, y = numpy.abs(end["Points"][slipped, 0]), numpy.abs(end["Points"][slipped, 1])
    weight = (end["slip"] * end["overlap"])[slipped]
    angle = numpy.degrees(numpy.arctan2(y, x))
    example.check("lobes of slip: mean angle in the quadrant, weighted with slip and area [degrees]",
                  float((weight * angle).sum() / weight.sum()), 45, 3)
    example.check_within("share of the slip within 25 degrees of the diagonals",
                         float(weight[numpy.abs(angle - 45) < 25].sum() / weight.sum()), 0.56, 1)
    example.check_within("work of friction over work from outside", float(h["contact_friction"][-1] / h["external_work"].max()), 0.01, 0.9)
    example.check_within("longest slip [m]", float(h["tight_largest_slip"][-1]), 1e-4, 0.05)
    # The problem is symmetric about both axes and both diagonals.
    move = results.nodal("displacement")[results.connectivity("rock")].mean(axis=1)
    centre = results.centres("rock")
    order = {(round(a, 6), round(b, 6)): i for i, (a, b) in enumerate(centre)}
    for name, image, turn in (("about x = 0", centre * [-1, 1], lambda v: v * [-1, 1]), ("about y = x", centre[:, ::-1], lambda v: v[:, ::-1])):
        partner = numpy.array([order[round(a, 6), round(b, 6)] for a, b in image])
        error = numpy.abs(move - turn(move[partner])).max() / numpy.abs(move).max()
        example.check_within(f"asymmetry {name} over the largest displacement", float(error), 0, 1e-6)
elif variant == "d":
    c30, s30 = math.sqrt(0.75), 0.5
    t = h["time"]
    arrivals = {}
    for wave, (a, b) in (("pressure", (c30, s30)), ("shear", (s30, -c30))):
        times = []
        for name in ("near", "after_5"):
            record = a * h[f"{name}_velocity_x"] + b * h[f"{name}_velocity_y"]
            first = int(numpy.argmax(record > 0.5 * record.max()))
            times.append(numpy.interp(0.5 * record.max(), record[first - 1 : first + 1], t[first - 1 : first + 1]))
        arrivals[wave] = 5 / (times[1] - times[0])
    for wave, intact, m, k in (("pressure", speed, wave_modulus, normal), ("shear", shear_speed, shear_modulus, shear)):
        exact = intact / math.sqrt(1 + m / k)
        example.check(f"speed of the {wave} wave along the joints' normal, against that of long waves [m/s]", float(arrivals[wave]), exact,
                      0.08, relative=True)
elif variant == "e":
    end = list(example.all_planes())[-1]
    example.check_within("least normal traction of all planes at all times [Pa]",
                         float(min(fields["normal_traction"].min(initial=0) for fields in example.all_planes())), 0, 0)
    upright = end["normal"][:, 0] ** 2 > 0.5
    example.check_within("upright joints that are open after the wave, share", float((end["state"][upright] == 1).mean()), 0.5, 1)
    # Pressed only once, forward: what passes ten joints moves on and is not pulled back.
    record = h["after_10_velocity_x"]
    example.check_within("backward over forward velocity behind ten joints", float(-record.min() / record.max()), -1, 0.2)
    example.check_within("forward velocity behind ten joints, over the amplitude at the left", float(record.max() / 0.05), 0.1, 1.2)
example.finish()
