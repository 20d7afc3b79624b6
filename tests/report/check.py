"""`coplane report`: what is on the page, taken apart without a browser; with the argument `browser`, drawn by one (README.md)."""

import base64
import gzip
import html
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

import numpy
import plotly.graph_objects

from coplanetest import Case, browser, documents, program

import coplane
from coplane import page, report

SOURCE = pathlib.Path(os.environ["COPLANE_SOURCE"])
case = Case("report", __file__)

# Shows pages in a width, and says what became of them.
LOOK = """
const seen = [];
for (const [name, width] of PAGES) {
  const page = await show(name, width, 3000), each = words => [...page.querySelectorAll(words)], box = thing => thing.getBoundingClientRect(), loaded = page.body.dataset.drawn;
  await until(() => page.body.dataset.drawn);
  seen.push({loaded, drawn: page.body.dataset.drawn, page: page.documentElement.scrollWidth, plots: each('.plot').filter(plot => plot.querySelector('.main-svg')).length,
    widest: Math.max(...each('.main-svg').map(plot => box(plot).width)), row: Math.max(...each('tr').map(row => box(row).height)),
    scrolls: each('.legend .scrollbar').filter(bar => box(bar).height > 0).length});
}
return seen;
"""


class Taken:
    """A page: its text as a reader sees it, its figures by title."""

    def __init__(self, path):
        self.html = pathlib.Path(path).read_text()
        self.figures = json.loads(re.search(r'id="figures">(.*?)</script>', self.html, flags=re.S).group(1))
        titles = re.findall(r'<h3>([^<]*)</h3><div class="plot"[^>]* id="(plot\d+)">', self.html)
        self.titled = {html.unescape(title): self.figures[name] for title, name in titles}
        body = re.sub(r"<(script|style).*?</\1>", "", self.html, flags=re.S)
        self.text = " ".join(html.unescape(re.sub(r"<[^>]+>", " ", body)).split())

    def curves(self, title):
        return {trace["name"]: trace for trace in self.titled[title]["data"]}

    def ending(self):
        return re.findall(r'data-ending="([^"]*)"', self.html)


def says(what, taken, *texts):
    case.check_equal(f"{what}: missing on the page", [text for text in texts if text not in taken.text], [])


