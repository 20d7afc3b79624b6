"""Runs decks: one, while it goes on, and many with other values."""

import itertools
import numbers
import os
import pathlib
import subprocess
import time

from . import documents, program, tables
from .deck import Deck
from .needs import needs
from .results import Run, is_held


class RunFailed(program.ProgramFailed):
    """A run that ended with another exit code than 0: `code` (docs/user/exit-codes.md), `run`."""

    def __init__(self, code, run):
        last = run.log.splitlines()[-15:]
        said = "\n".join([line for line in run.errors if line not in last] + last)
        super().__init__(f"coplane ended with exit code {code}; {run.path('.log')} ends with\n{said}")
        self.code, self.run = code, run


class Started(Run):
    """A run that this program has started; `process` is the program."""

    def __init__(self, folder, name, process, before, restart):
        """before: `_state` of the history before the start."""
        self.folder, self.name, self.process, self.before, self.restart = folder, name, process, before, restart

    @property
    def has_begun(self):
        """Whether the program has written the history: what was there before is of an earlier run."""
        return _state(self.path(".csv")) != self.before

    def written(self, end):
        if not (self.restart or self.has_begun):
            raise FileNotFoundError(f"{self.path(end)}: this run has written nothing; what is there is of an earlier one.")
        return super().written(end)

    @property
    def records(self):
        """Those of this run; none before it has begun."""
        return Run(self.path(".yaml")).records if self.restart or self.has_begun else []

    @property
    def ending(self):
        return super().ending if self.has_begun else "running" if self.is_running else "failed"

    @property
    def is_running(self):
        return self.process.poll() is None

    def wait(self):
        """Until it has ended; RunFailed when that was not well. Returns the run as it is then."""
        code = self.process.wait()
        if code:
            raise RunFailed(code, self)
        return Run(self.path(".yaml"))


def _demand_number(name, value):
    """ValueError unless a number of ranks or threads is a whole one from 1 on."""
    if not isinstance(value, numbers.Integral) or isinstance(value, bool) or value < 1:
        raise ValueError(f"{name}={value!r}; accepted: a whole number from 1 on.")


def _demand_card(deck, path):
    """KeyError when a path leads into a card that the deck lacks: it would become a new one, which nothing uses, and all runs the same."""
    group, _, rest = path.partition(".")
    card = rest.partition(".")[0]
    cards = dict(deck.get(group) or {})
    if group == "materials":  # a set of the library that a block names
        cards.update({block.get("material"): None for block in (deck.get("blocks") or {}).values()})
    if group in ("materials", "joints", "blocks", "define") and card not in cards:
        raise KeyError(f"study: {path}: the deck has no {group}.{card}; it has {', '.join(map(str, cards)) or 'none'}.")


def _state(path):
    """What changes when a file is replaced or written; None when it is not there."""
    try:
        place = path.stat()
    except FileNotFoundError:
        return None
    return place.st_ino, place.st_size, place.st_mtime_ns


def _refuse_two(deck, path):
    """RuntimeError when another run writes what this deck would write in the folder of the path."""
    outputs = [path.name, *(str(deck[name]) for name in ("history.file", "output.results", "checkpoint.file") if deck.get(name))]
    for lock in dict.fromkeys((path.parent / name).with_suffix(".lock") for name in outputs):
        if is_held(lock):
            owner = lock.read_text(encoding="utf-8", errors="replace").split("\n")[0]
            raise RuntimeError(f"{lock}: another run writes here ({owner}). Nothing was changed: wait for it, or give another folder.")


