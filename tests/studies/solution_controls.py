#!/usr/bin/env python3
"""What the constants of the iteration change: each halved and doubled, on small decks.
Usage: solution_controls.py IMPLAM [CONSTANT or DECK ...]     (about six minutes)

The constants are those of the group &controls, which `implam explain controls` lists. Without a name all are varied,
on all decks.
Prints a row a variant: the constant, its value, and for each deck the ratio of its cost to that of the deck as it is,
and the largest change of the force in the history over the peak force (of the energies, where no impactor presses), in
%. The cost is the number of solves plus 30 for each factorization, which takes about as long as 30 solves. A dash is a
run that has not ended."""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2] / "input"
# A blow with plies and an interface that fail; layers that follow damage, with adaptive steps; softening plies in
# implicit motion; an impact with adaptive steps; buckling under load steps; load steps by dissipated energy.
DECKS = {"damage": "small/damage.nml", "layers": "small/layers.nml", "snapping": "verify/snapping.nml",
         "adaptive": "sun_chen.nml", "buckling": "verify/buckled_strip.nml", "dcb": "verify/dcb.nml"}
# What is added to a deck: steps that follow their error.
ADDED = {"adaptive": "&adapt on=.true. /\n"}
# What is replaced in a deck: a first step that the error chooses.
REPLACED = {"adaptive": ("step=2e-6", "step=20e-6")}
# Decks of the constants of load steps, of Newton's method, and of the control of steps in time.
BY_LOAD = ("dissipation_tolerance", "dissipation_growth", "load_step_parts")
NEWTON = ("forcing", "max_forcing", "element", "contact", "search", "force", "last", "alternating")
PRICE = 30


def constants(program):
    """Names, types and values of the constants."""
    done = subprocess.run([program, "explain", "--markdown", "controls"], stdout=subprocess.PIPE, text=True, check=True)
    rows = [[cell.strip(" `") for cell in line.strip("|").split("|")] for line in done.stdout.splitlines()[2:]]
    return {row[0]: (row[1].split()[0], float(row[4])) for row in rows if len(row) > 4}


def run(program, deck, added):
    """Cost and history of a deck with something added; None if it has not ended."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "deck.nml"
        path.write_text(deck + "\n" + added, encoding="utf-8")
        done = subprocess.run([program, path, "--output", folder], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              check=False)
        if done.returncode:
            return None
        with next(Path(folder).glob("*_history.csv")).open(encoding="utf-8") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    last = rows[-1]
    force = "force" if any(abs(float(row["force"])) > 0 for row in rows) else "energy_strain"
    history = np.array([[float(row["time"]), float(row[force])] for row in rows])
    return float(last["solves"]) + PRICE * float(last["refactorisations"]), history


def compared(found, reference):
    """Ratio of costs and largest difference of the histories, in words."""
    if found is None:
        return "-"
    cost, history = found
    times, values = reference[1].T
    change = np.abs(np.interp(times, *history.T) - values).max() / np.abs(values).max()
    return f"{cost / reference[0]:.2f} {100 * change:.1g}"


def variants(kind, value, key):
    """Half and double of a value, within what the deck allows."""
    pair = [value / 2, value * 2]
    if key in ("forcing_factor", "search_max_part", "search_slope"):
        pair[1] = (1 + value) / 2
    if key in ("search_max_part", "lag_high"):
        pair[0] = (1 + value) / 2 if key == "lag_high" else 0.6
    if key == "ratio_near_growth":
        pair[1] = 0.9
    return [max(1, round(part)) for part in pair] if kind == "integer" else pair


def decks_of(key):
    """Names of the decks on which a constant is varied."""
    if key in BY_LOAD:
        return ["dcb"]
    if key.startswith(NEWTON):
        return ["damage", "layers", "snapping", "buckling"]
    return ["layers", "snapping", "adaptive"]


def main():
    """Run the variants and print their table."""
    program, wanted = sys.argv[1], [word for word in sys.argv[2:] if word not in DECKS]
    decks = {name: (ROOT / path).read_text(encoding="utf-8").replace(*REPLACED.get(name, ("", "")))
             for name, path in DECKS.items() if name in sys.argv or not set(DECKS) & set(sys.argv)}
    plain = {name: run(program, deck, ADDED.get(name, "")) for name, deck in decks.items()}
    print("| constant | value | " + " | ".join(decks) + " |")
    print("|---" * (len(decks) + 2) + "|")
    for key, (kind, value) in constants(program).items():
        if wanted and key not in wanted:
            continue
        if not set(decks_of(key)) & set(decks):
            continue
        for other in variants(kind, value, key):
            cells = ["" if name not in decks_of(key) else
                     compared(run(program, deck, f"{ADDED.get(name, '')}&controls {key}={other:g} /\n"), plain[name])
                     for name, deck in decks.items()]
            print(f"| {key} | {value:g} -> {other:g} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
