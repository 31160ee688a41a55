"""Run a deck over lists, grids or samples of its keys (`implam-sweep SWEEP.toml`)."""

import argparse
import itertools
import os
import re
import shlex
import shutil
import sys
import time
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING

from implam_post.io.counts import counted
from implam_post.io.errors import EXIT_DONE, EXIT_USAGE, CommandParser, DeckError, FileError, count, reason, run
from implam_post.io.files import try_lock, write_text
from implam_post.io.program import EXIT_STOPPED, PROGRAM_HELP, check_deck, find_program, processors
from implam_post.sweep.case_run import case_command, remove_failed
from implam_post.sweep.plan import FORMAT, Case, is_random, only, read_plan
from implam_post.sweep.runs import NOT_RUN, OUTDATED, STOPPED, Sweep, run_cases

if TYPE_CHECKING:  # it imports numpy, which an invalid sweep does not need
    from implam_post.sweep.table import Table

_TABLE_EVERY = 10.0  # seconds between intermediate tables
_LEFT = (NOT_RUN, STOPPED, OUTDATED)  # ends of cases that the same command runs
_SHOWN = 20  # number of faulty decks that are listed
_NUMBER = re.compile(r"\d+(?:\.\d*)?(?:[eE][-+]?\d+)?")


def check_decks(sweep: Sweep, cases: Sequence[Case], jobs: int, *, warns: bool = True) -> None:
    """Check all decks with the program, and report errors and warnings, before the first run."""
    with ThreadPoolExecutor(jobs) as pool:
        verdicts = list(pool.map(lambda case: check_deck(sweep.program, sweep.deck(case)), cases))
    faulty = [(case, printed) for case, (sound, printed) in zip(cases, verdicts, strict=True) if not sound]
    for case, printed in faulty[:_SHOWN]:
        print(f"case {case.number}: {case.label}", *printed, sep="\n  ", file=sys.stderr)
    if faulty:
        more = f" (the first {_SHOWN} are listed)" if len(faulty) > _SHOWN else ""
        raise DeckError(f"{len(faulty)} of {len(sweep.plan.cases)} decks are faulty{more}; no deck was run.")
    if not warns:
        return
    warnings = [[found[1] for line in printed if (found := re.match(r".*?: warning: (.*)", line))]
                for _, printed in verdicts]
    # Of warnings that differ only in numbers, the first one is printed.
    first: dict[str, str] = {}
    for warning in itertools.chain(*warnings):
        first.setdefault(_NUMBER.sub("#", warning), warning)
    numbers = Counter(alike for of_deck in warnings for alike in {_NUMBER.sub("#", warning) for warning in of_deck})
    for alike, warning in first.items():
        print(f"warning, {numbers[alike]} of {len(cases)} decks: {warning}", file=sys.stderr)


class _Tables:
    """Writer of the table, final and intermediate ones."""

    def __init__(self, sweep: Sweep) -> None:
        """Store the sweep."""
        self._sweep, self._written, self._figures = sweep, time.monotonic(), {}

    def write_now_and_then(self) -> None:
        """Write an intermediate table if the last one is old."""
        if time.monotonic() - self._written > _TABLE_EVERY:
            self.write()

    def write(self) -> "Table":
        """Write the table as CSV and return it."""
        from implam_post.sweep.table import make_table, write_csv
        table = make_table(self._sweep, self._figures)
        write_csv(table, self._sweep.plan.output / "table.csv")
        self._written = time.monotonic()
        return table


def _write_array(sweep: Sweep, cases: Sequence[Case]) -> int:
    """Write the remaining decks, and the commands that run them, one per line."""
    decks, commands = sweep.plan.output / "decks.txt", sweep.plan.output / "array.txt"
    write_text(decks, "".join(f"{sweep.deck(case).absolute()}\n" for case in cases))
    write_text(commands, "".join(shlex.join(case_command(sweep.folder(case), sweep.program)) + "\n" for case in cases))
    print(f"Decks to run: {len(cases)}, listed in {decks}, their commands in {commands}.")
    return EXIT_DONE


