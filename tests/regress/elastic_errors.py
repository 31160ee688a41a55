"""Manual, estimated errors: an impact that stays elastic has those of the preliminary elastic impact, confirmed by
cells of half the side and by inertia that is not scaled; where interfaces or plies fail, in the same deck, none are
given, as they would be too small.
Usage: elastic_errors.py IMPLAM FOLDER"""

import json
import re
from sys import argv, exit

from solver_runs import exit_code_of, require, run, write_deck

# Forces of runs with and without damage by less than this fraction: the peak alone does not distinguish them.
SAME_PEAK = 0.1
# The estimate has a safety factor against errors that cancel; in random elastic impacts it is exceeded by 1.35 at most.
AT_MOST = 1.35
DECK = """&case name='{name}' units='SI' kinematics='linear' /
&plate length=50e-3, 50e-3 edges='simple' symmetry='quarter' /
&mesh elements={elements} grading=1 patch=4e-3 /
&material name='ply' library='t300_976' {material}/
&laminate materials='ply' angles=5*0, 5*90, 5*0 thicknesses=0.1333e-3 /
&impactor mass=0.3 velocity=4 radius=8e-3 /
&indentation law='hertz' /
{damage}&time integrator='central_difference' end=0.25e-3 mass_scaling={scaling} /
"""
WEAK = "&delamination below_ply=10 G_Ic=280 G_IIc=790 strength_opening=12e6 strength_shear=25e6 /\n"
INTACT = WEAK.replace("12e6", "12e9").replace("25e6", "25e9")


def summary_of(implam, folder, name, damage, elements="12, 12", material="", scaling=1):
    """Run the deck; return its summary and the line of its peak force."""
    deck = folder / f"{name}.nml"
    deck.write_text(DECK.format(name=name, elements=elements, material=material, damage=damage,
                                scaling=scaling), encoding="utf-8")
    printed = run([implam, deck, "--output", folder])
    line, = re.findall(r"^  peak force .*", printed, re.MULTILINE)
    return json.loads((folder / f"{name}_summary.json").read_text(encoding="utf-8")), line


def check(implam, folder):
    """Compare the runs."""
    folder = write_deck(folder, "karas.nml").parent
    plain, line = summary_of(implam, folder, "plain", "")
    fine, _ = summary_of(implam, folder, "fine", "", elements="24, 24")
    errors = plain["estimated_errors"]
    require(errors["source"] == "elastic" and "+-" in line, f"Elastic: {errors}, {line}")
    change = abs(plain["peak_force"] - fine["peak_force"])
    print(f"elastic: {plain['peak_force']:.5g} +- {errors['peak_force']:.2g}, half the cells {fine['peak_force']:.5g}")
    require(change <= AT_MOST * errors["peak_force"], f"Half the cells change the peak by {change}, {errors}.")
    scaled, _ = summary_of(implam, folder, "scaled", "", scaling=10)
    change, error = (abs(plain["peak_force"] - scaled["peak_force"]), scaled["estimated_errors"]["peak_force"])
    print(f"inertia scaled by 10: {scaled['peak_force']:.5g} +- {error:.2g}")
    require(change <= AT_MOST * error, f"Scaled inertia changes the peak by {change}, its error is {error}.")
    intact, line = summary_of(implam, folder, "intact", INTACT)
    require(intact["delaminated_area"] == 0 and intact["estimated_errors"]["source"] == "elastic" and "+-" in line,
            f"An interface that does not fail: {intact['estimated_errors']}, {line}")
    for name, damage, material, count in (
            ("delaminated", WEAK, "", "delaminated_area"),
            ("cracked", "&ply_damage criteria='hashin' /\n", "YT=30e6 G_ft=60e3 G_fc=40e3 G_mt=280 G_mc=800 ",
             "matrix_cracks")):
        found, line = summary_of(implam, folder, name, damage, material=material)
        print(f"{name}: {count} {found[count]:.3g}, {line.strip()}, errors by {found['estimated_errors']['source']}")
        require(found[count] > 0, f"{name}: there is no damage.")
        require(abs(found["peak_force"] / plain["peak_force"] - 1) < SAME_PEAK, f"{name}: another peak force.")
        given = {key: value for key, value in found["estimated_errors"].items() if key != "source"}
        require(found["estimated_errors"]["source"] == "none" and "+-" not in line and
                all(value is None for value in given.values()), f"{name}: {found['estimated_errors']}, {line}")


if __name__ == "__main__":
    from pathlib import Path
    exit(exit_code_of(check, argv[1], Path(argv[2])))
