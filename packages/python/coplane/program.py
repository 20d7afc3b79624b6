"""Runs the programs. COPLANE_BIN is the folder that holds them; else they are sought beside this package, then on PATH."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile

import netCDF4
import numpy

from . import documents

# The source tree (packages/python/coplane), or PREFIX/share/coplane (python/coplane).
_ROOT = pathlib.Path(__file__).resolve().parents[2]
TOP = _ROOT.parent if _ROOT.name == "packages" else _ROOT

# What the test environment of CMake sets too, for runs by hand: containers, root, few cores.
for _name, _value in {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
    "OMPI_MCA_mpi_yield_when_idle": "1",
    "OMP_WAIT_POLICY": "passive",
    "OMP_PROC_BIND": "false",
}.items():
    os.environ.setdefault(_name, _value)


class ProgramFailed(RuntimeError):
    """A program that ended with another exit code than 0; the text has what it printed."""


def binary(name):
    """Path of a program. FileNotFoundError says where it was sought; a folder that COPLANE_BIN names is not looked into."""
    folder = os.environ.get("COPLANE_BIN")
    if folder:
        return os.path.join(os.path.abspath(folder), name)
    folders = [TOP / "build/bin", TOP.parents[1] / "bin"]
    beside = [str(place / name) for place in folders if (place / name).exists()]
    found = beside[0] if beside else shutil.which(name)
    if not found:
        raise FileNotFoundError(f"{name} is neither in {' or '.join(map(str, folders))} nor on PATH. Set COPLANE_BIN to the folder with the "
                                "programs, for instance COPLANE_BIN=build/bin.")
    return found


def schema(name):
    """Path of a JSON Schema of input files: deck, point-deck, recipe, joint-recipe or example."""
    return TOP / f"docs/schemas/{name}.json"


def deck_schema():
    """The JSON Schema of decks: the file of the source tree or the installation; where only this package is installed, what coplane prints."""
    path = schema("deck")
    return json.loads(path.read_text() if path.exists() else subprocess.run([binary("coplane"), "--schema"], stdout=subprocess.PIPE, text=True, check=True).stdout)


def command(arguments, ranks=1, prefix=()):
    """Command line of coplane on some ranks."""
    launch = [os.environ.get("MPIEXEC", "mpirun"), "-np", str(ranks), "--bind-to", "none"] if ranks > 1 else []
    return [*prefix, *launch, binary("coplane"), *arguments]


def run_program(arguments, folder, ranks=1, prefix=(), timeout=550):
    """Runs coplane with these arguments; returns exit code and everything it printed."""
    done = subprocess.run(
        command(arguments, ranks, prefix), cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=timeout
    )
    return done.returncode, done.stdout


def mesh_program(*arguments):
    """Runs coplane_mesh and returns what it printed."""
    arguments = [str(argument) for argument in arguments]
    done = subprocess.run([binary("coplane_mesh"), *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        raise ProgramFailed(f"coplane_mesh {' '.join(arguments)}: exit code {done.returncode}\n{done.stdout}")
    return done.stdout


def _with_recipe(recipe, call):
    """call(path of the recipe); a dict goes to a file for it, which messages call `recipe`."""
    if not isinstance(recipe, dict):
        return call(recipe)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "recipe.yaml")
        documents.save(documents.plain(recipe), path)
        try:
            return call(path).replace(path, "recipe")
        except ProgramFailed as failed:
            raise ProgramFailed(str(failed).replace(path, "recipe")) from None


def make_mesh(recipe, output):
    """Makes the mesh of a recipe (a path, or the recipe as a dict) at a path. Returns what the program printed; ProgramFailed has every mistake."""
    return _with_recipe(recipe, lambda path: mesh_program("make", path, "-o", output))


def split_mesh(mesh, joints, output):
    """Opens the joints of a recipe (a path, or a dict) in a mesh; returns what the program printed."""
    return _with_recipe(joints, lambda path: mesh_program("split", mesh, path, "-o", output))


def change_coordinates(mesh, change):
    """Moves the nodes of a mesh: `change` takes and returns an array (node, axis)."""
    with netCDF4.Dataset(mesh, "a") as file:
        file.set_auto_mask(False)
        names = [f"coord{axis}" for axis in "xyz" if f"coord{axis}" in file.variables]
        changed = change(numpy.stack([file[name][:] for name in names], axis=1))
        for axis, name in enumerate(names):
            file[name][:] = changed[:, axis]


# What scripts for pictures share: coplane_pictures.
PARAVIEW = next((path for path in (TOP / "apps/coplane/paraview", TOP / "paraview") if path.is_dir()), None)


def missing_for_pictures():
    """Programs that ParaView without a screen needs and that are not there."""
    return [name for name in ("xvfb-run", "pvbatch") if not shutil.which(name)]


def run_paraview(script, arguments, folder, timeout=None):
    """Runs a script of pvbatch without a screen; returns exit code and what it printed."""
    environment = dict(os.environ, PYTHONPATH=str(PARAVIEW), PYTHONDONTWRITEBYTECODE="1")
    for attempt in range(3):
        # A display number of its own: two that seek a free one at the same time may find the same. ParaView looks for the display before it draws, and
        # a display without -noreset starts anew when nobody looks at it: on a busy machine it was then not there, and ParaView aborted (134).
        display = str(100 + (os.getpid() + 1000 * attempt) % 30000)
        done = subprocess.run(["xvfb-run", "-a", "-n", display, "-s", "-screen 0 1280x1024x24 -noreset", "pvbatch", str(script), *map(str, arguments)], cwd=folder, env=environment,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", timeout=timeout)  # fmt: skip
        if done.returncode != 134 and (not done.returncode or "CreateAWindow" not in done.stdout):
            break
    return done.returncode, done.stdout
