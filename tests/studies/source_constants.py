#!/usr/bin/env python3
"""Effect of constants of single modules that no deck can set: each with two other values, on small decks.
Usage: source_constants.py BUILD [CONSTANT ...]     (about five minutes)

BUILD is the folder of a build by Ninja. For each value the source is compiled with it and linked with the objects of
the build; sources and build are unchanged. Prints a row for each constant and deck: for each value the ratio of costs
and the change of the force history as in solution_controls.py. Explicit runs have no cost; their change alone counts.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from solution_controls import ROOT, compared, run

FRONT = [("starter=12e-3", "starter=12e-3 law='front'")]
PENALTY = [("starter=12e-3", "starter=12e-3 law='front' contact='continuous_penalty'")]
SHORT = [("end=4e-3", "end=1e-3")]
# Decks: path and changes.
DECKS = {"chatter": ("verify/chatter.nml", SHORT), "front": ("small/delamination.nml", FRONT),
         "penalty": ("small/delamination.nml", PENALTY), "bands": ("small/crack_bands.nml", []),
         "rounds": ("small/breaking_rounds.nml", []), "nose": ("verify/nose.nml", []),
         "layers": ("small/layers.nml", []), "dent": ("small/dent.nml", []), "cai": ("small/cai_impact.nml", [])}
# Constant: source, value as in the source, other values, decks.
CONSTANTS = {
    "moving_stiffness": ("delamination/surface_contact", "2.0e6_wp", ("2.0e5_wp", "2.0e7_wp"), "chatter front"),
    "max_tail_slope": ("delamination/surface_contact", "1.0e5_wp", ("1.0e4_wp", "1.0e6_wp"), "penalty"),
    "open_fraction": ("delamination/surface_contact", "1.0e-9_wp", ("1.0e-8_wp", "1.0e-10_wp"), "chatter penalty"),
    "distance_tolerance": ("delamination/front_smoothing", "1.0e-6_wp", ("1.0e-5_wp", "1.0e-7_wp"), "chatter front"),
    "held_stiffness": ("interfaces/contact_and_ties", "1.0e5_wp", ("1.0e4_wp", "1.0e6_wp"), "chatter front"),
    "together": ("interfaces/front_growth", "0.95_wp", ("0.9_wp", "0.99_wp"), "chatter front"),
    "elements_crossed": ("interfaces/tie_release", "10", ("5", "20"), "chatter front"),
    "path_tolerance": ("ply_damage/ply_failures", "0.1_wp", ("0.05_wp", "0.2_wp"), "bands rounds"),
    "energy_tolerance": ("ply_damage/ply_failures", "3.0e-4_wp", ("1.5e-4_wp", "6.0e-4_wp"), "bands rounds"),
    "damage_tolerance": ("laminate/crack_bands", "1.0e-14_wp", ("1.0e-12_wp", "1.0e-15_wp"), "bands"),
    "deflection_increment": ("dynamics/impact_coupling", "1.0e-6_wp", ("1.0e-5_wp", "1.0e-7_wp"), "layers nose"),
    "relaxation": ("stepping/contact_updates", "0.2_wp", ("0.1_wp", "0.4_wp"), "nose"),
    "negligible": ("stepping/contact_updates", "1.0e-6_wp", ("1.0e-5_wp", "1.0e-7_wp"), "nose"),
    "lengthening_ratio": ("explicit/central_differences", "0.8_wp", ("0.6_wp", "0.9_wp"), "dent"),
    "stiffened_reserve": ("explicit/central_differences", "1.01_wp", ("1.005_wp", "1.02_wp"), "dent"),
    "slope_reserve": ("explicit/impactor_steps", "2", ("1.5_wp", "4"), "dent cai"),
    "final_ratio": ("explicit/central_difference_energies", "3.0e-4_wp", ("3.0e-3_wp", "3.0e-5_wp"), "dent"),
}


def command(build, target, beginning):
    """The last command of Ninja for a target that contains these words."""
    done = subprocess.run(["ninja", "-C", build, "-t", "commands", target], capture_output=True, text=True, check=True)
    return [line for line in done.stdout.splitlines() if beginning in line][-1]


def variant(build, folder, source, old, new):
    """Path of a program with one line of a source replaced."""
    path = ROOT.parent / "src" / f"{source}.f90"
    text = path.read_text(encoding="utf-8")
    if text.count(old) != 1:
        raise SystemExit(f"{path} has not one {old}.")
    changed = Path(folder) / path.name
    changed.write_text(text.replace(old, new), encoding="utf-8")
    made = f"CMakeFiles/implam_{source.split('/')[0]}.dir/src/{source}.f90"
    words = command(build, f"{made}.o", " -c ").split()
    words = [word.replace("-Jmodules", "-Imodules") for word in words if word != "-fpreprocessed"]
    words = [str(changed) if word.endswith("-pp.f90") else word for word in words]
    words[words.index("-o") + 1] = f"{changed}.o"
    subprocess.run([*words, f"-J{folder}"], cwd=build, check=True)
    link = command(build, "implam", " -o implam ").replace(f" {made}.o ", f" {changed}.o ")
    program = Path(folder) / "implam"
    subprocess.run(link.replace(" -o implam ", f" -o {program} "), shell=True, cwd=build, check=True)
    return program


def deck_text(name):
    """Text of a deck."""
    path, changes = DECKS[name]
    text = (ROOT / path).read_text(encoding="utf-8")
    for old, new in changes:
        text = text.replace(old, new)
    return text


def main():
    """Print a row for each constant and deck."""
    build, wanted, plain = Path(sys.argv[1]).resolve(), sys.argv[2:], {}
    print("| constant | deck | value | other value: cost, change in % |")
    print("|---|---|---|---|")
    for name, (source, value, others, decks) in CONSTANTS.items():
        if wanted and name not in wanted:
            continue
        cells = {deck: [] for deck in decks.split()}
        for other in others:
            with tempfile.TemporaryDirectory() as folder:
                program = variant(build, folder, source, f"{name} = {value}", f"{name} = {other}")
                for deck, row in cells.items():
                    if deck not in plain:
                        plain[deck] = run(build / "implam", deck_text(deck), "")
                    row.append(f"{other[:-3] if other.endswith('_wp') else other}: "
                               f"{compared(run(program, deck_text(deck), ''), plain[deck])}")
        for deck, row in cells.items():
            print(f"| {name} | {deck} | {value.removesuffix('_wp')} | {'; '.join(row)} |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 2 or "--help" in sys.argv:
        raise SystemExit(__doc__)
    main()
