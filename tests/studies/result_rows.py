"""Rows of results in a committed table, to which studies that can be stopped and continued add one after another."""

import csv


def append_row(path, names, row):
    """Add a row, a dictionary, to the table of a path; a new table has the names of the columns."""
    is_new = not path.exists()
    with path.open("a", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, names, lineterminator="\n")
        if is_new:
            writer.writeheader()
        writer.writerow(row)
