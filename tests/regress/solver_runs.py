"""Runs of the solver for the tests: decks with changed keys, processes, histories. Standard library only."""

import csv
import math
import re
import shutil
import subprocess
from pathlib import Path

DECKS = Path(__file__).resolve().parents[2] / "input" / "verify"
LONGEST_RUN = 240  # seconds
EXIT_DONE, EXIT_DECK, EXIT_CONVERGENCE, EXIT_FILES, EXIT_STOPPED = 0, 2, 3, 4, 75
ENERGIES = ("energy_impactor", "energy_kinetic", "energy_strain", "energy_indentation", "energy_delamination",
            "energy_ply_damage", "energy_contact", "energy_algorithmic")


class TrialError(Exception):
    """A failure of a trial, in one sentence."""


def require(condition, sentence):
    """Fail with a sentence unless the condition holds."""
    if not condition:
        raise TrialError(sentence)


def exit_code_of(trial, *arguments):
    """Run a trial; return 0, or 1 after printing its failure."""
    try:
        trial(*arguments)
    except (TrialError, subprocess.TimeoutExpired) as failure:
        print(failure)
        return 1
    return EXIT_DONE


def change_deck(text, settings):
    """Return a deck with changed keys; each setting reads group%key=value."""
    for setting in settings:
        target, value = setting.split("=", 1)
        group, key = target.split("%")
        found = re.search(rf"^&{group}\b(?:'[^']*'|[^'/])*/", text, re.MULTILINE | re.IGNORECASE)
        if not found:
            text += f"&{group} {key}={value} /\n"
            continue
        line, assignment = found[0], f"{key}={value}"
        changed, times = re.subn(rf"(?<=\s){key}=.*?(?=\s+\w+\s*=|\s*/$)", assignment.replace("\\", r"\\"), line,
                                 flags=re.IGNORECASE | re.DOTALL)
        if not times:
            changed = f"{line[:-1].rstrip()}  {assignment} /"
        text = text.replace(line, changed)
    return text


def write_deck(folder, deck, settings=()):
    """Create an empty folder with the changed deck; return the path of the deck."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    path = folder / "deck.nml"
    # Trials continue from a checkpoint within the run, which the one at its end would replace.
    if any(setting.startswith("output%checkpoint_every") for setting in settings):
        settings = [*settings, "output%checkpoint_at_end=.false."]
    path.write_text(change_deck((DECKS / deck).read_text(encoding="utf-8"), settings), encoding="utf-8")
    return path


def run(command, expected=EXIT_DONE, folder=None):
    """Run a command, in a folder if given, and return what it printed; any other exit code than expected fails."""
    ended = subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                           stderr=subprocess.STDOUT, text=True, timeout=LONGEST_RUN, check=False, cwd=folder)
    require(ended.returncode == expected,
            f"{' '.join(map(str, command))} ended with {ended.returncode}, not {expected}:\n{ended.stdout}")
    return ended.stdout


def run_deck(implam, deck, launcher=()):
    """Run a deck; its results are written beside it. Return the path of the history."""
    run([*launcher, implam, deck, "--output", deck.parent])
    return history_of(deck.parent)


def history_of(folder):
    """Return the path of the only history in a folder."""
    histories = sorted(folder.glob("*_history.csv"))
    require(len(histories) == 1, f"{folder} contains {len(histories)} histories.")
    return histories[0]


def checkpoint_of(folder):
    """Return the path that the checkpoint of the only history in a folder has or would have."""
    history = history_of(folder)
    return history.with_name(history.name.removesuffix("_history.csv") + "_restart.h5")


def read_history(path):
    """Return the columns of a history by name; a number that is not finite fails."""
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    require(rows, f"{path} has no rows.")
    history = {name: [float(row[name]) for row in rows] for name in rows[0]}
    for name, values in history.items():
        require(all(map(math.isfinite, values)), f"{path}: the column {name} is not finite throughout.")
    return history


def largest_difference(history, reference, leave_out=()):
    """Return the largest difference of two histories and its column.

    Each column is relative to its largest value; energy error and dissipation by integrators and contact are relative
    to the largest sum of the energies, penetration of faces to the largest deflection.
    """
    require(list(history) == list(reference), "The columns of the histories differ.")
    require(len(history["time"]) == len(reference["time"]),
            f"The histories have {len(history['time'])} and {len(reference['time'])} rows.")
    total = max(sum(row) for row in zip(*(reference[name] for name in ENERGIES), strict=True))
    worst = 0.0, "none"
    for name in reference:
        if name in leave_out:
            continue
        scale = max(map(abs, reference[name]))
        if name in ("energy_error", "energy_algorithmic", "energy_contact", "energy_layers"):
            scale = max(scale, total)
        if name == "penetration":
            scale = max(scale, *reference["deflection"])
        difference = max(abs(a - b) for a, b in zip(history[name], reference[name], strict=True))
        worst = max(worst, (difference / scale if scale > 0 else difference, name))
    return worst
