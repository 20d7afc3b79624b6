"""Checks on a run of exodus_inputs/run.py: an example's check.py uses this."""

import json
import pathlib
import sys

import numpy

from .checks import Checks
from .ended import EndedRun

class Example(Checks):
    """The run in the folder that the command line names; `size` and `variant` say which.

        example = Example()
        example.balances()
        example.check_within("residual speed [m/s]", ...)
        example.finish()
    """

    def __init__(self, folder=None):
        self.folder = pathlib.Path(folder or sys.argv[1]).resolve()
        chosen = json.loads((self.folder / "example.json").read_text())
        self.size, self.variant = chosen["size"], chosen["variant"]
        self.name = "_".join(filter(None, (chosen["example"], self.size, self.variant)))
        self.source = pathlib.Path(chosen["source"])
        self.failures = 0
        self.record = self.folder / "checks.jsonl"
        self.record.write_text("")
        self.run = EndedRun(self.folder, 0, (self.folder / "run.log").read_text())
        self.history = self.run.history

    @property
    def results(self):
        return self.run.results

    def in_play(self):
        """The energy against which errors count [J]: the largest of what was kinetic, internal, or came from outside."""
        h = self.history
        return max(h["initial"][-1], *(numpy.abs(h[name]).max() for name in ("kinetic", "internal", "external_work")))

    def balances(self, energy=0.02, hourglass=0.05, remainder=(-1e-3, 1e-3), momentum=1e-10, missed=0):
        """What must hold in every example, in every line of the history."""
        h, in_play = self.history, self.in_play()
        self.check_within("energy balance over energy in play", numpy.abs(h["error"]).max() / in_play, 0, energy)
        lost = h["contact_remainder"]
        self.check_within("contact remainder over energy in play", lost[numpy.argmax(numpy.abs(lost))] / in_play, *remainder)
        self.check_within("hourglass over largest internal energy", numpy.abs(h["hourglass"]).max() / (numpy.abs(h["internal"]).max() or 1.0),
                          0, hourglass)
        scale = numpy.sqrt(2 * self.run.mass * h["kinetic"].max())  # >= sum m |v| (Cauchy)
        error = max(numpy.abs(h[f"momentum_error_{axis}"]).max() for axis in "xyz")
        self.check_within("momentum without impulses over sqrt(2 M KE)", error / scale, 0, momentum)
        self.check_within("contacts missed", int(h["missed"].max()), 0, missed)

    def all_planes(self):
        """Contact planes of every output step, one after the other."""
        series = self.run.series
        return map(series.fields, range(len(series)))

    def deepest(self, area):
        """Largest closure of all planes with at least this area, over all output steps [m]. Slivers may be deeper: where a
        body turns, faces that oppose each other a little overlap a little, deep inside."""
        most = 0.0
        for fields in self.all_planes():
            large = fields["area"] > area
            if large.any():
                most = max(most, float(fields["closure"][large].max()))
        return most

    def at(self, name, time):
        """A column of the history at one time."""
        return float(numpy.interp(time, self.history["time"], self.history[name]))
