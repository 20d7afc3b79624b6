"""`coplane watch`: a run in the terminal, from the files that it writes, while it goes on or when it has ended."""

import argparse
import collections
import datetime
import os
import pathlib
import shutil
import socket
import sys
import textwrap
import time
import unicodedata

import numpy

from . import documents, tables
from .balances import MOST, in_play, momentum_in_play
from .results import IsMesh, NoRun, Run, SeveralRuns
from .running import is_new

CURVES = ["kinetic", "internal", "plastic", "contact_stored", "contact_friction", "external_work", "hourglass", "viscous", "eroded", "chemical"]
COUNTS = ["planes", "open", "stick", "slip", "pairs", "searches", "missed", "too_deep", "released", "eroded_elements"]
# Columns that every history has and that are shown.
NEEDED = {"time", "cycle", "dt", "kinetic", "internal", "external_work", "contact_stored", "initial", "error", "contact_remainder", "hourglass", *COUNTS,
          *(f"{name}_{axis}" for name in ("momentum", "momentum_error") for axis in "xyz")}  # fmt: skip
BLOCKS, LETTERS = "▁▂▃▄▅▆▇█", "_.-~=+*#"  # where the terminal shows UTF-8, and where not
COLORS = {"bold": "1", "good": "32", "look": "31", "note": "33"}
ENDINGS = {"completed": "good", "running": "bold", "starting": "bold", "interrupted": "note", "interrupted after a checkpoint": "note"}


def duration(seconds):
    """42 s, 3 min 20 s, 5 h 12 min"""
    s = round(seconds)
    return f"{s} s" if s < 60 else f"{s // 60} min {s % 60} s" if s < 3600 else f"{s // 3600} h {s % 3600 // 60} min"


def clean(text):
    """Without what terminals take for orders; names and logs may hold anything."""
    return "".join(letter if letter.isprintable() else " " for letter in str(text))


def cut(text, width):
    """The text on one line of this many columns; wide letters take two."""
    used = 0
    for place, letter in enumerate(text):
        used += 2 if unicodedata.east_asian_width(letter) in "WF" else 0 if unicodedata.combining(letter) else 1
        if used > width:
            return text[:place]
    return text


def small_curve(x, y, width, letters):
    """One line of letters for values y at growing x: the last value of each stretch, between the least and the largest, zero among them."""
    low, high = min(y.min(), 0), max(y.max(), 0)
    levels = numpy.zeros(len(y), int) if high == low or not numpy.isfinite([low, high]).all() else \
        numpy.rint((numpy.nan_to_num(y) - low) / (high - low) * (len(letters) - 1)).astype(int)
    ends = x[0] + (x[-1] - x[0]) * numpy.arange(1, width + 1) / width
    ends[-1] = x[-1]
    return "".join(letters[levels[place]] for place in numpy.searchsorted(x, ends, side="right") - 1)


class Pace:
    """How fast a run goes on, from what was seen of it in the last minute."""

    def __init__(self):
        self.seen = collections.deque()

    def add(self, now, time, cycle):
        """now: clock of the wall [s]. What lies before a new start is forgotten."""
        if self.seen and time < self.seen[-1][1]:
            self.seen.clear()
        self.seen.append((now, time, cycle))
        while now - self.seen[0][0] > 60:
            self.seen.popleft()

    def per_second(self):
        """Simulated seconds and cycles per second of the wall; zeros while that is not known."""
        (then, time, cycle), (now, last_time, last_cycle) = self.seen[0], self.seen[-1]
        return ((last_time - time) / (now - then), (last_cycle - cycle) / (now - then)) if now - then > 2 else (0.0, 0.0)


