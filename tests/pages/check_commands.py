#!/usr/bin/env python3
"""Tests the commands of the pages that no test runs completely: decks are checked, quick commands run, options and
files of the others must exist. Usage: check_commands.py IMPLAM ROOT BUILD

These are the lines of blocks marked `sh long` and `sh elsewhere` (page_commands.py), indented lines that begin with one
of the programs below, and commands of the program within sentences and tables. Those of blocks marked `sh` are run by
docs_commands and docs_tutorial, which also start those of blocks marked `sh long`. The manual gives each command of
Python at least once.
"""

import os
import re
import shlex
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

from page_commands import FENCE, INLINE, Command, parts_of

PROGRAM = r"((?:build/|\.venv/bin/)?implam\S*|tests/\S+\.py|mpirun) (.*)$"
LINE, FENCED = re.compile(r"^ {4,}" + PROGRAM), re.compile(PROGRAM, re.DOTALL)
CTEST = re.compile(r"`?ctest [^`|]*?-([RL]) +'?([^\s`']+)")
# Commands of the program that only read decks, and are run.
QUICK = ("check", "explain", "help", "version", "man", "completion")
# Commands with a file of an earlier run or of a list.
LATER = ("restart", "queue")
# Placeholders for decks of the reader.
PLACEHOLDERS = re.compile(r"^(?:deck|panel|plate|DECK)\.nml$")


def words_of(text):
    """The words of a command up to a comment or a second command."""
    return shlex.split(re.split(r" +# | & | && ", text)[0])


def indented(lines):
    """Programs and words of indented commands, continuation lines joined, with their numbers."""
    inside = False
    for number, line in enumerate(lines, 1):
        inside ^= bool(FENCE.match(line))
        match = None if inside else LINE.match(line)
        if match:
            words, following = match[2], number
            while words.endswith("\\"):
                words, following = words[:-1] + lines[following].strip(), following + 1
            yield number, match[1], words_of(words)


def commands(page):
    """Programs and words of a page's commands that no test runs, with their numbers of lines."""
    text = page.read_text(encoding="utf-8")
    yield from indented(text.splitlines())
    for part in parts_of(text):
        match = FENCED.match(part.text) if isinstance(part, Command) and part.kind != "run" else None
        if match:
            yield part.line, match[1], words_of(match[2])
    for number, line in enumerate(text.splitlines(), 1):
        # Capital letters are placeholders of the reader's input, dots mark omissions.
        for command in INLINE.findall(line):
            if not re.search(r"\b[A-Z]{2,}\b|\.\.\.|[|<]|\[", command):
                yield number, "implam", words_of(command.removeprefix("implam "))


