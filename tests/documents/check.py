"""Checks of the documents and of the installed package; one per argument. Run by ctest, in a folder of its own."""

import importlib.util
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

from coplanetest import browser
from drawn import check_classic, check_packages, check_potential  # noqa: F401

SOURCE = pathlib.Path(os.environ["COPLANE_SOURCE"])
BINARIES = pathlib.Path(os.environ["COPLANE_BIN"])
BUILD = BINARIES.parent


def run(command, **options):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)


def tracked(*patterns):
    listed = run(["git", "ls-files", *patterns], cwd=SOURCE)
    if listed.returncode:
        sys.exit(listed.stdout)
    return [name for name in listed.stdout.splitlines() if (SOURCE / name).is_file()]


def check_format():
    """Every C++ file is as clang-format leaves it."""
    names = tracked("*.cpp", "*.hpp")
    assert names, "no C++ files found"
    done = run(["clang-format", "--dry-run", "-Werror", *names], cwd=SOURCE)
    assert done.returncode == 0, done.stdout[:4000]
    print(f"{len(names)} files are formatted")


def check_verification():
    """The page of results has a section for every verification case, and none besides; its maker reads what tests write."""
    sys.path.insert(0, str(SOURCE / "tests/support"))
    import verification_page as maker

    listed = re.search(r"^foreach\(_case (.*)\)\n  coplane_check\(validation/", (SOURCE / "tests/CMakeLists.txt").read_text(), flags=re.M)
    names = [folder.name for folder in maker.cases("validation")]
    assert listed[1].split() == names, "tests/CMakeLists.txt does not register all of tests/validation, or more, or in another order"
    page = (SOURCE / "docs/validation.md").read_text()
    assert re.findall(r"^## (.*)", page, flags=re.M) == [name.replace("_", " ") for name in names] and maker.validation_index() in page, (
        "docs/validation.md is old: python3 tests/support/verification_page.py <build folder> validation, best after the case has run there"
    )
    assert "No results yet" not in page, "docs/validation.md has cases without results"
    names = [folder.name for folder in maker.cases()]
    registered = re.findall(r"^coplane_check\(verification/(\S+)", (SOURCE / "tests/CMakeLists.txt").read_text(), flags=re.M)
    assert sorted(set(registered)) == sorted(names), "tests/CMakeLists.txt does not register all of tests/verification, or more"
    kept = re.findall(r"^## (.*)", (SOURCE / "docs/verification.md").read_text(), flags=re.M)
    missing = sorted(set(name.replace("_", " ") for name in names) ^ set(kept))
    assert kept == [name.replace("_", " ") for name in names], (
        f"docs/verification.md is old ({missing}): python3 tests/support/verification_page.py <build folder>, best after the case has run there"
    )
    # The table of numbers: each number that is used anywhere has a row, and leads to the case that it names.
    assert maker.index() in (SOURCE / "docs/verification.md").read_text(), (
        "docs/verification.md: the table of numbers is old: python3 tests/support/verification_page.py <build folder>"
    )
    claims = {folder: {number for number, _ in maker.claims(title)} for folder, title in maker.titles()}
    for folder, numbers in claims.items():
        cases = re.findall(r"(?:Case\(|case\.name = )f?\"(.*?)\"", (folder / "check.py").read_text())
        named = set(re.findall(r"V\d\d", " ".join([folder.name, *cases])))
        assert named <= numbers, f"{folder.name}/README.md: the title does not say what {sorted(named - numbers)} show"
    known = set().union(*claims.values())
    pages = tracked("docs/*.md", "tests/*.md", "tests/*.py", "packages/*.md", "packages/*.?pp", "apps/*.md", "apps/*.?pp", "exodus_inputs/*.md", "exodus_inputs/*.py")
    used = {(number, name) for name in pages for number in re.findall(r"\bV\d\d\b", (SOURCE / name).read_text())}
    assert not (lost := sorted(pair for pair in used if pair[0] not in known)), f"numbers that no case has: {lost}"
    assert maker.claims("Two bars (V21), in other frames (V58) and waves (V12 to V14)") == [
        ("V21", "Two bars"), ("V58", "Two bars, in other frames"), ("V12", "Waves"), ("V13", "Waves"), ("V14", "Waves"),
    ]  # fmt: skip
    results = pathlib.Path("results")
    shutil.rmtree(results, ignore_errors=True)
    own = results / f"verification.{names[0]}"
    own.mkdir(parents=True)
    other = results / "parallel.something"
    other.mkdir()
    line = dict(folder=names[0], case="V0", quantity="|T| [m]", value=2.5, reference=2.0, error=0.25, tolerance=0.3, passed=True, relative=True)
    balance = dict(line, quantity="run: energy", kept="energy", error=0.1, relative=False)
    worse = dict(balance, quantity="other: energy", error=0.2, value=0.2)
    (own / "checks.jsonl").write_text("".join(json.dumps(record) + "\n" for record in (line, balance, worse)))
    (other / "checks.jsonl").write_text(json.dumps(dict(line, quantity="of another test")) + "\n")
    text = maker.page(results, f"## {names[1].replace('_', ' ')}\n\nkept\n")
    assert "| \\|T\\| [m] | 2 | 2.5 | 25 % | 30 % |" in text, text[:2000]
    assert "| energy, worst of 2 runs | 2 | 0.2 | 0.2 | 0.3 |" in text
    assert "of another test" not in text
    shutil.rmtree(results)  # the maker would read them as results of this build
    assert f"## {names[1].replace('_', ' ')}\n\nkept\n" in text and text.count("No results yet.") == len(names) - 2


