"""`coplane report`: one page of a run, finished or not, or of two runs over each other."""

import argparse
import datetime
import difflib
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy

from . import pictures, tables
from .balances import MOST, in_play, momentum_in_play
from .page import COLORS, MARK, POINTS, Page, bars, curve, escape, number
from .results import NoRun, Run

ENERGIES = ["kinetic", "internal", "contact_stored", "plastic", "external_work", "hourglass", "viscous", "eroded", "mass_damping", "local_damping",
            "kinetic_damping"]  # fmt: skip
CONTACT = ["contact_stored", "contact_friction", "contact_hysteresis", "contact_fracture", "contact_damping", "contact_eroded", "contact_remainder"]
COUNTS = ["pairs", "planes", "open", "stick", "slip"]
TROUBLE = ["missed", "too_deep", "released"]


# Sizes of the record that change during a run, with their columns of the history.
CHANGING = {"candidate_pairs": "pairs", "planes": "planes", "searches": "searches", "cycles": "cycle", "eroded_elements": "eroded_elements",
            "eroded_mass_kg": "eroded_mass"}  # fmt: skip


class Missing(Exception):
    """Something that a section needs is not there; the page says so."""


def has(run, *names):
    """Demands columns of the history."""
    try:
        missing = [name for name in names if name not in run.columns]
    except FileNotFoundError:
        raise Missing(f"There is no history {run.path('.csv').name}.") from None
    except ValueError as error:
        raise Missing(str(error)) from None
    if missing:
        raise Missing(f"The history {run.path('.csv').name} has no column {', '.join(missing)}.")
    if len(run.columns["time"]) == 0:
        raise Missing(f"The history {run.path('.csv').name} has no line yet.")


