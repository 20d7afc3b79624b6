"""Runs decks: one, while it goes on, and many with other values."""

import itertools
import os
import pathlib
import subprocess
import time

from . import program, tables
from .deck import Deck
from .needs import needs
from .results import Run


class RunFailed(program.ProgramFailed):
    """A run that ended with another exit code than 0: `code` (docs/user/exit-codes.md), `run`."""

    def __init__(self, code, run):
        said = "\n".join(run.log.splitlines()[-15:])
        super().__init__(f"coplane ended with exit code {code}; {run.path('.log')} ends with\n{said}")
        self.code, self.run = code, run


class Started(Run):
    """A run that this program has started; `process` is the program."""

    def __init__(self, folder, name, process):
        self.folder, self.name, self.process = folder, name, process

    @property
    def is_running(self):
        return self.process.poll() is None

    def wait(self):
        """Until it has ended; RunFailed when that was not well. Returns the run as it is then."""
        code = self.process.wait()
        if code:
            raise RunFailed(code, self)
        return Run(self.path(".yaml"))


def run(deck, folder=None, ranks=1, threads=1, restart=False, options=(), wait=True):
    """Runs a deck (a Deck or its path) and returns the Run, opened when it has ended.

    folder: where the run writes; default: the folder of the deck. A Deck with changes needs one. Into another folder the deck goes as
        <name>.yaml, with the whole path of its mesh. What is printed goes to <name>.log there.
    restart: True: from the newest checkpoint; or the path of one.
    options: more of the command line, such as ["--max-wall", "3600"].
    wait: False: returns at once, with a Run that has `process` and `wait()`; coplane.watch follows it.
    Raises RunFailed when the exit code is not 0.
    """
    deck = deck if isinstance(deck, Deck) else Deck.read(deck)
    if deck.path is None:
        raise ValueError("the deck has no path: write it to the folder in which it runs, with Deck.write, so that outputs have its name.")
    folder = pathlib.Path(folder or deck.folder).resolve()
    path = folder / deck.path.with_suffix(".yaml").name
    if path == deck.path.resolve():
        if deck.text != Deck.read(path).text:
            raise ValueError(f"{path}: the deck has changes that its file has not: write it with Deck.write, or give another folder.")
    else:
        folder.mkdir(parents=True, exist_ok=True)
        moved = deck.copy()
        moved["mesh"] = str(deck.mesh.resolve())
        moved.write(path)
    arguments = [path.name, "--backend", "threads", "--threads", str(threads), *options]
    if restart:
        arguments += ["--restart"] if restart is True else ["--restart", os.path.abspath(restart)]
    with open(path.with_suffix(".log"), "a" if restart else "w") as log:
        process = subprocess.Popen(program.command(arguments, ranks), cwd=folder, stdout=log, stderr=subprocess.STDOUT)
    started = Started(folder, path.stem, process)
    return started.wait() if wait else started


def watch(run, every=1.0):
    """Iterates over the lines of the history of a run as they are written, each a dict of numbers by name of column, from the first one to
    the last one of the run. Looks again after `every` seconds.
    """
    run = run if isinstance(run, Run) else Run(run)
    tail = tables.Tail(run.path(".csv"))
    while True:
        ended = not run.is_running  # asked first: all that it has written is read then
        yield from tail.lines()
        if ended:
            return
        time.sleep(every)


def _last(run):
    """What a study has of each run by default: the last line of the history."""
    return {name: values[-1] for name, values in run.columns.items()}


def study(deck, values, folder=None, measure=_last, ranks=1, threads=1):
    """Runs a deck with every combination of some values and returns a DataFrame with a line for each: the values, what `measure(run)` gives
    (a dict; default: the last line of the history), how the run ended and its folder.

    values: lists by path of the deck, `{"define.v": [50, 70], "joints.mortar.friction": [0.4, 0.6]}`.
    folder: runs are made in folders 000, 001, ... in it; default: <name of the deck>-study beside the deck. A combination that fails has
        its exit code in the column `code`, and no measures; the others are run all the same.
    """
    pandas = needs("pandas", "The table of a study")
    deck = deck if isinstance(deck, Deck) else Deck.read(deck)
    folder = pathlib.Path(folder or deck.folder / f"{deck.path.stem}-study")
    lines = []
    for number, combination in enumerate(itertools.product(*values.values())):
        line = dict(zip(values, combination))
        changed = deck.copy()
        for path, value in line.items():
            changed[path] = value
        place = folder / f"{number:03}"
        try:
            ended = run(changed, place, ranks, threads)
            line.update({**measure(ended), "code": 0, "ending": ended.ending})
        except RunFailed as error:
            line.update(code=error.code, ending=error.run.ending)
        lines.append({**line, "folder": str(place)})
    return pandas.DataFrame(lines)
