#!/usr/bin/env python3
"""Finds invented and everyday words where the field has a term. Usage: check_words.py ROOT

Checks names (split at underscores), comments, strings and pages of all sources, tests, decks, pages and scripts.
WORDS are refused everywhere, NAMES only as parts of names in code. Public names of decks and results stay. Prints one
line a breach, as file:line: word: what to say instead, and ends with code 1 if there is any.
"""

import re
import sys
from dataclasses import dataclass
from pathlib import Path

FOLDERS = ("src", "tests", "cmake", "doc", "postproc", "input", "packaging", ".ci")
# Texts in the root folder.
FILES = ("README.md", "CHANGELOG.md", "CITATION.cff", "CMakeLists.txt", "CMakePresets.json", "setup.sh")
SUFFIXES = (".f90", ".pf", ".c", ".in", ".py", ".toml", ".nml", ".md", ".txt", ".cmake", ".j2", ".sh", ".def", ".ipynb",
            "")  # fmt: skip
CODE = (".f90", ".pf", ".py")
# Folders without text of the project, and this checker with its test.
SKIPPED = re.compile(r"(?:^|/)(?:build|__pycache__|\.venv|[^/]+\.egg-info)/|^tests/lint/(?:test_)?check_words\.")

# Words and phrases, as regular expressions, and their replacements.
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
    r"follow(?:s|ed|ing)? (?:(?:its|their|the) )?damage": "adaptive, grow with the damage",
    r"ask(?:s|ed)? for more": "require",
    r"bears?|borne": "carry, support; of a name: have",
    r"held against": "compared with, tested by",
    r"remembers?|remembered": "history variables; store, save",
    r"gives? way": "deflect, compliance",
    r"pressed together|drawn apart": "in compression, in tension",
    r"how near": "exposure, index, ratio, tolerance",
    r"counts? as none": "tolerance of what",
    r"followers?": "dependent points, next case",
    r"stands? beside|lawful|astray|tales?|meanwhile|in vain": "next to; allowed; wrong; note; until then; rejected",
    r"begins? anew": "start again, start from zero",
    r"book(?:s|ed)?": "record, add to the ledger",
    r"judge[sd]?": "evaluate, compute, compare",
    r"leaves? no trace": "has no effect, does not contribute",
    r"there from the start": "constant, full value, existing from the start",
    r"fall(?:s)? through": "not supported",
    r"(?:here stands?|should stand|stands? (?:where|without|outside))": "is, is expected, has",
    r"rounding spoils": "round-off dominates",
    r"first touch(?:es)?": "first contact",
    r"(?:ca|wo|is|are|was|were|has|have|had|does|do|did|need|would|should|could|must)n'{1,2}t": "not, written out",
    r"in the plane(?! (?:of|x|y|z)(?!\w))": "in-plane",
    r"go(?:es)? without stress": "stress-free strains",
    r"winding (?:paths?|ways?)": "non-proportional path",
    r"fl(?:y|ies) apart": "separate",
    r"blows?": "impact",
    r"dearer": "costlier",
    r"stopwatch(?:es)?": "timer",
    r"(?:s|seconds|minutes?) of (?:the|a) processor": "processor time",
    r"dealt(?: out)?": "distributed, cyclically",
    r"set anew|in the midst": "changed; within, during",
    r"to and fro|by turns": "cyclic; alternately",
    r"whatever the step": "for any step",
    r"proves? nothing": "the test is void",
    r"(?:not |un)accounted for": "energy error",
    r"sound (?:ply|plies|constants)": "undamaged",
    r"what is not there": "zero, absent, missing",
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
    r"deepest|steepest|likeliest": "max_ or most probable of what",
}
# Names of decks, results and libraries that are kept, as in the text.
PUBLIC = (
    r"least_squares|at_(?:least|most)|most_common|(?:os|pty)\.fork|broken_strip",
    r"[\"`\[]scenes?[\"`\]]",
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
        """In the format of compilers."""
        return f"{self.path}:{self.line}: {self.word}: {self.instead}"


def alone(words):
    """Pattern of any of some words, alone or between underscores."""
    return re.compile(rf"(?<![^\W_])(?:{'|'.join(words)})(?![^\W_])", re.IGNORECASE)


def pattern(words):
    """Pattern of each word, and the advice for it."""
    return [(alone([word]), advice) for word, advice in words.items()]


EVERYWHERE, IN_NAMES = pattern(WORDS), pattern(NAMES)
# Any of them, so that most lines are searched only once.
ANY = alone([*WORDS, *NAMES])
STAYS = re.compile("|".join(f"(?:{name})" for name in PUBLIC))
STRING = re.compile(r"'[^']*'|\"[^\"]*\"")


def code_of(line, suffix):
    """The names in a line of code, without strings and comment."""
    mark = "#" if suffix == ".py" else "!"
    return STRING.sub(" ", line).split(mark)[0]


def check_text(text, path):
    """Breaches of a text."""
    breaches, suffix, inside = [], Path(path).suffix, False
    for number, line in enumerate(text.splitlines(), 1):
        if suffix == ".py" and line.count('"""') == 1:
            inside = not inside
        if not ANY.search(line) and not ("_" in line and ANY.search(line.replace("_", " "))):
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
    yield from (name for name in FILES if (root / name).is_file())
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


def main(arguments):
    """Prints breaches."""
    if len(arguments) != 1:
        sys.exit("Usage: check_words.py ROOT")
    breaches = check_project(Path(arguments[0]))
    for breach in breaches:
        print(breach)
    print(f"{len(breaches)} breaches")
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
