"""Pictures of a run: states, strips, animations and comparisons by ParaView, and flat ones as vector graphics by matplotlib."""

import argparse
import difflib
import errno
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy

from . import program
from .needs import needs
from .results import NoRun, Run
from .units import PLANES, attributes

CAMERAS = ("front", "back", "left", "right", "top", "bottom", "iso")


class PicturesFailed(RuntimeError):
    """What draws is missing, or has failed."""


# Colours of variables, and of planes.
PALETTES = ("green_blue", "cool_warm", "white_to_blue", "dark")
# What of an expression is no variable: functions and vectors of ParaView's calculator.
_FUNCTIONS = {"abs", "acos", "asin", "atan", "ceil", "cos", "cosh", "exp", "floor", "ln", "log10", "mag", "max", "min", "norm", "sin", "sinh", "sqrt",
              "tan", "tanh", "iHat", "jHat", "kHat", "if"}  # fmt: skip


def _steps(times, wanted, every):
    """Positions of the steps that are nearest to the wanted times [s], or so many from the first to the last."""
    if wanted:
        return sorted({int(numpy.argmin(numpy.abs(times - time))) for time in wanted})
    return sorted({int(step) for step in numpy.linspace(0, len(times) - 1, min(every, len(times))).round()})


def _up(run):
    """The axis against gravity; without: y in two dimensions, z in three."""
    gravity = (run.deck.get("gravity") if run.deck_text else None) or [0, 0, 0]
    across = [float(value) if isinstance(value, (int, float)) else 1.0 for value in list(gravity) + [0, 0]]
    return "z" if run.results.dimension == 3 and abs(across[1]) <= abs(across[2]) else "y"


def _demand(series, color, blocks):
    """ValueError unless there are the variables of a colour, which may be an expression, and these blocks."""
    names = series.element_names + series.nodal_names
    for word in [] if color == "block" else re.findall(r"[A-Za-z_]\w*", re.sub(r"\d[\d.]*(?:[eE][+-]?\d+)?", "", color)) or [color]:
        if word not in names and not any(name.rpartition("_")[0] == word for name in names) and (word == color or word not in _FUNCTIONS):
            vectors = sorted({name.rpartition("_")[0] for name in names if name.endswith("_x")})
            there = ["block", *vectors, *names]
            close = difflib.get_close_matches(word, there, 1)
            raise ValueError(f"no variable '{word}'{'; did you mean ' + close[0] + '?' if close else ''}; there are {', '.join(there)}")
    for name in blocks:
        if name not in series.blocks:
            raise ValueError(f"no block '{name}'; there are {', '.join(series.blocks)}")


def _planes(run, planes):
    """Path of what ParaView opens for the planes; None where there are none. ValueError when there is no such variable of planes."""
    if planes == "none":
        return None
    try:
        series = run.planes
    except (OSError, KeyError):
        series = None
    if planes not in ("dots", "all", "arrows"):
        fields = series.fields(-1) if series and len(series) else {}
        if planes not in fields or planes == "Points":
            raise ValueError(f"no variable '{planes}' of the planes; there are {', '.join(name for name in fields if name != 'Points') or 'no planes'}")
    return series and str(series.path.resolve().with_suffix(".xmf3" if series.path.suffix == ".vtkhdf" else ".pvd"))


# Variables of lines and their units.
LINES = {"force": "N", "stress": "Pa", "strain": "1", "plastic_strain": "1", "broken": "1", "slip": "m", "bond": "N"}


def _lines(run, lines):
    """Path of what ParaView opens for the lines; None where there are none. ValueError when there is no such variable of lines."""
    if lines != "none" and lines not in LINES:
        raise ValueError(f"no variable '{lines}' of the lines; there are {', '.join(LINES)}")
    series = run.folder / f"{run.results_path.stem}_lines.pvd"
    return str(series.resolve()) if lines != "none" and series.exists() else None


def _titled(name, of_planes=False):
    """A variable of the results or of the planes with its unit."""
    unit = PLANES.get(name, "") if of_planes else attributes(name).get("units", "")
    return name + (f" [{unit}]" if unit not in ("", "1") else "")


