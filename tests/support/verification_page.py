"""Makes docs/verification.md and docs/validation.md from the results of the verification and the validation cases.

Usage: verification_page.py <build folder> [verification | validation]

Reads the checks.jsonl of the tests of a suite below the build folder and the READMEs in tests/verification or tests/validation. A case without results
there keeps the section it has on the page, so one case can be run again alone: ctest -R V25, then this program.

A section of docs/validation.md is the README of the case, its picture (docs/validation/<case>.png), and tables of the checks, of other codes, and of the mesh
study; the table before them has the line **Verdict.** of each README. Numbers are those of the long form: where only the coarse one has run, the tables stay as they
are on the page, and the text is made anew.

The page of verification begins with a table of all V numbers, from the titles of the READMEs in tests/verification and tests/parallel. A title has each number in
brackets behind the words that say what it shows:

    # Two equal bars (V21), in other frames (V58)
    # Plastic waves (V36) and shock waves (V37)
    # The same bits on any ranks, threads and back end (V59, V60)
"""

import json
import pathlib
import re
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
HEAD = """# Verification

What the program computes against exact answers, case by case: made by `tests/support/verification_page.py` from the lines that the tests
of `ctest -L verification` write (`checks.jsonl` in the folder of each test). How each reference is derived, and why its tolerance
is what it is, stands in the README of the case. Errors are absolute where no per cent sign stands, in the unit of the quantity; `[low, high]` are limits.
The last rows of a table are the balances that every run has to keep, with the worst of its runs.

Cases have numbers, V04 and so on, by which documents and messages of commits call them. They are names: a number that is missing here has no case of
whole runs. Cases of `tests/parallel` compare runs with each other, bit by bit, and have no results below; cases without a number stand last.

"""

VALIDATION_HEAD = """# Validation

What the program computes against published tests, measured or computed by others: made by `tests/support/verification_page.py` from the lines that the tests of
`ctest -L validation` write. Numbers of the mesh studies and of other codes come from the long forms (`ctest -L validation` with the label `slow`; `-LE slow`
leaves them out). Differences are absolute where no per cent sign stands, in the unit of the quantity; `[low, high]` are limits. Seconds are those of the machine that made the page, two
cores that other work shared; a form's seconds are of all runs of the case together.

Cases whose verdict is not "agrees" are meant to be read: there the program is wrong, does not converge, or the reference asks for something that it does not have. Each section says what of its source was read; curves that could not be read as
numbers were computed again by a method of one's own, and the section says so.

Not here, because no table could be read: measured brick walls in a blast or under a vehicle-like blow (the next best: [blast wall](#blast-wall), [boulder wall](#boulder-wall), which name what was looked for), the 42 tilted walls of Restrepo Velez et al. (the next best: [walls of another paper](#tilting-wall) and closed forms), shear walls J5D to J7D (their loads and the guide of their beams),
overturning spectra of shaken blocks (Spanos and Koh; Zhang and Makris), the damage of brick walls that a boulder struck (Mavrouli et al. 2024: the set-up and the heights of release were read, not what became of each wall).

"""


def cases(suite="verification"):
    """Folders of the cases, in the order of their numbers; those without a number last."""

    def order(path):
        found = re.match(r"V(\d+)", path.name)
        return (0, int(found.group(1)), path.name) if found else (1, 0, path.name)

    return sorted((path.parent for path in (SOURCE / "tests" / suite).glob("*/check.py")), key=order)


def titles():
    """The title of each README of a case with its folder: those of tests/verification, then of tests/parallel."""
    folders = cases() + sorted(path.parent for path in (SOURCE / "tests/parallel").glob("*/README.md"))
    return [(folder, (folder / "README.md").read_text().split("\n", 1)[0].removeprefix("# ")) for folder in folders]


def claims(title):
    """What each number of a title shows: [(number, words)]. Words behind a comma go on from the first ones."""
    found, first = [], ""
    for words, numbers in re.findall(r"(.*?) \((V\d\d(?:(?:, | to )V\d\d)*)\)", title):
        said = first + words if words.startswith(", ") else words.removeprefix(" and ")
        said = said[0].upper() + said[1:]
        first = first or said
        given = [int(number) for number in re.findall(r"V(\d\d)", numbers)]
        for number in range(given[0], given[-1] + 1) if " to " in numbers else given:
            found.append((f"V{number:02}", said))
    return found


