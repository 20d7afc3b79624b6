"""The examples of exodus_inputs as recipe, deck and recipe of joints, in the sizes that tests run."""

import argparse
import importlib.util
import pathlib

INPUTS = pathlib.Path(__file__).resolve().parents[3] / "exodus_inputs"
# The part of its time that is run of an example without a coarse size.
PARTS = {"bar_wall_3d": 0.1, "penetration": 0.3}


def names():
    return sorted(path.parent.name for path in INPUTS.glob("*/example.yaml"))


def sized(name, size=None, variant=""):
    """Recipe, deck, recipe of joints or None of an example in one of its sizes; None: coarse, or the first that it has."""
    specification = importlib.util.spec_from_file_location("run_example", INPUTS / "run.py")
    run = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(run)
    example = run.read_example(INPUTS / name)
    size = size or ("coarse" if "coarse" in example["sizes"] else next(iter(example["sizes"])))
    options = argparse.Namespace(ranks=None, set=[], output=pathlib.Path("unused"), variant=[variant], overwrite=False)
    chosen = run.ExampleRun(INPUTS / name, example, size, variant, options)
    return chosen.recipe, chosen.deck, chosen.joints


def coarse(name):
    """The same in its coarse size, or the first that it has for a part of its time."""
    recipe, deck, joints = sized(name)
    deck["time"]["end"] *= PARTS.get(name, 1)
    return recipe, deck, joints
