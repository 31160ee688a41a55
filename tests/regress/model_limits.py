"""Whether passing the model's limits is told once, with its time, and ends a strict run.
Usage: model_limits.py IMPLAM FOLDER"""

import json
import re
import sys
from pathlib import Path

from solver_runs import EXIT_CONVERGENCE, EXIT_DONE, exit_code_of, require, run

# A plate that bends like a membrane, and a contact so soft that the ball would go through.
BEGINNING = """&plate length=0.1, 0.1  edges='clamped'  symmetry='quarter' /
&mesh elements=6, 6  grading=1  patch=5e-3 /
&material name='ply' density=1580  E1=139e9  E2=9.4e9  G12=4.5e9  G23=2.98e9  nu12=0.309 /
&laminate materials='ply'  angles=0, 90, 0  thicknesses=0.25e-3 /
"""
# What is passed: the rest of the deck, the column of the history that tells when, and its limit.
SCENES = {
    "steeper than": "&impactor mass=2  velocity=14  radius=10e-3 /\n&time end=1e-3  step=10e-6 /\n",
    "indentation is deeper": "&impactor mass=0.05  velocity=10 /\n&indentation law='hertz'  k=2e6 /\n"
                             "&time end=1e-3  step=10e-6 /\n",
    "have taken more than 10 %": "&impactor mass=0.005  velocity=10  radius=10e-3 /\n"
                                 "&time end=2e-3  step=50e-6  rho_inf=0 /\n",
}


def main(implam, folder):
    """Each limit in turn."""
    for number, (sentence, rest) in enumerate(SCENES.items()):
        here = Path(folder) / str(number)
        here.mkdir(parents=True, exist_ok=True)
        deck = here / "deck.nml"
        deck.write_text("&case name='limits' /\n" + BEGINNING + rest, "utf-8")
        said = run([implam, deck, "--output", here])
        told = [line for line in said.splitlines() if line.startswith("implam: warning:") and sentence in line]
        require(len(told) == 1, f"'{sentence}' is told {len(told)} times.")
        since = re.search(rf"{sentence}.*?time ([-\d.e]+\d)", told[0])
        closing = [warning for warning in json.loads((here / "limits_summary.json").read_text("utf-8"))["warnings"]
                   if sentence in json.dumps(warning)]
        require(len(closing) == 1, f"The summary doesn't tell of '{sentence}'.")
        deck.write_text("&case name='limits' strict=.true. /\n" + BEGINNING + rest, "utf-8")
        run([implam, deck, "--output", here], EXIT_CONVERGENCE)
        log = (here / "limits.log").read_text("utf-8")
        require(sentence in log, f"The log of a strict run doesn't tell that '{sentence}'.")
        last = (here / "limits_history.csv").read_text("utf-8").splitlines()[-1]
        require(abs(float(last.split(",")[0]) - float(since[1])) <= 1e-3*float(since[1]),
                "The history doesn't end at the limit.")
    return EXIT_DONE


if __name__ == "__main__":
    sys.exit(exit_code_of(main, *sys.argv[1:]))
