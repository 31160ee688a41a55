"""Equal stiffness: a sandwich with and without interfaces at or in its core, .1 %.
Usage: sandwich_layers.py IMPLAM FOLDER

Shear stresses of the core between its skins are nearly uniform: 5/6 of its stiffness makes the panel 10 % softer.
Halves with a free face each make it 11 % stiffer."""

import sys
from pathlib import Path

from solver_runs import exit_code_of, read_history, require, run_deck

PANEL = """&case name='panel' kinematics='linear' /
&plate length=0.4,0.4 edges='simple' in_plane='free' symmetry='quarter' /
&mesh elements=12,12 patch=20e-3 /
&material name='cfrp' density=1600 E1=70e9 E2=70e9 G12=5e9 G13=4.5e9 G23=4.5e9 nu12=.05 /
&material name='core' density=75 E=80e6 nu=.33 /
&laminate materials='cfrp','core','cfrp' angles=0,0,0 thicknesses=1e-3,20e-3,1e-3 /
&pressure value=1e3 /
&static steps=1 /
"""
INTERFACES = """&delamination below_ply=1,2 law='cohesive' strength_shear=1e9 strength_opening=1e9 G_Ic=1e6 G_IIc=1e6
  eta=2 zone=0.4,0.4 /
"""


def check(implam, folder):
    """Compare the deflection under pressure."""
    halves = PANEL.replace("'core',", "'core','core',").replace("0,0,0", "0,0,0,0")
    halves = halves.replace("20e-3,1e-3", "10e-3,10e-3,1e-3")
    found = {}
    for name, text in (("one", PANEL), ("layers", PANEL + INTERFACES),
                       ("halves", halves + INTERFACES.replace("1,2 ", "2 "))):
        (folder / name).mkdir(parents=True, exist_ok=True)
        deck = folder / name / "panel.nml"
        deck.write_text(text, encoding="utf-8")
        found[name] = read_history(run_deck(implam, deck))["deflection"][-1]
    for name in ("layers", "halves"):
        ratio = found[name]/found["one"]
        print(f"{name}: the deflection is {ratio:.4f} of that without")
        require(abs(ratio - 1) < 1e-3, "Layers change the stiffness of the panel.")


if __name__ == "__main__":
    raise SystemExit(exit_code_of(check, sys.argv[1], Path(sys.argv[2])))
