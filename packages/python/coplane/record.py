"""Records of earthquakes: read, corrected, filtered, integrated, and put into a deck as the velocity of its base or as a wave from below.

    from coplane import record
    ground = record.read("station.AT2").scaled(peak=3.0).corrected()
    ground.shake(deck, "base", axis="x")
"""

import pathlib
import re
import warnings

import numpy

from .needs import needs

G = 9.80665  # standard gravity [m/s^2]
UNITS = {"m/s^2": 1.0, "m/s2": 1.0, "m/s/s": 1.0, "g": G, "cm/s^2": 0.01, "cm/s2": 0.01, "cm/s/s": 0.01, "gal": 0.01, "mm/s^2": 1e-3}
TIMES = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0}
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?$")


class Record:
    """Acceleration of the ground, linear between its points. Methods give new records; the old one stays.

    times: [s], ascending, from 0; shape (n,).
    acceleration: [m/s^2]; shape (n,).
    done: what has been done to it since it was measured, one text for each step, with numbers.
    """

    def __init__(self, times, acceleration, done=()):
        self.times = numpy.asarray(times, float)
        self.acceleration = numpy.asarray(acceleration, float)
        self.done = list(done)
        if self.times.ndim != 1 or self.times.shape != self.acceleration.shape or len(self.times) < 2:
            raise ValueError(f"a record needs as many times as accelerations, two or more; there are {self.times.shape} and {self.acceleration.shape}.")
        if not (numpy.isfinite(self.times).all() and numpy.isfinite(self.acceleration).all()):
            raise ValueError("a record has values that are not finite.")
        if not (numpy.diff(self.times) > 0).all():
            raise ValueError(f"times of a record have to ascend; that after {self.times[numpy.argmin(numpy.diff(self.times))]} s does not.")

    def __str__(self):
        return "\n".join(self.done + [
            f"{len(self.times)} points in {self.times[-1] - self.times[0]:.6g} s; largest acceleration {self.peak:.6g} m/s^2, "
            f"velocity {abs(self.velocity).max():.6g} m/s, displacement {abs(self.displacement).max():.6g} m; "
            f"at the end {self.velocity[-1]:.6g} m/s and {self.displacement[-1]:.6g} m"
        ])  # fmt: skip

    @property
    def peak(self):
        """Largest size of the acceleration [m/s^2]."""
        return abs(self.acceleration).max()

    @property
    def velocity(self):
        """From rest, at the times [m/s]: exact, as the acceleration is linear between them."""
        h, a = numpy.diff(self.times), self.acceleration
        return numpy.concatenate([[0], numpy.cumsum(h * (a[:-1] + a[1:]) / 2)])

    @property
    def displacement(self):
        """From rest, at the times [m]: exact."""
        h, a = numpy.diff(self.times), self.acceleration
        return numpy.concatenate([[0], numpy.cumsum(h * self.velocity[:-1] + h**2 * (2 * a[:-1] + a[1:]) / 6)])

    def _then(self, acceleration, what):
        return Record(self.times, acceleration, [*self.done, what])

    def scaled(self, factor=None, peak=None):
        """Times a factor, or so that the largest acceleration is `peak` [m/s^2]."""
        if (factor is None) == (peak is None):
            raise ValueError("scaled: give a factor, or the peak.")
        if peak is not None and not self.peak > 0:
            raise ValueError("scaled: the record is zero.")
        factor = factor if factor is not None else peak / self.peak
        return self._then(factor * self.acceleration, f"scaled by {factor:.6g}")

    def cut(self, start, end):
        """From start to end [s]; times begin with 0 again. Ends between two points get the value there."""
        if not self.times[0] <= start < end <= self.times[-1]:
            raise ValueError(f"cut: {start} to {end} s is not within the record, {self.times[0]} to {self.times[-1]} s.")
        times = numpy.unique(numpy.concatenate([[start], self.times[(self.times > start) & (self.times < end)], [end]]))
        return Record(times - start, numpy.interp(times, self.times, self.acceleration), [*self.done, f"cut to {start:g} to {end:g} s"])

    def detrended(self, degree=0):
        """Less the polynomial of the time that fits the acceleration best (least squares over the points): degree 0 is the mean."""
        middle, half = (self.times[0] + self.times[-1]) / 2, (self.times[-1] - self.times[0]) / 2
        s = (self.times - middle) / half
        trend = numpy.polynomial.polynomial.polyval(s, numpy.polynomial.polynomial.polyfit(s, self.acceleration, degree))
        return self._then(self.acceleration - trend, f"polynomial of degree {degree} taken out: {abs(trend).max():.6g} m/s^2 at most")

    def corrected(self):
        """Baseline correction: less c0 + c1 t, so that velocity and displacement are zero at the end."""
        t = self.times - self.times[0]
        v, u, end = self.velocity[-1], self.displacement[-1], t[-1]
        # c0 T + c1 T^2/2 = v, c0 T^2/2 + c1 T^3/6 = u
        c1 = 6 / end**2 * (v - 2 * u / end)
        c0 = v / end - c1 * end / 2
        line = c0 + c1 * t
        return self._then(self.acceleration - line, f"baseline {c0:.6g} {c1:+.6g} t m/s^2 taken out, at most {abs(line).max() / self.peak:.3g} of the "
                          f"peak: the end was at {v:.6g} m/s and {u:.6g} m, and is at rest at 0")  # fmt: skip

    def filtered(self, low=None, high=None, order=4):
        """What lies between two frequencies [Hz], one of which may be left out: amplitudes times

            1 / sqrt(1 + (low/f)^(2 order)) / sqrt(1 + (f/high)^(2 order)),

        those of Butterworth, without a shift of phase. That takes a little from before a shock, also from before the start: zeros are put
        before and behind the record for 1.5 order/low (Converse and Brady 1992), or order/high, filtered with it, and cut off
        again. What was in them is told; correct the baseline after this.
        """
        if low is None and high is None:
            raise ValueError("filtered: give low, high or both [Hz].")
        h = self.times[1] - self.times[0]
        if abs(numpy.diff(self.times) - h).max() > 1e-3 * h:
            raise ValueError("filtered: the times of the record are not evenly spaced; interpolate it, as with resampled(step).")
        nyquist = 0.5 / h
        if not (0 if low is None else low) < (nyquist if high is None else high) <= nyquist or (low is not None and not low > 0):
            raise ValueError(f"filtered: low = {low} and high = {high} Hz; accepted: 0 < low < high <= {nyquist:g} Hz, half of the sampling rate.")
        pad = int(numpy.ceil((1.5 * order / low if low else order / high) / h))
        padded = numpy.concatenate([numpy.zeros(pad), self.acceleration, numpy.zeros(pad)])
        f = numpy.fft.rfftfreq(len(padded), h)
        gain = numpy.ones(len(f))
        if low is not None:
            with numpy.errstate(divide="ignore"):
                gain /= numpy.sqrt(1 + (low / f) ** (2 * order))
        if high is not None:
            gain /= numpy.sqrt(1 + (f / high) ** (2 * order))
        passed = numpy.fft.irfft(gain * numpy.fft.rfft(padded), len(padded))
        kept = passed[pad : pad + len(self.times)]
        lost = max(abs(passed[:pad]).max(initial=0), abs(passed[pad + len(self.times) :]).max(initial=0))
        band = " and ".join(f"{side} {limit:g} Hz" for side, limit in (("above", low), ("below", high)) if limit is not None)
        return self._then(kept, f"filtered to what is {band} (Butterworth, order {order}, zero phase): peak {self.peak:.6g} -> {abs(kept).max():.6g} m/s^2, "
                          f"up to {lost:.3g} m/s^2 cut off before and after")  # fmt: skip

    def resampled(self, step):
        """At even steps [s], linear between the points."""
        times = numpy.arange(self.times[0], self.times[-1] + 1e-9 * step, step)
        return Record(times, numpy.interp(times, self.times, self.acceleration), [*self.done, f"resampled to {step:g} s"])

    def velocity_table(self, start=0.0):
        """The velocity as a table of a deck, {"times": [...], "values": [...]} in s and m/s; the record begins at `start`.

        The program is linear between the points of a table: the acceleration there is the mean of that of both ends. A record that ends with
        more than a hundredth of its largest velocity brings a warning: the ground would go on with it.
        """
        velocity = self.velocity
        if abs(velocity[-1]) > 0.01 * abs(velocity).max():
            warnings.warn(f"the ground goes on with {velocity[-1]:.3g} m/s after the record, whose largest velocity is {abs(velocity).max():.3g} m/s; "
                          "corrected() brings it to rest.", stacklevel=2)  # fmt: skip
        times = self.times - self.times[0] + start
        return {"times": times.tolist(), "values": velocity.tolist()}

    def shake(self, deck, node_set, axis="x", start=0.0):
        """Adds a condition to a Deck: the nodes of a set move with the velocity of the record along an axis, from `start` [s] on, and
        rest before that. Other axes are left alone: hold them, or give them records of their own.
        """
        if axis not in ("x", "y", "z"):
            raise ValueError(f"shake: axis = {axis!r}; accepted: x, y or z.")
        value = self._vector(axis, start)
        _add(deck, {"type": "velocity", "node_set": node_set, "components": [axis], "value": value})

    def enter(self, deck, side_set, axis="x", start=0.0, of="outcrop"):
        """Adds an absorbing side to a Deck, through which the record comes in as a wave, from `start` [s] on.

        of: "outcrop": the record is the motion of a free surface of the ground below, twice the wave that comes up; "wave": it is that wave.
        """
        if axis not in ("x", "y", "z"):
            raise ValueError(f"enter: axis = {axis!r}; accepted: x, y or z.")
        if of not in ("outcrop", "wave"):
            raise ValueError(f"enter: of = {of!r}; accepted: outcrop or wave.")
        wave = self.scaled(0.5) if of == "outcrop" else self
        _add(deck, {"type": "absorbing", "side_set": side_set, "incident": wave._vector(axis, start)})

    def _vector(self, axis, start):
        """Velocity along an axis, as a value of a deck."""
        table = {key: _in_one_line(values) for key, values in self.velocity_table(start).items()}
        return [table if axis == one else 0 for one in "xyz"]


