"""Manual: the number of steps that `implam check` foresees is that of the run, within 5 % without damage, a fifth below
a nose on thin layers, and a third where damage lengthens the contact.
Usage: foreseen_steps.py IMPLAM FOLDER"""

import re
import sys
from pathlib import Path

from solver_runs import require, run

WITHIN, BELOW_NOSE, WITHIN_DAMAGED = 0.05, 0.2, 1 / 3
DECK = """&case name='{name}' units='SI' {case}/
&plate length=100e-3, 100e-3 edges={edges} /
{support}&mesh elements={elements} {mesh}/
&material name='ply' library='im7_8552' /
&laminate materials='ply' {plies} /
{load}&time integrator='central_difference' {time}/
"""
PLAIN = {"case": "", "edges": "'clamped' symmetry='quarter'", "support": "", "elements": "12, 12",
         "mesh": "patch=5e-3 ", "plies": "stacking='[0/90]2s' ply_thickness=0.25e-3", "time": ""}
THIN = "stacking='[0/90]s' ply_thickness=0.2e-3"
LINES = "".join(f"&line at={at}50e-3 component='u' displacement={to}0.1e-3 rise=1e-3 /\n"
                for at, to in (("", "-"), ("-", "")))


def ball(mass, velocity, more=""):
    """The groups of an impactor."""
    return f"&impactor mass={mass} velocity={velocity} radius=8e-3 {more}/\n&indentation law='hertz' /\n"


DECKS = {
    "small": {"load": ball(0.02, 2)},
    "damped": {"load": ball(0.02, 2), "time": "settle=5e-3 "},
    # Membrane forces shorten the contact, after which the plate is damped.
    "deep": {"load": ball(1.0, 3), "time": "settle=3e-3 "},
    "thin": {"load": ball(0.1, 4), "plies": THIN, "time": "settle=5e-3 "},
    "linear": {"load": ball(0.3, 3), "case": "kinematics='linear' ", "time": "settle=2e-3 "},
    "framed": {"load": ball(0.5, 2), "edges": "'free' in_plane='free' symmetry='quarter'",
               "support": "&support window=80e-3, 80e-3 unilateral=.true. bearing='edge' /\n"},
    # The contact limits the step.
    "light": {"load": ball(0.001, 20)},
    "heavy": {"load": ball(2.0, 0.5, "gravity=9.81 "), "time": "settle=2e-3 "},
    # The contact lasts beyond the end of the deck.
    "long": {"load": ball(1.0, 2), "time": "end=1e-3 settle=2e-3 "},
    "cut": {"load": ball(1.0, 2), "time": "end=2e-3 "},
    "pressed": {"load": "&impactor travel=2e-3 radius=8e-3 /\n&indentation law='hertz' /\n",
                "time": "end=10e-3 mass_scaling=10 "},
    "sudden": {"load": "&pressure value=2e4 /\n", "time": "end=4e-3 mass_scaling=1 ", "mesh": ""},
    "compressed": {"load": LINES, "edges": "'simple' in_plane='free'", "elements": "10, 10", "mesh": "",
                   "time": "settle=1e-3 end=4e-3 mass_scaling=10 "},
}
# The contact limits the step, the more the smaller the force is.
NOSE = {
    "nose": {"load": "&delamination below_ply='between_angles' strength_opening=1e9 strength_shear=1e9 /\n"
             + ball(1.0, 1, "contact_area='sphere' "), "time": "mass_scaling=10 "},
}
# Delaminations lengthen the contact: by a fifth below one interface, by a third below six.
MANY = "&delamination below_ply='between_angles' friction=0.3 /\n"
DAMAGED = {
    "three_delaminated": {"load": MANY + ball(2, 2.6), "plies": "stacking='[0/90]s' ply_thickness=1e-3",
                          "time": "mass_scaling=10 "},
    "seven_delaminated": {"load": MANY + ball(2, 2.6), "plies": "stacking='[0/90]2s' ply_thickness=0.5e-3",
                          "time": "mass_scaling=10 "},
}


def main(implam, folder):
    """Check and run each deck."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    wrong = []
    for name, changes in (DECKS | NOSE | DAMAGED).items():
        deck = folder / f"{name}.nml"
        deck.write_text(DECK.format(name=name, **PLAIN | changes), encoding="utf-8")
        foreseen = float(re.search(r"^About (\S+) steps of", run([implam, "check", deck]), re.MULTILINE)[1])
        taken = int(re.search(r"^(\d+) steps by central differences", run([implam, deck, "--output", folder]),
                              re.MULTILINE)[1])
        print(f"{name}: {foreseen:.0f} steps foreseen, {taken} taken, {100 * (foreseen / taken - 1):+.1f} %")
        within = WITHIN_DAMAGED if name in DAMAGED else BELOW_NOSE if name in NOSE else WITHIN
        if abs(foreseen / taken - 1) > within:
            wrong.append(name)
    require(not wrong, f"More or fewer steps than foreseen: {', '.join(wrong)}.")


if __name__ == "__main__":
    main(*sys.argv[1:])
