"""Ply cracks as flaws of the adjacent interface.
Usage: flaws.py whole|ranks|restart|doubler IMPLAM FOLDER [LAUNCHER...]
(LAUNCHER takes the number of ranks as its last word)

Each with cracks_as_flaws, and with shear_cracks.

whole    flaws cause damage, and quarter, half and point-symmetric half agree with the full plate: to 1e-6
ranks    on 1 and 2 ranks: to 1e-6
restart  from a checkpoint while cracks grow: bitwise
doubler  the lower half of the last block as a doubler on the full plate, with in-situ strengths: to 1e-6"""

import sys
from pathlib import Path

from restart import check_goes_on
from solver_runs import (
    exit_code_of,
    largest_difference,
    read_history,
    require,
    run_deck,
    write_deck,
)

DECK = "../small/cohesive.nml"
CRACKS = ["ply_damage%d=100", "material%XT=1517e6", "material%XC=1590e6", "material%YC=253e6", "material%Sf=500e6",
          "material%Sm23=105e6", "material%YT=46e6", "material%S12=105e6"]
# Settings with cracks, the key by which they are flaws, and time of a checkpoint. Steps are short enough that none is
# rejected: whether a longer one converges while cracks open depends on round-off.
WAYS = {"cracks_as_flaws": ([*CRACKS, "delamination%strength_opening=27e6", "delamination%strength_shear=60e6",
                             "time%end=200e-6", "time%step=2.5e-6", "solver%tolerance=1e-8"], 160e-6),
        "shear_cracks": ([*CRACKS, "time%end=280e-6", "time%step=2.5e-6", "solver%tolerance=1e-8"], 240e-6)}
# The same plate without and with a doubler.
WHOLE = ["laminate%angles=0, 90, 0, 0", "laminate%thicknesses=0.6666667e-3, 0.6666667e-3, 0.3333333e-3, 0.3333333e-3"]
PADDED = ["laminate%thicknesses=0.6666667e-3, 0.6666667e-3, 0.3333333e-3",
          "doubler%name='pad' face='back' materials='T300/976' stacking='[0]' ply_thickness=0.3333333e-3 at=0, 0 "
          "size=0.04, 0.04"]
PARTS = {"quarter": "6, 6", "half_x": "6, 12", "point": "6, 12", "none": "12, 12"}


def check_whole(implam, folder, key, _):
    """With flaws and without; on parts of the plate and on the full plate."""
    found = {}
    cracks = WAYS[key][0]
    settings = [*cracks, f"delamination%{key}=.true."]
    for symmetry, elements in PARTS.items():
        found[symmetry] = read_history(run_deck(implam, write_deck(
            folder / symmetry, DECK, [*settings, f"plate%symmetry='{symmetry}'", f"mesh%elements={elements}"])))
    without = read_history(run_deck(implam, write_deck(folder / "without", DECK, cracks)))
    areas = [history["delaminated_area"][-1] for history in (without, found["quarter"])]
    print(f"delaminated {1e6*areas[0]:.3f} mm2 without flaws, {1e6*areas[1]:.3f} mm2 with them")
    require(areas[0] < 1e-6 and areas[1] > 20e-6, "Flaws have no effect.")
    for symmetry, history in found.items():
        for name in ("force", "delaminated_area", "energy_delamination", "energy_ply_damage"):
            expected = found["none"][name]
            worst = max(abs(a - b) for a, b in zip(history[name], expected, strict=True))/max(expected)
            require(worst <= 1e-6, f"{name} of '{symmetry}' differs from the full plate's by {worst:.2g}.")


def check_ranks(implam, folder, key, launcher):
    """One rank and two."""
    cracks, end = WAYS[key]
    # Cracks of one rank have points of the other rank beside them only at the centre of a full plate.
    settings = [*cracks, f"delamination%{key}=.true.", "plate%symmetry='none'", "mesh%elements=12, 12",
                f"time%end={end}"]
    one, two = (read_history(run_deck(implam, write_deck(folder / name, DECK, settings), launch))
                for name, launch in (("one", ()), ("two", (*launcher, "2"))))
    left_out = [name for name in one if "iterations" in name or name in ("factorizations", "solves")]
    require(one["delaminated_area"][-1] > 1e-6, "The delamination does not grow.")
    difference, name = largest_difference(two, one, left_out)
    require(difference <= 1e-6, f"{name} differs by {difference:.2g} of its largest value.")


def check_restart(implam, folder, key, _):
    """From the last checkpoint, while cracks grow."""
    cracks, time = WAYS[key]
    settings = [*cracks, f"delamination%{key}=.true.", f"output%checkpoint_every={time}"]
    area = check_goes_on(implam, folder, DECK, settings)["delaminated_area"]
    require(area[-1] > area[-16] > 0, "The delamination does not grow after the checkpoint.")


def check_doubler(implam, folder, key, _):
    """A block that is partly a doubler has the strength and the reach of the whole block."""
    settings = [*(crack for crack in WAYS[key][0] if "%d=" not in crack), "delamination%shear_cracks=.true.",
                "delamination%stiffness=1e14", "ply_damage%in_situ=.true.", "material%G_ft=81.5e3",
                "material%G_fc=106.3e3", "material%G_mt=280", "material%G_mc=790"]
    whole, padded = (read_history(run_deck(implam, write_deck(folder / name, DECK, [*settings, *plies])))
                     for name, plies in (("whole", WHOLE), ("padded", PADDED)))
    print(f"delaminated {1e6*whole['delaminated_area'][-1]:.3f} mm2, with a doubler "
          f"{1e6*padded['delaminated_area'][-1]:.3f} mm2")
    require(len(padded["time"]) == len(whole["time"]), "The steps differ.")
    for name in ("force", "delaminated_area", "energy_delamination", "energy_ply_damage"):
        worst = max(abs(a - b) for a, b in zip(padded[name], whole[name], strict=True))/max(whole[name])
        require(worst <= 1e-6, f"{name} with the doubler differs by {worst:.2g}.")


def trial(kind, implam, folder, *launcher):
    """Run one trial."""
    checks = {"whole": check_whole, "ranks": check_ranks, "restart": check_restart, "doubler": check_doubler}
    for key in WAYS if kind != "doubler" else ("shear_cracks",):
        checks[kind](implam, Path(folder) / key, key, launcher)


if __name__ == "__main__":
    raise SystemExit(exit_code_of(trial, *sys.argv[1:]))
