#!/usr/bin/env python3
"""Checks the pages for readers: README.md, CHANGELOG.md and all Markdown under doc/ and tests/. Usage:
check_pages.py [ROOT] [--write] [--sentences]

- Relative links lead to files, and to headings, that exist.
- Files named in quotes exist: with their path from the root or from src/, or by a bare name somewhere in the project.
- A name quoted with its file, as in `wp` in `base/kinds.f90` or `wp` (`base/kinds.f90`), is in that file.
- A block of code after <!-- from PATH --> is in that file, line by line; "..." marks lines left out.
- doc/index.md lists every page of doc/, every key, column and field of the manual and every term of the glossary.
- Pages describe the present state: words of a diary ("as it was then") are refused outside CHANGELOG.md and doc/news/.
- No sentence of the pages under doc/ and of README.md has more than 40 words.
- tests/pages/reading_test.md has five questions for each page under doc/ but the news, numbered 1 to 5.
- The page of a group of the deck lists its warnings and limits.
- Displayed equations of a page of doc/theory/ are numbered without a gap, by one letter and a number; equations
  referred to exist.

--write updates the lists of doc/index.md. --sentences counts the sentences of more than 30 words and prints them.
Prints one line a breach, as file:line: sentence, and ends with code 1 if there is any.
"""

import re
import sys
from pathlib import Path

# Words of a sentence: usual and largest number.
LONGEST, LIMIT = 30, 40
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"`([^`\n]+)`")
HEADING = re.compile(r"^(#+) +(.*?) *#*$")
TAG = re.compile(r"\\tag\{([A-Z])(\d+)\}")
DISPLAYED = re.compile(r"^\$\$\n.*?^\$\$$", re.MULTILINE | re.DOTALL)
REFERRED = re.compile(r"\(([A-Z]\d+)\)")
FORMULA = re.compile(r"\$[^$\n]+\$")
FENCE = re.compile(r"^ *```")
ORIGIN = re.compile(r"^<!-- from (\S+) -->$")
# A file in a folder of the project, a source with its folder in src/, or the bare name of one.
PATHS = re.compile(r"^(?:src|tests|input|doc|cmake|postproc|\.ci)/[\w./*-]*$")
SOURCES = re.compile(r"^(?:[a-z_]+/)?[\w-]+\.(?:f90|pf|c|py)$")
# A name and the file that contains it.
MEMBER = re.compile(r"`(\w+)`\s+(?:in\s+|of\s+|\()`((?:\w+/)+[\w-]+\.(?:f90|pf|py))`")
# Names with placeholders: <name>, GROUP_deck.f90.
PLACEHOLDER = re.compile(r"<|[A-Z]{2}")
# Files that a patch of an example creates.
PATCHED = re.compile(r"^\+\+\+ \w/(\S+)", re.MULTILINE)
DIARY = re.compile(
    r"\b(?:as it was then|was then|as it was when|before the deck had|before (?:that|this) change|formerly|used to be|"
    r"up to now|until now|has now been)\b",
    re.IGNORECASE,
)
QUESTIONS = re.compile(r"^\*\*\[[^\]]+\]\(([^)]+)\)\*\*\n\n((?:\d+\..*\n)+)", re.MULTILINE)
BEGIN, END = "<!-- lists: written by tests/lint/check_pages.py --write -->", "<!-- end of the lists -->"
ROW = re.compile(r"^\| `(\w+)` \|", re.MULTILINE)
TERM = re.compile(r"^\*\*(.+?)\*\*(.*?)(?=^\*\*|^#|\Z)", re.MULTILINE | re.DOTALL)
# Abbreviations with a full stop that do not end a sentence.
SHORT = re.compile(r"\b(?:et al|Eqs?|Sec|Fig|No|e\.g|i\.e|vs|cf|(?<!\d )J|Proc|Comput|Mech|Appl|Int|Numer|Meth|Eng)\.")


def pages(root):
    """The pages of the project, without news."""
    found = [root / "README.md", root / "CHANGELOG.md"]
    for folder in ("doc", "tests"):
        found += sorted((root / folder).rglob("*.md"))
    return [page for page in found if page.exists()]


def pages_of(doc):
    """The pages under doc/, without news."""
    return [page for page in sorted(doc.rglob("*.md")) if "news" not in page.relative_to(doc).parts]


