"""Runs a deck and its variants and compares the histories with what is expected.
Usage: check_deck.py IMPLAM EXPECT.toml FOLDER        (implam_post on the PYTHONPATH)

The file of expectations is that of implam-compare with, if wanted, `deck` (default: the name of the file) and
[[variant]] tables: `name`, `set` (keys of the deck set anew, "group%key=value") and [[variant.expect]]. The
expectations at the top hold for every variant. `against = "deck.nml"` is the variant's own deck."""

import sys
import tomllib
from pathlib import Path

from solver_runs import TrialError, read_history, require, run_deck, write_deck

from implam_post.compare import Expectation, compare, table
from implam_post.history import read_history as read_columns


def check_variant(implam, deck, settings, entries, folder):
    """Run one variant; return True if it meets its expectations."""
    require(entries, f"{folder.name} expects nothing.")
    path = run_deck(implam, write_deck(folder, deck, settings))
    read_history(path)
    comparisons = compare(read_columns(path), [Expectation(**entry) for entry in entries], folder)
    print(f"{folder.name}: {deck} {' '.join(settings)}\n{table(comparisons)}\n", flush=True)
    return all(comparison.passed for comparison in comparisons)


def main(implam, expect, folder):
    """Run all variants; the exit code is 1 if any failed."""
    expect = Path(expect)
    content = tomllib.loads(expect.read_text(encoding="utf-8"))
    deck = content.pop("deck", expect.stem + ".nml")
    common = content.pop("expect", [])
    variants = content.pop("variant", [{"name": "as_it_is"}])
    require(not content, f"{expect} has more than deck, expect and variant.")
    passed = True
    for variant in variants:
        known = set(variant) <= {"name", "set", "expect"}
        require(known, f"{expect}: a variant has a name, set and expect, not {', '.join(variant)}.")
        try:
            passed &= check_variant(implam, deck, variant.get("set", []), common + variant.get("expect", []),
                                    Path(folder) / expect.stem / variant["name"])
        except TrialError as failure:
            print(f"{variant['name']}: FAIL: {failure}\n", flush=True)
            passed = False
    return 0 if passed else 1


if __name__ == "__main__":
    raise SystemExit(main(*sys.argv[1:]))
