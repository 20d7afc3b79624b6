"""History and tables: CSV files whose header names columns with units, as `kinetic[J]`."""

import csv
import io
import os
import re
import warnings

import numpy

from .needs import needs

# Columns of names; all others are numbers.
TEXTS = {"block", "block_a", "block_b", "material_a", "material_b", "joint", "line"}


def split(header):
    """Name and unit of a column; the unit is empty where the header has none."""
    found = re.fullmatch(r"(.*)\[([^\[\]]*)\]", header, flags=re.DOTALL)
    return (found.group(1), found.group(2)) if found else (header, "")


def _parsed(text):
    return list(csv.reader(io.StringIO(text, newline="")))  # names may have line ends of their own


def rows(path):
    """Header and complete lines. A last line without its end is still being written, or was cut off, and is left out."""
    with open(path, newline="", encoding="utf-8") as file:
        text = file.read()
    lines = _parsed(text[: text.rfind("\n") + 1])
    if not lines:
        raise ValueError(f"{path}: has no complete line; a history begins with a line that names its columns.")
    header = lines[0]
    for number, line in enumerate(lines[1:], start=2):
        if len(line) != len(header):
            raise ValueError(f"{path}:{number}: has {len(line)} values; the header names {len(header)} columns. The file is damaged there: "
                             "cut the line off, or restart the run from a checkpoint, which writes it anew.")  # fmt: skip
    return header, lines[1:]


def _sampled_lines(file, most):
    """The header of a history that is open as bytes, and complete lines from equal parts of the file, the first and the last among them."""
    header = file.readline()
    while header.count(b'"') % 2 and (more := file.readline()):  # names may have line ends of their own
        header += more
    begin, size = file.tell(), os.fstat(file.fileno()).st_size
    last = max(begin, size - 4 * len(header) - 4096)  # two lines and more before the end
    lines = {}

    def take(place):
        file.seek(place)
        if place > begin:
            file.readline()  # the rest of a line
        start, line = file.tell(), file.readline()
        if line.endswith(b"\n"):
            lines[start] = line
        return line

    for place in numpy.linspace(begin, last, most, dtype=int):
        take(place)
    while take(file.tell() - 1 if file.tell() > begin else begin):
        pass
    return header, [lines[start] for start in sorted(lines)]


def sampled(path, most=400):
    """Arrays by name of some lines of a history, however long it is: the first, the last, and such as lie between them in equal distances in the
    file. Empty when there is none yet; damaged lines are left out. FileNotFoundError when there is no file.
    """
    with open(path, "rb") as file:
        header, lines = _sampled_lines(file, most)
    names = [split(name)[0] for row in _parsed(header.decode(errors="replace"))[:1] for name in row]
    found = []
    for line in lines:
        try:
            numbers = [float(value) for value in line.split(b",")]
        except ValueError:
            continue
        if len(numbers) == len(names):
            found.append(numbers)
    return dict(zip(names, numpy.array(found).T)) if found else {}


class Tail:
    """New lines of a file that grows. Another file of the name, as a new start writes, is read from its first line."""

    def __init__(self, path):
        self.path = path
        self._begin(None)

    def _begin(self, file):
        self.file, self.offset, self.names, self.head = file, 0, None, b""

    def lines(self):
        """Those that were completed since the last call, as dicts of numbers by name of column."""
        try:
            with open(self.path, "rb") as file:
                place = os.fstat(file.fileno())
                if self.file != place.st_ino or place.st_size < self.offset or file.read(len(self.head)) != self.head:
                    self._begin(place.st_ino)
                file.seek(self.offset)
                text = file.read()
        except FileNotFoundError:
            return []
        text = text[: text.rfind(b"\n") + 1]
        self.head = self.head or text[:4096]
        self.offset += len(text)
        lines = _parsed(text.decode())
        if lines and self.names is None:
            self.names = [split(name)[0] for name in lines.pop(0)]
        return [dict(zip(self.names, map(float, line))) for line in lines]


def _numbers(path):
    """Header and numbers (line, column) of a file that has nothing else, without a text for each number; else None."""
    with open(path, newline="", encoding="utf-8") as file:
        header = next(csv.reader(file), [])
        if TEXTS & set(header):
            return None
        lines = (line for line in file if line.endswith("\n"))
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of a file without lines
                values = numpy.loadtxt(lines, delimiter=",", comments=None, ndmin=2)
        except ValueError:
            return None
    return (header, values) if values.size and values.shape[1] == len(header) else None


def columns(path):
    """Arrays by name without unit: numbers, or names. ValueError names the file."""
    if found := _numbers(path):
        return {split(name)[0]: values for name, values in zip(found[0], numpy.ascontiguousarray(found[1].T))}
    header, lines = rows(path)
    found = {}
    for name, values in zip(header, zip(*lines) if lines else [()] * len(header)):
        try:
            found[split(name)[0]] = numpy.array(values, object if name in TEXTS else float)
        except ValueError as error:
            raise ValueError(f"{path}: column {name}: {error}") from None
    return found


def units(path):
    """Units by name of column, of those that have one."""
    with open(path, newline="", encoding="utf-8") as file:
        named = map(split, next(csv.reader(file), []))
        return {name: unit for name, unit in named if unit}


def frame(path, index="time"):
    """A pandas DataFrame with the times [s] as its index, where the file has them; units are in `attrs["units"]`."""
    table = needs("pandas", "A table").DataFrame(columns(path))
    for name in {"cycle", "planes", "searches"} & set(table):
        table[name] = table[name].astype(int)
    if index in table:
        table = table.set_index(index)
    table.attrs["units"] = units(path)
    return table
