"""`coplane pictures`: states, strips, films, comparisons and vector graphics of runs, looked at as images (README.md)."""

import json
import os
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
whole = "all" in sys.argv[1:]  # ParaView starts for nearly every picture
missing = program.missing_for_pictures() + [name for name in ("ffmpeg", "ffprobe") if not shutil.which(name)]
if missing:
    sys.exit(f"this test needs {', '.join(missing)}: packages/cmake/dependencies.sh --with-paraview")
steel = {"model": "linear_elastic", "density": 8000, "youngs_modulus": 200e9, "poisson_ratio": 0.3}


def boxes(dimension, names=("left", "right")):
    size = [0.5, 0.1, 0.1][:dimension]
    return {"dimension": dimension, "parts": [{"shape": "box", "block": name, "min": [x, 0, 0][:dimension], "size": size, "divisions": [10, 2, 2][:dimension]}
                                              for name, x in zip(names, (0, 0.5))]}  # fmt: skip


def deck(speed, names=("left", "right")):
    return {"materials": {"steel": steel}, "blocks": {name: {"material": "steel"} for name in names},
            "initial": [{"block": names[0], "velocity": [speed, 0, 0]}], "time": {"end": 1e-4}, "output": {"every": 2e-5},
            "checkpoint": {"at_end": True}}  # fmt: skip


flat, space = case.attempt("flat", boxes(2), deck(2)), case.attempt("space", boxes(3), {**deck(2), "output": {"every": 2e-5, "planes_format": "vtp"}})
other = case.attempt("other", boxes(2), deck(1))
renamed = case.attempt("renamed", boxes(2, ("striker", "target")), deck(1, ("striker", "target")))
for run in (flat, space, other, renamed):
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
if whole:
    pictures.draw(coplane.open(flat.folder), "drawn", times=[0], size=(300, 200))

# --- strip, comparison, film ---------------------------------------------------------------------------------------------
(strip,) = drawn("strip", flat.folder, "-o", "drawn", "--steps", "3", "--strip", "2", "--size", "300", "200")
image = seen(strip)
case.check_equal("strip: two columns, two rows, in the last place only names", (image.shape, bool((image[200:260, 300:] < 160).any()), bool((image[260:, 300:] == 255).all())),
                 ((400, 600, 3), True, True))
# Of a body that is as wide as the picture nothing is hidden: the bar stands beside it, in each picture within its size, in a strip beside the last.
for what, words, width in (("wide body, colour bar beside it", [], 480), ("wide body, strip", ["--strip", "2"], 585))[: 2 if whole else 1]:
    (file,) = drawn(what, flat.folder, "-o", "drawn", "--times", "2e-4", "--color", "velocity", "--size", "480", "160", "--window", "0", "1", "-0.1", "0.2", "--no-edges",
                    "--planes", "none", "--name", "wide", *words)  # fmt: skip
    image = seen(file)
    white = numpy.flatnonzero((image > 250).all(axis=(0, 2)))  # columns with nothing on them
    left, right = image[:, : white[0]], image[:, white[0] :]
    colors_right = (right.max(axis=2) - right.min(axis=2) > 40).any(axis=0).sum()
    case.check_equal(f"{what}: width of the picture", image.shape[1], width)
    case.check_within(f"{what}: columns of the body, then white, then a bar", int(white[0]), width - 107, width - 103)
    case.check_within(f"{what}: columns of the bar", int(colors_right), 6, 20)
(pair,) = drawn("comparison", flat.folder, "--compare", other.folder, "-o", "drawn", "--times", "8e-5", "--color", "von_mises", "--size", "400", "300")
image = seen(pair)
case.check_equal("comparison: size", image.shape, (300, 800, 3))
case.check_equal("comparison: the halves differ in the bodies", bool((image[140:160, :400] != image[140:160, 400:]).any()), True)
# Mirrored at x = 0: dots in colours of the planes lie at both seams.
(file,) = drawn("planes, mirrored", flat.folder, "-o", "drawn", "--times", "8e-5", "--planes", "normal_traction", "--mirror", "--size", "480", "200", "--no-edges")
image = seen(file)[:, :370]
body = numpy.flatnonzero((image[90:110] < 252).any(axis=(0, 2)))
dots = numpy.flatnonzero((numpy.ptp(image[80:120], axis=2) > 60).any(axis=0))
middle = (body[0] + body[-1]) / 2
case.check_equal("planes, mirrored: dots on both sides", [bool((dots < middle).any()), bool((dots > middle).any())], [True, True])
if len(dots):
    case.check("planes, mirrored: both are as far from the middle", float(dots.min() + dots.max()) / 2, float(middle), 3)
