"""A run that cannot go on ends with the documented exit code and one sentence on the error output, nothing else.
Usage: one_sentence.py IMPLAM FOLDER"""

import subprocess
import sys
from pathlib import Path

from solver_runs import require, write_deck

DECK = "../small/ply_damage.nml"


def say(command, expected):
    """Run a command that is to fail and hold its exit code and its sentence against what is expected."""
    ended = subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                           stderr=subprocess.PIPE, text=True, timeout=60, check=False)
    lines = ended.stderr.splitlines()
    require(ended.returncode == expected, f"{command} ended with {ended.returncode}, not {expected}: {lines}")
    require(len(lines) == 1 and lines[0].startswith("implam: ") and lines[0].endswith((".", "?")),
            f"{command} did not end with one sentence: {lines}")
    print(lines[0])


def main(implam, folder):
    """Run all failures."""
    folder = Path(folder)
    deck = write_deck(folder, DECK)
    say([implam], 1)
    say([implam, deck, "--output"], 1)
    say([implam, deck, "--output", ""], 1)
    say([implam, deck, "--output", deck], 4)
    blocked = folder / "blocked"
    (blocked / "ply_damage_history.csv").mkdir(parents=True)
    say([implam, deck, "--output", blocked], 4)
    say([implam, "restart", deck], 4)
    deck = write_deck(folder / "hard", DECK, ["solver%max_iterations=1", "solver%tolerance=1e-13"])
    say([implam, deck, "--output", deck.parent], 3)
    error = [line for line in (deck.parent / "ply_damage.log").read_text(encoding="utf-8").splitlines()
             if "error: " in line]
    require(len(error) == 1, f"The log holds the sentence {len(error)} times.")


if __name__ == "__main__":
    main(*sys.argv[1:])
