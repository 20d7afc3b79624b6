"""V59 for the number of lanes: builds of 4 and of 8 give the same bits (COPLANE_LANES).

Builds the program once more with the other number, and compares scenes with tests/measure/compare_builds.py.
"""

import os
import pathlib
import re
import subprocess
import sys

from coplanetest import Case

NAMES = ["scene *", "points *", "example bar_wall_3d", "example explosion_3d", "example projectile_wall_2d"]
OPTIONS = ("COPLANE_ARCH", "COPLANE_TRILINOS", "Trilinos_DIR", "CMAKE_BUILD_TYPE", "CMAKE_CXX_COMPILER", "CMAKE_CXX_FLAGS", "CMAKE_CXX_COMPILER_LAUNCHER")
case = Case("V59 lane width", __file__)
source = pathlib.Path(os.environ["COPLANE_SOURCE"])
here = pathlib.Path(os.environ["COPLANE_BIN"])
cache = (here.parent / "CMakeCache.txt").read_text()


def option(name):
    found = re.search(rf"^{name}:\w+=(.*)$", cache, re.MULTILINE)
    return found.group(1) if found else ""


def lanes_of(folder):
    commands = (folder / "compile_commands.json").read_text()
    return {int(n) for n in re.findall(r"-DCOPLANE_LANES=(\d+)", commands)}


mine = lanes_of(here.parent)
case.check_equal("one number of lanes", len(mine), 1)
other = 4 if mine == {8} else 8
build = pathlib.Path("build").resolve()
same = [f"-D{name}={option(name)}" for name in OPTIONS if option(name)]
subprocess.run(["cmake", "-S", source, "-B", build, "-G", "Ninja", "-DCOPLANE_TESTS=OFF", f"-DCOPLANE_LANES={other}", *same], check=True)
subprocess.run(["ninja", "-C", build, "bin/coplane", "bin/coplane_mesh", "bin/coplane_point"], check=True)
case.check_equal("lanes of the other build", sorted(lanes_of(build)), [other])

compared = subprocess.run(
    [sys.executable, source / "tests/measure/compare_builds.py", here, build / "bin", *NAMES], capture_output=True, text=True, check=False)
print(compared.stdout, compared.stderr[-2000:])
rows = [line for line in compared.stdout.splitlines() if line.startswith("|")]
case.check_within("rows of the table", len(rows), 15, float("inf"))
case.check_equal("all runs are equal", compared.returncode, 0)
case.finish()