class View:
    """What is shown of a run at one moment: `lines`, pairs of text and style; `ending`."""

    def __init__(self, run, pace, width, letters, whole=False):
        """whole: sentences stay on one line, however long."""
        self.run, self.pace, self.width, self.letters, self.whole, self.lines = run, pace, width, letters, whole, []
        has_history = run.path(".csv").exists()
        self.ending = run.ending if not run.is_running else "running" if has_history and is_new(run) else "starting"
        goes_on = self.ending in ("running", "starting")
        self.record = run.record if not goes_on or run.record.get("ending") == "running" and self.ending == "running" else {}
        self.h = tables.sampled(run.path(".csv")) if has_history and self.ending != "starting" else {}
        self.head()
        if NEEDED <= self.h.keys():
            self.progress()
            self.step()
            self.energies()
            self.balances()
            self.counts()
        elif self.ending != "starting":
            self.say(f"there is no history {run.path('.csv').name}, it has no line yet, or is none of coplane")
        self.messages()
        self.last()

    def add(self, text, style=None):
        self.lines.append((cut(clean(text), self.width), style))

    def say(self, text, style=None, indent="", most=None):
        """A sentence on as many lines as it needs, or at most so many."""
        if self.whole:
            self.lines.append((indent + clean(text), style))
            return
        for line in textwrap.wrap(clean(text), self.width, initial_indent=indent, subsequent_indent=indent + "  ")[:most]:
            self.add(line, style)

    def wrap(self, text, style=None):
        """Of the program, whose sentences may be of any length."""
        self.say(text, style, "  ", 4)

    def head(self):
        record = self.record
        self.add(f"{self.run.name}: {record['title']}" if record.get("title") else self.run.name, "bold")
        self.add(f"{self.ending}   {self.run.folder.resolve() / self.run.name}", ENDINGS.get(self.ending, "look"))
        if self.ending == "starting":
            self.say("the program reads deck and mesh, or finds contacts; it has written nothing yet")
        if record:
            hosts = dict.fromkeys(place.get("host") for place in record.get("placement", []))
            self.add(f"{record.get('ranks')} ranks x {record.get('threads_per_rank')} threads on {', '.join(map(str, hosts))}, "
                     f"{record.get('sizes', {}).get('elements')} elements, started {str(record.get('started'))[:19]}")  # fmt: skip

    @property
    def end(self):
        """time.end [s], or 0 where neither record nor deck say it."""
        given = self.record.get("end_s") or ((documents.parse(self.run.deck_text) or {}).get("time") or {}).get("end")
        return float(given) if isinstance(given, (int, float)) else 0.0

    def elapsed(self):
        """Of the clock of the wall, of the last part [s]; None where the record does not say it."""
        if "wall_seconds" in self.record:
            return self.record["wall_seconds"]
        try:
            started = datetime.datetime.strptime(self.record["started"], "%Y-%m-%dT%H:%M:%S%z")
        except (KeyError, ValueError):
            return None
        return (datetime.datetime.now().astimezone() - started).total_seconds()

    def left(self, now, end):
        """Seconds of the wall until the end: by what was seen, else by the record, else by all that was done; None where nothing tells it."""
        speed = self.pace.per_second()[0]
        if speed > 0:
            return (end - now) / speed
        if "seconds_left" in self.record:
            return self.record["seconds_left"]
        elapsed = self.elapsed()
        return (end - now) / now * elapsed if elapsed and now > 0 and len(self.run.records) == 1 else None

    def progress(self):
        now, cycle, end, elapsed = self.h["time"][-1], int(self.h["cycle"][-1]), self.end, self.elapsed()
        is_running = self.ending == "running"
        if is_running:
            self.pace.add(time.monotonic(), now, cycle)
        rate = self.pace.per_second()[1] if is_running else 0
        left = self.left(now, end) if is_running and end > now else None
        if end > 0:
            size = max(4, min(40, self.width - 12))
            done = max(0, min(size, int(size * now / end + 1e-9)))
            self.add(f"[{'#' * done}{'-' * (size - done)}] {100 * now / end:.1f} %")
        self.add(f"t = {now:.6g}{f' of {end:.6g}' if end > 0 else ''} s, cycle {cycle}{f', {rate:.3g} cycles/s' if rate else ''}")
        parts = [f"{duration(elapsed)} elapsed"] if elapsed is not None else []
        parts += [f"about {duration(left)} left"] if left is not None else []
        if parts:
            self.add(", ".join(parts))

    def curve(self, name, value, y):
        """A line: name, last value, and how it came to be."""
        text = f"{name:<18} {value:>9} "
        room = min(60, self.width - len(text))
        self.add(text + (small_curve(self.h["time"], y, room, self.letters) if room >= 8 else ""))

    def step(self):
        self.curve("step [s]", f"{self.h['dt'][-1]:.3g}", self.h["dt"])
        if limits := self.record.get("step_limits"):
            self.wrap(f"limited by {limits[-1]['limited_by']}")

    def energies(self):
        least = 1e-9 * in_play(self.h)  # what is less is rounding
        there = [name for name in CURVES if name in self.h and abs(self.h[name]).max() > least]
        self.add("energies [J]", "bold")
        for name in there:
            self.curve("  " + name.replace("_", " "), f"{self.h[name][-1]:.3g}", self.h[name])

    def balances(self):
        scale = in_play(self.h)
        parts = {"balance error": ("error", self.h["error"][-1] / scale), "contact remainder": ("contact_remainder", self.h["contact_remainder"][-1] / scale),
                 "hourglass": ("hourglass", self.h["hourglass"][-1] / scale),
                 "momentum": ("momentum_error", max(abs(self.h[f"momentum_error_{axis}"][-1]) for axis in "xyz") / momentum_in_play(self.h))}  # fmt: skip
        self.add("balances, over what is in play", "bold")
        for name, (key, value) in parts.items():
            good = abs(value) <= MOST[key]
            self.add(f"  {name:<17} {value:>10.1e}{'' if good else f'  above {MOST[key]:g}: look at it'}", "good" if good else "look")

    def counts(self):
        last = {name: int(self.h[name][-1]) for name in COUNTS}
        self.add("planes {planes}: {open} open, {stick} stick, {slip} slip; {pairs} slots; {searches} searches".format(**last))
        self.add("missed {missed}, too deep {too_deep}, released {released}".format(**last)
                 + (f", eroded {last['eroded_elements']} elements" if last["eroded_elements"] else ""), "look" if last["missed"] or last["too_deep"] else None)

    def messages(self):
        told = self.record.get("messages", []) + ([] if self.ending in ("running", "starting", "completed") else self.run.errors)
        told = list(dict.fromkeys(told))
        if told:
            self.add(f"warnings and errors, the last of {len(told)}" if len(told) > 4 else "warnings and errors", "bold")
        for text in told[-4:]:
            self.wrap(" ".join(text.split()), "note" if text.startswith("WARNING") else "look")
        for kind, count in self.record.get("warnings", {}).items():
            if count > 3:
                self.wrap(f"{kind}: {count} warnings in all", "note")

    def last(self):
        if self.ending in ("running", "starting"):
            return
        code = self.run.exit_code
        text = f"{self.ending}, exit code {code}" if code is not None else self.ending
        if self.ending == "killed":
            host = next((place.get("host") for place in self.record.get("placement", [])), None)
            text = "killed: the record says running, but no program writes the run, and it left no exit code"
            if host and host != socket.gethostname():
                text += f" (or it runs on {host}, whose locks this machine does not see)"
        self.say(text, ENDINGS.get(self.ending, "look"))
        if self.ending == "killed":
            newest = self.run.newest_checkpoint
            self.say(f"its command with --restart goes on from the newest checkpoint, {newest.name}" if newest else
                     "it left no checkpoint to go on from with --restart (checkpoint.every_seconds in the deck writes some)")


