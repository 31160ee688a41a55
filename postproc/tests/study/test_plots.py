"""Tests of the plots of a study, on numbers made here."""

import math
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace

from implam_post.study.plots import plot_study


class StoppedStudyTest(unittest.TestCase):
    """A study that was stopped: some trials have no result."""

    def drawn(self, errors: list[float]) -> bool:
        """Return whether a picture is drawn of two problems with one trial each."""
        problems = [SimpleNamespace(name="first"), SimpleNamespace(name="second")]
        trials = [SimpleNamespace(problem=problem, method={"mesh%elements": 8.0}) for problem in problems]
        rows = [SimpleNamespace(trial=trial, errors={"peak_force": error}, time=0.1 if error < 1 else math.nan,
                                on_front=error < 1) for trial, error in zip(trials, errors, strict=True)]
        study = SimpleNamespace(problems=problems, trials=trials, error="peak_force", shown=["mesh%elements"])
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "front.png"
            return plot_study(rows, [], study, path) == path and path.exists()

    def test_problem_without_result(self) -> None:
        """A problem without a complete trial has an empty panel, whichever it is; without any there is no picture."""
        self.assertTrue(self.drawn([0.01, math.nan]))
        self.assertTrue(self.drawn([math.nan, 0.01]))
        self.assertFalse(self.drawn([math.nan, math.nan]))


if __name__ == "__main__":
    unittest.main()