def draw(run, folder, compare=None, times=(), steps=2, color="block", range=None, blocks=(), camera=None, deformed=True, planes="dots",
         size=(1200, 800), timeout=None, title=None, palette="green_blue", plain=(), window=None, dot_size=4, opacity=None, mirror=False,
         legend="all", edges=True, up=None, lines="force"):  # fmt: skip
    """Draws states with ParaView into a folder, over those that an earlier call has left; returns the PNG files, in order of time.

    Meanings are those of the options of `coplane pictures` (docs/user/paraview.md). camera: a name or a direction; window: 4 or 6 numbers [m];
    legend: names and colour bars at the right of all pictures, within their size; or last, of the last picture alone, which is so much wider. PicturesFailed when ParaView is missing or fails, ValueError for what the run has not.
    """
    missing = program.missing_for_pictures() + ([] if program.PARAVIEW else ["coplane_pictures.py"])
    if missing:
        raise PicturesFailed(f"{' and '.join(missing)} not found (packages/cmake/dependencies.sh --with-paraview installs ParaView)")
    runs, told = [run] if compare is None else [run, compare], []
    if compare is not None and compare.results.dimension != run.results.dimension:
        raise ValueError(f"{compare.folder / compare.name} has {compare.results.dimension} dimensions, {run.folder / run.name} has {run.results.dimension}: "
                         "they cannot be seen from one place")
    for one in runs:
        _demand(one.results, color, [*blocks, *plain])  # raises for what cannot be read, before ParaView does worse
        told.append({"folder": str(one.folder.resolve()), "name": one.results_path.stem, "planes": _planes(one, planes), "lines": _lines(one, lines), "blocks": one.results.blocks,
                     "files": [str(file.path if pathlib.Path(file.path).is_absolute() else pathlib.Path(file.path).resolve()) for part in one.results.parts for file in part]})
    if isinstance(camera, str) and camera not in CAMERAS:
        raise ValueError(f"no camera '{camera}'; there are {', '.join(CAMERAS)}, or a direction of three numbers")
    want = dict(runs=told, color=color, title=title or _titled(color), range=range, palette=palette, blocks=list(blocks), plain=list(plain), camera=camera, window=window,
                up=up or _up(run), planes=planes, planes_title=title if title and color == "block" else _titled(planes, True), lines=lines, lines_title=f"{lines} of lines [{LINES.get(lines, '')}]".replace(" [1]", ""), dot_size=dot_size, opacity=opacity, mirror=mirror,
                deformed=deformed, size=list(size), legend=legend, edges=edges, frames=_steps(numpy.array(run.results.times), times, steps))  # fmt: skip
    with tempfile.TemporaryDirectory() as draft:
        files = _drawn({**want, "folder": draft}, timeout)
        pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
        return [pathlib.Path(shutil.copy(file, folder)) for file in files]


def _drawn(want, timeout):
    """What ParaView draws into an empty folder."""
    code, said = program.run_paraview(program.PARAVIEW / "draw_run.py", [json.dumps(want)], want["folder"], timeout=timeout)
    found = sorted(pathlib.Path(want["folder"]).glob("*.png"))
    if code or len(found) != len(want["frames"]):
        raise PicturesFailed(f"ParaView ended with exit code {code}: {' '.join(said.strip().splitlines()[-1:])}")
    return found