class Report:
    def __init__(self, runs, pictures=True):
        self.runs, self.pictures, self.damaged = runs, pictures, {}
        for which, run in enumerate(runs):
            try:
                run.records
            except ValueError as error:
                self.damaged[which], run.records = str(error), []
        self.page = Page(f"{runs[0].record.get('title') or runs[0].name}: report")

    # --- parts of sections -------------------------------------------------------------------------

    def curves(self, title, names, unit, label=None, scale=None, optional=False):
        """Columns of the history over time, those of the second run dotted. What is zero throughout is left out; if all are, one of them is drawn, or
        nothing when `optional`. `scale`: of a run, by which values are divided."""
        traces = []
        names = [name for name in names if any(name in run.columns and numpy.any(run.columns[name]) for run in self.runs)] or names[: not optional]
        if not names:
            return ""
        for which, run in enumerate(self.runs):
            for name, color in zip(names, COLORS * 9):
                if name in run.columns:
                    values = run.columns[name] / (scale(run) if scale else 1)
                    shown = (label or (lambda text: text.replace("_", " ")))(name)
                    traces.append(curve(run.columns["time"], values, shown + self.of(which), color, dash=which > 0))
        return self.page.plot(title, traces, unit)

    def of(self, which):
        return "" if len(self.runs) == 1 else f" ({'AB'[which]})"

    def each(self, rows_of):
        """A table of a name and a value of each run; rows_of(run) gives a dict."""
        columns = [rows_of(run) for run in self.runs]
        names = list(dict.fromkeys(name for column in columns for name in column))
        return self.page.table([] if len(self.runs) == 1 else ["", "A", "B"], [[name, *(column.get(name, "–") for column in columns)] for name in names])

    def section(self, title, fill):
        self.page.head(title)
        try:
            fill()
        except Missing as missing:
            self.page.note(str(missing))
        except (OSError, ValueError, KeyError, SyntaxError) as error:  # of files that are damaged: XML, JSON, tables
            self.page.note(f"This part cannot be made: {type(error).__name__}: {error}")

    # --- sections ----------------------------------------------------------------------------------

    def head(self):
        page, run = self.page, self.runs[0]
        page.add(f"<h1>{escape(run.record.get('title') or run.name)}</h1>")
        for which, run in enumerate(self.runs):
            kind = "ok" if run.ending == "completed" else "look"
            page.add(f'<p>{escape("AB"[which] + ": ") if len(self.runs) > 1 else ""}{escape(run.folder.resolve() / run.name)}: '
                     f'<span class="{kind}" data-ending="{escape(run.ending)}">{escape(run.ending)}</span></p>')  # fmt: skip
            if run.ending == "running":
                page.note("The run goes on; this is what it had written when the page was made. Make it again to see more.")
            if which in self.damaged:
                page.note(self.damaged[which])
            if run.errors:
                page.add(f"<pre>{escape(chr(10).join(run.errors[-8:]))}</pre>")
            elif run.ending in ("failed", "killed"):
                page.note(f"The record has no reason, nor has the log {run.path('.log').name}." if run.log else
                          f"The record has no reason, and there is no log {run.path('.log').name}.")
        page.note(f"Made {datetime.datetime.now().astimezone():%Y-%m-%d %H:%M %Z}. Curves have at most {POINTS} points: of longer ones the smallest and "
                  f"largest value of each stretch are drawn. Histories: {', '.join(map(self.length, self.runs))}.")  # fmt: skip
        page.contents()

    @staticmethod
    def length(run):
        try:
            return f"{len(run.columns['time'])} lines"
        except (OSError, ValueError, KeyError):
            return "none"

    @staticmethod
    def sizes(run):
        """Of the record; that of a run that goes on or was killed has those of its start, and what has changed since is in the last line of the history."""
        sizes = run.record.get("sizes", {})
        if run.record.get("ending") != "running":
            return {**sizes, "time [s]": run.record.get("time_s")}
        try:
            last = {name: values[-1] for name, values in run.columns.items() if len(values)}
        except (OSError, ValueError):
            last = {}
        now = {name: last.get(column) for name, column in CHANGING.items() if name in sizes}
        now = {name: value if value is None or name.endswith("_kg") else int(value) for name, value in now.items()}
        return {**sizes, **now, "time [s]": last.get("time")}

    @classmethod
    def what(cls, run):
        record = run.record
        if not record:
            return {"record": f"there is no {run.name}.run.json: what was run is not known"}
        software, deck, mesh = (record.get(name, {}) for name in ("software", "deck", "mesh"))
        places = [f"{place.get('host')}: cores {place.get('cores')}" for place in record.get("placement", [])]
        memory = record.get("peak_memory_bytes", {}).get("sum")
        rows = {
            "deck": deck.get("file"), "deck, SHA-256": deck.get("sha256"), "mesh": mesh.get("file"), "mesh, SHA-256": mesh.get("sha256"),
            "run": record.get("run"), "state hash": record.get("state_hash"),
            "program": f"coplane {software.get('coplane')} ({software.get('revision')}), {software.get('compiler')}, {software.get('flags')}",
            "libraries": f"Trilinos {software.get('trilinos')}, Kokkos {software.get('kokkos')}, {str(software.get('mpi')).split(',')[0]}",
            "command": record.get("command_line"),
            "ranks x threads": f"{record.get('ranks')} x {record.get('threads_per_rank')}, back end {record.get('backend')}",
            "machine": "; ".join(dict.fromkeys(places)), "parts": len(run.records), "restarted from": record.get("restarted_from"),
            "started": record.get("started"), "ended": record.get("ended"), "wall-clock time [s]": record.get("wall_seconds"),
            "memory of all ranks [MB]": round(memory / 1e6) if memory else None,
            **{re.sub("(.*)_kg", r"\1 [kg]", name).replace("_", " "): value for name, value in cls.sizes(run).items()},
        }  # fmt: skip
        return {name: value for name, value in rows.items() if value not in (None, "")}

    @staticmethod
    def balances(run):
        h, scale = run.columns, in_play(run.columns)
        momentum = momentum_in_play(h)

        def marked(value, most):
            return ("ok" if abs(value) <= most else "look", number(value))

        largest = h["contact_remainder"][numpy.argmax(abs(h["contact_remainder"]))]
        return {
            "time reached [s]": float(h["time"][-1]), "cycles": int(h["cycle"][-1]), "energy in play [J]": float(scale),
            "largest error of the energy balance over it": marked(abs(h["error"]).max() / scale, MOST["error"]),
            "largest contact remainder over it": marked(largest / scale, MOST["contact_remainder"]),
            "largest hourglass energy over it": marked(abs(h["hourglass"]).max() / scale, MOST["hourglass"]),
            "largest momentum without impulses over the largest momentum":
                marked(max(abs(h[f"momentum_error_{axis}"]).max() for axis in "xyz") / momentum, MOST["momentum_error"]),
            "contacts missed": marked(int(h["missed"][-1]), 0), "planes too deep, at most": marked(int(h["too_deep"].max()), 0),
            "searches": int(h["searches"][-1]),
        }  # fmt: skip

    def energies(self):
        for run in self.runs:
            has(run, "time", "initial", *ENERGIES[:5], "error", "nodal_error")
        self.page.add(self.each(self.balances))
        self.page.grid(self.curves("Energies", ENERGIES, "J"),
                       self.curves("Error of the balance", ["error", "nodal_error"], "over the energy in play",
                                   scale=lambda run: in_play(run.columns)))  # fmt: skip

    def contact(self):
        for run in self.runs:
            has(run, "time", *CONTACT)
        pairs = [self.remainders(run) for run in self.runs]
        most = {key: max(abs(of[key][1]).max() for of in pairs if key in of) for of in pairs for key in of}
        colors = dict(zip(sorted(most, key=most.get, reverse=True), COLORS))
        traces = [curve(*of[key], "{} – {}, {}".format(*key) + self.of(which), color, dash=which > 0)
                  for which, of in enumerate(pairs) for key, color in colors.items() if key in of]  # fmt: skip
        self.page.grid(self.curves("Energies of contact", CONTACT[:-1], "J"), self.curves("Contact remainder", CONTACT[-1:], "J; positive: lost"),
                       traces and self.page.plot("Remainder by pairs of blocks", traces, "J; positive: lost"))  # fmt: skip
        if len(most) > len(colors):
            self.page.note(f"Of {len(most)} pairs those with the {len(colors)} largest remainders are drawn.")
        if not traces:
            self.page.note("history.tables: [pairs] in the deck gives the remainder by pairs of blocks and joints.")

    @staticmethod
    def remainders(run):
        """Times and remainders by two blocks and a joint."""
        path = run.table_path("pairs")
        if not path:
            return {}
        found = tables.columns(path)
        places = {}
        for place, key in enumerate(zip(*(found[name] for name in ("block_a", "block_b", "joint")))):
            places.setdefault(key, []).append(place)
        return {key: (found["time"][where], found["remainder"][where]) for key, where in places.items()}

    def momenta(self):
        axes = [f"{name}_{axis}" for name in ("momentum", "impulse") for axis in "xyz"]
        for run in self.runs:
            has(run, "time", *axes)
        self.page.grid(self.curves("Momentum and impulse", axes, "N s"),
                       self.curves("Momentum without impulses", [f"momentum_error_{axis}" for axis in "xyz"], "N s", optional=True),
                       self.curves("Angular momentum without impulses", [f"angular_momentum_error_{axis}" for axis in "xyz"], "N m s", optional=True))  # fmt: skip

    def joints(self):
        for run in self.runs:
            has(run, "time")
        names = list(dict.fromkeys(name for run in self.runs for name in run.joint_names))
        if not names:
            raise Missing('The history has no columns of joints; history.joints: ["*"] in the deck gives them.')
        for joint in names:
            def label(text, joint=joint):
                return text[len(joint) + 1 :].replace("_", " ")

            def drawn(title, ends, unit, joint=joint, label=label):
                return self.curves(f"{joint}: {title}", [f"{joint}_{end}" for end in ends], unit, label)

            self.page.grid(drawn("areas", ["open_area", "stick_area", "slip_area"], "m^2"), drawn("closure and slip", ["mean_closure", "largest_slip"], "m"),
                           drawn("normal force", ["normal_force"], "N"), drawn("energies", ["stored", "friction", "hysteresis", "fracture"], "J"))  # fmt: skip

    def step(self):
        for run in self.runs:
            has(run, "time", "dt")
        self.page.grid(self.page.plot("Time step", [
            curve(run.columns["time"][taken], run.columns["dt"][taken], f"time step{self.of(which)}", COLORS[0], dash=which > 0)
            for which, run in enumerate(self.runs) for taken in [run.columns["dt"] > 0]], "s"))  # the line of t = 0 has no step
        for which, run in enumerate(self.runs):
            most = sorted(run.limits.items(), key=lambda item: -item[1])[:10]
            if most:
                self.page.add(self.page.table([f"what limited the step{self.of(which)}", "looks"], most))
            else:
                self.page.note(f"What limited the step{self.of(which)}: there is no record that says it.")
        self.page.note("The program looks at the start, about every five seconds, and at the end.")

    def warnings(self):
        for which, run in enumerate(self.runs):
            if not run.record:
                self.page.note(f"Warnings{self.of(which)}: there is no record that has them.")
            elif not run.messages:
                self.page.note(f"No warnings{self.of(which)}.")
            for text in run.messages:
                self.page.add(f"<pre>{escape(text + self.of(which))}</pre>")
            for kind, count in run.warnings.items():
                if count > 3:
                    self.page.note(f"{kind}{self.of(which)}: {count} warnings in all.")

    def searches(self):
        for run in self.runs:
            has(run, "time", *COUNTS, *TROUBLE, "searches")
        self.page.grid(self.curves("Slots and planes", [*COUNTS, "looked_at"], "count", lambda name: {"pairs": "slots", "looked_at": "slots looked at"}.get(name, name)),
                       self.curves("Searches", ["searches"], "count"), self.curves("Missed, too deep, released", TROUBLE, "count"),
                       self.curves("Eroded elements", ["eroded_elements"], "count", optional=True))  # fmt: skip

    def worst_planes(self):
        for which, run in enumerate(self.runs):
            try:
                series = run.planes
            except FileNotFoundError as error:
                why = str(error) if run.planes_path.exists() else f"{run.planes_path.name} is not there (output.planes, contact)."
                self.page.note(f"There are no planes{self.of(which)}: {why}")
                continue
            if len(series) == 0:
                self.page.note(f"{run.planes_path.name} has no step yet.")
                continue
            fields, names = series.fields(-1), series.joint_names(-1)
            if len(fields["area"]) == 0:
                self.page.note(f"No planes at t = {series.times[-1]:.6g} s{self.of(which)}: nothing touches.")
                continue
            lost = fields["remainder"]
            self.page.note(f"{len(fields['area'])} planes at t = {series.times[-1]:.6g} s{self.of(which)}; the remainders of all sum up to "
                           f"{lost.sum():.6g} J: {lost.clip(min=0).sum():.6g} J lost, {abs(lost.clip(max=0).sum()):.6g} J gained.")  # fmt: skip
            for title, key in (("deepest", fields["closure"]), ("largest remainders", abs(lost)), ("longest slip", fields["slip"])):
                worst = [place for place in numpy.argsort(-key, kind="stable")[:5] if key[place] > 0]
                rows = [[*("{} / {}".format(fields[f"{side}_element"][p], fields[f"{side}_side"][p]) for side in ("lower", "higher")), names[fields["joint"][p]],
                         *(float(fields[name][p]) for name in ("area", "closure", "normal_traction", "slip", "remainder"))] for p in worst]  # fmt: skip
                if rows:
                    self.page.add(f"<h3>{title}</h3>", self.page.table(
                        ["element / side", "against", "joint", "area [m^2]", "closure [m]", "normal traction [Pa]", "slip [m]", "remainder [J]"], rows))

    def fragments(self):
        counts, masses = [], []
        for which, run in enumerate(self.runs):
            if not run.fragments_path.exists():
                self.page.note(f"There is no {run.fragments_path.name}{self.of(which)} (output.fragments).")
                continue
            table = tables.columns(run.fragments_path)
            bodies = table["fragment"] > 0
            times, place = numpy.unique(table["time"], return_inverse=True)
            if len(times) == 0:
                self.page.note(f"{run.fragments_path.name} has no line yet.")
                continue
            counts.append(curve(times, numpy.bincount(place[bodies], minlength=len(times)), "bodies" + self.of(which), COLORS[0], dash=which > 0))
            last = bodies & (table["time"] == times[-1])
            mass = numpy.sort(table["mass"][last])
            if len(mass):
                masses.append(curve(mass, numpy.cumsum(mass) / mass.sum(), f"at {times[-1]:.6g} s" + self.of(which), COLORS[1], dash=which > 0))
            speed = numpy.sqrt(sum(table[f"velocity_{axis}"] ** 2 for axis in "xyz"))
            spin = numpy.sqrt(sum(table[f"spin_{axis}"] ** 2 for axis in "xyz"))
            size = [table[f"high_{axis}"] - table[f"low_{axis}"] for axis in "xyz"]
            heaviest = numpy.flatnonzero(last)[numpy.argsort(-table["mass"][last], kind="stable")[:10]]
            rows = [[int(table["fragment"][i]), int(table["elements"][i]), float(table["mass"][i]), *(float(s[i]) for s in size), float(speed[i]), float(spin[i])]
                    for i in heaviest]
            if rows:
                self.page.add(f"<h3>heaviest{escape(self.of(which))}</h3>", self.page.table(
                    ["fragment", "elements", "mass [kg]", "x [m]", "y [m]", "z [m]", "speed [m/s]", "spin [rad/s]"], rows))
        if counts:
            self.page.grid(self.page.plot("Connected bodies", counts, "count"),
                           *([self.page.plot("Share of the mass in bodies up to a mass", masses, "share", x="mass [kg]")] if masses else []))

    def times(self):
        traces = []
        for which, run in enumerate(self.runs):
            shares = {name.replace("coplane::", ""): seconds for name, seconds in run.record.get("timers_s", {}).items()}
            if not shares:
                self.page.note(f"The record has no times of regions{self.of(which)}: they are written when the run ends.")
                continue
            order = sorted(shares, key=shares.get)[-15:]
            traces.append(bars(order, [shares[name] for name in order], run.name + self.of(which), COLORS[which]))
        if traces:
            self.page.note("Regions may lie in one another: search holds steps 1 to 5.")
            self.page.grid(self.page.plot("Seconds of the slowest rank", traces, "", x="s", tall=True))

    def probes(self):
        for run in self.runs:
            has(run, "time")
        names = list(dict.fromkeys(name for run in self.runs for name in [*run.probe_names, *run.body_names]))
        if not names:
            raise Missing("The history has no probes (history.probes, history.rigid).")
        if any(self.shears(run, names) for run in self.runs):
            self.page.add(self.each(lambda run: self.shears(run, names)))
        self.page.grid(*(self.curves(f"{name}: {what}", [f"{name}_{what}_{axis}" for axis in "xyz"], unit, lambda text: text[-1], optional=what in self.SHEARS)
                         for name in names for what, unit in (("velocity", "m/s"), ("displacement", "m"), *self.SHEARS.items())))  # fmt: skip

    # Columns that only some probes and bodies have, with their units.
    SHEARS = {"drift": "over the distance", "reaction": "N"}

    @classmethod
    def shears(cls, run, names):
        """The value of each drift and reaction that is largest in size, with its time."""
        found = {}
        for name in names:
            for column in [f"{name}_{what}_{axis}" for what in cls.SHEARS for axis in "xyz"]:
                values = run.columns.get(column)
                if values is not None and numpy.any(values):
                    place = numpy.argmax(abs(values))
                    unit = run.units.get(column)
                    found[f"largest {column}" + (f" [{unit}]" if unit else "")] = f"{number(float(values[place]))} at {number(float(run.columns['time'][place]))} s"
        return found

    def images(self):
        for which, run in enumerate(self.runs):
            found, why = pictures_of(run, self.pictures)
            if why:
                self.page.note(why + self.of(which))
            self.page.grid(*(self.page.picture(path.stem + self.of(which), png) for path, png in found))

    def deck(self):
        texts = [run.deck_text for run in self.runs]
        for which, text in enumerate(texts):
            if not text:
                self.page.note(f"Neither the record nor {self.runs[which].path('.yaml').name} has the deck{self.of(which)}.")
        if len(texts) == 2 and all(texts):
            lines = [line for line in difflib.unified_diff(*(text.splitlines() for text in texts), "A", "B", lineterm="", n=1)][2:]
            marks = {"+": "add", "-": "del"}
            self.page.add("<h3>Differences of the decks</h3>", "<pre>" + "\n".join(
                f'<span class="{marks.get(line[0], "")}">{escape(line)}</span>' for line in lines) + "</pre>" if lines else "<p>The decks are the same.</p>")
        for which, text in enumerate(texts):
            if text:
                self.page.add(f"<details><summary>The deck as it was used{self.of(which)}</summary><pre>{escape(text)}</pre></details>")

    def differences(self):
        a, b = self.runs
        for run in self.runs:
            has(run, "time")
        same = a.record.get("state_hash") and a.record.get("state_hash") == b.record.get("state_hash")
        self.page.add(f"<p>State hashes: {'the same: every bit of the last state is equal' if same else 'different, or one is not known'}.</p>")
        shared = [name for name in a.columns if name in b.columns]
        rows = []
        for name in shared:
            x, y = float(a.columns[name][-1]), float(b.columns[name][-1])
            if x != y:
                unit = a.units.get(name)
                rows.append([name + (f" [{unit}]" if unit else ""), x, y, y - x, f"{100 * (y - x) / abs(x):+.3g} %" if 0 < abs(y - x) < 10 * abs(x) else ""])
        if a.columns["time"][-1] != b.columns["time"][-1]:
            self.page.note("The runs ended at different times: final values are not those of one time.")
        self.page.add(f"<p>{len(shared) - len(rows)} of {len(shared)} final values are equal.</p>")
        if rows:
            self.page.add(self.page.table(["final value", "A", "B", "B - A", "of A"], rows))
        alone = sorted(set(a.columns) ^ set(b.columns))
        if alone:
            self.page.note(f"Only one of them has {', '.join(alone)}.")

    @property
    def has_fragments(self):
        return any(run.fragments_path.exists() for run in self.runs)

    def text(self):
        self.head()
        self.section("What was run", lambda: self.page.add(self.each(self.what)))
        self.section("Warnings", self.warnings)
        if len(self.runs) == 2:
            self.section("Differences", self.differences)
        for title, fill in (("Energies and balances", self.energies), ("Contact", self.contact), ("Momenta", self.momenta), ("Joints", self.joints),
                            ("Probes and bodies", self.probes), ("Step", self.step), ("Searches and slots", self.searches),
                            ("Worst planes", self.worst_planes), *([("Fragments", self.fragments)] if self.has_fragments else []), ("Time used", self.times), ("Pictures", self.images), ("Deck", self.deck)):  # fmt: skip
            self.section(title, fill)
        return self.page.text


