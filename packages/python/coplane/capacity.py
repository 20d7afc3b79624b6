"""What a structure carries: factors of safety by strength reduction, load multipliers, and curves of load over displacement.

    from coplane import capacity
    collapse = capacity.Moves("block", limit=1e-3, since=1.0)
    found = capacity.factor_of_safety(deck, collapse, joints=["plane"])
    print(found)          # factor of safety 1.09 to 1.1; collapse: ...
"""

import dataclasses
import difflib
import math
import pathlib
import re

import numpy

from .needs import needs
from .running import RunFailed, run

# Strength is c + friction times pressure in all laws that have these keys: divided by F, it is 1/F of what it was.
STRENGTHS = ("friction", "dynamic_friction", "cohesion", "residual_cohesion", "frictions", "cohesions", "joint_friction", "joint_cohesion")
# Bounded by a friction that falls.
_DILATIONS = {"dilation": ("friction", "dynamic_friction", "frictions"), "joint_dilation": ("joint_friction",)}


def _listed(name, names):
    """The names that there are, and the one that is meant, perhaps."""
    near = difflib.get_close_matches(name, names, 1, 0.5)
    return f"{', '.join(names) or 'none'}.{f' Did you mean {near[0]}?' if near else ''}"


@dataclasses.dataclass
class Moves:
    """Criterion of collapse: a probe of the history is displaced by more than `limit` [m] after the time `since` [s].

    probe: name in history.probes of the deck, on what will fall; or several names: one of them is enough.
    limit: far above what it moves when it holds, far below what it moves in the rest of the run when it falls. A body that is driven by a
        share e of its weight moves by e g T^2/2 in the time T that is left after `since`, so a factor is found to about 2 limit / (g T^2).
    since: when loads are up and the first motion has been damped; 0: the whole run counts.
    """

    probe: str | list
    limit: float
    since: float = 0.0

    def __str__(self):
        return f"{' or '.join(self.probes)} moves by more than {self.limit:g} m after t = {self.since:g} s"

    @property
    def probes(self):
        return [self.probe] if isinstance(self.probe, str) else list(self.probe)

    def demand(self, deck):
        """Raises KeyError or ValueError, before anything is run, where a run of the deck has no such probe or ends before `since`."""
        probes, rigid = deck.get("history.probes") or [], [str(name) for name in deck.get("history.rigid") or []]
        if "*" in rigid:
            rigid = [str(name) for name in deck.get("blocks") or {}]
        lines = [str(probe.get("name")) for probe in probes if "between" in probe]
        names = [*(str(probe.get("name")) for probe in probes if "between" not in probe), *(f"{line}_1" for line in lines), *rigid]
        for name in self.probes:
            numbered = re.fullmatch(r"(.*)_[1-9][0-9]*", name)  # of the points of a line, of the bodies of a block
            if name not in names and not (numbered and numbered[1] in lines + rigid):
                raise KeyError(f"the deck has no probe '{name}' in history.probes; it has {_listed(name, names)} Name one of them, or add one on what will fall.")
        end = deck.get("time.end")
        end = (deck.get("define") or {}).get(end, end)
        if isinstance(end, (int, float)) and self.since >= end:
            raise ValueError(f"since = {self.since:g} s is not before the end of the run, time.end = {end:g} s. Give an earlier since, or a later time.end.")

    def paths(self, ended):
        """Time [s] after `since` and displacement from there [m], of each probe; of the columns that the run has written."""
        columns = ended.columns
        times = columns["time"]
        late = times >= self.since
        if not late.any():
            raise ValueError(f"the run ends at {times[-1]:g} s, before since = {self.since:g} s.")
        found = {}
        for name in self.probes:
            if f"{name}_displacement_x" not in columns:
                raise KeyError(f"the history has no probe '{name}'; it has {', '.join(ended.probe_names) or 'none'}. history.probes in the deck names them.")
            place = numpy.stack([columns[f"{name}_displacement_{axis}"][late] for axis in "xyz"])
            found[name] = numpy.linalg.norm(place - place[:, :1], axis=0)
        return times[late], found

    def largest(self, ended):
        """Largest displacement after `since` [m]."""
        return float(max(path.max() for path in self.paths(ended)[1].values()))

    def collapsed(self, ended):
        return self.largest(ended) > self.limit


