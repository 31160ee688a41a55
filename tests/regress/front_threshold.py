"""Closed form of the delamination threshold force: a front of whole cells under a slow central impact.
Usage: front_threshold.py IMPLAM FOLDER"""

import itertools
import math
import sys
from pathlib import Path

from solver_runs import read_history, require, run, write_deck

# Data of input/verify/front_threshold.nml: modulus, Poisson's ratio, thickness, toughness, side of the patch.
YOUNG, NU, THICKNESS, TOUGHNESS, PATCH = 50e9, 0.3, 2e-3, 800.0, 4e-3


def threshold(area):
    """Return the force at which a round delamination of a given area grows under the patch."""
    point = math.sqrt(8 * math.pi**2 * YOUNG * THICKNESS**3 * TOUGHNESS / (9 * (1 - NU**2)))
    return point / (1 - PATCH**2 / (2 * area))


def growth_ratios(rows):
    """Return force over closed form at first growth and after each step with growth, and the areas of the steps."""
    grown = [(row, later) for row, later in itertools.pairwise(rows)
             if later["delaminated_area"] > row["delaminated_area"]]
    require(len(grown) > 0, "The front does not grow.")
    ratios = [later["force"] / threshold(later["delaminated_area"]) for _, later in grown]
    first = grown[0][0]
    return (max(grown[0][1]["force"], first["force"]) / threshold(first["delaminated_area"]), ratios,
            [later["delaminated_area"] - row["delaminated_area"] for row, later in grown])


def main(implam, folder):
    """Compare the deck with cells of 2 mm with the closed form."""
    folder = Path(folder)
    run([implam, write_deck(folder, "front_threshold.nml"), "--output", folder])
    columns = read_history(folder / "front_threshold_history.csv")
    rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    first, ratios, areas = growth_ratios(rows)
    mean = sum(ratio * area for ratio, area in zip(ratios, areas, strict=True)) / sum(areas)
    print(f"first growth {first:.3f}, then {min(ratios):.3f} to {max(ratios):.3f}, in the mean {mean:.3f}; "
          f"largest step {1e6 * max(areas):.0f} of {1e6 * sum(areas):.0f} mm^2")
    require(abs(first - 1) < LARGEST, f"Growth begins at {first:.3f} of the closed form.")
    require(max(abs(ratio - 1) for ratio in ratios) < LARGEST, "The force during growth differs from the closed form.")
    require(abs(mean - 1) < IN_THE_MEAN, f"The mean force of growth is {mean:.3f} of the closed form.")
    require(max(areas) < STEADY * sum(areas), "The front moves in bursts.")


# Bounds on the force, on its mean over the area, and on the area of one step. Measured: see doc/studies/accuracy.md.
LARGEST, IN_THE_MEAN, STEADY = 0.06, 0.04, 0.4

if __name__ == "__main__":
    main(*sys.argv[1:])
