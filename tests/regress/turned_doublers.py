"""A line that turns the edge of a thin plate between thick doublers: the springs of the line are stiff against the
plies there. Usage: turned_doublers.py IMPLAM FOLDER"""

import sys
from pathlib import Path

from solver_runs import exit_code_of, read_history, require, run_deck

DECK = """&case kinematics='linear' units='SI' /
&plate length=0.1, 0.05 edges='clamped', 'free', 'free', 'free' in_plane='free' /
&mesh elements=8, 4 /
&material name='m' E1=161e9 E2=9e9 G12=5.2e9 G13=5.2e9 G23=3.5e9 nu12=0.32 /
&laminate materials='m' angles=0 thicknesses={thickness} /
{doublers}&line at=0.05 component='theta_x' rotation=1e-3 /
&static steps=1 /
"""
DOUBLER = ("&doubler name='{face}' face='{face}' materials='m' stacking='[0]' ply_thickness=2e-3 at=0, 0 "
           "size=0.1, 0.05 /\n")
BOTH = "".join(DOUBLER.format(face=face) for face in ("front", "back"))
PLATES = {"whole": ("4.2e-3", ""), "between doublers": ("0.2e-3", BOTH)}


def trial(implam, folder):
    """The moment is that of a plate of the same thickness without doublers."""
    moments = []
    for name, (thickness, doublers) in PLATES.items():
        deck = Path(folder) / name.replace(" ", "_") / "plate.nml"
        deck.parent.mkdir(parents=True, exist_ok=True)
        deck.write_text(DECK.format(thickness=thickness, doublers=doublers), encoding="utf-8")
        moments.append(read_history(run_deck(implam, deck))["line_force_1"][-1])
        print(f"{name}: moment {moments[-1]:.6g} Nm")
    require(abs(moments[1] / moments[0] - 1) < 1e-9, "The line does not turn by its rotation.")


if __name__ == "__main__":
    raise SystemExit(exit_code_of(trial, *sys.argv[1:]))
