"""Coplane from Python: decks, runs and their results.

    import coplane
    run = coplane.open("out/wall")
    run.history.plot(y=["kinetic", "internal"])

Needs numpy, netCDF4 and PyYAML; pandas, xarray, plotly, jsonschema, ruamel.yaml and VTK only where they are used.
"""

from .deck import Deck, DeckError
from .program import make_mesh, split_mesh
from .results import Run
from .running import RunFailed, run, study, watch

__version__ = "0.1.0"
__all__ = ["Deck", "DeckError", "Run", "RunFailed", "make_mesh", "open", "run", "split_mesh", "study", "watch"]


def open(path):
    """The Run that a path means: a folder with one run, the name of a run with its folder (`out/wall`), or any of its files."""
    return Run(path)
