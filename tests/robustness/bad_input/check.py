"""Bad meshes, decks and disks: the right exit code on every rank, and a message that says what to mend."""

import copy
import math
import os
import pathlib
import re
import shutil

import netCDF4
from coplanetest import Case, documents, program

case = Case("bad input", __file__)
recipe, good = case.load("mesh.yaml"), case.load()
documents.save({"title": "bad input", **recipe}, "mesh.yaml")
program.make_mesh("mesh.yaml", "good.e")

# As docs/user/exit-codes.md has them.
DECK, MESH, OUTPUT, COMPUTATION = 3, 4, 5, 6


def attempt(name, deck=None, spoil=None, limit="unlimited", ranks=3):
    """Runs in a fresh folder; returns every rank's exit code and the output. `limit`: of the size of files, in
    blocks of 1024 bytes. A rank that waits for ever meets the time limit.
    """
    folder = pathlib.Path(name.replace(" ", "_")).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy("good.e", folder / "mesh.e")
    if spoil:
        spoil(folder / "mesh.e")
    documents.save({"mesh": "mesh.e", **(deck or good)}, folder / "run.yaml")
    # mpirun is told to let all ranks end by themselves, so that each can say its code. A full disk sends no signal,
    # unlike the limit that imitates it.
    shell = f'trap "" XFSZ; ulimit -f {limit}; "$@"; code=$?; echo $code > code.$OMPI_COMM_WORLD_RANK; exit $code'
    command = [os.environ.get("MPIEXEC", "mpirun"), "-np", str(ranks), "--bind-to", "none"]
    command += ["--mca", "orte_abort_on_non_zero_status", "0", "bash", "-c", shell, "bash"]
    _, output = program.run_program(["run.yaml"], folder, prefix=command, timeout=60)
    (folder / "output.txt").write_text(output)
    return [int(path.read_text()) for path in sorted(folder.glob("code.*"))], output


def expect(name, code, texts, deck=None, spoil=None, limit="unlimited"):
    codes, output = attempt(name, deck, spoil, limit)
    case.check_equal(f"{name}: exit codes of ranks", codes, [code] * 3)
    missing = [text for text in texts if text not in output]
    if not case.check_equal(f"{name}: words missing in the message", missing, []):
        print(output)
    # Once, not once per rank.
    case.check_equal(f"{name}: times that an error is printed", len(re.findall(r"(?m)^ERROR", output)), 1)


def changed(path, value):
    """The good deck with one value changed; None removes it."""
    deck = copy.deepcopy(good)
    place = deck
    for key in path[:-1]:
        place = place[key]
    if value is None:
        del place[path[-1]]
    else:
        place[path[-1]] = value
    return deck


def edit(change):
    def spoil(path):
        with netCDF4.Dataset(path, "a") as file:
            file.set_auto_mask(False)
            change(file)

    return spoil


def invert(file):
    connectivity = file["connect1"][:]
    connectivity[4] = connectivity[4][::-1]
    file["connect1"][:] = connectivity


def not_a_number(file):
    file["coordx"][7] = math.nan


def truncate(path):
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 3])


# --- meshes -----------------------------------------------------------------------------------------
expect("missing mesh", MESH, ["mesh.e"], spoil=lambda path: path.unlink())
code, _ = program.run_program(["run.yaml"], "missing_mesh", ranks=3, timeout=60)
case.check_equal("missing mesh: exit code of mpirun", code, MESH)
expect("text as mesh", MESH, ["mesh.e"], spoil=lambda path: path.write_text("solid cube\n"))
expect("empty mesh file", MESH, ["mesh.e"], spoil=lambda path: path.write_bytes(b""))
expect("truncated mesh", MESH, ["mesh.e"], spoil=truncate)
expect("folder as mesh", MESH, ["mesh.e"], spoil=lambda path: (path.unlink(), path.mkdir()))
expect("inverted element", MESH, ["5", "left"], spoil=edit(invert))
expect("coordinate not a number", MESH, ["8"], spoil=edit(not_a_number))

