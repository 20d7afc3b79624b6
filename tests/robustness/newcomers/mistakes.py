"""The table of mistakes; README.md says how it is used. Codes: docs/user/exit-codes.md."""

import dataclasses
import pathlib
from collections.abc import Callable

import netCDF4
from coplanetest import program

FINE, USAGE, DECK, MESH, OUTPUT, COMPUTATION, RESTART = 0, 2, 3, 4, 5, 6, 9


@dataclasses.dataclass
class Mistake:
    name: str
    says: list  # words that have to be there
    changes: dict = dataclasses.field(default_factory=dict)  # text of the deck, and what stands there instead
    code: int = DECK
    command: str = "run.yaml"
    files: dict = dataclasses.field(default_factory=dict)  # other files, with their text
    prepare: Callable = None  # of the folder
    encode: Callable = lambda text: text.encode()
    program: str = "coplane"
    two_ranks: bool = False


mistakes = []


def refused(name, changes, *says, **more):
    """The deck with something else in it is refused."""
    mistakes.append(Mistake(name, list(says), changes, **more))


def warned(name, changes, *says, code=FINE, **more):
    """The deck with something else in it is accepted, with a warning."""
    mistakes.append(Mistake(name, ["WARNING", *says], changes, code, "run.yaml --check", **more))


def typed(name, command, *says, code=USAGE, **more):
    """The right deck, and another command line."""
    mistakes.append(Mistake(name, list(says), code=code, command=command, **more))


def meshed(name, spoil, *says, code=MESH, **more):
    """The right deck, and a mesh in which `spoil` has changed something."""

    def prepare(folder):
        with netCDF4.Dataset(folder / "mesh.e", "a") as file:
            file.set_auto_mask(False)
            spoil(file)

    mistakes.append(Mistake(name, list(says), code=code, prepare=prepare, **more))


# --- values that are most likely not meant: a warning with the usual range ---------------------------------
warned("friction in degrees", {"friction: 0.6": "friction: 31"}, "run.yaml:6:80: joints.dry.friction = 31", "usual: up to 2", "tangent", "degrees",
       two_ranks=True)
warned("modulus in GPa", {"60e9": "60"}, "run.yaml:4:67: materials.granite.youngs_modulus = 60 Pa", "usual: from 1e+06 on", "1 GPa is 1e9")
warned("modulus in MPa", {"60e9": "60000"}, "youngs_modulus = 60000 Pa is unusually small", "1 MPa 1e6")
warned("density in g/cm^3", {"2650": "2.65"}, "run.yaml:4:45: materials.granite.density = 2.65 kg/m^3", "usual: from 20 on", "1 g/cm^3")
warned("density in t/mm^3", {"2650": "2.65e-9"}, "density = 2.65e-09 kg/m^3", "t/mm^3")
warned("all of it in mm, t and s", {"2650": "2.65e-9", "60e9": "60e3"}, "density = 2.65e-09", "youngs_modulus = 60000", "agree with each other")
warned("an almost incompressible solid", {"0.25": "0.4999"}, "poisson_ratio = 0.4999", "usual: up to 0.495", "lock")
warned("stiffness of a joint in GPa/m", {"1e10": "10"}, "joints.dry.normal_stiffness = 10 Pa/m", "usual: from 100000 on", "1 GPa/m")
warned("cohesion in MPa", {"friction: 0.6": "friction: 0.6, cohesion: 2"}, "joints.dry.cohesion = 2 Pa", "1 MPa 1e6")
warned("yield stress in MPa", {"linear_elastic": "j2", "0.25}": "0.25, yield_stress: 250}"}, "materials.granite.yield_stress = 250 Pa", "1 MPa 1e6")
warned("pressure in MPa", {"{type: fixed, node_set: base}": "{type: pressure, side_set: roof, value: 5}"}, "conditions.0.value = 5 Pa", "1 MPa 1e6")
warned("initial stress in MPa", {"gravity:": "initial: [{block: upper, stress: [-5, -5, -5, 0, 0, 0]}]\ngravity:"}, "initial.0.stress = -5 Pa")
warned("initial stress a thousand times too large", {"gravity:": "initial: [{block: upper, stress: [-1e10, -1e10, -1e10, 0, 0, 0]}]\ngravity:"},
       "initial stress of up to 1e+10 Pa in block 'upper' is 13.9 % of the P-wave modulus", "Usual: up to 10 %", "1 MPa 1e6", two_ranks=True)
