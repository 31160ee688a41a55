"""Run decks and compare them with expected values."""

import shutil
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from implam_post.io.errors import FileError, ImplamError
from implam_post.io.history import History, read_history
from implam_post.io.program import history_in
from implam_post.io.progress import Progress
from implam_post.io.start import RunError, run_deck
from implam_post.regress.compare import Comparison, check_expectations, heading
from implam_post.regress.expectations import AS_IT_IS, Expectations, Variant


@dataclass(eq=False)
class Outcome:
    """Result of one variant, run in a folder: its comparisons or the reason why there are none, and wall-clock time."""

    expectations: Expectations
    variant: Variant
    deck: Path
    folder: Path
    comparisons: list[Comparison] = field(default_factory=list)
    fault: str = ""
    seconds: float = 0.0
    history: History | None = None

    @property
    def label(self) -> str:
        """Name of the run."""
        name = self.expectations.path.stem
        return name if self.variant.name == AS_IT_IS else f"{name}/{self.variant.name}"

    @property
    def passed(self) -> bool:
        """Whether there are expectations and all are met."""
        return not self.fault and bool(self.comparisons) and all(comparison.passed for comparison in self.comparisons)

    @property
    def verdict(self) -> str:
        """Reason of the failure in one line; empty if the variant passed."""
        missed = [comparison.expected.label for comparison in self.comparisons if not comparison.passed]
        return self.fault or (f"not as expected: {', '.join(missed)}" if missed else "")


def run_variant(outcome: Outcome, program: Sequence[str], timeout: float | None) -> None:
    """Run a variant and compare it; the result is stored in `outcome`."""
    start = time.monotonic()
    try:
        shutil.rmtree(outcome.folder, ignore_errors=True)
        outcome.fault = _run(outcome, program, timeout)
        if not outcome.fault:
            outcome.history = _finite_history(outcome.folder)
            outcome.comparisons = check_expectations(outcome.history, outcome.variant.expectations,
                                                     outcome.expectations.path.parent)
    except ImplamError as error:
        outcome.fault = str(error)
    outcome.seconds = time.monotonic() - start


def _run(outcome: Outcome, program: Sequence[str], timeout: float | None) -> str:
    """Run the deck of a variant in its folder; return the error, empty if there is none."""
    started = run_deck(outcome.deck, outcome.variant.settings, outcome.folder, program, "deck.nml")
    try:
        started.wait(timeout)
    except (RunError, TimeoutError) as error:
        return str(error)
    finally:
        if started.is_running:
            started.kill()
    return ""


def _finite_history(folder: Path) -> History:
    """Return the history in a folder; raise an error unless all its numbers are finite."""
    path = history_in(folder)
    if path is None:
        raise FileError(f"{folder} has no history.")
    history = read_history(path)
    for name, values in history.columns.items():
        if not np.all(np.isfinite(values)):
            raise FileError(f"the column {name} of the history has values that are not finite.")
    return history


def run_all(outcomes: Sequence[Outcome], program: Sequence[str], jobs: int, timeout: float | None) -> None:
    """Run variants, up to `jobs` simultaneously."""
    with ThreadPoolExecutor(jobs) as pool, Progress(len(outcomes)) as progress:
        runs = {pool.submit(run_variant, outcome, program, timeout): outcome for outcome in outcomes}
        try:
            for ended in as_completed(runs):
                ended.result()
                progress.end_run(runs[ended].label, runs[ended].verdict)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def table(outcomes: Sequence[Outcome]) -> str:
    """Return all comparisons as lines of text."""
    rows = [(outcome.label, comparison) for outcome in outcomes for comparison in outcome.comparisons]
    runs = max([len(outcome.label) for outcome in outcomes])
    width = max([len(comparison.expected.label) for _, comparison in rows] + [len("quantity")])
    lines = [f"{'run':<{runs}} {heading(width)}"]
    for outcome in outcomes:
        if outcome.fault:
            lines.append(f"{outcome.label:<{runs}} {outcome.fault} FAIL")
        lines += [f"{outcome.label:<{runs}} {comparison.row(width)}" for comparison in outcome.comparisons]
    return "\n".join(lines)
