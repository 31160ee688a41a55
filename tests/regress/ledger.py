"""Energy balance of load steps: every kind of load on every kind of plate.
Usage: ledger.py IMPLAM FOLDER

Every load, with each mechanism that stores or dissipates energy: plies that fail suddenly or soften, interfaces, a rig
with a unilateral frame and clamps, residual stresses, and all of them together. The ledger closes to
1e-6 of the largest work in every step. Without failure nothing is dissipated, however large the steps."""

import shutil
import sys
from pathlib import Path

from solver_runs import TrialError, exit_code_of, read_history, require, run_deck

CLOSES = 1e-6  # of the work; 3.4e-8 remains here with a residual of 1e-8
CURVED = "&case name='ledger' kinematics='von_karman' /\n"
MESH = "&mesh elements=8,4 patch=10e-3 /\n"
PLY = ("&material name='m' density=1580 E1=139e9 E2=9.4e9 G12=4.5e9 G13=4.5e9 G23=2.98e9 nu12=0.309 XT=2000e6 "
       "XC=1200e6 YT=10e6 YC=200e6 S12=60e6 Sf=60e6 Sm23=80e6 alpha1=-0.3e-6 alpha2=28e-6")
LAMINATE = "&laminate materials='m' angles=0,90,0,90 thicknesses=0.5e-3 /\n"
STRIP = "&plate length=0.1,0.06 edges='clamped','clamped','free','free' /\n"
ON_RIG = "&plate length=0.1,0.06 edges='free' in_plane='fixed' /\n"
LOADS = {
    "pressure": "&pressure value=200e3 /",
    "force": "&line at=0 force=1.2e3 history='{}' /",
    "displacement": "&line at=0 displacement=0.5e-3 history='{}' /",
    "moment": "&line at=0.02 component='theta_x' moment=6 history='{}' /",
    "rotation": "&line at=0.02 component='theta_x' rotation=0.02 history='{}' /",
    "stretched": "&line at=0.02 component='u' displacement=0.05e-3 history='{}' /\n"
                 "&line at=-0.02 component='u' displacement=0 /",
    "pressed and held": "&pressure value=200e3 /\n&line at=0.02 displacement=0.2e-3 history='{}' /",
    "travel": "&impactor travel=0.8e-3 radius=10e-3 /\n&indentation law='hertz' k=1e9 /",
    "nose": "&impactor travel=0.8e-3 radius=10e-3 contact_area='sphere' /\n&indentation law='hertz' k=1e9 /",
}
CLAMPS = "clamps=-45e-3,20e-3, -45e-3,-20e-3, 45e-3,20e-3, 45e-3,-20e-3"
PARTS = {
    "nothing": "",
    "plies": "&ply_damage criteria='hashin' /",
    "softening": "&ply_damage criteria='hashin' /",
    "interface": "&delamination below_ply=2 law='cohesive' G_Ic=50 G_IIc=100 strength_opening=5e6 "
                 "strength_shear=5e6 zone=60e-3,60e-3 /",
    "rig": f"&support shape='rectangle' window=80e-3,60e-3 unilateral=.true. {CLAMPS} clamp_force=200 /",
    "springs": f"&support {CLAMPS} clamp_stiffness=1e6 /",
    "thermal": "&thermal delta_T=-100 /",
}
TOGETHER = [("plies",), ("softening",), ("interface",), ("rig",), ("springs",), ("thermal",), ("nothing",),
            ("plies", "interface", "thermal"), ("softening", "rig"), ("springs", "thermal")]


def deck_of(load, parts, steps=5):
    """Return a deck with a load and mechanisms that store or dissipate energy."""
    plate = ON_RIG if {"rig", "springs"} & set(parts) else STRIP
    ply = PLY
    if "rig" in parts:  # a line crosses the frame: it can only lift the plate
        load = load.replace(" displacement=", " displacement=-")
    if "softening" in parts:
        ply += " G_ft=100e3 G_fc=100e3 G_mt=1e3 G_mc=4e3"
    groups = [CURVED, plate, MESH, f"{ply} /\n", LAMINATE, load, *(PARTS[part] for part in parts),
              f"&static steps={steps} /",
              "&solver tolerance=1e-8 /"]
    return "\n".join(groups) + "\n"


# Failures that must occur in at least one case with the mechanism, so that their energy is recorded.
BREAKS = {"plies": "energy_ply_damage", "softening": "energy_ply_damage", "interface": "energy_delamination"}


def check(implam, folder, load, parts, steps=5):
    """Return the energy error over the largest work, and the history."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    deck = folder / "deck.nml"
    deck.write_text(deck_of(load, parts, steps), encoding="utf-8")
    history = read_history(run_deck(implam, deck))
    work = max(map(abs, history["work_external"]))
    require(work > 0, "nothing works")
    return max(map(abs, history["energy_error"]))/work, history


def trial(implam, folder):
    """Run all cases."""
    faults, worst, failed = [], 0.0, set()
    for name, text in LOADS.items():
        for history in ("ramp", "fixed") if "{}" in text else ("",):
            for parts in TOGETHER:
                case = f"{name} {history} with {' and '.join(parts)}".replace("  ", " ")
                try:
                    error, rows = check(implam, Path(folder) / case.replace(" ", "_"), text.format(history), parts)
                    worst = max(worst, error)
                    failed |= {part for part in parts if part in BREAKS and rows[BREAKS[part]][-1] > 0}
                    require(error < CLOSES, f"{error:.2g} of the work is the energy error")
                except TrialError as fault:
                    faults.append(f"{case}: {fault}")
    require(failed == set(BREAKS), f"Only {sorted(failed)} fail.")
    faults += elastic_faults(implam, folder)
    print(f"{worst:.2g} of the work at most")
    require(not faults, "\n".join(faults))


def elastic_faults(implam, folder):
    """Return the dissipation of an elastic plate in two load steps and the difference of its work from that in five."""
    faults = []
    for name in ("pressure", "force", "displacement", "rotation", "travel"):
        work = []
        for steps in (2, 5):
            case = Path(folder) / f"elastic_{name}_{steps}".replace(" ", "_")
            error, rows = check(implam, case, LOADS[name].format("ramp"), ("nothing",), steps)
            work.append(rows["work_external"][-1])
            lost = max(map(abs, rows["energy_algorithmic"]))/abs(work[-1])
            if max(error, lost) > CLOSES:
                faults.append(f"{name} in {steps} steps: {lost:.2g} of the work is lost in an elastic plate")
        if abs(work[0]/work[1] - 1) > CLOSES:
            faults.append(f"{name}: the work depends on the steps: {work}")
    return faults


if __name__ == "__main__":
    raise SystemExit(exit_code_of(trial, *sys.argv[1:]))