def _gather(sweep: Sweep, tables: _Tables) -> int:
    """Write table and plots, list failed cases, and return the exit code."""
    from implam_post.sweep.plots import plot_table
    from implam_post.sweep.table import write_hdf5
    output = sweep.plan.output
    table = tables.write()
    write_hdf5(table, output / "table.h5")
    # Random inputs are not used as axes; their statistics have their own pictures.
    plots = [] if sweep.plan.scatter else plot_table(table, output)
    print(output / "table.csv", output / "table.h5", *plots, sep="\n")
    if is_random(sweep.plan):
        _print_scatter(sweep, table.system)
    for note in table.notes:
        print(f"note: {note}")
    return exit_code(sweep, table)


def exit_code(sweep: Sweep, table: "Table") -> int:
    """List failed and remaining cases, and return the exit code; results that cannot be read count as failed."""
    code = print_outcomes(sweep)
    return code if table.is_readable else EXIT_USAGE


def _print_scatter(sweep: Sweep, system: str) -> None:
    """Write and print the statistics of runs with random inputs."""
    from implam_post.plot.style import PictureStyle
    from implam_post.sweep.scatter_plots import plot_scatter
    from implam_post.sweep.scatter_results import curves_of, groups_of, write_statistics
    from implam_post.sweep.scatter_text import statistics_text, variants_table
    groups, style = groups_of(sweep), PictureStyle(system)
    files = write_statistics(sweep, groups, system, variants_table(groups, style) if len(groups) > 1 else ())
    pictures = plot_scatter(groups, curves_of(sweep.plan.measured), style, sweep.plan.output)
    print(*files, *pictures, sep="\n")
    text = statistics_text(sweep.plan, groups, style)
    write_text(sweep.plan.output / "statistics.txt", f"{text.strip()}\n")
    print(text)
    for note in (note for group in groups for note in group.notes):
        print(f"note: {note}")


def print_outcomes(sweep: Sweep) -> int:
    """List failed and remaining cases, and return the exit code."""
    total = len(sweep.plan.cases)
    ends = [(case, sweep.failure(case)) for case in sweep.plan.cases]
    left = [case for case, failure in ends if failure in _LEFT]
    failed = [(case, failure) for case, failure in ends if failure and failure not in _LEFT]
    if failed:
        print(f"{len(failed)} of {total} cases failed:", file=sys.stderr)
    for case, failure in failed:
        print(f"  case {case.number} ({sweep.folder(case)}): {case.label}: {failure}", file=sys.stderr)
    if left:
        print(f"{len(left)} of {total} cases have not ended; the same command continues with them.", file=sys.stderr)
    return EXIT_USAGE if failed else EXIT_STOPPED if left else EXIT_DONE


def _check_second(sweep: Sweep, cases: Sequence[Case], jobs: int) -> None:
    """Check the decks of second runs before the first runs; their folder is kept if one is faulty."""
    if sweep.plan.then is None or not cases:
        return
    from implam_post.sweep.chain import foreseen
    second = foreseen(sweep, sweep.plan.then, cases)
    second.write_decks()
    check_decks(second, second.open_cases(), jobs, warns=False)
    shutil.rmtree(second.plan.output)


def print_outdated(sweep: Sweep, options: argparse.Namespace) -> None:
    """Remove the results of cases that have to run again, and say why; not if only the table is made."""
    for sentence in () if options.table else sweep.remove_outdated():
        print(sentence)


def _work(sweep: Sweep, options: argparse.Namespace) -> int:
    """Write and check the decks, then run or list them."""
    sweep.write_decks()
    for case in sweep.plan.cases if options.retry else ():
        remove_failed(sweep.folder(case))
    print_outdated(sweep, options)
    cases, tables = sweep.open_cases(), _Tables(sweep)
    if options.table:
        return max(_gather(sweep, tables), _work_on_second(sweep, options, tables))
    check_decks(sweep, cases, options.jobs)
    _check_second(sweep, cases, options.jobs)
    if options.array:
        # In a queue the second runs are listed after the first ones have ended.
        is_first = bool(cases) or sweep.plan.then is None
        return _write_array(sweep, cases) if is_first else _work_on_second(sweep, options, tables)
    for note in sweep.plan.notes:
        print(f"note: {note}")
    print(f"{counted(len(sweep.plan.cases), 'case')}, {counted(len(cases), 'deck')} to run", flush=True)
    finished = run_cases(sweep, cases, options.jobs, tables.write_now_and_then)
    code = _gather(sweep, tables)
    if not finished:
        return EXIT_STOPPED
    return max(code, _work_on_second(sweep, options, tables))