def check_citation():
    """CITATION.cff is what the format 1.2.0 wants, and of this version; every source that is cited has a row in docs/theory/references.md, with a DOI
    that looks like one, and every set of the library and data file a row of data."""
    from coplanetest import documents

    cited = documents.load(SOURCE / "docs/CITATION.cff")
    required = {"authors", "cff-version", "message", "title"}
    allowed = required | {"abstract", "commit", "contact", "date-released", "doi", "identifiers", "keywords", "license", "license-url", "preferred-citation", "references", "repository",
                          "repository-artifact", "repository-code", "type", "url", "version"}  # fmt: skip
    assert required <= set(cited) <= allowed, f"CITATION.cff: {sorted(set(cited) ^ required)}"
    assert cited["cff-version"] == "1.2.0" and cited["type"] == "software" and cited["license"] == "BSD-3-Clause", cited
    people = {"family-names", "given-names", "name-particle", "name-suffix", "affiliation", "email", "orcid", "alias", "website"}
    for reference in [cited, *cited["references"]]:
        assert {"authors", "title", "type"} <= set(reference), reference
        for author in reference["authors"]:
            assert "name" in author or author and set(author) <= people, author
    version = re.search(r"project\(Coplane VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text()).group(1)
    assert str(cited["version"]) == version, f"CITATION.cff: version {cited['version']}, the project has {version}"

    page = (SOURCE / "docs/theory/references.md").read_text()
    rows = [line.split("|")[1:-1] for line in page.splitlines() if line.startswith("| ") and not line.startswith("| cited as")]
    entries = [" ".join(row) for row in rows]
    for row in rows:
        link = re.search(r"\[(.*)\]\(https://doi\.org/(.*)\)", row[2])
        assert not link or re.fullmatch(r"10\.\d{4,5}/\S+", link.group(1)), row
    lost = []
    for name in tracked("docs/theory/*.md", "docs/user/*.md", "docs/examples/*.md", "packages/*.md", "packages/*.hpp", "packages/*.cpp", "packages/*.py", "apps/*.md", "tests/verification/*.md",
                        "exodus_inputs/*.md", "exodus_inputs/*.csv"):  # fmt: skip
        if name == "docs/theory/references.md":
            continue
        text = re.sub(r"\s*\n\s*(///?|\*|#)?\s*", " ", (SOURCE / name).read_text(errors="replace"))
        for who, *years in re.findall(r"([A-Z][A-Za-zéüöçšč-]+)(?: et al\.?)?,? \(?(1[789]\d\d|200\d|201\d)(?:, (1[789]\d\d))?\)?(?![\d.%])", text):
            if who not in ("Intel", "AMD"):
                lost += [f"{name}: {who} {year}" for year in years if year and not any(who in entry and year in entry for entry in entries)]
    assert not lost, "cited, but not in docs/theory/references.md:\n" + "\n".join(sorted(set(lost)))
    sets = re.findall(r"^\| `(\w+)` \| `\w+` \| \d", (SOURCE / "docs/user/materials.md").read_text(), flags=re.M)
    data = [*(f"`{name}`" for name in sets), *tracked("exodus_inputs/*.csv")]
    assert len(sets) > 10 and not (missing := [name for name in data if name not in page]), f"docs/theory/references.md has no origin of {missing}"


def check_trust():
    """The page of trust has a row for every law, form of element, law of joints and condition that decks know, and was made when the tests were those of today."""
    sys.path.insert(0, str(SOURCE / "tests/support"))
    import trust_page as maker

    page = maker.PAGE.read_text()
    assert maker.MARK in page, f"docs/trust.md lacks {maker.MARK}"
    head, made = page.split(maker.MARK)
    how = "python3 tests/support/trust_page.py <build folder>, after the tests have run there"
    schema = json.loads((SOURCE / "docs/schemas/deck.json").read_text())
    for group, words in maker.words_of(schema).items():
        for word in words:
            shown = re.search(rf"^\| (?:\w+, )?{word} \|", made, flags=re.M)
            assert shown, f"docs/trust.md is old: no row of the {group} {word}: {how}"
    data = json.loads(maker.DATA.read_text())
    assert made == maker.made(data, schema), f"docs/trust.md is not what tests/support/trust.json and the schema of decks give: {how}"
    gone = [test for test in data["tests"] if not maker.exists(test)]
    assert not gone, f"docs/trust.md is old: there are no tests {gone}: {how}"
    cases = {path.parent.name for path in (SOURCE / "tests/verification").glob("*/check.py")}
    ran = {test.split(".")[1] for test in data["tests"] if test.startswith("verification.")}
    skipped = {name for name in cases if "sys.exit(77)" in (SOURCE / f"tests/verification/{name}/check.py").read_text()}  # not in every build
    lost = sorted(cases - ran - maker.WITHOUT_RUNS - skipped)
    assert not lost, f"docs/trust.md is old: it does not know the cases {lost}: {how}"
    # What runs have is read from decks as they are.
    run = dict(dimension="plane", blocks=[["quadrilaterals, one_point", "j2"]], joints=["linear"], conditions=["fixed"], switches=["friction"], layout="1 rank, serial")
    data = maker.updated({"tests": {"parallel.memory": [[3, run]], "verification.gone": [[1, run]]}, "keys": {"mesh": "parallel.memory", "gravity": "verification.gone"}},
                         [("verification.V14_incline", run, {"title"}), ("verification.V14_incline", run, {"title"})])  # fmt: skip
    assert data["tests"] == {"parallel.memory": [[3, run]], "verification.V14_incline": [[2, run]]} and set(data["keys"]) == {"mesh", "title"}, data
    text = maker.made(data, schema)
    assert re.search(r"^\| j2 \| XB \| – \| – \|", text, flags=re.M) and "| linear | XB | – | – |" in text and "5 runs of 2 tests" in text, text[:3000]
    assert "- `gravity`" in text and "- `title`" not in text, text[-3000:]
    keys = set(maker.keys_of({"joints": {"mine": {"model": "table"}}, "conditions": [{"type": "fixed"}]}, schema))
    assert keys == {"joints", "joints.model", "joints.model: table", "conditions", "conditions.type", "conditions.type: fixed"}, keys


def check_tellings():
    """Meshes that are told otherwise have the same volume and the same sides; decks have the same numbers in other units and frames."""
    import numpy
    from coplanetest import meshes, rotation, turned_deck, units

    places = numpy.array([(x, y, z) for z in (0, 1.0) for y in (0, 1.0) for x in (0, 0.7, 2.0)])
    nodes = numpy.array([[0, 1, 4, 3, 6, 7, 10, 9], [1, 2, 5, 4, 7, 8, 11, 10]])
    solid = meshes.Mesh(places, [meshes.Block("a", 1, nodes)], {"left": numpy.array([0, 3, 6, 9])}, {"end": numpy.array([[1, 2]]), "top": numpy.array([[0, 6], [1, 6]])})
    flat = meshes.Mesh(places[:6, :2], [meshes.Block("a", 1, nodes[:, :4])], {"left": numpy.array([0, 3])}, {"end": numpy.array([[1, 2]])})

    def sizes(mesh):
        """Volume, and area of each side set as a vector, by triangles and tetrahedra about a point."""
        volume, areas = 0.0, {}
        for block in mesh.blocks:
            for element, row in enumerate(block.nodes):
                kind = mesh.dimension, len(row)
                middle = mesh.points[row].mean(axis=0)
                for number, side in enumerate(meshes.SIDES[kind], start=1):
                    p = mesh.points[row[list(side)]]
                    if mesh.dimension == 2:
                        area = numpy.array([p[1, 1] - p[0, 1], p[0, 0] - p[1, 0]])
                    else:
                        area = sum(numpy.cross(p[k] - p[0], p[k + 1] - p[0]) for k in range(1, len(p) - 1)) / 2
                    volume += float((p.mean(axis=0) - middle) @ area) / mesh.dimension
                    for name, members in mesh.side_sets.items():
                        if [element + mesh.first(block.name), number] in members.tolist():
                            areas[name] = areas.get(name, 0.0) + area
        return volume, areas

    for mesh in (solid, flat):
        volume, areas = sizes(mesh)
        assert abs(volume - 2) < 1e-14 and numpy.allclose(areas["end"], [1, 0, 0][: mesh.dimension]), (volume, areas)
        turn = rotation(17.3 if mesh.dimension == 2 else [17.3, -31.7, 23.9])
        told = {"turned": (meshes.moved(mesh, turn), turn), "mirrored": (meshes.moved(mesh, numpy.diag([-1.0, 1, 1])), numpy.diag([-1.0, 1, 1])),
                **{f.__name__: (f(*arguments), numpy.eye(3)) for f, *arguments in ((meshes.renumbered, mesh), (meshes.split, mesh), (meshes.refined, mesh, "a"), (meshes.cut, mesh, "a", 0, 2))}}  # fmt: skip
        for name, (other, matrix) in told.items():
            d = mesh.dimension
            size, sides = sizes(other)
            assert abs(size - volume) < 1e-13, f"{name}: volume {size}"
            assert all(numpy.allclose(sides[key], matrix[:d, :d] @ areas[key]) for key in areas), f"{name}: sides {sides}"
            here, there, weights = other.shares
            back = numpy.zeros_like(mesh.points)
            numpy.add.at(back, there[weights == 1], other.points[here[weights == 1]] @ matrix[:d, :d])
            count = numpy.bincount(there[weights == 1], minlength=len(back))
            assert numpy.allclose(back / count[:, None], mesh.points), f"{name}: nodes do not lead back"
            assert len(other.node_sets["left"]) >= len(mesh.node_sets["left"]), name
    # A pressure that depends on the place is the same at the same point of the body, wherever the frame has that.
    water = {"blocks": {}, "conditions": [{"type": "pressure", "side_set": "end", "value": "9810*(3 - y) + 7*x*z"}]}
    for matrix, offset in ((rotation([17.3, -31.7, 23.9]), (1000.0, -1000.0, 1000.0)), (numpy.diag([-1.0, 1, 1]), (0.0, 0.0, 0.0))):
        told = turned_deck(water, matrix, offset)["conditions"][0]["value"]
        for x, y, z in places:
            there = dict(zip("xyz", matrix @ numpy.array([x, y, z]) + offset))
            assert abs(eval(told, {}, there) - (9810 * (3 - y) + 7 * x * z)) < 1e-6, f"a pressure at {x, y, z}: {told}"
    slice = meshes.extruded(flat)
    assert abs(sizes(slice)[0] - 2) < 1e-14 and numpy.allclose(sizes(slice)[1]["end"], [1, 0, 0]), "extruded"

    assert units.powers("kg/m^3") == (-3, 0, 1) and units.powers("J/(kg K)") == (2, -2, 0) and units.powers("1/s") == (0, -1, 0)
    deck = {"materials": {"a": {"model": "linear_elastic", "density": 2000, "youngs_modulus": 1e9, "poisson_ratio": 0.2}}, "blocks": {"a": {"material": "a"}}, "gravity": [0, "-9.81*min(t/0.5, 1)", 0],
            "conditions": [{"type": "velocity", "node_set": "n", "value": ["2*t + x", 0, 0]}, {"type": "pressure", "side_set": "s", "value": 5.0}], "time": {"end": 2.0}}  # fmt: skip
    told = units.deck_in(deck, (1e3, 1e3, 1e3))
    card = told["materials"]["a"]
    assert numpy.allclose([card["density"], card["youngs_modulus"], card["poisson_ratio"], told["time"]["end"]], [2e-3, 1e3, 0.2, 2e3], rtol=1e-14, atol=0), told
    value = eval(told["conditions"][0]["value"][0], {"t": 3000.0, "x": 4000.0})  # at 3 s and 4 m: 10 m/s, which are 10 mm/ms
    assert abs(value - 10) < 1e-12 and abs(told["conditions"][1]["value"] - 5.0 * 1e3 / 1e3 / 1e6) < 1e-18, told["conditions"]
    quarter = numpy.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    told = turned_deck(deck, quarter, (7.0, 0, 0), (0.0, 0, 0))["conditions"][0]["value"]
    assert told[0] == 0.0 and abs(eval(told[1], {"t": 3.0, "x": 7.0, "y": 4.0}) - 10) < 1e-12, told  # x there is y here


def check_retold():
    """The cases that are told in other words are registered; every case once and every way of telling it twice are told without `slow`, but for cases that only `slow` tells."""
    sys.path.insert(0, str(SOURCE / "tests/metamorphic/retold"))
    from cases import CASES, UNTOLD
    from coplanetest import tellings

    text = (SOURCE / "tests/CMakeLists.txt").read_text()
    often, slow = (re.search(rf"set\({name} (.*?)\)", text, flags=re.S).group(1).split() for name in ("_retold", "_retold_slow"))
    assert sorted(often + slow) == sorted(CASES), f"tests/CMakeLists.txt: {sorted(set(often + slow) ^ set(CASES))}"
    assert [name for name in CASES if CASES[name].often] == [name for name in CASES if name in often], "cases without words that are told often are in _retold_slow"
    folders = [name for name in CASES if not (SOURCE / "tests/verification" / name).is_dir() and not (SOURCE / "exodus_inputs" / name).is_dir()]
    assert not folders, f"no verification cases or examples: {folders}"
    every = [path.parent.name for pattern in ("tests/verification/*/check.py", "exodus_inputs/*/example.yaml") for path in SOURCE.glob(pattern)]
    assert sorted([*CASES, *UNTOLD]) == sorted(every), f"told, or not told with a reason, in retold/cases.py: {sorted(set([*CASES, *UNTOLD]) ^ set(every))}"
    for word in [*tellings.WORDS, *tellings.WITH]:
        cases = [name for name, known in CASES.items() if any(told.split(":")[0] == word for told in known.often)]
        assert len(cases) >= 2, f"{word} is told of {cases} only"
    check_tellings()
    page = (SOURCE / "tests/metamorphic/README.md").read_text()
    missing = [word for word in [*tellings.WORDS, *tellings.WITH] if not re.search(rf"`{word}[`:]", page)]
    assert not missing, f"tests/metamorphic/README.md does not say what {missing} are"


def check_deck():
    """The deck reference is what the program prints."""
    printed = run([str(BINARIES / "coplane"), "--help-deck-markdown"])
    assert printed.returncode == 0, printed.stdout
    kept = (SOURCE / "docs/user/deck.md").read_text()
    assert printed.stdout == kept, "docs/user/deck.md is old: packages/cmake/write-references.sh"
    printed = run([str(BINARIES / "coplane_point"), "--help-deck-markdown"])
    kept = (SOURCE / "docs/user/point-deck.md").read_text()
    assert printed.stdout == kept, "docs/user/point-deck.md is old: packages/cmake/write-references.sh"


def check_recipe():
    """The reference of recipes is what the program prints."""
    printed = run([str(BINARIES / "coplane_mesh"), "--help-recipe-markdown"])
    assert printed.returncode == 0, printed.stdout
    kept = (SOURCE / "docs/user/recipe.md").read_text()
    assert printed.stdout == kept, "docs/user/recipe.md is old: packages/cmake/write-references.sh"


SCHEMAS = {
    "deck": ["coplane", "--schema"],
    "point-deck": ["coplane_point", "--schema"],
    "recipe": ["coplane_mesh", "--recipe-schema"],
    "joint-recipe": ["coplane_mesh", "--split-schema"],
    "blocks-recipe": ["coplane_mesh", "--blocks-schema"],
    "example": ["coplane_mesh", "--example-schema"],
}


def check_schemas():
    """The JSON Schemas are those that the programs print; every input file names one, and is as it says."""
    import jsonschema

    sys.path.insert(0, str(SOURCE / "tests/support"))
    from coplanetest import documents

    schemas = {}
    for name, (program, option) in SCHEMAS.items():
        printed = run([str(BINARIES / program), option])
        assert printed.returncode == 0, printed.stdout
        kept = (SOURCE / f"docs/schemas/{name}.json").read_text()
        assert printed.stdout == kept, f"docs/schemas/{name}.json is old: packages/cmake/write-references.sh"
        jsonschema.Draft7Validator.check_schema(json.loads(kept))
        schemas[name] = jsonschema.Draft7Validator(json.loads(kept))
    files = sorted((SOURCE / "exodus_inputs").glob("*/*.yaml"))
    assert files, "no input files found"
    wrong, used = [], set()
    for file in files:
        first = re.fullmatch(r"# yaml-language-server: \$schema=\.\./\.\./docs/schemas/([a-z-]+)\.json", file.read_text().splitlines()[0])
        if not first or first[1] not in schemas:
            wrong.append(f"{file}: the first line names no schema of docs/schemas")
            continue
        used.add(first[1])
        wrong += [f"{file}: {'.'.join(map(str, error.path))}: {error.message[:300]}" for error in schemas[first[1]].iter_errors(documents.load(file))]
    assert not wrong, "\n".join(wrong)
    assert used == set(schemas), f"no input file has the schemas {set(schemas) - used}"
    misspelt = documents.load(SOURCE / "exodus_inputs/bars_2d/mesh.yaml")
    misspelt["parts"][0]["divisons"] = misspelt["parts"][0].pop("divisions")
    assert not schemas["recipe"].is_valid(misspelt), "the schema of recipes accepts a misspelt key"


def check_codes():
    """The table of exit codes is what the program prints."""
    printed = run([str(BINARIES / "coplane"), "--help-codes"])
    assert printed.returncode == 0, printed.stdout
    kept = (SOURCE / "docs/user/exit-codes.md").read_text()
    assert printed.stdout in kept, "the table of docs/user/exit-codes.md is old: take that of build/bin/coplane --help-codes"


def check_links():
    """Relative links of all Markdown files lead to files of the project."""
    broken = []
    for name in tracked("*.md"):
        text = re.sub(r"```.*?```", "", (SOURCE / name).read_text(), flags=re.S)
        for target in re.findall(r"\]\(([^)#\s]+)", text):
            if "://" not in target and not ((SOURCE / name).parent / target).exists():
                broken.append(f"{name}: {target}")
    assert not broken, "\n".join(broken)


# What pages name as an example of the reader's own, or of another program.
NAMES_OF_OTHERS = {
    "NewLaw", "NewLawParameters", "NewParameters", "NewLaw.hpp", "NewLaw.cpp", "run_my_experiments.sh",
    "SideSets", "SideSetFields", "rock_tri3", "rock_quad4", "odls_base_sigkill_timeout",
}  # fmt: skip


def check_layout():
    """The top level holds what the project has there and nothing that a test or a person has left."""
    top = {name.split("/")[0] for name in tracked()}
    fixed = {"CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md", "apps", "docs", "exodus_inputs", "packages", "tests"}
    found = {name for name in top if not name.startswith(".")}
    assert found == fixed, f"at the top level: {sorted(found ^ fixed)}"


def check_names():
    """What pages name in `code` is there: files, functions and types, keys of decks, columns, options of programs."""
    files = tracked()
    basenames = {pathlib.PurePath(name).name for name in files}
    words, options = set(), set()
    for name in files:
        if re.search(r"\.(cpp|hpp|py|sh|cmake|txt|yaml|in)$", name) and not name.startswith(("docs/", "tests/documents/")):
            text = (SOURCE / name).read_text(errors="replace")
            words.update(re.findall(r"[A-Za-z_]\w*", text))
            options.update(re.findall(r"--[a-z][\w-]*", text))
    reference = "".join((SOURCE / page).read_text() for page in ("docs/user/deck.md", "docs/user/recipe.md"))
    keys = set(re.findall(r"^\| `(\w+)`", reference, flags=re.M))
    sections = re.findall(r"^## `(.*)`$", reference, flags=re.M)
    keys.update(part for section in sections for part in section.split("."))
    groups = {section.split(".")[0] for section in sections if ".<" not in section}

    def is_word(word):
        # Columns are put together: lower and _block, velocity and _x.
        parts = word.split("_")
        joined = any("_".join(parts[:i]) in words and "_" + "_".join(parts[i:]) in words for i in range(1, len(parts)))
        return word in words or joined

    wrong = []
    for page in tracked("*.md"):
        if page in ("docs/CHANGELOG.md", "docs/verification.md", "docs/validation.md"):  # of the past, of results
            continue
        text = re.sub(r"```.*?```", "", (SOURCE / page).read_text(), flags=re.S)
        for span in re.findall(r"(?<!`)`([^`\n]+)`(?!`)", text):
            if re.search(r"[<>*{}$…]|\.\.\.", span):
                continue
            named = [path for path in re.findall(r"[\w./-]+\.(?:cpp|hpp|py|sh|cmake)\b", span) if pathlib.PurePath(path).name not in basenames]
            named += [part for pair in re.findall(r"\b(?!std::|Kokkos::|Tpetra::|Zoltan2::)\w+::\w+\b", span) for part in pair.split("::") if part not in words]
            named += [word for word in re.findall(r"(?<![\w.-])(?:[a-z]+|[A-Z][a-z]+)[A-Z]\w*", span) if word not in words]
            named += [word for word in re.findall(r"(?<![\w-])--[a-z][\w-]*", span) if word not in options]
            named += [word for word in re.findall(r"(?<![\w/.-])[a-z]+(?:_[a-z0-9]+)+(?![\w/.-])", span) if not is_word(word)]
            if re.fullmatch(r"[a-z_]+(\.[a-z_]+)+", span) and span.split(".")[0] in groups and not span.endswith(".yaml"):
                named += [key for key in (span.split(".")[0], span.split(".")[-1]) if key not in keys]
            wrong += [f"{page}: `{span}`: no {word}" for word in named if word not in NAMES_OF_OTHERS]
    assert not wrong, "\n".join(wrong)


SEARCH = """
const found = {};
for (const words of WORDS) {
  const page = await show('/search.html?q=' + encodeURIComponent(words), 1200, 1600);
  const box = await until(() => page.getElementById('mkdocs-search-results').children.length && page.getElementById('mkdocs-search-results'));
  found[words] = box ? [...box.querySelectorAll('article a')].map(link => [link.getAttribute('href'), link.textContent]) : null;
}
return found;
"""


def check_search(site):
    """Typed into the search of the site in a browser, words lead to the pages of the manual, with the name of the page; other words to nothing."""
    first = {"search_every": ["./docs/user/deck.html#contact", "Deck reference: contact"], "restart": ["./docs/user/checkpoints.html#restart", "Checkpoints and restart: Restart"],
             "own problem": ["./docs/user/first-run.html#a-problem-of-your-own", "A first run: A problem of your own"]}  # fmt: skip
    found = browser.seen(site, SEARCH.replace("WORDS", json.dumps([*first, "friction", "blender"])))
    for words, entry in first.items():
        assert found[words][0] == entry, f"the search for {words}: {found[words][:3]}"
    assert ["./docs/user/deck.html#jointsname", "Deck reference: joints.<name>"] in found["friction"][:4], found["friction"][:4]
    assert found["blender"] == [], found["blender"]


def check_site():
    """The site has every page, every key, formulas and a search, and needs nothing from elsewhere; its maker finds links that lead nowhere."""
    specification = importlib.util.spec_from_file_location("make_site", SOURCE / "packages/cmake/make-site.py")
    maker = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(maker)
    site = pathlib.Path("site").absolute()
    shutil.rmtree(site, ignore_errors=True)
    done = run([sys.executable, maker.__file__, str(site)])
    assert done.returncode == 0, done.stdout[-3000:]
    sources = [name for name in tracked("*.md") if not name.startswith("docs/developer/pictures")]
    pages = [re.sub(r"README\.md$", "index.html", name).replace(".md", ".html") for name in sources]
    missing = [page for page in [*pages, "docs/keys.html", "search.html"] if not (site / page).exists()]
    assert not missing, f"pages that the site lacks: {missing}"
    found = {entry["location"]: entry["text"] for entry in json.loads((site / "search/search_index.json").read_text())["docs"]}
    for place, word in (("docs/user/deck.html#contact", "search_every"), ("docs/keys.html#from-a-to-z", "search_every"), ("docs/glossary.html#glossary", "remainder"),
                        ("docs/user/coming-from.html#ls-dyna", "MAT_JOHNSON_COOK"), ("docs/verification.html#v14-incline", "friction")):  # fmt: skip
        assert word in found[place], f"the search does not find {word} in {place}"
    if browser.chromium():
        check_search(site)
    else:
        print("the search was not tried: chromium is not installed (apt-get install chromium)")
    keys = (site / "docs/keys.html").read_text()
    lost = [key for file in maker.FILES for names in maker.groups_of(file).values() for key in names if f"<code>{key}</code>" not in keys]
    assert not lost, f"keys that docs/keys.html lacks: {lost}"
    theory = (site / "docs/theory/scp.html").read_text()
    assert theory.count('class="arithmatex"') > 90 and "auto-render.js" in theory, "formulas are lost"
    assert r"c_{\max}" in (site / "docs/theory/joints.html").read_text(), "KaTeX cannot read an index \\max without braces"
    elsewhere = [link for link in re.findall(r'<(?:script|img)[^>]*src="([^"]*)"|<link[^>]*href="([^"]*)"', theory) if "//" in "".join(link)]
    assert not elsewhere, elsewhere
    with open(site / "docs/user/deck.html", "a") as page:
        page.write('<a href="nowhere.html"></a><a href="decks.html#nothing"></a>')
    assert maker.dead_links(site) == ["docs/user/deck.html: nowhere.html", "docs/user/deck.html: decks.html#nothing: no such heading"]
    os.makedirs("mine", exist_ok=True)
    pathlib.Path("mine/notes.txt").write_text("mine")
    done = run([sys.executable, maker.__file__, "mine"])
    assert done.returncode == 1 and "no site" in done.stdout and os.listdir("mine") == ["notes.txt"], done.stdout


def readme_commands():
    text = (SOURCE / "README.md").read_text()
    return [line for block in re.findall(r"```bash\n(.*?)```", text, flags=re.S) for line in block.splitlines() if line]


def check_readme():
    """Every command of the README runs. The main job runs for its first 0.3 ms here, without pictures (the test paper.bar_wall_3d.S runs
    all of it); the test command is the one that runs this test."""
    folder = pathlib.Path("readme").absolute()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for name in ("exodus_inputs", "packages"):
        (folder / name).symlink_to(SOURCE / name)
    (folder / "build").symlink_to(BUILD)
    environment = dict(os.environ, PWD=str(folder))
    for command in readme_commands():
        if command == "packages/cmake/run-tests.sh":
            assert os.access(SOURCE / command, os.X_OK)
            continue
        if command == "packages/cmake/main-job.sh":
            command = f"bash {SOURCE}/{command} --no-pictures --end 3e-4 --folder {folder}/main-job"
        done = run(["bash", "-euc", command], cwd=folder, env=environment)
        print(f"$ {command}\n{done.stdout[-1500:]}")
        assert done.returncode == 0, f"exit code {done.returncode}: {command}"
    for name in ("bars.e", "bars.csv", "bars.run.json", "bars_planes.vtkhdf", "bars_planes.xmf3", "main-job/run.e", "main-job/run.csv"):
        assert (folder / name).stat().st_size > 0, name


# Numbers with a point or an exponent may be off in the last digits where a compiler or a library is another one.
NUMBER = r"(?<![\w.])[-+]?\d+(?:\.\d+(?:e[-+]?\d+)?|e[-+]?\d+)"
ELAPSED = r"after \d+ s"


def is_as_printed(quoted, printed):
    """Whether a line of a page is one that was printed; one that ends with ... need only begin like it."""
    quoted, printed = (re.sub(ELAPSED, "after", line) for line in (quoted, printed))
    begins, end = (quoted[:-3], ".*") if quoted.endswith("...") else (quoted, "")
    found = re.fullmatch(f"({NUMBER})".join(map(re.escape, re.split(NUMBER, begins))) + end, printed)
    numbers = map(float, re.findall(NUMBER, quoted))
    return bool(found) and all(abs(float(value) - number) <= 1e-3 * abs(number) for value, number in zip(found.groups(), numbers))


def lost_line(quoted, printed):
    """The first of the quoted lines that does not follow the one before in what was printed, where ... stands for any lines; or None."""
    anywhere = True
    for line in quoted:
        if line.strip() == "...":
            anywhere = True
            continue
        at = next((i for i, candidate in enumerate(printed if anywhere else printed[:1]) if is_as_printed(line, candidate)), None)
        if at is None:
            return line
        printed, anywhere = printed[at + 1:], False
    return None


def check_output():
    """Blocks of output in pages are what the commands in the block before them print."""
    printed = ["after 7 s: 1.0000e+00 J, 3 planes", "  a", "  b", "  gaps 5.176e-03, 9"]
    assert lost_line(["after 1 s: 1.0005e+00 J, 3 planes", "...", "  gaps 5.176e-03, ..."], printed) is None
    for wrong in (["after 1 s: 1.0020e+00 J, 3 planes"], ["after 1 s: 1.0000e+00 J, 4 planes"], ["  a", "  gaps 5.176e-03, 9"], ["  gaps 5.176e-03"]):
        assert lost_line(wrong, printed) == wrong[-1], wrong
    folder = pathlib.Path("output").absolute()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    (folder / "exodus_inputs").symlink_to(SOURCE / "exodus_inputs")
    environment = dict(os.environ, PWD=str(folder), PATH=f"{BINARIES}:{os.environ['PATH']}")
    for page, blocks in (("first-run", 5), ("joint-paths", 1)):
        text = (SOURCE / f"docs/user/{page}.md").read_text()
        pairs = re.findall(r"```(?:bash|sh)\n([^`]*)```(?:(?!```).)*?```text\n(.*?)```", text, flags=re.S)
        assert len(pairs) == blocks == text.count("```text\n"), f"{page}.md: blocks of output without a block of commands before them"
        for commands, quoted in pairs:
            done = run(["bash", "-euc", commands], cwd=folder, env=environment)
            assert done.returncode == 0, f"{page}.md: exit code {done.returncode}: {commands}\n{done.stdout[-3000:]}"
            line = lost_line(quoted.splitlines(), done.stdout.splitlines())
            assert line is None, f"{page}.md says\n{line}\nand the commands before it print\n{done.stdout[-6000:]}"
    # The problem that begins with an empty folder.
    inputs = re.findall(r"```yaml\n(.*?)```", (SOURCE / "docs/user/first-run.md").read_text(), flags=re.S)
    assert len(inputs) == 2, "first-run.md: a recipe and a deck"
    for name, text in zip(("mesh.yaml", "stones.yaml"), inputs):
        (folder / name).write_text(text)
    done = run(["bash", "-euc", "coplane_mesh make mesh.yaml -o mesh.e && coplane stones.yaml --set time.end=0.011 --backend serial"], cwd=folder, env=environment)
    assert done.returncode == 0 and "WARNING" not in done.stdout, done.stdout[-3000:]


def check_install():
    """The install target gives a package that another project finds, links and runs, and examples that run."""
    prefix = pathlib.Path("prefix").absolute()
    for folder in (prefix, pathlib.Path("user-build")):
        shutil.rmtree(folder, ignore_errors=True)
    done = run(["cmake", "--install", str(BUILD), "--prefix", str(prefix)])
    assert done.returncode == 0, done.stdout[-3000:]
    done = run(["cmake", "-S", str(SOURCE / "tests/package/user"), "-B", "user-build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}"])
    assert done.returncode == 0, done.stdout[-3000:]
    done = run(["cmake", "--build", "user-build"])
    assert done.returncode == 0, done.stdout[-3000:]
    printed = run(["user-build/user"]).stdout
    assert printed.split()[1:] == ["6"], printed
    assert not list(prefix.glob("include/*/detail")), "headers of a package alone are installed"
    version = run([str(prefix / "bin/coplane"), "--version"])
    assert version.returncode == 0 and version.stdout.startswith("coplane "), version.stdout

    # The Python package and its programs, from there.
    done = run([sys.executable, "-c", "import coplane; print(coplane.__file__, coplane.program.binary('coplane'), coplane.program.schema('deck').exists())"],
               env=dict(os.environ, PYTHONPATH=str(prefix / "share/coplane/python"), COPLANE_BIN=""))
    assert done.stdout.split() == [str(prefix / "share/coplane/python/coplane/__init__.py"), str(prefix / "bin/coplane"), "True"], done.stdout

    # An example runs and is checked with what is installed: the programs, run.py and its modules.
    shutil.rmtree("coplane-examples", ignore_errors=True)
    alone = {name: value for name, value in os.environ.items() if name not in ("COPLANE_BIN", "COPLANE_SOURCE", "PYTHONPATH")}
    tool = prefix / "share/coplane/exodus_inputs/run.py"
    done = run([sys.executable, str(tool), "rocking_block_2d", "--size", "coarse", "--no-pictures"], env=alone)
    assert done.returncode == 0, done.stdout[-3000:]
    assert str(SOURCE) not in done.stdout.replace(os.getcwd(), ""), done.stdout[-3000:]
    checks = pathlib.Path("coplane-examples/rocking_block_2d/coarse/checks.jsonl").read_text().splitlines()
    assert checks and all(json.loads(line)["passed"] for line in checks), checks
    done = run([str(prefix / "bin/coplane"), "report", "coplane-examples/rocking_block_2d/coarse", "--no-pictures", "-o", "installed.html"], env=alone)
    assert done.returncode == 0 and pathlib.Path("installed.html").stat().st_size > 1e6, done.stdout
    done = run([str(prefix / "bin/coplane"), "watch", "coplane-examples/rocking_block_2d/coarse"], env=alone)
    assert done.returncode == 0 and "completed, exit code 0" in done.stdout, done.stdout
    shutil.rmtree("made", ignore_errors=True)
    done = run([str(prefix / "bin/coplane"), "new", "made/bars", "--like", "bars_2d"], env=alone)
    assert done.returncode == 0 and str(tool) in done.stdout, done.stdout
    done = run([str(prefix / "bin/coplane"), "made/bars/bars.yaml", "--check"], env=alone)
    assert done.returncode == 0, done.stdout


if __name__ == "__main__":
    globals()[f"check_{sys.argv[1]}"]()
