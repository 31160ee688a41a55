"""CalculiX: the hinged cylindrical roof of Sabir and Lock (Int. J. Mech. Sci. 14, 1972) pressed through its limit load.
Usage: roof.py IMPLAM FOLDER     (ends with 77 where ccx is not installed)

CalculiX has the circle and finite rotations, Implam the parabola of shallow shells. Measured: limit load within .3 %,
forces within 3.0 % of the limit load up to a deflection of twice the rise."""

import contextlib
import math
import re
import shutil
import sys
from pathlib import Path

import numpy as np
from solver_runs import DECKS, read_history, require, run, run_deck

SKIPPED = 77
DECK = "roof.nml"
RADIUS, LENGTH, ANGLE, THICKNESS, YOUNG, POISSON = 2.54, 0.508, 0.1, 12.7e-3, 3102.75e6, 0.3
ELEMENTS, TRAVEL, INCREMENT = 8, 25e-3, 0.04
LIMIT_ERROR, CURVE_ERROR = 0.01, 0.04


def write_input(path):
    """Write the roof with quadratic shells, its centre displaced in increments."""
    last = 2 * ELEMENTS
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
    for element in range(ELEMENTS**2):
        row, column = divmod(element, ELEMENTS)
        grids = [nodes[2 * column + i, 2 * row + j] for i, j in around]
        lines.append(f"{element + 1}, " + ", ".join(map(str, grids)))
    hinges = [str(number) for (_, j), number in nodes.items() if j in (0, last)]
    lines += ["*NSET, NSET=HINGES", *hinges, "*NSET, NSET=CENTRE", str(nodes[ELEMENTS, ELEMENTS]),
              "*MATERIAL, NAME=ROOF", "*ELASTIC", f"{YOUNG}, {POISSON}",
              "*SHELL SECTION, ELSET=SHELLS, MATERIAL=ROOF", f"{THICKNESS}", "*BOUNDARY", "HINGES, 1, 3",
              "*STEP, NLGEOM, INC=200", "*STATIC", f"{INCREMENT}, 1., 1e-6, {INCREMENT}", "*BOUNDARY",
              f"CENTRE, 3, 3, {TRAVEL}", "*NODE PRINT, NSET=CENTRE, TOTALS=ONLY", "RF", "*END STEP"]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def calculix(folder):
    """Return deflections and forces at the centre computed by CalculiX."""
    write_input(folder / "ccx.inp")
    with contextlib.chdir(folder):
        run(["ccx", "ccx"])
    rows = re.findall(r"for set CENTRE and time\s+(\S+)\s+\S+\s+\S+\s+(\S+)", (folder / "ccx.dat").read_text())
    time, force = np.array(rows, dtype=float).T
    return time * TRAVEL, force


def limit_of(deflection, force):
    """Return the first maximum of the force, by the parabola through the three largest values."""
    top = int(np.argmax(force[deflection < TRAVEL / 2]))
    near = slice(top - 1, top + 2)
    bent, sloped, level = np.polyfit(deflection[near] - deflection[top], force[near], 2)
    return level - sloped**2 / (4 * bent)


def main(implam, folder):
    """Compare both programs."""
    if shutil.which("ccx") is None:
        print("skipped: ccx is not installed")
        return SKIPPED
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    shutil.copy(DECKS / DECK, folder)
    history = read_history(run_deck(implam, folder / DECK))
    own = np.array(history["patch_deflection"]), np.array(history["force"])
    deflection, force = calculix(folder)
    limits = limit_of(*own), limit_of(deflection, force)
    reached = deflection < own[0][-1]
    difference = max(abs(np.interp(deflection[reached], *own) - force[reached])) / limits[1]
    print(f"limit loads {limits[0]:.1f} and {limits[1]:.1f} N, forces within {100 * difference:.2f} % of it up to "
          f"{1e3 * own[0][-1]:.1f} mm")
    require(own[0][-1] > 0.9 * TRAVEL, "The roof is not pressed through its limit load.")
    require(min(force[deflection > TRAVEL / 2]) < 0.5 * limits[1], "CalculiX' roof does not snap through.")
    require(abs(limits[0] / limits[1] - 1) < LIMIT_ERROR, "The limit load differs from CalculiX'.")
    require(difference < CURVE_ERROR, "The force differs from CalculiX'.")
    return 0


if __name__ == "__main__":
    sys.exit(main(str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()))
