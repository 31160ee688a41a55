"""Closed forms of friction between surfaces, ranks and restarts.
Usage: friction.py block|notched|ranks|restart IMPLAM FOLDER [LAUNCHER...]     (LAUNCHER takes the number of ranks last)

block    a layer pulled along another: coefficient times force between them, to 1e-5; the frictional heat is work less
         strain energy, to the first order in the step
notched  end-notched flexure with a coefficient of .5: the load rises to 1/(1 - 2 mu h/(3 a)) of that without friction,
         a corrected as without. The arms carry half of the end force each, so P/4 presses them together at the support;
         friction there reduces the moment at the tip by mu h P/4. Measured: 2.53 and 2.44 % at 29 and 30 mm, where
         2.49 and 2.41 % are expected
ranks    an impact with friction on 1 and 2 ranks: to 1e-6
restart  the same from a checkpoint while faces slip: bitwise"""

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
from specimens import ARM, WIDTH, crack_correction, load_at, path_of

COEFFICIENT = 0.5
SMALL = ["delamination%friction=0.6"]


def rows_of(history):
    """Convert columns to rows."""
    return [{name: history[name][i] for name in history} for i in range(len(history["time"]))]


def check_block(implam, folder, _):
    """Pull and pressure in each step, and heat with two lengths of the step."""
    missed = []
    for steps in (10, 20):
        deck = write_deck(folder / str(steps), "block.nml", [f"static%steps={steps}"])
        history = read_history(run_deck(implam, deck))
        for row in rows_of(history):
            pressing = 5e5*0.1*0.02*row["time"] + row["line_force_4"] + row["line_force_5"]
            require(abs(row["line_force_10"]/(0.4*pressing) - 1) < 1e-5,
                    f"The pull is {row['line_force_10']!r} N, not {0.4*pressing!r} N.")
        last = rows_of(history)[-1]
        require(last["energy_friction"] > 0.5*last["work_external"], "Friction dissipates little.")
        require(abs(last["energy_error"]) < 1e-6*last["work_external"], "The ledger does not close.")
        missed.append(last["energy_friction"]/(last["work_external"] - last["energy_strain"]) - 1)
    print("heat over work done less strain energy:", missed)
    require(0 < missed[1] < 0.06 and abs(missed[1]/missed[0] - 0.5) < 0.03, "The heat is not work less strain energy.")


def check_notched(implam, folder, _):
    """Loads at three lengths of the crack, with friction and without."""
    paths = []
    for coefficient in (0.0, COEFFICIENT):
        deck = write_deck(folder / str(coefficient), "enf.nml",
                          [f"delamination%friction={coefficient}", "static%dissipation=0.12", "static%steps=24"])
        paths.append(path_of(implam, deck, deck.parent))
    require(paths[1][-1]["energy_friction"] > 0.005 and paths[0][-1]["energy_friction"] == 0, "No frictional heat.")
    worst = 0
    for crack in (29e-3, 30e-3):
        found = [load_at(crack, path, WIDTH, 5.6e-3, lambda row: row["line_force_3"]) for path in paths]
        expected = 1/(1 - 2*COEFFICIENT*ARM/(3*(crack + .42*crack_correction()*ARM)))
        print(f"{1e3*crack:g} mm: {found[1]/found[0]:.5f} times the load without friction, expected {expected:.5f}")
        worst = max(worst, abs(found[1]/found[0] - expected)/(expected - 1))
    require(worst < 0.05, f"The increase of the load differs by {100*worst:.1f} %.")


def check_ranks(implam, folder, launcher):
    """One rank and two."""
    one, two = (read_history(run_deck(implam, write_deck(folder / name, "../small/cohesive.nml", SMALL), launch))
                for name, launch in (("one", ()), ("two", (*launcher, "2"))))
    require(one["energy_friction"][-1] > 0, "Nothing slips.")
    left_out = [name for name in one if "iterations" in name or name in ("refactorisations", "solves")]
    difference, name = largest_difference(two, one, left_out)
    require(difference <= 1e-6, f"{name} differs by {difference:.2g} of its largest value.")


def check_restart(implam, folder, _):
    """From the last checkpoint, while faces slip."""
    heat = check_goes_on(implam, folder, "../small/cohesive.nml",
                         [*SMALL, "output%checkpoint_every=200e-6"])["energy_friction"]
    require(heat[-1] > heat[-4] > 0, "Nothing slips after the checkpoint.")


def trial(kind, implam, folder, *launcher):
    """Run one trial."""
    checks = {"block": check_block, "notched": check_notched, "ranks": check_ranks, "restart": check_restart}
    checks[kind](implam, Path(folder), launcher)


if __name__ == "__main__":
    raise SystemExit(exit_code_of(trial, *sys.argv[1:]))
