#!/usr/bin/env python3
"""Soft blocks, pressed deep and slid: in how many random scenes does contact hold, and what does it make or lose?

    python3 tests/measure/slid_blocks.py BUILD/bin [--against OTHER/bin] [--scenes 160] [--seed 7]

A block of rubber, 2 to 4 elements high, is pressed to 0.68 to 0.85 of its height on a slab of the same, with the default penalty, and slid by a
quarter to one and a half of its width. Prints a line for each program; 160 scenes take half a minute. The figures stand in docs/user/contact.md;
tests/verification/deep_slides demands some of the scenes.
"""

import argparse
import os
import pathlib
import random
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from coplanetest import Case
from coplanetest.slides import slid_block


def scenes(number, seed=7):
    rng = random.Random(seed)
    for _ in range(number):
        split = rng.choice([None, None, "triangles"])
        yield {
            "ratio": rng.uniform(0.68, 0.85), "slide": rng.uniform(0.05, 0.3) * rng.choice([-1, 1]), "friction": rng.choice([0, 0, 0.2, 0.4, 0.6]),
            "block": (rng.choice([3, 4, 5, 6, 8]), rng.choice([2, 3, 4])), "slab": (rng.choice([14, 18, 20, 25, 30]), rng.choice([2, 3, 4])),
            "split": split, "element": "one_point" if split else rng.choice(["one_point", "one_point", "full_integration"]),
        }  # fmt: skip


def measure(program, number, seed, goes_on):
    """goes_on: whether the program has to be told to go on when bodies go through each other; older ones do."""
    os.environ["COPLANE_BIN"] = str(pathlib.Path(program).resolve())
    held, lost, warned, false, ended, remainders = 0, 0, 0, 0, 0, []
    stopped = [0, 0, 0]  # by the default, of those that hold, that fall below 0.3, and the others
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        case = Case("slid blocks", __file__)
        for k, scene in enumerate(scenes(number, seed)):
            mesh, deck = slid_block(**scene)
            if goes_on:
                deck["contact"]["lost_contact"] = "warn"
            run = case.attempt(f"scene_{k}", mesh, deck)
            ended += run.code != 0
            force = run.history["touch_normal_force"]
            half = len(force) // 2  # pressed; then it slides
            held += force[half:].min() > 0.7 * force.max()
            says = "faces lie in other bodies" in run.output
            if goes_on and says:
                del deck["contact"]["lost_contact"]
                kind = 0 if force[half:].min() > 0.7 * force.max() else 1 if force[-1] < 0.3 * force.max() else 2
                stopped[kind] += case.attempt(f"scene_{k}_stopped", mesh, deck).code == 6
            lost += force[-1] < 0.3 * force.max()
            warned += says and force[-1] < 0.3 * force.max()
            false += says and force[-1] >= 0.3 * force.max()
            remainders.append(run.history["contact_remainder"][-1] / abs(run.history["external_work"]).max())
    sizes = sorted(abs(r) for r in remainders)
    print(f"| {number} | {held} | {lost} | {warned} | {false} | {ended} | {stopped[1]}; {stopped[2]}; {stopped[0]} | {sizes[number // 2]:.1e} | {min(remainders):.1e} | {max(remainders):.1e} |")


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("program")
    arguments.add_argument("--against")
    arguments.add_argument("--scenes", type=int, default=160)
    arguments.add_argument("--seed", type=int, default=7)
    options = arguments.parse_args()
    programs = [str(pathlib.Path(p).resolve()) for p in (options.program, options.against) if p]
    print("| scenes | force stays above 0.7 of the largest | falls below 0.3 | of these warned of | of the others | end early | code 6 by default, of these; of others; of those that hold | remainder over work, median size | most gained | most lost |\n|---|---|---|---|---|---|---|---|---|---|")
    for program in programs:
        measure(program, options.scenes, options.seed, goes_on=program == programs[0])


if __name__ == "__main__":
    main()
