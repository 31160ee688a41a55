"""Strengths of fibres that scatter: those of the formula, after an impact, and on other cells of a plate cut from it.
Usage: drawn_strengths.py IMPLAM FOLDER

The strengths in the fields are found again by theory (M33) with a hash written a second time: of the struck plate and
of a plate cut from it beside its centre, on other cells, in the run that starts from the impact. A run with
another seed, which has other strengths, cannot start from it, nor one from a plate cut beside its centre, whose place
is not known."""

import math
import shutil
import sys
from pathlib import Path

import h5py
import numpy as np
from solver_runs import DECKS, EXIT_DECK, change_deck, exit_code_of, require, run

SEED, SIDE, MODULUS, REFERENCE, XT, PLY = 7, 1.5e-3, 20.0, 3.75e-6, 2080e6, 0.6e-3
KEYS = [f"ply_damage%weibull_modulus={MODULUS}", f"ply_damage%strength_seed={SEED}",
        f"ply_damage%strength_length={SIDE}", "plate%symmetry='none'"]
CUT_AT = (6e-3, -3e-3)
CUT = ["plate%length=40e-3, 24e-3", "support%window=36e-3, 20e-3", "mesh%elements=18, 11", "mesh%lines_x=18e-3",
       "mesh%lines_y=10e-3", "line%at=20e-3", "line%displacement=-0.01e-3", "line%rise=0.01e-3", "time%settle=0.02e-3",
        "time%end=0.04e-3",
       "initial_state%cut_at=6e-3, -3e-3"]
# Cells over the full impact plate.
IMPACT = ["mesh%elements=20, 16"]


def murmur3(words, seed):
    """Return MurmurHash3 of 32-bit words."""
    def turned(word, bits):
        return (word << bits | word >> (32 - bits)) & 0xffffffff
    value = seed
    for word in words:
        value ^= turned((word & 0xffffffff) * 0xcc9e2d51 & 0xffffffff, 15) * 0x1b873593 & 0xffffffff
        value = (turned(value, 13) * 5 + 0xe6546b64) & 0xffffffff
    value ^= 4 * len(words)
    value = (value ^ value >> 16) * 0x85ebca6b & 0xffffffff
    value = (value ^ value >> 13) * 0xc2b2ae35 & 0xffffffff
    return value ^ value >> 16


def squares(low, high):
    """Return the squares with their middle between two coordinates, or that of the middle between these."""
    first, last = (math.ceil(end / SIDE - 0.5 - 1e-6) for end in (low, high))
    return range(first, last) or [math.floor((low + high) / 2 / SIDE + 1e-6)]


def strength(ply, low, high):
    """Return the strength of a ply in a rectangle."""
    largest = max(murmur3((ply, i, j), SEED) for i in squares(low[0], high[0]) for j in squares(low[1], high[1]))
    draw = -math.log((largest + 0.5) / 2**32) * REFERENCE / (SIDE**2 * PLY)
    return XT * draw**(1 / MODULUS) / math.gamma(1 + 1 / MODULUS)


def check_fields(path, origin, joined):
    """Compare the strengths in a file with those of the formula; elements at the struck point may be joined."""
    with h5py.File(path) as file:
        last = file["times"][max(file["times"])]
        mesh = file["meshes"][max(file["meshes"])]
        points, cells = mesh["coordinates"][()], mesh["connectivity"][()]
        count = 0
        for ply in (1, 4):
            found = np.asarray(last[f"cells/ply_{ply}_fibre_strength"]).ravel()
            for cell, value in zip(cells, found, strict=True):
                low, high = points[cell, :2].min(axis=0), points[cell, :2].max(axis=0)
                if value == 0 or (joined and np.any(np.minimum(abs(low), abs(high)) < 1e-9)):
                    continue
                expected = strength(ply, low + origin, high + origin)
                require(abs(value - expected) < 1e-12 * expected, f"{path}: {value} at {low}, not {expected}.")
                count += 1
    print(f"{path.name}: {count} strengths")
    require(count > 300, f"Only {count} strengths.")


def check(implam, folder):
    """Run the impact and what starts from it."""
    folder = Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)

    def deck_of(name, settings):
        text = (DECKS.parent / "small" / f"{name}.nml").read_text(encoding="utf-8")
        (folder / f"{name}.nml").write_text(change_deck(text, [*KEYS, *settings]), encoding="utf-8")
        return f"{name}.nml"

    run([implam, deck_of("cai_impact", IMPACT)], folder=folder)
    check_fields(folder / "cai_impact.h5", (0, 0), True)
    run([implam, deck_of("cai_compression", CUT)], folder=folder)
    check_fields(folder / "cai_compression.h5", CUT_AT, False)
    said = run([implam, deck_of("cai_compression", [*CUT, "ply_damage%strength_seed=8"])], EXIT_DECK, folder)
    require("strength_seed" in said and "8" in said, f"Another seed: {said}")
    run([implam, deck_of("cai_compression", CUT)], folder=folder)
    third = [*CUT[:-1], "initial_state%from='cai_compression_restart.h5'", "case%name='third'"]
    said = run([implam, deck_of("cai_compression", third)], EXIT_DECK, folder)
    require("places of strengths that scatter" in said, f"A plate cut before: {said}")


if __name__ == "__main__":
    sys.exit(exit_code_of(check, *sys.argv[1:]))