for color in ("block", "von_mises")[: 2 if whole else 1]:  # blocks of other names are drawn, too
    (pair,) = drawn(f"blocks of other names by {color}", flat.folder, "--compare", renamed.folder, "-o", "drawn", "--times", "8e-5", "--color", color, "--size", "400", "300",
                    "--planes", "none")  # fmt: skip
    image = seen(pair)
    widths = [int((half[140:160, :250] < 250).any(axis=(0, 2)).sum()) for half in (image[:, :400], image[:, 400:])]
    case.check_within(f"blocks of other names by {color}: bodies of the first", widths[0], 100, 250)
    case.check_within(f"blocks of other names by {color}: bodies of the other, as wide as these", widths[1], widths[0] - 3, widths[0] + 3)
(film,) = drawn("gif", flat.folder, "--animation", "drawn/run.gif", "--size", "240", "160")
case.check_equal("gif: a frame for each step of both parts", (Image.open(film).n_frames, steps > 8), (steps, True))
(film,) = drawn("mp4 in space", space.folder, "--animation", "drawn/run.mp4", "--planes", "arrows", "--camera", "iso", "--steps", "3", "--size", "241", "161")
told = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames,width,height", "-of", "csv=p=0", film],
                      stdout=subprocess.PIPE, text=True).stdout.strip()  # fmt: skip
case.check_equal("mp4: width, height, frames", told, "240,160,3")

# --- cameras and arrows ----------------------------------------------------------------------------------------------------
# A body of three blocks: its middle is grey at x < 0, and beside that a block stands out along each axis. Which blocks are seen, and on which side,
# tells where the camera stands: (right of, above, before) the others.
def block(name, low):
    return {"shape": "box", "block": name, "min": low, "size": [1, 1, 1], "divisions": [1, 1, 1]}


COLORS = {"middle": (115, 133, 153), "along_x": (217, 184, 140), "along_y": (143, 173, 128), "along_z": (191, 128, 117)}  # of draw_run.py, 0 to 255
corner = case.attempt("corner", {"dimension": 3, "parts": [block("middle", [0, 0, 0]), block("along_x", [1, 0, 0]), block("along_y", [0, 1, 0]),
                                                           block("along_z", [0, 0, 1])]},
                      {"materials": {"steel": steel}, "blocks": {name: {"material": "steel"} for name in COLORS}, "time": {"end": 1e-6}})  # fmt: skip
if corner.code:
    sys.exit(corner.output)
# right, up and toward the camera, as docs/user/paraview.md says, with z up
SEES = {"front": ("+x", "+z", "-y"), "back": ("-x", "+z", "+y"), "left": ("-y", "+z", "-x"), "right": ("+y", "+z", "+x"), "top": ("+x", "+y", "+z"),
        "bottom": ("+x", "-y", "-z")}  # fmt: skip


def middles(image):
    """Where each block is seen: the mean of its points, right and up, whatever the light on its faces."""
    found = {}
    points = image[40:, : int(0.8 * image.shape[1])].astype(float)  # without time and names
    colored = (points.max(axis=2) - points.min(axis=2) > 8) & (points.max(axis=2) > 40)
    shade = points / numpy.maximum(numpy.linalg.norm(points, axis=2, keepdims=True), 1)
    references = {name: numpy.array(color) / numpy.linalg.norm(color) for name, color in COLORS.items()}
    off = numpy.stack([numpy.linalg.norm(shade - reference, axis=2) for reference in references.values()])
    for place, name in enumerate(references):
        there = colored & (off.argmin(axis=0) == place) & (off[place] < 0.03)
        if there.sum() > 200:
            rows, columns = numpy.nonzero(there)
            found[name] = (float(columns.mean()), -float(rows.mean()))
    return found


