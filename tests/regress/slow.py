"""Slow indentation by an impactor's travel.
Usage: slow.py elastic|grows|restart IMPLAM FOLDER

elastic  an intact plate: force and travel of Hertz's law and the deflection under equal pressure on the patch, to
         1e-6; half the step length changes nothing
grows    a clamped plate that delaminates: the force is that of the closed form, 1756 N, within 3 %, while the area
         grows fourfold; the ledger closes to 1e-6
restart  from a checkpoint during growth: bitwise"""

import sys
from pathlib import Path

from restart import check_goes_on
from solver_runs import exit_code_of, read_history, require, run_deck, write_deck

STIFFNESS, TRAVEL, THRESHOLD = 1e9, 6e-3, 1756.0


def check_elastic(implam, folder):
    """Strengths far above the stresses, a coarse mesh."""
    settings = ["delamination%strength_shear=6e9", "delamination%strength_opening=6e9", "delamination%starter=6e-3"]
    found = []
    for steps in (3, 6):
        deck = write_deck(folder / str(steps), "indented.nml", [*settings, f"static%steps={steps}"])
        text = deck.read_text(encoding="utf-8").replace("dissipation=0.36", "")
        deck.write_text(text, encoding="utf-8")
        history = read_history(run_deck(implam, deck))
        for i, force in enumerate(history["force"]):
            way = (force/STIFFNESS)**(2/3) + history["patch_deflection"][i]
            require(abs(way/(TRAVEL*history["time"][i]) - 1) < 1e-6, f"The travel is {way!r} m.")
            place = history["impactor_displacement"][i]
            require(abs(place/(TRAVEL*history["time"][i]) - 1) < 1e-9, "The displacement of the impactor differs.")
        compliance = [w/force for w, force in zip(history["patch_deflection"], history["force"], strict=True)]
        require(max(compliance)/min(compliance) - 1 < 1e-6, "The plate's compliance changes.")
        work = history["energy_strain"][-1] + history["energy_indentation"][-1]
        require(abs(work/history["work_external"][-1] - 1) < 1e-6, "Work is dissipated.")
        found.append(history["force"][-1])
    require(abs(found[1]/found[0] - 1) < 1e-6, f"The force is {found} N.")


def check_grows(implam, folder):
    """The force while the delamination grows."""
    history = read_history(run_deck(implam, write_deck(folder / "grows", "indented.nml")))
    area = history["delaminated_area"]
    grown = [force for force, now in zip(history["force"], area, strict=True) if now > 2*area[0]]
    require(len(grown) > 5 and area[-1] > 3*area[0], "The delamination hardly grows.")
    print(f"{min(grown):.1f} to {max(grown):.1f} N in {len(grown)} steps; the area grows {area[-1]/area[0]:.2f} times")
    require(max(abs(force/THRESHOLD - 1) for force in grown) < 0.03, "The force differs from the closed form.")
    require(max(map(abs, history["energy_error"])) < 1e-6*history["work_external"][-1], "The ledger does not close.")


def check_restart(implam, folder):
    """From the last checkpoint."""
    check_goes_on(implam, folder, "indented.nml", ["output%checkpoint_every=0.6"])


def trial(kind, implam, folder):
    """Run one trial."""
    {"elastic": check_elastic, "grows": check_grows, "restart": check_restart}[kind](implam, Path(folder))


if __name__ == "__main__":
    raise SystemExit(exit_code_of(trial, *sys.argv[1:]))
