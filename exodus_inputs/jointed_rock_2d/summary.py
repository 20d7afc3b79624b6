"""Several variants together: searching once or every four cycles must give the same bits."""

import json
import pathlib
import sys

from coplanetools import Example, differences

runs = {json.loads((pathlib.Path(folder) / "example.json").read_text())["variant"]: folder for folder in sys.argv[1:]}
if {"", "every4"} <= set(runs):
    once, often = Example(runs[""]), Example(runs["every4"])
    once.check_equal("results that differ, searching every four cycles", differences(once.run.path("run.e"), often.run.path("run.e")), [])
    once.check_equal("state hash, searching every four cycles", often.run.state_hash, once.run.state_hash)
    once.finish()
