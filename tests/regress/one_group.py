"""Equal histories of two decks: one &delamination for several interfaces, or a group for each: bitwise.
Usage: one_group.py IMPLAM FOLDER"""

import re
import sys
from pathlib import Path

from solver_runs import exit_code_of, read_history, require, run_deck, write_deck

DECK, SETTINGS = "../small/turned.nml", ["laminate%angles=45,45,-45,0,0,90", "time%end=80e-6", "impactor%velocity=8"]
WORDS = ("2, 3, 5", "'all'", "'between_angles'")


def history_with(implam, folder, groups):
    """Run the deck with other groups of interfaces."""
    path = write_deck(folder, DECK, SETTINGS)
    text = path.read_text(encoding="utf-8")
    group = re.search(r"^&delamination.*\n", text, re.MULTILINE)[0]
    text = re.sub(r"^&delamination.*\n", "", text, flags=re.MULTILINE)
    text += "".join(re.sub(r"below_ply=\d+", f"below_ply={below}", group) for below in groups)
    path.write_text(text, encoding="utf-8")
    return read_history(run_deck(implam, path))


def try_groups(implam, folder):
    """Compare the histories."""
    each = history_with(implam, Path(folder) / "each", ("2", "3", "5"))
    require(each["delaminated_area"][-1] > 0, "No delamination grew: the trial is void.")
    for place, words in enumerate(WORDS):
        history = history_with(implam, Path(folder) / f"one_{place}", (words,))
        require(history == each, f"below_ply={words} gives another history than a group for each interface.")
        print(f"below_ply={words}: {len(history['time'])} rows, all the same, pass")


if __name__ == "__main__":
    raise SystemExit(exit_code_of(try_groups, *sys.argv[1:]))
