"""The benchmark makes its page: one run in all its ways, beside another program, which is the same one here."""

import os
import pathlib
import re
import subprocess
import sys

BINARIES = pathlib.Path(os.environ["COPLANE_BIN"])
script = pathlib.Path(__file__).with_name("benchmark.py")
command = [sys.executable, script, BINARIES, "--only", "perforation_3d", "--part", "0.2", "--folder", "runs"]
done = subprocess.run([*command, "--against", BINARIES / "coplane"], stdout=subprocess.PIPE, text=True, check=True)
print(done.stdout)
rows = re.findall(r"^\| perforation_3d coarse \|(.*)\|$", done.stdout, re.M)
assert len(rows) == 2, "one row of times, one of shares"
cells = [cell.strip() for cell in rows[0].split("|")]
assert len(cells) == 9 and all(float(cell) > 0 for cell in cells), cells
shares = [float(cell.rstrip(" %")) for cell in rows[1].split("|")[:-1]]
assert 0 < sum(shares) <= 105 and max(shares) > 1, shares
wrong = subprocess.run([*command, "--against", "/bin/false"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
assert wrong.returncode == 0 and "refused" in wrong.stdout, "another program that fails is told of, and is no reason to stop"
