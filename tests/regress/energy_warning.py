"""Manual: runs that create energy or load the plate too fast warn of it, and others do not.
Usage: energy_warning.py IMPLAM FOLDER"""

import json
import re
import sys
from pathlib import Path

from solver_runs import read_history, require, run

WARNING = "created more than 1 %"
BEGINNING = """&case name='pressed' /
&plate length=0.04, 0.04  edges='clamped'  symmetry='quarter' /
&mesh elements=6, 6  grading=1 /
&material name='ply' density=1580  E1=139e9  E2=9.4e9  G12=4.5e9  G23=2.98e9  nu12=0.309 /
&laminate materials='ply'  angles=0, 90, 0  thicknesses=0.6666667e-3 /
&delamination below_ply=2  G_c=400  zone=33e-3, 20e-3  starter=13e-3 /
"""
TURNED = """&case name='turned' /
&plate length=0.1, 0.02 edges='clamped', 'free', 'free', 'free' in_plane='fixed' /
&mesh elements=20, 4 /
&material name='al' density=2700 E=70e9 nu=0.3 /
&laminate materials='al' angles=0 thicknesses=2e-3 /
&line at=0.05 component='theta_x' rotation=0.02 rise=2e-4 /
&time end=1e-3 step=1e-5 integrator='generalized_alpha' rho_inf=0.8 /
"""
# Slow motion from rest: the energy of the first steps is far below that at the end.
SLOW = """&case name='slow' strict=.true. /
&plate length=0.04, 0.03 edges='clamped' symmetry='quarter' /
&mesh elements=4, 4 patch=4e-3 /
&material name='ply' density=1600 E1=130e9 E2=7.7e9 G12=4.8e9 G23=3.8e9 nu12=0.3 /
&laminate materials='ply' stacking='[0/90]s' ply_thickness=0.4e-3 /
&impactor travel=1e-4 radius=8e-3 /
&indentation law='hertz' /
&time integrator='central_difference' end=1e-3 mass_scaling=10 /
"""
# Gravity from rest: the energy of the first steps is far below that under the full weight.
LAID = SLOW.replace("travel=1e-4", "mass=0.2 velocity=0 gravity=9.81").replace("end=1e-3", "end=0.1e-3")
# The first step of a sudden load dissipates a quarter of its work, which is a millionth of that at the end.
SUDDEN = re.sub(r"&impactor.*\n&indentation.*\n", "&pressure value=1e5 /\n", SLOW).replace(" patch=4e-3", "")
# A line with a rise of a tenth of the run, far shorter than a period, that is then constant.
SET_IN = TURNED.replace("rise=2e-4", "history='fixed' rise=1e-5").replace("end=1e-3", "end=1e-4")
# Free vibration about the deflection under a sudden load: work and energies return to zero after each period.
SINE = """&case name='sine' units='SI' kinematics='linear' strict=.true. /
&plate length=0.1, 0.1 edges='simple' in_plane='free' symmetry='quarter' /
&mesh elements=4, 4 grading=1 /
&material name='al' density=2700 E=70e9 nu=0.3 /
&laminate materials='al' angles=0 thicknesses=2e-3 /
&pressure value=1e2 distribution='sine' /
&time integrator='central_difference' end=4e-3 mass_scaling=1 /
"""
PERIOD = 1 / 966.73  # of the first mode, Mindlin's theory
FREE = {
    "sine": SINE,
    # Rows, and with them checks, at multiples of the period, where all energies are zero.
    "rare": SINE + f"&output history_every={PERIOD:.6e} /\n",
    # Deflections of a fifth of the thickness: energies of terms that are not linear remain.
    "steep": SINE.replace("linear", "von_karman").replace("1e2", "2e3"),
    "graded": SINE.replace("grading=1", "grading=20 patch=2e-3").replace("elements=4, 4", "elements=8, 8"),
    # The same by implicit steps of a fiftieth of the period.
    "implicit": SINE.replace("integrator='central_difference'", f"integrator='newmark' step={PERIOD / 50:.6e}")
                    .replace(" mass_scaling=1", ""),
    # A force along a line, of which nothing remains after a period, either.
    "line": SINE.replace("&pressure value=1e2 distribution='sine' /",
                         "&line at=0 component='w' force=1 history='fixed' /"),
}
# A compression of a plate that is damped before: the work of its supports does not count.
PRESSED = """&case name='pressed' units='SI' /
&plate length=60e-3, 40e-3 edges='simple' in_plane='free' /
&mesh elements=8, 8 grading=1 patch=6e-3 /
&material name='ply' density=1600 E1=130e9 E2=7.7e9 G12=4.8e9 G13=4.8e9 G23=3.8e9 nu12=0.30 /
&laminate materials='ply' stacking='[0/90]s' ply_thickness=0.6e-3 /
&line at=30e-3 component='u' displacement=-0.05e-3 rise=1.5e-3 /
&line at=-30e-3 component='u' displacement=0.05e-3 rise=1.5e-3 /
&time integrator='central_difference' settle=0 end=3e-3 mass_scaling=10 /
"""
SHARE = (2e-4, 2e-3)  # bounds of the largest kinetic energy over work