def run(deck, folder=None, ranks=1, threads=1, restart=False, options=(), wait=True):
    """Runs a deck (a Deck or its path) and returns the Run, opened when it has ended.

    folder: where the run writes; default: the folder of the deck. A Deck with changes needs one. Into another folder the deck goes as
        <name>.yaml, with the whole path of its mesh. What is printed goes to <name>.log there.
    restart: True: from the newest checkpoint; or the path of one.
    options: more of the command line, such as ["--max-wall", "3600"].
    wait: False: returns at once, with a Run that has `process` and `wait()`; coplane.watch follows it.
    Raises ValueError for numbers of ranks and threads that are none, RunFailed when the exit code is not 0, and RuntimeError when another run writes there.
    """
    _demand_number("ranks", ranks)
    _demand_number("threads", threads)
    deck = deck if isinstance(deck, Deck) else Deck.read(deck)
    if deck.path is None:
        raise ValueError("the deck has no path: write it to the folder in which it runs, with Deck.write, so that outputs have its name.")
    folder = pathlib.Path(folder or deck.folder).resolve()
    path = folder / deck.path.with_suffix(".yaml").name
    _refuse_two(deck, path)
    if path == deck.path.resolve():
        if documents.parse(deck.text) != documents.load(path):
            raise ValueError(f"{path}: the deck has changes that its file has not: write it with Deck.write, or give another folder.")
    else:
        folder.mkdir(parents=True, exist_ok=True)
        path.write_text(deck.text_for(deck.mesh.resolve()), encoding="utf-8")
    arguments = [path.name, "--backend", "threads", "--threads", str(threads), *options]
    if restart:
        arguments += ["--restart"] if restart is True else ["--restart", os.path.abspath(restart)]
    if not restart:
        path.with_suffix(".log").unlink(missing_ok=True)
    before = _state(path.with_suffix(".csv"))
    with open(path.with_suffix(".log"), "a") as log:
        process = subprocess.Popen(program.command(arguments, ranks), cwd=folder, stdout=log, stderr=subprocess.STDOUT)
    started = Started(folder, path.stem, process, before, bool(restart))
    return started.wait() if wait else started


def is_new(run):
    """Whether the history is of the program that runs now, not what an earlier one has left."""
    if isinstance(run, Started):
        return run.has_begun
    history, lock = _state(run.path(".csv")), _state(run.path(".lock"))
    return not history or not lock or history[-1] >= lock[-1]


def watch(run, every=1.0):
    """Iterates over the lines of the history of a run as they are written, each a dict of numbers by name of column, from the first one to
    the last one of the run. When another start replaces the history, its lines follow from the first one. Looks again after `every` seconds.
    """
    run = run if isinstance(run, Run) else Run(run)
    tail = tables.Tail(run.path(".csv"))
    while True:
        ended = not run.is_running  # asked first: all that it has written is read then
        if ended and not isinstance(run, Started) or is_new(run):
            yield from tail.lines()
        if ended:
            return
        time.sleep(every)


def _last(run):
    """What a study has of each run by default: the last line of the history."""
    return {name: values[-1] for name, values in run.columns.items()}


def _measured(measure, run):
    """What `measure` gives of a run, and in `error` why it could not."""
    try:
        return {**measure(run), "error": ""}
    except Exception as error:  # of the caller's function: anything; the other runs are not lost for it
        return {"error": f"measure: {type(error).__name__}: {error}"}


def study(deck, values, folder=None, measure=_last, ranks=1, threads=1):
    """Runs a deck with every combination of some values and returns a DataFrame with a line for each: the values, what `measure(run)` gives
    (a dict; default: the last line of the history), how the run ended and its folder.

    values: lists by path of the deck, `{"define.v": [50, 70], "joints.mortar.friction": [0.4, 0.6]}`.
    folder: runs are made in folders 000, 001, ... in it; default: <name of the deck>-study beside the deck. A combination that fails has
        its exit code in the column `code`, the reason in `error`, and no measures; so has one whose measure fails. The others are run all the same.
    Raises KeyError when a path leads into a joint, material or block that the deck has not: nothing would use it.
    """
    pandas = needs("pandas", "The table of a study")
    deck = deck if isinstance(deck, Deck) else Deck.read(deck)
    if deck.path is None:
        raise ValueError("study: the deck has no path: name it, coplane.Deck(document, \"wall.yaml\"), so that outputs have its name.")
    folder = pathlib.Path(folder or deck.folder / f"{deck.path.stem}-study")
    for path, choices in values.items():
        if isinstance(choices, (str, bytes, dict)) or not hasattr(choices, "__iter__"):
            raise ValueError(f"study: {path}: {choices!r} is no list of values; write [{choices!r}] for one.")
        _demand_card(deck, path)
    values = {path: documents.plain(list(choices)) for path, choices in values.items()}
    lines = []
    for number, combination in enumerate(itertools.product(*values.values())):
        line = dict(zip(values, combination))
        changed = deck.copy()
        for path, value in line.items():
            changed[path] = value
        place = folder / f"{number:03}"
        try:
            ended = run(changed, place, ranks, threads)
            line.update(_measured(measure, ended), code=0, ending=ended.ending)
        except RunFailed as error:
            line.update(code=error.code, ending=error.run.ending, error=next(iter(error.run.errors), "no ERROR line in the log"))
        lines.append({**line, "folder": str(place)})
    return pandas.DataFrame(lines)
