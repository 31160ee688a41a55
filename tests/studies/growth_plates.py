#!/usr/bin/env python3
"""Area, peak force and time of impacts by the cells, with growth by energy or by strengths.
Usage: growth_plates.py run IMPLAM FOLDER DECK CELLS [CONTROL]

DECK is one of DECKS, CELLS are lengths in mm with commas, CONTROL is energy or strength.
The patch has its size on all meshes, the elements outside of the core their number. `run` adds a row to
growth/plates.csv for each mesh that has none, so that a stopped command continues. Times are processor times."""

import csv
import json
import os
import re
import sys
from pathlib import Path

from result_rows import append_row

HERE = Path(__file__).resolve().parent
INPUT = HERE.parents[1]/"input"
ROWS = HERE/"growth"/"plates.csv"
COLUMNS = ["deck", "cell", "control", "cells_shear", "peak_force", "projected_area", "delaminated_area", "first_growth",
           "seconds"]
# Half extents of the core less half of the patch along x and y, mm; elements outside; whether x is halved; the
# shortest process zone of shear, mm.
DECKS = {"peanut": ((19.2, 7.2), (6, 7), True, 2.59), "which_interfaces": ((22, 22), (3, 6), False, 3.37),
         "experiments/t700_m21_6.5J": ((20, 20), (18, 20), False, 2.8),
         "experiments/t800s_3900_2b_impact_15.5J": ((26, 26), (6, 12), False, 2.37)}


def text_of(deck, cell, control):
    """Return the deck on cells of a length."""
    halves, outside, is_quarter, _ = DECKS[deck]
    text = (INPUT/f"{deck}.nml").read_text(encoding="utf-8")
    patch = float(re.search(r"patch=([\d.e-]+)", text)[1])*1e3
    # A quarter has half of the elements of each side, half a plate by point symmetry those of x.
    along = [round(half/cell) + max(1, round(patch/2/cell)) for half in halves]
    counts = [along[0] + outside[0], along[1] + outside[1] if is_quarter else 2*along[1] + outside[1]]
    text = re.sub(r"elements=\d+, \d+", f"elements={counts[0]}, {counts[1]}", text)
    text = re.sub(r"cell=[\d.e-]+", f"cell={cell}e-3", text)
    law = "" if "law='cohesive'" in text else "law='cohesive'  "
    text = re.sub(r"&delamination ", f"&delamination {law}growth_control='{control}'  ", text)
    return re.sub(r"&time .*/", lambda time: time[0].replace("integrator='central_difference'", "").replace(
        "&time", "&time integrator='central_difference'"), text)


def run_deck(implam, deck, place):
    """Run a deck; return its summary and the processor time in seconds."""
    child = os.spawnv(os.P_NOWAIT, implam, [implam, str(deck), "--output", str(place)])
    _, status, usage = os.wait4(child, 0)
    if status:
        sys.exit(f"{deck} failed.")
    return json.loads(next(place.glob("*_summary.json")).read_text(encoding="utf-8")), usage.ru_utime


def main(implam, folder, deck, cells, control="energy"):
    """Run the meshes that have no row yet, and add their rows."""
    stored = []
    if ROWS.exists():
        with open(ROWS, encoding="utf-8") as table:
            stored = [(row["deck"], row["cell"], row["control"]) for row in csv.DictReader(table)]
    for cell in cells.split(","):
        if (deck, cell, control) in stored:
            continue
        place = Path(folder)/f"{Path(deck).name}_{cell}_{control}"
        place.mkdir(parents=True, exist_ok=True)
        (place/"deck.nml").write_text(text_of(deck, float(cell), control), encoding="utf-8")
        summary, seconds = run_deck(implam, place/"deck.nml", place)
        add_row([deck, cell, control, f"{DECKS[deck][3]/float(cell):.2f}", f"{summary['peak_force']:.0f}",
                 f"{1e6*summary['projected_area']:.1f}", f"{1e6*summary['delaminated_area']:.1f}",
                 f"{summary['first_growth_force'] or 0:.0f}", f"{seconds:.1f}"])


def add_row(values):
    """Append a row to the table, and print it."""
    append_row(ROWS, COLUMNS, dict(zip(COLUMNS, values, strict=True)))
    print(*values, flush=True)


if __name__ == "__main__":
    main(*sys.argv[2:])
