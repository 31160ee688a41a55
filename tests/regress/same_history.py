"""Runs a deck in two ways that must give the same history.
Usage: same_history.py ranks IMPLAM DECK FOLDER TOLERANCE LAUNCHER... [-- SETTING...]
       same_history.py symmetry IMPLAM DECK FOLDER TOLERANCE [-- SETTING...]

ranks: on 1, 2 and 4 ranks, LAUNCHER taking the number of ranks as its last word. symmetry: the quarter against the
whole plate with twice the elements each way."""

import re
import sys
from pathlib import Path

from solver_runs import TrialError, largest_difference, read_history, require, run_deck, write_deck

# How the solution was found, not what it is; the stress is a measure for the step only.
COUNTS = ("iterations", "force_iterations", "total_iterations", "total_force_iterations", "refactorisations", "solves")


def histories_of_ranks(implam, deck, folder, launcher, settings):
    """Yield name and history of the runs on 1, 2 and 4 ranks."""
    for ranks in (1, 2, 4):
        path = write_deck(folder / f"ranks_{ranks}", deck, settings)
        history = run_deck(implam, path, [*launcher, str(ranks)])
        log = next(path.parent.glob("*.log")).read_text(encoding="utf-8")
        require(f"{ranks} rank" in log, f"The log doesn't tell of {ranks} ranks.")
        yield f"{ranks} ranks", read_history(history)


def histories_of_symmetry(implam, deck, folder, _, settings):
    """Yield name and history of the quarter and of the whole plate."""
    quarter = write_deck(folder / "quarter", deck, [*settings, "plate%symmetry='quarter'"])
    yield "quarter", read_history(run_deck(implam, quarter))
    elements = re.search(r"elements=(\d+), *(\d+)", quarter.read_text(encoding="utf-8"))
    doubled = f"mesh%elements={2 * int(elements[1])},{2 * int(elements[2])}"
    whole = write_deck(folder / "whole", deck, [*settings, "plate%symmetry='none'", doubled])
    yield "whole", read_history(run_deck(implam, whole))


def main(kind, implam, deck, folder, tolerance, *words):
    """Run and compare; the exit code is 1 if the histories differ."""
    left_out = COUNTS if kind == "ranks" else (*COUNTS, "stress")
    divide = words.index("--") if "--" in words else len(words)
    launcher, settings = words[:divide], words[divide + 1:]
    histories = {"ranks": histories_of_ranks, "symmetry": histories_of_symmetry}[kind]
    runs = histories(implam, deck, Path(folder), launcher, settings)
    _, reference = next(runs)
    passed = True
    try:
        for name, history in runs:
            difference, column = largest_difference(history, reference, left_out)
            within = difference <= float(tolerance)
            print(f"{name}: {len(history['time'])} rows, largest difference {difference:.2e} ({column}), "
                  f"{'pass' if within else 'FAIL'}", flush=True)
            passed &= within
        require(passed, "The histories differ.")
    except TrialError as failure:
        print(failure)
        return 1
    return 0


if __name__ == "__main__":
    raise SystemExit(main(*sys.argv[1:]))
