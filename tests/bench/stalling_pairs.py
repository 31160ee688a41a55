#!/usr/bin/env python3
"""Whether rounding decides where steps stall: input/small/stalling_steps.nml with other speeds, to two ends.
Usage: stalling_pairs.py IMPLAM

Each is run with residuals of 1e-9, .8e-9 and 2e-9, which makes two pairs that ought to be the same. Prints the time in
ms at which times, forces (1e-5 of the largest) or areas (1e-4 mm2) part, and how many of the 32 pairs do; four
minutes."""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/regress"))
from solver_runs import change_deck

SPEEDS = (3.62, 3.64, 3.66, 3.6676, 3.68, 3.70, 3.72, 3.75)
ENDS = ("1448e-6", "1265.2427e-6")


def history(implam, settings):
    """Times, forces and areas of a run."""
    text = (ROOT / "input/small/stalling_steps.nml").read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "deck.nml").write_text(change_deck(text, settings), encoding="utf-8")
        subprocess.run([implam, folder / "deck.nml", "--output", folder], check=True, capture_output=True)
        with next(folder.glob("*_history.csv")).open(encoding="utf-8") as file:
            return [[float(row[key]) for key in ("time", "force", "delaminated_area")] for row in csv.DictReader(file)]


def parts_at(one, other):
    """Time in ms at which two histories part; None if they do not."""
    largest = max(force for _, force, _ in one)
    for (time, force, area), (other_time, other_force, other_area) in zip(one, other, strict=False):
        if abs(time - other_time) > 1e-12 or abs(force - other_force) > 1e-5*largest or abs(area - other_area) > 1e-10:
            return f"{1e3*time:.3f}"
    return None


def main(implam):
    """Print a row a speed and end."""
    parted = 0
    for end in ENDS:
        for speed in SPEEDS:
            runs = [history(implam, [f"impactor%velocity={speed}", f"time%end={end}", f"solver%tolerance={tolerance}"])
                    for tolerance in ("1e-9", "0.8e-9", "2e-9")]
            pairs = [parts_at(runs[0], run) for run in runs[1:]]
            parted += sum(pair is not None for pair in pairs)
            print(f"{speed} m/s to {end} s:", *(pair or "same" for pair in pairs), flush=True)
    print(f"{parted} of {2*len(ENDS)*len(SPEEDS)} pairs part.")


if __name__ == "__main__":
    main(sys.argv[1])
