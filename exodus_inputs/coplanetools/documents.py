"""Decks and mesh recipes as Python dictionaries."""

import re

import yaml


class _Loader(yaml.SafeLoader):
    """PyYAML reads 5e10 as text (YAML 1.1 wants 5.0e+10); decks mean a number."""


_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(r"^[-+]?(\d[\d_]*\.?\d*|\.\d+)([eE][-+]?\d+)?$"),
    list("-+0123456789."),
)
_Loader.add_implicit_resolver("tag:yaml.org,2002:int", re.compile(r"^[-+]?\d+$"), list("-+0123456789"))


def load(path):
    """A deck or recipe."""
    with open(path) as file:
        return yaml.load(file, _Loader)


def value(text):
    """What a deck would read from this text: a number, a list, a word, ..."""
    return yaml.load(text, _Loader)


def save(document, path):
    """Numbers are written with all digits."""
    with open(path, "w") as file:
        yaml.safe_dump(document, file, sort_keys=False, default_flow_style=None, width=120)
