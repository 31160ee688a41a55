#!/usr/bin/env python3
"""Compares the manual's page of every group, and those of the results, with the program.

usage: check_manual.py IMPLAM [--write]

The table of a page must be what `implam explain --markdown GROUP` prints, and every ```fortran block of a page must
be a deck that `implam check` accepts, completed by the groups that it lacks from tests/decks/good/impact.nml.
The same holds for the tables of `history` and `fields`, and the page of the energy ledger must define each of its
entries. The page of the summary must name each of its members and show the printed lines, the page of the command
line each exit code. No table is on two pages. The list of results in the Python package is the program's, too. With
--write the tables and the list are replaced.
"""
import json
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
REPORT = os.path.join(HERE, "..", "..", "src", "report")
# Members written by the sources; those of a verification are in their own file.
MEMBER = re.compile(r"json%(?:put|put_null|open_object|open_list)\('(\w+)'")
MANUAL = os.path.join(HERE, "..", "..", "doc", "manual")
TABLE = re.compile(r"^\| (?:key|name) \|.*?(?=\n\n|\Z)", re.DOTALL | re.MULTILINE)
RESULTS = ("history", "fields", "summary")
LIST = os.path.join(HERE, "..", "..", "postproc", "implam_post", "io", "results.csv")
# Columns of the history in the ledger.
ENTRY = re.compile(r"^\| `(energy_\w+|work_external)`", re.MULTILINE)
EXAMPLE = re.compile(r"^```fortran\n(.*?)^```", re.DOTALL | re.MULTILINE)
# Values of materials, and their sources.
MATERIALS = re.compile(r"^\| key \|.*?\n\n(?:- .*\n)+", re.DOTALL | re.MULTILINE)
# Measured errors of long cells.
ERRORS = re.compile(r"^\| cells, at least \|.*?(?=\n\n|\Z)", re.DOTALL | re.MULTILINE)
GROUP = re.compile(r"^&(\w+).*?/[ ]*$", re.DOTALL | re.MULTILINE)
# Groups that replace these of the completing deck in a static example.
TRANSIENT = ("impactor", "indentation", "time")
# The same for an example that starts from the final state of another run.
STRIKING = ("impactor", "indentation")


