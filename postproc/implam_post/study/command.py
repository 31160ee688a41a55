"""Run a deck over a grid of methods and compare errors with processor time (`implam-study STUDY.toml`)."""

import argparse
import os
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from implam_post.io.counts import counted
from implam_post.io.errors import EXIT_USAGE, CommandParser, FileError, count, reason, run
from implam_post.io.files import try_lock, write_text
from implam_post.io.program import EXIT_STOPPED, PROGRAM_HELP, find_program
from implam_post.plot.style import FORMATS
from implam_post.study.plan import ERRORS, FORMAT, Study, read_study
from implam_post.sweep.case_run import remove_failed
from implam_post.sweep.command import check_decks, print_outcomes, print_outdated
from implam_post.sweep.runs import Sweep, run_cases

_TABLE_EVERY = 10.0  # seconds between intermediate tables


class _Tables:
    """Writer of tables and plot, final and intermediate ones."""

    def __init__(self, sweep: Sweep, study: Study, kind: str) -> None:
        """Store the plan; `kind` is the file format of the plot."""
        from implam_post.study.references import References
        self._sweep, self._study, self._kind, self._written = sweep, study, kind, time.monotonic()
        self._references = References(sweep)

    def write_now_and_then(self) -> None:
        """Write an intermediate table if the last one is old."""
        if time.monotonic() - self._written > _TABLE_EVERY:
            self._rows()

    def _rows(self) -> list:
        """Write the table as CSV and return its rows."""
        from implam_post.study.table import make_rows, write_csv
        rows = make_rows(self._sweep, self._study, self._references)
        write_csv(rows, self._sweep, self._study, self._study.output / "table.csv")
        self._written = time.monotonic()
        return rows

    def write(self) -> int:
        """Write tables and plot, print the tables, and return the number of trials with damaged files."""
        from implam_post.study.plots import plot_study
        from implam_post.study.table import means, text_means, text_table
        rows, output = self._rows(), self._study.output
        found = means(rows, self._study) if len(self._study.problems) > 1 else []
        text = text_table(rows, self._study)
        if found:
            text += f"\nGeometric means over {len(self._study.problems)} problems, and the largest errors:\n\n"
            text += text_means(found, self._study)
        write_text(output / "table.txt", text)
        print(text)
        drawn = plot_study(rows, found, self._study, output / f"front.{self._kind}")
        print(output / "table.csv", output / "table.txt", *([drawn] if drawn else []), sep="\n")
        for note in dict.fromkeys(row.note for row in rows if row.note):
            print(f"note: {note}")
        return sum(bool(row.note) for row in rows)


def _work(sweep: Sweep, study: Study, options: argparse.Namespace) -> int:
    """Write and check the decks, run those that have not ended, and write tables and plot."""
    sweep.write_decks()
    for case in study.cases if options.retry else ():
        remove_failed(sweep.folder(case))
    print_outdated(sweep, options)
    runs, tables, finished = sweep.open_cases(), _Tables(sweep, study, options.format), True
    if not options.table:
        check_decks(sweep, list({case.deck: case for case in reversed(runs)}.values()), options.jobs)
        print(f"{counted(len(study.trials), 'trial')} of {counted(len(study.problems), 'problem')}, "
              f"{counted(len(runs), 'run')} remaining", flush=True)
        finished = run_cases(sweep, runs, options.jobs, tables.write_now_and_then)
    unread = tables.write()
    code = print_outcomes(sweep)
    if unread:
        print(f"{unread} of {counted(len(study.trials), 'trial')} cannot be evaluated; see the notes.",
              file=sys.stderr)
        code = EXIT_USAGE
    return code if finished or code == EXIT_USAGE else EXIT_STOPPED


def _command(options: argparse.Namespace) -> int:
    """Read the study and run it, with its folder locked."""
    study = read_study(options.study, options.output)
    if options.error:
        study = Study(**{**study.__dict__, "error": options.error})
    sweep = Sweep(study, find_program(options.program))
    try:
        study.output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"the folder {study.output} cannot be created ({reason(error)}).") from None
    lock = try_lock(study.output / "lock")
    if lock is None:
        raise FileError(f"another implam-study is running in {study.output}.")
    try:
        return _work(sweep, study, options)
    finally:
        os.close(lock)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; the exit code is 1 if a run failed or cannot be evaluated, 75 if the study was stopped."""
    parser = CommandParser(
        "implam-study", formatter_class=argparse.RawDescriptionHelpFormatter, epilog=FORMAT,
        description="Run problems with several methods (meshes, steps, integrators ...), compare each with a\n"
        "reference, and print errors and processor times in one table and one plot, with the Pareto front.\n"
        "The same command continues a stopped or killed study; completed runs are not repeated.")
    parser.add_argument("study", type=Path, metavar="STUDY.toml", help="file of the study; the format is given below")
    parser.add_argument("--output", type=Path, metavar="DIR", help="folder of runs and table (default: from the file)")
    parser.add_argument("--program", metavar="WORDS", help=PROGRAM_HELP)
    parser.add_argument("--jobs", type=count, default=1, metavar="N",
                        help="simultaneous runs (default: 1, since simultaneous runs distort processor times)")
    parser.add_argument("--error", choices=ERRORS, help="error of the plot and of the front (default: from the file)")
    parser.add_argument("--format", choices=FORMATS, default="png", help="file format of the plot (default: png)")
    parser.add_argument("--table", action="store_true", help="do not run decks; evaluate existing results")
    parser.add_argument("--retry", action="store_true", help="also repeat, from the start, runs without convergence")
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
