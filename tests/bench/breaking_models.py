#!/usr/bin/env python3
"""Random models with failing plies: energy dissipated by the integrators, and its change with half the step length.
Usage: breaking_models.py IMPLAM [COUNT]

Prints a line for each run: model, 1 for half the step, energy_algorithmic at the end, its minimum and maximum,
energy_ply_damage (all in % of the impact energy), fibre failures, steps, rejected steps, peak force."""

import csv
import random
import subprocess
import sys
import tempfile
from pathlib import Path

LAYUPS = ("0,90,90,0", "0,90,0,90,90,0,90,0", "90,0,0,90", "0,0,90,90,90,90,0,0", "0,90,0", "90,0,90,0,0,90,0,90")


def deck(seed, part):
    """Return the deck of a model with a fraction of its step."""
    chance = random.Random(seed)
    angles = chance.choice(LAYUPS)
    thickness = chance.uniform(1e-3, 3e-3)
    mass = chance.uniform(0.05, 0.8)
    energy = chance.uniform(2, 6) * (thickness / 1e-3)**1.5 * chance.choice([0.6, 1, 1.5])
    end = min(max(3.2 * (mass / (4e6 * thickness / 2e-3))**0.5, 480e-6), 3e-3)
    return f"""&case name='model' /
&plate length={chance.uniform(0.03, 0.1)},{chance.uniform(0.03, 0.08)} edges='{chance.choice(["clamped", "simple"])}'
  in_plane='{chance.choice(["fixed", "free"])}' symmetry='quarter' /
&mesh elements={chance.randint(6, 10)},{chance.randint(6, 10)} grading={chance.uniform(1, 3)}
  patch={chance.uniform(2e-3, 5e-3)} /
&material name='T700/M21' density=1600 E1=130e9 E2=7.7e9 G12=4.8e9 G23=3.8e9 nu12=0.30 alpha1=-0.3e-6 alpha2=28e-6
  XT=2080e6 XC=1250e6 YT=60e6 YC=290e6 S12=110e6 G_ft={chance.uniform(60e3, 150e3)} G_fc={chance.uniform(20e3, 80e3)}
  G_mt={chance.uniform(250, 700)} G_mc={chance.uniform(800, 2200)} /
&laminate materials='T700/M21' angles={angles} thicknesses={thickness / (1 + angles.count(","))} /
&impactor mass={mass} velocity={(2 * energy / mass)**0.5} radius={chance.uniform(5e-3, 12e-3)} /
&indentation alpha_cr=80.3e-6 /
&ply_damage criteria='{chance.choice(["hou", "hashin", "puck"])}' /
{chance.choice(["", "&thermal delta_T=-120 /"])}
&time end={end} step={part * chance.choice([8e-6, 16e-6])} integrator='generalized_alpha' /
&output fields_every={end} /
"""


def figures(implam, folder, seed, part):
    """Run a model; return the printed figures."""
    path = Path(folder) / "model.nml"
    path.write_text(deck(seed, part), encoding="utf-8")
    subprocess.run([implam, path, "--output", folder], check=True, capture_output=True)
    with (Path(folder) / "model_history.csv").open(encoding="utf-8") as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    impact = max(row["energy_impactor"] for row in rows)
    lost = [100 * row["energy_algorithmic"] / impact for row in rows]
    last = rows[-1]
    return (lost[-1], min(lost), max(lost), 100 * last["energy_ply_damage"] / impact, last["fibre_failures"],
            last["step"], last["rejected"], max(row["force"] for row in rows))


def main(implam, count="20"):
    """Run the models."""
    worst = 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(int(count)):
            for half, part in enumerate((1, 0.5)):
                found = figures(implam, folder, seed, part)
                worst = max(worst, -found[1], found[2])
                print(f"{seed:3d} {half}", " ".join(f"{figure:8.2f}" for figure in found), flush=True)
    print(f"worst {worst:.2f} %")


if __name__ == "__main__":
    if len(sys.argv) < 2 or "--help" in sys.argv:
        raise SystemExit(__doc__)
    main(*sys.argv[1:])
