"""CalculiX (Debian: calculix-ccx) on the same problems: box meshes, runs, and what it prints. Cases say so and go on where it is missing."""

import pathlib
import re
import shutil
import subprocess
import time

import numpy


def found():
    """Whether the program ccx is installed."""
    return shutil.which("ccx") is not None


class Input:
    """An input file in parts: a mesh of boxes of C3D8 elements, and lines of one's own, which are counted."""

    def __init__(self, element="C3D8"):
        self.mesh, self.own, self.nodes, self.elements, self.element = [], [], 0, 0, element

    def box(self, name, low, high, divisions):
        """A box of elements: node set N<name>, element set E<name>, surfaces S<name>x0, x1, y0, y1, z0, z1 (its sides), and node sets of the same
        names with N. Returns the coordinates of its nodes, with the first node number.
        """
        lines = [numpy.linspace(a, b, n + 1) for a, b, n in zip(low, high, divisions)]
        (nx, ny, nz), first = divisions, self.nodes + 1

        def node(i, j, k):
            return first + i + (nx + 1) * (j + (ny + 1) * k)

        def listed(numbers):
            return [", ".join(map(str, numbers[i : i + 12])) + "," for i in range(0, len(numbers), 12)]

        points = [(x, y, z) for z in lines[2] for y in lines[1] for x in lines[0]]
        self.nodes += len(points)
        self.mesh += [f"*NODE, NSET=N{name}", *(f"{first + n}, {x:.11e}, {y:.11e}, {z:.11e}" for n, (x, y, z) in enumerate(points))]  # 20 characters at most
        self.mesh.append(f"*ELEMENT, TYPE={self.element}, ELSET=E{name}")
        sides = {key: [] for key in ("x0", "x1", "y0", "y1", "z0", "z1")}
        for k in range(nz):
            for j in range(ny):
                for i in range(nx):
                    self.elements += 1
                    corners = [node(i + a, j + b, k + c) for a, b, c in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))]
                    self.mesh.append(f"{self.elements}, " + ", ".join(map(str, corners)))
                    for key, on, face in (("x0", i == 0, 6), ("x1", i == nx - 1, 4), ("y0", j == 0, 3), ("y1", j == ny - 1, 5), ("z0", k == 0, 1), ("z1", k == nz - 1, 2)):
                        if on:
                            sides[key].append((self.elements, face))
        points = numpy.array(points)
        for axis, key in enumerate("xyz"):
            for end, value in ((0, low[axis]), (1, high[axis])):
                self.mesh += [f"*SURFACE, NAME=S{name}{key}{end}", *(f"{e}, S{f}" for e, f in sides[f"{key}{end}"])]
                on = numpy.flatnonzero(numpy.isclose(points[:, axis], value)) + first
                self.mesh += [f"*NSET, NSET=N{name}{key}{end}", *listed(on.tolist())]
        return points, first

    def say(self, text):
        """Lines of one's own."""
        self.own += [line.strip() for line in text.strip().splitlines()]

    def bystander(self, at, speed, material):
        """A block of one element [m] at this corner, nowhere near the others, that flies past along y with this speed [m/s]. In implicit steps with contact CalculiX refuses a converged increment whose balance of
        energy has changed by more than 0.25 % of the largest energy so far (checkimpacts.f: "Friction has not been tested deeply"). Bodies that begin at rest have none yet, so that each increment is refused and cut until
        "too many cutbacks" or "solution seems to diverge". The energy of the bystander is what it takes its share of; the forces between the others do not change. Returns the lines of its section and of its velocity.
        """
        self.box("BYSTANDER", at, tuple(x + 0.1 for x in at), (1, 1, 1))
        return f"*SOLID SECTION, ELSET=EBYSTANDER, MATERIAL={material}", f"NBYSTANDER, 2, {speed}"

    def run(self, folder, timeout=600):
        """Runs ccx on one thread in the folder. Returns the seconds, or None where it ended with an error."""
        folder = pathlib.Path(folder).resolve()
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        (folder / "job.inp").write_text("\n".join(self.mesh + self.own) + "\n")
        begun = time.time()
        try:
            done = subprocess.run(["ccx", "job"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=timeout,
                                  env={"OMP_NUM_THREADS": "1", "PATH": "/usr/bin:/bin"})  # fmt: skip
        except subprocess.TimeoutExpired:
            return None
        (folder / "output.txt").write_text(done.stdout)
        return time.time() - begun if done.returncode == 0 and "Job finished" in done.stdout else None


def printed(folder):
    """Tables of job.dat: [(words of the heading, set, time, array of the rows)]."""
    tables, heading = [], None
    for line in pathlib.Path(folder, "job.dat").read_text().splitlines():
        if match := re.match(r"\s*(.*?)(?: for set (\S+))? and time\s+(\S+)", line):
            heading = (match[1], match[2], float(match[3]), [])
            tables.append(heading)
        elif heading and line.strip():
            heading[3].append([float(x) for x in line.split()])
    return [(words, name, at, numpy.array(rows)) for words, name, at, rows in tables]
