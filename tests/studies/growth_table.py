#!/usr/bin/env python3
"""The tables of growth on long cells from the rows of growth: the errors that `implam check` and `implam explain
growth_errors` print, strips in doc/studies/interfaces.md, and impacts in doc/studies/accuracy.md.
Usage: growth_table.py [--check] (without: writes them)

Strips are counted with the number of cells in the process zone of their mode, of opening in mixed modes, since it is
the shorter one; impacts with the fewest cells in a process zone of shear, and compared with the finest mesh of their
deck."""

import csv
import math
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parents[1]/"src"/"delamination"/"growth_errors.f90"
# Least cells in a process zone: 1.7 and 2.5 are those of the warning and of resolved zones.
LEAST = (0, .25, .4, .5, 1, 1.7, 2.5)
STUDIES = HERE.parents[1]/"doc"/"studies"
NAMES = {"dcb": "double cantilever", "enf": "end-notched flexure", "slb": "single-leg bending, 43 % of shear"}
# Tables of the pages by the beginning of their heading.
PAGES = {"interfaces.md": "| strip | arms, mm |", "accuracy.md": "| deck | cells, mm |"}
TABLE = re.compile(r"(    ! Written by growth_table\.py\.\n)(.*?)(    ! End of the table\.\n)", re.DOTALL)


def rows_of(name, control="energy", folder=HERE/"growth"):
    """Return the rows of a table by energy or strength."""
    with open(folder/f"{name}.csv", encoding="utf-8") as table:
        return [row for row in csv.DictReader(table) if row["control"] == control]


def strip_errors(rows):
    """Return cells in the process zone and error of the mean load in % of each strip that has grown."""
    return [(float(row["cells_shear" if row["strip"] == "enf" else "cells_opening"]),
             (100*(float(row["load_by_displacement"]) - 1),)) for row in rows if row["load_by_displacement"]]


def impact_errors(rows):
    """Return cells in the process zone of shear and errors of area and peak in % of each impact but the finest ones."""
    found = []
    for deck in {row["deck"] for row in rows}:
        *others, finest = sorted((row for row in rows if row["deck"] == deck), key=lambda row: -float(row["cell"]))
        found += [(float(row["cells_shear"]), tuple(100*(float(row[name])/float(finest[name]) - 1)
                                                    for name in ("projected_area", "peak_force"))) for row in others]
    return found


def bounds(errors, which):
    """Return least and largest error in whole per cent."""
    values = [round(error[which]) for error in errors]
    return f"[{min(values, default=0)}, {max(values, default=0)}]"


def table_lines(strips, impacts):
    """Return the lines of the Fortran table: errors with at least a number of cells; none if no row has fewer than the
    next number."""
    lines = []
    for least, following in zip(LEAST, (*LEAST[1:], math.inf), strict=True):
        loads, others = ([errors for cells, errors in found if cells >= least]
                         if any(least <= cells < following for cells, _ in found) else []
                         for found in (strips, impacts))
        lines.append(f"    growth_errors_t({least:g}{'' if '.' in f'{least:g}' else '.0'}_wp, {len(loads)}, "
                     f"{bounds(loads, 0)}, {len(others)}, {bounds(others, 0)}, {bounds(others, 1)})")
    return ", &\n".join(lines) + "]\n"


def by_strength(rows, row, names, value):
    """Return the value of the same model by strengths, or a dash."""
    found = [value(other) for other in rows if all(other[name] == row[name] for name in names)]
    return found[0] if found else "-"


def load_of(row):
    """Return the mean load of a strip, or the load that it carries without growth."""
    return row["load_by_displacement"] or f"> {float(row['largest']):.1f}"


def strip_lines(rows, others):
    """Return the table of strips."""
    lines = ["| strip | arms, mm | cells, mm | cells in the process zone, opening and shear | cells grown | "
             "kinetic energy, % of the work | mean load by displacement | by area | least and largest load | "
             "mean load by strengths |", "|" + "---|"*10]
    for row in sorted(rows, key=lambda row: (list(NAMES).index(row["strip"]), float(row["arm"]), -float(row["cell"]))):
        strengths = by_strength(others, row, ("strip", "arm", "cell"), load_of)
        lines.append(f"| {NAMES[row['strip']]} | {row['arm']} | {row['cell']} | {row['cells_opening']}, "
                     f"{row['cells_shear']} | {row['cells_grown']} | {100*float(row['kinetic_share']):.1f} | "
                     f"{load_of(row)} | {row['load_by_area'] or '-'} | {row['least']}, {row['largest']} | "
                     f"{strengths} |")
    return lines


def impact_lines(rows, others):
    """Return the table of impacts; errors are those against the finest cells, times those over the coarsest."""
    lines = ["| deck | cells, mm | fewest cells in a process zone of shear | peak force, kN | projected area, mm² | "
             "error of the peak, % | error of the area, % | processor time over that of the coarsest | projected area "
             "by strengths, mm² |", "|" + "---|"*9]
    for row in sorted(rows, key=lambda row: (row["deck"], -float(row["cell"]))):
        own = sorted((other for other in rows if other["deck"] == row["deck"]), key=lambda other: float(other["cell"]))
        errors = [f"{100*(float(row[name])/float(own[0][name]) - 1):+.1f}" for name in ("peak_force", "projected_area")]
        if row is own[0]:
            errors = ["0", "0"]
        area = by_strength(others, row, ("deck", "cell"), lambda other: f"{float(other['projected_area']):.0f}")
        lines.append(f"| `{row['deck']}.nml` | {row['cell']} | {row['cells_shear']} | "
                     f"{float(row['peak_force'])/1e3:.2f} | {float(row['projected_area']):.0f} | {errors[0]} | "
                     f"{errors[1]} | {float(row['seconds'])/float(own[-1]['seconds']):.1f} | {area} |")
    return lines


def page_with(page, lines):
    """Return a page with one of its tables replaced."""
    text = (STUDIES/page).read_text(encoding="utf-8")
    table = re.compile("^" + re.escape(PAGES[page]) + r".*?(?=\n\n|\Z)", re.DOTALL | re.MULTILINE)
    if not table.search(text):
        sys.exit(f"{page}: there is no table that begins with {PAGES[page]}")
    return table.sub(lambda _: "\n".join(lines), text)


def main(check):
    """Write or compare the tables."""
    strips, impacts = rows_of("strips"), rows_of("plates")
    source = SOURCE.read_text(encoding="utf-8")
    errors = table_lines(strip_errors(strips), impact_errors(impacts))
    new = {SOURCE: TABLE.sub(lambda found: found[1] + errors + found[3], source),
           STUDIES/"interfaces.md": page_with("interfaces.md", strip_lines(strips, rows_of("strips", "strength"))),
           STUDIES/"accuracy.md": page_with("accuracy.md", impact_lines(impacts, rows_of("plates", "strength")))}
    for path, text in new.items():
        if check and path.read_text(encoding="utf-8") != text:
            sys.exit(f"{path}: a table is not that of the rows; run growth_table.py.")
        if not check:
            path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main("--check" in sys.argv)
