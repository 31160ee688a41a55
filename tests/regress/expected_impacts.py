"""Elastic impacts away from the middle of a plate: peak force, deflection and end of contact that `implam check`
expects, beside those of runs. Usage: expected_impacts.py IMPLAM FOLDER"""

import json
import re
import sys
from pathlib import Path

from solver_runs import require, run, run_deck

DECK = """&case kinematics='linear' units='SI' /
&plate length=0.3, 0.2 {plate} /
&mesh elements=16, 12 patch=6e-3 /
&material name='m' density=1600 E1=127e9 E2=8.4e9 G12=4.2e9 G13=4.2e9 G23=2.9e9 nu12=0.31 /
&laminate materials='m' stacking='[0/45/90/-45]2s' ply_thickness=0.13e-3 /
&impactor mass=1.0 velocity=1.0 radius=8e-3 at={place} /
&indentation law='hertz' /
&time integrator='central_difference' /
"""
SIMPLE = "edges='simple' in_plane='free'"
PROPPED = "edges='clamped','simple','simple','simple' in_plane='free'"
CANTILEVER = "edges='clamped','free','simple','simple' in_plane='free'"
HINGED = "edges='simple','free','simple','simple' in_plane='free'"
CURVED = "curvature_radius=0, 0.6"
# Plate, struck point, and the relative difference allowed of peak force, deflection and end of contact. Measured: 2.7,
# 4.1, 6.5, 4.5, 2.1, .9 and 1.3 %.
TRIALS = {
    "simply supported": (SIMPLE, "-0.1, 0.05", 0.04),
    "clamped": ("edges='clamped'", "-0.1, 0.05", 0.07),
    "near the only clamped edge": (PROPPED, "-0.1, 0.05", 0.1),
    "far from it": (PROPPED, "0.1, 0.05", 0.1),
    "curved and clamped": (f"edges='clamped' {CURVED}", "-0.1, 0.05", 0.04),
    "clamped opposite a free edge": (CANTILEVER, "0.1, 0.05", 0.03),
    "hinged opposite a free edge": (HINGED, "0.1, 0.05", 0.03),
}
LABELS = ("expected peak force.*?", "expected deflection over thickness", "expected end of the last contact")
THICKNESS = 16 * 0.13e-3


def main(implam, folder):
    """Compare all trials."""
    passed = True
    for name, (plate, place, allowed) in TRIALS.items():
        deck = folder / name.replace(" ", "_") / "plate.nml"
        deck.parent.mkdir(parents=True, exist_ok=True)
        deck.write_text(DECK.format(plate=plate, place=place), encoding="utf-8")
        printed = run([implam, "check", str(deck)])
        expected = [float(re.search(label + r" +([\d.]+)(?: |$)", printed, re.MULTILINE)[1]) for label in LABELS]
        expected = [value * unit for value, unit in zip(expected, (1, THICKNESS, 1e-3), strict=True)]
        history = run_deck(implam, deck)
        summary = json.loads(next(history.parent.glob("*_summary.json")).read_text(encoding="utf-8"))
        computed = [summary[key] for key in ("peak_force", "largest_deflection", "contact_until")]
        differences = [of_check / of_run - 1 for of_check, of_run in zip(expected, computed, strict=True)]
        print(name, *(f"{value:.4g}" for value in computed), *(f"{100 * value:+.1f} %" for value in differences),
              flush=True)
        passed &= all(abs(value) < allowed for value in differences)
    require(passed, "What the check expects differs too much from the run.")


if __name__ == "__main__":
    main(str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]))
