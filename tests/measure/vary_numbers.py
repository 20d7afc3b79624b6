#!/usr/bin/env python3
"""How much hangs on the numbers of contact that were set by experience: each of them changed, and what becomes of contact.

    python3 tests/measure/vary_numbers.py prepare COPY
    python3 tests/measure/vary_numbers.py run BIN [NAME=VALUE ...]

`prepare` changes a copy of the sources (a clone, say) so that a program that is built of it reads these numbers from the environment, VARY_NAME
for NAME, and prints them with their values. `run` runs cases of verification, metamorphic scenes, 48 corners, 6 thrown bodies and 50 slid blocks
with such a program, in some three minutes on one core, and prints one line. Works in a folder of its own that it deletes.
"""

import contextlib
import io
import itertools
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
NAMES = (
    "alongThePlane behind convex cosFolded deepBehind deepestBirth deepestStart faceAway farthestInAStep fastBesideWaves flush grownAt largestBeginning "
    "least leastShare motionPerStep muchLess nearlyItsNormal one parallel partInMeeting perCycle rimStiffening rimsCountFrom sameWay shareOfStrip sharp "
    "smallestOverlap stiffestCalm unevenShare"
).split()
CASES = "V14_incline V24_rebound V30_eccentric_collision V52_topple_or_slide V53_arch deep_slides fast_blocks contact_damping slides_and_rocks".split()
SCENES = "settle_2d settle_3d tumble_2d corner_2d_rough corner_3d_rough slide_2d_rough rest_3d spin_3d_rough".split()
HEADER = """#pragma once

#include <cstdlib>
#include <string>

namespace coplane
{
inline double varied(const char* name, double usual)
{
  const char* value = std::getenv((std::string("VARY_") + name).c_str());
  return value ? std::atof(value) : usual;
}
} // namespace coplane
"""


def prepare(copy):
    packages = pathlib.Path(copy) / "packages"
    (packages / "core/src/coplane_core/Varied.hpp").write_text(HEADER)

    def from_environment(match):
        indent, in_class, declared = match.groups()
        parts = [[side.strip() for side in part.split("=")] for part in declared.split(",")]
        if not any(name in NAMES for name, _ in parts):
            return match.group(0)
        for name, value in parts:
            print(name, value)
        kind = "static inline" if in_class else "static" if indent else "inline"
        return f"{indent}{kind} const Real " + ", ".join(f'{name} = varied("{name}", {value})' for name, value in parts) + ";"

    for package in ("contact", "dynamics"):
        for path in sorted(packages.glob(f"{package}/src/**/*.?pp")):
            before = path.read_text()
            after = re.sub(r"^( *)(static )?constexpr Real ([a-zA-Z]+ = [^;{}]+);", from_environment, before, flags=re.M)
            if after != before:
                path.write_text(after.replace("#include", "#include <coplane_core/Varied.hpp>\n#include", 1))


def failed_checks(script, *arguments):
    """Of one case, in a folder of its own; that a run ends it counts as one."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([sys.executable, script, *arguments], cwd=folder, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    checks = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    failed = [check["quantity"] for check in checks if check["passed"] is False and not check.get("reported")]
    return failed or (["ended by a run"] if done.returncode else [])


def run(program):
    os.environ["COPLANE_BIN"] = str(pathlib.Path(program).resolve())
    failed = {}
    for name in CASES:
        failed[name] = failed_checks(HERE.parent / "verification" / name / "check.py")
    for name in SCENES:
        failed[name] = failed_checks(HERE.parent / "metamorphic" / "check.py", name)

    import contact_tables as tables
    import slid_blocks
    from coplanetest import Case

    def sizes(case, scenes):
        found = [case.attempt(str(k), recipe, deck, change_mesh=place) for k, (recipe, deck, place) in enumerate(scenes)]
        return sorted(abs(tables.lost(run)) if run.code in (0, 6) else 1.0 for run in found)

    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), contextlib.redirect_stdout(io.StringIO()):
        corners = sizes(Case("corners", __file__), [
            tables.corner(tilt, off, speed, rigid)
            for rigid, tilt, off, speed in itertools.product((False, True), (5, 25, 45, 60), (0.0, 1e-3, -5e-3), (2.0, 20.0))
        ])  # fmt: skip
        floors = sizes(Case("floors", __file__), [
            tables.thrown(shape, floor) for shape, floor in itertools.product(("cube", "prism"), ("four flush slabs", "slabs of other meshes", "tetrahedra"))
        ])  # fmt: skip
        case, held, let_go, remainders = Case("slides", __file__), 0, 0, []
        for k, scene in enumerate(slid_blocks.scenes(50, 7)):
            mesh, deck = slid_blocks.slid_block(**scene)
            deck["contact"]["lost_contact"] = "warn"
            history = case.attempt(str(k), mesh, deck).history
            force = history["touch_normal_force"]
            held += force[len(force) // 2 :].min() > 0.7 * force.max()
            let_go += force[-1] < 0.3 * force.max()
            remainders.append(history["contact_remainder"][-1] / abs(history["external_work"]).max())
    print(f"{sum(map(len, failed.values()))} checks fail {({name: checks[:3] for name, checks in failed.items() if checks}) or ''}; corners: median "
          f"{corners[len(corners) // 2]:.1e}, largest {corners[-1]:.1e}; floors {floors[-1]:.1e}; slides: {held} hold, {let_go} let go, "
          f"{min(remainders):.1e} to {max(remainders):.1e}")  # fmt: skip


if __name__ == "__main__":
    if sys.argv[1:2] == ["prepare"] and len(sys.argv) == 3:
        prepare(sys.argv[2])
    elif sys.argv[1:2] == ["run"] and len(sys.argv) > 2:
        for given in sys.argv[3:]:
            name, _, value = given.partition("=")
            if name not in NAMES or not value:
                sys.exit(f"{given}: give NAME=VALUE with one of {', '.join(NAMES)}")
            os.environ["VARY_" + name] = value
        run(sys.argv[2])
    else:
        sys.exit(__doc__)
