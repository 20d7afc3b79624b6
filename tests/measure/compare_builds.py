#!/usr/bin/env python3
"""Two builds of the program side by side: whether every run has the same bits, and how much processor time each takes.

    python3 tests/measure/compare_builds.py BEFORE/bin AFTER/bin [NAME ...] [--turns N] [--jobs N] > table.md

Runs the examples of exodus_inputs in their coarse size, the scenes of tests/parallel, the decks of coplane_point, and every deck that the cases of
tests/verification run: their check.py is executed once, and each run that it asks for is made with both programs, in turns, from the mesh of the first, the second time in the
folder `after`. That the second one's mesh is the same is checked, too. NAMEs choose some of them and may have * and ?.

A row compares the runs of a case: how many have the same state hash, the same bytes in all their tables (history among them) and the same exit
code; processor seconds of runs on one rank and thread; their ratio, above 1 where the second build is faster. Runs of less than a second say little
about speed: the last row adds up those of a second and more. runs.jsonl in the folder has every run.

The exit code is 0 when all runs are equal. A check that fails is named, but changes nothing: decks are compared, not answers.
"""

import argparse
import contextlib
import fnmatch
import hashlib
import json
import multiprocessing
import os
import pathlib
import runpy
import shutil
import subprocess
import sys
import threading
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/support"))
sys.dont_write_bytecode = True
import netCDF4  # noqa: E402
from coplanetest import Case, examples, program, scenes  # noqa: E402

LEAST_SECONDS = 1.0  # of a run that says something about speed


class TwoBuilds:
    """Takes the place of program.run_program: the run in the folder with the first build, the same in a folder `after` with the second."""

    def __init__(self, folders, record, turns):
        self.folders, self.record, self.turns = folders, record, turns
        self.done = set()
        self.first = 0  # which build begins
        self.mesh_program = program.mesh_program

    def __call__(self, arguments, folder, ranks=1, prefix=(), timeout=550):
        first = pathlib.Path(folder)
        second = pathlib.Path("after", os.path.relpath(first)).resolve()
        if "--restart" not in arguments:
            if self.is_known(arguments, first):  # the same on other ranks: the same bits
                return self.run(self.folders[0], arguments, first, ranks, prefix, timeout)[:2]
            shutil.rmtree(second, ignore_errors=True)
            shutil.copytree(first, second)
        start = None
        if self.turns > 1 and "--restart" not in arguments:
            start = pathlib.Path("start").resolve()
            shutil.rmtree(start, ignore_errors=True)
            shutil.copytree(first, start)
        ended, seconds = {}, {0: [], 1: []}
        for turn in range(self.turns if start else 1):
            for which in (0, 1) if self.first == 0 else (1, 0):
                place = (first, second)[which]
                if turn:
                    shutil.rmtree(place)
                    shutil.copytree(start, place)
                *ended[which], used = self.run(self.folders[which], arguments, place, ranks, prefix, timeout)
                seconds[which].append(used)
            self.first = 1 - self.first
        one_thread = "--threads" not in arguments or str(arguments[arguments.index("--threads") + 1]) == "1"
        self.compare(first, second, ended, [min(seconds[0]), min(seconds[1])] if ranks == 1 and one_thread else None)
        return tuple(ended[0])

    def mesh(self, *arguments):
        """Takes the place of program.mesh_program: the first build's mesh is used; another one of the second build is told."""
        printed = self.mesh_program(*arguments)
        words = list(map(str, arguments))
        if "-o" in words:
            made = pathlib.Path(words[words.index("-o") + 1])
            words[words.index("-o") + 1] = "second.e"
            code = self.timed([os.path.join(self.folders[1], "coplane_mesh"), *words], ".", 550)[0]
            if code or contents(made) != contents(pathlib.Path("second.e")):
                self.write({"run": f"mesh {os.path.relpath(made)}", "code": [0, code], "state": ["mesh", "another mesh"], "tables_that_differ": [], "seconds": None})
        return printed

    def points(self, deck, folder):
        """The paths of a deck of coplane_point, with both builds."""
        places = [pathlib.Path(folder).resolve(), pathlib.Path("after", folder).resolve()]
        ended = []
        for build, place in zip(self.folders, places):
            place.mkdir(parents=True)
            ended.append(self.timed([os.path.join(build, "coplane_point"), str(deck)], place, 550))
        self.compare(*places, [run[:2] for run in ended], [run[2] for run in ended])

    def is_known(self, arguments, folder):
        """Whether the run has been compared already, on whatever ranks and threads."""
        words, key = list(map(str, arguments)), hashlib.sha256()
        for option in ("--backend", "--threads"):
            if option in words:
                del words[words.index(option) : words.index(option) + 2]
        key.update("\0".join(words).encode())
        for path in sorted(path for path in folder.rglob("*") if path.is_file()):
            key.update(contents(path))
        known = key.digest() in self.done
        self.done.add(key.digest())
        return known

    def run(self, build, arguments, folder, ranks, prefix, timeout):
        """Exit code, output, processor seconds of the program and all that it starts."""
        os.environ["COPLANE_BIN"] = build
        command = program.command([str(argument) for argument in arguments], ranks, prefix)
        os.environ["COPLANE_BIN"] = self.folders[0]
        return self.timed(list(map(str, command)), folder, timeout)

    @staticmethod
    def timed(command, folder, timeout):
        with open(pathlib.Path(folder, "compared.log"), "w+") as log:
            process = subprocess.Popen(command, cwd=folder, stdout=log, stderr=subprocess.STDOUT)
            limit = threading.Timer(timeout, process.kill)
            limit.start()
            _, status, usage = os.wait4(process.pid, 0)
            limit.cancel()
            process.returncode = os.waitstatus_to_exitcode(status)
            log.seek(0)
            return process.returncode, log.read(), usage.ru_utime + usage.ru_stime

    def compare(self, first, second, ended, seconds):
        names = {path.name for place in (first, second) for path in place.glob("*.csv")}
        states = [state_hash(place, code) for place, (code, _) in ((first, ended[0]), (second, ended[1]))]
        self.write({
            "run": os.path.relpath(first), "code": [ended[0][0], ended[1][0]], "state": states,
            "tables_that_differ": sorted(name for name in names if not same_bytes(first / name, second / name)),
            "seconds": [round(used, 3) for used in seconds] if seconds else None,
        })  # fmt: skip

    def write(self, line):
        with open(self.record, "a") as file:
            file.write(json.dumps(line) + "\n")


