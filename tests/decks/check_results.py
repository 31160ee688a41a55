#!/usr/bin/env python3
"""Compares the tables of results, `implam explain history` and `implam explain fields`, with the public interface and
with the deck.

usage: check_results.py IMPLAM
"""
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
GOOD = os.path.join(HERE, "good", "impact.nml")
# The public interface: these columns come first, in this order.
FIRST = [
    "time", "step", "force", "indentation", "impactor_displacement", "impactor_velocity", "deflection",
    "delaminated_area", "energy_impactor", "energy_kinetic", "energy_strain", "energy_indentation",
    "energy_delamination", "energy_ply_damage", "energy_contact", "energy_algorithmic", "energy_error"]
# Words for dimensions in the deck's units, and those that only results have.
UNIT_WORDS = {"time", "length", "area", "force", "pressure", "energy", "mass", "volume", "degree"}
ONLY_IN_RESULTS = {"radian"}


def ask(program, *words):
    """Exit code and output of the program."""
    done = subprocess.run([program, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60, text=True)
    return done.returncode, done.stdout


def table(program, topic):
    """Rows of a table, each a dictionary by the heading."""
    lines = [[cell.strip() for cell in line.strip("| \n").split(" | ")]
             for line in ask(program, "explain", topic, "--markdown")[1].splitlines()]
    return [dict(zip(lines[0], cells, strict=False)) for cells in lines[2:]]


def words_of(unit):
    """Dimensions in a unit."""
    return set(re.findall(r"[a-z]+", unit))


def faults_of_rows(program, topic):
    """Faults of the rows of a table."""
    rows = table(program, topic)
    names = [row["name"] for row in rows]
    if len(rows) < 20 or len(set(names)) < len(names):
        yield f"{topic}: {len(rows)} rows, {len(set(names))} names"
    deck_units = set().union(*(words_of(row["unit"]) for group in groups(program) for row in table(program, group)))
    if not UNIT_WORDS.issubset(deck_units):
        yield f"the deck has no unit with {sorted(UNIT_WORDS - deck_units)}"
    for row in rows:
        unknown = words_of(row["unit"]) - UNIT_WORDS - ONLY_IN_RESULTS
        if unknown or not row["unit"]:
            yield f"{topic}: {row['name']} has the unit {row['unit']}, which is not made of the deck's"
        # A row longer than its text is cut off.
        if not re.fullmatch(r"`\w+`", row["name"]) or not row.get("meaning", "").endswith("."):
            yield f"{topic}: the row of {row['name']} is cut off: {row}"


def groups(program):
    """Names of the deck's groups."""
    return re.findall(r"^  &(\w+)", ask(program, "explain")[1], re.MULTILINE)


def faults_of_first_columns(program):
    """Whether the first columns are those of the public interface."""
    names = [row["name"].strip("`") for row in table(program, "history")]
    if names[:len(FIRST)] != FIRST:
        yield f"the first columns of the history are {names[:len(FIRST)]}"


def idle_without(program, choice):
    """Groups without which a choice of fields has no effect, as `implam check` reports for a deck with neither."""
    with open(GOOD, encoding="utf-8") as deck:
        text = deck.read()
    for group in ("delamination", "ply_damage", "output"):
        text = re.sub(rf"^&{group}\b.*?/[ ]*$", "", text, flags=re.DOTALL | re.MULTILINE)
    with tempfile.NamedTemporaryFile("w", suffix=".nml", encoding="utf-8") as deck:
        deck.write(f"{text}\n&output fields='{choice}' /\n")
        deck.flush()
        code, output = ask(program, "check", deck.name)
    if code != 0:
        return {f"the deck fails: {output}"}
    return set(re.findall(rf"'{choice}' has no effect without (&\w+)", output))


def faults_of_choices(program):
    """Whether &output offers the choices of the table with the groups that each requires."""
    needs = {}
    for row in table(program, "fields"):
        if row["choice"] != "-":
            needs.setdefault(row["choice"], set()).update({row["needs"]} - {"-"})
    fields = [row for row in table(program, "output") if row["key"] == "`fields`"]
    offered = re.findall(r"`'(\w+)'`", fields[0]["allowed"])
    if sorted(offered) != sorted(needs):
        yield f"&output offers the fields {sorted(offered)}, the table has {sorted(needs)}"
    for choice in sorted(needs):
        if idle_without(program, choice) != needs[choice]:
            yield f"{choice} needs {needs[choice]} by the table, but {idle_without(program, choice)} by implam check"


def main():
    program = os.path.abspath(sys.argv[1])
    wrong = [*faults_of_rows(program, "history"), *faults_of_rows(program, "fields"),
             *faults_of_first_columns(program), *faults_of_choices(program)]
    print("\n".join(wrong) or "the tables of results agree with the deck and with the public interface")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
