#!/usr/bin/python3
"""The record of the ground, made up: noise of a fixed seed under an envelope, filtered to 0.3 to 2 Hz, as on soft ground, baseline corrected, largest value 1.

    motion.py         writes it into deck.yaml
"""

import pathlib
import re
import sys

import numpy

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from coplanetools import deck_of  # finds the Python package

from coplane import record

STEP, LENGTH, SEED, START = 0.02, 9.0, 17, 1.0  # START: when it begins in the deck [s]


def motion():
    """The Record: 9 s, of which 1 to 5 s are strong."""
    t = numpy.arange(round(LENGTH / STEP) + 1) * STEP
    envelope = numpy.minimum(t, 1) ** 2 * numpy.exp(-0.8 * numpy.maximum(t - 4, 0))
    noise = numpy.random.RandomState(SEED).standard_normal(len(t))
    return record.Record(t, envelope * noise).filtered(0.3, 2).corrected().scaled(peak=1)


def table():
    """Times and values as they stand in the deck; before START the ground rests."""
    made = motion()
    rest = [0.0, START - 1e-6]  # its first value is not quite zero: the ground must not creep up to it
    return rest + [round(float(t) + START, 4) for t in made.times], [0.0, 0.0] + [round(float(a), 5) for a in made.acceleration]


def main():
    times, values = table()
    deck = deck_of(HERE)
    line = r"\1times: [" + ", ".join(f"{t:.9g}" for t in times) + r"]\n\1values: [" + ", ".join(f"{a:g}" for a in values) + "]\n"
    text, count = re.subn(r"( +)times: \[[^]]*\]\n +values: \[[^]]*\]\n", line, deck.read_text())
    if count != 1:
        sys.exit(f"{deck}: {count} tables of times and values, in brackets, are there; one is accepted, which is replaced.")
    deck.write_text(text)


if __name__ == "__main__":
    main()
