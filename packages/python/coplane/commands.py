"""The subcommands of coplane: `coplane report` starts the program coplane_report, which is this."""

import importlib
import pathlib
import sys

# Modules with a main() by subcommand.
MODULES = {"new": "new", "pictures": "pictures", "report": "report", "watch": "view"}


def main():
    """Runs the subcommand whose name the program has."""
    word = pathlib.Path(sys.argv[0]).name.removeprefix("coplane_")
    importlib.import_module(f"coplane.{MODULES[word]}").main()