warned("velocity in mm/s", {"[0, -0.1, 0]": "[0, -1e5, 0]"}, "conditions.1.value = -100000 m/s", "mm/s", "too fast for the waves", code=COMPUTATION)  # in the trial
warned("gravity in mm/s^2", {"-9.81": "-9810"}, "run.yaml:14:10: gravity = -9810 m/s^2", "9.81, not 9810")
warned("gravity upwards", {"-9.81": "9.81"}, "gravity.1 = 9.81 m/s^2 pulls along +y, upwards", "-9.81")
warned("damping in per cent", {"{default_joint: dry}": "{default_joint: dry, damping: {normal: 5}}"}, "contact.damping.normal = 5", "5 % are 0.05")
warned("time in microseconds", {"end: 1e-3": "end: 1000000"}, "time.end = 1e+06 s", "steps of", "1 ms is 1e-3")
warned("an end before the first step", {"end: 1e-3": "end: 1e-9"}, "time.end = 1e-09 s is less than the first step", "Seconds are meant")
warned("results after the end", {"every: 2e-4": "every: 2"}, "run.yaml:16:17: output.every = 2 s is longer than the run")
warned("history after the end", {"every: 1e-4": "every: 1"}, "run.yaml:17:18: history.every = 1 s is longer than the run")
warned("times after the end", {"every: 2e-4": "times: [1, 2]"}, "output.times has 1 s, but the run ends at time.end = 0.001 s")
warned("a step that is too large", {"end: 1e-3": "end: 1e-3, fixed_step: 1e-3"}, "time.fixed_step = 1.0000e-03 s is above the stable step")
warned("two conditions on the same nodes", {"node_set: base": "node_set: top"}, "run.yaml:12:5 (fixed of 'top') and run.yaml:13:5 (velocity of 'top')",
       "the same component of 3 nodes", "the second acts there", two_ranks=True)
warned("motion across a symmetry", {"{type: fixed, node_set: base}": "{type: symmetry, node_set: top, normal: [0, 1, 0]}"},
       "run.yaml:12:5 (symmetry of 'top') and run.yaml:13:5 (velocity of 'top')", "the second acts there", two_ranks=True)  # fmt: skip
warned("a joint within one block", {"dry}": "dry, pairs: [{blocks: [lower, lower], joint: dry, declared: true}]}"}, "contact.pairs.0",
       "no faces of its two sides overlap")  # fmt: skip

# --- values out of their range --------------------------------------------------------------------------------
refused("a negative density", {"2650": "-2650"}, "run.yaml:4:45: materials.granite.density = '-2650' is out of range", "a number > 0 [kg/m^3]", two_ranks=True)
refused("Poisson's ratio 0.5", {"0.25": "0.5"}, "run.yaml:4:88: materials.granite.poisson_ratio = '0.5' is out of range", "< 0.5")
refused("step factor in per cent", {"end: 1e-3": "end: 1e-3, step_factor: 80"}, "time.step_factor = '80' is out of range", "<= 1")
refused("no time", {"end: 1e-3": "end: 0"}, "time.end = '0' is out of range", "> 0 [s]")

# --- how numbers are written ----------------------------------------------------------------------------------
refused("a unit", {"60e9": "60 GPa"}, "run.yaml:4:67: materials.granite.youngs_modulus = '60 GPa' is not a number", "no units", "write 60000000000;", "[Pa]",
        two_ranks=True)  # fmt: skip
