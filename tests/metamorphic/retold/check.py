"""A verification case or an example told in other words: its own checks must pass, and what moved must be the same. See ../README.md.

Arguments: the folder of a verification case or the name of an example, and `all` for all words, or some words.
"""

import json
import os
import pathlib
import subprocess
import sys

import numpy
from coplanetest import Case

from cases import CASES, EXACT, OTHER_STEPS

name, rest = sys.argv[1], sys.argv[2:]
known = CASES[name]
words = known.words(True) if rest == ["all"] else rest or known.often
case = Case(name, __file__)
verification = case.source.parents[1] / "verification" / name / "check.py"
command = [str(verification)] if verification.exists() else [str(case.source / "example.py"), name]
if known.long and rest == ["all"]:
    command.append("all")


def ask(word):
    """Runs the check of the case in these words; the exit code and the lines of the check."""
    folder = pathlib.Path(word.replace(":", "_")).resolve()
    folder.mkdir(exist_ok=True)
    environment = dict(os.environ, COPLANE_TOLD_AS=word, COPLANE_CHECKS_DIR=str(folder))
    done = subprocess.run([sys.executable, *command], cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    (folder / "output.txt").write_text(done.stdout)
    lines = {}
    for path in folder.glob("*.jsonl"):
        for text in path.read_text().splitlines():
            line = json.loads(text)
            lines[line["case"], line["quantity"]] = line
    return folder, done, lines


def number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def apart(lines, first):
    """By how much answers lie elsewhere than those of the original, over the tolerances of the check: the largest; and the answers that must be equal
    and are not. An answer is what the check compares: value less reference.
    """
    worst, unequal = 0.0, []
    for key, line in lines.items():
        if "kept" in line or line.get("reported") or key not in first:
            continue
        found = []
        for told in (line, first[key]):
            if number(told["value"]) and number(told["reference"]):  # not intervals
                off = told["value"] - told["reference"]
                found.append(off / abs(told["reference"]) if told.get("relative") else off)
        if len(found) == 2 and line["tolerance"] > 1e-6:  # smaller ones are about round-off themselves
            worst = max(worst, abs(found[0] - found[1]) / line["tolerance"])
        elif line["value"] != first[key]["value"] and line["reference"] == first[key]["reference"] and not (len(found) == 2 and line["tolerance"]) and not isinstance(line["reference"], list):
            unequal.append(key[1])
    return worst, unequal


def largest(values):
    return float(numpy.max(numpy.abs(values), initial=0.0))


def differences(a, b):
    """Of the motions of two runs, over the largest of the second; and whether both took the same steps. Where they did not, displacements are taken at
    the times of the second: in lines of the history by interpolation, at the end by the velocity there. Velocities are not: where bodies strike each
    other between two lines, one that does so a step later has another one in between.
    """
    length = max([largest(b[key]) for key in b if "displacement" in key] or [0.0])
    speed = max([largest(b[key]) for key in b if "velocity" in key] or [0.0])
    speed = max(speed, length / largest(b["nodes time"])) if "nodes time" in b and largest(b["nodes time"]) else speed  # what ends at rest has none
    same = all(a[key].shape == b[key].shape and largest(a[key] - b[key]) <= 1e-9 * largest(b[key]) for key in ("time", "nodes time") if key in b)
    worst = 0.0
    for key in set(a) & set(b):
        scale = length if "displacement" in key else speed if "velocity" in key else 0.0
        if not scale or not same and "velocity" in key:
            continue
        mine = a[key]
        if not same and key == "nodes displacement":
            mine = mine + a["nodes velocity"] * (b["nodes time"] - a["nodes time"])
        elif not same:
            mine = numpy.interp(b["time"], a["time"], mine)
        worst = max(worst, largest(mine - b[key]) / scale)
    return worst, same, length


def motion(folder, base):
    """Largest difference of any motion of runs with the same steps, and of those with others; how many runs were told and how many were not, with a
    reason; and the largest rounding of a coordinate over the largest displacement of its run.
    """
    worst, others, told, untold, why, rounding = 0.0, None, 0, 0, "", 0.0
    for path in sorted(folder.rglob("told.json")):
        answer = json.loads(path.read_text())
        if not answer["told"]:
            untold, why = untold + 1, answer["why"]
            continue
        told += 1
        seen, first = path.parent / "seen.npz", base / path.parent.relative_to(folder) / "seen.npz" if base else None
        if path.parent.name in known.apart or not (first and first.exists() and seen.exists()):
            continue
        a = numpy.load(seen)
        apart, same, length = differences(a, numpy.load(first))
        if length and "reach" in a:
            rounding = max(rounding, float(a["reach"]) * 2.0**-53 / length)
        if same:
            worst = max(worst, apart)
        else:
            others = max(others or 0.0, apart)
    return worst, others, told, untold, why, rounding


base = None
if known.base or rest:
    base, done, first = ask("as_it_is")
    case.check_equal("as it is: exit code", done.returncode, 0, kept="exit code")
for word in words:
    folder, done, lines = ask(word)
    moved, others, told, untold, why, rounding = motion(folder, base)
    if not told:
        case.line(f"{word}: {untold} runs cannot be told so: {why}", 0, 0, 0, 0, True, report=True)
        continue
    runs = f"{told} runs" if not untold else f"{told} of {told + untold} runs"
    # Checks about round-off in a frame of their own (2D is a slice of 3D to 1e-10) are left to the comparison of motions; balances are not.
    failed = sorted({line["quantity"] for line in lines.values() if not line["passed"] and not line.get("reported") and ("kept" in line or not 0 < line["tolerance"] <= 1e-6)})
    crashed = done.returncode not in (0, 1) or (done.returncode and "checks failed" not in done.stdout)
    if crashed:
        failed.append(done.stdout.strip().splitlines()[-1][:200])
    reason = known.other.get(word)
    case.line(f"{word}: checks of the case that fail ({runs})", len(failed), 0, len(failed), 0, not failed, report=bool(reason))
    for what in failed:
        print(f"    {what}", flush=True)
    if base is None:
        continue
    answers, unequal = apart(lines, first)
    exact = EXACT.get(word)
    if exact is None:
        case.check(f"{word}: answers over tolerances", answers, 0, 1, report=True)
        continue
    if exact:
        exact += (20 if word == "powers_of_two" else 200) * rounding
    bound = known.bounds.get(word, exact)
    case.check(f"{word}: any motion", moved, 0, exact if bound is None else bound, report=bound is None)
    if others is not None:
        case.check(f"{word}: any motion, other steps", others, 0, OTHER_STEPS, report=bound is None)
    # Energies seen from 100 m/s are known from lines of the history only, to the work of half a step.
    case.check(f"{word}: answers over tolerances", answers, 0, 1e-3 if others is None else 1, report=bound is None or word == "drifting" or bool(reason))
    case.check_equal(f"{word}: answers that differ", unequal, [], kept="equal answers")
case.finish()
