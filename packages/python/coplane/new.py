"""`coplane new`: a folder of one's own with deck, recipe and check, like one of the examples."""

import argparse
import difflib
import os
import pathlib
import re
import shlex
import shutil
import sys

from . import documents, program
from .deck import Deck

EXAMPLES = program.TOP / "exodus_inputs"


class NotMade(Exception):
    """The folder was not made; the text says why."""


def examples():
    """Titles by name."""
    return {path.parent.name: documents.load(path)["title"] for path in sorted(EXAMPLES.glob("*/example.yaml"))}


def listed():
    titles = examples()
    if not titles:
        return f"There are no examples in {EXAMPLES}: the package is used without the rest of Coplane."
    width = max(map(len, titles))
    return "Examples:\n" + "".join(f"  {name:<{width}}  {title}\n" for name, title in titles.items())


def texts_of(example):
    """Texts by name of file of an example; of another one, too, whose files it uses (../perforation/check.py)."""
    own = EXAMPLES / example
    texts = {path.name: path.read_text(encoding="utf-8") for path in sorted(own.iterdir())
             if path.is_file() and path.name != "README.md"}  # fmt: skip
    beside = r"(?<!\.\./)\.\./([\w-]+)/"
    for other in dict.fromkeys(re.findall(beside, texts["example.yaml"])):
        texts = {**{name: text for name, text in texts_of(other).items() if name != "example.yaml"}, **texts}
    texts["example.yaml"] = re.sub(beside, "", texts["example.yaml"])
    return texts


def in_size(texts, size):
    """Of the texts of an example what one of its sizes needs (None: its default), with the values of that size in recipe and deck; and the
    example.yaml of the new folder as a dictionary: one size that changes nothing, and no variants, nor a summary of several runs."""
    example = documents.parse(texts["example.yaml"])
    sizes = example["sizes"]
    size = size or example.get("default", next(iter(sizes)))
    if size not in sizes:
        raise NotMade(f"--size {size}: the example has no such size; it has {', '.join(sizes)}.")
    chosen = sizes[size] or {}
    settings = {"recipe": "mesh.yaml", "deck": "deck.yaml", **example, **chosen}
    for file, changes in ((settings["recipe"], "mesh"), (settings["deck"], "set")):
        if chosen.get(changes):
            document = Deck.from_text(texts[file])
            as_written = Deck.from_text(texts["example.yaml"]).document["sizes"][size][changes]  # 5e-3 stays 5e-3
            for path, value in as_written.items():
                document[path] = value
            texts[file] = document.text
    inputs = [settings[key] for key in ("recipe", "deck", "joints") if key in settings]
    summary = settings.get("summary", "summary.py")
    texts = {file: text for file, text in texts.items() if file in inputs or not file.endswith(".yaml") and file != summary}
    kept = ("title", "recipe", "joints", "deck", "check", "pictures", "ranks")
    return texts, {**{key: settings[key] for key in kept if key in settings}, "sizes": {size: {}}}


def renamed(texts, settings, example, name):
    """The texts of an example for a folder of this name: the deck is <name>.yaml and its mesh mesh.e; with its example.yaml."""
    if f"{name}.yaml" in texts.keys() - {settings["deck"]}:
        raise NotMade(f"{name}: the example has a file {name}.yaml that is not its deck. Choose another name.")
    texts = {**texts, "example.yaml": "# yaml-language-server: $schema=/example.json\n" + documents.text(settings)}
    for file, text in texts.items():
        text = re.sub(r"(?<![\w-])" + re.escape(example) + r"(?![\w-])", name, text)
        texts[file] = re.sub(r"\$schema=\S*/([\w-]+)\.json", lambda found: f"$schema={program.schema(found[1])}", text)
    for file in [file for file in texts if file.endswith(".py")]:
        text = texts[file].replace("sys.path.insert(0, str(HERE.parent))", f"sys.path.insert(0, {str(EXAMPLES)!r})")  # of coplanetools
        texts[file] = re.sub(r"(?<![\w-])" + re.escape(settings["deck"]) + r"(?![\w-])", f"{name}.yaml", text)
    texts[f"{name}.yaml"] = re.sub(r"^mesh: .*$", "mesh: mesh.e", texts.pop(settings["deck"]), count=1, flags=re.M)
    texts["example.yaml"] = re.sub(r"^deck: .*$", f"deck: {name}.yaml", texts["example.yaml"], flags=re.M)
    return texts