def index():
    """The table of all numbers; one that several cases show has a row for each."""
    rows = []
    for folder, title in titles():
        anchor = heading(folder)[3:].lower().replace(" ", "-")
        link = f"#{anchor}" if folder.parent.name == "verification" else f"../tests/parallel/{folder.name}/README.md"
        rows += [(number, f"| {number} | {said} | [{folder.name}]({link}) |") for number, said in claims(title)]
    return "\n".join(["| number | what it shows | case |", "|---|---|---|", *(row for _, row in sorted(rows, key=lambda row: row[0])), ""])


def records(build, suite="verification"):
    """Last line for each quantity of each case folder: {folder: {(case, quantity, size or code): record}}.

    Only lines of the tests of the suite themselves (verification.<case>/checks.jsonl, or <case>.jsonl in
    COPLANE_CHECKS_DIR): other tests leave lines about made-up quantities in the build, too.
    """
    found = {}
    names = tuple(folder.name for folder in cases(suite))
    for path in sorted(pathlib.Path(build).rglob("*.jsonl")):
        if not (path.name == "checks.jsonl" and path.parent.name.startswith(f"{suite}.")) and not path.name.startswith(names):
            continue
        for text in path.read_text().splitlines():
            record = json.loads(text)
            key = record["case"], record["quantity"], record.get("size", record.get("code"))
            found.setdefault(record["folder"], {})[key] = record
    return found


def number(value):
    if isinstance(value, bool) or value is None or isinstance(value, str):
        return str(value)
    if isinstance(value, list):
        return "[" + ", ".join(number(item) for item in value) + "]" if value else "none"
    return f"{value:.5g}"


def row(record):
    quantity = record["quantity"].replace("|", "\\|")
    if record.get("reported"):
        quantity += " (for the record)"
    elif not record["passed"]:
        quantity += " **failed**"
    if record.get("relative"):
        error, tolerance = f"{100 * record['error']:.2g} %", f"{100 * record['tolerance']:.2g} %"
    else:
        error, tolerance = f"{record['error']:.2g}", f"{record['tolerance']:.2g}"
    return [quantity, number(record["reference"]), number(record["value"]), error, tolerance]


def kept(lines):
    """One row for each balance: the run that comes nearest to its tolerance."""
    rows, groups = [], {}
    for record in lines:
        groups.setdefault(record["kept"], []).append(record)
    for what, group in groups.items():
        worst = max(
            group,
            key=lambda r: (not r["passed"], r["error"] / r["tolerance"] if r["tolerance"] else r["error"], isinstance(r["reference"], str)),
        )
        cells = row({**worst, "quantity": f"{what}, worst of {len(group)} runs"})
        if isinstance(worst["reference"], str):
            cells[1], cells[2] = "equal", "equal" if worst["passed"] else "different"
        rows.append(cells)
    return rows


def heading(folder):
    return f"## {folder.name.replace('_', ' ')}"


def section(folder, lines):
    readme = (folder / "README.md").read_text()
    title, paragraph = re.match(r"# ([^\n]*)\n+(.*?)(?=\n\n|\Z)", readme, flags=re.S).groups()
    claim = paragraph.replace("**Claim.** ", "").replace("\n", " ").strip()
    text = [heading(folder), "", f"{title}. {claim}", "", f"[README](../tests/verification/{folder.name}/README.md)", ""]
    if not lines:
        return "\n".join(text + ["No results yet.", ""])
    text += ["| quantity | reference | computed | error | tolerance |", "|---|---|---|---|---|"]
    rows = [row(record) for record in lines if "kept" not in record]
    if len({record["case"] for record in lines}) > 1:  # cases that share a folder
        rows = [[f"{record['case']}: {row(record)[0]}", *row(record)[1:]] for record in lines if "kept" not in record]
    rows += kept([record for record in lines if "kept" in record])
    return "\n".join(text + ["| " + " | ".join(cells) + " |" for cells in rows] + [""])


def table(header, rows):
    if not rows:
        return []
    return ["| " + " | ".join(header) + " |", "|" + "---|" * len(header), *("| " + " | ".join(cells) + " |" for cells in rows), ""]


def off(record):
    """Difference of a line of a study or another code from the reference, in per cent."""
    value, reference = record["value"], record["reference"]
    if isinstance(value, str) or isinstance(reference, str) or not reference or value is None:
        return ""
    return f"{100 * (value / reference - 1):+.2g} %"


