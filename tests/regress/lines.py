"""Lines on quarters of plates, on ranks and across restarts.
Usage: lines.py quarter|ranks|restart IMPLAM FOLDER [LAUNCHER...]
(LAUNCHER takes the number of ranks as its last word)

quarter  a strip and the quarter that stands for it: deflection and forces to 1e-9
ranks    a notched strip that is taken by what it dissipates, on 1 and 2 ranks: to 1e-6
restart  the same from a checkpoint while damage grows: bitwise"""

import shutil
import sys
from pathlib import Path

from solver_runs import (
    DECKS,
    checkpoint_of,
    exit_code_of,
    history_of,
    largest_difference,
    read_history,
    require,
    run,
    run_deck,
    write_deck,
)

NOTCHED = ["mesh%elements=56,2", "static%steps=12", "static%dissipation=0.12", "delamination%strength_shear=40e6"]


def check_quarter(implam, folder, _):
    """A line for two, and one in the middle."""
    whole = read_history(run_deck(implam, write_deck(folder / "whole", "three_point.nml")))
    deck = write_deck(folder / "quarter", "three_point.nml", ["plate%symmetry='quarter'", "mesh%elements=10,2"])
    text = deck.read_text(encoding="utf-8")
    deck.write_text("\n".join(line for line in text.splitlines() if "at=-" not in line), encoding="utf-8")
    quarter = read_history(run_deck(implam, deck))
    for name, other in (("deflection", "deflection"), ("work_external", "work_external"),
                        ("line_force_2", "line_force_1"), ("line_force_3", "line_force_2"),
                        ("line_force_5", "line_force_3")):
        found, expected = quarter[other][-1], whole[name][-1]
        require(abs(found - expected) <= 1e-9*abs(expected), f"{name}: {found!r} on the quarter, not {expected!r}.")


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
    settings = [*NOTCHED, "output%checkpoint_every=0.7"]
    whole = run_deck(implam, write_deck(folder / "whole", "enf.nml", settings))
    copy = folder / "again"
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(whole.parent, copy)
    run([implam, "restart", checkpoint_of(copy)], folder=copy)
    rows = read_history(whole)
    require(rows["load_factor"][-1] < max(rows["load_factor"]), "The load does not fall.")
    require(history_of(copy).read_bytes() == whole.read_bytes(),
            "The history goes on otherwise than without a restart.")


def trial(kind, implam, folder, *launcher):
    """One of them."""
    checks = {"quarter": check_quarter, "ranks": check_ranks, "restart": check_restart}
    require((DECKS / "enf.nml").exists(), "The decks are missing.")
    checks[kind](implam, Path(folder), launcher)


if __name__ == "__main__":
    raise SystemExit(exit_code_of(trial, *sys.argv[1:]))
