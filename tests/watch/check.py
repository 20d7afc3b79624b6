"""`coplane watch` on runs that go on, have ended, failed, or were killed, on terminals and none (README.md)."""

import fcntl
import os
import pathlib
import pty
import re
import shutil
import signal
import struct
import subprocess
import sys
import termios
import threading
import time

import numpy

from coplanetest import Case, documents, program

import coplane
from coplane import report, tables, view

case = Case("watch", __file__)
STARTED = []  # what must not go on when a check fails


def once(*arguments, environment=()):
    """Exit code, output and errors of a view that goes into a pipe."""
    done = subprocess.run([program.binary("coplane"), "watch", *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          env={**os.environ, "PYTHONIOENCODING": "utf-8", **dict(environment)}, timeout=60)  # fmt: skip
    return done.returncode, done.stdout, done.stderr


def says(what, text, *words):
    case.check_equal(f"{what}: missing", [word for word in words if word not in text], [])


class Terminal:
    """`coplane watch` on a pseudo terminal."""

    def __init__(self, *arguments, columns=100, **environment):
        ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 50, columns, 0, 0))
        self.text = ""
        environment = dict(os.environ, PYTHONIOENCODING="utf-8", **environment)
        for name in ("NO_COLOR", "COLUMNS", "LINES"):
            if name not in environment or not environment[name]:
                environment.pop(name, None)
        self.process = subprocess.Popen([program.binary("coplane"), "watch", "--every", "0.1", *map(str, arguments)], stdin=theirs, stdout=theirs, stderr=theirs,
                                        env=environment, start_new_session=True)  # fmt: skip
        os.close(theirs)
        self.reader = threading.Thread(target=self.read, args=[ours], daemon=True)
        self.reader.start()

    def read(self, ours):
        try:
            while data := os.read(ours, 65536):
                self.text += data.decode("utf-8", "replace")
        except OSError:  # the other end is closed
            pass

    def until(self, *words):
        begin = time.monotonic()
        while not all(word in self.text for word in words):
            if time.monotonic() - begin > 60:
                for process in STARTED:
                    process.kill()
                sys.exit(f"waited for {words}; there is {self.text[-3000:]}")
            time.sleep(0.05)

    def ended(self):
        code = self.process.wait(60)
        self.reader.join(10)
        return code

    def widest(self):
        """The longest line of the views."""
        lines = [re.sub(r"\x1b\[[0-9;]*[A-Za-z]", "", line) for line in re.split(r"[\r\n]+", self.text)]
        return max(len(line) for line in lines if "Waiting" not in line)


deck = case.load("exodus_inputs/bars_2d/bars.yaml")
deck["output"] = {"every": 1, "planes": False}
deck["history"]["every"] = 1e-5
deck["mesh"] = str(pathlib.Path("mesh.e").absolute())
recipe = case.load("exodus_inputs/bars_2d/mesh.yaml")
documents.save(recipe, "mesh.yaml")
coplane.make_mesh("mesh.yaml", "mesh.e")


