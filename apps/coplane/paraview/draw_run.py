"""Pictures of any run, for pvbatch: what coplane.pictures asks for, as JSON in the first argument; prints the files, a line each.

    runs: [{folder, name, files (of the results), planes and lines (the series, or null), blocks (their names, as in the mesh)}, ...]   one, or two to be compared
    folder: of the pictures   frames: positions in the times of the first run
    color: a variable, an expression of variables, or "block"   title: of its bar   range: [lowest, highest] or null: of all frames
    palette: of its colours   blocks: names, none for all   plain: blocks in colours of their own
    camera: a name, a direction [x, y, z] or null   window: what is seen, [x0, x1, y0, y1] or with z0, z1, or null   up: y or z
    planes: dots (of those that carry traction), all, arrows, none or a variable of theirs   dot_size: in points of the screen   opacity: of bodies, or null
    lines: a variable of the segments of lines, or none; drawn where the run has written them
    mirror, deformed, edges: bool   size: [width, height]
    legend: names and colour bars at the right of the bodies, within the width, in all pictures; or last: only in the last, which is so much wider
"""
import json
import os
import sys

import coplane_pictures as cp
from paraview.simple import MergeBlocks, Reflect, Threshold

want = json.loads(sys.argv[1])
runs = [cp.Run(run["folder"], want["folder"], run["name"], want["deformed"], run["files"], run["planes"], run["blocks"], run["lines"]) for run in want["runs"]]
times = [runs[0].times[frame] for frame in want["frames"]]
boxes = [run.bounds(run.nearest(times[0], times[-1]), want["blocks"]) for run in runs]
bounds = [(min if side % 2 == 0 else max)(box[side] for box in boxes) for side in range(6)]
in_space = bounds[5] > bounds[4]
if want["mirror"]:
    bounds[0] = min(bounds[0], -bounds[1])
if want["window"]:
    bounds[: len(want["window"])] = want["window"]
view = {"camera": want["camera"] or ("iso" if in_space else "front"), "bounds": bounds, "up": want["up"],
        "room": 1.0 if want["window"] else 1.2}  # fmt: skip


def chosen(run):
    """Names of the blocks that are drawn; those of compared runs may differ."""
    return want["blocks"] or run.names


def colored(run):
    """Of these, those that have the colours of the variable."""
    return [name for name in chosen(run) if name not in want["plain"]]


by_block = want["color"] == "block" or not all(map(colored, runs))
of_planes = want["planes"] not in ("dots", "all", "arrows", "none")
has_planes = want["planes"] != "none" and all(run.has_planes() for run in runs)
has_lines = want["lines"] != "none" and all(run.has_lines() for run in runs)
# Planes lie between bodies: their arrows and values shall be seen through them.
bars = (not by_block) + (of_planes and has_planes) + has_lines
margin = cp.margin_for(want["size"], [name for run in runs for name in chosen(run)] if by_block and not of_planes else (), bars)
width = want["size"][0] - (margin if want["legend"] == "all" else 0)
opacity = want["opacity"] or (0.3 if in_space and (of_planes or want["planes"] == "arrows" or has_lines) else 1.0)


def whole(source):
    """With its mirror image at x = 0, where that is wanted."""
    return MergeBlocks(Input=Reflect(Input=source, Plane="X", Center=0), MergePoints=0) if want["mirror"] else source


def bodies(run):
    """The coloured ones, and the name of the variable by which they are."""
    source, name = run.blocks(*colored(run)), want["color"]
    source.UpdatePipeline(times[0])
    if source.PointData.GetArray(name) or source.CellData.GetArray(name):
        return source, name
    on_nodes = any(array.GetName() in name for array in source.PointData) and not any(array.GetName() in name for array in source.CellData)
    return cp.computed(source, want["title"], name, "Point Data" if on_nodes else "Cell Data"), want["title"]


