"""CalculiX: the hinged cylindrical roof of Sabir and Lock (Int. J. Mech. Sci. 14, 1972) pressed through its limit load.
Usage: roof.py thick|thin IMPLAM FOLDER     (ends with 77 where ccx is not installed)

CalculiX has the circle and finite rotations, Implam the parabola of shallow shells. Measured: 12.7 mm thick, limit load
within .3 %, forces within 3.0 % of the limit load up to a deflection of twice the rise; 6.35 mm thick, limit
load within .1 %, displacements within 1 % until the path turns back in displacement."""

import contextlib
import math
import re
import shutil
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
from solver_runs import DECKS, EXIT_CONVERGENCE, EXIT_DONE, history_of, read_history, require, run, run_deck

SKIPPED = 77
RADIUS, LENGTH, ANGLE, YOUNG, POISSON = 2.54, 0.508, 0.1, 3102.75e6, 0.3
INCREMENT = 0.04


class Roof(NamedTuple):
    """A roof: deck, thickness, elements of CalculiX along a side, displacement of the centre, whether the path turns
    back before it; the force after the limit load, over it, that must be reached; tolerances of the limit load, and of
    forces over it or of displacements.
    """

    deck: str
    thickness: float
    elements: int
    travel: float
    turns_back: bool
    left: float
    limit_error: float
    curve_error: float


ROOFS = {"thick": Roof("roof.nml", 12.7e-3, 8, 25e-3, False, 0.5, 0.01, 0.04),
         "thin": Roof("thin_roof.nml", 6.35e-3, 16, 18e-3, True, 0.15, 0.004, 0.01)}
# Relative difference of the displacements at which the path of the thin roof turns back. Measured: .4 %.
TURN_ERROR = 0.006
NO_CONVERGENCE_OF_CALCULIX = 201


def write_input(roof, path):
    """Write the roof with quadratic shells, its centre displaced in increments."""
    last = 2 * roof.elements
    nodes, lines = {}, ["*NODE, NSET=ROOF"]
    for j in range(last + 1):
        angle = ANGLE * (2 * j / last - 1)
        for i in range(last + 1):
            if i % 2 and j % 2:
                continue
            nodes[i, j] = len(nodes) + 1
            lines.append(f"{nodes[i, j]}, {LENGTH * (i / last - 0.5):.12g}, {RADIUS * math.sin(angle):.12g}, "
                         f"{RADIUS * (1 - math.cos(angle)):.12g}")
    lines.append("*ELEMENT, TYPE=S8R, ELSET=SHELLS")
    around = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    for element in range(roof.elements**2):
        row, column = divmod(element, roof.elements)
        grids = [nodes[2 * column + i, 2 * row + j] for i, j in around]
        lines.append(f"{element + 1}, " + ", ".join(map(str, grids)))
    hinges = [str(number) for (_, j), number in nodes.items() if j in (0, last)]
    lines += ["*NSET, NSET=HINGES", *hinges, "*NSET, NSET=CENTRE", str(nodes[roof.elements, roof.elements]),
              "*MATERIAL, NAME=ROOF", "*ELASTIC", f"{YOUNG}, {POISSON}",
              "*SHELL SECTION, ELSET=SHELLS, MATERIAL=ROOF", f"{roof.thickness}", "*BOUNDARY", "HINGES, 1, 3",
              "*STEP, NLGEOM, INC=200", "*STATIC", f"{INCREMENT}, 1., 2e-4, {INCREMENT}", "*BOUNDARY",
              f"CENTRE, 3, 3, {roof.travel}", "*NODE PRINT, NSET=CENTRE, TOTALS=ONLY", "RF", "*END STEP"]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def calculix(roof, folder):
    """Return deflections and forces at the centre computed by CalculiX."""
    write_input(roof, folder / "ccx.inp")
    with contextlib.chdir(folder):
        run(["ccx", "ccx"], NO_CONVERGENCE_OF_CALCULIX if roof.turns_back else EXIT_DONE)
    rows = re.findall(r"for set CENTRE and time\s+(\S+)\s+\S+\s+\S+\s+(\S+)", (folder / "ccx.dat").read_text())
    time, force = np.array(rows, dtype=float).T
    return time * roof.travel, force


def limit_of(deflection, force):
    """Return the first maximum of the force, by the parabola through the three largest values."""
    # The force of a roof that snaps through rises again.
    top = next(place for place in range(1, len(force) - 1) if force[place] >= max(force[place - 1:place + 2]))
    near = slice(top - 1, top + 2)
    bent, sloped, level = np.polyfit(deflection[near] - deflection[top], force[near], 2)
    return level - sloped**2 / (4 * bent)


def own_curve(roof, implam, folder):
    """Return deflections and forces by Implam; the run ends where the path turns back."""
    deck = folder / roof.deck
    shutil.copy(DECKS / roof.deck, deck)
    if roof.turns_back:
        run([implam, deck, "--output", folder], EXIT_CONVERGENCE)
        history = read_history(history_of(folder))
    else:
        history = read_history(run_deck(implam, deck))
    return np.array(history["patch_deflection"]), np.array(history["force"])


def difference_of(roof, own, other, limit):
    """Return the largest difference: of forces over the limit load, or of displacements after the limit load, where the
    path approaches its turn, over the displacement there.
    """
    if not roof.turns_back:
        reached = other[0] < own[0][-1]
        return max(abs(np.interp(other[0][reached], *own) - other[1][reached])) / limit
    forces = np.linspace(0.9, 0.15, 16) * limit
    curves = [np.interp(-forces, -force[np.argmax(force):], deflection[np.argmax(force):])
              for deflection, force in (own, other)]
    return max(abs(curves[0] / curves[1] - 1))


def main(trial, implam, folder):
    """Compare both programs."""
    if shutil.which("ccx") is None:
        print("skipped: ccx is not installed")
        return SKIPPED
    roof = ROOFS[trial]
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    own = own_curve(roof, implam, folder)
    other = calculix(roof, folder)
    limits = limit_of(*own), limit_of(*other)
    difference = difference_of(roof, own, other, limits[1])
    what = "displacements" if roof.turns_back else "forces"
    print(f"limit loads {limits[0]:.1f} and {limits[1]:.1f} N, {what} within "
          f"{100 * difference:.2f} %, followed to {1e3 * own[0][-1]:.2f} and {1e3 * other[0][-1]:.2f} mm")
    require(own[0][-1] > 0.9 * roof.travel, "The roof is not pressed through its limit load.")
    require(min(other[1][other[0] > roof.travel / 2]) < roof.left * limits[1], "CalculiX' roof does not snap through.")
    require(abs(limits[0] / limits[1] - 1) < roof.limit_error, "The limit load differs from CalculiX'.")
    require(difference < roof.curve_error, "The force differs from CalculiX'.")
    require(not roof.turns_back or abs(own[0][-1] / other[0][-1] - 1) < TURN_ERROR,
            "The displacement at which the path turns back differs from CalculiX'.")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], str(Path(sys.argv[2]).resolve()), Path(sys.argv[3]).resolve()))
