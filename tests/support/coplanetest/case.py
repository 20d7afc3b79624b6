"""A verification case: runs it needs and checks it makes."""

import json
import os
import pathlib
import shutil
import sys

import numpy

from . import documents, program


class Case:
    """`folder_of` is the check's __file__: recipes and decks stand beside it. Runs are made in the
    working folder, each in a folder of its own.
    """

    def __init__(self, name, folder_of):
        self.name = name
        self.source = pathlib.Path(folder_of).resolve().parent
        self.failures = 0

    # --- documents ---------------------------------------------------------------------------------

    def load(self, name="deck.yaml"):
        """A deck or recipe beside the check; a name with a folder: relative to the project."""
        path = self.source / name
        if not path.exists():
            path = pathlib.Path(os.environ["COPLANE_SOURCE"]) / name
        return documents.load(path)

    # --- runs --------------------------------------------------------------------------------------

    def run(self, name, recipe, deck, ranks=1, threads=1, backend="serial", options=(), **tolerances):
        """Makes the mesh, runs the deck, demands exit code 0 and checks conservation.

        Tolerances: see conservation().
        """
        result = self.attempt(name, recipe, deck, ranks, threads, backend, options)
        if result.code:
            sys.exit(f"{self.name}, run '{name}': exit code {result.code}\n{result.output}")
        self.conservation(name, result, deck, **tolerances)
        return result

    def attempt(self, name, recipe, deck, ranks=1, threads=1, backend="serial", options=(), prefix=()):
        """The same without demands on how the run ends. `recipe` None: no mesh is made."""
        folder = pathlib.Path(name).resolve()
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        if recipe is not None:
            documents.save({"title": self.name, **recipe}, folder / "mesh.yaml")
            program.make_mesh(str(folder / "mesh.yaml"), str(folder / "mesh.e"))
        documents.save({"mesh": "mesh.e", **deck}, folder / "run.yaml")
        arguments = ["run.yaml", "--backend", backend, "--threads", str(threads), *options]
        code, output = program.run_program(arguments, folder, ranks, prefix)
        (folder / "output.txt").write_text(output)
        return program.Run(folder, code, output)

    def conservation(self, name, run, deck, energy=1e-3, momentum=1e-12, angular=1e-11, remainder=None):
        """Every run keeps its balances, in every recorded cycle.

        energy: error of the balance over the energy in play (element energies, so of order dt^2).
        momentum, angular: momentum less what loads and reactions gave, over sum m |v| (times the
        distance from the origin). Only rounding is allowed; sum m |v| <= sqrt(2 M KE) (Cauchy). What
        gravity gives counts too, also where a support takes it at once.
        remainder: what contact lost because areas change under load, over the energy in play.
        """
        h = run.history
        in_play = max(
            numpy.max(h["kinetic"]), numpy.max(h["internal"]), numpy.max(numpy.abs(h["external_work"]))
        )
        weight = run.mass * numpy.linalg.norm(deck.get("gravity", 0))
        scale = numpy.sqrt(2 * run.mass * numpy.max(h["kinetic"])) + weight * h["time"][-1]
        results = run.results
        reach = numpy.max(numpy.abs(results.coordinates)) + numpy.max(numpy.abs(results.nodal("displacement")))
        vectors = {
            quantity: numpy.sqrt(sum(h[f"{quantity}_error_{axis}"] ** 2 for axis in "xyz"))
            for quantity in ("momentum", "angular_momentum")
        }
        self.check(f"{name}: energy balance", numpy.max(numpy.abs(h["error"])) / in_play, 0, energy)
        self.check(f"{name}: momentum", numpy.max(vectors["momentum"]) / scale, 0, momentum)
        self.check(
            f"{name}: angular momentum", numpy.max(vectors["angular_momentum"]) / (scale * reach), 0, angular
        )
        self.check(f"{name}: missed contacts", int(numpy.max(h["missed"])), 0, 0)
        if remainder is not None:
            self.check(
                f"{name}: contact remainder", numpy.max(numpy.abs(h["contact_remainder"])) / in_play, 0, remainder
            )

    # --- checks ------------------------------------------------------------------------------------

    def check(self, quantity, value, reference, tolerance, relative=False, report=False):
        """One JSON line. `tolerance` is absolute, or relative to the reference. `report`: the line is
        printed, but does not fail the case.
        """
        error = abs(value - reference)
        if relative:
            error /= abs(reference)
        passed = bool(error <= tolerance)  # false for NaN
        self.line(quantity, value, reference, error, tolerance, passed, report)
        return passed

    def check_equal(self, quantity, value, reference):
        """For texts, lists and counts."""
        same = value == reference
        self.line(quantity, value, reference, 0 if same else 1, 0, same)
        return same

    def check_within(self, quantity, value, low, high):
        """One-sided or unsymmetric limits; the reference is the nearer end of the interval."""
        passed = bool(low <= value <= high)
        self.line(quantity, value, [low, high], 0 if passed else min(abs(value - low), abs(value - high)), 0, passed)
        return passed

    def line(self, quantity, value, reference, error, tolerance, passed, report=False):
        def plain(x):
            return x.item() if isinstance(x, numpy.generic) else x

        record = {
            "case": self.name,
            "quantity": quantity,
            "value": plain(value),
            "reference": plain(reference),
            "error": plain(error),
            "tolerance": plain(tolerance),
            "passed": passed,
        }
        if report:
            record["reported"] = True
        elif not passed:
            self.failures += 1
        print(json.dumps(record), flush=True)

    def finish(self):
        """Call last: the exit code tells whether all checks passed."""
        if self.failures:
            sys.exit(f"{self.name}: {self.failures} checks failed")