# --- decks ------------------------------------------------------------------------------------------
expect("block without material", DECK, ["right"], changed(["blocks", "right"], None))
expect("block not in mesh", DECK, ["middle", "left"], changed(["blocks", "middle"], {"material": "soft"}))
expect("unknown material", DECK, ["sotf", "soft"], changed(["blocks", "left"], {"material": "sotf"}))
expect("missing node set", DECK, ["bottom", "end"], changed(["conditions", 0, "node_set"], "bottom"))
expect("negative modulus", DECK, ["youngs_modulus", "> 0"], changed(["materials", "soft", "youngs_modulus"], -1e9))
expect("modulus not a number", DECK, ["youngs_modulus"], changed(["materials", "soft", "youngs_modulus"], math.nan))
expect("infinite end", DECK, ["time.end"], changed(["time", "end"], math.inf))
expect("misspelt key", DECK, ["densty", "density"], changed(["materials", "soft", "densty"], 1))
expect("condition on a part of a rigid block", DECK, ["run.yaml:", "a condition on velocities holds 3 of the 9 nodes of a rigid body"], changed(["blocks", "right", "rigid"], True))

expect(
    "nodal pressure in quadrilaterals", DECK,
    ["blocks.left.element = 'nodal_pressure' is for TRI3 and TETRA4, but the block has QUAD4; accepted: one_point"],
    changed(["blocks", "left", "element"], "nodal_pressure"),
)
expect(
    "points beyond the axis", DECK, ["geometry = 'axisymmetric', but node 1 is at x = -0.1 m; accepted: x >= 0"],
    changed(["geometry"], "axisymmetric"),
)


def beside_axis(file):
    file["coordx"][:] += 1


ring = changed(["geometry"], "axisymmetric")
expect("gravity away from the axis", DECK, ["gravity along x does not go with geometry = 'axisymmetric'"], {**ring, "gravity": [9.81, 0, 0]}, spoil=edit(beside_axis))
expect("spin out of the section", DECK, ["angular_velocity about z does not go with geometry = 'axisymmetric'"],
       {**ring, "initial": [{"block": "left", "angular_velocity": [0, 0, 1], "center": [1, 0, 0]}]}, spoil=edit(beside_axis))  # fmt: skip
for what, history, column in (("joint card called contact", {"joints": ["*"]}, "contact_stored[J]"), ("probe called as a rigid block", {"rigid": ["left"], "probes": [{"name": "left", "block": "right"}]}, "left_displacement_x[m]")):
    deck = {**good, "joints": {"contact": {"model": "linear", "normal_stiffness": 1e9}}, "contact": {"default_joint": "contact"}, "history": history,
            "blocks": {block: {**card, "rigid": block == "left"} for block, card in good["blocks"].items()}}  # fmt: skip
    expect(what, DECK, [f"history: two columns would be called '{column}'"], deck)


def other_mesh(name, texts, path, value, dimension=2, split=None):
    """The good deck with one value changed, on a mesh of other elements."""
    parts = []
    for block, x in (("left", 0), ("right", 1)):
        part = {"shape": "box", "block": block, "min": [x, 0, 0][:dimension], "size": [1] * dimension, "divisions": [1] * dimension}
        parts.append({**part, **({"split": split} if split else {})})
    mesh = {"title": name, "dimension": dimension, "parts": parts, "node_sets": {"end": {"block": "right", "where": {"x": 2}}}}
    documents.save(mesh, "other.yaml")
    program.make_mesh("other.yaml", "other.e")
    expect(name, DECK, texts, changed(path, value), spoil=lambda path: shutil.copy("other.e", path))


for dimension, split, shape in ((2, "triangles", "TRI3"), (3, "tetrahedra", "TETRA4")):
    for element in ("assumed_strain", "full_integration", "full_integration_plain"):
        text = f"blocks.left.element = '{element}' is for QUAD4 and HEX8, but the block has {shape}"
        other_mesh(f"{element} in {split}", [text], ["blocks", "left", "element"], element, dimension, split)
