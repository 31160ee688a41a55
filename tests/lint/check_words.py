#!/usr/bin/env python3
"""Finds invented and everyday words where the field has a term. Usage: check_words.py ROOT [--list FILE] [--write]

Looks at names (split at underscores), comments, strings and pages under src, tests, cmake, doc and postproc. WORDS are
refused everywhere, NAMES only as parts of names in code. Public names of decks and results stay. Prints one line a
breach, as file:line: word: what to say instead, and ends with code 1 if there is any.

--list names a file with lines "number path": breaches that a file may still have. The number may only become smaller;
--write lowers it to what the file has and drops files without a breach.
"""

import argparse
import re
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

FOLDERS = ("src", "tests", "cmake", "doc", "postproc")
SUFFIXES = (".f90", ".pf", ".c", ".in", ".py", ".toml", ".nml", ".md", ".txt", ".cmake", ".j2")
CODE = (".f90", ".pf", ".py")
# Folders that hold no text of ours, and this checker with its test and list.
SKIPPED = re.compile(r"(?:^|/)(?:build|__pycache__|\.venv|[^/]+\.egg-info)/|^tests/lint/(?:test_)?check_words\.|"
                     r"^tests/lint/words_to_do\.txt$")  # fmt: skip

# Words and phrases, as regular expressions, and what to say instead.
WORDS = {
    r"answers?": "unit-load solution, response, result",
    r"crowds?|company": "many points; batch of right-hand sides",
    r"haste": "lag of damage",
    r"clap(?:s|ped|ping)?": "open and close",
    r"hurts?|snapped": "damaged, failed",
    r"broken": "failed, damaged; of a file or link: invalid",
    r"lets? go": "release, separate",
    r"comes? apart|came apart|parted|parts company": "delaminate, separate, release; of text: separated",
    r"rounds of (?:the )?plies": "staggered iterations",
    r"he|him|his": "the impactor, or the noun that is meant",
    r"tups?": "impactor",
    r"forks?": "bifurcation, two solutions",
    r"wander(?:s|ed|ing)?": "take many iterations, drift",
    r"betters?|heed(?:s|ed)?": "improves, accelerates; limits by",
    r"(?:begins?|began|starts?) fresh": "start from a new factorization",
    r"on the wall": "wall-clock time",
    r"debts?|ow(?:es|ed)": "energy balance",
    r"whole plates?": "full plate",
    r"in play": "total, applied or internal forces",
    r"dear": "costly",
    r"tells?|told|untold": "prints, reports, gives",
    r"wants": "requests, requires",
    r"scenes?": "case, model, setup",
    r"leaps?|leapt": "jump over, step past",
    r"some(?:body|one) (?:looks|asks)": "output is due",
    r"adrift": "unrestrained",
    r"what it was made of": "the data it was computed from",
    r"go(?:es)? through the plate": "perforates",
    r"follow(?:s|ed)? (?:its|their) damage": "adaptive, grow with the damage",
    r"ask(?:s|ed)? for more": "require",
}
# Parts of names in code.
NAMES = {
    r"much|noticed|noticeable|little": "threshold or tolerance of what",
    r"settled?|settles": "converged, update, equilibrate",
    r"falls|fallen": "negative curvature, softening, decrease",
    r"lasting|rounds": "iterations of what",
    r"unmet": "residual, mismatch",
    r"judge|forget|remember": "check, reset, save",
    r"(?:most|least)(?=_)": "max, min",
    r"learn|learnt|seen": "update, record",
    r"borne|bears?": "supported, on frame",
    r"look|looks|looked": "check, observe",
}
# Names of decks, results and libraries that stay, as they stand in the text.
PUBLIC = (
    r"least_squares|at_(?:least|most)|(?:os|pty)\.fork|broken_strip",
    r"(?:key_|%|&time |`|\|\s*|')settle\b",
    r"settle\s*=",
    r"^.*\bsettle => .*$",
)