refused("milliseconds", {"end: 1e-3": "end: 1ms"}, "time.end = '1ms' is not a number", "no units", "write 0.001")
refused("a unit of another kind", {"2650": "2.65 g/cm3"}, "density = '2.65 g/cm3' is not a number", "write the number in kg/m^3 alone")
refused("per cent", {"0.25": "25%"}, "poisson_ratio = '25%' is not a number", "write 0.25")
refused("a decimal comma", {"time: {end: 1e-3}": "time:\n  end: 0,001"}, "run.yaml:16:8: time.end = '0,001'", "decimal point", "write 0.001")
refused("a decimal comma between braces", {"0.25}": "0,25}"}, "run.yaml:4:90: materials.granite.25 is not known", "decimal comma", "0.25")
refused("a number in quotes", {"60e9": '"60e9"'}, 'youngs_modulus = "60e9" is text in quotes', "remove the quotes")
refused("a number of Fortran", {"60e9": "60d9"}, "'60d9' is not a number", "write 60e9")
refused("thousands apart", {"2650": "2 650"}, "'2 650' is not a number", "write 2650")
refused("thousands with underscores", {"2650": "2_650"}, "'2_650' is not a number", "write 2650")
refused("arithmetic", {"0.25": "1/4"}, "'1/4' is not a number", "write 0.25")
refused("a value is missing", {"2650": ""}, "run.yaml:4:45: materials.granite.density = nothing", "a number > 0 [kg/m^3]")
refused("yes for true", {"{default_joint": "{enabled: yes, default_joint"}, "contact.enabled = 'yes' is not a flag", "true or false")
refused("pi", {"-0.1,": '"-0.1*sin(2*pi*t)",'}, "run.yaml:13:48: conditions.1.value.1", "the number pi is called _pi")
refused("powers with stars", {"-0.1,": '"-0.1*t**2",'}, "conditions.1.value.1", "powers are written with ^")
refused("time instead of t", {"-0.1,": '"-0.1*time",'}, "conditions.1.value.1", "the time is called t")
refused("one number for a vector", {"[0, -9.81, 0]": "-9.81"}, "run.yaml:14:10: gravity = '-9.81'", "a list of 3", "such as [0,")
refused("two numbers for a vector", {"[0, -9.81, 0]": "[0, -9.81]"}, "gravity = a list of 2", "a list of 3", "such as [0,")

# --- how YAML is written ---------------------------------------------------------------------------------------
refused("a tab", {"blocks:\n  lower": "blocks:\n\tlower"}, "run.yaml:8:1: this line is indented with a tab", "blanks", two_ranks=True)
refused("a tab after a line that is right", {"  dry: {model": "\tdry: {model"}, "run.yaml:6:1: this line is indented with a tab")
refused("an open brace", {"friction: 0.6}": "friction: 0.6"}, "run.yaml:6:8: '{' is not closed", "put the missing '}'", two_ranks=True)
refused("an open bracket", {"-0.1, 0]": "-0.1, 0"}, "run.yaml:13:44: '[' is not closed, and '}' comes in line 13", "put the missing ']'")
refused("an open quote", {"two blocks": '"two blocks'}, 'run.yaml:1:8: the quote " is not closed')
refused("an open single quote", {"two blocks": "'two blocks"}, "run.yaml:1:8: the quote ' is not closed")
refused("an open quote before another", {"two blocks": '"two blocks', "-0.1,": '"-0.1*t",'}, 'run.yaml:1:8: the quote " is not closed in its line')
refused("a line too far right", {"  upper: {mat": "   upper: {mat"}, "run.yaml:9:4: this line is indented by 3 blanks", "one column")
refused("no blank after a colon", {"density: 2650": "density:2650"}, "density:2650 is not known", "density is missing")
refused("no colon", {"time: {": "time {"}, "run.yaml:15:1: time {end is not known", "time is missing")
refused("a colon in a text", {"two blocks": "test: two blocks"}, "run.yaml:1:12: a second ': ' within one value", "quotes")
refused("a comment of C", {"title:": "// two blocks\ntitle:"}, "run.yaml:1:1: a line that begins with '//'", "comments begin with '#'")
refused("a comment of LS-DYNA", {"title:": "$ two blocks\ntitle:"}, "run.yaml:1:1: a line that begins with '$'", "comments begin with '#'")
refused("a comment with a star", {"title:": "* two blocks\ntitle:"}, "run.yaml:1:1: a line that begins with '*'", "comments begin with '#'")
refused("a key twice", {"density: 2650": "density: 2650, density: 2600"}, "run.yaml:4:51: materials.granite.density is given twice, first at run.yaml:4:36")
refused("a list for names", {"  granite: {model": "  - granite: {model"}, "run.yaml:4:3: materials = a list of 1", "names are wanted, not items with '-'")
refused("names for a list", {"  - {type: fixed, node_set: base}\n  - {type: velocity, node_set: top, value: [0, -0.1, 0]}": "  type: fixed\n  node_set: base"},
        "run.yaml:12:3: conditions = a group of keys", "each with '-' before it")  # fmt: skip