class Screen:
    """Shows views on the standard output: on a terminal one in the place of the other, in colour unless NO_COLOR is set."""

    def __init__(self):
        self.is_terminal = sys.stdout.isatty() and os.environ.get("TERM", "dumb") != "dumb"
        self.colored = self.is_terminal and not os.environ.get("NO_COLOR")
        self.shown, self.size = 0, None
        encoding = (sys.stdout.encoding or "ascii").lower().replace("-", "")
        self.letters = BLOCKS if encoding == "utf8" else LETTERS
        sys.stdout.reconfigure(errors="replace")

    @property
    def width(self):
        return max(20, shutil.get_terminal_size().columns - 1)

    def show(self, lines, is_last):
        """is_last: nothing will be shown in its place, so it may be longer than the screen."""
        size = shutil.get_terminal_size()
        begin = ""
        if self.is_terminal:
            lines = lines if is_last or len(lines) < size.lines else lines[: max(1, size.lines - 2)] + lines[-1:]
            if self.shown:
                begin = f"\033[{self.shown}A\033[J" if size == self.size else "\033[H\033[2J"
        text = "".join(f"\033[{COLORS[style]}m{line}\033[0m\n" if self.colored and style else line + "\n" for line, style in lines)
        print(begin + text, end="", flush=True)
        self.shown, self.size = len(lines), size


