"""Pictures of the documents are those that their makers draw: checks of check.py."""

import os
import pathlib
import re
import subprocess
import sys

SOURCE = pathlib.Path(os.environ["COPLANE_SOURCE"])
BINARIES = pathlib.Path(os.environ["COPLANE_BIN"])


def run(command, **options):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)


def same_picture(kept, maker, **options):
    """A picture is the one that its maker draws."""
    picture = pathlib.Path(kept).name
    done = run([sys.executable, str(SOURCE / maker), picture], **options)
    assert done.returncode == 0, done.stdout
    assert pathlib.Path(picture).read_text() == (SOURCE / kept).read_text(), f"{kept} is old: see {maker}"


def check_packages():
    """The picture of the packages is the one that their dependency files give."""
    same_picture("docs/developer/packages.svg", "packages/cmake/draw-packages.py")


def check_classic():
    """The picture of corners under both kinds of common plane is the one that the contact package gives."""
    table = run([str(BINARIES / "coplane_classic_corner_table")])
    assert table.returncode == 0, table.stdout
    same_picture("docs/theory/pictures/classic-corners.svg", "docs/theory/pictures/draw-classic.py", input=table.stdout)


def check_potential():
    """Pictures of the potential, drawn with the constants of the code."""
    maker = "docs/theory/pictures/draw-potential.py"
    code = (SOURCE / "packages/contact/src/coplane_contact/ContactEnergy.hpp").read_text()
    told = dict(re.findall(r"^([A-Z_]+) = ([0-9.]+)$", (SOURCE / maker).read_text(), re.MULTILINE))
    assert len(told) == 5, told
    for name, value in told.items():
        words = name.lower().split("_")
        assert re.search(rf"\b{words[0]}{''.join(word.title() for word in words[1:])} = {value}\b", code), f"{maker}: {name} is not that of ContactEnergy.hpp"
    for picture in ("potential-pair", "potential-strip", "seam-force", "plane-life"):
        same_picture(f"docs/theory/pictures/{picture}.svg", maker)
    same_strip()


def same_strip():
    """What the page of the potential says of a strip follows from its formulas."""
    maker = SOURCE / "docs/theory/pictures/draw-potential.py"
    page = (SOURCE / "docs/theory/contact-potential.md").read_text()
    done = run([sys.executable, str(maker), "--numbers"])
    assert done.returncode == 0, done.stdout
    told = {name: values for name, *values in re.findall(r"^(.+): (\S+) k c\^([23]) at w = (\S+) c$", done.stdout, re.MULTILINE)}
    assert len(told) == 7, done.stdout
    for name, wanted in (("front where it begins to fall", "0.125"), ("front after its end", "0.000"), ("over a seam, largest rise", "0.000")):
        assert told.pop(name)[0] == wanted, done.stdout
    for name, (value, power, width) in told.items():
        told_there = rf"\${re.escape(value)}\\,kc_0\^{power}\$[^$]*" + ("at first" if width == "0.00" else rf"\$w={re.escape(width)}\\,c_0\$")
        assert re.search(told_there, page), f"{name}: {value} k c^{power} at {width} c is not what the page says"
    (value, _, width), = [values for name, values in told.items() if name == "front, largest"]
    assert f"at most ${value}\\,kc^3$ per length, at $w={width}\\,c$" in page
