"""coplane.record: files of several forms, exact integrals, baseline, filter, tables of a deck (README.md)."""

import pathlib
import warnings

import numpy
from coplanetest import Case

from coplane import Deck, record
from coplane.documents import parse
from coplane.record import G, Record

case = Case("records", __file__)


def differs(what, value, reference, tolerance=1e-12):
    case.check(what, float(numpy.max(numpy.abs(numpy.asarray(value) - numpy.asarray(reference)))), 0, tolerance)


def told(what, call, *words):
    """A call raises ValueError, and its text has these words."""
    try:
        call()
        text = "no error"
    except ValueError as error:
        text = str(error)
    case.check_equal(f"{what}: told of", [word for word in words if word not in text], [])


def written(name, text):
    path = pathlib.Path(name)
    path.write_text(text)
    return path


# --- integrals --------------------------------------------------------------------------------------

# Linear between points that are not evenly spaced: a = 2 + 3 t.
t = numpy.sort(numpy.concatenate([[0, 4], numpy.random.default_rng(1).uniform(0, 4, 998)]))
line = Record(t, 2 + 3 * t)
differs("velocity of 2 + 3 t", line.velocity, 2 * t + 1.5 * t**2, 1e-11)
differs("displacement of 2 + 3 t", line.displacement, t**2 + 0.5 * t**3, 1e-11)
# A triangle of 1 s and 1 m/s^2: 0.5 m/s; the ground is 0.25 m on its way at the end.
triangle = Record([0, 0.5, 1], [0, 1, 0])
case.check("velocity after a triangle [m/s]", triangle.velocity[-1], 0.5, 1e-15)
case.check("displacement after a triangle [m]", triangle.displacement[-1], 0.25, 1e-15)

# --- baseline ---------------------------------------------------------------------------------------

# The drift of an instrument on a motion that ends at rest at 0: exactly that drift is taken out.
t = numpy.arange(2001) * 0.005
s = t / t[-1]
rest = (s**2 * (1 - s) ** 2 * (1 - 2 * s) * 40 * numpy.sin(9 * t))
rest = Record(t, rest).corrected().acceleration
drifting = Record(t, rest + 0.03 + 0.01 * t)
fixed = drifting.corrected()
differs("baseline: what is left", fixed.acceleration, rest)
case.check("baseline: velocity at the end [m/s]", fixed.velocity[-1], 0, 1e-12)
case.check("baseline: displacement at the end [m]", fixed.displacement[-1], 0, 1e-12)
case.check_equal("baseline: told", "baseline 0.03 +0.01 t" in fixed.done[-1], True)
differs("polynomial of degree 2", Record(t, 1 - t + 0.2 * t**2).detrended(2).acceleration, 0, 1e-11)
differs("mean", Record(t, 3 + 0 * t).detrended().acceleration, 0)
case.check("scaled to its peak [m/s^2]", drifting.scaled(peak=2.5).peak, 2.5, 1e-14)
differs("scaled", drifting.scaled(0.5).acceleration, 0.5 * drifting.acceleration)
part = Record([0, 1, 2, 3], [0, 2, 0, 1]).cut(0.5, 2.5)
differs("cut: times", part.times, [0, 0.5, 1.5, 2])
differs("cut: values", part.acceleration, [1, 2, 0, 0.5])

# --- filter -----------------------------------------------------------------------------------------

t = numpy.arange(8000) * 0.01
middle = slice(3000, 5000)
for f in (0.1, 0.2, 1.0, 3.0, 6.0):
    sine = numpy.sin(2 * numpy.pi * f * t)
    gain = 1 / numpy.sqrt(1 + (0.2 / f) ** 8) / numpy.sqrt(1 + (f / 3.0) ** 8)
    passed = Record(t, sine).filtered(0.2, 3.0).acceleration
    case.check(f"filter of 0.2 to 3 Hz at {f} Hz: difference from {gain:.4f} times the sine, in phase", numpy.max(numpy.abs(passed - gain * sine)[middle]), 0, 2e-3)
one = Record(t, numpy.sin(2 * numpy.pi * 10 * t) + numpy.sin(2 * numpy.pi * 0.5 * t)).filtered(high=2).acceleration
differs("only above: 10 Hz are gone", (one - numpy.sin(2 * numpy.pi * 0.5 * t))[middle], 0, 4e-3)
case.check_equal("filter: told", "above 0.2 Hz and below 3 Hz" in Record(t, one).filtered(0.2, 3).done[-1], True)
told("filter beyond half of the sampling rate", lambda: Record(t, one).filtered(high=80), "50 Hz")
told("filter of uneven times", lambda: Record([0, 1, 3], [0, 1, 0]).filtered(high=0.1), "evenly")
differs("resampled", Record([0, 1], [0, 1]).resampled(0.25).acceleration, [0, 0.25, 0.5, 0.75, 1])

# --- files ------------------------------------------------------------------------------------------

values = numpy.round(numpy.sin(numpy.arange(13)) * 0.3, 7)
body = "\n".join("".join(f"{value:15.7E}" for value in values[start : start + 5]) for start in (0, 5, 10))
head = "PEER NGA STRONG MOTION DATABASE RECORD\nmade up\nACCELERATION TIME SERIES IN UNITS OF {}\n"
for name, text in (("new", head.format("G") + f"NPTS=     13, DT=   .0050 SEC,\n{body}\n"), ("old", head.format("g") + f"   13  0.0050  NPTS, DT\n{body}\n")):
    read = record.read(written(f"{name}.AT2", text))
    differs(f"AT2, {name} header: times", read.times, numpy.arange(13) * 0.005, 1e-15)
    differs(f"AT2, {name} header: values", read.acceleration, G * values, 1e-15)
