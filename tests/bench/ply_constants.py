#!/usr/bin/env python3
"""What the numbers by which plies follow a step do to two scenes: each is halved and made half as large again or twice.
Usage: ply_constants.py BUILD [NAME ...]     (BUILD: a built preset of this checkout; NAMEs: only these constants)

Changes one constant of the sources at a time, builds, runs, and puts the sources back; about two minutes a row. The
scenes are input/small/crack_bands.nml, without damping, and scene 5 of damaging_scenes.py up to .394 ms, where fibres
have just broken below the patch, with it. Prints of each peak force in N, energy of plies and of integrators in % of
the impact, fibre failures, steps, steps tried again and iterations."""

import csv
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import damaging_scenes

ROOT = Path(__file__).resolve().parents[2]
ROUNDS, FAILURES = "src/dynamics/ply_rounds.f90", "src/ply_damage/ply_failures.f90"
CONTROLLERS, PROBLEMS = "src/dynamics/step_controllers.f90", "src/dynamics/step_problems.f90"
# File, constant, and the values it takes.
CONSTANTS = ((ROUNDS, "most_rounds", ("15", "45")),
             (ROUNDS, "noticed", ("0.5e-4_wp", "2.0e-4_wp")), (ROUNDS, "most_lost", ("0.5e-3_wp", "2.0e-3_wp")),
             (ROUNDS, "most_missed", ("2.0_wp", "8.0_wp")),
             (FAILURES, "path_tolerance", ("0.05_wp", "0.2_wp")), (FAILURES, "noticed", ("1.5e-4_wp", "6.0e-4_wp")),
             (CONTROLLERS, "spare_in_breaking", ("0.125_wp", "0.5_wp")),
             (PROBLEMS, "watched", ("2", "8")), (PROBLEMS, "most_left", ("0.25_wp", "0.75_wp")),
             (PROBLEMS, "most_stalls", ("1", "3")))


def decks():
    """The two scenes."""
    yield (ROOT / "input/small/crack_bands.nml").read_text(encoding="utf-8")
    text = damaging_scenes.deck(damaging_scenes.scene(5))
    yield re.sub(r"(end|every)=[\d.e-]+", r"\1=3.938637e-4", text)


def figures(implam, text):
    """Run a scene; what is printed of it."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scene.nml").write_text(text, encoding="utf-8")
        subprocess.run([implam, folder / "scene.nml", "--output", folder], check=True, capture_output=True)
        with next(folder.glob("*_history.csv")).open(encoding="utf-8") as file:
            rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    last = rows[-1]
    impact = sum(rows[0][key] for key in rows[0] if key.startswith("energy_") and "error" not in key)
    return (f"{max(row['force'] for row in rows):7.0f} {100 * last['energy_ply_damage'] / impact:6.1f} "
            f"{100 * last['energy_algorithmic'] / impact:6.2f} {last['fibre_failures']:4.0f} {last['step']:5.0f} "
            f"{last['rejected']:4.0f} {last['total_iterations']:6.0f}")


def row(build, title):
    """Build and run the scenes as the sources are."""
    subprocess.run(["cmake", "--build", build, "--target", "implam"], check=True, capture_output=True)
    print(f"{title:28}", " | ".join(figures(build / "implam", text) for text in decks()), flush=True)


def main(build, *names):
    """Print a row each."""
    build = Path(build).absolute()
    row(build, "as it is")
    for path, name, values in CONSTANTS:
        if names and name not in names:
            continue
        file = ROOT / path
        kept = file.read_text(encoding="utf-8")
        try:
            for value in values:
                text, found = re.subn(rf"\b{name} = [\w.+-]+", f"{name} = {value}", kept, count=1)
                if not found:
                    sys.exit(f"{path} has no constant {name}.")
                file.write_text(text, encoding="utf-8")
                row(build, f"{name} {value}")
        finally:
            file.write_text(kept, encoding="utf-8")
    subprocess.run(["cmake", "--build", build, "--target", "implam"], check=True, capture_output=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
