#!/usr/bin/env python3
"""Effect of the constants of the iteration: each halved and doubled, on small decks.
Usage: solution_controls.py IMPLAM [CONSTANT or DECK ...]     (about six minutes)
       solution_controls.py IMPLAM own [CONSTANT ...]         (about two minutes)

The constants are those of the group &controls, which `implam explain controls` lists. Without a name all are varied,
on all decks.
Prints a row for each variant: the constant, its value, and for each deck the ratio of its cost to that of the unchanged
deck, and the largest change of the force in the history over the peak force (of the energies, without an impactor), in
%. The cost is the number of solves plus 30 for each factorization, which takes about as long as 30 solves. A dash marks
a run that did not end.

With `own` the constants that few decks use are varied, each on decks that use it: a row has constant, deck, and for
each other value ratio and change."""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2] / "input"
# An impact with ply and interface failure; adaptive layers with adaptive steps; softening plies with implicit steps; an
# impact with adaptive steps; buckling under load steps; load steps by dissipated energy.
DECKS = {"damage": "small/damage.nml", "layers": "small/layers.nml", "snapping": "verify/snapping.nml",
         "adaptive": "sun_chen.nml", "buckling": "verify/buckled_strip.nml", "dcb": "verify/dcb.nml"}
# Additions to a deck: adaptive steps.
ADDED = {"adaptive": "&adapt on=.true. /\n"}
# Replacements in a deck: a first step chosen by the error.
REPLACED = {"adaptive": ("step=2e-6", "step=20e-6")}
# Decks for the constants of load steps, of Newton's method, and of the control of time steps.
BY_LOAD = ("dissipation_tolerance", "load_step_parts")
NEWTON = ("forcing", "max_forcing", "element", "contact", "search", "force", "last", "alternating")
PRICE = 30
# Changes of input/sun_chen.nml: patterns and their replacements.
COARSE = [("elements=16, 16", "elements=8, 8")]
SHORT = [*COARSE, ("step=2e-6", "step=0.1e-6")]
PLAIN = ("'gear4'", "'trapezoidal'")
CURVED = [*COARSE, PLAIN, ("'linear'", "'von_karman'"), ("end=1000e-6", "end=300e-6")]
FRONT = [("starter=12e-3", "starter=12e-3 law='front' growth='one_per_step'")]
PRESSED = [("step=1e-3", "step=2e-2"), ("step_max=5e-3", "step_max=2e-2"), ("stress_change=0.1 ", ""),
           ("refactor='deflection' stiffness_update=0.003 ", "")]
# Decks for constants that few decks use: path, changes, and additions.
OWN_DECKS = {
    "curved": ("sun_chen.nml", [*CURVED, ("velocity=3", "velocity=30")], ""),
    "exact": ("sun_chen.nml", CURVED, "&solver tolerance=1e-12 /"),
    "short": ("sun_chen.nml", [*SHORT, PLAIN], "&adapt on=.true. tolerance=1e-2 /"),
    "gear": ("sun_chen.nml", SHORT, "&adapt on=.true. tolerance=1e-2 /"),
    "stress": ("sun_chen.nml", [*COARSE, PLAIN], "&adapt on=.true. rule='stress_rate' stress_change=0.2 /"),
    "long": ("sun_chen.nml", [*COARSE, PLAIN, ("step=2e-6", "step=40e-6")], "&adapt on=.true. /\n"),
    "pressed": ("../tests/decks/good/pressure_transient.nml", PRESSED, ""),
    "front": ("small/delamination.nml", FRONT, "&adapt on=.true. /"),
    "block": ("verify/block.nml", [], ""), "ubm": ("verify/dcb_ubm.nml", [], ""),
    "strip": ("verify/buckled_strip.nml", [], ""),
}
# Constants, the decks that use them, and other values.
OWN = {
    "element_reduction": ("curved", (1e-3, 0.1)), "last_digits": ("exact", (8, 128)),
    "force_floor": ("block", (1e-7, 1e-5, 1e-3)), "alternating_iterations": ("block", (4, 16, 100)),
    "ratio_near_growth": ("front", (0.5, 0.7, 0.9)),
    "min_mass_ratio": ("stress short pressed", (0.1, 0.6)),
    "rejection_error": ("pressed", (4, 16, 100)), "first_error": ("long", (2, 64)),
    "allowed_in_impact": ("short", (0.0625, 0.25)), "max_doublings": ("short", (1, 2, 6)),
    "steady_in_impact": ("short", (12, 48)), "doublings_of_gear": ("gear", (2, 3)), "equal_of_gear": ("gear", (1, 20)),
    "dissipation_tolerance": ("strip ubm", (1e-3, 0.1)), "load_step_parts": ("strip ubm", (2, 16)),
}


def constants(program):
    """Names, types and values of the constants."""
    done = subprocess.run([program, "explain", "--markdown", "controls"], stdout=subprocess.PIPE, text=True, check=True)
    rows = [[cell.strip(" `") for cell in line.strip("|").split("|")] for line in done.stdout.splitlines()[2:]]
    return {row[0]: (row[1].split()[0], float(row[4])) for row in rows if len(row) > 4}


def run(program, deck, added):
    """Cost and history of a deck with additions; None if it has not ended."""
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
    """Ratio of costs and largest difference of the histories, as text."""
    if found is None:
        return "-"
    cost, history = found
    times, values = reference[1].T
    change = np.abs(np.interp(times, *history.T) - values).max() / np.abs(values).max()
    return f"{cost / reference[0] if cost else 1:.2f} {100 * change:.1g}"


def variants(kind, value, key):
    """Half and double of a value, within the limits of the deck."""
    pair = [value / 2, value * 2]
    if key in ("forcing_factor", "search_max_part", "search_slope"):
        pair[1] = (1 + value) / 2
    if key == "search_max_part":
        pair[0] = 0.6
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


def own_deck(name):
    """Text of a deck of OWN_DECKS."""
    path, changes, added = OWN_DECKS[name]
    text = (ROOT / path).read_text(encoding="utf-8")
    for old, new in changes:
        if old not in text:
            raise SystemExit(f"{path} has no {old}.")
        text = text.replace(old, new)
    return f"{text}\n{added}\n"


def vary_own(program, wanted):
    """Print a row for each constant of OWN and deck."""
    values, plain = constants(program), {}
    print("| constant | deck | value | other value: cost, change in % |")
    print("|---|---|---|---|")
    for key, (names, others) in OWN.items():
        for name in names.split() if not wanted or key in wanted else ():
            if name not in plain:
                plain[name] = run(program, own_deck(name), "")
            cells = []
            for other in others:
                found = run(program, own_deck(name), f"&controls {key}={other:g} /\n")
                cells.append(f"{other:g}: {compared(found, plain[name]) if plain[name] else 'deck fails'}")
            print(f"| {key} | {name} | {values[key][1]:g} | {'; '.join(cells)} |", flush=True)


def main():
    """Run the variants and print their table."""
    if sys.argv[2:3] == ["own"]:
        vary_own(sys.argv[1], sys.argv[3:])
        return
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
    if len(sys.argv) < 2 or "--help" in sys.argv:
        raise SystemExit(__doc__)
    main()
