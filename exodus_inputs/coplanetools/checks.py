"""Checks, one JSON line each."""

import json
import sys

import numpy


class Checks:
    """Lines are printed and added to the file `record`. A class of its own sets `name`, of what is checked, `source`, the folder
    it comes from, `record`, and `failures` to 0.
    """

    def check(self, quantity, value, reference, tolerance, relative=False, report=False, kept=None):
        """One JSON line. `tolerance` is absolute, or relative to the reference. `report`: the line is
        printed, but does not fail the case. `kept`: the balance that this line is about.
        """
        error = abs(value - reference)
        if relative:
            error /= abs(reference)
        passed = bool(error <= tolerance)  # false for NaN
        self.line(quantity, value, reference, error, tolerance, passed, report, kept, relative)
        return passed

    def check_equal(self, quantity, value, reference, kept=None):
        """For texts, lists and counts."""
        same = value == reference
        self.line(quantity, value, reference, 0 if same else 1, 0, same, kept=kept)
        return same

    def check_within(self, quantity, value, low, high):
        """One-sided or unsymmetric limits; the reference is the nearer end of the interval."""
        passed = bool(low <= value <= high)
        self.line(quantity, value, [low, high], 0 if passed else min(abs(value - low), abs(value - high)), 0, passed)
        return passed

    def line(
        self, quantity, value, reference, error, tolerance, passed, report=False, kept=None, relative=False
    ):
        record = {
            "case": self.name,
            "quantity": quantity,
            "value": value,
            "reference": reference,
            "error": error,
            "tolerance": tolerance,
            "passed": passed,
        }
        if report:
            record["reported"] = True
        elif not passed:
            self.failures += 1
        print(json.dumps(record, default=numpy.generic.item), flush=True)
        if kept:
            record["kept"] = kept
        if relative:
            record["relative"] = True
        self.append(record)

    def append(self, record):
        with open(self.record, "a") as file:
            file.write(json.dumps({**record, "folder": self.source.name}, default=numpy.generic.item) + "\n")

    def finish(self):
        """Call last: the exit code tells whether all checks passed."""
        if self.failures:
            sys.exit(f"{self.name}: {self.failures} checks failed")