class Checker:
    """Tests commands from the root of the project."""

    def __init__(self, program, root, build):
        """Set the program and folders."""
        self.program, self.root, self.build = program, root, build
        self.helps, self.numbers, self.ended = {}, {}, {}

    def run(self, *words):
        """Exit code and output of a program, which is run once only with the same words."""
        if words not in self.ended:
            with tempfile.TemporaryDirectory() as folder:
                done = subprocess.run(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                      timeout=120, check=False)  # fmt: skip
            self.ended[words] = done.returncode, done.stdout
        return self.ended[words]

    def help_of(self, name):
        """The help of a Python command; empty where it is not installed."""
        script = self.root / ".venv" / "bin" / name
        if name not in self.helps:
            self.helps[name] = self.run(str(script), "--help")[1] if script.exists() else ""
        return self.helps[name]

    def fault_of_program(self, words):
        """Test a command of the program: run it if quick, else check its deck."""
        verb = words[0] if words else ""
        if verb in LATER:
            return ""
        decks = [word for word in words if word.endswith(".nml")]
        if verb == "new":
            code, printed = self.run(self.program, *words)
            return printed.strip() if code else ""
        if any(PLACEHOLDERS.match(deck) for deck in decks):
            return ""
        # A command that is only named, as `implam check` is, or that reads the deck of the folder.
        if not decks and (verb not in QUICK or verb == "check"):
            return ""
        missing = [deck for deck in decks if not (self.root / deck).exists()]
        if missing:
            return f"there is no {missing[0]}"
        given = [str(self.root / word) if word in decks else word for word in words] if verb in QUICK else [
            "check", *(str(self.root / deck) for deck in decks)]
        code, printed = self.run(self.program, *given)
        # A run from the final state of another one needs that run first.
        return "" if code == 0 or "initial_state" in printed else printed.strip()

    def fault_of_options(self, options, text):
        """Options that a help or a source does not list."""
        unknown = [option for option in options if option.split("=")[0] not in text]
        return f"unknown option {unknown[0]}" if unknown and text else ""

    def fault(self, program, words):
        """The fault of a command; empty: none."""
        name = Path(program).name
        options = [word for word in words if word.startswith("--")]
        if program.startswith("tests/"):
            script = self.root / program
            if not os.access(script, os.X_OK):
                return f"there is no {program} that can be executed"
            return self.fault_of_options(options, script.read_text())
        if name == "mpirun":
            place = next((n for n, word in enumerate(words) if Path(word).name == "implam"), None)
            return "" if place is None else self.fault_of_program(words[place + 1:])
        if name == "implam":
            return self.fault_of_program(words) or self.fault_of_options(options, self.run(self.program, "help")[1])
        files = [word for word in words if re.match(r"(?:input|tests)/", word) and not word.startswith("input/small/")]
        missing = [word for word in files if not (self.root / word).exists() and word.endswith((".bdf", ".csv"))]
        return f"there is no {missing[0]}" if missing else self.fault_of_options(options, self.help_of(name))

    def tests_of(self, option, pattern):
        """Number of tests that ctest selects."""
        if (option, pattern) not in self.numbers:
            found = self.run("ctest", "--test-dir", str(self.build), "-N", f"-{option}", pattern)[1]
            self.numbers[option, pattern] = int(re.search(r"Total Tests: (\d+)", found)[1])
        return self.numbers[option, pattern]

    def is_registered(self, pattern):
        """False for tests that exist only with the Python commands and their tools."""
        tools = {"postproc": "implam-plot", "lint_types": "mypy"}
        return all((self.root / ".venv/bin" / tool).exists() for name, tool in tools.items() if name in pattern)

    def check(self, page):
        """Breaches of a page."""
        name = page.relative_to(self.root)
        for number, program, words in commands(page):
            fault = self.fault(program, words)
            if fault:
                yield f"{name}:{number}: {program} {' '.join(words)}: {fault}"
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            # Other builds have other tests.
            chosen = [] if re.search(r"--preset (?!release)|--test-dir build-", line) else CTEST.findall(line)
            for option, pattern in chosen:
                if pattern != "NAME" and self.is_registered(pattern) and not self.tests_of(option, pattern):
                    yield f"{name}:{number}: ctest -{option} {pattern} chooses no test"


def unnamed(root):
    """Python commands that no page of the manual gives."""
    manual = "".join(page.read_text(encoding="utf-8") for page in (root / "doc" / "manual").glob("*.md"))
    project = tomllib.loads((root / "postproc" / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return [name for name in project["scripts"] if not re.search(rf"\b{name} ", manual)]


def main(program, root, build):
    """Check all pages; return the exit code."""
    program, root, build = (Path(word).resolve() for word in (program, root, build))
    checker = Checker(str(program), root, build)
    pages = [root / "README.md", *(page for page in sorted((root / "doc").rglob("*.md")) if "news" not in page.parts)]
    wrong = [breach for page in pages for breach in checker.check(page)]
    wrong += [f"doc/manual: no page gives the command {name}" for name in unnamed(root)]
    tried = sum(1 for page in pages for _ in commands(page))
    print("\n".join(wrong) or f"{tried} commands of {len(pages)} pages can be given")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
