"""V62: how often the program searches for contacts does not change the answer."""

import copy

import numpy
from coplanetest import Case, differences

case = Case("V62", __file__)


def spread(runs, every, reference):
    """Largest difference of final displacements and velocities, each over its largest value."""
    a, b = runs[every].results, runs[reference].results
    return max(
        numpy.max(numpy.abs(a.nodal(f) - b.nodal(f))) / numpy.max(numpy.abs(b.nodal(f))) for f in ("displacement", "velocity")
    )


# --- joints that stay: one search is enough, to the last bit ----------------------------------------
deck = case.load("deck_wave.yaml")
for name in ("wave", "grid"):
    runs = {}
    for every in ("once", 1, 7):
        deck["contact"]["search_every"] = every
        runs[every] = case.run(f"{name}_{every}", case.load(f"mesh_{name}.yaml"), deck)
    if name == "grid":
        # Faces beside each other along a joint begin to overlap by slivers as the blocks bulge. Such
        # planes inherit from their neighbours at searches only, so the answer is close, not equal.
        for every in ("once", 7):
            case.check(f"grid: {every} against every cycle", spread(runs, every, 1), 0, 1e-6, report=True)
        break
    cycles = int(runs[1].history["cycle"][-1])
    case.check("wave: searches, once", int(runs["once"].history["searches"][-1]), 1, 0)
    case.check("wave: searches, every cycle", int(runs[1].history["searches"][-1]), cycles + 1, 0)
    for every in runs:
        h = runs[every].history
        case.check(f"wave_{every}: planes, always seven joints of four faces", int(numpy.max(numpy.abs(h["planes"] - 28))), 0, 0)
    for every in (1, 7):
        case.check_equal(f"wave: results that differ, every {every} cycles against once",
                         differences(runs[every].path("run.e"), runs["once"].path("run.e")), [])

