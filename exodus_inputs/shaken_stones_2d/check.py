"""The ground moves as the record says, and what the survival curve says of the two structures is true of this run."""

import importlib.util
import pathlib

import numpy

from coplanetools import Example, documents



def module(name):
    spec = importlib.util.spec_from_file_location(name, pathlib.Path(__file__).with_name(f"{name}.py"))
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


motion, survival = module("motion"), module("survival")
example = Example()
h = example.history
acceleration = 2.0 if example.variant == "weak" else 3.0
# Rigid stones; the ground bears their weight all the time, and what hardly moves has little momentum to compare that with.
example.balances(remainder=(-1e-3, 1e-3), hourglass=1e-9, momentum=1e-9)
table = documents.load(example.folder / "run.yaml")["conditions"][0]["value"][0]
times, values = motion.table()
example.check("record of the deck against its formula, largest difference", float(numpy.abs(numpy.array([table["times"], table["values"]]) - (times, values)).max()), 0, 1e-5)
late = (h["time"] >= motion.START) & (h["time"] <= motion.START + motion.LENGTH)  # after it the last value, nearly zero, stays
ground = acceleration * numpy.interp(h["time"][late] - motion.START, motion.motion().times, motion.motion().displacement)
example.check("displacement of the ground against the record, over its largest", float(numpy.abs(h["ground_displacement_x"][late] - ground).max() / numpy.abs(ground).max()), 0, 0.01)
if example.size != "coarse":
    for structure, stands in (("portal", example.variant == "weak"), ("tower", example.variant == "weak")):
        most, last, found = survival.outcome(h, structure)
        print(f"{structure}: largest drift {100 * most:.2f} %, last {100 * last:.2f} %")
        example.check(f"{structure} stands", int(found), int(stands), 0)
example.finish()
