"""A run, with everything that it has written."""

import collections
import fcntl
import functools
import json
import pathlib
import re

from . import exodus, fields, grids, tables
from .documents import parse
from .planes import Planes

# Ends of the columns that each of these has in the history (docs/user/outputs.md).
_MOTION = [f"{what}_{axis}" for what in ("displacement", "velocity") for axis in "xyz"]
_REACTION = [f"reaction_{axis}" for axis in "xyz"]
_DRIFT = [f"drift_{axis}" for axis in "xyz"]
_BODY = _MOTION + [f"{what}_{axis}" for what in ("spin", "reaction", "reaction_moment") for axis in "xyz"]
_JOINT = ["open_area", "stick_area", "slip_area", "mean_closure", "largest_slip", "normal_force", "stored", "friction", "hysteresis", "fracture"]
_RECORD = re.compile(r"(.+)\.run(?:-s([0-9]+))?\.json")
# What follows the name of a run in the names of its files.
_END = re.compile(r"\.run(-s[0-9]+)?\.json|_(blocks|pairs|materials|lines)\.csv|\.csv|\.e(-s[0-9]+)?(\.[0-9]+\.[0-9]+)?|\.yaml|\.log|\.chk\.[01]"
                  r"|_planes(\.pvd|_[0-9]+\.vtp|\.vtkhdf|\.xmf3)|_lines(\.pvd|_[0-9]+\.vtp)|-report\.html")  # fmt: skip


class NoRun(FileNotFoundError):
    """There is no run of a name, or more than one in a folder."""


class SeveralRuns(NoRun):
    """There is more than one in a folder."""


class IsMesh(NoRun):
    """A mesh was named, not the results of a run."""


class _Named(dict):
    """Parts of a run by name; the KeyError of a name that is not there lists those that are, and says what gives more."""

    def __init__(self, what, given_by, parts):
        super().__init__(parts)
        self.what, self.given_by = what, given_by

    def __missing__(self, name):
        raise KeyError(f"the run has no {self.what} '{name}'; it has {', '.join(self) or 'none'}. {self.given_by}")


def _stems(folder):
    """Names of the runs in a folder: of their records."""
    names = [_RECORD.fullmatch(path.name) for path in folder.iterdir()] if folder.is_dir() else []
    return sorted({name.group(1) for name in names if name})


def _is_results(path):
    """Whether an Exodus file is of a run: it has its identity, or steps."""
    try:
        file = exodus.Results(path)
    except (OSError, KeyError, ValueError):  # damaged, or something else
        return False
    return bool(file.run) or len(file.times) > 0


def _place(path):
    """Folder and name of the run that is meant by a folder, a name, or a file of the run."""
    path = pathlib.Path(path)
    if path.is_dir():
        stems = _stems(path) or sorted(file.stem for file in path.glob("*.csv") if file.with_suffix(".yaml").exists())
        if len(stems) == 1:
            return path, stems[0]
        if stems:
            raise SeveralRuns(f"{path}: the folder has several runs; open one of {', '.join(str(path / stem) for stem in stems)}.")
        if path.name in _stems(path.parent):  # `coplane wall/wall.yaml` runs beside the folder `wall`
            return path.parent, path.name
        raise NoRun(f"{path}: the folder has no record of a run (<name>.run.json) and no history beside its deck.")

    def is_run(stem):
        there = {end for end in (".run.json", ".csv", "_planes.pvd", "_planes.vtkhdf", ".e") if (path.parent / (stem + end)).exists()}
        return bool(there - {".e"}) or bool(there) and _is_results(path.parent / (stem + ".e"))

    # Where a name can be taken apart in two ways (wall_pairs.csv), the shorter one that is a run.
    stems = [path.name[:place] for place in range(1, len(path.name)) if _END.fullmatch(path.name, place)] if path.exists() else []
    stem = next(filter(is_run, stems), stems[-1] if stems else path.name)
    if not is_run(stem):
        there = _stems(path.parent)
        also = f"There are {', '.join(str(path.parent / name) for name in there)}." if there else \
            "Give the name of its deck without .yaml, with the folder in which it ran."
        if (path.parent / (stem + ".e")).exists():
            why = f"{path}: no run: {stem}.e is a mesh, or no Exodus file, and there is no {stem}.run.json or {stem}.csv. {also}"
            raise IsMesh(why) if path.suffix == ".e" else NoRun(why)
        log = path.parent / (stem + ".log")
        said = log.read_text(encoding="utf-8", errors="replace").splitlines()[-1:] if log.exists() else []
        raise NoRun(f"{path}: there is no run of this name: no {stem}.run.json, {stem}.csv or {stem}.e. "
                    + (f"{log} ends with: {said[0]}" if said else also))  # fmt: skip
    return path.parent, stem