def strip(files, output, columns):
    """Pictures of one size beside each other, in rows of so many; the last may be wider, by its legend."""
    Image = needs("PIL.Image", "A strip")
    images = [Image.open(file).convert("RGB") for file in files]
    width, height = images[0].size
    places = [(width * (place % columns), height * (place // columns)) for place, _ in enumerate(images)]
    whole = Image.new("RGB", (max(x + image.width for (x, _), image in zip(places, images)), places[-1][1] + height), "white")
    for place, image in zip(places, images):
        whole.paste(image, place)
    whole.save(output)


def _demand_film(output):
    """PicturesFailed when there is nothing that makes such a film."""
    if pathlib.Path(output).suffix == ".mp4" and not shutil.which("ffmpeg"):
        raise PicturesFailed(f"{output}: ffmpeg not found, which makes .mp4: apt-get install ffmpeg, or choose a file .gif")


def animate(files, output, rate=12):
    """A film of pictures: .gif, or .mp4 where ffmpeg is installed."""
    if pathlib.Path(output).suffix == ".gif":
        Image = needs("PIL.Image", "A gif")
        images = [Image.open(file).convert("RGB").quantize(128) for file in files]
        images[0].save(output, save_all=True, append_images=images[1:], duration=round(1000 / rate), loop=0)
        return
    _demand_film(output)
    with tempfile.TemporaryDirectory() as folder:
        for place, file in enumerate(files):
            shutil.copy(file, f"{folder}/{place:06d}.png")
        # Even numbers of points and this kind of colours: what every player takes.
        done = subprocess.run(["ffmpeg", "-y", "-loglevel", "error", "-framerate", str(rate), "-i", f"{folder}/%06d.png", "-vf",
                               "scale=trunc(iw/2)*2:trunc(ih/2)*2", "-pix_fmt", "yuv420p", str(output)], capture_output=True, text=True)  # fmt: skip
    if done.returncode:
        raise PicturesFailed(f"ffmpeg: {' '.join(done.stderr.split())}")


def _told(time):
    """A time [s] as pictures tell it."""
    return f"t = {1e6 * time:.4g} µs" if 0 < abs(time) < 1e-4 else f"t = {1e3 * time:.4g} ms"


def _values(series, block, name, step):
    """A variable on the elements of a block: nodal ones as means; of vectors the length."""
    names = [name] if name in series.element_names + series.nodal_names else [f"{name}_{axis}" for axis in "xy"]
    if names[0] in series.element_names:
        return series.element(block, names[0], step)
    corners = series.connectivity(block)
    return numpy.linalg.norm([series.nodal(one, step)[corners].mean(axis=1) for one in names], axis=0) if len(names) > 1 else \
        series.nodal(names[0], step)[corners].mean(axis=1)  # fmt: skip


def vector(run, output, time=None, color="block", range=None, blocks=(), deformed=True, planes=True, window=None):
    """A run in two dimensions as vector graphics (.svg, .pdf), at the step nearest to a time [s]; default: the last."""
    matplotlib = needs("matplotlib", "A picture as vector graphics")
    matplotlib.use("agg")
    collections = needs("matplotlib.collections", "A picture as vector graphics")
    pyplot = needs("matplotlib.pyplot", "A picture as vector graphics")

    series = run.results
    if series.dimension != 2:
        raise ValueError(f"{run.results_path.name}: vector graphics are for two dimensions; this run has three")
    _demand(series, color, blocks)
    if color != "block" and not re.fullmatch(r"\w+", color):
        raise ValueError(f"'{color}': vector graphics are coloured by a variable, not by an expression")
    times = numpy.array(series.times)
    step = len(times) - 1 if time is None else _steps(times, [time], 1)[0]
    points = numpy.array(series.coordinates)[:, :2]
    if deformed:
        points = points + numpy.stack([series.nodal(f"displacement_{axis}", step) for axis in "xy"], axis=1)
    figure, axes = pyplot.subplots(figsize=(8, 6))
    chosen = [name for name in series.blocks if not blocks or name in blocks]
    values = {} if color == "block" else {name: _values(series, name, color, step) for name in chosen}
    lowest, highest = range or (min(v.min() for v in values.values()), max(v.max() for v in values.values())) if values else (0, 1)
    for place, name in enumerate(chosen):
        alive = series.element(name, "alive", step) > 0.5
        polygons = collections.PolyCollection(points[series.connectivity(name)[alive]], linewidths=0.3, edgecolors="0.3")
        if values:
            polygons.set(array=values[name][alive], clim=(lowest, highest), cmap="viridis")
        else:
            polygons.set(facecolor=f"C{place}", label=name)
        axes.add_collection(polygons)
    axes.autoscale()
    if window:
        axes.set(xlim=window[:2], ylim=window[2:4])
    axes.locator_params(nbins=5)  # numbers of small lengths are long
    axes.set(aspect="equal", title=_told(times[step]), xlabel="x [m]", ylabel="y [m]")
    if values:
        figure.colorbar(polygons, cax=axes.inset_axes([1.03, 0, 0.04, 1]), label=_titled(color))  # as tall as what is seen
    else:
        axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1))
    if planes and run.planes_path.exists() and len(run.planes):
        place = int(numpy.argmin(numpy.abs(run.planes.times - times[step])))
        fields = run.planes.fields(place)
        touching = fields["area"] > 0
        axes.plot(*fields["Points"][touching, :2].T, ".", color="black", markersize=3)
    figure.savefig(output, bbox_inches="tight")
    pyplot.close(figure)


# Options that vector graphics know.
_OF_VECTOR = {"run", "vector", "color", "range", "blocks", "window", "times", "shares", "undeformed", "planes"}


def _count(word):
    if not word.isdecimal() or int(word) < 1:
        raise argparse.ArgumentTypeError(f"'{word}'; accepted: whole numbers from 1 on")
    return int(word)


def _share(word):
    try:
        if 0 <= float(word) <= 1:
            return float(word)
    except ValueError:
        pass
    raise argparse.ArgumentTypeError(f"'{word}'; accepted: numbers from 0 to 1")


def _parser():
    parser = argparse.ArgumentParser(prog="coplane pictures", description="Draws any run: bodies, deformed, with the planes that carry traction.")
    parser._negative_number_matcher = re.compile(r"-(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$")  # -1e-3 is a number, no option
    parser.add_argument("run", help="the run: its name with its folder (out/wall), its folder, or one of its files")
    parser.add_argument("--compare", metavar="OTHER", help="another run, drawn beside it at the same times")
    parser.add_argument("-o", "--output", metavar="FOLDER", help="default: the folder pictures beside the run")
    parser.add_argument("--name", help="what the names of files begin with, and that of a strip; default: that of the run")
    parser.add_argument("--times", nargs="+", type=float, default=[], metavar="T", help="times [s]; default: the first and the last")
    parser.add_argument("--shares", nargs="+", type=_share, default=[], metavar="X", help="times, from 0 to 1 as shares of the last one")
    parser.add_argument("--steps", type=_count, metavar="N", help="so many states from the first to the last; default: 2, of a film all")
    parser.add_argument("--color", default="block", metavar="VARIABLE",
                        help="block (default), a variable (von_mises, velocity, damage, ...), or an expression of variables, such as '4*(1-damage)'")
    parser.add_argument("--title", help="of the colours; default: the variable and its unit")
    parser.add_argument("--range", nargs=2, type=float, metavar=("LOW", "HIGH"), help="of the colours; default: of all that is drawn, but for the highest 0.5 %%")
    parser.add_argument("--palette", choices=PALETTES, default=PALETTES[0], help="the colours")
    parser.add_argument("--blocks", nargs="+", default=[], metavar="NAME", help="only these")
    parser.add_argument("--plain", nargs="+", default=[], metavar="NAME", help="these in a colour of their own, where others have that of a variable")
    parser.add_argument("--camera", choices=CAMERAS, help="default: front in two dimensions, iso in three")
    parser.add_argument("--direction", nargs=3, type=float, metavar=("X", "Y", "Z"), help="from the bodies to the camera, in place of a name")
    parser.add_argument("--up", choices=("y", "z"), help="default: the axis against gravity; without, y in two dimensions and z in three")
    parser.add_argument("--window", nargs="+", type=float, metavar="X",
                        help="what is seen [m]: X0 X1 Y0 Y1, in space also with Z0 Z1; default: all bodies, with room around them")
    parser.add_argument("--planes", default="dots", metavar="KIND",
                        help="dots (default), all (dots, also of those that carry nothing), arrows of their force, none, or a variable of theirs (slip, closure, ...): dots in its colours")
    parser.add_argument("--lines", default="force", metavar="VARIABLE",
                        help="segments of lines, where the run has output.lines, in the colours of their force (default), stress, strain, plastic_strain, broken, slip or bond; or none")
    parser.add_argument("--dot-size", type=_count, default=4, metavar="N", help="points of the screen; default: 4")
    parser.add_argument("--opacity", type=_share, metavar="X", help="of the bodies, to 1; default: 1, and 0.3 where arrows or colours of planes lie between bodies in space")
    parser.add_argument("--mirror", action="store_true", help="also the mirror image at x = 0: the other half of a problem in axes r and z")
    parser.add_argument("--no-edges", action="store_true", help="without the edges of elements")
    parser.add_argument("--undeformed", action="store_true", help="at the coordinates of the start")
    parser.add_argument("--size", nargs=2, type=_count, default=[1200, 800], metavar=("WIDTH", "HEIGHT"))
    parser.add_argument("--strip", type=_count, metavar="COLUMNS", help="one picture of all states, so many in a row; names and colours are told in the last")
    parser.add_argument("--animation", metavar="FILE", help=".mp4 or .gif of all steps, or of those that --times or --steps choose")
    parser.add_argument("--vector", metavar="FILE", help=".svg or .pdf of a run in two dimensions, at the last of the times")
    return parser


def words_of(card):
    """Words of the command line that a card of `pictures` in an example.yaml means: keys are options without dashes before them."""
    words = []
    for key, value in card.items():
        option = "--" + key.replace("_", "-")
        if str(value).lower() == "true":
            words.append(option)
        elif str(value).lower() != "false":
            words += [option, *map(str, value if isinstance(value, list) else [value])]
    return words


def _file_of(name, endings):
    """A file that is asked for, before anything is drawn for it."""
    path = pathlib.Path(name)
    if path.suffix not in endings:
        raise ValueError(f"{name}: the name ends with {' or '.join(endings)}")
    if not path.resolve().parent.is_dir():
        raise ValueError(f"{name}: there is no folder {path.parent}")
    _demand_place(path.parent)
    return path


def _demand_place(folder):
    """PermissionError unless files can be written in a folder, which may have to be made, with those above it."""
    there = next(place for place in (folder, *folder.resolve().parents) if place.exists())
    if not there.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), str(folder))
    if not os.access(there, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(folder))