@dataclasses.dataclass
class Bracket:
    """Where collapse begins: it holds at `low` and collapses at `high`.

    trials: dicts, in the order of the runs: factor, collapsed, displacement [m], code, folder.
    criterion: the Moves that decided.
    """

    low: float
    high: float
    trials: list
    criterion: Moves
    what: str = "factor"

    @property
    def value(self):
        """The middle."""
        return (self.low + self.high) / 2

    @property
    def table(self):
        """The trials as a DataFrame."""
        return needs("pandas", "The table of the trials").DataFrame(self.trials)

    def __str__(self):
        return f"{self.what} {self.low:.5g} to {self.high:.5g}, from {len(self.trials)} runs; collapse: {self.criterion}"


def _trial(deck, criterion, folder, ranks, threads):
    """Whether it collapses, how far it moved, and the exit code. A run that fails has collapsed if it had moved by more than the limit
    before; else the failure is none of the structure, and RunFailed goes on."""
    try:
        ended, code = run(deck, folder, ranks, threads), 0
    except RunFailed as error:
        ended, code = error.run, error.code
        if "time" not in _columns(ended) or ended.columns["time"][-1] < criterion.since or not criterion.collapsed(ended):
            raise
    return criterion.collapsed(ended), criterion.largest(ended), code


def _columns(ended):
    try:
        return ended.columns
    except (OSError, ValueError):  # it wrote no history
        return {}


def bracket(deck_of, criterion, low, high, tolerance=0.01, folder=None, ranks=1, threads=1, what="factor"):
    """The Bracket of the factor at which `deck_of(factor)`, a Deck, begins to collapse, to `tolerance` of it, by halving.

    low, high: where to begin; while it collapses at `low` or holds at `high`, that end goes out by a factor of 1.5, six times at most.
    folder: runs are made in folders 000, 001, ... in it; default: <name of the deck>-capacity beside the deck.
    It has to hold below the factor and collapse above it. Raises ValueError when the ends do not enclose one.
    """
    if not 0 < low < high:
        raise ValueError(f"low = {low}, high = {high}; accepted: 0 < low < high.")
    first = deck_of(low)
    criterion.demand(first)
    folder = pathlib.Path(folder or first.folder / f"{first.path.stem}-capacity")
    trials = []

    def collapses(factor):
        place = folder / f"{len(trials):03}"
        collapsed, moved, code = _trial(deck_of(factor), criterion, place, ranks, threads)
        trials.append({"factor": factor, "collapsed": collapsed, "displacement": moved, "code": code, "folder": str(place)})
        return collapsed

    lowest, highest = low / 1.5**6, high * 1.5**6
    if collapses(low):
        while True:
            high, low = low, low / 1.5
            if low < lowest * (1 - 1e-9):
                raise ValueError(f"{what}: it collapses at {high:.5g} already. Collapse: {criterion}; last trial: {trials[-1]}")
            if not collapses(low):
                break
    else:
        while not collapses(high):
            low, high = high, 1.5 * high
            if high > highest * (1 + 1e-9):
                raise ValueError(f"{what}: it still holds at {low:.5g}. Collapse: {criterion}; last trial: {trials[-1]}")
    while high - low > tolerance * low:
        middle = math.sqrt(low * high)
        if collapses(middle):
            high = middle
        else:
            low = middle
    return Bracket(low, high, trials, criterion, what)


def _over(value, factor):
    """A number, a list of numbers or an expression of names, divided by the factor."""
    if isinstance(value, list):
        return [_over(entry, factor) for entry in value]
    return f"({value})/{factor!r}" if isinstance(value, str) else value / factor


