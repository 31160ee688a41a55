"""CalculiX, webs as shells: stiffness of a panel with three blades under a force on 12 mm, in a bay and over a web.
Usage: blades.py IMPLAM FOLDER [ELEMENTS...]     (ends with 77 where ccx is not installed)

Webs as shells bend across and locally under the force, where stringers are rigid across their height. Webs begin in the
mid-plane of the skin, so that half its thickness counts twice. Measured for blades of 25 by 2 mm on a skin of 2 mm:
.03 % in the bay and .7 % over the web; for blades of 40 by 1 mm 6.9 % over the web."""

import contextlib
import re
import shutil
import sys
from pathlib import Path

import numpy as np
from implam_post.exchange.abaqus import abaqus_input
from implam_post.exchange.results import read_panel
from implam_post.exchange.shell_mesh import shell_mesh
from solver_runs import exit_code_of, read_history, require, run, run_deck

SKIPPED = 77
PATCH = 12.0
DECK = """&case kinematics='linear' units='mm-t-s' /
&plate length=240, 240 edges='clamped' /
&mesh elements={elements}, {elements} patch={patch:g} grading=1 /
&material name='alloy' density=2.7e-9 E=70e3 nu=0.33 /
&laminate materials='alloy' angles=0 thicknesses=2 shear_correction='5/6' /
{stringers}
&impactor travel=1 at=0, {at:g} /
&indentation law='hertz' k=1e12 /
&static steps=1 /
"""
BLADE = "&stringer along='x' name='at_{index}' at={place:g} height={height:g} thickness={thickness:g} " \
        "E=70e3 G=26316 density=2.7e-9 /"
# Height and thickness of the blades, place of the force, and its allowed difference.
TRIALS = {"bay": ((25, 2), 30, 0.005), "web": ((25, 2), 0, 0.012), "slender web": ((40, 1), 0, 0.08)}
# Mean over a cell of the deflections at its corners and mid-sides.
WEIGHTS = np.array(4 * [-1 / 12] + 4 * [1 / 3])


def own_stiffness(folder, implam, blade, at, elements):
    """Return the stiffness by Implam and the panel on the cells of the run."""
    stringers = "\n".join(BLADE.format(index=index, place=place, height=blade[0], thickness=blade[1])
                          for index, place in enumerate((-60, 0, 60)))
    folder.mkdir(parents=True)
    path = folder / "deck.nml"
    path.write_text(DECK.format(elements=elements, patch=PATCH, at=at, stringers=stringers), encoding="utf-8")
    path_of_history = run_deck(implam, path)
    history = read_history(path_of_history)
    results = Path(str(path_of_history).removesuffix("_history.csv") + ".h5")
    deflection = history["impactor_displacement"][-1] - history["indentation"][-1]  # the mean of the patch
    return history["force"][-1] / deflection, read_panel(results)


def calculix_stiffness(folder, panel, at):
    """Return the stiffness by CalculiX for a pressure on the cells of the patch."""
    mesh = shell_mesh(panel, with_middles=False)
    middles = np.array([mesh.coordinates[np.array(element.eight[:4]) - 1].mean(axis=0) for element in mesh.elements])
    loaded = np.flatnonzero((np.abs(middles[:, :2] - [0, at]) < PATCH / 2).all(axis=1))
    text = "\n".join(abaqus_input(panel.with_pressure(1.0), "deck.nml"))
    text = re.sub(r"\*ELSET, ELSET=STRUCK, GENERATE\n.*\n",
                  "*ELSET, ELSET=STRUCK\n" + "\n".join(f"{number + 1}," for number in loaded) + "\n", text)
    (folder / "panel.inp").write_text(text + "\n", encoding="utf-8")
    with contextlib.chdir(folder):
        run(["ccx", "panel"])
    rows = [line.split() for line in (folder / "panel.dat").read_text().splitlines()]
    deflections = {int(row[0]): float(row[3]) for row in rows if len(row) == 4 and row[0].isdigit()}
    means, areas = [], []
    for number in loaded:
        nodes = mesh.elements[number].eight
        corners = mesh.coordinates[np.array(nodes[:4]) - 1]
        areas.append(np.prod(np.ptp(corners[:, :2], axis=0)))
        means.append(WEIGHTS @ [deflections[node] for node in nodes])
    require(abs(sum(areas) - PATCH**2) < 1e-6 * PATCH**2, f"The patch has an area of {sum(areas):g}.")
    return sum(areas) / np.average(means, weights=areas)


def check(implam, folder):
    """Compare all trials."""
    shutil.rmtree(folder, ignore_errors=True)
    for name, (blade, at, allowed) in TRIALS.items():
        for elements in map(int, sys.argv[3:] or [40]):
            here = folder / f"{name} {elements}"
            own, panel = own_stiffness(here, implam, blade, at, elements)
            other = calculix_stiffness(here, panel, at)
            print(f"{name}, {elements} elements: {own:.1f} N/mm, {other:.1f} by CalculiX, "
                  f"{100 * (own / other - 1):.2f} %", flush=True)
            require(abs(own / other - 1) < allowed, f"{name}: the stiffness differs.")


if __name__ == "__main__":
    if not shutil.which("ccx"):
        print("skipped: ccx is not installed")
        raise SystemExit(SKIPPED)
    raise SystemExit(exit_code_of(check, Path(sys.argv[1]).resolve(), Path(sys.argv[2])))
