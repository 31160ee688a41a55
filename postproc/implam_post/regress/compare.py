"""Compare a history with expected values (`implam-compare HISTORY.csv EXPECT.toml`)."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from implam_post.io.deck import read_deck
from implam_post.io.errors import EXIT_DONE, EXIT_USAGE, CommandParser, FileError, run
from implam_post.io.history import History, read_history
from implam_post.io.measured import check_units
from implam_post.io.quantities import AGAINST_QUANTITIES, COLUMN_QUANTITIES, QUANTITIES
from implam_post.plot.style import add_options, style_of
from implam_post.reference.semi_analytic import semi_analytic
from implam_post.regress.expectations import FORMAT, Expectation, read_expectations


@dataclass(frozen=True)
class Comparison:
    """An expectation and the value found."""

    expected: Expectation
    found: float

    @property
    def passed(self) -> bool:
        """Whether the value found is within the tolerance; NaN never is."""
        return abs(self.found - self.expected.value) <= self.expected.tolerance

    def row(self, width: int) -> str:
        """Return the comparison as a line of text, with the name of the quantity padded to a width."""
        expected = self.expected
        numbers = (expected.value, self.found, self.found - expected.value, expected.tolerance)
        return (f"{expected.label:<{width}} " + " ".join(f"{number:13.6g}" for number in numbers) +
                (" pass" if self.passed else " FAIL"))


def check_expectations(history: History, expectations: Sequence[Expectation], folder: Path | str = "."
                       ) -> list[Comparison]:
    """Compare a history with each expectation; files of `against` are in `folder`, or else in that of the history."""
    @cache
    def reference(name: str) -> History:
        path = Path(folder) / name
        if not path.exists() and (Path(history.name).parent / name).exists():
            path = Path(history.name).parent / name
        if path.suffix != ".csv":
            return semi_analytic(read_deck(path))
        curve = read_history(path)
        check_units(history, curve)
        return curve

    def measure(expected: Expectation) -> float:
        if expected.quantity in AGAINST_QUANTITIES:
            return AGAINST_QUANTITIES[expected.quantity](history, reference(expected.against))
        if expected.quantity == "at":
            return history.at(expected.column, expected.time)
        if expected.column:
            return COLUMN_QUANTITIES[expected.quantity](history[expected.column])
        return QUANTITIES[expected.quantity](history)

    return [Comparison(expected, measure(expected)) for expected in expectations]


def table(comparisons: Sequence[Comparison]) -> str:
    """Return the comparisons as lines of text."""
    width = max(len(comparison.expected.label) for comparison in comparisons)
    return "\n".join([heading(width), *(comparison.row(width) for comparison in comparisons)])


def heading(width: int) -> str:
    """Return the head of a table of comparisons."""
    return f"{'quantity':<{width}} {'expected':>13} {'found':>13} {'difference':>13} {'tolerance':>13}"


def _command(options: argparse.Namespace) -> int:
    """Compare, print and draw."""
    expectations, history = read_expectations(options.expect), read_history(options.history)
    if options.plot and not expectations.curves:
        raise FileError(f"--plot needs a [[curve]] in {options.expect}.")
    comparisons = check_expectations(history, expectations.variant(options.variant).expectations, options.expect.parent)
    print(table(comparisons))
    if options.plot:
        # Importing matplotlib is slow.
        from implam_post.plot.curves import plot_curves
        print(plot_curves(history, expectations.curves, options.plot, style_of(options, [options.history])))
    return EXIT_DONE if all(comparison.passed for comparison in comparisons) else EXIT_USAGE


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; the exit code is 1 if an expectation is not met."""
    parser = CommandParser("implam-compare", formatter_class=argparse.RawDescriptionHelpFormatter, epilog=FORMAT,
                           description="Compare a history with expected values.")
    parser.add_argument("history", type=Path, metavar="HISTORY.csv", help="history written by implam")
    parser.add_argument("expect", type=Path, metavar="EXPECT.toml", help="expected values; the format is given below")
    parser.add_argument("--variant", metavar="NAME", help="the variant that was run, if the file has several")
    parser.add_argument("--plot", type=Path, metavar="FILE",
                        help="picture of the history with each [[curve]] (PNG, PDF or SVG)")
    add_options(parser)
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