# All in one start of ParaView, by the parts that the program uses; then the program's own options.
script = """
import coplane_pictures as cp
run = cp.Run()
for name, camera, up in [(name, name, "z") for name in cp.CAMERAS] + [("up_y", "front", "y")]:
    picture = cp.Picture(run, 0, size=(400, 300), camera=camera, bounds=run.bounds([0]), up=up, label=False, margin=cp.margin_for((400, 300), run.names))
    picture.bodies(legend=False, edges=False)
    picture.save(name)
"""
pathlib.Path("cameras.py").write_text(script)
code, said = program.run_paraview(pathlib.Path("cameras.py").resolve(), [corner.folder, "drawn"], ".")
if not case.check_equal("cameras: exit code", code, 0):
    sys.exit(said)
names = sorted(path.name.split("_0")[0] for path in pathlib.Path("drawn").glob("*_000000us.png") if "state" not in path.name)
case.check_equal("cameras: pictures", names, sorted([*pictures.CAMERAS, "up_y"]))
for camera, (right, up, toward) in {**SEES, "up_y": ("+x", "+y", "+z")}.items():
    places = middles(seen(f"drawn/{camera}_000000us.png"))
    base = f"along_{toward[1]}" if toward[0] == "+" else "middle"  # what stands before the rest
    case.check_equal(f"camera {camera}: what stands behind is hidden", sorted(COLORS.keys() - places.keys()), sorted({"middle", f"along_{toward[1]}"} - {base}))
    for side, axis in ((right, 0), (up, 1)):
        there, middle = places.get(f"along_{side[1]}", (0, 0))[axis], places.get(base, (0, 0))[axis]
        case.check_equal(f"camera {camera}: {side} is {'up' if axis else 'right'}", (there > middle + 20) if side[0] == "+" else (there < middle - 20), True)
iso = middles(seen("drawn/iso_000000us.png"))
case.check_equal("camera iso: three sides are seen", sorted(COLORS.keys() - iso.keys() - {"middle"}), [])
LOOKS = ["-o", "drawn", "--shares", "0", "--size", "400", "300", "--planes", "none", "--no-edges"]
for what, words, reference in (("--camera left", ["--camera", "left"], "left"), ("--direction of iso", ["--direction", "1", "-1.6", "0.8"], "iso"),
                               ("--up y", ["--camera", "front", "--up", "y"], "up_y"))[: 3 if whole else 1]:  # fmt: skip
    (file,) = drawn(what, corner.folder, *LOOKS, *words, "--name", "by")
    places, references = middles(seen(file)), middles(seen(f"drawn/{reference}_000000us.png"))
    case.check_equal(f"{what}: sees the blocks of {reference}", sorted(places), sorted(references))
    case.check(f"{what}: where they are seen, in points", max(numpy.abs(numpy.subtract(places[name], references[name])).max() for name in references), 0, 2)


def red(image):
    """Points in the colour of arrows."""
    return int(((image[..., 0] > 90) & (image[..., 1] < 60) & (image[..., 2] < 60)).sum())


(with_arrows,) = drawn("arrows", space.folder, "-o", "drawn", "--times", "6e-5", "--planes", "arrows", "--camera", "front", "--size", "900", "600", "--name", "arrows")
image = seen(with_arrows)
case.check_within("arrows: their points", red(image), 50, 20000)
case.check_equal("no arrows: none", red(seen("drawn/iso_000000us.png")), 0)
bodies = (image < 250).any(axis=2)
bodies[:200] = bodies[-80:] = False  # without time, names and scale
body = numpy.flatnonzero(bodies.any(axis=0))
middle = int(numpy.flatnonzero(bodies.any(axis=1)).mean())
rows, columns = numpy.nonzero(((image[..., 0] > 90) & (image[..., 1] < 60) & (image[..., 2] < 60))[middle:])  # of the lower of the two rows of faces
case.check_within("an arrow lies along x, the force between the bars: width over height", numpy.ptp(columns) / numpy.ptp(rows), 3, 20)
case.check_within("arrows begin between the bars", abs(columns.min() - body.mean()) / numpy.ptp(body), 0, 0.06)