def weakened(deck, factor, joints=(), materials=()):
    """A copy of a deck with the strengths of these cards divided by a factor: friction, which is the tangent of the angle, and cohesion; in
    materials also their tables, and those of ubiquitous joints. Dilation is at most the friction that is left. Stiffnesses, and
    tensile strengths, which cohesion over friction bounds, stay. Strengths that stages set are divided, too; dilation is bounded by the least
    friction of all stages. Cards from the library (`set`, or a name alone) are refused: their strengths do not stand in the deck.
    """
    changed = deck.copy()
    cards = [f"joints.{name}" for name in joints] + [f"materials.{name}" for name in materials]
    if not cards:
        raise ValueError("there is no strength to divide: name the joint cards or the materials that are to be weakened: joints=['plane'].")
    for group, given in (("joints", joints), ("materials", materials)):
        there = [str(name) for name in changed.get(group) or {}]
        for name in given:
            if name not in there:
                raise KeyError(f"{group}.{name}: the deck has no such card; its {group} are {_listed(name, there)}")
    for card in cards:
        _written_out(changed[card], card)
        keys = [key for key in STRENGTHS if changed[card].get(key)]
        later = [entry for entry in _set_by_stages(changed, card) if entry[2] in STRENGTHS and entry[0][entry[1]]]
        if not keys and not later:
            raise ValueError(f"{card} ({changed[card].get('model')}) has no strength that can be divided: none of {', '.join(STRENGTHS)}.")
        for key in keys:
            changed[f"{card}.{key}"] = _over(changed[f"{card}.{key}"], factor)
        for values, key, _ in later:
            values[key] = _over(values[key], factor)
        for dilation, frictions in _DILATIONS.items():
            if changed[card].get(dilation) is not None:
                changed[f"{card}.{dilation}"] = _least(changed, card, changed[card][dilation], frictions)
            for values, key, name in _set_by_stages(changed, card):
                if name == dilation and values[key] is not None:
                    values[key] = _least(changed, card, values[key], frictions)
    return changed


def _written_out(card, name):
    """Raises ValueError for a card whose values stand in the library."""
    if isinstance(card, str) or "set" in card:
        taken = card if isinstance(card, str) else card["set"]
        raise ValueError(
            f"{name}: its values come from the library ('{taken}'), and are not in the deck to be divided. Write the model and its strengths on the card."
        )


def _set_by_stages(deck, card):
    """What stages set on a card: (mapping, its key, key of the card) of each value."""
    group, name = card.split(".", 1)
    found = []
    for number, stage in enumerate(deck.get("stages") or []):
        settings = stage.get("set") or {}
        for path, value in settings.items():
            if path.startswith(f"{card}."):
                found.append((settings, path, path[len(card) + 1 :].split(".")[0]))
            whole = value if path == card else value.get(name) if path == group and isinstance(value, dict) else None
            if whole is not None:
                _written_out(whole, f"stages.{number}.set.{card}")
                found += [(whole, key, key) for key in whole]
    return found


def _least(deck, card, dilation, frictions):
    """The dilation, or the least friction of the card, at the start or set by a stage, where that is less."""
    values = [dilation]
    for value in [deck[card].get(key) for key in frictions] + [at[key] for at, key, name in _set_by_stages(deck, card) if name in frictions]:
        if value is not None:
            values += value if isinstance(value, list) else [value]
    if any(isinstance(value, str) for value in values):
        return f"min({', '.join(map(str, values))})"
    return min(values)


def factor_of_safety(deck, criterion, joints=(), materials=(), low=1.0, high=2.0, tolerance=0.01, folder=None, ranks=1, threads=1):
    """The Bracket of the factor by which the strengths of these cards can be divided until the structure collapses (strength reduction)."""
    return bracket(lambda factor: weakened(deck, factor, joints, materials), criterion, low, high, tolerance, folder, ranks, threads, "factor of safety")


def load_multiplier(deck, criterion, name="multiplier", low=0.1, high=1.0, tolerance=0.01, folder=None, ranks=1, threads=1):
    """The Bracket of the number at which the structure collapses when it is given to `define.<name>` of the deck: the deck uses it
    in what is to grow, such as `gravity: ["9.81*multiplier*min(t, 1)", -9.81]`."""
    if f"define.{name}" not in deck:
        raise ValueError(f"the deck has no define.{name}; give it one, and use it in the loads.")

    def deck_of(value):
        changed = deck.copy()
        changed[f"define.{name}"] = value
        return changed

    return bracket(deck_of, criterion, low, high, tolerance, folder, ranks, threads, f"multiplier '{name}'")