refused("a value for a group", {"{end: 1e-3}": "1e-3"}, "run.yaml:15:7: time = '1e-3'", "keys with values, such as {end: 0.041}")
refused("a key of a group at the top", {"time: {end: 1e-3}": "end: 1e-3"}, "run.yaml:15:1: end is not known", "Its place is time.end")
refused("Latin-1", {"two blocks": "zwei Blöcke"}, "run.yaml:1: the text is not UTF-8 here", "iconv", encode=lambda text: text.encode("latin-1"))
refused("UTF-16", {}, "run.yaml:1: the text is UTF-16", "Save it as UTF-8", encode=lambda text: text.encode("utf-16"))
mistakes.append(Mistake("none", [], code=FINE))
mistakes.append(Mistake("Windows line ends", [], code=FINE, encode=lambda text: text.replace("\n", "\r\n").encode()))
mistakes.append(Mistake("a byte order mark", [], code=FINE, encode=lambda text: b"\xef\xbb\xbf" + text.encode()))

# --- words of other programs -------------------------------------------------------------------------------------
for theirs, ours in {"rho": "density", "E": "youngs_modulus", "nu": "poisson_ratio", "jkn": "normal_stiffness", "jfric": "friction"}.items():
    refused(f"the word {theirs}", {f"{ours}:": f"{theirs}:"}, f".{theirs} is not known. It is called '{ours}' here.")
refused("the model elastic", {"linear_elastic": "elastic"}, "run.yaml:4:20: materials.granite.model = 'elastic'", "It is called 'linear_elastic' here")
refused("the joint of Coulomb", {"{model: linear,": "{model: coulomb,"}, "joints.dry.model = 'coulomb'", "It is called 'linear' here")
refused("the key endtim", {"{end:": "{endtim:"}, "run.yaml:15:8: time.endtim is not known. It is called 'end' here.")
refused("the key dt", {"end: 1e-3": "end: 1e-3, dt: 1e-6"}, "time.dt is not known. It is called 'fixed_step' here.")
refused("the key boundary", {"conditions:": "boundary:"}, "run.yaml:11:1: boundary is not known. It is called 'conditions' here.")
refused("the type encastre", {"type: fixed": "type: encastre"}, "run.yaml:12:12: conditions.0.type = 'encastre'", "It is called 'fixed' here")
refused("plane stress", {"mesh: mesh.e": "mesh: mesh.e\ngeometry: plane_stress"}, "geometry = 'plane_stress' is not known", "plane_strain")
refused("a deck of LS-DYNA", {}, "run.yaml: this is an input file of LS-DYNA or Abaqus", "--help-deck", encode=lambda _: b"$ two blocks\n*KEYWORD\n*END\n")
refused("a deck of Abaqus", {}, "run.yaml: this is an input file of LS-DYNA or Abaqus", encode=lambda _: b"*HEADING\n two blocks\n*NODE\n1, 0., 0.\n")

