"""A verification case: runs it needs and checks it makes."""

import json
import os
import pathlib
import re
import shutil
import sys

import numpy

from coplanetools import EndedRun, documents, program
from coplanetools.checks import Checks

from . import tellings


class Case(Checks):
    """`folder_of` is the check's __file__: recipes and decks stand beside it. Runs are made in the
    working folder, each in a folder of its own.
    """

    def __init__(self, name, folder_of):
        self.name = name
        self.source = pathlib.Path(folder_of).resolve().parent
        self.failures = 0
        # All lines once more in a file, of which support/verification_page.py makes a page.
        folder = os.environ.get("COPLANE_CHECKS_DIR")
        arguments = [argument for argument in sys.argv[1:] if not argument.startswith("-")]
        name = "_".join([self.source.name, *arguments]) + ".jsonl"
        self.record = pathlib.Path(folder, name) if folder else pathlib.Path("checks.jsonl").resolve()
        self.record.parent.mkdir(parents=True, exist_ok=True)
        self.record.write_text("")

    # --- documents ---------------------------------------------------------------------------------

    def load(self, name="deck.yaml"):
        """A deck or recipe beside the check; a name with a folder: relative to the project."""
        path = self.source / name
        if not path.exists():
            path = pathlib.Path(os.environ["COPLANE_SOURCE"]) / name
        return documents.load(path)

    # --- runs --------------------------------------------------------------------------------------

    def run(
        self, name, recipe, deck, ranks=1, threads=1, backend="serial", options=(), change_mesh=None, joints=None,
        edit_mesh=None, **tolerances
    ):
        """Makes the mesh, runs the deck, demands exit code 0 and checks conservation.

        Tolerances: see conservation().
        """
        result = self.attempt(
            name, recipe, deck, ranks, threads, backend, options, change_mesh=change_mesh, joints=joints, edit_mesh=edit_mesh
        )
        if result.code:
            sys.exit(f"{self.name}, run '{name}': exit code {result.code}\n{result.output}")
        self.conservation(name, result, deck, **tolerances)
        return result

    def same_bits(
        self, name, recipe, deck, run, ranks=2, threads=1, backend="threads", change_mesh=None, joints=None
    ):
        """The run again, on other ranks and threads: every bit of the state must be the same. Not asked in other words."""
        if tellings.wanted():
            return
        again = self.attempt(
            f"{name}_again", recipe, deck, ranks, threads, backend, change_mesh=change_mesh, joints=joints
        )
        kept = "same bits on other ranks"
        self.check_equal(f"{name}: exit code on {ranks} ranks x {threads} threads", again.code, 0, kept)
        self.check_equal(f"{name}: state hash on {ranks} ranks x {threads} threads", again.state_hash, run.state_hash, kept)

    def restarts(self, name, recipe, deck, run, near, ranks=1, **how):
        """The run again, with a checkpoint in that cycle which `run` has recorded next to the time `near`, and gone on with from there
        on the other back end: every bit of the state at the end must be the same. It ends there the first time, but for a run in stages,
        whose checkpoint must be in its second half. Not asked in other words.
        """
        if tellings.wanted():
            return
        at = 1 + numpy.argmin(numpy.abs(run.history["time"][1:-1] - near))
        if "stages" in deck:
            options = ["--set", f"checkpoint.every_cycles={int(run.history['cycle'][at])}"]
        else:
            options = ["--set", f"time.end={float(run.history['time'][at])!r}", "--set", "checkpoint.at_end=true"]
        first = self.attempt(f"{name}_restarted", recipe, deck, options=options, **how)
        kept = "same bits after a restart"
        self.check_equal(f"{name}: exit code of the run to be gone on with", first.code, 0, kept)
        code, output = program.run_program(["run.yaml", "--restart", "--backend", "threads"], first.folder, ranks)
        pathlib.Path(first.path("output-restart.txt")).write_text(output)
        kept = "same bits after a restart"
        self.check_equal(f"{name}: exit code of the restart", code, 0, kept)
        self.check_equal(f"{name}: it went on from there", f": cycle {int(run.history['cycle'][at])}, t = " in output, True, kept)
        if code == 0:
            again = json.loads(pathlib.Path(first.path("run.run-s0002.json")).read_text())["state_hash"]
            self.check_equal(f"{name}: state hash after a restart on {ranks} ranks, with threads", again, run.state_hash, kept)

    def attempt(
        self, name, recipe, deck, ranks=1, threads=1, backend="serial", options=(), prefix=(), change_mesh=None,
        joints=None, edit_mesh=None,
    ):
        """The same without demands on how the run ends. `recipe` None: no mesh is made. `change_mesh`
        gets the mesh's coordinates (node, axis) and returns those that are used. `joints`: a recipe of
        joints that are opened in the mesh. `edit_mesh` gets the path of the mesh and may change all of it.
        """
        folder = pathlib.Path(name).resolve()
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        if recipe is not None:
            documents.save({"title": self.name, **recipe}, folder / "mesh.yaml")
            program.make_mesh(str(folder / "mesh.yaml"), str(folder / ("whole.e" if joints else "mesh.e")))
        if joints is not None:
            documents.save(joints, folder / "joints.yaml")
            split = program.split_mesh(str(folder / "whole.e"), str(folder / "joints.yaml"), str(folder / "mesh.e"))
            (folder / "split.txt").write_text(split)
        if change_mesh is not None:
            program.change_coordinates(str(folder / "mesh.e"), change_mesh)
        if edit_mesh is not None:
            edit_mesh(str(folder / "mesh.e"))
        told = tellings.retold(folder, deck)
        documents.save({"mesh": "mesh.e", **(told.deck if told else deck)}, folder / "run.yaml")
        arguments = ["run.yaml", "--backend", backend, "--threads", str(threads), *options]
        code, output = 0, ""
        if told and told.restarted:
            stop = ["--set", f"time.end={0.5 * deck['time']['end']!r}", "--set", "checkpoint.at_end=true"]
            code, output = program.run_program([*arguments, *stop], folder, ranks, prefix)
            arguments.append("--restart")
        if code == 0:
            code, printed = program.run_program(arguments, folder, ranks, prefix)
            output += re.sub(r"(?m)^ *block '.*mass \S+ kg.*\n", "", printed) if output else printed  # the start tells the blocks
        (folder / "output.txt").write_text(output)
        if not told:
            return EndedRun(folder, code, output)
        run = tellings.ToldRun(folder, code, output, told)
        if code == 0:
            run.keep()
        return run

    def conservation(self, name, run, deck, energy=1e-3, momentum=1e-12, angular=1e-11, remainder=None, load=0):
        """Every run keeps its balances, in every recorded cycle.

        energy: error of the balance over the energy in play (element energies, so of order dt^2).
        momentum, angular: momentum less what loads and reactions gave, over sum m |v| (times the
        distance from the origin). Only rounding is allowed; sum m |v| <= sqrt(2 M KE) (Cauchy). What
        gravity and a lasting load give counts too, also where a support takes it at once: the sums of
        what both gave are rounded, and a body at rest has no m |v| to compare that with.
        remainder: what contact lost because areas change under load, over the energy in play.
        load: force that acts during the run and is borne by supports [N].
        """
        if isinstance(run, tellings.ToldRun):  # balances are those of the run as it is
            run, deck = run.raw, run.deck
            momentum, angular = 10 * momentum, 10 * angular  # odd angles, more nodes and other orders are rounded otherwise
        h = run.history
        in_play = max(
            numpy.max(h["kinetic"]),
            numpy.max(h["internal"]),
            numpy.max(numpy.abs(h["external_work"])),
            h["contact_stored"][0],  # of joints under initial stress: all that there is at rest
        )
        # Components that vary in time do not count.
        gravity = [g for g in deck.get("gravity", []) if isinstance(g, (int, float))]
        weight = run.mass * numpy.linalg.norm(gravity)
        scale = numpy.sqrt(2 * run.mass * numpy.max(h["kinetic"])) + (weight + load) * h["time"][-1]
        results = run.results
        reach = numpy.max(numpy.abs(results.coordinates)) + numpy.max(numpy.abs(results.nodal("displacement")))
        vectors = {
            quantity: numpy.sqrt(sum(h[f"{quantity}_error_{axis}"] ** 2 for axis in "xyz"))
            for quantity in ("momentum", "angular_momentum")
        }

        def kept(what, value, tolerance):
            self.check(f"{name}: {what}", value, 0, tolerance, kept=what)

        kept("energy balance", numpy.max(numpy.abs(h["error"])) / in_play, energy)
        kept("momentum", numpy.max(vectors["momentum"]) / scale, momentum)
        kept("angular momentum", numpy.max(vectors["angular_momentum"]) / (scale * reach), angular)
        kept("missed contacts", int(numpy.max(h["missed"])), 0)
        if remainder is not None:
            kept("contact remainder", numpy.max(numpy.abs(h["contact_remainder"])) / in_play, remainder)