def pictures_of(run, draw, most=12):
    """PNG files of a run, (path, bytes) each: those that are in its folder, else such as ParaView draws; and why there are none, or not all."""
    there = sorted((run.folder / "pictures").glob("*.png"))
    if there:
        return [(path, path.read_bytes()) for path in there[:most]], f"The first {most} of {len(there)} pictures." if len(there) > most else ""
    if not draw:
        return [], "Pictures were not asked for."
    try:
        with tempfile.TemporaryDirectory() as folder:
            drawn = [(path, path.read_bytes()) for path in pictures.draw(run, folder, color="von_mises", size=(900, 600), timeout=300)]
    except subprocess.TimeoutExpired:
        return [], "No pictures: ParaView took more than 300 s."
    except (OSError, ValueError, pictures.PicturesFailed) as error:
        return [], f"No pictures: {error}."
    return drawn, ""


def write(path, text):
    """Replaces an earlier report; any other file of the name is refused."""
    path = pathlib.Path(path)
    if path.is_file():
        with open(path, errors="replace") as file:
            if MARK not in file.read(200):
                raise FileExistsError(f"{path}: there is a file of this name that is no report of coplane. Nothing was changed; choose another name with -o.")
    draft = path.with_name(f"{path.name}.part-{os.getpid()}")
    try:
        draft.write_text(text, encoding="utf-8", errors="replace")  # names of folders may be no text
        os.replace(draft, path)
    except OSError as error:
        raise OSError(f"{path}: {error.strerror or error}") from None
    finally:
        if os.path.lexists(draft):
            draft.unlink()