def made(*arguments):
    """Runs `coplane report`; returns exit code and what it said."""
    done = subprocess.run([program.binary("coplane"), "report", *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return done.returncode, done.stdout


recipe = case.load("exodus_inputs/jointed_rock_2d/mesh.yaml")
documents.change(recipe, "parts.0.blocks", [6, 2])
for group in ("node_sets", "side_sets"):
    recipe[group]["right"]["where"]["x"], recipe[group]["top"]["where"]["y"] = 6, 2
for name in ("after_5", "after_10"):
    recipe["node_sets"].pop(name)
deck = case.load("exodus_inputs/jointed_rock_2d/deck.yaml")
TITLE = 'a wave through "jointed" rock </script> <!--<script> & more'
deck.update(title=TITLE, mesh="mesh.e", time={"end": 3e-3}, output={"every": 1e-3},
            history={"every": 0, "joints": ["*"], "tables": ["pairs"], "probes": [{"name": "near", "node_set": "near", "relative_to": "foot"}, {"name": "foot", "node_set": "left", "reaction": True}]})  # fmt: skip
for folder, changes in (("a", {}), ("b", {"joints.tight.normal_stiffness": 1e10, "time.end": 2e-3})):
    shutil.rmtree(folder, ignore_errors=True)
    os.mkdir(folder)
    documents.save(recipe, f"{folder}/mesh.yaml")
    coplane.make_mesh(f"{folder}/mesh.yaml", f"{folder}/mesh.e")
    changed = json.loads(json.dumps(deck))
    for path, value in changes.items():
        documents.change(changed, path, value)
    documents.save(changed, f"{folder}/run.yaml")
    coplane.run(f"{folder}/run.yaml", ranks=2)
run = coplane.open("a")
case.check_equal("a report", made("a/run", "--no-pictures"), (0, "a/run-report.html\n"))

if "browser" in sys.argv:
    if not browser.chromium():
        print("skipped: chromium is not installed (apt-get install chromium)")
        sys.exit(77)
    made("a", "--compare", "b", "-o", "two.html", "--no-pictures")
    pages = [("a/run-report.html", 1400), ("a/run-report.html", 390), ("two.html", 390)]
    for (name, width), seen in zip(pages, browser.seen(".", LOOK.replace("PAGES", json.dumps(pages)))):
        what = f"{name}, {width} pixels"
        case.check_equal(f"{what}: drawn when it counts as loaded, as screenshots and prints without a screen want it", seen.get("loaded"), "yes")
        case.check_equal(f"{what}: drawn, plots", (seen["drawn"], seen["plots"]), ("yes", len(Taken(name).figures)))
        case.check_within(f"{what}: widest plot", seen["widest"], 300, width)
        case.check_within(f"{what}: width of the page", seen["page"], width - 20, width)
        case.check_within(f"{what}: highest row of a table", seen["row"], 10, 125)  # six lines of text; letters below each other are more
        case.check_equal(f"{what}: legends that have to be scrolled", seen["scrolls"], 0)
    case.finish()
    sys.exit()

# --- the page of a run ---------------------------------------------------------------------------------

one = Taken("a/run-report.html")
own = re.sub(r'<script type="text/plain".*?</script>', "", one.html, flags=re.S)
case.check_equal("addresses of things outside", re.findall(r'<link|(?:src|href)="(?!data:|#)|@import|url\(', own), [])
case.check_equal("for phones", '<meta name="viewport" content="width=device-width' in one.html, True)
library = gzip.decompress(base64.b64decode(re.search(r'id="library">(.*?)</script>', one.html).group(1)))
case.check_equal("plotly.js is in it", b"plotly.js v" in library[:100], True)
for title, figure in one.titled.items():
    plotly.graph_objects.Figure(figure)  # raises on anything that plotly does not know
case.check_equal("figures", len(one.titled), len(one.figures))
record = run.record
says("what was run", one, record["deck"]["sha256"], record["mesh"]["sha256"], record["state_hash"], record["run"], "2 x 1, back end threads", "coplane 0.1.0",
     TITLE, record["placement"][0]["host"], f"{len(run.history)} lines")  # fmt: skip
case.check_equal("its ending", one.ending(), ["completed"])
says("balances", one, "largest error of the energy balance", "contacts missed", "planes too deep")
for title, name in (("Energies", "kinetic"), ("Energies", "external work"), ("Energies of contact", "contact stored"), ("Contact remainder", "contact remainder"),
                    ("Momentum and impulse", "momentum x"), ("tight: areas", "stick area"), ("tight: closure and slip", "mean closure"),
                    ("tight: normal force", "normal force"),
                    ("Time step", "time step"), ("Slots and planes", "slots"), ("near: velocity", "x"), ("Remainder by pairs of blocks", "rock – rock, tight"),
                    ("Searches", "searches")):  # fmt: skip
    column = {"slots": "pairs", "time step": "dt", "x": "near_velocity_x", "rock – rock, tight": "contact_remainder"}.get(name, name.replace(" ", "_"))
    column = column if column in run.columns else f"tight_{column}"
    drawn = one.curves(title)[name]["y"]
    exact = run.columns[column]
    case.check(f"{title}, {name}: largest value", max(drawn), exact.max(), 1e-5 * abs(exact).max())
    case.check(f"{title}, {name}: last value", drawn[-1], exact[-1], 1e-5 * abs(exact).max())
for title, column, label in (("near: drift", "near_drift_x", "largest near_drift_x"), ("foot: reaction", "foot_reaction_x", "largest foot_reaction_x [N]")):
    exact, drawn = run.columns[column], one.curves(title)["x"]["y"]
    most = numpy.argmax(abs(exact))
    case.check_within(f"{column}: there is one", abs(exact[most]), 1e-9, 1e12)
    case.check(f"{title}: largest value drawn", max(drawn, key=abs), exact[most], 1e-5 * abs(exact[most]))
    says(f"{title}: the largest", one, f"{label} {exact[most]:.6g} at {run.columns['time'][most]:.6g} s")
case.check_equal("no drift of what has none", ["foot: drift" in one.titled, "near: reaction" in one.titled], [False, False])
says("what limited the step", one, "what limited the step", "at node")
says("planes", one, f"{len(run.planes[-1])} planes at t", "deepest", "largest remainders")
worst = run.planes[-1].sort_values("closure").iloc[-1]
says("the deepest plane", one, f"{worst.closure:.6g}")
case.check_equal("time used", "output::history" in one.curves("Seconds of the slowest rank")["run"]["y"], True)
says("pictures", one, "Pictures were not asked for.")
says("warnings", one, "No warnings.")
says("deck", one, "normal_stiffness: 20000000000.0")

if shutil.which("pvbatch") and shutil.which("xvfb-run"):
    case.check_equal("with ParaView", made("a/run", "-o", "drawn.html"), (0, "drawn.html\n"))
    case.check_equal("states that are drawn", re.findall(r'alt="(\w+)" src="data:image/png;base64,iVBOR', pathlib.Path("drawn.html").read_text()),
                     [f"state_{number:04d}_{round(1e6 * time):06d}us" for number, time in enumerate(run.results.times[[0, -1]])])  # fmt: skip
x = numpy.linspace(0, 1, 100000)
y = numpy.sin(40 * x)
y[54321] = 7
thin = page.thinned(x, y)
case.check_equal("a long curve: its peak, ends and length", (thin[1].max(), thin[0][0], thin[0][-1], len(thin[0]) <= page.POINTS), (7.0, 0.0, 1.0, True))

# --- two runs ------------------------------------------------------------------------------------------

case.check_equal("two runs", made("a", "--compare", "b/run.csv", "-o", "two.html", "--no-pictures"), (0, "two.html\n"))
two = Taken("two.html")
case.check_equal("both are drawn", sorted(two.curves("Time step")), ["time step (A)", "time step (B)"])
case.check_equal("the second one is dotted", two.curves("Time step")["time step (B)"]["line"]["dash"], "dot")
case.check("its last value", two.curves("Energies")["kinetic (B)"]["y"][-1], coplane.open("b").history.kinetic.iloc[-1], 1e-5, relative=True)
kinetic = [coplane.open(name).history.kinetic.iloc[-1] for name in "ab"]
says("differences", two, "State hashes: different", f"kinetic [J] {kinetic[0]:.6g} {kinetic[1]:.6g} {kinetic[1] - kinetic[0]:.6g}",
     "ended at different times")  # fmt: skip
case.check_equal("lines of the decks that differ", [bool(re.search(f'class="{kind}">[^<]*normal_stiffness: {value}', two.html))
                                                    for kind, value in (("del", "20000000000.0"), ("add", "10000000000.0"))], [True, True])  # fmt: skip
report.make("a", "same.html", compare="a", pictures=False)
says("a run and itself", Taken("same.html"), "every bit of the last state is equal", "The decks are the same.")

# --- runs that have not ended well ---------------------------------------------------------------------

for name, changes in (("going", {"time.end": 10}), ("failed", {"conditions.0.value.0": "t < 2.5e-3 ? 5e4*sin(2*_pi*200*t) : 0"})):
    changed = coplane.Deck.read("a/run.yaml")
    for path, value in changes.items():
        changed[path] = value
    shutil.rmtree(name, ignore_errors=True)
    started = coplane.run(changed, name, wait=False)
    if name == "failed":
        case.check_equal("failed: exit code", started.process.wait(), 6)
        continue
    while not (started.path(".csv").exists() and started.path(".csv").read_bytes().count(b"\n") > 20):
        time.sleep(0.05)
    report.make("going", pictures=False)
    going = Taken("going/run-report.html")
    case.check_equal("a run that goes on", going.ending(), ["running"])
    says("a run that goes on", going, "The run goes on", "they are written when the run ends")
    case.check_within("lines that are drawn", len(going.curves("Time step")["time step"]["x"]), 15, page.POINTS)
    started.process.send_signal(signal.SIGKILL)
    started.process.wait()
    report.make("going", pictures=False)
    killed, last = Taken("going/run-report.html"), coplane.open("going").history.iloc[-1]
    case.check_equal("a killed run", killed.ending(), ["killed"])
    says("a killed run: its last numbers", killed, f"planes {int(last.planes)} searches {int(last.searches)} cycles {int(last.cycle)} ")
    started.path(".csv").rename("going/away.csv")
    report.make("going", pictures=False)
    case.check_equal("a killed run without history: numbers of its start are left out", re.findall("searches [0-9]+ cycles", Taken("going/run-report.html").text), [])
case.check_equal("report of a failed run", made("failed", "--no-pictures")[0], 0)
failed = Taken("failed/run-report.html")
case.check_equal("a failed run", failed.ending(), ["failed"])
says("a failed run", failed, "has turned inside out or has a force that is not finite")
pathlib.Path("failed/run.log").unlink()
made("failed", "--no-pictures")
says("a failed run without a log", Taken("failed/run-report.html"), "ERROR: ", "has turned inside out or has a force that is not finite")

# --- what is missing -----------------------------------------------------------------------------------

shutil.copytree("a", "less", dirs_exist_ok=True)
for path in [*pathlib.Path("less").glob("run_p*"), pathlib.Path("less/run.log"), pathlib.Path("less/run.run.json"), pathlib.Path("less/run.yaml")]:
    path.unlink(missing_ok=True)
lines = pathlib.Path("a/run.csv").read_text().splitlines(keepends=True)
pathlib.Path("less/run.csv").write_text("".join(lines[:-1]) + lines[-1][:30])
case.check_equal("with less", made("less/run", "--no-pictures")[0], 0)
less = Taken("less/run-report.html")
says("with less", less, "there is no run.run.json", "run_planes.vtkhdf is not there", "there is no record that says it", "there is no record that has them", "Neither the record nor run.yaml has the deck",
     "gives the remainder by pairs", f"{len(lines) - 2} lines")  # fmt: skip
pathlib.Path("less/run.csv").write_text("".join(lines[:9]) + lines[9][:30] + "\n" + lines[10])
case.check_equal("with a damaged history", made("less/run.csv", "--no-pictures")[0], 0)
says("with a damaged history", Taken("less/run-report.html"), "run.csv:10: has")
pathlib.Path("less/run.csv").write_text(lines[0])
made("less/run.csv", "--no-pictures")
says("with an empty history", Taken("less/run-report.html"), "has no line yet")
pathlib.Path("less/run.run.json").write_text('{"ending": ')
code, said = made("less/run.csv", "--no-pictures")
case.check_equal("a damaged record", code, 0)
says("a damaged record", Taken("less/run-report.html"), "less/run.run.json: the record is damaged")
code, said = made("less/rum")
case.check_equal("no such run", (code, "ERROR: less/rum: there is no run of this name" in said), (2, True))
pathlib.Path("mine.html").write_text("mine")
code, said = made("a", "--no-pictures", "-o", "mine.html")
case.check_equal("a file of mine", (code, "no report of coplane" in said, pathlib.Path("mine.html").read_text()), (5, True, "mine"))
code, said = made("a", "--no-pictures", "-o", "nowhere/a.html")
case.check_equal("no such folder", (code, said), (5, "ERROR: the report cannot be written: nowhere/a.html: there is no folder nowhere; make it first.\n"))
code, said = made("a/mesh.e", "--no-pictures")
case.check_equal("a mesh", (code, "mesh.e is a mesh" in said, pathlib.Path("a/mesh-report.html").exists()), (2, True, False))
case.check_equal("drafts that are left", [path.name for path in pathlib.Path().glob("*.part-*")], [])

# An example ends well without its report.
os.makedirs("without", exist_ok=True)
pathlib.Path("without/plotly.py").write_text("raise ImportError('taken away')\n")
EXAMPLE = [sys.executable, str(SOURCE / "exodus_inputs/run.py"), "rocking_block_2d", "--size", "coarse", "--no-pictures", "--set", "time.end=1e-3", "--no-check",
           "--output", "example"]  # fmt: skip
done = subprocess.run(EXAMPLE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=dict(os.environ, PYTHONPATH="without"))
case.check_equal("an example without plotly", (done.returncode, len(re.findall("^.*no report: .*python3-plotly.*$", done.stdout, flags=re.M))), (0, 1))
done = subprocess.run(EXAMPLE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
case.check_equal("an example's report", (done.returncode, pathlib.Path("example/run-report.html").exists()), (0, True))

case.finish()
