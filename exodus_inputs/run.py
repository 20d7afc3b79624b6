#!/usr/bin/python3
"""Runs an example and draws its pictures.

    exodus_inputs/run.py --list
    exodus_inputs/run.py projectile_wall_2d
    exodus_inputs/run.py projectile_wall_2d --size M --variant B
    exodus_inputs/run.py jointed_rock_2d --variant a b c --no-pictures
    exodus_inputs/run.py ~/problems/wall

An example is a folder beside this file, or any other, with an `example.yaml` that names its sizes and variants: what they change in the
mesh recipe and in the deck; a folder of your own may have a deck.yaml and a mesh.yaml alone. `coplane new` makes one. A run makes, in its
folder (default NAME/SIZE or NAME/SIZE-VARIANT in build/examples; of an installed run.py in coplane-examples, in the working folder; of a
folder elsewhere in `runs` there),

    mesh.yaml, mesh.e    the recipe with all changes, and its mesh
    run.yaml             the deck with all changes
    run.log, run.e, run_planes.xmf3, run.csv, run.run.json     what coplane writes
    run-report.html      all of it on one page (coplane report)
    pictures/            what `pictures` of the example.yaml, or its pictures.py, says
    checks.jsonl         what the example's check.py found
    written.json         the list of all these: nothing else in the folder is ever removed or overwritten

What is complete is not done again as long as the deck, the mesh and the program stay the same. `a+b` combines two variants;
several variants are run one after the other. Needs Python 3 with yaml, numpy and netCDF4, and for pictures ParaView:
packages/cmake/dependencies.sh --with-paraview installs all of it on Debian 12.
"""

import argparse
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import time

INPUTS = pathlib.Path(__file__).resolve().parent
TOP = INPUTS.parent
# In the source tree, or installed in PREFIX/share/coplane.
IS_INSTALLED = not (TOP / "CMakeLists.txt").exists()
BINARIES = TOP.parents[1] / "bin" if IS_INSTALLED else TOP / "build/bin"
RUNS = pathlib.Path("coplane-examples").resolve() if IS_INSTALLED else TOP / "build/examples"
sys.dont_write_bytecode = True
try:
    from coplanetools import documents, program
    from coplane import pictures, report
except ImportError as error:
    what = (error.name or "").partition(".")[0]
    if what in ("coplane", "coplanetools"):
        folders = {"coplane": "packages/python of the source tree, or share/coplane/python of the installation", "coplanetools": "exodus_inputs of both"}
        sys.exit(f"run.py: the Python package {what} is not where a run.py in {INPUTS} seeks it. It is in {folders[what]}: start the run.py there, "
                 f"on a folder anywhere (`coplane new` makes one like an example), or put that folder on PYTHONPATH.")
    debian = {"yaml": "python3-yaml", "numpy": "python3-numpy", "netCDF4": "python3-netcdf4"}.get(what)
    sys.exit(f"run.py: {error}. {f'Install {debian}' if debian else 'It needs python3-yaml, python3-numpy and python3-netcdf4'}, and start this with "
             "Debian's /usr/bin/python3.")


def fail(message):
    sys.exit(f"run.py: {message}")


def examples():
    return sorted(path.parent.name for path in INPUTS.glob("*/example.yaml"))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", nargs="?", help="name of the example, or a folder anywhere")
    parser.add_argument("--list", action="store_true", help="print the examples with their sizes and variants")
    parser.add_argument("--size", help="one of the example's sizes; default: its `default`")
    parser.add_argument("--variant", nargs="+", default=[""], help="one or more of its variants; base: none; a+b: both together")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE",
                        help="one more change of the deck; results of the deck without it are replaced in its folder (-o: another folder)")
    parser.add_argument("--ranks", type=int, help="MPI ranks; default: as the example says, else 2")
    parser.add_argument("-o", "--output", type=pathlib.Path, help="folder of the run; of several runs: a folder in it for each")
    parser.add_argument("--overwrite", action="store_true",
                        help="also files of the same names in the folder that this program has not written")
    parser.add_argument("--no-pictures", action="store_true", help="compute and check only")
    parser.add_argument("--no-check", action="store_true", help="do not look at the results")
    return parser.parse_args()


def folder_of(name):
    """The folder that a name means: such a folder, else the example beside this file."""
    path = pathlib.Path(name)
    if any((path / file).exists() for file in ("example.yaml", "deck.yaml")):
        return path.resolve()
    if not (INPUTS / name / "example.yaml").exists():
        fail(f"there is no example '{name}', and no such folder with an example.yaml, or with deck.yaml and mesh.yaml; there are "
             f"{', '.join(examples())}. `coplane new` makes a folder.")
    return INPUTS / name