told("AT2 that was cut off", lambda: record.read(written("short.AT2", head.format("G") + f"NPTS= 14, DT= .005 SEC\n{body}\n")), "NPTS = 14", "13 values")
told("AT2 of a velocity", lambda: record.read(written("v.AT2", "a\nb\nVELOCITY TIME SERIES IN UNITS OF CM/S\nNPTS= 1, DT= 1 SEC\n1\n")), "ACCELERATION")
told("AT2 in a unit that is none of acceleration", lambda: record.read(written("cm.AT2", head.format("CM") + f"NPTS= 13, DT= .005 SEC\n{body}\n")), "cm.AT2:3", "'CM'", "cm/s^2")
told("AT2 without a unit", lambda: record.read(written("none.AT2", head.replace(" IN UNITS OF {}", "") + f"NPTS= 13, DT= .005 SEC\n{body}\n")), "UNITS OF", "cm/s^2")
for unit, size in (("CM/S/S", 0.01), ("G.", G), ("M/S2, filtered", 1.0)):
    differs(f"AT2 in {unit}", record.read(written("u.AT2", head.format(unit) + f"NPTS= 13, DT= .005 SEC\n{body}\n")).acceleration, size * values, 1e-15)
told("AT2 with a unit of the caller", lambda: record.read("new.AT2", unit="g"), "leave out unit")

csv = "time[s],ns[cm/s^2],ew[cm/s^2]\n0,1,4\n0.1,2,5\n0.3,3,7\n"
differs("CSV: column by its name", record.read(written("a.csv", csv), column="ew").acceleration, [0.04, 0.05, 0.07])
differs("CSV: times", record.read("a.csv", column=1).times, [0, 0.1, 0.3])
differs("text: unit, blanks, comments", record.read(written("a.txt", "# station\n0.0 1.0 # first\n0.5 -1e0\n"), unit="g").acceleration, [G, -G])
for unit, factor in (("ms", 1e-3), ("s", 1), ("us", 1e-6), ("min", 60)):
    table = written("t.csv", f"t[{unit}],a[m/s^2]\n0,1\n20,2\n40,3\n")
    differs(f"CSV: times in {unit}", record.read(table).times, factor * numpy.array([0.0, 20, 40]), 1e-15 * factor)
told("times in a unit that is not known", lambda: record.read(written("u.csv", "t[h],a[g]\n0,1\n1,2\n")), "t[h]", "ms")
differs("text: one column", record.read(written("b.txt", "1\n2\n3\n"), unit="gal", step=0.1).acceleration, [0.01, 0.02, 0.03])
differs("text: rows of values, the last one short", record.read(written("c.txt", "1 2 3\n4 5\n"), unit="m/s^2", step=0.1).times, numpy.arange(5) * 0.1)
told("several columns", lambda: record.read("a.csv"), "3 columns", "ns[cm/s^2]", "column=")
told("no such column", lambda: record.read("a.csv", column="up"), "'up'", "ew[cm/s^2]")
told("other unit than the header", lambda: record.read("a.csv", column="ns", unit="g"), "unit = 'g'")
told("no unit", lambda: record.read("a.txt"), "unit='g'")
told("no times", lambda: record.read("b.txt", unit="g"), "step=")
told("an unknown unit", lambda: record.read("a.txt", unit="ft/s^2"), "ft/s^2", "gal")
told("a line that is no numbers", lambda: record.read(written("d.txt", "0 1\n1 2\nend of record\n"), unit="g"), "d.txt:3")
told("a short line", lambda: record.read(written("e.txt", "0 1\n1\n"), unit="g"), "e.txt:2")
told("times that go back", lambda: record.read(written("f.txt", "0 1\n1 2\n1 3\n"), unit="g"), "ascend", "1.0 s")

# --- decks ------------------------------------------------------------------------------------------

deck = Deck.from_text("conditions:\n  - {type: fixed, node_set: left}  # stays\n")
fixed.shake(deck, "base", axis="y", start=2.0)
condition = parse(deck.text)["conditions"][1]
table = condition["value"][1]
case.check_equal("condition", [condition[key] for key in ("type", "node_set", "components")], ["velocity", "base", ["y"]])
case.check_equal("other axes", [condition["value"][0], condition["value"][2]], [0, 0])
differs("table: times", table["times"], fixed.times + 2, 1e-15)
differs("table: velocity", table["values"], fixed.velocity, 1e-15)
case.check_equal("other conditions and comments stay", "# stays" in deck.text, True)
with warnings.catch_warnings(record=True) as warned:
    warnings.simplefilter("always")
    drifting.velocity_table()
case.check_equal("a record that does not come to rest", ["the ground goes on with" in str(w.message) for w in warned], [True])
told("an axis of a wave", lambda: fixed.enter(deck, "base", axis="north"), "x, y or z")
told("what a record is of", lambda: fixed.enter(deck, "base", of="within"), "outcrop or wave")
told("an axis", lambda: fixed.shake(deck, "base", axis="north"), "x, y or z")
case.finish()