def opened(path, log):
    """The run as it is now."""
    run = Run(path)
    if log:
        run.log_path = pathlib.Path(log)
    return run


def wait_for(path, log, new, every):
    """The run, as soon as it is there; new: as soon as one goes on. What hinders is said once."""
    said = None
    while True:
        try:
            run = opened(path, log)
            if not new or run.is_running:
                return run
            why = f"{run.folder / run.name}: {run.ending}; waiting for a new start"
        except (SeveralRuns, IsMesh):
            raise
        except NoRun as error:
            why = f"{error} Waiting for it."
        if why != said:
            print(clean(why), file=sys.stderr, flush=True)
            said = why
        time.sleep(every)


def watch(options):
    """Shows the run until it ends; returns the exit code: that of the run, 1 when it was killed."""
    screen, pace = Screen(), Pace()
    once = options.once or not sys.stdout.isatty()
    if options.wait or not once:
        wait_for(options.run, options.log, options.wait, options.every)
    before = None
    while True:
        view = View(opened(options.run, options.log), pace, screen.width, screen.letters, whole=not sys.stdout.isatty())
        goes_on = view.ending in ("running", "starting")
        if once or screen.is_terminal or not goes_on:
            screen.show(view.lines, not goes_on)
        elif (short := [text for text, _ in view.lines if text.startswith(("[", "t =", "starting"))]) != before:
            print("  ".join(short), flush=True)  # a terminal that cannot go back
            before = short
        if not goes_on:
            return view.run.exit_code if view.run.exit_code is not None else 1 if view.ending in ("killed", "failed") else 0
        if once:
            return 0
        time.sleep(options.every)


def main():
    parser = argparse.ArgumentParser(prog="coplane watch", description="Shows a run in the terminal until it ends: progress, step, energies, balances, contact, warnings.")
    parser.add_argument("run", help="the run: its name with its folder (out/wall), its folder, or one of its files")
    parser.add_argument("--once", action="store_true", help="one view, then stop; so it is where the output is no terminal")
    parser.add_argument("--wait", action="store_true", help="wait for a start from now on, whatever an earlier run has left")
    parser.add_argument("--log", metavar="FILE", help="what the program printed, for errors that the record does not have; default: <name>.log beside the files of the run")
    parser.add_argument("--every", type=float, default=1.0, metavar="SECONDS", help="between two views; default: 1")
    options = parser.parse_args()
    if not options.every > 0:
        parser.error("argument --every: a number of seconds above 0 is accepted")
    if options.wait and options.once:
        parser.error("--once shows what is there now, and --wait waits for a start: one of them is accepted")
    try:
        sys.exit(watch(options))
    except KeyboardInterrupt:
        sys.exit(130)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        sys.exit(141)
    except (OSError, ValueError) as error:
        print(f"ERROR: {error}", file=sys.stderr)
        sys.exit(2)
