"""A function that communicates has a communicator in its type, and says that it is collective. Reads text only.

It takes a `const Comm&` or an object that keeps one, or is a member of such a class: docs/developer/packages.md. Run by ctest.
"""

import os
import pathlib
import re
import sys

SOURCE = pathlib.Path(os.environ["COPLANE_SOURCE"])
COLLECTIVE = re.compile(r"(?<![Nn]ot )\bCollective\b|///< ([^/]*[;,] )?collective\b|\b[Aa]ll calls are collective\b|; collective\.")

COMMUNICATES = re.compile(r"\bcomm(_|\(\))?(\.|->)(min|max|sum|barrier|broadcast|demandSame|allGather|exchange|together)\(|\b(overRanks|totals)\(")


class Declaration:
    """A function as a header declares it: its words in `text`, what is said of it in `said`, its class or ""."""

    def __init__(self, place, text, said, owner):
        self.place, self.text, self.said, self.owner = place, text, said, owner
        self.name = re.search(r"(~?\w+|operator\W+)\s*\(", text).group(1)
        self.collective = bool(COLLECTIVE.search(said))

    def makes_object(self):
        return self.name.strip("~") == self.owner


def declarations(path):
    """Of a header, in order; and of every class in it the words of its head and of its members that are no functions."""
    functions, classes = [], {}
    said, paragraph, owners, lines = "", "", [], path.read_text().split("\n")
    at = 0
    while at < len(lines):
        line = lines[at].strip()
        indent = len(lines[at]) - len(lines[at].lstrip())
        if owners and line.startswith("}") and indent == owners[-1][1]:
            owners.pop()
        head = re.match(r"(?:class|struct) (\w+)([^;]*)$", line)
        if head and indent <= 4:
            owners.append((head.group(1), indent, said))
            classes[head.group(1)] = head.group(2)
        if line.startswith("//"):
            # `//` says something of all that follow up to an empty line, `///` of the next one.
            if line.startswith("///"):
                said += " " + line.lstrip("/")
            else:
                paragraph += " " + line.lstrip("/")
        elif not line:
            said = paragraph = ""
        elif not line.startswith(("#", "}", "{")) and not re.match(r"(public|protected|private):", line):
            start, text = at, line
            while not re.search(r"[;{}]", text.split("///<")[0]) and at + 1 < len(lines):
                at += 1
                text += " " + lines[at].strip()
            code = re.sub(r"///<.*?(?=  |$)", "", text)
            inside = indent == (owners[-1][1] + 2 if owners else 0)
            is_function = re.match(r"[\w:<>,&*\[\] ~]+\s\**&?(~?\w+|operator\W+)\(|(explicit )?~?\w+\(", code) and " = " not in code.split("(")[0]
            if inside and is_function and not line.startswith(("return", "if", "for", "using", "template", "friend")):
                of_class = owners[-1][2] if owners and "All calls" in owners[-1][2] else ""
                place = f"{path.relative_to(SOURCE)}:{start + 1}"
                functions.append(Declaration(place, code, said + paragraph + of_class + text[text.find("///<") :] * ("///<" in text), owners[-1][0] if owners else ""))
            elif owners and inside:
                classes[owners[-1][0]] += " " + code
            if not line.startswith("template"):
                said = ""
        at += 1
    return functions, classes


def keepers(functions, classes):
    """Classes that keep a communicator: made with one, or with a member or a base class that keeps one."""
    found = {"Comm"} | {f.owner for f in functions if f.makes_object() and re.search(r"\bComm\b", f.text)}
    while True:
        words = re.compile(r"\b(" + "|".join(found) + r")\b")
        more = {name for name, text in classes.items() if words.search(text)} - found
        if not more:
            return found
        found |= more


def bodies(path):
    """Class, name and body of every member that a source defines outside its class."""
    text = path.read_text()
    for found in re.finditer(r"^[^\s#/}].*?\b(\w+)::(~?\w+)\([^;{}]*?\)[^;{}]*?\n\{\n(.*?)^\}", text, re.M | re.S):
        yield found.group(1), found.group(2), found.group(3)


def main():
    functions, classes = [], {}
    for path in sorted([*SOURCE.glob("packages/*/src/**/*.hpp"), *SOURCE.glob("apps/*/src/*.hpp")]):
        more, types = declarations(path)
        functions += more
        classes.update(types)
    kept = keepers(functions, classes)
    word = re.compile(r"\b(" + "|".join(sorted(kept)) + r")\b")
    wrong = []
    for function in functions:
        if function.owner == "Comm":
            continue
        if function.collective and not function.name.startswith("~") and function.owner not in kept and not word.search(function.text):
            wrong.append(f"{function.place}: {function.name} is said to be collective, but has no Comm, nor an object that keeps one")
        takes = re.search(r"\(.*\bconst Comm& \w+", function.text)
        if takes and not function.collective and not function.makes_object():
            wrong.append(f"{function.place}: {function.name} takes a Comm, but is not said to be collective; if it only counts ranks, let it take numbers")
    said = {(f.owner, f.name): f for f in functions}
    said.update({(f.owner, f.name): f for f in functions if f.collective})
    for path in sorted([*SOURCE.glob("packages/*/src/**/*.cpp"), *SOURCE.glob("apps/*/src/*.cpp")]):
        for owner, name, body in bodies(path):
            function = said.get((owner, name))
            if function and not function.collective and " override" not in function.text and COMMUNICATES.search(body):
                wrong.append(f"{function.place}: {owner}::{name} communicates ({path.relative_to(SOURCE)}), but is not said to be collective")
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"{sum(f.collective for f in functions)} of {len(functions)} functions are collective; {len(kept)} classes keep a communicator")


if __name__ == "__main__":
    main()