@dataclass
class Breach:
    """A word in a line of a file."""

    path: str
    line: int
    word: str
    instead: str

    def __str__(self):
        """As compilers print it."""
        return f"{self.path}:{self.line}: {self.word}: {self.instead}"


def pattern(words):
    """Pattern of words that stand alone or between underscores, and the advice for each."""
    bound = [rf"(?<![^\W_])(?:{word})(?![^\W_])" for word in words]
    return [(re.compile(word, re.IGNORECASE), advice) for word, advice in zip(bound, words.values(), strict=True)]


EVERYWHERE, IN_NAMES = pattern(WORDS), pattern(NAMES)
# Any of them, so that most lines are searched once.
ANY = re.compile("|".join(word.pattern for word, _ in EVERYWHERE + IN_NAMES), re.IGNORECASE)
STAYS = re.compile("|".join(f"(?:{name})" for name in PUBLIC))
STRING = re.compile(r"'[^']*'|\"[^\"]*\"")


def code_of(line, suffix):
    """The names of a line of code, without strings and comment."""
    mark = "#" if suffix == ".py" else "!"
    return STRING.sub(" ", line).split(mark)[0]


def check_text(text, path):
    """Breaches of a text."""
    breaches, suffix, inside = [], Path(path).suffix, False
    for number, line in enumerate(text.splitlines(), 1):
        if suffix == ".py" and line.count('"""') == 1:
            inside = not inside
        if not ANY.search(line.replace("_", " ")) and not ANY.search(line):
            continue
        line = STAYS.sub(" ", line)
        for word, instead in EVERYWHERE:
            breaches += [Breach(path, number, found[0], instead) for found in word.finditer(line.replace("_", " "))]
        if suffix in CODE and not inside and '"""' not in line:
            for word, instead in IN_NAMES:
                breaches += [Breach(path, number, found[0], instead) for found in word.finditer(code_of(line, suffix))]
    return breaches


def texts(root):
    """Paths of the texts of a project, from its root."""
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            name = path.relative_to(root).as_posix()
            if path.suffix in SUFFIXES and path.is_file() and not SKIPPED.search(name):
                yield name


def check_project(root):
    """Breaches of all texts."""
    found = []
    for name in texts(root):
        found += check_text((root / name).read_text(encoding="utf-8"), name)
    return found


def read_list(path):
    """Breaches that files may still have."""
    rows = [line.split(maxsplit=1) for line in path.read_text(encoding="utf-8").splitlines() if line[:1] != "#"]
    return {name: int(number) for number, name in rows}


def write_list(path, allowed, counts):
    """Lowers the numbers of a list; it gains neither breaches nor files."""
    head = [line for line in path.read_text(encoding="utf-8").splitlines() if line[:1] == "#"]
    rows = [f"{min(number, counts[name])} {name}" for name, number in sorted(allowed.items()) if counts[name]]
    path.write_text("\n".join(head + rows) + "\n", encoding="utf-8")


def main(arguments):
    """Prints breaches."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("root", type=Path)
    parser.add_argument("--list", type=Path, help="breaches that files may still have")
    parser.add_argument("--write", action="store_true", help="lower the numbers of the list")
    parser.add_argument("--all", action="store_true", help="print what the list allows, too")
    given = parser.parse_args(arguments)
    breaches = check_project(given.root)
    counts = Counter(breach.path for breach in breaches)
    allowed = read_list(given.list) if given.list else {}
    if given.write:
        write_list(given.list, allowed, counts)
    shown = [breach for breach in breaches if given.all or counts[breach.path] > allowed.get(breach.path, 0)]
    for breach in shown:
        print(breach)
    left = sum(counts[name] for name in allowed)
    print(f"{len(shown)} breaches shown; files of the list have {left}, they may have {sum(allowed.values())}")
    return 1 if any(counts[name] > allowed.get(name, 0) for name in counts) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
