"""Decks in other units: every number of a deck has its unit in the schema that checks decks."""

import re

from coplane import program

from .meshes import CannotTell

# Powers of length, time and mass.
_SYMBOLS = {"m": (1, 0, 0), "s": (0, 1, 0), "kg": (0, 0, 1), "N": (1, -2, 1), "Pa": (-1, -2, 1), "J": (2, -2, 1), "rad": (0, 0, 0), "-": (0, 0, 0),
            "K": (0, 0, 0), "cycles": (0, 0, 0), "": (0, 0, 0)}  # fmt: skip


def powers(unit):
    """Of length, time and mass in a unit such as kg/m^3 or J/(kg K): (-3, 0, 1)."""
    found = [0, 0, 0]
    over = unit.replace("(", "").replace(")", "").split("/")
    for sign, part in zip((1, -1), over):
        for symbol in re.split(r"[ *]", part):
            name, _, exponent = symbol.partition("^")
            if name == "1":
                continue
            for i, power in enumerate(_SYMBOLS[name]):
                found[i] += sign * power * int(exponent or 1)
    return tuple(found)


def factor_of(unit, factors):
    """Of a quantity with this unit, where `factors` are what 1 m, 1 s and 1 kg are called."""
    result = 1.0
    for base, power in zip(factors, powers(unit)):
        result *= base**power
    return result


def _unit(schema):
    """The unit that a description of the schema names at its end; None where it names none."""
    if not isinstance(schema, dict):
        return None
    found = re.findall(r"\[([^\[\]]*)\](?:; (?:required|optional|default).*)?$", schema.get("description", "").split("; default")[0])
    return found[-1] if found and all(symbol in _SYMBOLS for symbol in re.findall(r"[A-Za-z]+", found[-1])) else None


def _expression(text, factor, factors):
    """In the old units inside, in the new ones outside."""
    length, time, _ = factors
    inner = re.sub(r"\b[xyz]\b", lambda found: f"({found.group(0)}/{length!r})", text)
    inner = re.sub(r"\bt\b", f"(t/{time!r})", inner)
    return f"{factor!r}*({inner})"


def _told(value, factor, factors):
    if isinstance(value, bool):
        return value
    if isinstance(value, (int, float)):
        return value * factor
    if isinstance(value, list):
        return [_told(item, factor, factors) for item in value]
    if isinstance(value, dict):
        return {"times": [t * factors[1] for t in value["times"]], "values": [v * factor for v in value["values"]]}
    return _expression(value, factor, factors) if isinstance(value, str) else value


def deck_in(deck, factors):
    """A deck whose numbers are those in other units; `factors` are what 1 m, 1 s and 1 kg are called. CannotTell: sets of the library, laws that
    hold constants of their own in SI.
    """
    for name, card in deck.get("materials", {}).items():
        if "set" in card or card.get("model") == "johnson_cook" or card.get("rate_effects"):
            raise CannotTell(f"material {name} has constants in SI")
    for name, block in deck["blocks"].items():
        if block["material"] not in deck.get("materials", {}):
            raise CannotTell(f"block {name} has a material of the library")
    if "define" in deck:
        raise CannotTell("numbers of `define` have no units")
    return _walk(deck, program.deck_schema(), factors)


def _properties(schema, value):
    """Keys of a group; where they hang on its type or model, those that this one has."""
    found = dict(schema.get("properties", {}))
    for part in schema.get("allOf", []):
        chosen = {key: item.get("const", item.get("enum")) for key, item in part.get("if", {}).get("properties", {}).items()}
        if all(key not in value or wanted == value[key] or isinstance(wanted, list) and value[key] in wanted for key, wanted in chosen.items()):
            found.update({name: item for name, item in part.get("then", {}).get("properties", {}).items() if item and not found.get(name)})
    return found


def _walk(value, schema, factors):
    if isinstance(value, dict) and (schema.get("type") == "object" or "properties" in schema):
        known, other = _properties(schema, value), schema.get("additionalProperties")
        told = {}
        for key, item in value.items():
            inner = known.get(key, other if isinstance(other, dict) else {})
            told[key] = _walk(item, inner, factors)
        return told
    if isinstance(value, list) and value and isinstance(value[0], dict) and "times" not in value[0] and "items" in schema:
        return [_walk(item, schema["items"], factors) for item in value]
    unit = _unit(schema)
    if unit is None or isinstance(value, str) and not re.search(r"\d|\bt\b", value):
        return value
    factor = factor_of(unit, factors)
    return value if powers(unit) == (0, 0, 0) and not (isinstance(value, (str, dict)) or _has_text(value)) else _told(value, factor, factors)


def _has_text(value):
    return isinstance(value, list) and any(isinstance(item, (str, dict)) for item in value)