# --- impact and sliding -----------------------------------------------------------------------------
incline = "tests/verification/V14_incline"
slide = case.load(f"{incline}/deck.yaml")
slide["time"] = {"end": 0.3, "fixed_step": 1.2e-4}
# Two blocks collide corner first, turning (free eccentric collision).
impact = case.load("deck_impact.yaml")
for name, recipe, deck in (
    ("slide", case.load(f"{incline}/mesh.yaml"), slide),
    ("impact", case.load("mesh_impact.yaml"), impact),
):
    runs = {}
    for every in (1, 2, 4, 16, "auto"):
        deck = copy.deepcopy(deck)
        deck["contact"]["search_every"] = every
        runs[every] = case.run(f"{name}_{every}", recipe, deck)
    case.check_within(f"{name}: friction work [J]", runs[1].history["contact_friction"][-1], 1e-3, float("inf"))
    for every in (2, 4, 16, "auto"):
        case.check(f"{name}: {every if every == 'auto' else f'every {every} cycles'} against every one", spread(runs, every, 1), 0, 1e-6)
    if name == "slide":
        case.check_within("slide: searches, auto", int(runs["auto"].history["searches"][-1]), 2, int(runs[4].history["searches"][-1]) // 10)

# --- over a seam: a search may see the front edge of the block flush with it, or may not ------------
for name, recipe in (("seam", case.load("mesh_seam.yaml")), ("seam_3d", case.load("mesh_seam_3d.yaml"))):
    for forces in ("potential", "common_normal"):
        runs = {}
        for every in (1, 100):
            deck = case.load("deck_seam.yaml")
            deck["contact"].update(forces=forces, search_every=every)
            runs[every] = case.run(f"{name}_{forces}_{every}", recipe, deck)
        friction = runs[100].history["contact_friction"][-1]
        case.check(f"{name}, {forces}: friction work, every cycle against every 100 [J]", runs[1].history["contact_friction"][-1], friction, 1e-4, relative=True)
        largest = {every: numpy.max(numpy.abs(run.history["contact_remainder"])) / friction for every, run in runs.items()}
        for every, remainder in largest.items():
            case.check(f"{name}, {forces}, {every}: remainder over friction work", remainder, 0, 4e-6 if forces == "potential" else 2e-3)
        if forces == "potential":
            deck["time"]["step_factor"] = 0.4
            half = case.run(f"{name}_{forces}_half", recipe, deck).history
            remainder = numpy.max(numpy.abs(half["contact_remainder"])) / half["contact_friction"][-1]
            case.check(f"{name}, {forces}: remainder over friction work with half the step", remainder, 0, 4e-6)

# --- what neighbours pass on changes: auto searches as every fourth cycle does ----------------------
def changed(**joint):
    deck = copy.deepcopy(slide)
    deck["joints"]["rough"] = {"friction": 0.3, **joint}
    return deck


def bound(deck, velocity):
    """The joint closed at the start, and a block that gets going."""
    deck["contact"]["pairs"] = [{"blocks": ["slab", "block"], "joint": "rough", "declared": True}]
    deck["initial"] = [{"block": "block", "velocity": [velocity, 0, 0]}]
    return deck


level = case.load(f"{incline}/mesh.yaml")
sunk = copy.deepcopy(level)
sunk["parts"][1]["min"][1] = -0.003
sunk["node_sets"]["base"]["where"]["y"] = -0.003
overlap, seed = copy.deepcopy(slide), copy.deepcopy(slide)
overlap["contact"]["initial_overlap"] = "allow"
seed["contact"]["preset"] = "seed"
stiff = {"normal_stiffness": 1e9, "shear_stiffness": 5e8}
for name, recipe, deck in (
    ("overlap", sunk, overlap),
    ("dilating", level, changed(model="linear", dilation=0.1, **stiff)),
    ("curve", level, changed(model="closure_curve", initial_stiffness=1e8, maximum_closure=1e-3, shear_stiffness=5e7)),
    ("softening", level, bound(changed(model="mortar", cohesion=2e3, tensile_strength=1e3, tension_energy=0.05, shear_energy=0.3, **stiff), 3)),
    ("seed", level, seed),
):
    runs = {}
    for every in (4, "auto"):
        deck["contact"]["search_every"] = every
        runs[every] = case.run(f"{name}_{every}", recipe, deck)
    # The preset sums closures up from velocities, so that its answers hang on when pairs begin.
    case.check(f"{name}: auto against every 4 cycles", spread(runs, "auto", 4), 0, 1e-6, report=name == "seed")

# --- a plank comes down on its edge, and faces beside each other begin to touch within a few cycles ---
# The second lies deep when its shadow first shares area with a face, and has to know what the first has begun to pass on.
plank = {"dimension": 3, "node_sets": {"base": {"block": "base"}}, "parts": [
    {"shape": "box", "block": "base", "min": [-0.5, -0.2, -0.3], "size": [1, 0.2, 0.6], "divisions": [5, 1, 3]},
    {"shape": "box", "block": "plank", "min": [-0.5, 0.3, -0.05], "size": [1, 0.02, 0.1], "divisions": [13, 1, 2], "rotate": [0, 17, 0]}]}  # fmt: skip
down = {
    "materials": {"rock": {"model": "linear_elastic", "density": 2000, "youngs_modulus": 1e8, "poisson_ratio": 0.25}},
    "blocks": {name: {"material": "rock", "rigid": True} for name in ("base", "plank")},
    "initial": [{"block": "plank", "velocity": [0, -5, 0], "angular_velocity": [0, 0, 20]}],
    "conditions": [{"type": "fixed", "node_set": "base"}],
    "joints": {"rough": {"model": "penalty", "friction": 0.4}},
    "contact": {"default_joint": "rough"},
    "time": {"end": 0.04},
}
for forces in ("potential", "common_normal"):
    energies = {}
    for every in (1, 4, 100, "auto", "once"):
        down["contact"].update(search_every=every, forces=forces)
        h = case.run(f"plank_{forces}_{every}", plank, down).history
        energies[every] = h["kinetic"][-1], h["contact_friction"][-1]
    for every in (4, 100, "auto", "once"):
        for what, value, reference in zip(("kinetic energy", "friction work"), energies[every], energies[1]):
            case.check(f"plank, {forces}, {every}: {what} [J]", value, reference, 1e-6, relative=True)
case.finish()