# --- names ----------------------------------------------------------------------------------------------------------
refused("a misspelt key", {"density:": "densty:"}, "run.yaml:4:36: materials.granite.densty is not known. Did you mean 'density'?")
refused("another case in a key", {"density:": "Density:"}, "materials.granite.Density is not known. Did you mean 'density'?")
refused("another case in a material", {"upper: {material: granite}": "upper: {material: Granite}"}, "run.yaml:9:21", "Did you mean 'granite'?")
refused("a misspelt joint", {"default_joint: dry": "default_joint: dyr"}, "run.yaml:10:26: contact.default_joint = 'dyr'", "Did you mean 'dry'?")
refused("a misspelt block", {"  upper:": "  uper:"}, "run.yaml:9:3: blocks = 'uper' is not an element block of the mesh. Did you mean 'upper'?", two_ranks=True)
refused("a number for a block", {"  upper:": "  2:"}, "blocks = '2' is not an element block", "Names are wanted, not numbers", "lower, upper")
refused("a block without a card", {"  upper: {material: granite}\n": ""}, "blocks has no card for the element block 'upper'", "{material: ...}")
refused("a misspelt node set", {"node_set: base": "node_set: bsae"}, "run.yaml:12:5: conditions.0.node_set = 'bsae'", "Did you mean 'base'?")
refused("a side set for a node set", {"node_set: base": "node_set: roof"}, "conditions.0.node_set = 'roof'", "'roof' is a side set")
refused("a block for a node set", {"node_set: base": "node_set: lower"}, "'lower' is an element block")
refused("a pressure on nodes", {"{type: fixed, node_set: base}": "{type: pressure, node_set: top, value: 1e5}"}, "conditions.0.side_set is missing",
        "node_set belongs to type: fixed")  # fmt: skip
refused("one block for a pair", {"dry}": "dry, pairs: [{blocks: lower, joint: dry}]}"}, "contact.pairs.0.blocks = 'lower'", "a list of 2 names", "such as [bricks")
refused("axes as flags", {"base}": "base, components: [1, 0, 0]}"}, "conditions.0.components.0 = '1' is not known", "one of x, y, z")

# --- the right thing in the wrong form -----------------------------------------------------------------------------
refused("a start of nodes", {"gravity:": "initial: [{node_set: base, velocity: [1, 0, 0]}]\ngravity:"}, "initial.0.block is missing", "element block of the mesh")
refused("components in one word", {"base}": "base, components: xy}"}, "conditions.0.components = 'xy'", "a list of names out of x, y, z")
refused("a name for a pair", {"dry}": "dry, pairs: [{blocks: lower, joint: dry}]}"}, "contact.pairs.0.blocks = 'lower'", "a list of 2 names, such as")
refused("two default joints", {"default_joint: dry": "default_joint: [dry, dry]"}, "contact.default_joint = a list of 2; accepted: text")
refused("an interval", {"{every: 2e-4}": "{interval: 2e-4}"}, "output.interval is not known. It is called 'every' here.")
refused("a frequency of outputs", {"{every: 2e-4}": "{frequency: 50}"}, "output.frequency is not known. It is called 'every' here.")
refused("a stress of three numbers", {"gravity:": "initial: [{block: upper, stress: [-1e6, -1e6, 0]}]\ngravity:"}, "initial.0.stress = a list of 3", "a list of 6 numbers [Pa]")
refused("reduced integration", {"upper: {material: granite}": "upper: {material: granite, element: reduced}"}, "blocks.upper.element = 'reduced' is not known", "one_point")
refused("damping by a number", {"gravity:": "damping: 0.1\ngravity:"}, "damping = '0.1'; accepted: keys with values")
refused("static and dynamic friction in one", {"friction: 0.6": "friction: [0.6, 0.4]"}, "joints.dry.friction = a list of 2", "a number >= 0")
refused("two probes of one name", {"gravity:": "history: {probes: [{name: a, block: lower}, {name: a, block: upper}]}\ngravity:", "history: {every": "partition: {every"},
        "history.probes.1.name = 'a' is taken", "each name once")  # fmt: skip