def _work_on_second(sweep: Sweep, options: argparse.Namespace, tables: _Tables) -> int:
    """Run the second decks, or list them for a queue, and write the table with the figures of both runs."""
    from implam_post.sweep.chain import following
    second = following(sweep)
    if second is None:
        return EXIT_DONE
    second.write_decks()
    for case in second.plan.cases if options.retry else ():
        remove_failed(second.folder(case))
    print_outdated(second, options)
    cases = second.open_cases()
    if options.table:
        return _gather_second(sweep, second, tables)
    check_decks(second, cases, options.jobs)
    if options.array:
        return _write_array(second, cases)
    print(f"{counted(len(second.plan.cases), 'run')} from their final states, {counted(len(cases), 'deck')} to run",
          flush=True)
    finished = run_cases(second, cases, options.jobs, lambda: None)
    code = _gather_second(sweep, second, tables)
    return code if finished else EXIT_STOPPED


def _gather_second(sweep: Sweep, second: Sweep, tables: _Tables) -> int:
    """Write the table of both runs and the picture of the strengths, list failed cases, and return the exit code."""
    from implam_post.sweep.chain import add_figures, remark_of_bounds
    from implam_post.sweep.chain_plots import plot_strength
    from implam_post.sweep.table import write_csv, write_hdf5
    table, output = tables.write(), sweep.plan.output
    printed = len(table.notes)
    add_figures(table, sweep, second)
    write_csv(table, output / "table.csv")
    write_hdf5(table, output / "table.h5")
    drawn = plot_strength(table, output / "strength.png")
    print(output / "table.csv", output / "table.h5", *[] if drawn is None else [drawn], sep="\n")
    if remark := remark_of_bounds(table):
        print(remark, file=sys.stderr)
    for note in table.notes[printed:]:
        print(f"note: {note}")
    return exit_code(second, table)


def _command(options: argparse.Namespace) -> int:
    """Read the sweep and run it, with its folder locked."""
    program = find_program(options.program)
    plan = read_plan(options.sweep, options.output, program)
    if plan.measured is not None:
        # Read before the runs, so that an error is reported before them.
        from implam_post.sweep.scatter_results import curves_of
        curves_of(plan.measured)
    sweep = Sweep(only(plan, options.only) if options.only else plan, program)
    try:
        sweep.plan.output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"the folder {sweep.plan.output} cannot be created ({reason(error)}).") from None
    lock = try_lock(sweep.plan.output / "lock")
    if lock is None:
        raise FileError(f"another implam-sweep is running in {sweep.plan.output}.")
    try:
        return _work(sweep, options)
    finally:
        os.close(lock)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; the exit code is 1 if a case failed, 75 if the sweep was stopped."""
    parser = CommandParser(
        "implam-sweep", formatter_class=argparse.RawDescriptionHelpFormatter, epilog=FORMAT,
        description="Run a deck over lists, grids or samples of its keys. All decks are checked before the first run.\n"
        "The same command continues a stopped or killed sweep; completed cases are not repeated.")
    parser.add_argument("sweep", type=Path, metavar="SWEEP.toml", help="file of the sweep; the format is given below")
    parser.add_argument("--output", type=Path, metavar="DIR", help="folder of cases and table (default: from the file)")
    parser.add_argument("--program", metavar="WORDS", help=PROGRAM_HELP)
    parser.add_argument("--jobs", type=count, default=processors(), metavar="N",
                        help="simultaneous runs (default: the number of processors)")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--array", action="store_true",
                      help="do not run decks; list decks (decks.txt) and commands (array.txt) for a job array")
    what.add_argument("--table", action="store_true", help="do not run decks; evaluate existing results")
    parser.add_argument("--only", nargs="+", metavar="VARIANT",
                        help="only these of [variants], and the first one, with which others are compared")
    parser.add_argument("--retry", action="store_true", help="also repeat, from the start, cases without convergence")
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