def spread(source_and_name, share=99.5, few=8):
    """Least value, or 0, and what is below only this share, over some of the frames of all runs: single elements do not decide."""
    least, most = [0.0], [0.0]
    for run in runs:
        source, name = source_and_name(run)
        for time in run.nearest(*times[:: max(1, len(times) // few)], times[-1]):
            values = cp.values(source, name, time)
            if len(values):
                least.append(float(cp.numpy.percentile(values, 100 - share)))
                most.append(float(cp.numpy.percentile(values, share)))
    return [min(least), max(most) if max(most) > min(least) else min(least) + 1.0]


colors = None if by_block else want["range"] or spread(bodies)
most = spread(lambda run: (run.planes(), "force"), 100)[1] if want["planes"] == "arrows" and has_planes else 1.0
plane_colors = want["range"] or spread(lambda run: (run.planes(touching=False), want["planes"])) if of_planes and has_planes else None

line_colors = spread(lambda run: (run.lines(), want["lines"]), 100) if has_lines else None


def styled(name, range):
    """How colours are told to Picture.surface()."""
    return {"preset": cp.PRESETS[name]} if name in cp.PRESETS else {"points": cp.palette(name, *range)}


def draw(run, time, name):
    nearest = run.nearest(time)[0]
    with_legend = want["legend"] == "all" or time == times[-1]
    picture = cp.Picture(run, nearest, size=[width + (margin if with_legend else 0), want["size"][1]], margin=margin if with_legend else 0, **view)
    if of_planes and want["color"] == "block":
        picture.solid(whole(run.blocks(*chosen(run))), [0.96, 0.95, 0.93], want["edges"], opacity, [0.85, 0.84, 0.82])
    elif by_block:
        picture.bodies(chosen(run), opacity, with_legend, whole, want["edges"])
    else:
        source, variable = bodies(run)
        picture.surface(whole(source), variable, colors, want["title"], edges=want["edges"], bar=with_legend, **styled(want["palette"], colors)).Opacity = opacity
        picture.bodies([block for block in chosen(run) if block in want["plain"]] or ["none"], opacity, False, whole, want["edges"])
    if has_planes and want["planes"] in ("dots", "all"):
        picture.dots(whole(run.planes(touching=want["planes"] == "dots")), size=want["dot_size"])
    elif has_planes and want["planes"] == "arrows":
        picture.arrows(0.15 * max(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]), most)
    elif has_planes and of_planes:
        # Those that have next to nothing of it would hide the others.
        least = plane_colors[0] + 0.01 * (plane_colors[1] - plane_colors[0])
        some = Threshold(Input=run.planes(touching=False), Scalars=["POINTS", want["planes"]], LowerThreshold=least, UpperThreshold=least,
                         ThresholdMethod="Above Upper Threshold")  # fmt: skip
        picture.points(whole(some), want["planes"], plane_colors, want["planes_title"], size=want["dot_size"], bar=with_legend,
                       points=cp.palette("dark", *plane_colors))  # fmt: skip
        if len(cp.values(some, want["planes"], nearest)) == 0:
            picture.text(f"{want['planes']}: 0", "Lower Right Corner")
    if has_lines:
        if by_block and not of_planes:
            picture.bars += 1  # names stand above
        # A third bar has no place.
        picture.lines(whole(run.lines()), want["lines"], line_colors, want["lines_title"], bar=with_legend and picture.bars < 2, points=cp.palette("dark", *line_colors))
    picture.scale_bar()
    if len(runs) > 1:
        stem = os.path.basename(run.file)[:-2]
        picture.text(stem if runs[0].folder == runs[1].folder else f"{os.path.basename(run.folder)}/{stem}", "Upper Center")
    return picture.save(name)


for number, time in enumerate(times):
    files = [draw(run, time, f"state_{number:04d}{'ab'[which] if len(runs) > 1 else ''}") for which, run in enumerate(runs)]
    if len(runs) > 1:
        cp.strip(files, files[0].replace(f"state_{number:04d}a", f"state_{number:04d}"), 2)