refused("an absorbing side in a free field", {"gravity:": "  - {type: absorbing, side_set: roof}\n  - {type: free_field, side_set: roof}\ngravity:"},
        "run.yaml:15:5: free_field side set 'roof' has", "faces that the absorbing side set 'roof' of run.yaml:14:5 has, too", "one of the two on a face at a time",
        two_ranks=True)  # fmt: skip
refused("variables of no results", {"{every: 2e-4}": "{results: none, variables: [stress]}"}, "output.variables has no effect without results")
typed("a colon in --set", "run.yaml --set time.end:0.1", "is not an assignment", "path=value, such as time.end=0.1", code=DECK)

# --- two dimensions ------------------------------------------------------------------------------------------------
refused("gravity along z", {"[0, -9.81, 0]": "[0, 0, -9.81]"}, "run.yaml:14:17: gravity along z has no effect", "two dimensions")
refused("held along z", {"base}": "base, components: [z]}"}, "run.yaml:12:5: components: [z] holds nothing", "two dimensions", "x, y or both", two_ranks=True)
refused("moved along z", {"[0, -0.1, 0]": "[0, 0, -0.1]"}, "run.yaml:13:5: a velocity along z has no effect")
refused("a normal along z", {"{type: fixed, node_set: base}": "{type: symmetry, node_set: base, normal: [0, 0, 1]}"}, "the normal of a symmetry along z")

# --- files ---------------------------------------------------------------------------------------------------------
for ending, words in {
    "msh": "coplane_mesh convert bar.msh --output bar.e",
    "inp": "coplane_mesh convert bar.inp --output bar.e",
    "k": "save the mesh as Exodus II in the program that made it, or as .msh 4.1 of Gmsh",
    "vtk": "save the mesh as Exodus II in the program that made it, or as .msh 4.1 of Gmsh",
    "stl": "surfaces, not elements",
    "geo": "coplane_mesh convert bar.msh --output bar.e",
}.items():
    refused(f"a mesh .{ending}", {"mesh.e": f"bar.{ending}"}, f"bar.{ending}: the file is not an Exodus II file", words, code=MESH, files={f"bar.{ending}": "text\n"},
            two_ranks=ending == "msh")  # fmt: skip