def is_held(lock):
    """Whether a program that runs holds this lock."""
    try:
        with open(lock) as file:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except FileNotFoundError:
        return False
    except BlockingIOError:
        return True
    return False


class Run:
    """What a run has written so far: `run = coplane.open("out/wall")`. Everything is read when it is wanted first; a run that goes on is
    opened again to see more. Units are those of the files: SI.
    """

    def __init__(self, path):
        self.folder, self.name = _place(path)

    def __repr__(self):
        return f"<coplane run {self.folder / self.name}: {self.ending}>"

    def path(self, end):
        """Path of a file of the run: its name and what follows."""
        return self.folder / (self.name + end)

    def written(self, end):
        """Path of a file that the run itself writes."""
        return self.path(end)

    # --- what was run ------------------------------------------------------------------------------

    @functools.cached_property
    def records(self):
        """The records of all parts, the first run and its restarts."""
        found = []
        for path in self.folder.glob("*.json"):
            name = _RECORD.fullmatch(path.name)
            if name and name.group(1) == self.name:
                try:
                    found.append((int(name.group(2) or 1), dict(json.loads(path.read_text(encoding="utf-8")))))
                except (ValueError, TypeError) as error:
                    raise ValueError(f"{path}: the record is damaged, no JSON of a record: {error}. Without the file the rest of the run can be opened.") from error
        records = [record for _, record in sorted(found, key=lambda item: item[0])]
        return [record for record in records if record.get("run") == records[0].get("run")]

    @property
    def record(self):
        """That of the last part, <name>.run.json; empty when there is none."""
        return self.records[-1] if self.records else {}

    @property
    def identity(self):
        """What the record, results and planes of a run have in common; empty without a record."""
        return self.record.get("run", "")

    @property
    def is_running(self):
        """Whether a program writes the run now: it holds the lock."""
        return is_held(self.path(".lock"))

    @property
    def ending(self):
        """How it ended: that of the record, or `killed` where that says running but nothing runs; `unknown` without a record."""
        ending = self.record.get("ending", "unknown")
        return "killed" if ending == "running" and not self.is_running else ending

    @property
    def exit_code(self):
        """That of the program (docs/user/exit-codes.md), as the record of the last part says it; None while it runs, and when it was killed."""
        return self.record.get("exit_code")

    @property
    def newest_checkpoint(self):
        """Path of the last one that it has written; None when there is none."""
        named = ((parse(self.deck_text) or {}).get("checkpoint") or {}).get("file", f"{self.name}.chk")
        there = [path for number in "01" if (path := self.folder / f"{named}.{number}").exists()]
        return max(there, key=lambda path: path.stat().st_mtime, default=None)

    @property
    def deck_text(self):
        """The deck as it was used; empty when neither the record nor a deck beside it has it."""
        if "deck" in self.record:
            return self.record["deck"]["text"]
        return self.path(".yaml").read_text(encoding="utf-8", errors="replace") if self.path(".yaml").exists() else ""

    @property
    def deck(self):
        from .deck import Deck

        return Deck.from_text(self.deck_text, self.path(".yaml"))

    @functools.cached_property
    def log_path(self):
        """Of what the program printed; may be set to another file."""
        return self.path(".log")

    @property
    def log(self):
        """What the program printed, where that was kept in `log_path`; else empty."""
        return self.log_path.read_text(encoding="utf-8", errors="replace") if self.log_path.exists() else ""

    @property
    def messages(self):
        """Warnings and errors as the program showed them: of every part the last 40, each text once."""
        return list(dict.fromkeys(text for record in self.records for text in record.get("messages", [])))

    @property
    def warnings(self):
        """Number of warnings by kind, of all parts, with those that were not shown."""
        counts = collections.Counter()
        for record in self.records:
            counts.update(record.get("warnings", {}))
        return dict(counts)

    @property
    def errors(self):
        """Why the run failed, as its record says it; else the lines of the log that say what was wrong: a start that fails, or is killed, leaves no
        reason in the record."""
        if "reason" in self.record:
            return [f"ERROR: {self.record['reason']}"]
        return [line for line in self.log.splitlines() if re.match(r"(ERROR|error)[: ]", line)]

    @property
    def limits(self):
        """What limited the step, and how often it was seen to (the program looks about every five seconds): a dict, what was seen last at its end."""
        counts = {}
        for limit in (limit for record in self.records for limit in record.get("step_limits", [])):
            counts[limit["limited_by"]] = counts.pop(limit["limited_by"], 0) + limit["looks"]
        return counts

    # --- over time ---------------------------------------------------------------------------------

    @property
    def _history_path(self):
        path = self.written(".csv")
        if not path.exists():
            raise FileNotFoundError(f"{path}: there is no history of this run; it is written from the first cycle on, beside the record.")
        return path

    @functools.cached_property
    def columns(self):
        """The history as arrays by name, without pandas."""
        return tables.columns(self._history_path)

    @functools.cached_property
    def units(self):
        """Units by column of the history."""
        return tables.units(self._history_path)

    @functools.cached_property
    def history(self):
        """The history as a DataFrame: a line per time [s]; units in attrs["units"]."""
        return tables.frame(self._history_path)

    @functools.cached_property
    def tables(self):
        """Energies by blocks, pairs and materials, and segments of lines, of those that the run wrote, as DataFrames."""
        return _Named("table", "history.tables in the deck gives blocks, pairs, materials, lines.",
                      {name: tables.frame(path, index=None) for name in ("blocks", "pairs", "materials", "lines") if (path := self.table_path(name))})

    def table_path(self, name):
        """Path of a table; None when the run wrote none: the deck of its record says so, whatever an earlier run has left."""
        path = self.written(f"_{name}.csv")
        return path if path.exists() and self._asked("history", "tables", lambda names: name in (names or [])) else None

    def _asked(self, group, key, wants):
        """Whether the deck of any part asks for an output; runs without a record have what is there. wants(value of the key, or None)."""
        decks = [parse(record["deck"]["text"]) or {} for record in self.records if "deck" in record]
        return not decks or any(wants((deck.get(group) or {}).get(key)) for deck in decks)

    def groups(self, ends):
        """Names with a column `<name>_<end>` for each of these ends."""
        names = [name[: -len(ends[0]) - 1] for name in self.columns if name.endswith("_" + ends[0])]
        return [name for name in names if all(f"{name}_{end}" in self.columns for end in ends)]

    def _of(self, names, ends, what, key, also=()):
        """also: ends of columns that not every one has."""
        found = _Named(what, f"{key} in the deck names them.", {})
        for name in names:
            there = [*ends, *(end for end in also if f"{name}_{end}" in self.columns)]
            table = self.history[[f"{name}_{end}" for end in there]].set_axis(there, axis=1)
            table.attrs["units"] = {end: self.units[f"{name}_{end}"] for end in there}
            found[name] = table
        return found

    @property
    def probe_names(self):
        return [name for name in self.groups(_MOTION) if name not in self.body_names]

    @property
    def probes(self):
        """Motion of every probe: displacement_x..z, velocity_x..z, and where the deck asks for them reaction_x..z and drift_x..z, as DataFrames."""
        return self._of(self.probe_names, _MOTION, "probe", "history.probes", also=_REACTION + _DRIFT)

    @property
    def joint_names(self):
        return self.groups(_JOINT)

    @property
    def joints(self):
        """Areas, closure, slip, force and energies of every joint of `history.joints`, as DataFrames."""
        return self._of(self.joint_names, _JOINT, "joint in its history", "history.joints")

    @property
    def body_names(self):
        return self.groups(_BODY)

    @property
    def bodies(self):
        """Motion, spin and reactions of every body of `history.rigid`, as DataFrames."""
        return self._of(self.body_names, _BODY, "body", "history.rigid")

    @property
    def _results_name(self):
        """Of the Exodus file: that of the deck, if it is there; that of the run, which may have been renamed; else that of the deck's file, whose
        name the run need not have."""
        named = ((parse(self.deck_text) or {}).get("output") or {}).get("results", "none")
        of_deck = named if named != "none" else pathlib.Path(self.record.get("deck", {}).get("file", self.name + ".yaml")).stem + ".e"
        places = [of_deck, f"{self.name}.e"]
        for name in places:
            try:
                exodus.files_of(self.folder / name, self.identity)
                return name
            except OSError:  # not there, of another run, or damaged
                continue
        return next((name for name in places if (self.folder / name).exists()), of_deck)

    # --- fields ------------------------------------------------------------------------------------

    @functools.cached_property
    def results(self):
        """The Exodus files of the run as one series, with arrays of numpy."""
        if not self._asked("output", "results", lambda name: name != "none"):
            raise FileNotFoundError(f"{self.folder / self.name}: the run writes no results (output.results: none).")
        return exodus.Series(exodus.files_of(self.written("").parent / self._results_name, self.identity))

    @functools.cached_property
    def nodes(self):
        """Fields on nodes as a Dataset: dimensions time and node."""
        return fields.nodes(self.results)

    @functools.cached_property
    def elements(self):
        """Fields on all elements as a Dataset: dimensions time and element; the coordinate block says which block."""
        return fields.elements(self.results)

    @functools.cached_property
    def blocks(self):
        """Fields on the elements of each block, with their connectivity."""
        return _Named("block", "The mesh names them.", {name: fields.block(self.results, name) for name in self.results.blocks})

    def vtk(self, step=-1, blocks=None, deformed=True, dead=False):
        """A step of the results as a vtkUnstructuredGrid with all fields on nodes and elements, which pyvista.wrap takes.

        blocks: names, default all. deformed: points moved by the displacement, else as at the start [m]. dead: also elements that are no
        longer there. Vectors have three components, in two dimensions the last is 0; `stress` has xx, yy, zz, xy, yz, zx. `node_id` and
        `element_id` are the ids of the mesh, `block_id` those of the blocks, whose names are `block_names`, and `body_id` is there when the mesh has it; `TimeValue` is the time [s].
        """
        return grids.grid(self.results, step, blocks, deformed, dead)

    @functools.cached_property
    def node_sets(self):
        """Positions of the nodes of each set: `run.nodes.isel(node=run.node_sets["tip"])`."""
        return _Named("node set", "The mesh names them.", {name: self.results.set_nodes(name) for name in self.results.node_sets})

    @functools.cached_property
    def side_sets(self):
        """Fields of contact on the sides of each set: dimensions time and side."""
        return _Named("side set", "The mesh names them.", {name: fields.sides(self.results, name) for name in self.results.side_sets})

    @functools.cached_property
    def globals(self):
        """Time step and energies at the times of the results."""
        return fields.whole(self.results)

    @functools.cached_property
    def planes(self):
        """The contact planes over time."""
        self.written("")
        if not self._asked("output", "planes", lambda value: value is not False):
            raise FileNotFoundError(f"{self.folder / self.name}: the run writes no planes (output.planes: false).")
        return Planes(self.planes_path, self.identity)

    @property
    def results_path(self):
        """Path of the shared file of results, or of its first part."""
        return self.written("").parent / self._results_name

    @property
    def fragments_path(self):
        """Path of the table of connected bodies (output.fragments)."""
        stem = self.folder / pathlib.Path(self._results_name).with_suffix("")
        return stem.with_name(stem.name + "_fragments.csv")

    @property
    def fragments(self):
        """Connected bodies over time, a pandas DataFrame: output.fragments in the deck gives it."""
        self.written("")
        if not self._asked("output", "fragments", bool):
            raise FileNotFoundError(f"{self.fragments_path}: the run writes no fragments; output.fragments: true in the deck gives them.")
        return tables.frame(self.fragments_path)

    @property
    def planes_path(self):
        """Path of the series of planes: that of the format which the deck asks for, or what is there when it asks for none."""
        stem = self.folder / f"{pathlib.Path(self._results_name).with_suffix('')}_planes"
        output = (parse(self.deck_text) or {}).get("output") or {}
        one, many = stem.with_name(stem.name + ".vtkhdf"), stem.with_name(stem.name + ".pvd")
        wanted = output.get("planes_format", "vtkhdf" if one.exists() or not many.exists() else "vtp")
        return one if wanted == "vtkhdf" else many
