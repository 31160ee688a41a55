"""Size of the stressed volume: a beam in three-point bending fails at the force of the closed form.
Usage: stressed_volume.py IMPLAM FOLDER

Its outer fibres have the strength XT (2 (m + 1)^2 V0/V)^(1/m), V between the supports (theory (M30)); the force is 2
b h^2/(3 L) times that. In load steps and by central differences, where the load is so slow that inertia adds little."""

import sys
from pathlib import Path

from solver_runs import exit_code_of, read_history, require, run_deck, write_deck

SPAN, WIDTH, THICKNESS, XT, MODULUS, REFERENCE = 40e-3, 10e-3, 2e-3, 2080e6, 20, 3.75e-6
STRENGTH = XT*(2*(MODULUS + 1)**2*REFERENCE/(SPAN*WIDTH*THICKNESS))**(1/MODULUS)
FORCE = 2*WIDTH*THICKNESS**2/(3*SPAN)*STRENGTH
SLOW = "&time  integrator='central_difference'  end=1e-3 /"


def first_failure(history):
    """Return the forces before and at the first failure of fibres."""
    for row, energy in enumerate(history["energy_fibre_tension"]):
        if energy > 0:
            return [-history["line_force_1"][at] - history["line_force_2"][at] for at in (row - 1, row)]
    return [0.0, 0.0]


def check(implam, folder):
    """Run both."""
    for name, tolerance in (("steps", 0.01), ("explicit", 0.02)):
        deck = write_deck(Path(folder) / name, "stressed_volume.nml",
                          ["mesh%elements=22,2"] if name == "explicit" else [])
        if name == "explicit":
            text = deck.read_text(encoding="utf-8")
            text = text[:text.index("&static")].replace("displacement=3.6e-3", "displacement=3.6e-3  rise=0.5e-3")
            deck.write_text(text + SLOW + "\n", encoding="utf-8")
        before, failing = first_failure(read_history(run_deck(implam, deck)))
        print(f"{name}: fibres fail between {before:.0f} and {failing:.0f} N; closed form {FORCE:.0f} N")
        require((1 - tolerance)*FORCE < failing and before < (1 + tolerance)*FORCE,
                f"{name}: fibres fail between {before} and {failing} N, not at {FORCE} N.")


if __name__ == "__main__":
    sys.exit(exit_code_of(check, *sys.argv[1:]))