def contents(path):
    """Bytes of a file; of a mesh those of its variables, without the records of when it was made."""
    if path.suffix != ".e":
        return path.read_bytes()
    with netCDF4.Dataset(path) as file:
        file.set_auto_mask(False)
        return b"".join(variable[:].tobytes() for name, variable in sorted(file.variables.items()) if name not in ("qa_records", "info_records"))


def state_hash(folder, code):
    """Of the last record that the run has left; of a run that failed, and of coplane_point, the exit code."""
    records = sorted(folder.glob("*.run*.json"), key=lambda path: path.stat().st_mtime)
    if records and code == 0:
        return json.loads(records[-1].read_text())["state_hash"]
    return f"exit code {code}"


def same_bytes(a, b):
    return a.exists() and b.exists() and a.read_bytes() == b.read_bytes()


def everything():
    """What may be chosen: name -> what makes its runs."""

    def run_example(name):
        case = Case(f"example {name}", __file__)
        recipe, deck, joints = examples.coarse(name)
        case.attempt("run", recipe, deck, joints=joints)

    def run_scene(name):
        case = Case(f"scene {name}", __file__)
        recipe, deck, joints, _ = scenes.scene_of(case, name)
        case.attempt("run", recipe, deck, joints=joints)

    def run_points(decks):
        for deck in sorted((examples.INPUTS / decks).glob("*.yaml")):
            program.run_program.points(deck, deck.stem)

    def run_check(path):
        sys.argv = [str(path)]
        runpy.run_path(str(path), run_name="__main__")

    found = {f"example {name}": (run_example, name) for name in examples.names()}
    found.update({f"scene {name}": (run_scene, name) for name in scenes.NAMES})
    found.update({f"points {decks}": (run_points, decks) for decks in ("joint_paths", "material_paths")})
    for path in sorted((SOURCE / "tests/verification").glob("*/check.py")):
        found[path.parent.name] = (run_check, path)
    return found