# --- files of ranks, the contents of pictures --------------------------------------------------------------------------------
ranks = case.attempt("ranks", boxes(2), {**deck(2), "output": {"every": 2e-5, "file_per_rank": True}}, 2, options=["--set", "time.end=6e-5"])
documents.save({"mesh": "mesh.e", **deck(2), "time": {"end": 1e-4}}, pathlib.Path(ranks.folder) / "run.yaml")
subprocess.run([program.binary("coplane"), "run.yaml", "--restart", "--quiet"], cwd=ranks.folder, check=True)
case.check_equal("files of ranks, and a part in one file", sorted(path.name for path in pathlib.Path(ranks.folder).glob("run.e*")), ["run.e-s0002", "run.e.2.0", "run.e.2.1"])
looks = ["-o", "drawn", "--times", "4e-5", "1e-4", "--color", "velocity", "--range", "0", "2", "--size", "300", "200", "--strip", "1"]
(one,), (other_file,) = drawn("one file", flat.folder, *looks, "--name", "one"), drawn("files of ranks", ranks.folder, *looks, "--name", "many")
case.check_equal("files of ranks: the same picture as of one file", bool((seen(one) == seen(other_file)).all()), True)
(dots,) = drawn("dots", flat.folder, "-o", "drawn", "--times", "6e-5", "--size", "600", "400", "--dot-size", "8", "--window", "0.4", "0.6", "0", "0.1", "--no-edges", "--name", "dots")
# Two faces meet: a dot of 8 by 8 points at a quarter and at three quarters of the height.
dark = (seen(dots)[60:340, 60:] < 60).all(axis=2)
case.check_within("dots on flat bodies: their points", int(dark.sum()), 100, 140)
case.check_within("dots on flat bodies: where they are, of the height of the bodies", numpy.ptp(numpy.flatnonzero(dark.any(axis=1))) / 300, 0.45, 0.6)
(expression,) = drawn("expression", flat.folder, "-o", "drawn", "--times", "4e-5", "--color", "0*density+1", "--range", "0", "1", "--palette", "white_to_blue", "--planes", "none",
                      "--no-edges", "--size", "300", "200", "--name", "expression")  # fmt: skip
case.check_equal("expression: the colour of the highest value", tuple(seen(expression)[100, 100]), (26, 64, 140))
(mirrored,) = drawn("planes by a variable, mirror", flat.folder, "-o", "drawn", "--times", "6e-5", "--planes", "normal_traction", "--dot-size", "8", "--mirror", "--size", "400", "200",
                    "--window", "-1", "1", "-0.2", "0.3", "--name", "values")  # fmt: skip
image = seen(mirrored)[90:110]
case.check_within("mirror: first and last column of the bodies", numpy.ptp(numpy.flatnonzero((image < 253).any(axis=(0, 2)))), 380, 400)
case.check_within("planes by a variable: points in colours", int((image.max(axis=2) - image.min(axis=2) > 60).sum()), 20, 2000)

# Names of blocks with capitals, spaces and letters of other languages, in a folder and a run of such names.
odd = case.attempt("odd", {"dimension": 2, "parts": [{"shape": "box", "block": name, "min": [x, 0], "size": [0.5, 0.1], "divisions": [10, 2]}
                                                    for name, x in (("Linker Balken", 0), ("Zweiter_Körper", 0.5))]},
                   {**deck(2), "blocks": {name: {"material": "steel"} for name in ("Linker Balken", "Zweiter_Körper")}, "initial": []})  # fmt: skip
if odd.code:
    sys.exit(odd.output)
