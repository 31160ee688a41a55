"""Damage of two doublers that are images of each other: parts of the plate against the full one.
Usage: doublers.py TRIAL IMPLAM FOLDER

parts    histories and failed areas of the modelled parts are those of the full plate
started  the full plate, on the same cells and on others, starts with all damage of a modelled part"""

import json
import sys
from pathlib import Path

from solver_runs import checkpoint_of, exit_code_of, largest_difference, read_history, require, run_deck

DECK = """&case units='mm-t-s' /
&plate length=60,40 edges='clamped' in_plane='fixed' symmetry='{symmetry}' /
&mesh elements={elements} patch=4 /
&material name='ply' density=1.6e-9 E1=130e3 E2=7.7e3 G12=4.8e3 G13=4.8e3 G23=3.8e3 nu12=0.3 nu23=0.35
  XT=2080 XC=1250 YT=40 YC=290 S12=60 G_ft=133 G_fc=10 G_mt=0.5 G_mc=1.6 /
&material name='weak' density=1.6e-9 E1=130e3 E2=7.7e3 G12=4.8e3 G13=4.8e3 G23=3.8e3 nu12=0.3 nu23=0.35
  XT=60 XC=60 YT=2 YC=6 S12=3 G_ft=2 G_fc=2 G_mt=0.01 G_mc=0.03 /
&laminate materials='ply' stacking='[0/90]s' ply_thickness=0.4 /
&doubler name='a' at=0,-7 size=40,6 materials='weak' stacking='[0/90]' ply_thickness=0.2 /
&doubler name='b' at=0,7 size=40,6 materials='weak' stacking='[0/90]' ply_thickness=0.2 /
&ply_damage criteria='hashin' /
{load}
"""
STRUCK = """&impactor mass=60e-6 velocity=7e3 radius=8 /
&indentation law='hertz' k=30000 /
&time integrator='central_difference' end=0.15e-3 mass_scaling=10 /"""
PRESSED = "&pressure value=6 /\n&time integrator='central_difference' end=6e-5 mass_scaling=10 /"
AGAIN = """&initial_state from='{start}' /
&pressure value=1e-6 /
&time integrator='central_difference' end=6e-5 settle=5e-5 mass_scaling=10 /"""
CELLS = {"none": "20,16", "quarter": "10,8", "half_x": "10,16", "half_y": "20,8", "point": "10,16"}
# Relative to the largest value of a column.
SAME = 1e-6
AREAS = ("fibre_failure_area", "matrix_crack_area", "matrix_crushing_area")
COUNTS = ("fibre_failures", "matrix_cracks", "matrix_crushings")


def run_part(implam, folder, symmetry, load=STRUCK, elements=None):
    """Run a part of the plate; return its history and summary."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "deck.nml"
    path.write_text(DECK.format(symmetry=symmetry, elements=elements or CELLS[symmetry], load=load), encoding="utf-8")
    history = read_history(run_deck(implam, path))
    return history, json.loads(next(folder.glob("*_summary.json")).read_text(encoding="utf-8"))


def areas_of(summary):
    """Failed areas of all plies in all modes."""
    return [ply[area] for ply in summary["plies"] for area in AREAS]


def try_parts(implam, folder):
    """Compare the parts with the full plate."""
    history, summary = run_part(implam, folder / "none", "none")
    expected = areas_of(summary)
    require(all(sum(areas_of({"plies": [ply]})) > 0 for ply in summary["plies"] if "doubler" in ply),
            "A ply of the doublers has not failed.")
    for part in ("quarter", "half_x", "half_y", "point"):
        found, summary = run_part(implam, folder / part, part)
        worst, column = largest_difference(found, history)
        print(f"{part}: {worst:.1e} of the full plate in {column}")
        require(worst < SAME, f"{part}: {column} differs by {worst}.")
        apart = max(abs(one - other) for one, other in zip(areas_of(summary), expected, strict=True))
        require(apart < SAME * max(expected), f"{part}: failed areas are {areas_of(summary)}, not {expected}.")


def try_started(implam, folder):
    """Start the full plate from parts of it."""
    for part in ("quarter", "point"):
        before, _ = run_part(implam, folder / part, part, PRESSED)
        load = AGAIN.format(start=checkpoint_of(folder / part))
        same, _ = run_part(implam, folder / f"{part} same", "none", load)
        found, expected = [same[count][0] for count in COUNTS], [before[count][-1] for count in COUNTS]
        print(f"from {part}, same cells: {found} failures at first, {expected} before")
        require(found == expected, f"from {part}: {found} plies of elements have failed, not {expected}.")
        _, other = run_part(implam, folder / f"{part} other", "none", load, "24,20")
        mapping = other["mapping"]
        for name in ("fibre_damage_area", "matrix_damage_area", "energy_ply_damage"):
            kept = mapping[name + "_after"] / mapping[name + "_before"]
            print(f"from {part}, other cells: {name} times {kept:.9f}")
            require(abs(kept - 1) < SAME, f"from {part}: {name} is {kept} times that before.")


def check(trial, implam, folder):
    """Run a trial."""
    {"parts": try_parts, "started": try_started}[trial](Path(implam), Path(folder).absolute())


if __name__ == "__main__":
    sys.exit(exit_code_of(check, *sys.argv[1:]))
