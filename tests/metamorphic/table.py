"""Puts the measured differences into README.md. Usage: table.py <folder with the checks.jsonl of the tests> ...; longer runs of a scene win. Scenes and
cases without results there keep the rows they have.
"""

import json
import pathlib
import re
import sys

README = pathlib.Path(__file__).resolve().parent / "README.md"


def rows(folders, name):
    found = {}
    for path in sorted((path for folder in folders for path in pathlib.Path(folder).rglob("checks.jsonl")), key=lambda path: path.stat().st_size):
        for text in path.read_text().splitlines():
            record = json.loads(text)
            if record["folder"] == name:
                found.setdefault(record["case"], {})[record["quantity"]] = record
    return found


def of_scene(scene, records):
    lines, kept = [], {}
    for quantity, record in records.items():
        if "kept" in record:
            kept[record["kept"]] = max(kept.get(record["kept"], 0.0), record["error"])
            continue
        words, what = quantity.rsplit(": ", 1)
        note = " (reported)" if record.get("reported") else ""
        lines.append(f"| {scene} | {words} | {what} | {record['error']:.1e} | {record['tolerance']:.2g}{note} |")
    for what in ("energy balance", "contact remainder"):
        lines.append(f"| {scene} | all that are not reported | {what} | {kept[what]:.1e} | 0.001 |")
    return lines


def of_case(case, records):
    """A line for each way of telling it: runs, checks that fail, motion and its bound, answers."""
    told, lines = {}, []
    for quantity, record in records.items():
        untold = re.fullmatch(r"(\S+): (\d+) runs cannot be told so: (.*)", quantity)
        if untold:
            lines.append(f"| {case} | {untold.group(1)} | none of {untold.group(2)} | | | {untold.group(3).strip(chr(39))} |")
        elif "kept" not in record:
            words, what = quantity.rsplit(": ", 1)
            told.setdefault(words, {})[what] = record
    for words, found in told.items():
        first = next(what for what in found if what.startswith("checks of the case"))
        cells = [re.search(r"\((.*)\)", first).group(1), str(found[first]["value"]) + (" (reported)" if found[first].get("reported") else "")]
        moved = [(what, found[what]) for what in ("any motion", "any motion, other steps") if what in found]
        cells.append("; ".join(f"{record['error']:.1e} of {record['tolerance']:.1g}{', other steps' if 'other' in what else ''}" for what, record in moved))
        answers = found.get("answers over tolerances")
        cells.append(f"{answers['error']:.1e}" if answers else "")
        lines.append(f"| {case} | {words} | " + " | ".join(cells) + " |")
    return lines


def put(text, mark, head, of, found, order):
    """The text with the lines behind the mark made anew; those of names without results stay."""
    before, old = text.split(mark)
    old, *after = old.split("<!-- end -->")
    kept = {}
    for line in old.splitlines()[2:]:
        if line.startswith("| "):
            kept.setdefault(line.split(" | ")[0][2:], []).append(line)
    lines = [line for name in order for line in (of(name, found[name]) if name in found else kept.get(name, []))]
    return before + mark + "\n".join([head, "|---" * (head.count("|") - 1) + "|", *lines]) + "\n" + "<!-- end -->".join(["", *after])


def not_covered(cases, untold, words_of_every_case):
    """Lines for what is not told, with the reason: words left out of the runs without `all`, answers that are only reported, runs whose motion is
    not compared, verification cases and examples that are not told at all.
    """
    root = README.parents[2]
    lines = []
    for name, case in cases.items():
        rest = [word for word in case.words(True) if word not in case.often]
        why = "takes long, and others of its kind are told: with `all` alone" if not case.often else "with `all` alone: the covering set has these words with other cases"
        lines.append(f"| {name} | {', '.join(rest)} | {why} |")
        lines += [f"| {name} | {word}: its answers are only reported | {reason} |" for word, reason in case.other.items()]
        lines += [f"| {name} | run {run}: motion not compared | {reason} |" for run, reason in case.apart.items()]
        lines += [f"| {name} | {word}: motion only reported | the bound is none |" for word, bound in case.bounds.items() if bound is None]
    for word in words_of_every_case:
        if not any(word in case.often for case in cases.values()):
            lines.append(f"| all | {word} | with `all` alone |")
    every = sorted(path.parent.name for path in (root / "tests/verification").glob("*/check.py")) + sorted(path.parent.name for path in (root / "exodus_inputs").glob("*/example.yaml"))
    unknown = sorted(set(every) - set(cases) - set(untold)) + sorted(set(untold) - set(every))
    if unknown:
        sys.exit(f"retold/cases.py says of {', '.join(unknown)} neither how they are told nor why not, or they are no more")
    lines += [f"| {name} | all | {untold[name]} |" for name in every if name in untold]
    return lines


def replace_between(text, mark, body):
    before, old = text.split(mark)
    return before + mark + body + "<!-- end -->" + old.split("<!-- end -->", 1)[1]


if __name__ == "__main__":
    sys.path[:0] = [str(README.parents[1] / "support"), str(README.parent / "retold")]
    from cases import CASES, EXACT, NEAR, UNTOLD
    from scenes import SCENES  # in their order

    text = put(README.read_text(), "<!-- cases -->\n", "| case | told as | runs | checks that fail | any motion, over the largest | answers |", of_case, rows(sys.argv[1:], "retold"), CASES)
    text = replace_between(text, "<!-- not covered -->\n", "\n".join(["| case | not told as | why |", "|---|---|---|", *not_covered(CASES, UNTOLD, [*EXACT, *NEAR])]) + "\n")
    README.write_text(put(text, "<!-- table -->\n", "| scene | told as | what | difference | bound |", of_scene, rows(sys.argv[1:], "metamorphic"), SCENES))
