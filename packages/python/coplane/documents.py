"""Decks and mesh recipes as Python dictionaries."""

import os
import re

import yaml


class _Loader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # by libyaml where PyYAML was built with it
    """PyYAML reads 5e10 as text (YAML 1.1 wants 5.0e+10); decks mean a number."""


_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(r"^[-+]?(\d[\d_]*\.?\d*|\.\d+)([eE][-+]?\d+)?$"),
    list("-+0123456789."),
)
_Loader.add_implicit_resolver("tag:yaml.org,2002:int", re.compile(r"^[-+]?\d+$"), list("-+0123456789"))
_Dumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)


def parse(text):
    """What a deck would read from this text: a document, a number, a list, a word, ..."""
    return yaml.load(text, _Loader)


def load(path):
    """A deck or recipe, or JSON."""
    with open(path, encoding="utf-8") as file:
        return parse(file)


def text(document):
    """As YAML; numbers with all digits."""
    return yaml.dump(document, Dumper=_Dumper, sort_keys=False, default_flow_style=None, width=120)


def save(document, path):
    """Writes the text of a deck or recipe."""
    with open(path, "w", encoding="utf-8") as file:
        file.write(text(document))


def plain(value):
    """The value without types of numpy and paths, which YAML does not know: arrays and tuples become lists."""
    if hasattr(value, "tolist"):  # numpy's arrays and numbers
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if type(value) is dict:
        return {key: plain(entry) for key, entry in value.items()}
    return [plain(entry) for entry in value] if type(value) in (list, tuple) else value


def change(document, path, value):
    """document.a.1.b = value; None takes the key out. KeyError when the path leads nowhere."""
    *parents, last = [int(key) if key.isdigit() else key for key in path.split(".")]
    for key in parents:
        try:
            document = document.setdefault(key, {}) if isinstance(document, dict) else document[key]
        except (IndexError, TypeError):
            raise KeyError(f"{path} leads nowhere: there is no '{key}'.") from None
    if value is None and isinstance(document, dict):
        document.pop(last, None)
    elif isinstance(document, list) and last == len(document):
        document.append(value)
    else:
        document[last] = value


def demand_card(deck, path):
    """KeyError when a path leads into a joint, material or block that a deck has not: it would make one that nothing uses, and change nothing."""
    group, _, rest = path.partition(".")
    card, _, key = rest.partition(".")
    if group not in ("joints", "materials", "blocks") or not key:
        return
    cards = list(deck.get(group) or {})
    if group == "materials":  # also sets of the library that a block names
        cards += {block.get("material"): None for block in (deck.get("blocks") or {}).values() if block.get("material") not in cards}
    if card not in cards:
        raise KeyError(f"{path}: the deck has no {group}.{card}; it has {', '.join(map(str, cards)) or 'none'}.")


def value_at(document, path):
    """document.a.1.b; KeyError when there is none."""
    for key in path.split("."):
        try:
            document = document[int(key) if isinstance(document, list) else key]
        except (IndexError, KeyError, TypeError, ValueError):
            raise KeyError(f"{path} leads nowhere: there is no '{key}'.") from None
    return document
