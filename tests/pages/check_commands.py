#!/usr/bin/env python3
"""Tries every command of the pages: decks are checked, quick commands run, options and files of the others must exist.
Usage: check_commands.py IMPLAM ROOT BUILD

A command is an indented line of a page that begins with one of the programs below. Commands that take longer are run by
other tests: the tutorial by docs_tutorial, examples of the manual by postproc_runs, exchange by exchange_manual. Lines
of Python given to an interpreter by -c are compiled.
"""

import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

LINE = re.compile(r"^ {4,}((?:build/|\.venv/bin/)?implam\S*|tests/\S+\.py|mpirun) (.*)$")
PYTHON = re.compile(r'^( {4,})\S*python3? -c "(.*?)"$', re.MULTILINE | re.DOTALL)
CTEST = re.compile(r"`?ctest [^`|]*?-([RL]) +'?([^\s`']+)")
# Commands of the program that only read decks, and run at once.
QUICK = ("check", "explain", "help", "version", "man", "completion")
# Commands with a file of an earlier run or of a list.
LATER = ("restart", "queue")
# Decks that stand for the reader's own.
PLACEHOLDERS = re.compile(r"^(?:deck|panel|plate|DECK)\.nml$")


def commands(page):
    """Programs and words of a page's commands, lines that go on joined, with their numbers."""
    lines = page.read_text(encoding="utf-8").splitlines()
    inside = False
    for number, line in enumerate(lines, 1):
        inside ^= line.lstrip().startswith("```")
        match = None if inside else LINE.match(line)
        if match:
            words, following = match[2], number
            while words.endswith("\\"):
                words, following = words[:-1] + lines[following].strip(), following + 1
            yield number, match[1], shlex.split(re.split(r" +# | & | && ", words)[0])


def fault_of_python(code, indentation):
    """What the compiler says of lines given to Python, as they are copied from a page."""
    try:
        compile(code.replace(f"\n{indentation}", "\n"), "page", "exec")
    except SyntaxError as error:
        return f"Python: {error.msg} in line {error.lineno} of its code"
    return ""


class Checker:
    """Tries commands from the root of the project."""

    def __init__(self, program, root, build):
        """Take the program and folders."""
        self.program, self.root, self.build = program, root, build
        self.helps, self.numbers = {}, {}

    def run(self, *words):
        """Exit code and output of a program."""
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                  timeout=120, check=False)  # fmt: skip
        return done.returncode, done.stdout

    def help_of(self, name):
        """What a command of Python prints about its options; empty where it is not installed."""
        script = self.root / ".venv" / "bin" / name
        if name not in self.helps:
            self.helps[name] = self.run(str(script), "--help")[1] if script.exists() else ""
        return self.helps[name]

    def fault_of_program(self, words):
        """Try the program's own command: run it if quick, else check its deck."""
        verb = words[0] if words else ""
        if verb in LATER:
            return ""
        decks = [word for word in words if word.endswith(".nml")]
        if verb == "new" or any(PLACEHOLDERS.match(deck) for deck in decks):
            return ""
        missing = [deck for deck in decks if not (self.root / deck).exists()]
        if missing:
            return f"there is no {missing[0]}"
        given = [str(self.root / word) if word in decks else word for word in words] if verb in QUICK else [
            "check", *(str(self.root / deck) for deck in decks)]
        code, printed = self.run(self.program, *given)
        # A run from another's end needs that first.
        return "" if code == 0 or "initial_state" in printed else printed.strip()

    def fault_of_options(self, options, text):
        """Options that a help or a source does not name."""
        unknown = [option for option in options if option.split("=")[0] not in text]
        return f"unknown option {unknown[0]}" if unknown and text else ""

    def fault(self, program, words):
        """What is wrong with a command; empty: nothing."""
        name = Path(program).name
        options = [word for word in words if word.startswith("--")]
        if program.startswith("tests/"):
            script = self.root / program
            return self.fault_of_options(options, script.read_text()) if script.exists() else f"there is no {program}"
        if name == "mpirun":
            place = next((n for n, word in enumerate(words) if Path(word).name == "implam"), None)
            return "" if place is None else self.fault_of_program(words[place + 1:])
        if name == "implam":
            return self.fault_of_program(words) or self.fault_of_options(options, self.run(self.program, "help")[1])
        files = [word for word in words if re.match(r"(?:input|tests)/", word) and not word.startswith("input/small/")]
        missing = [word for word in files if not (self.root / word).exists() and word.endswith((".bdf", ".csv"))]
        return f"there is no {missing[0]}" if missing else self.fault_of_options(options, self.help_of(name))

    def tests_of(self, option, pattern):
        """Number of tests that ctest chooses."""
        if (option, pattern) not in self.numbers:
            found = self.run("ctest", "--test-dir", str(self.build), "-N", f"-{option}", pattern)[1]
            self.numbers[option, pattern] = int(re.search(r"Total Tests: (\d+)", found)[1])
        return self.numbers[option, pattern]

    def check(self, page):
        """Breaches of a page."""
        name = page.relative_to(self.root)
        for number, program, words in commands(page):
            fault = self.fault(program, words)
            if fault:
                yield f"{name}:{number}: {program} {' '.join(words)}: {fault}"
        text = page.read_text(encoding="utf-8")
        for match in PYTHON.finditer(text):
            fault = fault_of_python(match[2], match[1])
            if fault:
                yield f"{name}:{text[:match.start()].count(chr(10)) + 1}: {fault}"
        for number, line in enumerate(text.splitlines(), 1):
            # Other builds have other tests.
            chosen = [] if re.search(r"--preset (?!release)|--test-dir build-", line) else CTEST.findall(line)
            for option, pattern in chosen:
                if pattern != "NAME" and not self.tests_of(option, pattern):
                    yield f"{name}:{number}: ctest -{option} {pattern} chooses no test"


def main(program, root, build):
    """Check all pages; return the exit code."""
    checker = Checker(program, Path(root), Path(build))
    pages = [Path(root, "README.md"), *sorted(Path(root, "doc").rglob("*.md"))]
    wrong = [breach for page in pages for breach in checker.check(page)]
    tried = sum(1 for page in pages for _ in commands(page))
    print("\n".join(wrong) or f"{tried} commands of {len(pages)} pages can be given")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
