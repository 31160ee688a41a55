"""Names, types, kinds of units and labels of results: the program's list, `implam explain history` and `summary`.

results.csv is written and compared with the program by tests/decks/check_manual.py."""

import csv
import re
from pathlib import Path
from typing import NamedTuple

# Kinds of units in the list, and names of their dimensions in this package.
DIMENSIONS = {"-": "", "pressure": "stress", "length/time": "velocity"}


class Result(NamedTuple):
    """A column of the history or a figure of the summary; the label is that of the log, empty for columns."""

    type: str
    dimension: str
    label: str


def _read() -> dict[str, dict[str, Result]]:
    """Return the results by table and name, in the order of the program."""
    found: dict[str, dict[str, Result]] = {"history": {}, "summary": {}}
    with Path(__file__).with_name("results.csv").open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            found[row["table"]][row["name"]] = Result(row["type"], DIMENSIONS.get(row["unit"], row["unit"]),
                                                      row["label"])
    return found


TABLES = _read()


def dimension_of(name: str) -> str:
    """Return the dimension of a column of the history or a figure of the summary by its name; empty if it has none."""
    for table in TABLES.values():
        if found := table.get(name) or table.get(re.sub(r"\d+$", "N", name)):
            return found.dimension
    return ""