other_mesh("nodal pressure in hexahedra", ["is for TRI3 and TETRA4, but the block has HEX8"], ["blocks", "left", "element"], "nodal_pressure", 3)
other_mesh("solid of revolution", ["geometry = 'axisymmetric', but the mesh has three dimensions"], ["geometry"], "axisymmetric", 3)

# --- not wrong, but worth a warning -------------------------------------------------------------------
# E G_F / f_t^2 = 33e9 * 120 / 4e6^2 = 0.2475 m; an element of `left` is 1/30 m, so a tenth of the fracture energy is too little.
for energy, expected in ((120, False), (12, True)):
    deck = changed(["materials", "soft"], {"set": "concrete_c40", "fracture_energy": energy})
    documents.save({"mesh": "good.e", **deck}, "softening.yaml")
    code, output = program.run_program(["softening.yaml", "--check"], ".")
    case.check_equal(f"fracture energy {energy}: exit code of --check", code, 0)
    case.check_equal(f"fracture energy {energy}: warning of elements that are too large", "spring back" in output, expected)

# --- runs that cannot go on -------------------------------------------------------------------------
unstable = changed(["time"], {"end": 1e-2, "fixed_step": 2e-4})
expect("step far too large", COMPUTATION, ["cycle", "step"], unstable)


# Functions of the deck are called where the nodes are: some ranks find what others do not.
root = {"type": "velocity", "node_set": "end", "value": ["sqrt(x - 3)", 0, 0]}
expect("velocity that is no number at some nodes", COMPUTATION, ["'sqrt(x - 3)' is", "run.yaml:"], changed(["conditions", 0], root))
late = {"type": "velocity", "node_set": "end", "value": ["sqrt(5e-4 - t)", 0, 0]}
expect("velocity that is no number later", COMPUTATION, ["'sqrt(5e-4 - t)' is", "finite"], changed(["conditions", 0], late))
expect("gravity that is no number", COMPUTATION, ["'1/(t > 2e-4 ? 0 : 1)' is inf"], {**good, "gravity": [0, "1/(t > 2e-4 ? 0 : 1)", 0]})
expect(
    "initial velocity that is no number in one block", COMPUTATION, ["'sqrt(-0.05 - x)' is"],
    changed(["initial", 0], {"block": "left", "velocity_field": ["sqrt(-0.05 - x)", 0, 0]}),
)
expect(
    "a name that define does not have", DECK, ["initial.0.velocity.0 = '2*sped' is not a number (did you mean 'speed'?)"],
    {**changed(["initial", 0], {"block": "left", "velocity": ["2*sped", 0, 0]}), "define": {"speed": 5}},
)
expect("a name that nothing uses", DECK, ["define.speed is used nowhere"], {**good, "define": {"speed": 5}})
expect(
    "stress out of the plane", DECK, ["yz = 1000000 Pa", "plane strain"],
    changed(["initial", 0], {"block": "left", "stress": [0, 0, 0, 0, 1e6, 0]}),
)

# --- disks ------------------------------------------------------------------------------------------
expect("results in a folder that is missing", OUTPUT, ["no_such_folder"], changed(["output", "results"], "no_such_folder/run.e"))
# A full disk, imitated by a limit on the size of files of 10 MB: MPI's own files must stay below it.
for part, number in zip(recipe["parts"], (60, 61)):
    part["divisions"] = [number, number]
documents.save({"title": "bad input", **recipe}, "mesh.yaml")
program.make_mesh("mesh.yaml", "good.e")
full = changed(["output"], {"every": 1e-6})
expect("full disk", OUTPUT, ["run.e"], full, limit="10240")
steps = netCDF4.Dataset("full_disk/run.e")["time_whole"]
case.check_within("full disk: steps that can be read", len(steps), 2, 1000)
case.finish()