def make(job):
    """All runs of one case, in a folder of its own; what is wrong with its check."""
    name, builds, top, turns = job
    folder = top / name.replace(" ", "_")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    os.chdir(folder)
    os.environ.update(COPLANE_BIN=builds[0], COPLANE_SOURCE=str(SOURCE))
    os.environ.pop("COPLANE_CHECKS_DIR", None)
    program.run_program = TwoBuilds(builds, folder / "runs.jsonl", turns)
    program.mesh_program = program.run_program.mesh
    wrong = []
    with open("check.log", "w") as log, contextlib.redirect_stdout(log), contextlib.redirect_stderr(log):
        function, argument = everything()[name]
        try:
            function(argument)
        except SystemExit as end:
            wrong = [str(end.code or "").strip().partition("\n")[0]]
        except Exception as error:  # noqa: BLE001 (whatever it is, other cases go on)
            wrong = [f"{type(error).__name__}: {error}".splitlines()[0]]
    lines = [json.loads(line) for line in (folder / "runs.jsonl").read_text().splitlines()] if (folder / "runs.jsonl").exists() else []
    return name, lines, wrong[0] if wrong else ""


def is_equal(line):
    return line["code"][0] == line["code"][1] and line["state"][0] == line["state"][1] and not line["tables_that_differ"]


def cells(name, lines):
    timed = [line["seconds"] for line in lines if line["seconds"]]
    before, after = (sum(seconds[which] for seconds in timed) for which in (0, 1))
    return [
        name, len(lines), sum(line["state"][0] == line["state"][1] for line in lines), sum(not line["tables_that_differ"] for line in lines),
        f"{before:.1f}", f"{after:.1f}", f"{before / after:.3f}" if after else "",
    ]


def show(row):
    print("| " + " | ".join(map(str, row)) + " |", flush=True)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", help="folder with the programs of the first build")
    parser.add_argument("after", help="folder with those of the second")
    parser.add_argument("names", nargs="*", metavar="NAME", help="such as V24*, 'example arch_2d' or 'scene *'")
    parser.add_argument("--turns", type=int, default=1, help="how often each run is made with each build; the least time counts (default: 1)")
    parser.add_argument("--jobs", type=int, default=2, help="cases at a time; 1 for the least noise in times (default: 2)")
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("compare_builds"), help="where all is run (default: compare_builds)")
    return parser.parse_args()


def main():
    options = arguments()
    builds = [os.path.abspath(build) for build in (options.before, options.after)]
    for build in builds:
        for name in ("coplane", "coplane_mesh"):
            if not os.access(os.path.join(build, name), os.X_OK):
                sys.exit(f"compare_builds.py: {build} has no program {name}.")
    names = [name for name in everything() if not options.names or any(fnmatch.fnmatch(name, pattern) for pattern in options.names)]
    if not names:
        sys.exit(f"compare_builds.py: no case is called {' or '.join(options.names)}; there are {', '.join(everything())}.")
    begin, every = time.monotonic(), []
    show(["case", "runs", "same state", "same tables", "seconds before", "seconds after", "before / after"])
    show(["---"] * 7)
    notes = []
    jobs = [(name, builds, options.folder.resolve(), options.turns) for name in names]  # each in a process of its own
    with multiprocessing.get_context("fork").Pool(options.jobs, maxtasksperchild=1) as pool:
        for name, lines, wrong in pool.imap(make, jobs, chunksize=1):
            every += [{"case": name, **line} for line in lines]
            show(cells(name, lines))
            notes += [f"- {name}: its check with the first build: {wrong}"] if wrong else []
    show(cells("all", every))
    show(cells(f"runs of {LEAST_SECONDS:g} s and more", [line for line in every if line["seconds"] and min(line["seconds"]) >= LEAST_SECONDS]))
    (options.folder / "runs.jsonl").write_text("".join(json.dumps(line) + "\n" for line in every))
    different = [line for line in every if not is_equal(line)]
    notes += [f"- {line['case']}, {line['run']}: exit codes {line['code']}, states {line['state']}, tables that differ {line['tables_that_differ']}" for line in different]
    print(f"\n{len(every)} runs, {len(different)} different, in {time.monotonic() - begin:.0f} s.\n" + "\n".join(notes))
    sys.exit(1 if different else 0)


if __name__ == "__main__":
    main()
