"""Pictures of any run, for pvbatch: what coplane.pictures asks for, as JSON in the first argument; prints the files, a line each.

    runs: [[folder, name of the run], ...]   one, or two to be compared
    folder: of the pictures   frames: positions in the times of the first run
    color: a variable, or "block"   unit: of it   range: [lowest, highest] or null: of all frames
    blocks: names, none for all   camera: a name   up: y or z   deformed: bool   planes: dots, arrows or none   size: [width, height]
"""
import json
import os
import sys

import coplane_pictures as cp

want = json.loads(sys.argv[1])
runs = [cp.Run(folder, want["folder"], stem, want["deformed"]) for folder, stem in want["runs"]]
times = [runs[0].times[frame] for frame in want["frames"]]
boxes = [run.bounds(run.nearest(times[0], times[-1])) for run in runs]
bounds = [(min if side % 2 == 0 else max)(box[side] for box in boxes) for side in range(6)]
camera = want["camera"] or ("iso" if bounds[5] > bounds[4] else "front")
by_block = want["color"] == "block"
spread = want["range"]


def largest(source_of, variable, few=8):
    """Over some of the frames, of all runs."""
    chosen = times[:: max(1, len(times) // few)] + times[-1:]
    found = [cp.values(source_of(run), variable, time) for run in runs for time in run.nearest(*chosen)]
    found = [values for values in found if len(values)]
    return (float(min(values.min() for values in found)), float(max(values.max() for values in found))) if found else (0.0, 1.0)


if not by_block and spread is None:
    lowest, highest = largest(lambda run: run.blocks(*want["blocks"]), want["color"])
    spread = [min(lowest, 0.0), highest if highest > lowest else lowest + 1.0]
top = largest(lambda run: run.planes(), "force")[1] if want["planes"] == "arrows" and all(run.has_planes() for run in runs) else 1.0


def draw(run, time, name):
    nearest = run.nearest(time)[0]
    picture = cp.Picture(run, nearest, size=want["size"], camera=camera, bounds=bounds, up=want["up"])
    # Planes lie between bodies: their arrows shall be seen through them.
    opacity = 0.3 if want["planes"] == "arrows" and bounds[5] > bounds[4] else 1.0
    if by_block:
        picture.bodies(want["blocks"], opacity)
    else:
        title = want["color"] + (f" [{want['unit']}]" if want["unit"] not in ("", "1") else "")
        picture.surface(run.blocks(*want["blocks"]), want["color"], spread, title).Opacity = opacity
    if run.has_planes() and want["planes"] == "dots":
        picture.dots(size=4)
    elif run.has_planes() and want["planes"] == "arrows":
        picture.arrows(0.15 * max(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]), top)
    picture.scale_bar()
    if len(runs) > 1:
        stem = os.path.basename(run.file)[:-2]
        picture.text(stem if runs[0].folder == runs[1].folder else f"{os.path.basename(run.folder)}/{stem}", "Upper Center")
    return picture.save(name)


for number, time in enumerate(times):
    files = [draw(run, time, f"state_{number:04d}{'ab'[which] if len(runs) > 1 else ''}") for which, run in enumerate(runs)]
    if len(runs) > 1:
        cp.strip(files, files[0].replace(f"state_{number:04d}a", f"state_{number:04d}"), 2)