refused("the recipe for the mesh", {"mesh.e": "bar.yaml"}, "coplane_mesh make bar.yaml --output bar.e", code=MESH, files={"bar.yaml": "dimension: 2\n"})
refused("a misspelt mesh", {"mesh.e": "mehs.e"}, "mehs.e: the mesh file does not exist", "There is a file 'mesh.e'", code=MESH, two_ranks=True)
refused("another case in a mesh", {"mesh.e": "Mesh.e"}, "There is a file 'mesh.e'", code=MESH)
refused("a mesh with another ending", {"mesh.e": "mesh.exo"}, "There is a file 'mesh.e'", code=MESH)
refused("a mesh in the home folder", {"mesh.e": "~/mesh.e"}, "'~' and variables are not replaced", code=MESH)
refused("a mesh with backslashes", {"mesh.e": "meshes\\mesh.e"}, "separated by '/'", code=MESH)
refused("a folder for a mesh", {"mesh.e": "."}, "this is a folder", code=MESH)
refused("results in a folder that is missing", {"{every: 2e-4}": "{every: 2e-4, results: out/run.e}"}, "out' exists and can be written to", code=OUTPUT)
refused("results in a file", {"{every: 2e-4}": "{every: 2e-4, results: mesh.e/run.e}"}, "Not a directory", code=OUTPUT)
refused("results over the mesh", {"{every: 2e-4}": "{every: 2e-4, results: mesh.e}"}, "would overwrite the mesh")
typed("a misspelt deck", "rum.yaml", "rum.yaml: the deck cannot be read", "There is a file 'run.yaml'", code=DECK)
typed("a deck without its ending", "run", "There is a file 'run.yaml'", code=DECK)
typed("a folder for a deck", ".", "this is a folder", code=DECK)
typed("the mesh for a deck", "mesh.e", "mesh.e: this is a mesh or results (Exodus)", "a YAML file", code=DECK)
typed("the recipe for a deck", "bar.yaml", "bar.yaml: this is a recipe of a mesh, for coplane_mesh make", code=DECK, files={"bar.yaml": "dimension: 2\nparts: []\n"})
typed("a deck for coplane_mesh", "make run.yaml --output bar.e", "run.yaml: this is a deck of coplane", code=DECK, program="coplane_mesh")
typed("a deck for coplane_point", "run.yaml", "run.yaml: this is a deck of coplane", code=DECK, program="coplane_point")
typed("a file of Nastran for convert", "convert bar.bdf --output bar.e", "bar.bdf", "no mesh of Gmsh", code=MESH, program="coplane_mesh", files={"bar.bdf": "GRID\n"})
typed("quadratic elements of Abaqus", "convert bar.inp --output bar.e", "bar.inp:3", "C3D20R", "first-order", code=MESH, program="coplane_mesh",
      files={"bar.inp": "*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=C3D20R\n"})

# --- recipes of meshes ---------------------------------------------------------------------------------------------
recipe = (pathlib.Path(__file__).parent / "mesh.yaml").read_text()


def cooked(name, old, new, *says):
    """The recipe with something else in it is refused."""
    typed(name, "make bar.yaml --output bar.e", *says, code=DECK, program="coplane_mesh", files={"bar.yaml": recipe.replace(old, new, 1)})


cooked("a set without members", "{y: 0}", "{y: 7}", "bar.yaml:7:31: node_sets.base.where selects no node", "bounding box")
cooked("a recipe of another dimension", "dimension: 2", "dimension: 3", "parts.0.size = a list of 2", "a list of 3 numbers > 0 [m]")
cooked("an unknown shape", "shape: box", "shape: cube", "bar.yaml:4:13: parts.0.shape = 'cube' is not known", "one of box")
cooked("millimetres in a recipe", "size: [1,", "size: [1000 mm,", "parts.0.size.0 = '1000 mm' is not a number", "write 1;")
cooked("one number of divisions", "divisions: [2, 1]", "divisions: 2", "parts.0.divisions = '2'", "a list of 2 whole numbers >= 1")
cooked("a set of a misspelt block", "block: lower, where", "block: lwoer, where", "node_sets.base.block = 'lwoer' is no block of the parts", "Did you mean 'lower'?")

cooked("corners clockwise", "{shape: box", "{shape: quadrilateral, block: q, corners: [[5, 0], [5, 1], [6, 1], [6, 0]], divisions: [1, 1]}\n  - {shape: box",
       "bar.yaml:4:", "parts.0.corners turn inside out", "counter-clockwise")  # fmt: skip
cooked("three angles in two dimensions", "shape: box,", "shape: box, rotate: [0, 0, 30],", "parts.0.rotate must be one number in two dimensions")
cooked("a list of sets", "node_sets:", "side_sets: [base]\nnode_sets:", "side_sets = a list of 1: names are wanted, not items with '-'")
cooked("a place in words", "{y: 0}", "'y = 0'", 'node_sets.base.where = "y = 0"', "keys with values")


def with_checkpoint(folder):
    program.run_program(["run.yaml", "--set", "checkpoint.at_end=true"], folder)