def read_example(source):
    path = source / "example.yaml"
    if not path.exists():
        return {"title": source.name, "sizes": {"S": {}}}
    os.environ.setdefault("COPLANE_BIN", str(BINARIES))
    reader = program.binary("coplane_mesh")
    if not os.path.exists(reader):
        return documents.load(path)  # to be listed: nothing is run without the programs
    done = subprocess.run([reader, "example", str(path)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        fail(done.stderr.strip())
    return json.loads(done.stdout)


def change(document, path, value, is_deck=False):
    try:
        if is_deck:
            documents.demand_card(document, path)
        documents.change(document, path, value)
    except KeyError as error:
        fail(error.args[0])


class OwnFiles:
    """The files in a folder that this program and those that it starts have written, as the list written.json in it says. Only
    these are removed or overwritten, whatever their names."""

    LIST = "written.json"

    def __init__(self, folder):
        self.folder = folder
        self.names = set()
        try:
            self.names = {str(name) for name in json.loads((folder / self.LIST).read_text())}
        except FileNotFoundError:
            pass
        except (ValueError, TypeError):
            fail(f"{folder / self.LIST}, the list of what an earlier run wrote, is damaged. Remove it, and start again with --overwrite or "
                 "in another folder.")
        self.names.add(self.LIST)
        # A run that was killed could not list its planes: the series that it kept does.
        for series in [name for name in self.names if name.endswith(".pvd")]:
            if (folder / series).is_file():
                self.names.update(re.findall(r'file="(run_planes_[0-9]+\.vtp)"', (folder / series).read_text(errors="replace")))

    def claim(self, names, overwrite):
        """Before the first of these is written. Refuses when one is there that is not ours."""
        foreign = sorted(name for name in names if name not in self.names and os.path.lexists(self.folder / name))
        if foreign and not overwrite:
            fail(f"{self.folder} has files of the names that the run writes, but no earlier run wrote them: {', '.join(foreign)}. "
                 "Nothing was changed. Choose another folder, move them away, or say --overwrite.")
        self.names.update(names)
        self.save()

    def save(self):
        draft = self.folder / (self.LIST + ".part")
        draft.write_text(json.dumps(sorted(self.names), indent=0) + "\n")
        os.replace(draft, self.folder / self.LIST)

    def remove(self, keep):
        for name in sorted(self.names - set(keep) - {self.LIST}):
            path = self.folder / name
            if path.is_file() or path.is_symlink():
                path.unlink()
        self.names &= set(keep) | {self.LIST}

    def there(self):
        return {str(path.relative_to(self.folder)) for path in self.folder.rglob("*") if not path.is_dir() or path.is_symlink()}


class ExampleRun:
    """One run: an example in one size, with the changes of one variant (or a combination)."""

    def __init__(self, source, example, size, variant, options):
        sizes, variants = example["sizes"], example.get("variants") or {}
        self.source, self.name, self.example, self.size = source, source.name, example, size
        if size not in sizes:
            fail(f"{self.name} has no size '{size}'; it has {', '.join(sizes)}.")
        chosen = [item for item in variant.split("+") if item and item != "base"]
        self.variant = variant = "+".join(chosen)
        for item in chosen:
            if item not in variants:
                fail(f"{self.name} has no variant '{item}'; it has {', '.join(variants) or 'none'}.")
        self.settings = {"recipe": "mesh.yaml", "deck": "deck.yaml", "ranks": 2}
        changes = [example, sizes[size] or {}] + [variants[item] or {} for item in chosen]
        for item in changes:
            self.settings.update({key: item[key] for key in ("title", "recipe", "joints", "deck", "ranks") if key in item})
        self.ranks = options.ranks or self.settings["ranks"]
        for key in ("recipe", "deck"):
            if not (source / self.settings[key]).exists():
                fail(f"{source / self.settings[key]}, the {key} of {self.name}, is not there.")
        self.recipe = documents.load(source / self.settings["recipe"])
        self.deck = documents.load(source / self.settings["deck"])
        self.joints = documents.load(source / self.settings["joints"]) if self.settings.get("joints") else None
        self.changed = {}  # by example.yaml: values by path, by file
        for item in changes[1:]:
            for key, document, file in (("mesh", self.recipe, self.settings["recipe"]), ("set", self.deck, self.settings["deck"])):
                for path, value in (item.get(key) or {}).items():
                    change(document, path, value, is_deck=key == "set")
                    self.changed.setdefault(file, {})[path] = value
        for text in options.set:
            path, equals, value = text.partition("=")
            if not equals:
                fail(f"--set {text}: KEY=VALUE is accepted, for instance time.end=1e-3.")
            change(self.deck, path, documents.parse(value), is_deck=True)
        self.deck["mesh"] = "mesh.e"
        self.deck.setdefault("output", {}).pop("results", None)
        self.deck.setdefault("history", {}).pop("file", None)
        self.overwrite = options.overwrite
        label = size + ("-" + variant if variant else "")
        if options.output is None:
            self.folder = (RUNS / self.name if source.parent == INPUTS else source / "runs") / label
        elif len(options.variant) > 1:
            self.folder = options.output.resolve() / label
        else:
            self.folder = options.output.resolve()

    def say(self, message):
        print(f"{self.name} {self.size}{' ' + self.variant if self.variant else ''}: {message}", flush=True)

    def key(self, *parts):
        digest = hashlib.sha256()
        for part in parts:
            digest.update(part if isinstance(part, bytes) else pathlib.Path(part).read_bytes())
        return digest.hexdigest()

    def is_done(self, stamp, key):
        path = self.folder / stamp
        return path.exists() and path.read_text() == key

    def new_files(self, before):
        """Of those that were not there before: what coplane and the pictures add to the names that are known beforehand."""
        pattern = re.compile(r"run_planes_[0-9]+\.vtp|run\.e[.-].*|run\.run-s[0-9]+\.json|run\.chk\..*|pictures/.*")
        return {name for name in self.own.there() - before if pattern.fullmatch(name)}

    def call(self, command, log, environment=None):
        """Runs a program in the folder; its output goes to a file too. Returns the exit code."""
        with open(self.folder / log, "w") as file:
            process = subprocess.Popen(
                command, cwd=self.folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            for line in process.stdout:
                file.write(line)
                file.flush()
                print(line, end="", flush=True)
            return process.wait()

    def compute(self):
        """Mesh and run. Returns whether anything was done."""
        for name in ("coplane", "coplane_mesh"):
            if not os.path.exists(program.binary(name)):
                fail(f"{program.binary(name)} is missing. packages/cmake/main-job.sh builds it, or set COPLANE_BIN to its folder.")
        self.folder.mkdir(parents=True, exist_ok=True)
        self.own = OwnFiles(self.folder)
        history = self.deck.get("history") or {}
        self.results = ["run.csv", "run.run.json"] + [f"run_{table}.csv" for table in history.get("tables") or []]
        self.results += [] if (self.deck.get("output") or {}).get("results") == "none" else ["run.e"]
        made = ["mesh.yaml", "run.yaml", "mesh.e", "example.json", "run.log", "done", "pictures.done", "pictures.log", "checks.jsonl",
                "run-report.html", "run_planes.pvd", "run_planes_0000.vtp", "run_planes.vtkhdf", "run_planes.xmf3", "run.chk.0", "run.chk.1", *self.results]
        if self.joints is not None:
            made += ["joints.yaml", "whole.e"]
        self.own.claim(made, self.overwrite)
        documents.save(self.recipe, self.folder / "mesh.yaml")
        documents.save(self.deck, self.folder / "run.yaml")
        inputs = [self.folder / "mesh.yaml", self.folder / "run.yaml", program.binary("coplane"), program.binary("coplane_mesh")]
        if self.joints is not None:
            documents.save(self.joints, self.folder / "joints.yaml")
            inputs.append(self.folder / "joints.yaml")
        self.run_key = self.key(*inputs)
        if self.is_done("done", self.run_key) and all((self.folder / name).exists() for name in self.results):
            self.say(f"computed already, in {self.folder}")
            return
        for file, values in self.changed.items():
            self.say(f"example.yaml changes {file}: " + ", ".join(f"{path}: {json.dumps(value)}" for path, value in values.items()))
        self.own.remove(keep=["mesh.yaml", "run.yaml", "joints.yaml"])
        self.own.claim(made, self.overwrite)
        before = self.own.there()
        self.say(f"making the mesh in {self.folder}")
        whole = "whole.e" if self.joints is not None else "mesh.e"
        try:
            program.make_mesh(self.folder / "mesh.yaml", self.folder / whole)
            if self.joints is not None:
                program.split_mesh(self.folder / whole, self.folder / "joints.yaml", self.folder / "mesh.e")
        except program.ProgramFailed as error:
            fail(error)
        (self.folder / "example.json").write_text(json.dumps(
            {"example": self.name, "source": str(self.source), "size": self.size, "variant": self.variant, "ranks": self.ranks}))
        command = program.command(["run.yaml", "--backend", "serial"], self.ranks)
        self.say("running: " + " ".join(command))
        start = time.monotonic()
        code = self.call(command, "run.log")
        self.own.claim(self.new_files(before), overwrite=True)
        if code:
            self.report()
            fail(f"coplane ended with exit code {code}; see {self.folder}/run.log and docs/user/exit-codes.md.")
        self.say(f"computed in {time.monotonic() - start:.0f} s")
        (self.folder / "done").write_text(self.run_key)

    def picture_script(self):
        """Of an example whose pictures `coplane pictures` cannot make."""
        return self.source / "pictures.py"

    def demand_what_draws(self):
        """Before anything is computed."""
        missing = program.missing_for_pictures()
        if missing and (self.picture_script().exists() or self.example.get("pictures")):
            fail(f"{' and '.join(missing)} not found, which the pictures need. Debian: apt-get install paraview python3-paraview xvfb xauth. "
                 "Or leave the pictures out with --no-pictures.")

    def draw(self):
        script, cards = self.picture_script(), self.example.get("pictures") or {}
        own = [script] if script.exists() else []
        if not own and not cards:
            if program.missing_for_pictures():
                return
            cards = {"state": {"color": "von_mises"}}  # drawn as any run
        key = self.key(self.run_key.encode(), json.dumps(cards).encode(), *own, *sorted(program.PARAVIEW.glob("*.py")))
        if self.is_done("pictures.done", key):
            return
        self.say("drawing")
        before = self.own.there()
        (self.folder / "pictures").mkdir(exist_ok=True)
        if own:
            code, said = program.run_paraview(script, [".", "pictures"], self.folder)
            (self.folder / "pictures.log").write_text(said)
            if code:
                fail("drawing failed:\n" + "".join(said.splitlines(True)[-20:]))
        for name, card in cards.items():
            words = [str(self.folder / "run"), "--output", str(self.folder / "pictures"), "--name", name, *pictures.words_of(card or {})]
            try:
                for path in pictures.make(words):
                    print(path, flush=True)
            except (OSError, ValueError, pictures.PicturesFailed) as error:
                fail(f"drawing failed: coplane pictures {' '.join(words)}: {error}")
        self.own.claim(self.new_files(before), overwrite=True)
        (self.folder / "pictures.done").write_text(key)
        self.say(f"pictures: {self.folder}/pictures")

    def report(self):
        """The page of the run; what has been computed is worth as much without it."""
        try:
            self.say(f"report: {report.make(self.folder / 'run', pictures=False)}")
        except Exception as error:  # noqa: BLE001 (whatever it is)
            self.say(f"no report: {error}")

    def check(self):
        """The example's own check.py on the results; returns whether all is well."""
        script = self.source / self.example.get("check", "check.py")
        return not script.exists() or python(script, [self.folder], self.folder) == 0


def python(script, parameters, folder):
    path = os.pathsep.join([str(INPUTS), os.environ.get("PYTHONPATH", "")]).rstrip(os.pathsep)
    environment = dict(os.environ, PYTHONPATH=path, PYTHONDONTWRITEBYTECODE="1")
    return subprocess.run([sys.executable, str(script), *map(str, parameters)], cwd=folder, env=environment).returncode


def main():
    options = arguments()
    if options.list or not options.name:
        for name in examples():
            example = read_example(INPUTS / name)
            print(f"{name}: {example['title']}\n    sizes: {', '.join(example['sizes'])}"
                  + (f"; variants: {', '.join(example['variants'])}" if example.get("variants") else ""))
        return
    source = folder_of(options.name)
    example = read_example(source)
    size = options.size or example.get("default", next(iter(example["sizes"])))
    runs = [ExampleRun(source, example, size, variant, options) for variant in options.variant]
    well = True
    for run in runs:
        if not options.no_pictures:
            run.demand_what_draws()
        run.compute()
        if not options.no_check:
            well = run.check() and well
        try:
            if not options.no_pictures:
                run.draw()
        finally:
            run.report()
    summary = source / example.get("summary", "summary.py")
    if summary.exists() and not options.no_check:
        well = python(summary, [run.folder for run in runs], runs[0].folder) == 0 and well
    for run in runs:
        planes = [f", {name} (contact planes)" for name in ("run_planes.xmf3", "run_planes.pvd") if (run.folder / name).exists()]
        run.say(f"results: {run.folder}/run.e (fields){''.join(planes[:1])}, run.csv (history)")
    sys.exit(0 if well else 1)


if __name__ == "__main__":
    main()
