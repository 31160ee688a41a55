"""Limiting cases of clamps with a force: rigid clamps and no clamps. Usage: clamp_force.py IMPLAM FOLDER

Four clamps with a large force act as rigid ones, four with a very small force let the plate lift off as without clamps,
and those between hold it with their force while it is off the frame, and never with more. Energy is conserved with all
of them."""

import sys
from pathlib import Path

from solver_runs import read_history, require, run_deck

DECK = """&case name='clamped' /
&plate length=0.150,0.100 edges='free' symmetry='point' in_plane='free' /
&support window=0.125,0.075 unilateral=.true. /
{clamps}
&mesh elements=12,16 patch=4e-3 /
&material name='ply' density=1600 E1=130e9 E2=7.7e9 G12=4.8e9 G13=4.8e9 G23=3.8e9 nu12=0.30 nu23=0.35 /
&laminate materials='ply' angles=2*0,2*45,2*90,4*-45,2*90,2*45,2*0 thicknesses=0.26e-3 /
&impactor mass=2 velocity=2.55 radius=8e-3 /
&indentation law='hertz' k=9.18e8 /
&time end=1e-3 step=10e-6 /
&adapt on=.false. /
&solver tolerance=1e-8 /
"""
POINTS = "clamps=50e-3,44e-3, -50e-3,44e-3, 50e-3,-44e-3, -50e-3,-44e-3"
FORCE = 200.0
WAYS = {"none": "", "rigid": f"&support {POINTS} /", "hard": f"&support {POINTS} clamp_force=1e5 /",
        "light": f"&support {POINTS} clamp_force=1e-3 /", "some": f"&support {POINTS} clamp_force={FORCE} /"}
SAME, CONSERVED = 5e-6, 1e-7  # of the largest force; of the impact. Measured: 1e-6 and 3e-9


def apart(one, other):
    """Return the difference of the forces of two runs, over the largest."""
    require(len(one["force"]) == len(other["force"]), "Steps differ.")
    return max(abs(a - b) for a, b in zip(one["force"], other["force"], strict=True)) / max(one["force"])


def main(implam, folder):
    """Run all variants."""
    runs = {}
    for name, clamps in WAYS.items():
        path = Path(folder) / name / "deck.nml"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(DECK.format(clamps=clamps), encoding="utf-8")
        runs[name] = read_history(run_deck(implam, path))
    lost = max(abs(value) for run in runs.values() for value in run["energy_error"]) / (2 * 2.55**2 / 2)
    held = min(runs["some"]["reaction_2"])
    figures = {"hard from rigid": apart(runs["rigid"], runs["hard"]),
               "light from none": apart(runs["none"], runs["light"]),
               "rigid from none": apart(runs["rigid"], runs["none"]),
               "some from none": apart(runs["some"], runs["none"]),
               "largest hold over the force": -held / (4 * FORCE), "energy error": lost}
    for name, value in figures.items():
        print(f"{name}: {value:.3e}")
    require(figures["hard from rigid"] < SAME, "Clamps with a large force differ from rigid ones.")
    require(figures["light from none"] < SAME, "Clamps with a small force hold the plate.")
    require(min(figures["rigid from none"], figures["some from none"]) > 0.01, "Clamps have no effect.")
    require(abs(figures["largest hold over the force"] - 1) < SAME, "The reaction of the clamps is not their force.")
    require(lost < CONSERVED, "Energy is not conserved.")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
