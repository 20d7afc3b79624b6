#!/usr/bin/python3
"""Manual pages and bash completion, from what the programs say with --help.

    program-manuals.py VERSION FOLDER_OF_PROGRAMS OUTPUT_FOLDER

writes OUTPUT_FOLDER/coplane.1.gz and so on, and OUTPUT_FOLDER/completion, one file for all programs. Needs the standard library only.
"""

import dataclasses
import gzip
import pathlib
import re
import subprocess
import sys

# What each is, for `man -k`; programs whose calls begin with another one's name: its command, too.
PROGRAMS = {
    "coplane": "explicit dynamics of solids in contact by common planes",
    "coplane_mesh": "make, check, convert and split meshes for coplane",
    "coplane_pictures": "pictures and films of a run of coplane",
    "coplane_point": "lead material and joint laws along paths at one point",
    "coplane_new": "a folder of your own like an example of coplane",
    "coplane_report": "one HTML file about a run of coplane",
    "coplane_watch": "a view of a run of coplane in the terminal",
}
COMMANDS_OF_OTHERS = {"coplane": {name.partition("_")[2]: name for name in ("coplane_new", "coplane_pictures", "coplane_report", "coplane_watch")}}
FOLDER_NOTE = "Examples and documents: the folder share/coplane of the installation, for instance /usr/share/coplane."


@dataclasses.dataclass
class Help:
    """What one program, or one of its commands, says with --help."""

    usage: str = ""
    paragraphs: list = dataclasses.field(default_factory=list)
    sections: dict = dataclasses.field(default_factory=dict)  # heading: list of [item, meaning]
    commands: dict = dataclasses.field(default_factory=dict)  # name: Help

    def items(self, *headings):
        return [item for name, items in self.sections.items() if name.lower() in headings for item in items]

    def options(self):
        """Words that begin with a dash, and the words one of which has to follow them, if only these may."""
        words = {}
        for item, _ in self.items("options"):
            chosen = re.search(r"\{(.*?)\}", item)
            for name in re.findall(r"(?<![\w-])--?[a-zA-Z][\w-]*", item):
                words[name] = chosen.group(1).split(",") if chosen else []
        return words


def call_of(program):
    """As users write it: `coplane report` for coplane_report."""
    return program.replace("_", " ") if program in COMMANDS_OF_OTHERS["coplane"].values() else program


def parsed(text, program, command):
    """The parts of CLI11's and of argparse's help; `command` is the call that it is about, as users write it."""
    found, items = Help(), None
    for line in text.splitlines():
        heading = re.fullmatch(r"([A-Za-z][a-z ]*):", line)
        if line.lower().startswith("usage: "):
            called = re.sub(rf"^\S*{program}\b|^{call_of(program)}", "", line.split(": ", 1)[1]).strip()
            found.usage = " ".join(filter(None, [command, re.sub(rf"^{command.partition(' ')[2]} ", "", called)]))
            items = None
        elif heading:
            items = found.sections.setdefault(heading.group(1), [])
        elif items is not None and re.match(r"  \S", line):
            items.append((re.split(r"\s{2,}", line.strip(), maxsplit=1) + [""])[:2])
        elif items and re.match(r"\s{3,}\S", line):
            items[-1][1] = f"{items[-1][1]} {line.strip()}".strip()
        elif line.strip():
            items = None
            found.paragraphs.append(line.strip())
    return found


