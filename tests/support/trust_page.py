"""Makes docs/trust.md: what has been tested with what, from the decks that tests have run.

Usage: trust_page.py <build folder> ... [-o <page>]

Reads the record (`*.run*.json`) of every run that a whole-program test has left below <build>/tests, with the deck in it and the mesh beside it. What
they had goes to trust.json beside this program, so one test can be run again alone: ctest -R V25, then this program; tests that are no more
leave it. Kinds of evidence hang on the family of the test: EVIDENCE below. What the page says in words stands in docs/trust.md in front of the mark; all behind it is made.
"""

import json
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from coplanetest import Results, documents  # noqa: E402

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PAGE = SOURCE / "docs/trust.md"
DATA = SOURCE / "tests/support/trust.json"
MARK = "<!-- made by tests/support/trust_page.py -->\n"

# Against measurements: these decks are of experiments that were published, or of the charts and fits that stand for them. The other cases of tests/validation have a closed form or a solution of the equations for reference.
EXPERIMENTS = ("verification.V49_taylor_anvil", "verification.V75_cylinder_test", "verification.V74_air_blast", "gallery.perforation", "gallery.penetration",
               "validation.dropped_weight", "validation.hypervelocity", "validation.penetration", "validation.perforation", "validation.shear_wall", "validation.spall", "validation.taylor_rods")  # fmt: skip
# A letter for each kind of evidence, the strongest first.
EVIDENCE = {
    "X": "against an exact answer, a published solution or a balance that must hold (`tests/verification`, `tests/validation`)",
    "M": "against measurements (`tests/validation`, examples; whether we agree stands in [validation](validation.md))",
    "W": "the same problem in other words has the same answer (`tests/metamorphic`)",
    "B": "the same bits on other ranks, threads and back ends, and after restarts (`tests/parallel`)",
    "R": "runs, its balances hold, its files say what was computed (examples, `tests/outputs`, `tests/robustness` and others)",
}


def evidence(test):
    if test.startswith(EXPERIMENTS):
        return "M"
    return {"verification": "X", "validation": "X", "metamorphic": "W", "parallel": "B"}.get(test.split(".")[0], "R")


def words_of(schema):
    """Words that keys of a deck may take, in the order of the schema."""
    properties = schema["properties"]

    def words(group, key):
        part = properties[group]
        return part.get("items", part.get("additionalProperties"))["properties"][key]["enum"]

    return {"law": words("materials", "model"), "element": words("blocks", "element"), "joint": words("joints", "model"), "condition": words("conditions", "type")}


def library():
    """Law of every parameter set of the library, from the table of docs/user/materials.md."""
    return dict(re.findall(r"^\| `(\w+)` \| `(\w+)` \|", (SOURCE / "docs/user/materials.md").read_text(), flags=re.M))


def keys_of(value, schema, path=""):
    """Every key that a deck sets and every word that one of them takes: conditions.type, conditions.type: fixed."""
    if isinstance(value, dict):
        named = isinstance(schema.get("additionalProperties"), dict)
        for key, item in value.items():
            inner = schema["additionalProperties"] if named else schema.get("properties", {}).get(key)
            if inner is None:
                continue
            where = path if named else f"{path}.{key}" if path else key
            if not named:
                yield where
            yield from keys_of(item, inner, where)
    elif isinstance(value, list):
        for item in value:
            yield from keys_of(item, schema.get("items", {}), path)
    elif value in schema.get("enum", []):
        yield f"{path}: {value}"


def all_keys(schema, path=""):
    """What keys_of() can find at all."""
    if "enum" in schema:
        yield from (f"{path}: {word}" for word in schema["enum"])
    for key, inner in schema.get("properties", {}).items():
        where = f"{path}.{key}" if path else key
        yield where
        yield from all_keys(inner, where)
    for key in ("additionalProperties", "items"):
        if isinstance(schema.get(key), dict):
            yield from all_keys(schema[key], path)


def given(command, schema):
    """What --set of a command line adds."""
    for path, value in re.findall(r"--set ([\w.]+)=(\S+)", command):
        document = documents.parse(value)
        for key in reversed(path.split(".")):
            document = [document] if key.isdigit() else {key: document}
        yield from keys_of(document, schema)


def defaults(schema, path=""):
    """Words that hold where a deck says nothing."""
    found = re.search(r"default: (\w+)$", schema.get("description", ""))
    if found and "enum" in schema:
        yield f"{path}: {found.group(1)}"
    for key, inner in schema.get("properties", {}).items():
        yield from defaults(inner, f"{path}.{key}" if path else key)
    for key in ("additionalProperties", "items"):
        if isinstance(schema.get(key), dict):
            yield from defaults(schema[key], path)


