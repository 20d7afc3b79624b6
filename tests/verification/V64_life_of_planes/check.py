"""V64: planes come and go as a block slides over a slab and off its end; what they know passes on."""

import copy

import numpy
from coplanetest import Case

case = Case("V64", __file__)
weight = 2000 * 0.18 * 0.1 * 9.81


def slide(name, start, inherit=True, left=0.013, whole=True):
    """Runs with the block `start` above the slab [m]; returns what the contact did while all of the block was on it. `whole`:
    until the block has fallen off, with all checks.
    """
    recipe, deck = copy.deepcopy(case.load("mesh.yaml")), case.load()
    recipe["parts"][1]["min"] = [left, start]
    deck["contact"]["inherit"] = inherit
    if not whole:
        deck["time"]["end"] = 0.3
    run = case.run(name, recipe, deck)
    h = run.history
    steps = [run.planes(n) for n in range(len(run.results.times))]
    keys = [list(zip(*(p[k] for k in ("lower_element", "lower_side", "higher_element", "higher_side")))) for p in steps]
    way = numpy.interp(run.results.times, h["time"], h["block_displacement_x"])
    # Settled, and with all of the base on the slab, which has some 0.6 m left at the start.
    rows = [n for n in range(len(steps)) if run.results.times[n] > 0.07 and way[n] < 0.59]
    if whole:
        case.check(f"{name}: steps with a pair of faces twice", sum(len(set(k)) < len(k) for k in keys), 0, 0)
        case.check_within(f"{name}: faces of the slab that were passed", way[rows[-1]] / 0.05, 10, 16)
        # Four faces, cut by three or four joints of the slab.
        case.check_within(f"{name}: fewest planes at a time", min(len(keys[n]) for n in rows), 7, 8)
        case.check_within(f"{name}: most planes at a time", max(len(keys[n]) for n in rows), 7, 8)
        area = max(abs(steps[n]["area"].sum() / 0.18 - 1) for n in rows)
        case.check(f"{name}: area of contact over the base's, off from 1 by", area, 0, 1e-3)
        # The block is gone: only the planes that were declared stay, without area.
        case.check(f"{name}: planes that overlap at the end", len(keys[-1]), 0, 0)
        case.check_equal(f"{name}: pairs at the end, the declared ones", int(h["pairs"][-1]), len(keys[0]))
        case.check_equal(f"{name}: planes at the end, the declared ones", int(h["planes"][-1]), len(keys[0]))
        case.check(f"{name}: planes deeper than the limit", int(numpy.max(h["too_deep"])), 0, 0)
    # Mean closure of each face of the block, from step to step; and the force.
    jump = force = 0.0
    before = None
    for n in rows:
        p = steps[n]
        force = max(force, abs(numpy.sum(p["area"] * p["normal_traction"]) / weight - 1))
        faces = numpy.unique(p["higher_element"])
        now = {f: numpy.average(p["closure"][p["higher_element"] == f], weights=p["area"][p["higher_element"] == f]) for f in faces}
        if before:
            jump = max(jump, max(abs(now[f] / before[f] - 1) for f in faces))
        before = now
    # Until the block reaches the end of the slab: how high it stands.
    height = numpy.interp(run.results.times[rows], h["time"], h["block_displacement_y"]).mean()
    return jump, force, height


for name, start in (("overlap", -2e-5), ("gap", 2e-5)):
    jump, force, height = slide(name, start)
    case.check(f"{name}: largest change of a face's closure in 1 ms", jump, 0, 0.02)
    case.check(f"{name}: force over the weight, off from 1 by", force, 0, 0.02)
    case.check_within(f"{name}: height of the block over the overlap", height / 2e-5, -0.25, 0)

# Planes that inherit nothing know of no offset, and lift the block to the surface of the slab.
height = slide("no_inheritance", -2e-5, inherit=False, whole=False)[2]
case.check_within("no_inheritance: height of the block over the overlap", height / 2e-5, 0.75, 1)

# A block whose end lies above a joint of the slab meets the next face in the first cycle, before the second search: that
# plane has nobody to inherit from. For the record.
height = slide("end_at_joint", -2e-5, left=0.02, whole=False)[2]
case.check("end_at_joint: height of the block over the overlap", height / 2e-5, -0.16, 0.05, report=True)
case.finish()
