#!/usr/bin/python3
"""Draws report.png and report-phone.png: two runs of jointed rock, one with joints half as stiff, over each other, as a browser shows the page.

    PATH=build/bin:$PATH PYTHONPATH=packages/python docs/user/pictures/draw-report.py

Needs chromium and python3-pil; takes half a minute.
"""

import pathlib
import subprocess
import sys
import tempfile

from PIL import Image

from coplane import report

HERE = pathlib.Path(__file__).resolve().parent
TOP = HERE.parents[2]


def shot(page, width, height, picture):
    subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--allow-file-access-from-files",
                    f"--user-data-dir={page.parent / 'browser'}", "--virtual-time-budget=30000", f"--window-size={max(width, 500)},{height}",
                    f"--screenshot={picture}", page.as_uri()], check=True, stderr=subprocess.DEVNULL)  # fmt: skip


with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
    folder = pathlib.Path(folder)
    for name, stiffness in (("a", 2e10), ("b", 1e10)):
        subprocess.run([sys.executable, TOP / "exodus_inputs/run.py", "jointed_rock_2d", "--size", "coarse", "--no-pictures", "--no-check", "--output", folder / name,
                        "--set", f"joints.tight.normal_stiffness={stiffness:g}", "--set", "history.tables=[pairs]"], check=True, stdout=subprocess.DEVNULL)  # fmt: skip
    page = report.make(folder / "a", folder / "run-report.html", folder / "b", pictures=False)
    text = page.read_text()
    # From the balances on: what stands before them is long, and differs from machine to machine.
    begin, end = text.index('<h2 id="section0"'), text.index('<h2 id="section3"')
    page.write_text((text[:begin] + text[end:]).replace(str(folder), "out"))
    (folder / "frame.html").write_text('<body style="margin:0"><iframe src="run-report.html" style="width:390px;height:1500px;border:0"></iframe>')
    for name, source, width, height in (("report.png", page, 1000, 1500), ("report-phone.png", folder / "frame.html", 390, 1500)):
        shot(source, width, height, folder / name)
        picture = Image.open(folder / name).convert("RGB").crop((0, 0, width, height))
        picture.quantize(256, dither=Image.Dither.NONE).save(HERE / name, optimize=True)
        print(HERE / name)
