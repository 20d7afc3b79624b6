"""Puts the measured differences into README.md. Usage: table.py <folder with the checks.jsonl of the tests>; longer runs of a scene win."""

import json
import pathlib
import re
import sys

README = pathlib.Path(__file__).resolve().parent / "README.md"


def rows(folder):
    found = {}
    for path in sorted(pathlib.Path(folder).rglob("*.jsonl"), key=lambda path: path.stat().st_size):
        for text in path.read_text().splitlines():
            record = json.loads(text)
            if record["folder"] == "metamorphic":
                found.setdefault(record["case"], {})[record["quantity"]] = record
    return found


def table(found):
    lines = ["| scene | told as | what | difference | bound |", "|---|---|---|---|---|"]
    for scene, records in found.items():
        kept = {}
        for quantity, record in records.items():
            if "kept" in record:
                kept[record["kept"]] = max(kept.get(record["kept"], 0.0), record["error"])
                continue
            words, what = quantity.rsplit(": ", 1)
            note = " (reported)" if record.get("reported") else ""
            lines.append(f"| {scene} | {words} | {what} | {record['error']:.1e} | {record['tolerance']:.2g}{note} |")
        for what in ("energy balance", "contact remainder"):
            lines.append(f"| {scene} | all that are not reported | {what} | {kept[what]:.1e} | 0.001 |")
    return "\n".join(lines)


if __name__ == "__main__":
    found = rows(sys.argv[1])
    sys.path.insert(0, str(README.parents[1] / "support"))
    from scenes import SCENES  # in their order

    text = table({name: found[name] for name in SCENES if name in found})
    README.write_text(re.sub(r"(<!-- table -->\n).*", lambda match: match.group(1) + text + "\n", README.read_text(), flags=re.DOTALL))
