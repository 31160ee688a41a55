"""The same equilibrium in another way: plates with E1c far below or above E1, in 1 and in 3 load steps.
Usage: two_moduli.py IMPLAM FOLDER

With linear strains the energy is convex, so that there is one equilibrium under residual stress and loads, and
Newton's method finds it in a few corrections for any E1c."""

import sys
from pathlib import Path

from solver_runs import exit_code_of, read_history, require, run_deck

PLATE = """&case kinematics='linear' /
&plate length=.08,.1 edges='simple','free','clamped','simple' in_plane='tangential' /
&mesh elements=8,10 patch=10e-3 /
&material name='ply' density=1600 E1=130e9 E1c={modulus} E2=12e9 G12=4.8e9 G13=5.2e9 G23=3e9 nu12=.1
  alpha1=1e-6 alpha2=28e-6 /
&laminate materials='ply' angles=45,90,15,15,90,45 thicknesses=.2e-3,.3e-3,.5e-3,.3e-3,.3e-3,.3e-3 /
&static steps={steps} /
"""
CURED = "&thermal delta_T=-160 /\n"
LOADS = {"pressed": "&pressure value=2e4 /\n",
         "cured": CURED + "&pressure value=2e4 /\n",
         "indented": CURED + "&impactor travel=.5e-3 radius=8e-3 /\n&indentation law='hertz' /\n",
         "bonded": CURED + "&pressure value=1e4 /\n&delamination below_ply=3 law='cohesive' G_Ic=500 G_IIc=1500 "
                           "strength_opening=60e6 strength_shear=90e6 zone=.04,.04 /\n"}
MODULI = {"quarter": 32.5e9, "half": 65e9, "twice": 260e9}
# Usual are 4; the signs of a few sub-plies change in each.
MAX_CORRECTIONS = 12


def check(implam, folder):
    """Compare the deflections."""
    for load, groups in LOADS.items():
        for name, modulus in MODULI.items():
            found = []
            for steps in (1, 3):
                run = folder / f"{load}_{name}_{steps}"
                run.mkdir(parents=True, exist_ok=True)
                deck = run / "plate.nml"
                deck.write_text(PLATE.format(modulus=modulus, steps=steps) + groups, encoding="utf-8")
                history = read_history(run_deck(implam, deck))
                require(history["rejected"][-1] == 0, f"{run.name}: a load step was rejected.")
                require(max(history["iterations"]) <= MAX_CORRECTIONS, f"{run.name}: too many corrections.")
                found.append(history["deflection"][-1])
            print(f"{load}, E1c {name}: {found[0]:.6e} in 1 step, {found[1]:.6e} in 3, "
                  f"{max(history['iterations']):.0f} corrections", flush=True)
            require(abs(found[1] - found[0]) < 1e-5*abs(found[0]), f"{load}, {name}: another equilibrium in 3 steps.")


if __name__ == "__main__":
    raise SystemExit(exit_code_of(check, sys.argv[1], Path(sys.argv[2])))