def tilted(deck, rate, down=None, towards=(1, 0, 0), start=0.0):
    """A copy of a deck on a table that tilts: its gravity, whose size stays, turns from `down` towards another direction by `rate` [degrees/s]
    from `start` [s] on. The angle at the time t is rate (t - start). down: by default the direction of the deck's gravity.
    """
    try:
        gravity = [float(value) for value in deck["gravity"]]
    except (TypeError, ValueError):
        raise ValueError(f"gravity: {deck['gravity']} is not a list of numbers. Give its final components as numbers, such as [0, -9.81, 0].") from None
    gravity += [0.0] * (3 - len(gravity))
    size = math.sqrt(sum(value**2 for value in gravity))
    if size == 0:
        raise ValueError("gravity: it is zero, and has no direction. Give its components, such as [0, -9.81, 0].")
    for number, stage in enumerate(deck.get("stages") or []):
        for path in stage.get("set") or {}:
            if path.split(".")[0] == "gravity":
                raise ValueError(f"stages.{number}.set.{path}: it would undo the tilt. Take it out, and give gravity to the deck.")
    down = gravity if down is None else down
    down, towards = (numpy.array(v, float) / numpy.linalg.norm(v) for v in (down, towards))
    if abs(numpy.dot(down, towards)) > 1e-9:
        raise ValueError(f"down {down.tolist()} and towards {towards.tolist()} are not at right angles; give towards=(x, y, z).")
    angle = f"({math.radians(rate)!r}*max(0, t - {start!r}))"
    changed = deck.copy()
    changed["gravity"] = [f"{size * d!r}*cos{angle} + {size * s!r}*sin{angle}" if d or s else 0.0 for d, s in zip(down.tolist(), towards.tolist())]
    return changed


@dataclasses.dataclass
class Curve:
    """A load over the displacement of a control probe, from one run in which the load grows.

    displacement: [m]; load: in its own unit; times: [s]; shape (n,) each, up to collapse.
    limit: the displacement that counts as collapse [m].
    """

    times: numpy.ndarray
    displacement: numpy.ndarray
    load: numpy.ndarray
    limit: float
    collapsed: bool

    @property
    def capacity(self):
        """Load that is largest in size before the control probe had moved by `limit`, with its sign."""
        return float(self.load[numpy.argmax(abs(self.load))])

    @property
    def table(self):
        """As a DataFrame."""
        return needs("pandas", "The table of a curve").DataFrame({"time": self.times, "displacement": self.displacement, "load": self.load})

    def __str__(self):
        end = f"collapse: displaced by more than {self.limit:g} m at t = {self.times[-1]:.5g} s" if self.collapsed else \
            f"no collapse: displaced by {self.displacement.max():.4g} m of {self.limit:g} m"  # fmt: skip
        return f"largest load {self.capacity:.5g}; {end}"


def curve(ended, probe, load, limit, since=0.0):
    """The Curve of a run that has ended.

    probe: name in history.probes: its displacement from its place at `since` [s].
    load: function of the times (array, s) for a load that the deck prescribes, or the name of a column of the history, such as
        "base_reaction_x" where a displacement is prescribed.
    limit: displacement that counts as collapse [m]. While a load grows at a rate r, a body that begins to move at its capacity reaches `limit`
        a little later: about (6 limit / (g r))^(1/3) for a multiplier of its weight. Slower loads come nearer to the static capacity.
    """
    times, paths = Moves(probe, limit, since).paths(ended)
    displacement = paths[probe]
    values = numpy.asarray(load(times) if callable(load) else ended.columns[load][ended.columns["time"] >= since], float)
    beyond = numpy.nonzero(displacement > limit)[0]
    end = int(beyond[0]) + 1 if len(beyond) else len(times)
    return Curve(times[:end], displacement[:end], values[:end], limit, bool(len(beyond)))