def slug(heading):
    """The anchor of a heading."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.lower())
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def anchors(page):
    """The anchors of a page."""
    return {slug(match.group(2)) for line, _ in prose(page) if (match := HEADING.match(line))}


def prose(page):
    """The lines of a page outside blocks of code, with their numbers."""
    lines, inside, displayed = [], False, False
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        if FENCE.match(line):
            inside = not inside
        elif line.strip().startswith("$$") and not inside:
            displayed = not displayed
            lines.append(("", number))
        elif displayed:
            lines.append(("", number))
        elif not inside:
            lines.append((line, number))
    return lines


def check_links(page):
    """Breaches of links."""
    for line, number in prose(page):
        for target in LINK.findall(CODE.sub("", line)):
            if re.match(r"[a-z]+:", target):
                continue
            name, _, anchor = target.partition("#")
            path = page.parent / name if name else page
            if not path.exists():
                yield f"{page}:{number}: the link to {target} leads nowhere"
            elif anchor and anchor not in anchors(path):
                yield f"{page}:{number}: {name or page.name} has no heading #{anchor}"


class Names:
    """The files of the project."""

    def __init__(self, root):
        """List them."""
        self.root = root
        self.bare = set()
        for folder in ("src", "tests", "postproc", "cmake"):
            self.bare |= {path.name for path in (root / folder).rglob("*") if ".venv" not in path.parts}
        patches = (root / "tests" / "examples").glob("*.patch")
        self.patched = {name for path in patches for name in PATCHED.findall(path.read_text(encoding="utf-8"))}

    def missing(self, word):
        """Whether a quoted word names a file that does not exist."""
        if PLACEHOLDER.search(word) or word in self.patched:
            return False
        if PATHS.match(word):
            return not (any(self.root.glob(word)) if "*" in word else (self.root / word).exists())
        if not SOURCES.match(word):
            return False
        if "/" in word:
            return not ((self.root / "src" / word).exists() or (self.root / word).exists())
        return "*" not in word and word not in self.bare


def check_names(page, names):
    """Breaches of quoted names of files."""
    for line, number in prose(page):
        for quoted in CODE.findall(line):
            for word in quoted.split():
                if names.missing(word.rstrip(",;:")):
                    yield f"{page}:{number}: there is no file {word}"


def check_members(page, root):
    """Breaches of quoted names that the quoted file lacks."""
    lines = prose(page)
    text = "\n".join(line for line, _ in lines)
    for found in MEMBER.finditer(text):
        name, file = found.groups()
        path = next((path for path in (root / file, root / "src" / file) if path.exists()), None)
        if path and not re.search(rf"\b{name}\b", path.read_text(encoding="utf-8")):
            yield f"{page}:{lines[text.count(chr(10), 0, found.start())][1]}: {file} has no {name}"


def check_quotes(page, root):
    """Breaches of code quoted from files."""
    lines = page.read_text(encoding="utf-8").splitlines()
    for number, line in enumerate(lines):
        origin = ORIGIN.match(line)
        if not origin:
            continue
        path = root / origin.group(1)
        if not path.exists():
            yield f"{page}:{number + 1}: there is no file {origin.group(1)} to quote"
            continue
        if number + 1 == len(lines) or not FENCE.match(lines[number + 1]):
            yield f"{page}:{number + 1}: no block of code follows"
            continue
        end = next((n for n in range(number + 2, len(lines)) if FENCE.match(lines[n])), len(lines))
        wrong = first_missing(lines[number + 2 : end], path.read_text(encoding="utf-8").splitlines())
        if wrong is not None:
            yield f"{page}:{number + 3 + wrong}: {origin.group(1)} has no such line here"


def first_missing(quote, lines):
    """The first line of a quote that the lines of a file lack, or None. Indentation is ignored."""
    lines = [line.strip() for line in lines]
    best = 0
    for start in range(len(lines)):
        place, gap = start, False
        for count, wanted in enumerate(line.strip() for line in quote):
            if wanted == "...":
                gap = True
                continue
            if gap and wanted in lines[place:]:
                place = lines.index(wanted, place)
            if place >= len(lines) or lines[place] != wanted:
                best = max(best, count)
                break
            place, gap = place + 1, False
        else:
            return None
    return best


def check_diary(page, root):
    """Breaches of pages that describe earlier states."""
    if page == root / "CHANGELOG.md" or page.parent == root / "doc" / "news":
        return
    for line, number in prose(page):
        found = DIARY.search(line)
        if found:
            yield f'{page}:{number}: "{found.group()}" describes an earlier state; describe the present one'


def title(page):
    """The first heading of a page."""
    return next((match.group(2) for line, _ in prose(page) if (match := HEADING.match(line))), page.stem)


def linked(items):
    """Links in one paragraph."""
    return wrapped(", ".join(f"[{text}]({target})" for text, target in items) + ".")


def wrapped(text, width=118):
    """A paragraph, or the item of a list, in lines; links are not divided."""
    margin = "  " if text.startswith("- ") else ""
    lines = [""]
    for word in re.split(r" (?![^\[]*\]\()", text):
        if lines[-1].strip() and len(lines[-1]) + 1 + len(word) > width:
            lines.append(margin)
        lines[-1] += (" " if lines[-1].strip() else "") + word
    return "\n".join(lines)


def listed_rows(page, heading, label):
    """The rows of a page's table as one item of a list, if it has a table with this first heading."""
    table = re.search(rf"^\| {heading} \|.*?(?=\n\n|\Z)", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    rows = ROW.findall(table.group()) if table else []
    target = f"{page.parent.name}/{page.name}"
    return [wrapped(f"- [{label}]({target}): " + ", ".join(f"`{row}`" for row in rows) + ".")] if rows else []


def index_lists(doc):
    """The lists of the index: pages, groups with their keys, columns and fields, terms."""
    listed = [page for page in pages_of(doc) if page.name != "index.md"]
    parts = ["## Pages", ""]
    for page in sorted(listed, key=lambda page: (page.parent, page.name)):
        parts.append(f"- [{title(page)}]({page.relative_to(doc).as_posix()})")
    parts += ["", "## Groups and keys of the deck", ""]
    for page in sorted((doc / "manual").glob("*.md")):
        parts += listed_rows(page, "key", f"&{page.stem}")
    parts += ["", "## Columns and fields of the results", ""]
    for page in sorted((doc / "manual").glob("*.md")):
        parts += listed_rows(page, "name", page.stem)
    parts += ["", "## Terms", ""]
    glossary = doc / "glossary.md"
    if glossary.exists():
        terms = []
        for term, text in TERM.findall(glossary.read_text(encoding="utf-8")):
            target = next((link for link in LINK.findall(text) if not re.match(r"[a-z]+:", link)), "glossary.md")
            terms.append((term.rstrip(".,:"), target))
        parts.append(linked(sorted(terms, key=lambda item: item[0].lower())))
    return "\n".join(parts) + "\n"


def check_index(root, write):
    """Breaches of the index, whose lists are updated if requested."""
    index = root / "doc" / "index.md"
    if not index.exists():
        yield f"{index}:1: there is no index"
        return
    text = index.read_text(encoding="utf-8")
    if text.count(BEGIN) != 1 or text.count(END) != 1:
        yield f"{index}:1: the lists have lost the comments around them"
        return
    before, rest = text.split(BEGIN)
    whole = f"{before}{BEGIN}\n\n{index_lists(root / 'doc')}\n{END}{rest.split(END)[1]}"
    if write:
        index.write_text(whole, encoding="utf-8")
    elif whole != text:
        yield f"{index}:1: the lists are not up to date; run tests/lint/check_pages.py --write"


def sentences(page):
    """The sentences of a page, with the numbers of the lines on which their paragraphs begin."""
    for text, number in paragraphs(page):
        text = LINK.sub("Link", FORMULA.sub("Formula", CODE.sub("Code", text)))
        for sentence in re.split(r"(?<=[.!?])[\")*]* +(?=[\"(*`A-Z0-9&])", SHORT.sub("short", text)):
            yield sentence, number


def paragraphs(page):
    """Paragraphs, items of lists and cells of tables, with the numbers of their first lines."""
    text, first, listed = "", 0, False
    for line, number in [*prose(page), ("", 0)]:
        listed = line == BEGIN or (listed and line != END)
        if listed:
            continue
        stripped = line.strip()
        # Equations and commands are indented, separate from the text around them.
        starts = re.match(r"(?:[-*] |\d+\. |>|\||#|$|<!--)", stripped) or (line.startswith("    ") and not text)
        if starts and text:
            yield text, first
            text = ""
        if stripped.startswith("|"):
            for cell in stripped.strip("|").split("|"):
                yield cell.strip(), number
        elif stripped and not stripped.startswith(("#", "<!--")) and (text or not line.startswith("    ")):
            first = first if text else number
            text += " " + re.sub(r"^(?:[-*>]+|\d+\.) +", "", stripped)


def long_sentences(page, limit=LONGEST):
    """The sentences of a page above the usual number of words."""
    for sentence, number in sentences(page):
        words = [word for word in sentence.split() if re.search(r"\w", word)]
        if len(words) > limit:
            yield number, len(words), sentence.strip()


def check_sentences(page, root):
    """Breaches of sentences above the largest number of words."""
    if page.is_relative_to(root / "doc") or page == root / "README.md":
        for number, words, text in long_sentences(page, LIMIT):
            yield f"{page}:{number}: a sentence of {words} words: {' '.join(text.split()[:8])} ..."


def check_equations(pages_of_theory):
    """Breaches of the numbers of equations."""
    known = set()
    for page in pages_of_theory:
        text = page.read_text(encoding="utf-8")
        tags = TAG.findall(text)
        known |= {letter + number for letter, number in tags}
        if len(tags) != len(DISPLAYED.findall(text)):
            yield f"{page}:1: displayed equations are without a number such as \\tag{{P1}}"
        expected = [(tags[0][0], str(number)) for number in range(1, len(tags) + 1)] if tags else []
        if tags != expected:
            yield f"{page}:1: the equations are not numbered from 1 without a gap, by one letter"
    for page in pages_of_theory:
        letters = {name[0] for name in known}
        for line, number in prose(page):
            for name in REFERRED.findall(line):
                if name[0] in letters and name not in known:
                    yield f"{page}:{number}: there is no equation ({name})"


def check_questions(root):
    """Pages without five questions in the reading test."""
    testing = root / "tests/pages/reading_test.md"
    if not testing.exists():
        return
    asked = {}
    for link, numbers in QUESTIONS.findall(testing.read_text(encoding="utf-8")):
        asked[link.removeprefix("../../doc/")] = re.findall(r"^(\d+)\.", numbers, re.MULTILINE)
    for page in pages_of(root / "doc"):
        name = page.relative_to(root / "doc").as_posix()
        if asked.get(name) != list("12345"):
            yield f"tests/pages/reading_test.md:1: {name} has no five questions"


def check_groups(root):
    """Pages of groups without their warnings or limits."""
    for page in sorted((root / "doc" / "manual").glob("*.md")):
        text = page.read_text(encoding="utf-8")
        for heading in ("What is warned of", "Limits"):
            if text.startswith("# &") and f"\n## {heading}\n" not in text:
                yield f"{page}:1: a page of a group has a section \"{heading}\""


def main(arguments):
    """Check the pages; return the exit code."""
    folders = [argument for argument in arguments if not argument.startswith("--")]
    root = Path(folders[0] if folders else Path(__file__).resolve().parents[2])
    if "--sentences" in arguments:
        found = [(page, *sentence) for page in pages(root) for sentence in long_sentences(page)]
        for page, number, words, text in found:
            print(f"{page.relative_to(root)}:{number}: {words} words: {text}")
        total = sum(1 for page in pages(root) for _ in sentences(page))
        print(f"{len(found)} of {total} sentences have more than {LONGEST} words")
        return 0
    breaches = [*check_index(root, "--write" in arguments), *check_questions(root), *check_groups(root)]
    breaches += check_equations([root / "doc" / "theory.md", *sorted((root / "doc" / "theory").glob("*.md"))]
                                if (root / "doc" / "theory.md").exists() else [])
    names = Names(root)
    for page in pages(root):
        breaches += [*check_links(page), *check_names(page, names), *check_quotes(page, root), *check_diary(page, root)]
        breaches += [*check_members(page, root), *check_sentences(page, root)]
    print("\n".join(breaches) if breaches else f"{len(pages(root))} pages keep the rules")
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
