"""What a run has left, as checks want it: arrays of one file after the other."""

import json
import os
import re

from coplane import tables
from coplane.exodus import Results
from coplane.results import Run


class EndedRun:
    """A run of a deck `run.yaml` that has ended, with what it wrote in its folder."""

    def __init__(self, folder, code, output):
        self.folder, self.code, self.output = str(folder), code, output
        self._history = self._results = None

    def path(self, name):
        return os.path.join(self.folder, name)

    @property
    def history(self):
        """Columns of the CSV history by name without unit, as arrays."""
        if self._history is None:
            self._history = tables.columns(self.path("run.csv"))
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
        return sorted(name for name in os.listdir(self.folder) if re.match(r"run_planes.*\.(vtkhdf|xmf3|vtp|pvd)$", name))

    @property
    def series(self):
        """Contact planes over time."""
        return Run(self.path("run.yaml")).planes

    def planes(self, step=-1):
        """Contact planes of one output step, by field."""
        return self.series.fields(step)

    def bytes_of(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()
