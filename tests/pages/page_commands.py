"""Commands and files of pages, for the tests of this folder.

A block of code marked `sh` holds commands that a test runs, in the order of the page. `sh long` holds commands of
minutes to hours, which a test starts and stops. `sh elsewhere` holds those that another page or test runs, or that need
a queue, a screen, a network or files of the reader's own: they are checked without being run. A block after
<!-- file PATH --> is the content of a file that the reader saves.
"""

import re
import shlex
import textwrap
from dataclasses import dataclass

FENCE = re.compile(r"^( *)```(.*)$")
SAVED = re.compile(r"^ *<!-- file (\S+) -->$")
# Marks of blocks with commands, and their treatment by the tests.
KINDS = {"sh": "run", "sh long": "start", "sh elsewhere": "check"}
# Decks that end early in tests, since their figures are not compared: after first growth, the compression under load.
# The last two are written by `implam new` and `implam-from-nastran`.
EARLY = {"input/tutorial/delamination.nml": "1.5e-3", "input/tutorial/panel.nml": "1.5e-3",
         "input/small/cai_impact.nml": "0.3e-3", "input/small/cai_compression.nml": "0.4e-3", "plate.nml": "0.4e-3",
         "panel.nml": "1e-3"}
# A command given within a sentence or a table.
INLINE = re.compile(r"`(implam (?!FILE|queue)[^`\n]*)`")


@dataclass
class Command:
    """A command of a page."""

    line: int
    text: str
    kind: str


@dataclass
class SavedFile:
    """A file that the reader saves before the commands that follow."""

    line: int
    name: str
    text: str


def blocks(page):
    """Blocks of code of a page: number of the first line, mark, name of a file to save, content."""
    lines, start, name = page.splitlines(), None, ""
    for number, line in enumerate(lines, 1):
        fence = FENCE.match(line)
        if start is None and not fence:
            saved = SAVED.match(line)
            name = saved[1] if saved else name if not line.strip() else ""
        elif start is None:
            start, mark = number + 1, fence[2].strip()
        elif fence and not fence[2]:
            yield start, mark, name, textwrap.dedent("\n".join(lines[start - 1 : number - 1])) + "\n"
            start, name = None, ""


def is_complete(text):
    """True if a command is complete on its line: quotes are closed, no backslash at the end."""
    try:
        shlex.split(text, comments=True)
    except ValueError:
        return False
    return not text.endswith("\\")


def commands_of(block, first):
    """The commands of a block with their numbers of lines; one may extend over several lines."""
    begun, text = first, ""
    for number, line in enumerate(block.splitlines(), first):
        if not text:
            begun = number
        text = f"{text}\n{line}" if text else line
        if text.strip() and is_complete(text):
            yield begun, text.replace("\\\n", " ").strip()
            text = ""
        elif not text.strip():
            text = ""


def parts_of(page):
    """Commands and files of a page, in its order."""
    for first, mark, name, block in blocks(page):
        if name:
            yield SavedFile(first, name, block)
        elif mark in KINDS:
            yield from (Command(number, text, KINDS[mark]) for number, text in commands_of(block, first))


def shorten(folder):
    """Let the decks of EARLY in a folder like a clone end early, where it has them."""
    for name, end in EARLY.items():
        path = folder / name
        if path.exists():
            path.write_text(re.sub(r"(?<=\bend=)\S+", end, path.read_text(encoding="utf-8")), encoding="utf-8")