def make(words):
    """What `coplane pictures` makes of these words of its command line: paths of files. Raises what draw() raises, and NoRun."""
    options = _parser().parse_args(words)
    run = Run(options.run)
    if options.window and len(options.window) not in (4, 6):
        raise ValueError(f"--window has {len(options.window)} numbers; accepted are 4, X0 X1 Y0 Y1, or 6, also with Z0 Z1")
    if options.direction and not any(options.direction):
        raise ValueError("--direction 0 0 0 is none")
    if options.shares:
        options.times += [share * float(run.results.times[-1]) for share in options.shares]
    if options.vector:
        path = _file_of(options.vector, (".svg", ".pdf"))
        others = sorted(f"--{name.replace('_', '-')}" for name, value in vars(options).items() if name not in _OF_VECTOR and value != _parser().get_default(name))
        if others:
            raise ValueError(f"--vector does not know {', '.join(others)}; it knows {', '.join('--' + name for name in sorted(_OF_VECTOR - {'run', 'vector', 'shares'}))}")
        vector(run, path, options.times[-1] if options.times else None, options.color, options.range, options.blocks, not options.undeformed,
               options.planes != "none", options.window)  # fmt: skip
        return [path]
    film = _file_of(options.animation, (".mp4", ".gif")) if options.animation else None
    if film:
        ignored = [f"--{name}" for name in ("name", "output", "strip") if getattr(options, name)]
        if ignored:
            raise ValueError(f"--animation does not know {', '.join(ignored)}: it writes one file, {film}")
        _demand_film(film)  # before minutes of drawing
    other = Run(options.compare) if options.compare else None
    steps = options.steps or (len(run.results.times) if film else 2)
    folder, name = pathlib.Path(options.output or run.folder / "pictures"), options.name or run.name
    if not film:
        _demand_place(folder)  # before minutes of drawing
    with tempfile.TemporaryDirectory() as draft:
        files = draw(run, draft, other, options.times, steps, options.color, options.range, options.blocks, options.direction or options.camera, not options.undeformed,
                     options.planes, options.size, None, options.title, options.palette, options.plain, options.window, options.dot_size, options.opacity,
                     options.mirror, "last" if options.strip else "all", not options.no_edges, options.up, options.lines)  # fmt: skip
        if film:
            animate(files, film)
            return [film]
        folder.mkdir(parents=True, exist_ok=True)
        if options.strip:
            path = folder / (f"{name}.png" if options.name else f"{name}_strip.png")
            strip(files, path, options.strip)
            return [path]
        return [pathlib.Path(shutil.copy(file, folder / f"{name}_{file.name.removeprefix('state_') if options.name else file.name}")) for file in files]


def main():
    try:
        for path in make(sys.argv[1:]):
            print(path)
    except (NoRun, ImportError, ValueError, PicturesFailed) as error:
        print(f"ERROR: {error}", file=sys.stderr)
        sys.exit(2)
    except OSError as error:
        print(f"ERROR: {error.filename or ''}: cannot be written: {error.strerror or error}", file=sys.stderr)
        sys.exit(5)