# --- the command line ----------------------------------------------------------------------------------------------
typed("no deck", "", "deck is required", "coplane DECK")
typed("two decks", "run.yaml run.yaml", "one deck")
typed("ranks", "-np 2 run.yaml", "mpirun -np 2 coplane")
typed("the deck with an option", "-i run.yaml", "The deck stands without an option")
typed("the deck as in LS-DYNA", "i=run.yaml", "i=run.yaml: the deck cannot be read", "There is a file 'run.yaml'", code=DECK)
typed("a misspelt option", "run.yaml --chek", "Did you mean --check?")
typed("a blank in --set", "run.yaml --set time.end 0.1", "--set time.end=...")
typed("a key of --set without its group", "run.yaml --set end=0.1", "end is not known. Its place is time.end", code=DECK)
typed("restart in front of the deck", "--restart run.yaml", "deck is required", "coplane run.yaml --restart", two_ranks=True)
typed("a restart without a checkpoint", "run.yaml --restart", "there is no checkpoint to restart from", "run.chk.0", code=RESTART)
typed("a restart from the mesh", "run.yaml --restart mesh.e", "it is not a checkpoint of Coplane", code=RESTART)
typed("a restart of another deck", "run.yaml --restart --set materials.granite.density=2600", "the deck run.yaml is not that of the checkpoint",
      "materials.granite.density was 2650 and is 2600 now", code=RESTART, prepare=with_checkpoint, two_ranks=True)  # fmt: skip
typed("threads of the serial back end", "run.yaml --backend serial --threads 4", "4 threads, but --backend serial has one", two_ranks=True)
typed("threads above the machine", "run.yaml --threads 128", "WARNING", "share cores", code=FINE)
typed("an hour of --max-wall", "run.yaml --max-wall 1h", "1h; accepted: a number of seconds")
typed("a back end of another name", "run.yaml --backend openmp", "serial,threads")
typed("coplane_mesh without a command", "bar.yaml --output bar.e", "coplane_mesh make RECIPE --output MESH", program="coplane_mesh")
typed("coplane_mesh with two names", "make bar.yaml bar.e", "--output is required", "coplane_mesh make RECIPE --output MESH", program="coplane_mesh")


# --- the mesh -------------------------------------------------------------------------------------------------------
def inside_out(file):
    nodes = file["connect1"][:]
    nodes[0] = nodes[0][::-1]
    file["connect1"][:] = nodes


def mirrored(file):
    file["coordx"][:] = -file["coordx"][:]


def flat(file):
    file["coordy"][:] = 0


def long(file):
    for axis in "xy":
        file["coord" + axis][:] = 1e8 * file["coord" + axis][:]


def overlapping(file):
    y = file["coordy"][:]
    y[file["connect2"][:].ravel() - 1] -= 0.01
    file["coordy"][:] = y


meshed("an element inside out", inside_out, "mesh.e: 1 elements are inside out or flat", "element 1 of block 'lower'", "order of their nodes", two_ranks=True)
meshed("a mesh that was mirrored", mirrored, "4 elements are inside out or flat", "order of their nodes")
meshed("elements without area", flat, "4 elements are inside out or flat", "0 m^2")
meshed("a mesh in another unit of length", long, "WARNING", "1.41e+08 m from corner to corner", "in metres", code=FINE, command="run.yaml --check")
meshed("bodies in each other", overlapping, "mesh.e: bodies overlap before the first step", "'lower' and 'upper'", "0.01 m deep", "initial_overlap", two_ranks=True)

# --- steps that nothing limits ----------------------------------------------------------------------------------------
rigid = {
    "lower: {": "lower: {rigid: true, ",
    "upper: {": "upper: {rigid: true, ",
    "{default_joint: dry}": "{enabled: false}",
    "  - {type: fixed, node_set: base}\n  - {type: velocity, node_set: top, value: [0, -0.1, 0]}": "  - {type: rigid_motion, block: lower, velocity: [0, 0, 0]}",
}
mistakes.append(Mistake("rigid bodies without contact", ["first step: 1.000000e-06 s", "nothing: no element deforms"], rigid, FINE, "run.yaml --check"))
