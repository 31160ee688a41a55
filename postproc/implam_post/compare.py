"""Compare a history with what is expected of it (`implam-compare HISTORY.csv EXPECT.toml`).

The expectations are a table of TOML entries:

    [[expect]]
    quantity = "peak_force"      # a name of `quantities.QUANTITIES`
    value = 298.87
    relative = 0.015             # or absolute = 4.5

    [[expect]]
    quantity = "at"              # a column at a time; "final", "max", "min", "max_abs" need the column only
    column = "impactor_velocity"
    time = 1.0e-3
    value = -0.5178
    absolute = 0.01

    [[expect]]
    quantity = "rms_force"       # over the first contact, as a fraction of the peak
    against = "sun_chen.nml"     # a deck: its semi-analytic answer; else another history. Beside the TOML file
    value = 0.0
    absolute = 0.01
"""

import argparse
import math
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from implam_post.deck import read_deck
from implam_post.errors import EXIT_DONE, EXIT_USAGE, CommandParser, FileError, run
from implam_post.history import History, read_history
from implam_post.quantities import COLUMN_QUANTITIES, QUANTITIES, rms_force_difference
from implam_post.semi_analytic import semi_analytic


@dataclass(frozen=True)
class Expectation:
    """A quantity, its expected value and tolerance, and what it is measured from."""

    quantity: str
    value: float
    relative: float | None = None
    absolute: float | None = None
    column: str = ""
    time: float | None = None
    against: str = ""

    def __post_init__(self) -> None:
        """Refuse entries that could not be measured or could not fail."""
        known = [*QUANTITIES, *COLUMN_QUANTITIES, "at", "rms_force"]
        tolerances = [tolerance for tolerance in (self.relative, self.absolute) if tolerance is not None]
        if self.quantity not in known:
            raise FileError(f"'{self.quantity}' is none of the quantities {', '.join(known)}.")
        if not _is_number(self.value) or len(tolerances) != 1 or not all(map(_is_number, tolerances)):
            raise FileError(f"{self.label}: a value and one of relative and absolute are needed, as finite numbers.")
        if self.relative is not None and self.value == 0:
            raise FileError(f"{self.label}: a tolerance relative to zero means nothing; use absolute.")
        if (self.quantity in COLUMN_QUANTITIES or self.quantity == "at") == (not self.column):
            columns = ", ".join([*COLUMN_QUANTITIES, "at"])
            raise FileError(f"{self.label}: a column goes with {columns}, and with them only.")
        if (self.quantity == "at") != _is_number(self.time):
            raise FileError(f"{self.label}: a time goes with the quantity at, and with it only.")
        if (self.quantity == "rms_force") == (not self.against):
            raise FileError(f"{self.label}: against goes with the quantity rms_force, and with it only.")

    @property
    def label(self) -> str:
        """Name of the entry in tables and messages."""
        time = "" if self.time is None else f" at {self.time:g}"
        return f"{self.column}{time}" if self.quantity == "at" else " ".join(
            word for word in (self.quantity, self.column, self.against) if word)

    @property
    def tolerance(self) -> float:
        """Largest difference accepted."""
        return abs(self.relative * self.value) if self.absolute is None else self.absolute


@dataclass(frozen=True)
class Comparison:
    """An expectation and what was found."""

    expected: Expectation
    found: float

    @property
    def passed(self) -> bool:
        """Tell whether the value found is within the tolerance; NaN never is."""
        return abs(self.found - self.expected.value) <= self.expected.tolerance


def read_expectations(path: Path | str) -> list[Expectation]:
    """Read the expectations from a TOML file; at least one must be there."""
    path = Path(path)
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
        entries = content.pop("expect", [])
        if content or not entries:
            raise FileError("only [[expect]] entries are known, and one at least is needed.")
        return [Expectation(**entry) for entry in entries]
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError, TypeError, FileError) as error:
        raise FileError(f"the expectations {path}: {error}") from None


def compare(history: History, expectations: Sequence[Expectation], folder: Path | str = ".") -> list[Comparison]:
    """Measure each expectation; `against` names files relative to `folder`."""
    @cache
    def reference(name: str) -> History:
        path = Path(folder) / name
        return read_history(path) if path.suffix == ".csv" else semi_analytic(read_deck(path))

    def measure(expected: Expectation) -> float:
        if expected.quantity == "rms_force":
            return rms_force_difference(history, reference(expected.against))
        if expected.quantity == "at":
            return history.at(expected.column, expected.time)
        if expected.column:
            return COLUMN_QUANTITIES[expected.quantity](history[expected.column])
        return QUANTITIES[expected.quantity](history)

    return [Comparison(expected, measure(expected)) for expected in expectations]


def table(comparisons: Sequence[Comparison]) -> str:
    """Return the comparisons as lines of text."""
    width = max(len(comparison.expected.label) for comparison in comparisons)
    lines = [f"{'quantity':<{width}} {'expected':>13} {'found':>13} {'difference':>13} {'tolerance':>13}"]
    for comparison in comparisons:
        expected = comparison.expected
        numbers = (expected.value, comparison.found, comparison.found - expected.value, expected.tolerance)
        verdict = "pass" if comparison.passed else "FAIL"
        lines.append(f"{expected.label:<{width}} " + " ".join(f"{number:13.6g}" for number in numbers) + f" {verdict}")
    return "\n".join(lines)


def _is_number(value: object) -> bool:
    """Tell whether `value` is a finite number."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _command(options: argparse.Namespace) -> int:
    """Compare and print."""
    comparisons = compare(read_history(options.history), read_expectations(options.expect), options.expect.parent)
    print(table(comparisons))
    return EXIT_DONE if all(comparison.passed for comparison in comparisons) else EXIT_USAGE


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; the exit code is 1 if an expectation isn't met."""
    parser = CommandParser("implam-compare", description="Compare a history with what is expected of it.")
    parser.add_argument("history", type=Path, metavar="HISTORY.csv", help="history written by implam")
    parser.add_argument("expect", type=Path, metavar="EXPECT.toml", help="table of [[expect]] entries")
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
