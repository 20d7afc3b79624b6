"""Whole-program tests of Coplane: cases, conservation, the same problem told otherwise. Decks, runs and results are those of
the package coplane and of exodus_inputs/coplanetools, which examples use as well.
"""

import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[3] / "exodus_inputs"))

from coplanetools import Results, differences, documents, program, series_differences, tables, waves  # noqa: E402

from . import calculix, examples  # noqa: E402
from .case import Case  # noqa: E402
from .frames import rotation, turned, turned_deck  # noqa: E402
from .validation import ValidationCase  # noqa: E402

__all__ = ["Case", "Results", "ValidationCase", "calculix", "differences", "documents", "examples", "program", "rotation", "series_differences", "tables", "turned", "turned_deck", "waves"]
