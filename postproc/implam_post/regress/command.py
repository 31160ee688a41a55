"""Run decks and compare the results with expected values (`implam-regress DIR`)."""

import argparse
import shutil
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from implam_post.io.counts import counted
from implam_post.io.errors import EXIT_DONE, EXIT_USAGE, CommandParser, FileError, count, positive, run
from implam_post.io.files import write_text
from implam_post.io.program import PROGRAM_HELP, find_program, processors, version_in
from implam_post.regress.accept import accept, accept_new
from implam_post.regress.expectations import AS_IT_IS, FORMAT, Expectations, Variant, read_expectations
from implam_post.regress.junit import junit
from implam_post.regress.runs import Outcome, run_all, table


def find_expectations(paths: Sequence[Path], decks: Path | None) -> list[Expectations]:
    """Return the expectations in folders and files; a deck without a file of expectations gets an empty list.

    Decks are searched in the folder of the expectations, or in `decks`.
    """
    files = [file for path in paths for file in (sorted(path.glob("*.toml")) if path.is_dir() else [path])]
    found = [read_expectations(path) for path in dict.fromkeys(files)]
    used = {deck_path(expectations, decks).resolve() for expectations in found}
    for folder in [path for path in paths if path.is_dir() and decks is None]:
        found += [Expectations(deck.with_suffix(".toml"), deck.name, [], [Variant(AS_IT_IS, {}, [])])
                  for deck in sorted(folder.glob("*.nml")) if deck.resolve() not in used]
    if not found:
        raise FileError(f"there are no decks and no expectations in {', '.join(map(str, paths))}.")
    name, times = Counter(expectations.path.stem for expectations in found).most_common(1)[0]
    if times > 1:
        raise FileError(f"{times} files are named {name}: give their folders one at a time.")
    return found


def deck_path(expectations: Expectations, decks: Path | None) -> Path:
    """Return the path of the deck of expectations."""
    return (expectations.path.parent if decks is None else decks) / expectations.deck


def _accept(expectations: Expectations, outcomes: Sequence[Outcome]) -> bool:
    """Accept the results of the runs of one file, and print the changes; return False if they cannot be accepted."""
    if all(outcome.passed for outcome in outcomes):
        return True
    path = expectations.path
    try:
        for outcome in outcomes:
            if outcome.fault:
                raise FileError(f"{outcome.label}: {outcome.fault}")
        if expectations.variants[0].expectations:
            lines = accept(expectations, [outcome.comparisons for outcome in outcomes])
        else:
            lines = accept_new(path, outcomes[0].history, version_in(outcomes[0].folder))
    except FileError as error:
        print(f"{path}: nothing is accepted: {error}", file=sys.stderr)
        return False
    print(*(f"{path}: {line}" for line in lines), sep="\n")
    return True


def _run(options: argparse.Namespace, folder: Path) -> bool:
    """Run all variants in a folder, compare and report; return True if all results are as expected, or accepted."""
    program, found = find_program(options.program), find_expectations(options.paths, options.decks)
    outcomes = {expectations.path: [
        Outcome(expectations, variant, deck_path(expectations, options.decks),
                folder / expectations.path.stem / variant.name) for variant in expectations.variants]
        for expectations in found}
    everything = [outcome for variants in outcomes.values() for outcome in variants]
    to_run = [outcome for outcome in everything if outcome.variant.expectations or options.accept]
    for outcome in everything:
        if outcome not in to_run:
            outcome.fault = "the deck has no expected values; --accept writes those of the run."
    start = time.monotonic()
    run_all(to_run, program, options.jobs, options.timeout)
    if options.junit:
        write_text(options.junit, junit(everything, time.monotonic() - start))
    if any(outcome.comparisons or outcome.fault for outcome in everything):
        print(table(everything))
    failed = sum(not outcome.passed for outcome in everything)
    if options.accept:
        accepted = [_accept(expectations, outcomes[expectations.path]) for expectations in found]
        return all(accepted)
    print(f"{counted(len(everything), 'run')}, {failed} failed")
    return not failed


def _command(options: argparse.Namespace) -> int:
    """Run in the given folder, or in a temporary one that is removed unless something failed."""
    folder = options.output or Path(tempfile.mkdtemp(prefix="implam_regress_"))
    passed = False
    try:
        passed = _run(options, folder)
        return EXIT_DONE if passed else EXIT_USAGE
    finally:
        if not options.output and (passed or not any(folder.iterdir())):
            shutil.rmtree(folder, ignore_errors=True)
        elif not passed and folder.exists():
            print(f"The results are in {folder}", file=sys.stderr)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; the exit code is 1 if anything is not as expected."""
    parser = CommandParser(
        "implam-regress", formatter_class=argparse.RawDescriptionHelpFormatter, epilog=FORMAT,
        description="Run decks NAME.nml and compare the results with expected values, NAME.toml. A deck\n"
        "without expected values fails.")
    parser.add_argument("paths", nargs="+", type=Path, metavar="DIR",
                        help="folders of decks and expectations, or files of expectations; the format is given below")
    parser.add_argument("--decks", type=Path, metavar="DIR", help="folder of the decks (default: that of each file)")
    parser.add_argument("--output", type=Path, metavar="DIR",
                        help="folder of the results (default: a temporary one, kept after a failure)")
    parser.add_argument("--program", metavar="WORDS", help=PROGRAM_HELP)
    parser.add_argument("--jobs", type=count, default=processors(), metavar="N",
                        help="simultaneous runs (default: the number of processors)")
    parser.add_argument("--timeout", type=positive, metavar="SECONDS", help="time limit of a run (default: none)")
    parser.add_argument("--junit", type=Path, metavar="FILE", help="write the results as JUnit XML")
    parser.add_argument("--accept", action="store_true",
                        help="replace expected values that are not met by the results; tolerances are kept, and "
                        "are 0.1 %% and, for times, a tenth of a step in new files")
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
