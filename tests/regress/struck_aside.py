"""Navier's series: deflection of a plate under an eccentric impact, .5 %, its mirror image 1e-8.
Usage: struck_aside.py IMPLAM FOLDER

Navier's series for a simply supported plate under a force on a square at any position, quasi-static as in frame.py; and
the plate with the mirrored struck point, whose response must be the same."""

import math
import sys
from pathlib import Path

from solver_runs import exit_code_of, read_history, require, run_deck

LENGTH, THICKNESS, MODULUS, POISSON, PATCH = (0.3, 0.2), 2e-3, 70e9, 0.3, 8e-3
AT = (0.06, -0.03)
TOLERANCE, MIRROR_TOLERANCE = 5e-3, 1e-8
DECK = """&case name='aside' kinematics='linear' /
&plate length=0.3, 0.2 edges='simple' /
&mesh elements=20, 17 patch=8e-3 {mesh} /
&material name='a' density=2700 E=70e9 nu=0.3 /
&laminate materials='a' angles=0 thicknesses=2e-3 /
&impactor mass=2000 velocity=0.01 radius=8e-3 at={at} /
&indentation law='hertz' k=1e9 /
&time end=0.2 step=4e-3 integrator='generalized_alpha' rho_inf=0 /
&adapt on=.false. /
"""


def navier_stiffness():
    """Force over the mean deflection of the patch, for Kirchhoff's plate."""
    bending = MODULUS * THICKNESS**3 / 12 / (1 - POISSON**2)

    def mean(number, axis):
        """Mean of the sine over the patch."""
        wave = number * math.pi / LENGTH[axis]
        return math.sin(wave * (AT[axis] + LENGTH[axis] / 2)) * math.sin(wave * PATCH / 2) / (wave * PATCH / 2)

    series = sum((mean(m, 0) * mean(n, 1))**2 / ((m / LENGTH[0])**2 + (n / LENGTH[1])**2)**2
                 for m in range(1, 120) for n in range(1, 120))
    return bending * math.pi**4 * LENGTH[0] * LENGTH[1] / 4 / series


def history_at(implam, folder, at, mesh):
    """Run the plate with an impact at a given point."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "deck.nml"
    path.write_text(DECK.format(at=f"{at[0]}, {at[1]}", mesh=mesh), encoding="utf-8")
    return read_history(run_deck(implam, path))


def try_places(implam, folder):
    """Run all trials."""
    passed = True
    for name, mesh in (("patch", ""), ("core", "core=40e-3, 30e-3 cell=8e-3")):
        history = history_at(implam, Path(folder) / name, AT, mesh)
        late = [row for row, force in enumerate(history["force"]) if force > 0.8 * max(history["force"])]
        stiffness = sum(history["force"][row] for row in late) / sum(history["patch_deflection"][row] for row in late)
        difference = stiffness / navier_stiffness() - 1
        print(f"{name}: {stiffness:.1f} N/m, {difference:+.2%} from Navier's series", flush=True)
        passed &= abs(difference) <= TOLERANCE
        image = history_at(implam, Path(folder) / (name + "_image"), (-AT[0], -AT[1]), mesh)
        largest = max(abs(one - other) for one, other in zip(history["force"], image["force"], strict=True))
        print(f"{name}: its image differs by {largest / max(history['force']):.1e} of the force", flush=True)
        passed &= largest <= MIRROR_TOLERANCE * max(history["force"])
    require(passed, "The stiffness under an eccentric impact is wrong, or the image differs.")


if __name__ == "__main__":
    raise SystemExit(exit_code_of(try_places, *sys.argv[1:]))