def said(folder, program, *arguments):
    done = subprocess.run([folder / program, *arguments, "--help"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode or "sage:" not in done.stdout:
        sys.exit(f"program-manuals: {program} {' '.join(arguments)} --help: exit code {done.returncode}\n{done.stdout}")
    return done.stdout


def help_of(folder, program):
    whole = parsed(said(folder, program), program, call_of(program))
    for name, _ in whole.items("subcommands"):
        whole.commands[name] = parsed(said(folder, program, name), program, f"{program} {name}")
    for name, other in COMMANDS_OF_OTHERS.get(program, {}).items():
        whole.commands[name] = parsed(said(folder, other), other, f"{program} {name}")
    return whole


def roff(text):
    return re.sub(r"^([.'])", r"\\&\1", text.replace("\\", "\\e").replace("-", "\\-"), flags=re.M)


def roff_items(items):
    return [line for item, meaning in items for line in (".TP", f"\\fB{roff(item)}\\fR", roff(meaning) or "\\&")]


def manual(program, text, version):
    """A page of section 1."""
    lines = [f'.TH {program.upper()} 1 "" "coplane {version}" "User Commands"', ".SH NAME", f"{roff(program)} \\- {roff(PROGRAMS[program])}",
             ".SH SYNOPSIS", f".B {roff(text.usage)}"]  # fmt: skip
    for command in text.commands.values():
        lines += [".br", f".B {roff(command.usage)}"]
    lines += [".SH DESCRIPTION"]
    for paragraph in text.paragraphs:
        lines += [".PP", roff(re.sub(rf"^{program}: ", "", paragraph))]
    for heading, items in text.sections.items():
        if heading.lower() != "subcommands":
            lines += [f".SH {heading.upper()}", *roff_items(items)]
    if text.commands:
        lines += [".SH COMMANDS"]
    for name, command in text.commands.items():
        lines += [f".SS {roff(f'{program} {name}')}", *map(roff, command.paragraphs)]
        lines += [line for items in command.sections.values() for line in roff_items(items)]
    lines += [".SH EXIT STATUS", "0 after success. \\fBcoplane \\-\\-help\\-codes\\fR prints the table of the others."]
    lines += [".SH FILES", roff(FOLDER_NOTE)]
    others = ", ".join(f"\\fB{roff(other)}\\fR(1)" for other in PROGRAMS if other != program)
    return "\n".join([*lines, ".SH SEE ALSO", others]) + "\n"


def completion_case(call, text):
    """Lines of the case statement of the completion for one call; file names are completed where it says nothing."""
    options = text.options()
    lines = [f"    {call})", f"      words='{' '.join(options)}'"]
    for name, chosen in options.items():
        if chosen:
            lines += [f"      [ \"$previous\" != {name} ] || chosen='{' '.join(chosen)}'"]
    if text.commands:
        lines += [f"      commands='{' '.join(text.commands)}'"]
    return [*lines, "      ;;"]


def completion(helps):
    cases = [line for program, text in helps.items() for line in completion_case(program, text)]
    cases += [line for program, text in helps.items() for name, command in text.commands.items()
              for line in completion_case(f"'{program} {name}'", command)]  # fmt: skip
    known = "|".join(f"'{program} {name}'" for program, text in helps.items() for name in text.commands)
    return "\n".join([
        "# bash completion of Coplane's programs; made from their --help",
        "_coplane_programs() {",
        "  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} call=${COMP_WORDS[0]##*/} words= chosen= commands=",
        "  COMPREPLY=()",
        f'  case "$call ${{COMP_WORDS[1]}}" in {known}) [ "$COMP_CWORD" = 1 ] || call="$call ${{COMP_WORDS[1]}}" ;; esac',
        '  case "$call" in',
        *cases,
        "  esac",
        '  if [ -n "$chosen" ]; then words=$chosen',
        '  elif [ "$COMP_CWORD" = 1 ] && [ "${word#-}" = "$word" ]; then words=$commands',
        '  elif [ "${word#-}" = "$word" ]; then return; fi',
        '  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")',
        "}",
        f"complete -o bashdefault -o default -F _coplane_programs {' '.join(helps)}",
    ]) + "\n"  # fmt: skip


def main():
    version, programs, output = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    output.mkdir(parents=True, exist_ok=True)
    helps = {program: help_of(programs, program) for program in PROGRAMS}
    for program, text in helps.items():
        (output / f"{program}.1.gz").write_bytes(gzip.compress(manual(program, text, version).encode(), 9, mtime=0))
    (output / "completion").write_text(completion(helps))


if __name__ == "__main__":
    main()
