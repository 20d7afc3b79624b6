"""Pictures of a run: states, strips, animations and comparisons by ParaView, and flat ones as vector graphics by matplotlib."""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy

from . import program
from .needs import needs
from .results import NoRun, Run
from .units import attributes

CAMERAS = ("front", "back", "left", "right", "top", "bottom", "iso")


class PicturesFailed(RuntimeError):
    """What draws is missing, or has failed."""


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
    """ValueError unless there are this variable and these blocks."""
    names = series.element_names + series.nodal_names
    if color != "block" and color not in names and not any(name.rsplit("_", 1)[0] == color for name in names):
        raise ValueError(f"no variable '{color}'; there are block, {', '.join(names)}")
    for name in blocks:
        if name not in series.blocks:
            raise ValueError(f"no block '{name}'; there are {', '.join(series.blocks)}")


def draw(run, folder, compare=None, times=(), steps=2, color="block", range=None, blocks=(), camera=None, deformed=True, planes="dots",
         size=(1200, 800), timeout=None):  # fmt: skip
    """Draws states with ParaView into a folder, over those that an earlier call has left; returns the PNG files, in order of time."""
    missing = program.missing_for_pictures() + ([] if program.PARAVIEW else ["coplane_pictures.py"])
    if missing:
        raise PicturesFailed(f"{' and '.join(missing)} not found (packages/cmake/dependencies.sh --with-paraview installs ParaView)")
    runs = [run] if compare is None else [run, compare]
    for one in runs:
        one.results  # raises for what cannot be read, before ParaView does worse
        if not one.results_path.exists():
            raise PicturesFailed(f"there is no shared file {one.results_path.name}")
        _demand(one.results, color, blocks)
    with tempfile.TemporaryDirectory() as draft:
        files = _drawn(runs, draft, dict(color=color, range=range, blocks=list(blocks), camera=camera, deformed=deformed, planes=planes, size=list(size)),
                       _steps(numpy.array(run.results.times), times, steps), timeout)  # fmt: skip
        pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
        return [pathlib.Path(shutil.copy(file, folder)) for file in files]


def _drawn(runs, folder, want, frames, timeout):
    """What ParaView draws into an empty folder."""
    want = {"runs": [[str(one.folder.resolve()), one.results_path.stem] for one in runs], "folder": folder,
            "frames": frames, "unit": attributes(want["color"]).get("units", ""), "up": _up(runs[0]), **want}  # fmt: skip
    code, said = program.run_paraview(program.PARAVIEW / "draw_run.py", [json.dumps(want)], folder, timeout=timeout)
    found = sorted(pathlib.Path(folder).glob("*.png"))
    if code or len(found) != len(frames):
        raise PicturesFailed(f"ParaView ended with exit code {code}: {' '.join(said.strip().splitlines()[-1:])}")
    return found


