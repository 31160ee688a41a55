"""The option --verify: the finer run is that of a deck refined by hand, changes are those of the summaries,
and existing results are reused. Usage: verification.py IMPLAM FOLDER"""

import json
import sys
from pathlib import Path

from solver_runs import EXIT_DONE, EXIT_STOPPED, exit_code_of, read_history, require, run, run_deck, write_deck

# A ball on a small cross-ply whose lower interface delaminates; by hand, with twice the elements and half the step.
DECK = "../small/delamination.nml"
SHORT = ["case%name='plate'", "time%end=120e-6"]
BY_HAND = [*SHORT, "mesh%elements=12,12", "time%step=5e-6"]
# A wall-clock limit that ends the run after the first step on every machine.
AT_ONCE = ["--wall-limit", "1e-9"]


def rows(folder, name):
    """Return a history as written, without its comment lines."""
    lines = (folder / f"{name}_history.csv").read_text("utf-8").splitlines()
    return [line for line in lines if not line.startswith("#")]


def main(implam, folder):
    """Without a stop, and with stops in both runs."""
    folder = Path(folder)
    deck = write_deck(folder / "whole", DECK, SHORT)
    command = [implam, deck, "--verify", "--output", deck.parent]
    printed = run(command)
    by_hand = read_history(run_deck(implam, write_deck(folder / "by_hand", DECK, BY_HAND)))
    finer = read_history(deck.parent / "plate_finer1_history.csv")
    require(finer == by_hand, "The finer run is not that of a deck refined by hand.")

    figures = json.loads((deck.parent / "plate_verification.json").read_text("utf-8"))["figures"]
    force = figures["peak_force"]
    for name, value in (("plate", force["as_it_is"]), ("plate_finer1", force["finer"])):
        require(value == max(read_history(deck.parent / f"{name}_history.csv")["force"]),
                f"The peak force of {name} is not that of its history.")
    line, = [line for line in printed.splitlines() if line.startswith("  peak force") and line.endswith("%")]
    change = 100 * (force["finer"] / force["as_it_is"] - 1)
    require(abs(float(line.split()[-2]) - change) <= 0.05 * abs(change), f"The change is not {change} %: {line}")
    require(set(figures) >= {"impactor_velocity", "largest_deflection", "delaminated_area"}, f"Only {list(figures)}.")

    stopped = write_deck(folder / "stopped", DECK, SHORT)
    command = [implam, stopped, "--verify", "--output", stopped.parent]
    for name in ("plate", "plate_finer1"):
        said = run([*command, *AT_ONCE], EXIT_STOPPED)
        require("with the same command" in said, f"The command to continue is not printed: {said}")
        require(len(rows(stopped.parent, name)) == 2, f"{name} was not stopped after its first step.")
        if name == "plate":
            # The first run is completed, the second not yet.
            run([implam, "restart", stopped.parent / "plate_restart.h5"])
    said = run(command)
    require(said.count("has been run before") == 1, f"The first run was repeated: {said}")
    for name in ("plate", "plate_finer1"):
        require(rows(stopped.parent, name) == rows(deck.parent, name), f"{name} is not that without a stop.")
    # Another deck of the same name is run.
    changed = write_deck(folder / "changed", DECK, [*SHORT, "impactor%velocity=2"])
    said = run([implam, changed, "--verify", "--output", stopped.parent])
    require("has been run before" not in said, "A changed deck was not run.")
    return EXIT_DONE


if __name__ == "__main__":
    sys.exit(exit_code_of(main, *sys.argv[1:]))
