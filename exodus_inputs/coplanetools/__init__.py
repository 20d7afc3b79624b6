"""What run.py and the checks and summaries of examples use besides the package coplane, which reads and writes decks, runs programs and
opens results.
"""

import pathlib
import sys

# Of the source tree (packages/python), or of PREFIX/share/coplane (python).
_TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(_TOP / "packages/python" if (_TOP / "packages").is_dir() else _TOP / "python"))

from coplane import documents, program, tables  # noqa: E402
from coplane.exodus import Results, differences, series_differences  # noqa: E402

from . import waves  # noqa: E402
from .ended import EndedRun  # noqa: E402
from .example import Example  # noqa: E402



def deck_of(folder):
    """Path of the deck in the folder of an example, or in one that `coplane new` has made like it: its example.yaml says which."""
    return folder / documents.load(folder / "example.yaml").get("deck", "deck.yaml")


__all__ = ["EndedRun", "Example", "Results", "deck_of", "differences", "documents", "program", "series_differences", "tables", "waves"]
