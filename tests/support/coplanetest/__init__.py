"""Whole-program tests of Coplane: meshes, decks, runs, results, conservation, one JSON line per check."""

from . import documents, program, waves
from .case import Case
from .documents import turned, turned_deck
from .example import Example
from .results import Results, differences

__all__ = ["Case", "Example", "Results", "differences", "documents", "program", "turned", "turned_deck", "waves"]
