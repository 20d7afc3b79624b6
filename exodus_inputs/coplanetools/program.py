"""Runs the programs. COPLANE_BIN is the folder that holds them."""

import csv
import json
import os
import re
import subprocess
import sys

import netCDF4
import numpy

from .results import Results, planes

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


def binary(name):
    folder = os.environ.get("COPLANE_BIN")
    if not folder:
        sys.exit("set COPLANE_BIN to the folder with the programs, for instance COPLANE_BIN=build/bin")
    return os.path.join(os.path.abspath(folder), name)


def run_program(arguments, folder, ranks=1, prefix=(), timeout=550):
    """Runs coplane with these arguments; returns exit code and everything it printed."""
    command = list(prefix)
    if ranks > 1:
        command += [os.environ.get("MPIEXEC", "mpirun"), "-np", str(ranks), "--bind-to", "none"]
    command += [binary("coplane")] + list(arguments)
    done = subprocess.run(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=timeout
    )
    return done.returncode, done.stdout


def make_mesh(recipe, output):
    done = subprocess.run(
        [binary("coplane_mesh"), "make", recipe, "-o", output],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )
    if done.returncode:
        sys.exit(f"coplane_mesh make {recipe}: exit code {done.returncode}\n{done.stdout}")


def split_mesh(mesh, joints, output):
    """Opens the joints of a recipe; returns what the program printed."""
    done = subprocess.run(
        [binary("coplane_mesh"), "split", mesh, joints, "-o", output],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )
    if done.returncode:
        sys.exit(f"coplane_mesh split {mesh} {joints}: exit code {done.returncode}\n{done.stdout}")
    return done.stdout


def change_coordinates(mesh, change):
    """Moves the nodes of a mesh: `change` takes and returns an array (node, axis)."""
    with netCDF4.Dataset(mesh, "a") as file:
        file.set_auto_mask(False)
        names = [f"coord{axis}" for axis in "xyz" if f"coord{axis}" in file.variables]
        changed = change(numpy.stack([file[name][:] for name in names], axis=1))
        for axis, name in enumerate(names):
            file[name][:] = changed[:, axis]


class Run:
    """A run that has ended, with what it wrote in its folder."""

    def __init__(self, folder, code, output):
        self.folder, self.code, self.output = str(folder), code, output
        self._history = self._results = None

    def path(self, name):
        return os.path.join(self.folder, name)

    @property
    def history(self):
        """Columns of the CSV history by name without unit, as arrays."""
        if self._history is None:
            with open(self.path("run.csv")) as file:
                rows = list(csv.reader(file))
            columns = numpy.array([[float(value) for value in row] for row in rows[1:]]).T
            self._history = {re.sub(r"\[.*\]", "", name): column for name, column in zip(rows[0], columns)}
        return self._history

    @property
    def results(self):
        if self._results is None:
            self._results = Results(self.path("run.e"))
        return self._results

    @property
    def record(self):
        with open(self.path("run.run.json")) as file:
            return json.load(file)

    @property
    def state_hash(self):
        return self.record["state_hash"]

    @property
    def mass(self):
        """Of all blocks, as printed at the start [kg]."""
        return sum(float(value) for value in re.findall(r"block .*mass (\S+) kg", self.output))

    def planes_files(self):
        return sorted(name for name in os.listdir(self.folder) if re.match(r"run_planes.*\.(vtp|pvd)$", name))

    def planes(self, step=-1):
        """Contact planes of one output step, by field."""
        return planes(self.path([name for name in self.planes_files() if name.endswith(".vtp")][step]))

    def bytes_of(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()
