"""Names of any letters come back from every file, as the readers of others see them: pandas, ParaView, netCDF4, json (README.md)."""

import json
import pathlib
import shutil
import subprocess
import sys

from coplanetest import Case, Results, documents, program

import coplane

case = Case("names", __file__)
try:
    import pandas
except ImportError:
    sys.exit("this test needs pandas: apt-get install python3-pandas")
if not shutil.which("pvpython"):
    sys.exit("this test needs ParaView: packages/cmake/dependencies.sh --with-paraview")

steel = {"model": "linear_elastic", "density": 7800, "youngs_modulus": 200e9, "poisson_ratio": 0.3}
# Scripts of two, three and four bytes, from right to left, marks that combine, joiners; what CSV, XML and JSON use themselves; what looks
# like a number, a formula or nothing; blanks; lines; long ones.
names = ["Mörtel", "ΑΒΓ μάρμαρο", "кирпич", "砖墙", "जोड़", "جدار", "🧱🏽", "e\u0301 \u200d", "a,b;c", 'say "so"', "it's", "<b> & </b>", "]]>", "{\"x\": 1}",
         "back\\slash", "100 %", "=1+1", "@x", "#7", "007", "1e5", "nan", "NA", "true", " leading", "two\nlines", "tab\there",
         "\u2028separator", "\ufeffmark", "B" * 60, "砖" * 40, "x/y", "a.b", "*"]
results = "砖 & <x> 'y' Ö.e"
DECK = 3
joint, material = 'Fuge "1", <&> 砖🧱', "Stahl, \"hart\" & 钢"


def deck_of(names, joint=joint, material=material):
    return {"materials": {material: steel}, "blocks": {name: {"material": material} for name in names},
            "joints": {joint: {"model": "penalty", "friction": 0.3}}, "contact": {"default_joint": joint},
            "time": {"end": 1e-6, "fixed_step": 5e-7}, "output": {"results": results},
            "history": {"file": "run.csv", "tables": ["blocks", "pairs", "materials"],
                        "probes": [{"name": name, "block": name} for name in names], "joints": ["*"]}}


# Blocks in a row, each on the one before: a plane between each two.
recipe = {"dimension": 2,
          "parts": [{"shape": "box", "block": name, "min": [0, i * (1 - 1e-6)], "size": [1, 1], "divisions": [1, 1]} for i, name in enumerate(names)],
          "node_sets": {f"n {name}": {"block": name, "where": {"x": 0}} for name in names},
          "side_sets": {f"s {name}": {"block": name, "where": {"x": 0}} for name in names}}
reader = """
import json, sys
from paraview import servermanager, simple
mesh = simple.IOSSReader(FileName=[sys.argv[1]])
mesh.UpdatePipelineInformation()
found = {kind: list(getattr(mesh, kind).Available) for kind in ("ElementBlocks", "NodeSets", "SideSets")}
planes = simple.OpenDataFile("./" + sys.argv[2])
planes.UpdatePipeline(planes.TimestepValues[-1])
data = servermanager.Fetch(planes)
array = data.GetFieldData().GetAbstractArray("joint_names")
found["joints"] = [array.GetValue(i) for i in range(array.GetNumberOfValues())] if array else None
found["planes"] = data.GetNumberOfPoints()
json.dump(found, open("paraview.json", "w"))
"""


def paraview(folder, planes):
    """What ParaView finds in the results and in the series of planes."""
    (folder / "read.py").write_text(reader)
    done = subprocess.run(["pvpython", "--force-offscreen-rendering", "read.py", results, planes], cwd=folder, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=200)
    if done.returncode or not (folder / "paraview.json").exists():
        sys.exit(f"pvpython ends with {done.returncode}\n{done.stdout}")
    return json.loads((folder / "paraview.json").read_text())


def as_paraview(name):
    """ParaView's reader of Exodus shows blanks as underscores and A to Z as a to z."""
    return "".join(c.lower() if "A" <= c <= "Z" else "_" if c == " " else c for c in name)


def table(file):
    return pandas.read_csv(file, keep_default_na=False)


