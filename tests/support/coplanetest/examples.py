"""The examples of exodus_inputs as recipe, deck and recipe of joints, in the sizes that tests run."""

import argparse
import importlib.util
import pathlib

INPUTS = pathlib.Path(__file__).resolve().parents[3] / "exodus_inputs"
# The part of its time that is run of an example without a coarse size.
PARTS = {"bar_wall_3d": 0.1, "penetration": 0.3}


def names():
    return sorted(path.parent.name for path in INPUTS.glob("*/example.yaml"))


def coarse(name):
    """Recipe, deck, recipe of joints or None of an example in its coarse size, or the first that it has for a part of its time."""
    specification = importlib.util.spec_from_file_location("run_example", INPUTS / "run.py")
    run = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(run)
    example = run.read_example(INPUTS / name)
    size = "coarse" if "coarse" in example["sizes"] else next(iter(example["sizes"]))
    options = argparse.Namespace(ranks=None, set=[], output=pathlib.Path("unused"), variant=[""], overwrite=False)
    chosen = run.ExampleRun(INPUTS / name, example, size, "", options)
    chosen.deck["time"]["end"] *= PARTS.get(name, 1)
    return chosen.recipe, chosen.deck, chosen.joints