def make(run, output=None, compare=None, pictures=True):
    """Writes the report of a run, over another one if `compare` says so, and returns its path (default <name>-report.html in the folder of
    the run). Runs are named as for coplane.open. NoRun when there is no such run, OSError when the file cannot be written.
    """
    runs = [Run(path) for path in ([run] if compare is None else [run, compare])]
    output = pathlib.Path(output or runs[0].path("-report.html"))
    if not output.parent.is_dir():
        raise FileNotFoundError(f"{output}: there is no folder {output.parent}; make it first.")
    write(output, Report(runs, pictures).text())
    return output


def main():
    parser = argparse.ArgumentParser(prog="coplane report", description="Writes one HTML file about a run that has ended, goes on or has failed.")
    parser.add_argument("run", help="the run: its name with its folder (out/wall), its folder, or one of its files (record, history, tables, results, planes, checkpoint, deck, log)")
    parser.add_argument("--compare", metavar="OTHER", help="another run, drawn over it, with the differences of both")
    parser.add_argument("-o", "--output", metavar="FILE", help="default: <name>-report.html beside the files of the run")
    parser.add_argument("--no-pictures", action="store_true", help="do not draw with ParaView; pictures that are there are taken")
    options = parser.parse_args()
    try:
        print(make(options.run, options.output, options.compare, not options.no_pictures))
    except (NoRun, ImportError, ValueError) as error:
        print(f"ERROR: {error}", file=sys.stderr)
        sys.exit(2)
    except OSError as error:
        print(f"ERROR: {error}" if isinstance(error, FileExistsError) else f"ERROR: the report cannot be written: {error}", file=sys.stderr)
        sys.exit(5)