def at_one_point():
    """Laws of the decks of `coplane_point` that V46 and V48 ask: exodus_inputs/material_paths and joint_paths."""
    found = set()
    for path in [*(SOURCE / "exodus_inputs/material_paths").glob("*.yaml"), *(SOURCE / "exodus_inputs/joint_paths").glob("*.yaml")]:
        text = path.read_text()
        found |= set(re.findall(r"model: (\w+)", text)) | {law for name, law in library().items() if re.search(rf"\b{name}\b", text)}
    for name in ("V46_concrete_point", "V48_joint_paths"):
        found |= set(re.findall(r"\"model\": \"(\w+)\"", (SOURCE / f"tests/verification/{name}/check.py").read_text()))
    return found


SHAPES = {(2, 3): "triangles", (2, 4): "quadrilaterals", (3, 4): "tetrahedra", (3, 8): "hexahedra"}
DIMENSIONS = ("plane", "axisymmetric", "3D")


def features(record, folder, schema, sets):
    """What a run had: dimension, ranks, layout, blocks as (form, law), joint laws, conditions and switches; and the keys that it set."""
    deck = documents.parse(record["deck"]["text"])
    mesh = folder / record["mesh"]["file"]
    if not isinstance(deck, dict) or not mesh.exists():
        return None
    ran = Results(mesh)
    dimension = "3D" if ran.dimension == 3 else "axisymmetric" if deck.get("geometry") == "axisymmetric" else "plane"
    shapes = {name: SHAPES.get((ran.dimension, ran.connectivity(name).shape[1]), "other shapes") for name in ran.blocks if len(ran.connectivity(name))}
    ran.file.close()
    materials = deck.get("materials") or {}

    def law(name):
        card = materials.get(name, {})
        return card.get("model") or sets.get(card.get("set", name), "?")

    cards = {name: card for name, card in deck.get("blocks", {}).items() if name in shapes}
    blocks = {(f"{shapes[name]}, {card.get('element', 'one_point')}", "rigid" if card.get("rigid") else law(card["material"])) for name, card in cards.items()}
    contact = deck.get("contact") or {}
    joints = set()
    if contact.get("enabled", True) and record["sizes"]["planes"] > 0:
        used = {contact.get("default_joint"), *(pair.get("joint") for pair in contact.get("pairs", []))} - {None}
        named = deck.get("joints") or {}
        joints = {named[name].get("model", "penalty") for name in used if name in named} or {"penalty"}
        if "default_joint" not in contact:
            joints.add("penalty")
    conditions = {condition["type"] for condition in deck.get("conditions") or []}
    command = record["command_line"]
    switches = {
        "friction": any(card.get("friction") or card.get("model") == "barton_bandis" for card in (deck.get("joints") or {}).values()) and bool(joints),
        "declared joints": any(pair.get("declared") for pair in contact.get("pairs", [])),
        "bonds that break or soften": bool({"mortar", "bilinear"} & joints) or any("tensile_strength" in card for card in (deck.get("joints") or {}).values()),
        "contact damping": bool((contact.get("damping") or {}).get("normal") or (contact.get("damping") or {}).get("shear")),
        "forces along the common normal": contact.get("forces") == "common_normal" or contact.get("preset") == "seed",
        "rigid bodies": any(card.get("rigid") for card in cards.values()),
        "erosion": any(card.get("erosion") for card in cards.values()),
        "initial stress": any("stress" in item for item in deck.get("initial") or []),
        "gravity": bool(deck.get("gravity")),
        "damping to rest": bool(deck.get("damping")),
        "restart": "--restart" in command,
    }
    ranks = record["ranks"]
    layout = f"{'1 rank' if ranks == 1 else '2 ranks' if ranks == 2 else '3 ranks and more'}, {record['backend']}"
    had = dict(dimension=dimension, blocks=sorted(map(list, blocks)), joints=sorted(joints), conditions=sorted(conditions),
               switches=sorted(name for name, on in switches.items() if on), layout=layout)  # fmt: skip
    return had, set(keys_of(deck, schema)) | set(given(command, schema))