def strip(files, output, columns):
    """Pictures of one size beside each other, in rows of so many."""
    Image = needs("PIL.Image", "A strip")
    images = [Image.open(file).convert("RGB") for file in files]
    width, height = images[0].size
    whole = Image.new("RGB", (width * min(columns, len(images)), height * -(-len(images) // columns)), "white")
    for place, image in enumerate(images):
        whole.paste(image, (width * (place % columns), height * (place // columns)))
    whole.save(output)


def animate(files, output, rate=12):
    """A film of pictures: .gif, or .mp4 where ffmpeg is installed."""
    if pathlib.Path(output).suffix == ".gif":
        Image = needs("PIL.Image", "A gif")
        images = [Image.open(file).convert("RGB").quantize(128) for file in files]
        images[0].save(output, save_all=True, append_images=images[1:], duration=round(1000 / rate), loop=0)
        return
    if not shutil.which("ffmpeg"):
        raise PicturesFailed("ffmpeg not found: apt-get install ffmpeg, or choose a file .gif")
    with tempfile.TemporaryDirectory() as folder:
        for place, file in enumerate(files):
            shutil.copy(file, f"{folder}/{place:06d}.png")
        # Even numbers of points and this kind of colours: what every player takes.
        done = subprocess.run(["ffmpeg", "-y", "-loglevel", "error", "-framerate", str(rate), "-i", f"{folder}/%06d.png", "-vf",
                               "scale=trunc(iw/2)*2:trunc(ih/2)*2", "-pix_fmt", "yuv420p", str(output)], capture_output=True, text=True)  # fmt: skip
    if done.returncode:
        raise PicturesFailed(f"ffmpeg: {' '.join(done.stderr.split())}")


def _values(series, block, name, step):
    """A variable on the elements of a block: nodal ones as means; of vectors the length."""
    names = [name] if name in series.element_names + series.nodal_names else [f"{name}_{axis}" for axis in "xy"]
    if names[0] in series.element_names:
        return series.element(block, names[0], step)
    corners = series.connectivity(block)
    return numpy.linalg.norm([series.nodal(one, step)[corners].mean(axis=1) for one in names], axis=0) if len(names) > 1 else \
        series.nodal(names[0], step)[corners].mean(axis=1)  # fmt: skip


def vector(run, output, time=None, color="block", range=None, blocks=(), deformed=True, planes=True):
    """A run in two dimensions as vector graphics (.svg, .pdf), at the step nearest to a time [s]; default: the last."""
    matplotlib = needs("matplotlib", "A picture as vector graphics")
    matplotlib.use("agg")
    collections = needs("matplotlib.collections", "A picture as vector graphics")
    pyplot = needs("matplotlib.pyplot", "A picture as vector graphics")

    series = run.results
    if series.dimension != 2:
        raise ValueError(f"{run.results_path.name}: vector graphics are for two dimensions; this run has three")
    _demand(series, color, blocks)
    times = numpy.array(series.times)
    step = len(times) - 1 if time is None else int(numpy.argmin(numpy.abs(times - time)))
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
    axes.set(aspect="equal", title=f"t = {1e3 * times[step]:.4g} ms", xlabel="x [m]", ylabel="y [m]")
    if values:
        unit = attributes(color).get("units", "")
        figure.colorbar(polygons, label=color + (f" [{unit}]" if unit not in ("", "1") else ""))
    else:
        axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1))
    if planes and run.planes_path.exists() and len(run.planes):
        place = int(numpy.argmin(numpy.abs(run.planes.times - times[step])))
        fields = run.planes.fields(place)
        touching = fields["area"] > 0
        axes.plot(*fields["Points"][touching, :2].T, ".", color="black", markersize=3)
    figure.savefig(output, bbox_inches="tight")
    pyplot.close(figure)


def _count(word):
    if not word.isdecimal() or int(word) < 1:
        raise argparse.ArgumentTypeError(f"'{word}'; accepted: whole numbers from 1 on")
    return int(word)


def _arguments():
    parser = argparse.ArgumentParser(prog="coplane pictures", description="Draws any run: bodies, deformed, with the planes that carry traction.")
    parser.add_argument("run", help="the run: its name with its folder (out/wall), its folder, or one of its files")
    parser.add_argument("--compare", metavar="OTHER", help="another run, drawn beside it at the same times")
    parser.add_argument("-o", "--output", metavar="FOLDER", help="default: the folder pictures beside the run")
    parser.add_argument("--times", nargs="+", type=float, default=[], metavar="T", help="times [s]; default: the first and the last")
    parser.add_argument("--steps", type=_count, metavar="N", help="so many states from the first to the last; default: 2, of a film all")
    parser.add_argument("--color", default="block", metavar="VARIABLE", help="block (default) or a variable: von_mises, velocity, damage, ...")
    parser.add_argument("--range", nargs=2, type=float, metavar=("LOW", "HIGH"), help="of the colours; default: of all that is drawn")
    parser.add_argument("--blocks", nargs="+", default=[], metavar="NAME", help="only these")
    parser.add_argument("--camera", choices=CAMERAS, help="default: front in two dimensions, iso in three")
    parser.add_argument("--planes", choices=("dots", "arrows", "none"), default="dots", help="as dots, as arrows of their force, or not")
    parser.add_argument("--undeformed", action="store_true", help="at the coordinates of the start")
    parser.add_argument("--size", nargs=2, type=int, default=[1200, 800], metavar=("WIDTH", "HEIGHT"))
    parser.add_argument("--strip", type=_count, metavar="COLUMNS", help="one picture of all states, so many in a row")
    parser.add_argument("--animation", metavar="FILE", help=".mp4 or .gif of all steps, or of those that --times or --steps choose")
    parser.add_argument("--vector", metavar="FILE", help=".svg or .pdf of a run in two dimensions, at the last of the times")
    return parser.parse_args()


def _file_of(name, endings):
    """A file that is asked for, before anything is drawn for it."""
    path = pathlib.Path(name)
    if path.suffix not in endings:
        raise ValueError(f"{name}: the name ends with {' or '.join(endings)}")
    if not path.resolve().parent.is_dir():
        raise ValueError(f"{name}: there is no folder {path.parent}")
    return path


def _make(options):
    run = Run(options.run)
    if options.vector:
        path = _file_of(options.vector, (".svg", ".pdf"))
        vector(run, path, options.times[-1] if options.times else None, options.color, options.range, options.blocks, not options.undeformed,
               options.planes != "none")  # fmt: skip
        return [path]
    film = _file_of(options.animation, (".mp4", ".gif")) if options.animation else None
    other = Run(options.compare) if options.compare else None
    steps = options.steps or (len(run.results.times) if film else 2)
    folder = pathlib.Path(options.output or run.folder / "pictures")
    with tempfile.TemporaryDirectory() as draft:
        files = draw(run, draft, other, options.times, steps, options.color, options.range, options.blocks, options.camera, not options.undeformed,
                     options.planes, options.size)  # fmt: skip
        if film:
            animate(files, film)
            return [film]
        folder.mkdir(parents=True, exist_ok=True)
        if options.strip:
            path = folder / f"{run.name}_strip.png"
            strip(files, path, options.strip)
            return [path]
        return [pathlib.Path(shutil.copy(file, folder / f"{run.name}_{file.name}")) for file in files]


def main():
    try:
        for path in _make(_arguments()):
            print(path)
    except (NoRun, ImportError, ValueError, PicturesFailed) as error:
        print(f"ERROR: {error}", file=sys.stderr)
        sys.exit(2)
    except OSError as error:
        print(f"ERROR: {error}", file=sys.stderr)
        sys.exit(5)
