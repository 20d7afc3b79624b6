"""Every mistake of the table has its exit code and its words, and what is refused writes nothing."""

import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess

from coplanetest import Case, program
from mistakes import mistakes

case = Case("mistakes of newcomers", __file__)
deck = (case.source / "deck.yaml").read_text()
recipe = (case.source / "mesh.yaml").read_text()
pathlib.Path("mesh.yaml").write_text(recipe)
program.make_mesh("mesh.yaml", "mesh.e")


def attempt(mistake, ranks):
    """Makes the mistake in a folder of its own. Returns the exit code, what was printed, and what is new in the folder."""
    folder = pathlib.Path(f"{ranks}_ranks", re.sub(r"\W+", "_", mistake.name)).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    shutil.copy("mesh.e", folder)
    text = deck
    for old, new in mistake.changes.items():
        if old not in text:
            raise ValueError(f"{mistake.name}: the deck has no '{old}'")
        text = text.replace(old, new, 1)
    (folder / "run.yaml").write_bytes(mistake.encode(text))
    for name, content in mistake.files.items():
        (folder / name).write_text(content)
    if mistake.prepare:
        mistake.prepare(folder)
    before = sorted(os.listdir(folder))
    launch = [os.environ.get("MPIEXEC", "mpirun"), "-np", str(ranks), "--bind-to", "none"] if ranks > 1 else []
    command = [*launch, program.binary(mistake.program), *mistake.command.split()]
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", timeout=60)
    return done.returncode, done.stdout, sorted(set(os.listdir(folder)) - set(before))


def judge(mistake, ranks, code, output, made):
    name = mistake.name if ranks == 1 else f"{mistake.name}, {ranks} ranks"
    good = case.check_equal(f"{name}: exit code", code, mistake.code)
    good = case.check_equal(f"{name}: words missing", [word for word in mistake.says if word not in output], []) and good
    if not mistake.says:
        good = case.check_equal(f"{name}: warnings", re.findall(r"(?m)^WARNING.*", output), []) and good
    if mistake.code:
        good = case.check_equal(f"{name}: files that were made", made, []) and good
        if mistake.program == "coplane":
            good = case.check_equal(f"{name}: times that an error is printed", len(re.findall(r"(?m)^ERROR", output)), 1) and good
    if not good:
        print(output)


names = [mistake.name for mistake in mistakes]
case.check_equal("names that two mistakes have", sorted({name for name in names if names.count(name) > 1}), [])
case.check_within("mistakes", len(mistakes), 60, 1000)
runs = [(mistake, ranks) for mistake in mistakes for ranks in ((1, 2) if mistake.two_ranks else (1,))]
with concurrent.futures.ThreadPoolExecutor(2) as pool:
    for (mistake, ranks), outcome in zip(runs, pool.map(lambda run: attempt(*run), runs)):
        judge(mistake, ranks, *outcome)
case.finish()