def validation_parts(folder):
    """Title, verdict, and the text of the README without them."""
    title, text = (folder / "README.md").read_text().split("\n", 1)
    verdict = re.search(r"^\*\*Verdict\.\*\* (.*)$", text, flags=re.M)
    # Links of a README, to other cases and to documents, are those of the page.
    text = re.sub(r"\]\(\.\./(\w+)/README\.md\)", lambda found: f"](#{found[1].replace('_', '-')})", text).replace("](../../../docs/", "](")
    return title.removeprefix("# "), verdict.group(1).strip(), re.sub(r"^\*\*Verdict\.\*\* ", "**Verdict.** ", text.strip(), flags=re.M)


def seconds(lines):
    return {record["quantity"]: record["value"] for record in lines if record.get("kind") == "seconds"}


def validation_section(folder, lines, before=""):
    title, _, readme = validation_parts(folder)
    text = [heading(folder), "", f"*{title}.* [Deck, recipe, check](../tests/validation/{folder.name}/README.md)", "", readme, ""]
    if (SOURCE / f"docs/validation/{folder.name}.png").exists():
        text += [f"![{title}](validation/{folder.name}.png)", ""]
    first = before.find("| quantity | reference | ours |")
    if first >= 0 and "long form" not in seconds(lines) and (not lines or "long form" in before[first:]):
        return "\n".join(text) + "\n" + before[first:].rstrip("\n") + "\n"
    if not lines:
        return "\n".join(text + ["No results yet.", ""])
    checks = [record for record in lines if "kind" not in record]
    rows = [row(record) for record in checks if "kept" not in record] + kept([record for record in checks if "kept" in record])
    text += table(("quantity", "reference", "ours", "difference", "tolerance"), rows)
    others = [record for record in lines if record.get("kind") == "other"]
    spent = [f"{record['seconds']:.2g}" if record["seconds"] else "" for record in others]
    input_lines = [str(record["lines"] or "") for record in others]
    text += table(
        ("quantity", "code or source", "value", "reference", "difference", "seconds", "lines of input"),
        [[r["quantity"].replace("|", "\\|"), r["code"], number(r["value"]), number(r["reference"]) if r["reference"] is not None else "", off(r), s, n]
         for r, s, n in zip(others, spent, input_lines)],
    )  # fmt: skip
    studies = [record for record in lines if record.get("kind") == "study"]
    text += table(
        ("mesh study: quantity", "elements", "ours", "reference", "difference", "seconds"),
        [[r["quantity"].replace("|", "\\|"), r["size"], number(r["value"]), number(r["reference"]) if r["reference"] is not None else "", off(r),
          f"{r['seconds']:.2g}" if r["seconds"] else ""] for r in studies],
    )  # fmt: skip
    spent = seconds(lines)
    text += ["Seconds: " + ", ".join(f"{form} {value:.0f}" for form, value in spent.items()) + ".", ""]
    return "\n".join(text)


def validation_index():
    """All cases, with their verdicts, behind a line of those in which we differ."""
    rows, differ = [], []
    for folder in cases("validation"):
        title, verdict, _ = validation_parts(folder)
        link = f"[{folder.name}](#{heading(folder)[3:].lower().replace(' ', '-')})"
        rows.append([link, title, verdict])
        if not verdict.startswith("agrees") or "differs" in verdict.lower() or "does not converge" in verdict:
            differ.append(link)
    return "\n".join([f"Where we differ or do not converge, wholly or in part: {', '.join(differ)}.", "", *table(("case", "what", "verdict"), rows)])


def page(build, old="", suite="verification"):
    """The page's text; sections of `old` stay where the build has no results."""
    before = {match.split("\n", 1)[0]: match for match in re.findall(r"^## .*?(?=^## |\Z)", old, flags=re.S | re.M)}
    found = records(build, suite)
    sections = []
    for folder in cases(suite):
        lines = list(found.get(folder.name, {}).values())
        if suite == "validation":
            sections.append(validation_section(folder, lines, before.get(heading(folder), "")))
        elif lines or heading(folder) not in before:
            sections.append(section(folder, lines))
        else:
            sections.append(before[heading(folder)].rstrip("\n") + "\n")
    head = HEAD + index() if suite == "verification" else VALIDATION_HEAD + validation_index()
    return head + "\n" + "\n".join(sections)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["verification"], ["validation"]):
        sys.exit(__doc__)
    if not (pathlib.Path(sys.argv[1]) / "CTestTestfile.cmake").exists():
        sys.exit(f"{sys.argv[1]}: no build folder (there is no CTestTestfile.cmake)\n\n{__doc__}")
    for suite in sys.argv[2:] or ("verification", "validation"):
        output = SOURCE / f"docs/{suite}.md"
        output.write_text(page(sys.argv[1], output.read_text() if output.exists() else "", suite))
