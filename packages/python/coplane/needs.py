"""Modules that only some functions use, imported when they are wanted."""

import importlib

# What Debian calls them; the same names without `python3-` serve pip where it says nothing else.
DEBIAN = {
    "jsonschema": "python3-jsonschema",
    "pandas": "python3-pandas",
    "plotly": "python3-plotly",
    "pyvista": None,
    "ruamel.yaml": "python3-ruamel.yaml",
    "xarray": "python3-xarray",
}


def needs(module, purpose):
    """The module; ImportError says what it is wanted for and how to install it."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = DEBIAN[module.split(".")[0] if module.split(".")[0] in DEBIAN else module]
        how = f"apt-get install {package} (Debian)" if package else f"pip install {module} (it is not in Debian 12)"
        raise ImportError(f"{purpose} needs the Python module {module}: {how}. ({error})") from error