def prepared(folder, **changes):
    """A folder with the deck, and nothing of an earlier test."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    changed = coplane.Deck(deck)
    for path, value in changes.items():
        changed[path.replace("__", ".")] = value
    changed.write(f"{folder}/bars.yaml")
    return changed


# --- a run that has ended ------------------------------------------------------------------------------

ODD = "an odd földer {} '板"
prepared(ODD)
run = coplane.run(f"{ODD}/bars.yaml")
code, shown, _ = once(f"{ODD}/bars")
last = run.history.iloc[-1]
case.check_equal("completed: exit code", (code, run.exit_code), (0, 0))
says("completed", shown, "bars: impact of two equal bars", "completed, exit code 0", "100.0 %", f"cycle {int(last.cycle)}", f"{last.kinetic:.3g}", f"{last.internal:.3g}",
     f"planes {int(last.planes)}: {int(last.open)} open", f"{int(last.searches)} searches", "missed 0", "limited by element ", "1 ranks x 1 threads", "1200 elements")  # fmt: skip
case.check_equal("completed: no orders to terminals in a pipe", "\x1b" in shown, False)
case.check_equal("completed: the same by the folder, and with --once", [once(*place)[1] == shown for place in ([ODD], ["--once", f"{ODD}/bars.csv"])], [True, True])
def widest(shown):
    """Of the lines that are no sentences of a log, which are whole where there is no terminal."""
    return max(len(line) for line in shown.splitlines() if not line.startswith(("  limited by ", "  WARNING")))


case.check_within("a line", widest(shown), 70, 79)
case.check_within("a line of 40 columns", widest(once(ODD, environment={"COLUMNS": "40"})[1]), 30, 39)
ascii_only = once(ODD, environment={"PYTHONIOENCODING": "ascii"})[1]
case.check_equal("a terminal without UTF-8", (ascii_only.isascii(), "#####" in ascii_only), (True, True))
history = pathlib.Path(ODD, "bars.csv")
whole = history.read_text()
history.write_text("time[s],other\n0,1\n")
says("a history of something else", once(ODD)[1], "none of coplane", "completed, exit code 0")
history.write_text(whole)
seen = Terminal(ODD, TERM="xterm")
case.check_equal("on a terminal: exit code", seen.ended(), 0)
says("on a terminal", seen.text, "\x1b[32mcompleted, exit code 0\x1b[0m")
quiet = Terminal(ODD, TERM="xterm", NO_COLOR="1", columns=40)
quiet.ended()
case.check_equal("NO_COLOR", "\x1b[3" in quiet.text, False)
case.check_within("40 columns", quiet.widest(), 30, 39)

# --- by hand: nobody keeps what the program prints -------------------------------------------------------

for folder, command in (("plain", ["bars.yaml"]), ("quiet", ["bars.yaml", "--quiet"])):
    prepared(folder, materials__elastic__density=8e6)
    done = subprocess.run(program.command(command, ranks=1 + (folder == "quiet")), cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    case.check_equal(f"{folder}: exit code, no log", (done.returncode, pathlib.Path(folder, "bars.log").exists()), (0, False))
    says(folder, once(folder)[1], "limited by contact at node", "warnings and errors", "WARNING: values that are accepted", "density")
    of_run = coplane.open(folder)
    case.check_equal(f"{folder}: in Python", (list(of_run.warnings), of_run.errors, all("node" in limit for limit in of_run.limits)),
                     (["unusual values"], [], True))  # fmt: skip
    report.make(folder, pictures=False)
    page = pathlib.Path(folder, "bars-report.html").read_text()
    case.check_equal(f"{folder}: the report has its warning, and what limited the step", ["WARNING: values that" in page, "<td>contact at node" in page], [True, True])

# --- what is no run ----------------------------------------------------------------------------------------

for name in ("mesh.e", "mesh.yaml", "mesh"):
    code, _, said = once(name)
    case.check_equal(f"{name}: refused", (code, "mesh.e is a mesh" in said), (2, True))
seen = Terminal("mesh.e", TERM="xterm")
case.check_equal("a mesh is not waited for", (seen.ended(), "mesh.e is a mesh" in seen.text), (2, True))
code, _, said = once("--wait", "--once", ODD)
case.check_equal("--wait and --once", (code, "one of them" in said), (2, True))

# --- a run that begins later, goes on, and is stopped ----------------------------------------------------

changed = prepared("going", time__end=10.0)
case.check_equal("no run yet, one view", [once("--once", "going/bars")[0], "no run of this name" in once("going/bars")[2]], [2, True])
waiting = Terminal("going/bars", TERM="xterm")
dumb = Terminal("going/bars", "--wait", TERM="dumb")
waiting.until("Waiting for it.")
dumb.until("Waiting for it.")
started = coplane.run("going/bars.yaml", wait=False)
STARTED.append(started.process)
waiting.until("cycles/s", "left", " %", "kinetic")
dumb.until(" of 10 s, cycle")
code, shown, _ = once("going")
case.check_equal("going on: exit code of one view", code, 0)
says("going on", shown, "running   /", "of 10 s", "elapsed")
begin = time.monotonic()
while "seconds_left" not in coplane.open("going/bars").record and time.monotonic() - begin < 60:
    time.sleep(0.1)
says("going on, after the first line of progress", once("going")[1], "about ", " left", "limited by")
started.process.send_signal(signal.SIGTERM)
case.check_equal("stopped: exit codes of the run and of its views", (started.process.wait(), waiting.ended(), dumb.ended()), (7, 7, 7))
says("stopped", waiting.text, "interrupted, exit code 7", "\x1b[J", "\x1b[33m")
case.check_equal("a dumb terminal", "\x1b" in dumb.text, False)
case.check_equal("views in place of each other", waiting.text.count("A\x1b[J") > 3, True)
case.check_within("their width", waiting.widest(), 80, 99)

# --- one that starts where an earlier one has left its files ---------------------------------------------

lock = pathlib.Path("going/bars.lock")
with open(lock, "w") as file:
    fcntl.flock(file, fcntl.LOCK_EX)
    now = time.time()
    os.utime(lock, (now + 1, now + 1))
    code, shown, _ = once("going/bars", "--wait")
case.check_equal("starting: exit code", code, 0)
says("starting", shown, "starting   /", "reads deck and mesh")
case.check_equal("starting: nothing of the earlier run", [word for word in ("kinetic", "cycle", "exit code") if word in shown], [])

# --- killed and failed -----------------------------------------------------------------------------------

prepared("killed", time__end=10.0)
started = coplane.run("killed/bars.yaml", wait=False)
STARTED.append(started.process)
watching = Terminal("killed/bars", TERM="xterm")
watching.until("kinetic")
started.process.kill()
started.process.wait()
code, shown, _ = once("killed")
case.check_equal("killed: exit codes", (watching.ended(), code), (1, 1))
KILLED = "killed: the record says running, but no program writes the run, and it left no exit code"
says("killed", shown, KILLED + "\n", "it left no checkpoint to go on from with --restart")
pathlib.Path("killed/bars.chk.1").touch()
narrow = Terminal("killed", TERM="xterm", NO_COLOR="1", columns=40)
narrow.ended()
says("killed, on a terminal of 40 columns", " ".join(narrow.text.split()), KILLED, "with --restart goes on from the newest checkpoint, bars.chk.1")
case.check_within("killed: 40 columns", narrow.widest(), 30, 39)
prepared("failed", initial__0__velocity=[20000, 0, 0])
try:
    coplane.run("failed/bars.yaml")
except coplane.RunFailed as failure:
    case.check_equal("failed: exit codes", (failure.code, failure.run.exit_code, once("failed")[0]), (6, 6, 6))
says("failed", once("failed")[1], "failed, exit code 6", "warnings and errors", "ERROR: ")
pathlib.Path("failed/bars.log").unlink()
says("failed, without a log", once("failed")[1], "failed, exit code 6", "ERROR: cycle ")
pathlib.Path("told.txt").write_text("WARNING: one\nERROR: two \x1b[2J\n")
says("killed, with another log", once("killed", "--log", "told.txt")[1], "ERROR: two  [2J")

# --- parts -----------------------------------------------------------------------------------------------

LINES = 200000
with open("long.csv", "w") as file:
    file.write('time[s],"a ""name""\nof two lines[J]"\n')
    file.writelines(f"{line},{line * line}\n" for line in range(LINES))
    file.write(f"{LINES},1")  # being written
sample = tables.sampled("long.csv", 300)
name = 'a "name"\nof two lines'
case.check_equal("a long history: its ends", (sample["time"][0], sample["time"][-1], sample[name][-1]), (0.0, LINES - 1.0, (LINES - 1.0) ** 2))
case.check_equal("a long history: lines in order, none twice", bool((numpy.diff(sample["time"]) > 0).all()), True)
case.check_within("a long history: lines", len(sample["time"]), 290, 1500)
case.check_within("a long history: largest distance", float(numpy.diff(sample["time"]).max()), 1, 3 * LINES / 300)
for text, count in (("", 0), ("time[s],a", 0), ("time[s],a\n", 0), ("time[s],a\n1,2", 0), ("time[s],a\n1,2\n", 1), ("time[s],a\n1,2\nx,3\n4,5\n6,7", 2)):
    pathlib.Path("short.csv").write_text(text)
    case.check_equal(f"lines of {text!r}", len(tables.sampled("short.csv").get("time", [])), count)
x = numpy.arange(11.0)
for what, y, curve in (("a rise", x, "▂▂▃▄▅▅▆▇▇█"), ("below zero", -x, "▇▇▆▅▅▄▃▂▂▁"), ("a jump", numpy.where(x < 5, -1, 1.0), "▁▁▁▁██████"), ("nothing", 0 * x, "▁" * 10)):
    case.check_equal(f"small curve: {what}", view.small_curve(x, y, 10, view.BLOCKS), curve)
case.check_equal("small curve of one line", view.small_curve(x[:1], x[1:2], 3, view.BLOCKS), "███")
case.check_equal("cut at wide letters", view.cut("板板板", 5), "板板")
case.check_equal("durations", [view.duration(s) for s in (59.4, 61, 3661)], ["59 s", "1 min 1 s", "1 h 1 min"])
case.finish()
