"""Modules that only some functions use, imported when they are wanted."""

import importlib

# What Debian calls them.
DEBIAN = {
    "PIL": "python3-pil",
    "jsonschema": "python3-jsonschema",
    "matplotlib": "python3-matplotlib",
    "pandas": "python3-pandas",
    "plotly": "python3-plotly",
    "ruamel.yaml": "python3-ruamel.yaml",
    "vtkmodules": "python3-vtk9",
    "xarray": "python3-xarray",
}


def needs(module, purpose):
    """The module; ImportError says what it is wanted for and how to install it."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = DEBIAN[module if module in DEBIAN else module.split(".")[0]]
        raise ImportError(f"{purpose} needs the Python module {module}: apt-get install {package} (Debian). ({error})") from error
