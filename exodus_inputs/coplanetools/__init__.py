"""What run.py and the checks and summaries of examples use: decks and recipes, runs of the programs, their results."""

from . import documents, program, waves
from .example import Example
from .results import Results, differences, series_differences

__all__ = ["Example", "Results", "differences", "documents", "program", "series_differences", "waves"]