def gather(build):
    """(test, what the run had, keys) of every run."""
    schema, sets, found = json.loads((SOURCE / "docs/schemas/deck.json").read_text()), library(), []
    top = pathlib.Path(build, "tests") if pathlib.Path(build, "tests").is_dir() else pathlib.Path(build)
    for path in sorted([*top.rglob("*.run.json"), *top.rglob("*.run-s*.json")]):
        test = path.relative_to(top).parts[0]
        if test.startswith(("documents", "package")):  # they run decks of others
            continue
        try:
            seen = features(json.loads(path.read_text()), path.parent, schema, sets)
        except (ValueError, KeyError, OSError, RuntimeError, AttributeError, TypeError):
            continue  # tests of bad input and of killed runs leave such
        if seen:
            found.append((test, *seen))
    return found


def exists(test):
    """Whether a test of this name can still be: its folder is there."""
    family, *rest = test.split(".")
    top = SOURCE / "tests" / family
    return family in ("gallery", "paper") or (top / "check.py").exists() or any((top / "/".join(rest[:n])).is_dir() for n in range(1, len(rest) + 1))


def updated(data, found):
    """The data with new runs: tests that have run anew replace what they had; equal runs of a test are counted."""
    tests = {test: list(runs) for test, runs in data.get("tests", {}).items() if exists(test)}
    keys = {key: test for key, test in data.get("keys", {}).items() if test in tests}
    for test in {test for test, *_ in found}:
        tests[test] = []
    for test, had, used in found:
        same = [run for run in tests[test] if run[1] == had]
        if same:
            same[0][0] += 1
        else:
            tests[test].append([1, had])
        for key in used:
            keys.setdefault(key, test)
    return {"tests": dict(sorted(tests.items())), "keys": dict(sorted(keys.items()))}


def runs_of(data):
    """[(test, what the run had, how many such)], with sets for lists."""
    return [(test, {key: {tuple(item) if isinstance(item, list) else item for item in value} if isinstance(value, list) else value for key, value in had.items()}, count)
            for test, runs in data["tests"].items() for count, had in runs]  # fmt: skip


def letters(tests):
    kinds = {evidence(test) for test in tests}
    return "".join(letter for letter in EVIDENCE if letter in kinds) or "–"


def named(tests):
    """Some tests, the strongest evidence first."""
    order = list(EVIDENCE)
    short = sorted({(order.index(evidence(test)), re.sub(r"\.(all|S|coarse)$", "", test)) for test in tests})
    texts = [re.sub(r"^verification\.", "", test) for _, test in short]
    return ", ".join(texts[:4]) + (f" and {len(texts) - 4} more" if len(texts) > 4 else "")


def table(rows, columns, where, corner):
    """where[row, column]: tests."""
    lines = [f"| {corner} | " + " | ".join(columns) + " |", "|---" * (len(columns) + 1) + "|"]
    return "\n".join(lines + ["| " + " | ".join([row, *(letters(where.get((row, column), ())) for column in columns)]) + " |" for row in rows])


def collected(runs, pairs):
    """{pair: tests} of what pairs(features) gives."""
    found = {}
    for test, seen, _ in runs:
        for pair in pairs(seen):
            found.setdefault(pair, set()).add(test)
    return found


