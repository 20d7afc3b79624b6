"""An example of exodus_inputs in its coarse size, as a check that can be asked in other words: its balances. Argument: the example."""

import sys

from coplanetest import Case, examples

name = sys.argv[1]
case = Case(f"example {name}", __file__)
recipe, deck, joints = examples.coarse(name)
deck.pop("mesh", None)
case.run(name, recipe, deck, joints=joints, energy=0.02, momentum=1e-10, angular=1e-9)
case.finish()