def _add(deck, condition):
    there = deck.get("conditions")
    if there:
        deck[f"conditions.{len(there)}"] = condition
    else:
        deck["conditions"] = [condition]


def _in_one_line(values):
    """A list that a deck writes in brackets."""
    row = needs("ruamel.yaml", "Writing a record to a deck").comments.CommentedSeq(values)
    row.fa.set_flow_style()
    return row


def _unit(text, where):
    """Size of a unit of acceleration in m/s^2."""
    size = UNITS.get(text.strip().lower())
    if size is None:
        raise ValueError(f"{where}: unit '{text}' is not known; accepted: {', '.join(UNITS)}.")
    return size


def _value(text):
    return float(text.replace("d", "e").replace("D", "e"))


def _read_at2(path, lines):
    """Format of the PEER ground motion databases: three lines of text, NPTS and DT, values one after the other."""
    head = " ".join(lines[:3]).upper()
    if "ACCELERATION" not in head:
        raise ValueError(f"{path}: the header does not say ACCELERATION; files of velocity (VT2) and displacement (DT2) are not read.")
    units = re.search(r"UNITS OF\s+([^\s,;]+?)\.?(?:[\s,;]|$)", head)
    if not units:
        raise ValueError(f"{path}: the first three lines do not say UNITS OF ...; accepted: UNITS OF G, or of {', '.join(UNITS)}.")
    size = _unit(units.group(1), f"{path}:{1 + ['UNITS OF' in line.upper() for line in lines[:3]].index(True)}")
    line = lines[3].upper()
    number = r"(\d*\.?\d+(?:E[+-]?\d+)?)"
    found = re.search(rf"NPTS\s*=\s*(\d+).*?DT\s*=\s*{number}", line) or re.match(rf"\s*(\d+)\s+{number}", line)
    if not found:
        raise ValueError(f"{path}:4: no NPTS and DT in '{lines[3].strip()}'; accepted: NPTS= 4000, DT= .0050 SEC, or 4000 .0050.")
    count, step = int(found.group(1)), float(found.group(2))
    values = [_value(word) for line in lines[4:] for word in line.split()]
    if len(values) != count:
        raise ValueError(f"{path}: the header says NPTS = {count}, but there are {len(values)} values.")
    return Record(numpy.arange(count) * step, size * numpy.array(values), [f"{path.name}: {count} points at {step:g} s, in units of {units.group(1).lower()}"])


