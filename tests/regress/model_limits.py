"""Manual: passing a limit of the model is reported once, with its time, and ends a strict run.
Usage: model_limits.py IMPLAM FOLDER"""

import json
import re
import sys
from pathlib import Path

from solver_runs import EXIT_CONVERGENCE, EXIT_DONE, exit_code_of, read_history, require, run

# A plate with membrane action, and a contact so soft that the ball would pass through.
BEGINNING = """&plate length=0.1, 0.1  edges='clamped'  symmetry='quarter' /
&mesh elements=6, 6  grading=1  patch=5e-3 /
&material name='ply' density=1580  E1=139e9  E2=9.4e9  G12=4.5e9  G23=2.98e9  nu12=0.309 /
&laminate materials='ply'  angles=0, 90, 0  thicknesses=0.25e-3 /
"""
# Plies that fail: the ply above with lower strengths, for plates that are to fail or to be perforated.
WEAK = """&plate length=0.1, 0.1  edges='clamped'  symmetry='quarter' /
&mesh elements=6, 6  grading=1  patch=5e-3 /
&material name='ply' density=1580  E1=139e9  E2=9.4e9  G12=4.5e9  G13=4.5e9  G23=2.98e9  nu12=0.309  XT=20e6  XC=20e6
  YT=5e6  YC=25e6  S12=10e6  Sf=50e6  Sm23=10e6 /
&laminate materials='ply'  angles=0, 90, 0  thicknesses=0.25e-3 /
&ply_damage d=100  e=1e-2 /
"""
ZONE = "&delamination below_ply=2  G_c=1  zone=40e-3, 40e-3  starter=15e-3 /\n"
OPEN = """&delamination below_ply=1  G_c=1000  law='cohesive'  zone=96e-3, 96e-3  starter=70e-3
  strength_opening=20e6  strength_shear=40e6 /
"""
# The limit passed, and the rest of the deck.
MODELS = {
    "slope of the plate has exceeded": "&impactor mass=2  velocity=14  radius=10e-3 /\n&time end=1e-3  step=10e-6 /\n",
    "indentation has exceeded the thickness": "&impactor mass=0.05  velocity=10 /\n&indentation law='hertz'  k=2e6 /\n"
                             "&time end=1e-3  step=10e-6 /\n",
    # Indentation of at most .69 mm, less than the thickness.
    "or the radius of the impactor": "&impactor mass=0.005  velocity=2  radius=1e-4 /\n"
                                     "&indentation law='hertz'  k=2e6 /\n&time end=0.5e-3  step=5e-6 /\n",
    "integrators have dissipated more than 1 %": "&impactor mass=0.005  velocity=10  radius=10e-3 /\n"
                                 "&time end=2e-3  step=50e-6  rho_inf=0 /\n",
    # Plies that fail in long load steps.
    "Load steps have dissipated more than 1 %": "&impactor travel=1e-3 radius=10e-3 /\n&static steps=2 /\n",
    "reached the border of its zone": ZONE + "&impactor mass=0.5  velocity=3  radius=10e-3 /\n"
                                      "&time end=1e-3  step=10e-6 /\n",
    "failed over an area as large as the contact": "&impactor mass=2  velocity=5  radius=10e-3 /\n"
                                                 "&time end=1e-3  step=10e-6 /\n",
    "clamped plate has exceeded 3 thicknesses": "&impactor mass=2  velocity=5  radius=10e-3 /\n"
                                                              "&time end=1e-3  step=10e-6 /\n",
    "kinetic energy of the plate has exceeded 5 %": "&line at=0 displacement=2e-4 rise=1e-5 /\n"
                                       "&time integrator='central_difference' end=1e-4 /\n",
    "kinetic energy of motions with scaled inertia has exceeded": "&impactor mass=0.05 velocity=10 radius=10e-3 /\n"
        "&time integrator='central_difference' end=2e-4 mass_scaling=1000 /\n",
    # A ball of 1 g strikes a plate of two sublaminates: 3.9 % on these cells, 2.7 and 1.8 % on cells of a half and a
    # quarter.
    "Contact of surfaces or with the frame has dissipated more than 2 %": OPEN + "&impactor mass=1e-3 velocity=10 "
        "radius=10e-3 /\n&time integrator='central_difference' end=0.3e-3 /\n&output history_every=1e-5 /\n",
    "error of steps has exceeded the tolerance": ZONE + "&impactor mass=2  velocity=5  radius=10e-3 /\n"
                                            "&time end=0.1e-3  step=10e-6 /\n&adapt /\n",
}


AT = re.compile(r"(?:time|load factor) ([-\d.e]*\d)")


def time_of(warning):
    """The time that a warning reports."""
    return float(AT.search(warning)[1])


def main(implam, folder):
    """Test each limit in turn."""
    for number, (sentence, rest) in enumerate(MODELS.items()):
        here = Path(folder) / str(number)
        here.mkdir(parents=True, exist_ok=True)
        deck = here / "deck.nml"
        breaking = ("over an area as large", "3 thicknesses", "&adapt", "travel")
        fails = any(words in sentence + rest for words in breaking)
        plate = WEAK if fails else BEGINNING
        deck.write_text("&case name='limits' /\n" + plate + rest, "utf-8")
        said = run([implam, deck, "--output", here])
        printed = [line for line in said.splitlines() if line.startswith("implam: warning:") and sentence in line]
        require(len(printed) == 1, f"'{sentence}' is printed {len(printed)} times.")
        since = time_of(printed[0])
        closing = [warning for warning in json.loads((here / "limits_summary.json").read_text("utf-8"))["warnings"]
                   if sentence in json.dumps(warning)]
        require(len(closing) == 1, f"The summary does not report '{sentence}'.")
        times = [time_of(line) for line in said.splitlines() if line.startswith("implam: warning:") and AT.search(line)]
        history = read_history(here / "limits_history.csv")
        for time, passed in zip(history["time"], history["limits_passed"], strict=True):
            require(passed == sum(at <= time*(1 + 1e-3) for at in times), f"The history counts {passed} at {time}.")
        # A strict run ends at the first limit that it passes.
        deck.write_text("&case name='limits' strict=.true. /\n" + plate + rest, "utf-8")
        run([implam, deck, "--output", here], EXIT_CONVERGENCE)
        log = (here / "limits.log").read_text("utf-8")
        require(sentence in log or min(times) < since, f"The log of a strict run does not report '{sentence}'.")
        last = read_history(here / "limits_history.csv")["time"][-1]
        require(abs(last - min(times)) <= 1e-3*last, "The history does not end at the limit.")
    return EXIT_DONE


if __name__ == "__main__":
    sys.exit(exit_code_of(main, *sys.argv[1:]))
