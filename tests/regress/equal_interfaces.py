"""Closed form of the threshold force: equal circular delaminations above each other, mean force 2 %.
Usage: equal_interfaces.py IMPLAM FOLDER

Under a force at the centre of a thin plate the energy release rate of each of n is (n + 2) P**2/(32 pi**2 D), so they
grow together at P = pi sqrt(32 D G_c/(n + 2)): 1756, 1521 and 1361 N for 1, 2 and 3."""

import math
import sys
from pathlib import Path

from solver_runs import exit_code_of, read_history, require, run_deck, write_deck

BENDING, TOUGHNESS, THICKNESS = 50e9 * 2e-3**3 / 12 / (1 - 0.3**2), 800, 2e-3
# Measured on cells of 2 mm: means at most 1.3 % off, single steps 2.7 %.
MEAN, SINGLE = 0.02, 0.035


def check(number, implam, folder):
    """Compare the force of all steps in which the area grows, once process zones have formed."""
    history = read_history(run_deck(implam, write_deck(folder, "cohesive_threshold.nml", [
        f"laminate%angles={number + 1}*0", f"laminate%thicknesses={THICKNESS / (number + 1)!r}",
        f"delamination%below_ply={','.join(map(str, range(1, number + 1)))}"])))
    area, force = history["delaminated_area"], history["force"]
    grown = [force[i] for i in range(1, len(area)) if area[i] > max(1.0005 * area[i - 1], 1.6 * area[0])]
    expected = math.pi * math.sqrt(32 * BENDING * TOUGHNESS / (number + 2))
    mean, smallest, limit = (figure / expected for figure in (sum(grown) / len(grown), min(grown), max(grown)))
    print(f"{number} interface(s): {len(grown)} steps, {mean:.4f}, {smallest:.4f} to {limit:.4f} of {expected:.0f} N")
    require(len(grown) > 10, "The delamination hardly grows.")
    require(abs(mean - 1) < MEAN and smallest > 1 - SINGLE and limit < 1 + SINGLE, "The force differs.")
    below = [history[f"area_below_{ply}"][-1] for ply in range(1, number + 1)]
    require(max(below) < 1.05 * min(below), f"The delaminations grow differently: {below}.")


def main(implam, folder):
    """Run one, two and three interfaces."""
    return max(exit_code_of(check, number, implam, Path(folder) / str(number)) for number in (1, 2, 3))


if __name__ == "__main__":
    raise SystemExit(main(*sys.argv[1:]))