def ask(program, *words):
    """Exit code and output of the program."""
    done = subprocess.run([program, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60, text=True)
    return done.returncode, done.stdout


def completed(example):
    """An example completed by missing groups."""
    with open(os.path.join(HERE, "good", "impact.nml"), encoding="utf-8") as deck:
        rest = deck.read()
    own = [match.group(1) for match in GROUP.finditer(example)]
    for match in GROUP.finditer(rest):
        name = match.group(1)
        if name not in own and not (("static" in own and name in TRANSIENT) or
                                    ("initial_state" in own and name in STRIKING)):
            example += match.group(0) + "\n"
    if "static" in own and "pressure" not in own:
        example += "&pressure value=1 /\n"
    return example


def check_table(program, topic, wrong):
    """Compare the table of a page with the program's and return the page; add differences to `wrong`."""
    path = os.path.join(MANUAL, topic + ".md")
    if not os.path.exists(path):
        wrong.append(f"{path}: there is no such page")
        return None
    with open(path, encoding="utf-8") as page:
        text = page.read()
    table = ask(program, "explain", "--markdown", topic)[1].strip()
    if "--write" in sys.argv:
        text = TABLE.sub(table.replace("\\", r"\\"), text)
        with open(path, "w", encoding="utf-8") as page:
            page.write(text)
    written = TABLE.search(text)
    if not written or written.group(0).strip() != table:
        wrong.append(f"{path}: the table is not the program's; run check_manual.py IMPLAM --write")
    return text


def check_examples(program, topic, text, wrong):
    """Add examples of a page that are not valid decks to `wrong`."""
    path = os.path.join(MANUAL, topic + ".md")
    examples = EXAMPLE.findall(text)
    if not examples:
        wrong.append(f"{path}: there is no example")
    for example in examples:
        with tempfile.NamedTemporaryFile("w", suffix=".nml", encoding="utf-8") as deck:
            deck.write(completed(example))
            deck.flush()
            code, output = ask(program, "check", deck.name)
        if code != 0 or ": warning: " in output:
            wrong.append(f"{path}: the example does not pass: {output}")


def check_materials(program, wrong):
    """Add a message to `wrong` if the page of published materials has other values or sources than the program."""
    path = os.path.join(MANUAL, "materials.md")
    with open(path, encoding="utf-8") as page:
        text = page.read()
    table = ask(program, "explain", "--markdown", "materials")[1].strip()
    if "--write" in sys.argv:
        text = MATERIALS.sub(lambda _: table + "\n", text)
        with open(path, "w", encoding="utf-8") as page:
            page.write(text)
    if table not in text:
        wrong.append(f"{path}: the tables are not the program's; run check_manual.py IMPLAM --write")
    check_examples(program, "materials", text, wrong)


def check_growth_errors(program, wrong):
    """Add a message to `wrong` if the page on cells has other measured errors than the program."""
    path = os.path.join(MANUAL, "which_cells.md")
    with open(path, encoding="utf-8") as page:
        text = page.read()
    table = ask(program, "explain", "--markdown", "growth_errors")[1].strip()
    if "--write" in sys.argv:
        text = ERRORS.sub(lambda _: table, text)
        with open(path, "w", encoding="utf-8") as page:
            page.write(text)
    if not table.startswith("| cells") or table not in text:
        wrong.append(f"{path}: the table of errors is not the program's; run check_manual.py IMPLAM --write")


def check_ledger(program, wrong):
    """Add entries of the energy ledger that its page does not define to `wrong`."""
    path = os.path.join(MANUAL, "energy_ledger.md")
    with open(path, encoding="utf-8") as page:
        defined = re.findall(r"^\*\*(\w+)\*\*", page.read(), re.MULTILINE)
    entries = ENTRY.findall(ask(program, "explain", "--markdown", "history")[1])
    if not entries or sorted(entries) != sorted(defined):
        wrong.append(f"{path}: it defines {sorted(defined)}, and the history has {sorted(entries)}")


def check_list(program, wrong):
    """Add a message to `wrong` if the list of results in the Python package is not the program's."""
    lines = ["table,name,type,unit,label"]
    for topic in ("history", "summary"):
        heading, _, *rows = [[cell.strip() for cell in line.strip("| ").split(" | ")] for line in
                             ask(program, "explain", "--markdown", topic)[1].strip().splitlines()]
        for row in (dict(zip(heading, cells, strict=True)) for cells in rows):
            lines.append(",".join([topic, row["name"].strip("`"), row["type"], row["unit"], row.get("label", "")]))
    text = "\n".join([*lines, ""])
    if "--write" in sys.argv:
        with open(LIST, "w", encoding="utf-8") as file:
            file.write(text)
    with open(LIST, encoding="utf-8") as file:
        if file.read() != text:
            wrong.append(f"{LIST}: the list is not the program's; run check_manual.py IMPLAM --write")


def members_of(value):
    """Names of the members of a summary at any level."""
    if isinstance(value, dict):
        return {*value, *(name for inner in value.values() for name in members_of(inner))}
    return {name for inner in value for name in members_of(inner)} if isinstance(value, list) else set()


def written_members():
    """Names of the members that the sources write into a summary, since no single run has all of them."""
    found = set()
    for name in sorted(os.listdir(REPORT)):
        if name.endswith(".f90"):
            with open(os.path.join(REPORT, name), encoding="utf-8") as source:
                found |= set(MEMBER.findall(source.read()))
    return found


def check_summary(program, wrong):
    """Add members of a summary that its page does not name, and lines that a run does not print, to `wrong`."""
    path = os.path.join(MANUAL, "summary.md")
    with open(path, encoding="utf-8") as page:
        text = page.read()
    deck = os.path.join(HERE, "..", "..", "input", "small", "damage.nml")
    with tempfile.TemporaryDirectory() as folder:
        printed = ask(program, deck, "--output", folder)[1]
        with open(os.path.join(folder, "damage_summary.json"), encoding="utf-8") as file:
            members = members_of(json.load(file)) | written_members()
    named = set(re.findall(r"`(\w+)`", text)) | {"code", "kind", "message", "at", "energy_..."}
    ledger = {name for name in members if name.startswith("energy_")}
    missing = sorted(members - ledger - named)
    if missing:
        wrong.append(f"{path}: it does not name {', '.join(missing)}")
    # Round-off differs between machines.
    shown = re.search(r"^```text\n(.*?)^```", text, re.DOTALL | re.MULTILINE)[1]
    for line in shown.splitlines():
        if "energy error" not in line and line.rstrip() not in [one.rstrip() for one in printed.splitlines()]:
            wrong.append(f"{path}: the program does not print: {line}")


def check_exit_codes(program, wrong):
    """Add exit codes that the page of the command line lacks or describes differently to `wrong`."""
    path = os.path.join(MANUAL, "command_line.md")
    with open(path, encoding="utf-8") as page:
        listed = re.findall(r"^\| (\d+) \| [^|]+ \|$", page.read(), re.MULTILINE)
    codes = re.findall(r"^ +(\d+) +\S", ask(program, "help")[1].partition("xit codes")[2], re.MULTILINE)
    if not codes or codes != listed:
        wrong.append(f"{path}: it has the exit codes {', '.join(listed)}, and the program {', '.join(codes)}")


def check_once(topics, wrong):
    """Add tables of groups or results on other pages than their own to `wrong`."""
    doc = os.path.join(HERE, "..", "..", "doc")
    for folder, _, names in os.walk(doc):
        for name in names:
            path = os.path.join(folder, name)
            if not name.endswith(".md") or (folder.endswith("manual") and name[:-3] in topics):
                continue
            with open(path, encoding="utf-8") as page:
                if re.search(r"^\| (?:key \| type|name \| (?:type|on)) \|", page.read(), re.MULTILINE):
                    wrong.append(f"{path}: a table of keys, columns or fields is on the page of its group only")


def main():
    program = os.path.abspath(sys.argv[1])
    overview = ask(program, "explain")[1]
    groups = re.findall(r"^  &(\w+)", overview, re.MULTILINE)
    wrong = [] if groups else [f"`implam explain` names no groups: {overview}"]
    for topic in (*groups, *RESULTS):
        text = check_table(program, topic, wrong)
        if text is not None and topic not in RESULTS:
            check_examples(program, topic, text, wrong)
    check_ledger(program, wrong)
    check_list(program, wrong)
    check_summary(program, wrong)
    check_exit_codes(program, wrong)
    check_once((*groups, *RESULTS), wrong)
    check_growth_errors(program, wrong)
    check_materials(program, wrong)
    print("\n".join(wrong) or f"{len(groups) + len(RESULTS)} pages agree with the program, so does that of the ledger")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
