"""Runs a deck and its variants and compares the histories with what is expected, as implam-regress does (its --help
describes the format). Usage: check_deck.py IMPLAM EXPECT.toml FOLDER        (implam_post on the PYTHONPATH)

Decks are in input/verify; `against = "deck.nml"` is the variant's own deck."""

import sys
from pathlib import Path

from implam_post.regress.command import main

from solver_runs import DECKS, LONGEST_RUN

if __name__ == "__main__":
    implam, expect, folder = sys.argv[1:]
    raise SystemExit(main([expect, "--program", implam, "--decks", str(DECKS), "--output", str(Path(folder)),
                           "--jobs", "1", "--timeout", str(LONGEST_RUN)]))
