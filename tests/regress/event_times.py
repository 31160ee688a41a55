"""Run without such times: output times that nearly coincide with the end or with each other cause no tiny steps.
Usage: event_times.py IMPLAM FOLDER"""

import sys
from itertools import pairwise
from pathlib import Path

from solver_runs import read_history, require, run_deck, write_deck

DECK = "../small/delamination.nml"
STEP = 2e-6
END = 240e-6


def run_with(implam, folder, *settings):
    """Run the deck with steps of which 120 end just before the end time, and return its history."""
    return read_history(run_deck(implam, write_deck(folder, DECK, [f"time%step={STEP!r}", *settings])))


def main(implam, folder):
    """The last row is at the end, and fronts grow as far as without such times."""
    folder = Path(folder)
    require(120 * STEP < END, "The last step does not end before the end: the trial is void.")
    reference = run_with(implam, folder / "no_rows_asked")
    require(reference["delaminated_area"][-1] > 1.1 * reference["delaminated_area"][0], "No delamination grew.")
    trials = {"rows": [f"output%history_every={STEP!r}"],
              "fields": [f"output%fields_every={STEP!r}"],
              # Ten intervals of one output are one interval of the other, up to round-off or a fraction of the smallest
              # step.
              "both": [f"output%history_every={STEP!r}", "output%checkpoint_every=20.0000001e-6"]}
    for name, settings in trials.items():
        history = run_with(implam, folder / name, *settings)
        shortest = min(after - before for before, after in pairwise([0.0, *history["time"]]))
        area = history["delaminated_area"][-1] / reference["delaminated_area"][-1]
        print(f"{name}: {history['step'][-1]:.0f} steps, the shortest of {shortest:.3e} s, area {area:.3f} of that "
              "with even steps")
        require(history["step"][-1] == 120 and shortest > 0.999 * STEP, f"{name}: a step between equal events.")
        require(abs(area - 1) < 1e-12, f"{name}: fronts grew in the tiny step.")
        require(history["time"][-1] == END, f"{name}: the end was missed.")


if __name__ == "__main__":
    main(*sys.argv[1:])
