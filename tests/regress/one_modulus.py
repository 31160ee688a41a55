"""The same run in another way: runs without E1c and with E1c = E1, to the last bit.
Usage: one_modulus.py IMPLAM FOLDER

Explicit and implicit steps of softening plies, load steps, and sudden failure."""

import filecmp
import sys
from pathlib import Path

from solver_runs import exit_code_of, require, run_deck, write_deck

EXPLICIT = "time%integrator='central_difference'"
MODELS = {"explicit": ("../small/crack_bands.nml", [EXPLICIT, "time%end=80e-6"], "130e9"),
          "implicit": ("../small/crack_bands.nml", ["time%end=80e-6"], "130e9"),
          "sudden": ("../small/breaking_rounds.nml", ["time%end=50e-6"], ""),
          "steps": ("stressed_volume.nml", ["mesh%elements=22, 2", "static%steps=8"], "130e9")}


def check(implam, folder):
    """Compare histories."""
    for name, (source, settings, modulus) in MODELS.items():
        plain = write_deck(Path(folder) / name / "without", source, settings)
        if not modulus:
            text = plain.read_text(encoding="utf-8")
            modulus = text.split("E1=", 1)[1].split()[0].rstrip(",")
        equal = write_deck(Path(folder) / name / "equal", source, [*settings, f"material%E1c={modulus}"])
        other = write_deck(Path(folder) / name / "other", source, [*settings, f"material%E1c={0.8 * float(modulus)}"])
        histories = [run_deck(implam, deck) for deck in (plain, equal, other)]
        require(filecmp.cmp(histories[0], histories[1], shallow=False), f"{name}: E1c = E1 changes the history.")
        require(not filecmp.cmp(histories[0], histories[2], shallow=False), f"{name}: E1c has no effect.")
        print(f"{name}: the same to the last bit with E1c = E1", flush=True)


if __name__ == "__main__":
    sys.exit(exit_code_of(check, *sys.argv[1:]))