moved = pathlib.Path("Ein schöner Ordner")
shutil.rmtree(moved, ignore_errors=True)
shutil.copytree(odd.folder, moved)
look = ["-o", "drawn", "--shares", "1", "--size", "400", "200", "--planes", "none", "--no-edges", "--window", "0", "1", "-0.1", "0.2"]
(left_only,) = drawn("odd names", moved, *look, "--name", "links von hier", "--blocks", "Linker Balken")
body = (numpy.abs(seen(left_only) - [115, 133, 153]).max(axis=2) < 8).any(axis=0)
(plain,) = drawn("odd names, plain", moved, *look, "--name", "plain", "--color", "velocity", "--plain", "Zweiter_Körper", "--window", "0", "1", "-0.1", "0.2")
second = (numpy.abs(seen(plain) - [217, 184, 140]).max(axis=2) < 8).any(axis=0)
case.check_within("odd names: columns of the block that is chosen", int(body.sum()), 80, 400)
case.check_within("odd names: columns of the block in its own colour", int(second.sum()), 80, 220)

# The cards of example.yaml have the options of the program, and no others.
schema = json.loads((pathlib.Path(os.environ["COPLANE_SOURCE"]) / "docs/schemas/example.json").read_text())
keys = set(schema["properties"]["pictures"]["additionalProperties"]["properties"])
options = {action.dest for action in pictures._parser()._actions} - {"help", "run", "compare", "output", "name", "animation", "vector"}
case.check_equal("keys of pictures in example.yaml are options", sorted(keys ^ options), [])
card = {"times": ["0", "1e-4"], "strip": "2", "mirror": "true", "no_edges": "false", "dot_size": "7", "window": ["-1e-3", "1", "0", "1"]}
parsed = pictures._parser().parse_args(["run", *pictures.words_of(card)])
case.check_equal("a card: the options that it means", (parsed.times, parsed.strip, parsed.mirror, parsed.no_edges, parsed.dot_size, parsed.window),
                 ([0, 1e-4], 2, True, False, 7, [-1e-3, 1, 0, 1]))  # fmt: skip

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
                          ("options that vector graphics do not know", [flat.folder, "--vector", "a.svg", "--mirror", "--palette", "dark"],
                           ["--vector does not know --mirror, --palette", "--window"]),
                          ("a film and a strip", [flat.folder, "--animation", "a.gif", "--strip", "2", "-o", "drawn"], ["--animation does not know --output, --strip", "a.gif"]),
                          ("runs in other dimensions", [flat.folder, "--compare", space.folder], ["space/run has 3 dimensions, ", "flat/run has 2"]),
                          ("a misspelt vector", [flat.folder, "--color", "velocty"], ["no variable 'velocty'; did you mean velocity?"]),
                          ("a variable in an expression", [flat.folder, "--color", "1-damge"], ["no variable 'damge'"]),
                          ("a variable of the planes", [flat.folder, "--planes", "slop"], ["no variable 'slop' of the planes", "slip"]),
                          ("a window", [flat.folder, "--window", "0", "1"], ["--window has 2 numbers", "X0 X1 Y0 Y1"]),
                          ("a share", [flat.folder, "--shares", "60"], ["'60'; accepted: numbers from 0 to 1"]),
                          ("a run", ["nobody"], ["there is no run of this name"])):  # fmt: skip
    code, said = draw(*words)
    case.check_equal(f"{what}: refused with these words", (code, [word for word in told if word not in said]), (2, []))
# What cannot be written is told before anything is drawn: a file stands where a folder is wanted (root may write everywhere).
pathlib.Path("drawn/file").write_text("")
for words in (["-o", "drawn/file"], ["-o", "drawn/file/deep"]):
    code, said = draw(flat.folder, *words)
    case.check_equal(f"{' '.join(words)}: refused", (code, "cannot be written: Not a directory" in said, words[1] in said), (5, True, True))
# That ffmpeg is missing is told before anything is drawn: here nothing that draws is found either.
which, told = shutil.which, ""
shutil.which = lambda name: None
try:
    pictures.make([str(flat.folder), "--animation", "drawn/late.mp4"])
except pictures.PicturesFailed as error:
    told = str(error)
finally:
    shutil.which = which
case.check_equal("a film without ffmpeg: told first", [word for word in ("late.mp4", "ffmpeg not found", ".gif") if word not in told], [])
case.finish()
