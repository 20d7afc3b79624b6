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


def _step(container, path):
    """The first key of a path in a map or list, and what is left of the path, as the program takes them: of the keys that are there the
    longest that fits, so that names may have dots."""
    word = path.split(".", 1)[0]
    if isinstance(container, dict):
        there = [key for key in container if path == str(key) or path.startswith(f"{key}.")]
        if there:
            key = max(there, key=lambda key: len(str(key)))
            return key, path[len(str(key)) + 1 :]
    return int(word) if word.isdigit() else word, path[len(word) + 1 :]


def change(document, path, value):
    """document.a.1.b = value; None takes the key out. KeyError when the path leads nowhere."""
    key, rest = _step(document, path)
    while rest:
        try:
            document = document.setdefault(key, {}) if isinstance(document, dict) else document[key]
        except (IndexError, TypeError):
            raise KeyError(f"{path} leads nowhere: there is no '{key}'.") from None
        key, rest = _step(document, rest)
    if value is None and isinstance(document, dict):
        document.pop(key, None)
    elif isinstance(document, list) and key == len(document):
        document.append(value)
    else:
        document[key] = value


def demand_card(deck, path):
    """KeyError when a path leads into a joint, material or block that a deck has not: it would make one that nothing uses, and change nothing."""
    group, _, rest = path.partition(".")
    if group not in ("joints", "materials", "blocks"):
        return
    cards = dict.fromkeys(deck.get(group) or {})
    if group == "materials":  # also sets of the library that a block names
        cards.update((block.get("material"), None) for block in (deck.get("blocks") or {}).values())
    card, key = _step(cards, rest)
    if key and card not in cards:
        raise KeyError(f"{path}: the deck has no {group}.{card}; it has {', '.join(map(str, cards)) or 'none'}.")


def value_at(document, path):
    """document.a.1.b; KeyError when there is none."""
    rest = path
    while rest:
        key, rest = _step(document, rest)
        try:
            document = document[key]
        except (IndexError, KeyError, TypeError):
            raise KeyError(f"{path} leads nowhere: there is no '{key}'.") from None
    return document
