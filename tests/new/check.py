"""`coplane new` for every example, and run.py on folders anywhere (README.md)."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import jsonschema

from coplanetest import Case, documents, program

import coplane
from coplane import new

SOURCE = pathlib.Path(os.environ["COPLANE_SOURCE"])
RUN = [sys.executable, str(SOURCE / "exodus_inputs/run.py")]
# Those with few elements; `coplane --check` on the others takes seconds each.
CHECKED = ["bars_2d", "cut_rock_2d", "perforation", "penetration", "rocking_block_2d"]
case = Case("new", __file__)


def called(command, folder=".", env=None):
    done = subprocess.run(list(map(str, command)), cwd=folder, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return done.returncode, done.stdout


def made(*arguments):
    """Runs `coplane new`."""
    return called([program.binary("coplane"), "new", *arguments], place)


def wrong(file):
    """What its schema, which its first line names, finds in an input file."""
    schema = re.fullmatch(r"# yaml-language-server: \$schema=(/.*)", file.read_text().splitlines()[0])
    return [f"{file.name}: {error.message}" for error in jsonschema.Draft7Validator(documents.load(schema[1])).iter_errors(documents.load(file))]


def in_default_size(example):
    """Recipe and deck of an example as run.py runs them in its default size."""
    source = SOURCE / "exodus_inputs" / example
    settings = documents.load(source / "example.yaml")
    size = settings["sizes"][settings.get("default", next(iter(settings["sizes"])))] or {}
    found = [documents.load(source / settings.get(key, f"{other}.yaml")) for key, other in (("recipe", "mesh"), ("deck", "deck"))]
    for document, key in zip(found, ("mesh", "set")):
        for path, value in (size.get(key) or {}).items():
            documents.change(document, path, value)
    return found


scratch = tempfile.TemporaryDirectory(prefix="my own ", ignore_cleanup_errors=True)
place = pathlib.Path(scratch.name)
for example in new.examples():
    folder = place / f"like-{example[:3]}"
    shutil.rmtree(folder, ignore_errors=True)
    code, said = made(folder, "--like", example)
    if not case.check_equal(f"{example}: exit code", code, 0):
        print(said)
        continue
    texts = {path.name: path.read_text() for path in folder.iterdir() if path.suffix != ".e"}
    case.check_equal(f"{example}: files that name it, or others outside", [name for name, text in texts.items() if example in text or re.search(r"\.\./[a-z]", text)], [])
    case.check_equal(f"{example}: against the schemas", [text for name in texts if name.endswith(".yaml") for text in wrong(folder / name)], [])
    recipe, deck = in_default_size(example)
    settings = documents.load(folder / "example.yaml")
    case.check_equal(f"{example}: recipe and deck are those of its default size",
                     (documents.load(folder / settings["recipe"]), documents.load(folder / settings["deck"])), (recipe, {**deck, "mesh": "mesh.e"}))  # fmt: skip
    case.check_equal(f"{example}: example.yaml changes nothing", ([*settings["sizes"].values()], "variants" in settings), ([{}], False))
    case.check_equal(f"{example}: other input files", [name for name in texts if name.endswith(".yaml")],
                     [name for name in texts if name in ("example.yaml", settings["recipe"], settings["deck"], settings.get("joints"))])  # fmt: skip
    case.check_equal(f"{example}: check", (folder / "check.py").exists(), True)
    if example not in CHECKED:
        continue
    code, said = called([program.binary("coplane"), folder / f"{folder.name}.yaml", "--check"])
    case.check_equal(f"{example}: coplane --check", (code, "check: deck and mesh are fine" in said), (0, True))

# --- what it says, and refuses ---------------------------------------------------------------------------

code, said = made("bars", "--like", "bars_2d")
case.check_equal("made: it says how to run it", [word for word in ("coplane bars/bars.yaml", "run.py bars", "mesh.yaml -o bars/mesh.e") if word not in said], [])
before = {path.name: path.read_bytes() for path in (place / "bars").iterdir()}
code, said = made("bars", "--like", "arch_2d")
case.check_equal("there already", (code, "is there already" in said, {path.name: path.read_bytes() for path in (place / "bars").iterdir()} == before), (2, True, True))
for arguments, words in (
    ((), ["NAME and --like EXAMPLE missing", "  bars_2d "]),
    (("x", "--like", "bars_2d", "--size", "XL"), ["no such size", "it has S"]),
    (("x",), ["--like EXAMPLE missing", "  bars_2d ", "a bar hits another one"]),
    (("x", "--like", "rocking_block"), ["Did you mean rocking_block_2d?", "  explosion_3d "]),
    (("x", "--like", "../tests"), ["no such example"]),
    (("2 x", "--like", "bars_2d"), ["a letter first"]),
    (("mesh", "--like", "bars_2d"), ["Choose another name"]),
):
    code, said = made(*arguments)
    case.check_equal(f"new {' '.join(arguments)}", (code, [word for word in words if word not in said]), (2, []))
case.check_equal("refused: nothing was made", [name for name in ("x", "2 x", "mesh") if (place / name).exists()], [])
case.check_equal("a folder that cannot be made", made("bars/bars.yaml/x", "--like", "bars_2d")[0], 5)

# As it says, beside the folder; then the folder means this run, and after a run in it that one.
code, said = called([program.binary("coplane"), "bars/bars.yaml", "--set", "time.end=1e-6"], place)
case.check_equal("a run beside its folder: exit code", code, 0)
one = coplane.open(place / "bars")
case.check_equal("a run beside its folder, by the name of both", (str(one.folder), one.name), (str(place), "bars"))
case.check_equal("watch", called([program.binary("coplane"), "watch", "bars"], place)[0], 0)

# --- scripts of examples, in the copies --------------------------------------------------------------------

bare = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
for example, name, size, scripts in (
    ("rock_slope_2d", "slope", "coarse", [("safety.py", ["safe", 1], "| 1 | 0.9")]),
    ("shaken_stones_2d", "stones", "coarse", [("motion.py", [], ""), ("survival.py", ["survive", 0.5], "| 0.5 |")]),
):
    made(name, "--like", example, "--size", size)
    before = documents.load(place / name / f"{name}.yaml")
    for script, arguments, words in scripts:
        code, said = called([place / name / script, *arguments], place, env=bare)
        if not case.check_equal(f"{name}/{script}: exit code, what it says", (code, words in said), (0, True)):
            print(said)
    case.check_equal(f"{name}: the deck says the same", documents.load(place / name / f"{name}.yaml"), before)
text = (place / "stones/stones.yaml").read_text()
(place / "stones/stones.yaml").write_text(re.sub(r"times: \[[^]]*\]", "times: [0, 1]", text))
called([place / "stones/motion.py"], place, env=bare)
case.check_equal("motion.py wrote into the deck of its folder", documents.load(place / "stones/stones.yaml"), documents.parse(text))

# --- run.py on folders outside the tree --------------------------------------------------------------------

code, said = called([*RUN, "bars", "--no-pictures", "--set", "time.end=5e-4"], place)
case.check_equal("run.py: exit code", code, 0)
results = place / "bars/runs/S"
checks = [json.loads(line) for line in (results / "checks.jsonl").read_text().splitlines()]
case.check_equal("run.py: checks, results", (len(checks) > 5 and all(line["passed"] for line in checks), (results / "run.e").exists()), (True, True))
alone = place / "alone"
alone.mkdir()
shutil.copy(place / "bars/bars.yaml", alone / "deck.yaml")
code, said = called([*RUN, alone, "--no-pictures"])
case.check_equal("run.py without a recipe", (code, "mesh.yaml, the recipe of alone, is not there" in said), (1, True))
shutil.copy(place / "bars/mesh.yaml", alone)
code, said = called([*RUN, ".", "--no-pictures", "--set", "time.end=1e-5"], alone)
case.check_equal("run.py on a deck and a recipe", (code, (alone / "runs/S/run.csv").exists()), (0, True))
made("rocks", "--like", "rocking_block_2d", "--size", "coarse")
mine = coplane.Deck.read(place / "rocks/rocks.yaml")
case.check_equal("another size", mine["time.end"], 0.5)
mine["time.end"] = 1e-3
mine.write(place / "rocks/rocks.yaml")
code, said = called([*RUN, "rocks", "--no-pictures", "--no-check"], place)
run = documents.load(place / "rocks/runs/coarse/run.yaml")
case.check_equal("run.py: the deck of a new folder is not changed", (code, "example.yaml changes" in said, run),
                 (0, False, documents.load(place / "rocks/rocks.yaml")))  # fmt: skip
(place / "rocks/example.yaml").write_text("title: rocks\ndeck: rocks.yaml\nsizes:\n  S: {set: {time.end: 2e-3}, mesh: {parts.1.rotate: -3}}\n")
code, said = called([*RUN, "rocks", "--no-pictures", "--no-check", "--ranks", 1], place)
case.check_equal("run.py: what example.yaml changes is told", (code, [word for word in ("example.yaml changes rocks.yaml: time.end: 0.002", "mesh.yaml: parts.1.rotate: -3") if word not in said]),
                 (0, []))  # fmt: skip
code, said = called([*RUN, "bars", "--set", "blocks.lfet.rigid=true", "-o", place / "misspelt"], place)
case.check_equal("run.py: a card that the deck has not", (code, "blocks.lfet.rigid: the deck has no blocks.lfet; it has left, right." in said, (place / "misspelt").exists()),
                 (1, True, False))  # fmt: skip
for name, gone, words in (
    ("a copy beside its tools", None, ["package coplane is not", "packages/python", "PYTHONPATH", "coplane new"]),
    ("a copy alone", "coplanetools", ["package coplanetools is not", "exodus_inputs", "PYTHONPATH"]),
):
    shutil.copytree(SOURCE / "exodus_inputs/coplanetools", place / "copy/coplanetools", dirs_exist_ok=True)
    shutil.copy(SOURCE / "exodus_inputs/run.py", place / "copy")
    if gone:
        shutil.rmtree(place / "copy" / gone)
    code, said = called([sys.executable, place / "copy/run.py", "--list"], env=bare)
    case.check_equal(f"run.py: {name}", (code, [word for word in words if word not in said], "python3-numpy" in said), (1, [], False))
(place / "without").mkdir()
(place / "without/netCDF4.py").write_text("raise ModuleNotFoundError('taken away', name='netCDF4')\n")
code, said = called([*RUN, "--list"], env={**bare, "PYTHONPATH": str(place / "without")})
case.check_equal("run.py: names the package that is missing", (code, "Install python3-netcdf4" in said, "python3-numpy" in said), (1, True, False))
code, said = called([*RUN, "nothing"], place)
case.check_equal("run.py: no such folder", (code, [word for word in ("no example 'nothing'", "bars_2d", "coplane new") if word not in said]), (1, []))
case.finish()
