"""Whole-program tests of Coplane: meshes, decks, runs, results, conservation, one JSON line per check."""

from .case import Case
from .documents import load, turned
from .program import Run, run_program
from .results import Results, differences

__all__ = ["Case", "Results", "Run", "differences", "load", "run_program", "turned"]
