"""Decks: read, change, check, write."""

import functools
import io
import os
import pathlib
import re
import subprocess
import tempfile

from . import documents, program
from .needs import needs


class DeckError(ValueError):
    """A deck that is not as it has to be; the text names every fault."""


def _yaml():
    yaml = needs("ruamel.yaml", "Reading a deck with its comments").YAML()
    yaml.preserve_quotes = True
    yaml.width = 4096  # lines stay as they are
    yaml.indent(mapping=2, sequence=4, offset=2)
    yaml.Representer = _exact_numbers()
    return yaml


@functools.cache
def _exact_numbers():
    """Numbers with an exponent are written as they stood in the file where that is the same number. ruamel.yaml cuts digits off those
    with 16 and more, as records have them.
    """
    ruamel = needs("ruamel.yaml", "Reading a deck with its comments")

    class Representer(ruamel.representer.RoundTripRepresenter):
        def represent_scalar_float(self, data):
            node = super().represent_scalar_float(data)
            if float(node.value.replace("_", "")) != float(data):
                mantissa, exponent, power = repr(float(data)).partition("e")
                node.value = mantissa + ("" if "." in mantissa else ".0") + exponent + power
            return node

    Representer.add_representer(ruamel.scalarfloat.ScalarFloat, Representer.represent_scalar_float)
    return Representer


class Deck:
    """A deck whose values are named by their paths, as in `--set`: `deck["time.end"] = 0.1`, `del deck["contact.skin"]`,
    `deck["conditions.0.value"]`. Comments and the order of keys stay.
    """

    def __init__(self, document, path=None):
        self.document = documents.plain(document)
        self.path = pathlib.Path(path) if path else None

    @classmethod
    def read(cls, path):
        try:
            return cls(_yaml().load(pathlib.Path(path).read_text(encoding="utf-8")), path)
        except UnicodeDecodeError as error:
            raise DeckError(f"{path}: is no deck: it is not text in UTF-8 ({error}).") from error
        except needs("ruamel.yaml", "Reading a deck").error.YAMLError as error:
            raise DeckError(f"{path}: is no YAML: {error}") from error

    @classmethod
    def from_text(cls, text, path=None):
        return cls(_yaml().load(text), path)

    def copy(self):
        return Deck.from_text(self.text, self.path)

    @property
    def text(self):
        text = io.StringIO()
        _yaml().dump(self.document, text)
        return text.getvalue()

    def text_for(self, mesh):
        """The text with another mesh. The deck stays as it is; a copy of one with long tables takes long."""
        own, self["mesh"] = self["mesh"], str(mesh)
        try:
            return self.text
        finally:
            self["mesh"] = own

    @property
    def folder(self):
        """The mesh is sought from here."""
        return self.path.parent if self.path else pathlib.Path()

    @property
    def mesh(self):
        """Path of the mesh."""
        return self.folder / str(self["mesh"])

    def __getitem__(self, path):
        return documents.value_at(self.document, path)

    def __setitem__(self, path, value):
        documents.change(self.document, path, documents.plain(value))

    def __delitem__(self, path):
        self[path]
        documents.change(self.document, path, None)

    def __contains__(self, path):
        try:
            self[path]
        except KeyError:
            return False
        return True

    def get(self, path, default=None):
        return self[path] if path in self else default

    def write(self, path):
        """Writes the deck as it is, and is the deck of that path from then on. A mesh without a whole path is sought in the new folder."""
        pathlib.Path(path).write_text(self.text, encoding="utf-8")
        self.path = pathlib.Path(path)

    def _faults(self):
        """Errors of jsonschema."""
        validator = needs("jsonschema", "Checking a deck against its schema").Draft7Validator(program.deck_schema())
        plain = documents.parse(self.text)  # as Coplane reads it: numbers such as 5e10 are none to every reader of YAML
        return list(validator.iter_errors(plain))

    def _described(self, fault):
        return f"{self.line(fault.absolute_path)}: {'.'.join(map(str, fault.absolute_path)) or 'deck'}: {fault.message}"

    def schema_errors(self):
        """What the JSON Schema of decks finds, each with its line, the path of the value, and what is wrong there."""
        return [self._described(fault) for fault in self._faults()]

    def line(self, keys):
        """Number of the line, from 1, on which the value that these keys lead to begins in the file that was read; of a new one: that of the group
        around it."""
        document, line = self.document, 0
        for key in keys:
            if getattr(document, "lc", None) and key in (document.lc.data or {}):
                line = document.lc.data[key][0]
            document = document[key]
        return line + 1

    def check(self):
        """What `coplane --check` prints: masses, step, contact before the first step. DeckError with every fault that the schema or the
        program finds.
        """
        faults = self._faults()
        # Beside the deck, because names of files in it begin there.
        if os.access(self.folder, os.W_OK):
            code, printed = self._checked(self.folder)
        else:
            with tempfile.TemporaryDirectory() as folder:
                moved = self.copy()
                if "mesh" in moved:
                    moved["mesh"] = str(self.mesh.resolve())
                code, printed = moved._checked(folder)
        # Of keys that are not known the program says more.
        errors = [f"{self.path or 'deck'}:{self._described(fault)}" for fault in faults
                  if fault.validator != "additionalProperties" or not all(f"{key} is not known" in printed for key in re.findall("'(.*?)'", fault.message))]
        if errors or code:
            raise DeckError("\n".join([*errors, *([printed.strip()] if code else [])]))
        return printed

    def _checked(self, folder):
        """Exit code and words of `coplane --check`, of a copy of the deck in a folder."""
        with tempfile.NamedTemporaryFile("w", encoding="utf-8", dir=folder, prefix=".check-", suffix=".yaml") as file:
            file.write(self.text)
            file.flush()
            done = subprocess.run(program.command([os.path.abspath(file.name), "--check"]), cwd=folder, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True)  # fmt: skip
        return done.returncode, done.stdout.replace(os.path.abspath(file.name), str(self.path or "deck"))