def _split(line):
    for separator in ",;\t":
        if separator in line:
            return [word.strip().strip('"') for word in line.split(separator)]
    return line.split()


def _rows(path, lines, ragged):
    """Names (texts before the numbers; None without) and rows of numbers of a table of text, all of one length unless `ragged`."""
    names, rows = None, []
    for number, line in enumerate(lines, 1):
        words = _split(line.split("#")[0].strip())
        if not words or words == [""]:
            continue
        if all(_NUMBER.match(word) for word in words):
            if rows and len(words) != len(rows[0]) and not ragged:
                raise ValueError(f"{path}:{number}: {len(words)} numbers where the lines before have {len(rows[0])}.")
            rows.append([_value(word) for word in words])
        elif rows:
            raise ValueError(f"{path}:{number}: '{line.strip()}' is no line of numbers.")
        else:
            names = words
    if not rows:
        raise ValueError(f"{path}: there are no numbers.")
    return (names if names and len(names) == len(rows[0]) else None), rows


def _find(path, column, names, count):
    """Position of the column that is meant."""
    if column is None:
        if count > 2:
            raise ValueError(f"{path}: there are {count} columns{': ' + ', '.join(names) if names else ''}; name the one that holds the acceleration: column=...")
        return count - 1
    if isinstance(column, int):
        if not 0 <= column < count:
            raise ValueError(f"{path}: column {column} is not there; accepted: 0 to {count - 1}.")
        return column
    known = {re.sub(r"\s*[\[(].*", "", name): place for place, name in enumerate(names or [])}
    known.update((name, place) for place, name in enumerate(names or []))
    if column not in known:
        raise ValueError(f"{path}: no column '{column}'; the header has {', '.join(names) if names else 'no names'}.")
    return known[column]