def made(data, schema):
    """The part of the page behind the mark."""
    words, runs = words_of(schema), runs_of(data)
    tests = set(data["tests"])
    text = ["", f"{sum(count for *_, count in runs)} runs of {len(tests)} tests:", "", "| letter | evidence | runs | tests |", "|---|---|---|---|"]
    for letter, what in EVIDENCE.items():
        text.append(f"| {letter} | {what} | {sum(count for t, _, count in runs if evidence(t) == letter)} | {sum(evidence(t) == letter for t in tests)} |")
    text += ["", f"Tests: {', '.join(sorted(tests))}"]
    text += ["", "## By feature", "", "A dash: no run of any test has it. Tests: those with the strongest evidence first. At one point: driven along paths by `coplane_point`, without a mesh (V46, V48).", ""]
    points = at_one_point()
    features = {
        "laws of the continuum": [(word, lambda seen, word=word: any(law == word for _, law in seen["blocks"])) for word in words["law"]],
        "forms of elements": [(form, lambda seen, form=form: any(f == form for f, _ in seen["blocks"])) for form in FORMS],
        "laws of joints": [(word, lambda seen, word=word: word in seen["joints"]) for word in words["joint"]],
        "conditions": [(word, lambda seen, word=word: word in seen["conditions"]) for word in words["condition"]],
        "other": [(word, lambda seen, word=word: word in seen["switches"]) for word in SWITCHES],
    }
    for group, rows in features.items():
        point = [" at one point |"] if group.startswith("laws") else [""]
        text += [f"| {group} | " + " | ".join(DIMENSIONS) + f" |{point[0]} tests |", "|---|---|---|---|---|" + "---|" * bool(point[0])]
        for word, has in rows:
            having = [(test, seen["dimension"]) for test, seen, _ in runs if has(seen)]
            cells = [letters({test for test, d in having if d == dimension}) for dimension in DIMENSIONS]
            if point[0]:
                cells.append("X" if word in points else "–")
            text.append(f"| {word} | " + " | ".join(cells) + f" | {named({test for test, _ in having})} |")
        text.append("")
    laws = [*words["law"], "rigid"]
    text += ["## Form of element and law", "", "In one block.", "", table(FORMS, laws, collected(runs, lambda seen: seen["blocks"]), "form"), ""]
    pairs = collected(runs, lambda seen: {(law, joint) for _, law in seen["blocks"] for joint in seen["joints"]})
    text += ["## Law and joint", "", "In one run, where planes had touched; the faces in contact may be those of another block.", "", table(laws, words["joint"], pairs, "law"), ""]
    pairs = collected(runs, lambda seen: {(form, joint) for form, _ in seen["blocks"] for joint in seen["joints"]})
    text += ["## Form of element and joint", "", "In one run.", "", table(FORMS, words["joint"], pairs, "form"), ""]
    pairs = collected(runs, lambda seen: {(law, condition) for _, law in seen["blocks"] for condition in seen["conditions"]})
    text += ["## Law and condition", "", "In one run.", "", table(laws, words["condition"], pairs, "law"), ""]
    pairs = collected(runs, lambda seen: {(joint, condition) for joint in seen["joints"] for condition in seen["conditions"]})
    text += ["## Joint and condition", "", "In one run.", "", table(words["joint"], words["condition"], pairs, "joint"), ""]
    layouts = sorted({seen["layout"] for _, seen, _ in runs})
    features = collected(runs, lambda seen: {(word, seen["layout"]) for word in [*(law for _, law in seen["blocks"]), *seen["joints"], *seen["conditions"], *seen["switches"]]})
    rows = list(dict.fromkeys([*laws, *words["joint"], *words["condition"], *SWITCHES]))
    text += ["## Ranks and back ends", "", "In one run.", "", table(rows, layouts, features, "feature"), ""]
    unused = sorted(set(all_keys(schema)) - set(data["keys"]) - set(defaults(schema)))
    text += ["## What no run of any test has", "", "Keys and words that no deck of the runs above sets; where a key has a default, that is what runs had.", ""]
    text += ["".join(f"- `{key}`\n" for key in unused) or "None.\n"]
    return "\n".join(text)


# Cases whose runs are not those of decks with meshes: laws at one point, decks that fail.
WITHOUT_RUNS = {"V46_concrete_point", "V48_joint_paths"}

FORMS = [f"{shape}, {form}" for shape in SHAPES.values() for form in ("one_point", "assumed_strain", "full_integration", "full_integration_plain", "nodal_pressure")
         if (form == "nodal_pressure") == (shape in ("triangles", "tetrahedra")) or form == "one_point"]  # fmt: skip
SWITCHES = ["friction", "declared joints", "bonds that break or soften", "contact damping", "forces along the common normal", "rigid bodies", "erosion", "initial stress", "gravity",
            "damping to rest", "restart"]  # fmt: skip


if __name__ == "__main__":
    arguments = sys.argv[1:]
    page = pathlib.Path(arguments[-1]) if arguments[-2:-1] == ["-o"] else PAGE
    builds = arguments[:-2] if arguments[-2:-1] == ["-o"] else arguments
    found = [run for build in builds for run in gather(build)]
    if not found:
        sys.exit(f"{' '.join(builds)}: no records of runs below tests; run some tests there first\n\n{__doc__}")
    data = updated(json.loads(DATA.read_text()) if DATA.exists() else {}, found)
    lines = [f"  {json.dumps(test)}: [\n" + ",\n".join(f"   {json.dumps(run)}" for run in runs) + "\n  ]" for test, runs in data["tests"].items()]
    DATA.write_text('{"tests": {\n' + ",\n".join(lines) + '\n },\n "keys": ' + json.dumps(data["keys"], indent=1) + "}\n")
    head = PAGE.read_text().split(MARK)[0]
    page.write_text(head + MARK + made(data, json.loads((SOURCE / "docs/schemas/deck.json").read_text())))