def check_free_vibration(implam, folder):
    """Free vibration ends neither as unstable nor with a warning, and returns to rest after a period."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, deck in FREE.items():
        (folder / f"{name}.nml").write_text(deck.replace("'sine' units", f"'{name}' units"), encoding="utf-8")
        run([implam, folder / f"{name}.nml", "--output", folder])
        if name in ("rare", "line"):
            continue
        rows = read_history(folder / f"{name}_history.csv")
        near = [i for i, time in enumerate(rows["time"]) if 0.6 * PERIOD < time < 1.4 * PERIOD]
        back = min(near, key=lambda i: rows["deflection"][i])
        tolerance = 0.06 if name == "steep" else 0.01
        require(abs(rows["time"][back] / PERIOD - 1) < tolerance, f"{name}: back at {rows['time'][back]} s.")
        require(abs(rows["deflection"][back]) < 0.02 * max(rows["deflection"]), f"{name} is not back at rest.")


def check_compression_at_rest(implam, folder):
    """With and without `settle` the kinetic energy of a slow compression is a small fraction of the work."""
    folder.mkdir(parents=True, exist_ok=True)
    for rest_time in ("0", "1e-3"):
        deck = PRESSED.replace("settle=0 end=3e-3", f"settle={rest_time} end={3e-3 + float(rest_time):.6g}")
        (folder / "pressed.nml").write_text(deck, encoding="utf-8")
        printed = run([implam, folder / "pressed.nml", "--output", folder])
        share = json.loads((folder / "pressed_summary.json").read_text(encoding="utf-8"))["kinetic_share"]
        require("too fast" not in printed and SHARE[0] < share < SHARE[1], f"settle={rest_time}: {share} of the work.")
    # Twenty times as fast it is too fast, with `settle`, too.
    deck = PRESSED.replace("settle=0 end=3e-3", "settle=1e-3 end=1.15e-3").replace("rise=1.5e-3", "rise=0.075e-3")
    (folder / "pressed.nml").write_text(deck, encoding="utf-8")
    printed = run([implam, folder / "pressed.nml", "--output", folder])
    require("too fast for a quasi-static test" in printed, "There is no warning of a fast compression after settle.")


def warnings_of(implam, folder, history, time):
    """Return the number of warnings of created energy of a run under pressure."""
    folder.mkdir(parents=True, exist_ok=True)
    deck = folder / "pressed.nml"
    deck.write_text(f"{BEGINNING}&pressure value=2e6 history='{history}' /\n&time end=1e-3 {time} /\n", "utf-8")
    lines = run([implam, deck, "--output", folder]).splitlines()
    return sum(line.startswith("implam: warning: ") and WARNING in line for line in lines)


def main(implam, folder):
    """Loads applied gradually or at once, and steps that are too long."""
    folder = Path(folder)
    # Up to 10 % of the energy in the first step, which is a millionth of that at the end.
    for step in ("2e-6", "10e-6", "50e-6"):
        printed = warnings_of(implam, folder / f"ramp_{step}", "ramp", f"step={step}")
        require(printed == 0, f"A ramp with steps of {step} s warns without energy created.")
    # The first step creates 4 %, the second dissipates more.
    require(warnings_of(implam, folder / "step", "step", "step=10e-6") == 0, "A sudden load warns in its first step.")
    # Steps of half a period without damping.
    require(warnings_of(implam, folder / "long", "step", "step=50e-6 rho_inf=1") == 1, "Long steps do not warn once.")
    # A rotation with a smooth start: the first steps dissipate more than 1 % of an energy far below that at the end.
    turned = folder / "turned"
    turned.mkdir(parents=True, exist_ok=True)
    (turned / "turned.nml").write_text(TURNED, encoding="utf-8")
    printed = run([implam, turned / "turned.nml", "--output", turned])
    require("of the energy" not in printed, "A line with a smooth start warns of the energy of its first steps.")
    slow = folder / "slow"
    slow.mkdir(parents=True, exist_ok=True)
    (slow / "slow.nml").write_text(SLOW, encoding="utf-8")
    printed = run([implam, slow / "slow.nml", "--output", slow])
    require("of the energy" not in printed, "A travel with a smooth start warns of the energy of its first steps.")
    (slow / "slow.nml").write_text(LAID, encoding="utf-8")
    run([implam, slow / "slow.nml", "--output", slow])
    (slow / "slow.nml").write_text(SUDDEN, encoding="utf-8")
    run([implam, slow / "slow.nml", "--output", slow])
    (turned / "turned.nml").write_text(SET_IN, encoding="utf-8")
    printed = run([implam, turned / "turned.nml", "--output", turned])
    require("the motion is too fast for a quasi-static test" in printed, "There is no warning of a fast line.")
    check_free_vibration(implam, folder / "free")
    check_compression_at_rest(implam, folder / "rest")


if __name__ == "__main__":
    main(*sys.argv[1:])