def _seconds(name, path):
    """Of the unit in the header of a column of times; without one they are seconds."""
    bracket = re.search(r"[\[(]([^\])]*)[\])]", name)
    unit = bracket.group(1).strip().lower() if bracket else "s"
    if unit not in TIMES:
        raise ValueError(f"{path}: the header of the times says {name}; accepted units: {', '.join(TIMES)}.")
    return TIMES[unit]


def _read_table(path, lines, unit, step, column):
    one_after_the_other = step is not None and column is None
    names, rows = _rows(path, lines, ragged=one_after_the_other)
    if one_after_the_other:
        values, times, name = numpy.concatenate(rows), None, names[0] if names and len(rows[0]) == 1 else None
    else:
        numbers = numpy.array(rows)
        place = _find(path, column, names, numbers.shape[1])
        if step is None and place == 0:
            raise ValueError(f"{path}: the first column is the acceleration, so there are no times; give the time between its values: step=0.01.")
        seconds = _seconds(names[0], path) if names and step is None else 1.0
        values, times, name = numbers[:, place], seconds * (numbers[:, 0] - numbers[0, 0]), names[place] if names else None
    bracket = re.search(r"[\[(]([^\])]*)[\])]", name or "")
    if bracket:
        if unit is not None and _unit(unit, path) != _unit(bracket.group(1), path):
            raise ValueError(f"{path}: unit = '{unit}', but the header says {name}.")
        unit = bracket.group(1)
    if unit is None:
        raise ValueError(f"{path}: give the unit of the acceleration: unit='g', 'm/s^2', 'cm/s^2' or 'gal'.")
    if step is not None:
        times = numpy.arange(len(values)) * float(step)
    return Record(times, _unit(unit, path) * values, [f"{path.name}{f', {name}' if name else ''}: {len(times)} points, in units of {unit}"])


def read(path, unit=None, step=None, column=None):
    """The Record of a file.

    PEER (.AT2): units, number and step are those of its header.
    Anything else is a table of text or CSV, with commas, semicolons, tabs or blanks between columns, `#` before comments: the first column is
    the time [s] and the second the acceleration, or `column` (name, or number from 0). With `step` [s] there are no times: the values of the
    column, or, without `column`, all numbers of the file, row by row, stand `step` apart.
    unit: of the acceleration: g, m/s^2, cm/s^2, gal or mm/s^2; a header such as "a[g]" gives it, too; times with "t[ms]" (s, ms, us, min) become seconds.
    Raises ValueError where a file, with its line, is not as it has to be.
    """
    path = pathlib.Path(path)
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    if path.suffix.lower() == ".at2":
        given = [name for name, value in (("unit", unit), ("step", step), ("column", column)) if value is not None]
        if given:
            raise ValueError(f"{path}: the header of an AT2 file says all; leave out {', '.join(given)}.")
        if len(lines) < 5:
            raise ValueError(f"{path}: an AT2 file has four lines before its values.")
        return _read_at2(path, lines)
    return _read_table(path, lines, unit, step, column)