def mesh_commands(folder, settings):
    """Arguments of coplane_mesh that make mesh.e of the recipe, with its joints opened where the example has some."""
    joints = settings.get("joints")
    commands = [["make", folder / settings.get("recipe", "mesh.yaml"), "-o", folder / ("whole.e" if joints else "mesh.e")]]
    return commands + ([["split", folder / "whole.e", folder / joints, "-o", folder / "mesh.e"]] if joints else [])


def new(folder, example, size=None):
    """Makes the folder, like an example in one of its sizes (None: its default), and returns its path. NotMade when there is something already, or
    no such example or size; ProgramFailed when its mesh cannot be made."""
    folder = pathlib.Path(folder)
    name = folder.name
    if not re.fullmatch(r"[A-Za-z]\w*([-.]\w+)*", name, flags=re.ASCII) or name.endswith(".yaml"):
        raise NotMade(f"{folder}: accepted as the name of the folder, which is that of the deck, too: letters, digits, _ and -, a letter first.")
    if example not in examples():
        near = difflib.get_close_matches(example, examples(), 1, 0.5)
        raise NotMade(f"--like {example}: there is no such example.{f' Did you mean {near[0]}?' if near else ''}\n{listed()}")
    if os.path.lexists(folder):
        raise NotMade(f"{folder}: is there already. Nothing was changed; choose another name.")
    texts = renamed(*in_size(texts_of(example), size), example, name)
    folder.mkdir(parents=True)
    try:
        for file, text in texts.items():
            (folder / file).write_text(text, encoding="utf-8")
            if text.startswith("#!"):
                (folder / file).chmod(0o755)
        for command in mesh_commands(folder, documents.parse(texts["example.yaml"])):
            program.mesh_program(*command)
    except BaseException:
        shutil.rmtree(folder)
        raise
    return folder


def told(folder, example):
    """What is there, and what to do with it."""

    def line(*words):
        return "  " + shlex.join(map(str, words)) + "\n"

    check = ", check.py: what must be true of the results" if (folder / "check.py").exists() else ""
    return (f"{folder}: like {example} ({examples()[example]})\n"
            f"  {folder.name}.yaml: the deck, mesh.yaml: the recipe of its mesh, mesh.e: the mesh\n"
            f"  example.yaml: what run.py needs{check}\n"
            "Run it here:\n" + line("coplane", folder / f"{folder.name}.yaml")
            + "After a change of the recipe:\n"
            + "".join(line("coplane_mesh", *command) for command in mesh_commands(folder, documents.load(folder / "example.yaml")))
            + f"Or all at once, with checks, pictures and a report, in {folder / 'runs'}:\n" + line(EXAMPLES / "run.py", folder))  # fmt: skip


def main():
    parser = argparse.ArgumentParser(prog="coplane new", formatter_class=argparse.RawDescriptionHelpFormatter, epilog=listed(),
                                     description="Makes a folder with deck, recipe, mesh and check, like an example, to be changed.")
    parser.add_argument("name", nargs="?", help="the folder, which must not exist; the deck in it gets its name")
    parser.add_argument("--like", metavar="EXAMPLE", help="one of the examples below")
    parser.add_argument("--size", help="one of the sizes of the example, as `run.py --list` prints them; default: its own")
    options = parser.parse_args()
    missing = [word for word, given in (("NAME", options.name), ("--like EXAMPLE", options.like)) if given is None]
    if missing:
        parser.exit(2, f"ERROR: {' and '.join(missing)} missing: coplane new NAME --like EXAMPLE makes the folder NAME.\n{listed()}")
    try:
        folder = new(options.name, options.like, options.size)
    except (NotMade, program.ProgramFailed, FileNotFoundError, ImportError) as error:
        parser.exit(2, f"ERROR: {error}\n")
    except OSError as error:
        parser.exit(5, f"ERROR: {options.name} cannot be made: {error}\n")
    print(told(folder, options.like), end="")
