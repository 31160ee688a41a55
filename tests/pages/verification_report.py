#!/usr/bin/env python3
"""Writes doc/verification.md from the tests: the expectations of tests/regress/expect and the scripts that
tests/regress/CMakeLists.txt registers, with its loops. Usage: verification_report.py [ROOT] [--check]

--check writes nothing and ends with code 1 if the page is not up to date."""

import ast
import re
import sys
import tomllib
from pathlib import Path

COLUMNS = """| test | case | reference | figure | expected | tolerance |
|---|---|---|---|---|---|
"""
HEAD = """# Verification

Runs are compared with references: {cases} cases with {figures} figures, and {scripts} tests by scripts. This page is
written from the tests by `tests/pages/verification_report.py`; `ctest -R docs_verification` fails if it is not up to
date. A row is met when its test passes. The command of a test is `ctest --test-dir build -R NAME`, that of all
`ctest --test-dir build -L regress`.

A tolerance in % is relative; the others are in the unit of the figure.

## Figures
Closed forms, published results, other programs, energy balances, and the same run in another way.

""" + COLUMNS
REGRESSION = """
## Figures of earlier runs
These rows show that a figure has not changed. They are no evidence that it is right.

""" + COLUMNS
SCRIPTS = """
## Scripts
Comparisons that need more than one figure of one run: closed forms of specimens, symmetries, ranks, restarts.

| test | label | reference | case and tolerance |
|---|---|---|---|
"""
EARLIER = "Figures of earlier runs"
# Units of the page by the ends of figures' names, with their number in the SI unit; figures of others are numbers.
UNITS = {end: unit for ends, unit in (
    ("rms_force", ("", 1)),  # over the peak
    ("force", ("N", 1)),
    ("deflection penetration displacement", ("mm", 1e3)),
    ("time release begin", ("ms", 1e3)),
    ("velocity", ("m/s", 1)),
    ("area", ("mm²", 1e6)),
    ("energy_strain energy_delamination energy_ply_damage energy_algorithmic energy_fibre_tension "
     "energy_contact", ("J", 1)),
) for end in ends.split()}  # fmt: skip
KNOWN = ("quantity", "column", "value", "relative", "absolute", "against", "at")


def first_sentence(text):
    """The first sentence of a comment or docstring."""
    text = re.split(r"(?<=[.!?;])\s", " ".join(text.split()), maxsplit=1)[0]
    return text.rstrip(".:;").replace("|", "\\|")


def reference_and_case(text):
    """The first sentence of a comment or docstring, such as `Closed form: a cantilever`, at its colon."""
    reference, _, case = first_sentence(text).partition(": ")
    return reference, case


def comment(text):
    """The comment at the head of a file."""
    lines = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("# "))
    return " ".join(lines)


def figure_of(row):
    """The quantity of a row."""
    name = row["quantity"]
    parts = [f"`{row['column']}`"] if "column" in row else []
    parts += [f"{key} {value:g}" for key, value in row.items() if key not in KNOWN and isinstance(value, float)]
    return f"{name} of {', '.join(parts)}" if parts else name


def unit_of(row):
    """The unit of a row's figure, and its number in the SI unit."""
    name = re.sub(r"_\d+$", "", row.get("column", row["quantity"]))
    return next((unit for end, unit in UNITS.items() if name == end or name.endswith(f"_{end}")), ("", 1))


def in_unit(number, row):
    """A number in the unit of a row's figure."""
    unit, factor = unit_of(row)
    return f"{number * factor:.6g} {unit}".rstrip()


def tolerance_of(row):
    """The tolerance of a row."""
    if "relative" in row:
        return f"{100 * row['relative']:.3g} %"
    return in_unit(row["absolute"], row) if "absolute" in row else "bound"


def expected_of(row):
    """The value of a row, or its bounds."""
    if "value" in row:
        return in_unit(row["value"], row)
    return "see file"


def rows_of(path):
    """The rows of a file of expectations."""
    text = path.read_text(encoding="utf-8")
    data = tomllib.loads(text)
    cases = data.get("variant") or [{"name": ""}]
    common = [(row, "all" if data.get("variant") else "") for row in data.get("expect", [])]
    own = [(row, case.get("name", "")) for case in cases for row in case.get("expect", [])]
    reference, what = reference_and_case(comment(text))
    for row, case in common + own:
        figure = (figure_of(row), expected_of(row), tolerance_of(row))
        yield (f"`verify_{path.stem}`", joined(what, case), reference, *figure)


def unrolled(listed):
    """The text of a CMakeLists.txt with its loops expanded and its variables of one or more words replaced."""

    def written_out(loop):
        return "".join(loop[3].replace(f"${{{loop[1]}}}", word) for word in loop[2].split())

    text = re.sub(r"foreach\((\w+) ([^)]*)\)(.*?)endforeach\(\)", written_out, listed, flags=re.S)
    for name, value in re.findall(r"^set\((\w+) ([^)\n]*)\)$", text, re.M):
        text = text.replace(f"${{{name}}}", value)
    return text


def entry_of(printed, trial):
    """The entry of a trial in a docstring: the line that begins with its name, and the indented ones after it."""
    found = re.search(rf"^{re.escape(trial)}:? +(.*(?:\n +.*)*)", printed, re.M) if trial else None
    return first_sentence(found[1]) if found else ""


def joined(*parts):
    """Those that are not empty, separated by semicolons."""
    return "; ".join(part for part in parts if part)


def scripts_of(folder):
    """Registered scripts with the first sentence of their docstrings and the entries of their trials."""
    listed = unrolled((folder / "CMakeLists.txt").read_text(encoding="utf-8"))
    for test, label, script, trial in re.findall(r"implam_add_script\((\S+) ([\w-]+) ([\w./]+\.py)\s+(\S+)", listed):
        printed = ast.get_docstring(ast.parse((folder / script).read_text(encoding="utf-8"))) or ""
        reference, case = reference_and_case(printed)
        yield f"`{test}`", label, reference, joined(case, entry_of(printed, trial))


def table(rows):
    """Rows of a table in Markdown."""
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def page_of(root):
    """The text of the page."""
    folder = root / "tests" / "regress"
    files = sorted((folder / "expect").glob("*.toml"))
    rows = [row for path in files for row in rows_of(path)]
    scripts = list(scripts_of(folder))
    earlier = [row for row in rows if EARLIER in row]
    text = HEAD.format(cases=len(files), figures=len(rows), scripts=len(scripts))
    text += table([row for row in rows if row not in earlier]) + REGRESSION + table(earlier)
    return text + SCRIPTS + table(scripts)


def main(arguments):
    """Write or check the page; return the exit code."""
    folders = [word for word in arguments if not word.startswith("--")]
    root = Path(folders[0] if folders else Path(__file__).resolve().parents[2])
    page, text = root / "doc" / "verification.md", page_of(root)
    empty = [line for line in text.splitlines() if "|  |" in line]
    if empty:
        print("A first sentence, `Reference: case`, lacks one of both:", *empty, sep="\n")
        return 1
    if "--check" not in arguments:
        page.write_text(text, encoding="utf-8")
    elif not page.exists() or page.read_text(encoding="utf-8") != text:
        print(f"{page} is not up to date; run tests/pages/verification_report.py")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