for ranks in (1, 2):
    # Planes in one file, and in one for each step.
    deck = deck_of(names)
    deck["output"]["planes_format"] = "vtkhdf" if ranks == 1 else "vtp"
    planes = results[:-2] + ("_planes.xmf3" if ranks == 1 else "_planes.pvd")
    run = case.attempt(f"ranks_{ranks}", recipe, deck, ranks)
    if not case.check_equal(f"{ranks} ranks: exit code", run.code, 0):
        sys.exit(run.output[-3000:])
    folder = pathlib.Path(run.folder)
    file = Results(str(folder / results))
    case.check_equal(f"{ranks} ranks, netCDF: blocks", file.blocks, names)
    case.check_equal(f"{ranks} ranks, netCDF: side sets", file.side_sets, [f"s {name}" for name in names])

    seen = paraview(folder, planes)
    case.check_equal(f"{ranks} ranks, ParaView: blocks", seen["ElementBlocks"], list(map(as_paraview, names)))
    case.check_equal(f"{ranks} ranks, ParaView: node sets", seen["NodeSets"], [as_paraview(f"n {name}") for name in names])
    case.check_equal(f"{ranks} ranks, ParaView: side sets", seen["SideSets"], [as_paraview(f"s {name}") for name in names])
    case.check_equal(f"{ranks} ranks, ParaView: joints and planes", (seen["joints"] is None or joint in seen["joints"], seen["planes"]), (True, len(names) - 1))
    case.check_equal(f"{ranks} ranks: a joint of the planes", joint in coplane.open(folder).planes.joint_names(-1), True)

    history = table(folder / "run.csv")
    columns = [f"{name}_displacement_x[m]" for name in names] + [f"{joint}_stored[J]"]
    case.check_equal(f"{ranks} ranks, pandas: columns of the history that are missing", [name for name in columns if name not in history], [])
    case.check_equal(f"{ranks} ranks, pandas: cycles", list(history["cycle"]), [0, 1, 2])
    case.check_equal(f"{ranks} ranks, pandas: blocks of the table", list(table(folder / "run_blocks.csv")["block"])[: len(names)], names)
    pairs = table(folder / "run_pairs.csv")
    case.check_equal(f"{ranks} ranks, pandas: pairs", sorted(set(zip(pairs["block_a"], pairs["block_b"]))), sorted(zip(names, names[1:])))
    case.check_equal(f"{ranks} ranks, pandas: joints of pairs", sorted(set(pairs["joint"])), [joint])

    opened = coplane.open(folder)
    case.check_equal(f"{ranks} ranks, coplane: probes, joints, blocks", (opened.probe_names, opened.joint_names, list(opened.blocks)), (names, [joint], names))
    case.check_equal(f"{ranks} ranks, coplane: blocks of the table", list(opened.tables["blocks"]["block"])[: len(names)], names)
    case.check_equal(f"{ranks} ranks, coplane: pairs", sorted(set(zip(*(opened.tables["pairs"][f"block_{side}"] for side in "ab")))), sorted(zip(names, names[1:])))

    record = json.loads((folder / "run.run.json").read_text())
    case.check_equal(f"{ranks} ranks, json: the deck is that of the file", record["deck"]["text"], (folder / "run.yaml").read_text())

# What Exodus cannot hold is refused with the name, before a file is there.
for what, name in {"a blank at the end": "brick ", "a zero": "a\0b", "too long": "砖" * 86}.items():
    for kind in ("block", "node set", "side set"):
        part = {**recipe["parts"][0], "block": name if kind == "block" else "brick"}
        sets = {} if kind == "block" else {kind.replace(" ", "_") + "s": {name: {"where": {"x": 0}}}}
        documents.save({"dimension": 2, "parts": [part], **sets}, "refused.yaml")
        done = subprocess.run([program.binary("coplane_mesh"), "make", "refused.yaml", "-o", "refused.e"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        named = "zero byte" if what == "a zero" else kind
        good = case.check_equal(f"{what} in the name of a {kind}", (done.returncode, named in done.stdout, pathlib.Path("refused.e").exists()), (DECK, True, False))
        if not good:
            print(done.stdout)
case.finish()
