"""`coplane pictures`: states, strips, films, comparisons and vector graphics of runs, looked at as images (README.md)."""

import pathlib
import re
import shutil
import subprocess
import sys

import numpy
from coplanetest import Case, documents, program
from PIL import Image

import coplane
from coplane import pictures

case = Case("pictures", __file__)
missing = program.missing_for_pictures() + [name for name in ("ffmpeg", "ffprobe") if not shutil.which(name)]
if missing:
    sys.exit(f"this test needs {', '.join(missing)}: packages/cmake/dependencies.sh --with-paraview")
steel = {"model": "linear_elastic", "density": 8000, "youngs_modulus": 200e9, "poisson_ratio": 0.3}


def boxes(dimension):
    size = [0.5, 0.1, 0.1][:dimension]
    return {"dimension": dimension, "parts": [{"shape": "box", "block": name, "min": [x, 0, 0][:dimension], "size": size, "divisions": [10, 2, 2][:dimension]}
                                              for name, x in (("left", 0), ("right", 0.5))]}  # fmt: skip


def deck(speed):
    return {"materials": {"steel": steel}, "blocks": {name: {"material": "steel"} for name in ("left", "right")},
            "initial": [{"block": "left", "velocity": [speed, 0, 0]}], "time": {"end": 1e-4}, "output": {"every": 2e-5},
            "checkpoint": {"at_end": True}}  # fmt: skip


flat, space = case.attempt("flat", boxes(2), deck(2)), case.attempt("space", boxes(3), {**deck(2), "output": {"every": 2e-5, "planes_format": "vtkhdf"}})
other = case.attempt("other", boxes(2), deck(1))
for run in (flat, space, other):
    if run.code:
        sys.exit(run.output)
# A second part of the results: what draws has to see both.
documents.save({"mesh": "mesh.e", **deck(2), "time": {"end": 2e-4}}, pathlib.Path(flat.folder) / "run.yaml")
subprocess.run([program.binary("coplane"), "run.yaml", "--restart", "--quiet"], cwd=flat.folder, check=True)
steps = len(coplane.open(flat.folder).results.times)
shutil.rmtree("drawn", ignore_errors=True)
pathlib.Path("drawn").mkdir()


def draw(*words):
    done = subprocess.run([program.binary("coplane"), "pictures", *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return done.returncode, done.stdout.strip()


def drawn(what, *words):
    """The files that are told of."""
    code, said = draw(*words)
    if not case.check_equal(f"{what}: exit code", code, 0):
        sys.exit(said)
    return said.splitlines()


def seen(path):
    return numpy.asarray(Image.open(path).convert("RGB")).astype(int)


# --- a state: its size, what is on it, and its scale ----------------------------------------------------------------
files = drawn("states", flat.folder, "-o", "drawn", "--color", "velocity", "--times", "0", "2e-4", "--size", "900", "600")
case.check_equal("states: files", [re.sub(r"_\d+us", "", pathlib.Path(name).name) for name in files], ["run_state_0000.png", "run_state_0001.png"])
first, last = map(seen, files)
case.check_equal("states: size", last.shape, (600, 900, 3))
case.check_equal("states: the bodies of the last are not those of the first", bool((first[290:310] != last[290:310]).any()), True)
body = numpy.flatnonzero((last[290:310] < 240).any(axis=(0, 2)))
black = numpy.flatnonzero((last[575:590, :400] < 60).all(axis=2).any(axis=0))
words = 0.2  # a fifth of what is seen across, rounded down to 1, 2 or 5: 200 mm
case.check_within("states: scale bar over bodies, 0.2 m over 1 m", numpy.ptp(black) / numpy.ptp(body), 0.97 * words, 1.03 * words)
colors = {tuple(color) for color in last[290:310].reshape(-1, 3)}
case.check_within("states: colours on the bodies", len(colors), 10, 10000)

again = [str(path) for path in pictures.draw(coplane.open(flat.folder), "drawn", times=[0], size=(300, 200))]
case.check_equal("states again, into the same folder: files", [pathlib.Path(name).name for name in again], ["state_0000_000000us.png"])
pictures.draw(coplane.open(flat.folder), "drawn", times=[0], size=(300, 200))

# --- strip, comparison, film ---------------------------------------------------------------------------------------------
(strip,) = drawn("strip", flat.folder, "-o", "drawn", "--steps", "3", "--strip", "2", "--size", "300", "200")
image = seen(strip)
case.check_equal("strip: two columns, two rows, the last place empty", (image.shape, bool((image[200:, 300:] == 255).all())), ((400, 600, 3), True))
(pair,) = drawn("comparison", flat.folder, "--compare", other.folder, "-o", "drawn", "--times", "8e-5", "--color", "von_mises", "--size", "400", "300")
image = seen(pair)
case.check_equal("comparison: size", image.shape, (300, 800, 3))
case.check_equal("comparison: the halves differ in the bodies", bool((image[140:160, :400] != image[140:160, 400:]).any()), True)
(film,) = drawn("gif", flat.folder, "--animation", "drawn/run.gif", "--size", "240", "160")
case.check_equal("gif: a frame for each step of both parts", (Image.open(film).n_frames, steps > 8), (steps, True))
(film,) = drawn("mp4 in space", space.folder, "--animation", "drawn/run.mp4", "--planes", "arrows", "--camera", "iso", "--steps", "3", "--size", "241", "161")
told = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames,width,height", "-of", "csv=p=0", film],
                      stdout=subprocess.PIPE, text=True).stdout.strip()  # fmt: skip
case.check_equal("mp4: width, height, frames", told, "240,160,3")

# --- vector graphics ----------------------------------------------------------------------------------------------------------
for name, color, there in (("by_block.svg", "block", ["left", "right"]), ("by_stress.svg", "von_mises", ["von_mises [Pa]"])):
    (path,) = drawn(name, flat.folder, "--vector", f"drawn/{name}", "--color", color, "--times", "2e-4")
    text = pathlib.Path(path).read_text()
    said = re.findall(r"<!-- (.*?) -->", text)  # matplotlib writes the words of letters that it draws
    case.check_equal(f"{name}: words", [word for word in [*there, "x [m]", "t = 0.20"] if not any(one.startswith(word) for one in said)], [])
    case.check_within(f"{name}: polygons", len(re.findall(r"<(?:path|use)\b", text)), 40, 10000)
pictures.vector(coplane.open(flat.folder), "drawn/run.pdf")
case.check_equal("pdf", pathlib.Path("drawn/run.pdf").read_bytes().startswith(b"%PDF-"), True)

# --- what is refused ----------------------------------------------------------------------------------------------------------
for what, words, told in (("a variable", [flat.folder, "--color", "stresss"], ["no variable 'stresss'", "von_mises"]),
                          ("a block", [flat.folder, "--blocks", "middle"], ["no block 'middle'", "left, right"]),
                          ("a strip", [flat.folder, "--strip", "0"], ["--strip: '0'; accepted: whole numbers from 1 on"]),
                          ("a kind of film", [flat.folder, "--animation", "a.avi"], ["a.avi", ".mp4 or .gif"]),
                          ("a folder", [flat.folder, "--vector", "nowhere/a.svg"], ["no folder nowhere"]),
                          ("vector graphics in space", [space.folder, "--vector", "a.svg"], ["two dimensions"]),
                          ("a run", ["nobody"], ["there is no run of this name"])):  # fmt: skip
    code, said = draw(*words)
    case.check_equal(f"{what}: refused with these words", (code, [word for word in told if word not in said]), (2, []))
case.finish()
