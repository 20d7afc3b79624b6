"""A validation case: what a verification case is, with mesh studies, answers of other codes, the time that it took, and a picture."""

import json
import os
import pathlib
import subprocess
import sys
import time

from coplanetools import program

from .case import Case


class ValidationCase(Case):
    """Lines of kind `study`, `other` and `seconds` fail nothing; support/verification_page.py makes tables of them.

    `full` tells whether the long form was asked for (argument `all`). With the argument `picture` the long form also draws
    the picture of the case, into docs/validation/<case>.png.
    """

    def __init__(self, folder_of):
        super().__init__(pathlib.Path(folder_of).resolve().parent.name, folder_of)
        self.full = "all" in sys.argv[1:]
        self.begun = time.time()

    def study(self, quantity, size, value, reference=None, seconds=None):
        """One row of a mesh study: the value [unit as in `quantity`] with elements of this size (words), and the seconds of its run."""
        self.note("study", quantity, value, reference, size=size, seconds=seconds)

    def other(self, quantity, code, value, reference=None, seconds=None, lines=None):
        """What a code, or another source, gives for the quantity; `lines`: of input."""
        self.note("other", quantity, value, reference, code=code, seconds=seconds, lines=lines)

    def note(self, kind, quantity, value, reference, **more):
        def plain(x):
            return x.item() if hasattr(x, "item") else x

        record = {"case": self.name, "kind": kind, "quantity": quantity, "value": plain(value), "reference": plain(reference), **more}
        print(json.dumps(record), flush=True)
        self.append(record)

    def timed(self, *arguments, **options):
        """run() and its wall seconds, meshing included."""
        begun = time.time()
        result = self.run(*arguments, **options)
        return result, time.time() - begun

    def picture(self, run, *options):
        """Draws an ended run by `coplane pictures` where the argument `picture` is given; options: of that program. One picture of all
        states that the options choose.
        """
        if "picture" not in sys.argv[1:]:
            return
        folder = pathlib.Path(run.folder, "pictures")
        command = [program.binary("coplane"), "pictures", run.path("run.e"), "-o", str(folder), "--name", self.source.name, *options]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            sys.exit(f"{self.name}: {' '.join(command)}\n{done.stdout}")
        drawn = sorted(folder.glob("*.png"), key=os.path.getmtime)
        target = pathlib.Path(os.environ["COPLANE_SOURCE"], "docs/validation", f"{self.source.name}.png")
        target.parent.mkdir(exist_ok=True)
        from PIL import Image

        # 256 colours are enough, and a third of the bytes.
        Image.open(drawn[-1]).convert("RGB").quantize(256, dither=Image.Dither.NONE).save(target, optimize=True)

    def finish(self):
        self.note("seconds", "long form" if self.full else "coarse form", time.time() - self.begun, None)
        super().finish()
