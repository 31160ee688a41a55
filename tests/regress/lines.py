"""Lines on quarters of plates, on ranks and across restarts.
Usage: lines.py quarter|ranks|restart IMPLAM FOLDER [LAUNCHER...]
(LAUNCHER takes the number of ranks as its last word)

quarter  a strip and the quarter or half that stands for it: deflection and forces to 1e-9
ranks    a notched strip that is taken by what it dissipates, on 1 and 2 ranks: to 1e-6
restart  the same from a checkpoint while damage grows: bitwise"""

import sys
from pathlib import Path

from restart import check_goes_on
from solver_runs import (
    DECKS,
    exit_code_of,
    largest_difference,
    read_history,
    require,
    run_deck,
    write_deck,
)

NOTCHED = ["mesh%elements=56,2", "static%steps=12", "static%dissipation=0.12", "delamination%strength_shear=40e6"]


def check_quarter(implam, folder, _):
    """A line for two, and one in the middle; of a half across the lines, all of them."""
    whole = read_history(run_deck(implam, write_deck(folder / "whole", "three_point.nml")))
    for part, elements in (("quarter", "10,2"), ("half_x", "10,4"), ("half_y", "20,2")):
        deck = write_deck(folder / part, "three_point.nml", [f"plate%symmetry='{part}'", f"mesh%elements={elements}"])
        number = {2: 2, 3: 3, 5: 5}
        if part != "half_y":
            text = deck.read_text(encoding="utf-8")
            deck.write_text("\n".join(line for line in text.splitlines() if "at=-" not in line), encoding="utf-8")
            number = {2: 1, 3: 2, 5: 3}
        found = read_history(run_deck(implam, deck))
        names = {"deflection": "deflection", "work_external": "work_external",
                 **{f"line_force_{line}": f"line_force_{own}" for line, own in number.items()}}
        for name, own in names.items():
            value, expected = found[own][-1], whole[name][-1]
            require(abs(value - expected) <= 1e-9*abs(expected),
                    f"{name}: {value!r} with {part}, not {expected!r}.")


def check_ranks(implam, folder, launcher):
    """One rank and two."""
    one = read_history(run_deck(implam, write_deck(folder / "one", "enf.nml", NOTCHED)))
    two = read_history(run_deck(implam, write_deck(folder / "two", "enf.nml", NOTCHED), (*launcher, "2")))
    require(one["delaminated_area"][-1] > 1.03*one["delaminated_area"][0], "Nothing grows.")
    left_out = [name for name in one if "iterations" in name or name in ("factorizations", "solves")]
    difference, name = largest_difference(two, one, left_out)
    require(difference <= 1e-6, f"{name} differs by {difference:.2g} of its largest value.")


def check_restart(implam, folder, _):
    """From the last checkpoint, while damage grows."""
    rows = check_goes_on(implam, folder, "enf.nml", [*NOTCHED, "output%checkpoint_every=0.7"])
    require(rows["load_factor"][-1] < max(rows["load_factor"]), "The load does not fall.")


def trial(kind, implam, folder, *launcher):
    """One of them."""
    checks = {"quarter": check_quarter, "ranks": check_ranks, "restart": check_restart}
    require((DECKS / "enf.nml").exists(), "The decks are missing.")
    checks[kind](implam, Path(folder), launcher)


if __name__ == "__main__":
    raise SystemExit(exit_code_of(trial, *sys.argv[1:]))
