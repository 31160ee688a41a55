"""Tests of errors and Pareto front of a study, on given numbers."""

import math
import unittest

import numpy as np

from implam_post.io.history import History
from implam_post.study.table import _percent, force_history_error, front


class FrontTest(unittest.TestCase):
    """The Pareto front."""

    def test_front(self) -> None:
        """A lower value in one number is sufficient; equal points are both on the front; points with NaN are not."""
        points = [(1, 5), (2, 2), (2, 3), (5, 1), (5, 1), (6, 6), (math.nan, 0.1), (0.1, math.nan)]
        self.assertEqual(front(points), [True, True, False, True, True, False, False, False])
        self.assertEqual(front([]), [])


class ErrorTest(unittest.TestCase):
    """The error of a force history."""

    def history(self, rows: int, factor: float = 1.0, last: float = 1.0, shift: float = 0.0) -> History:
        """Return half a wave of sin, in rows that begin after time 0, as those of the program."""
        time = np.linspace(0, last, rows + 1)[1:]
        return History({"time": time, "force": factor * np.sin(np.pi * (time - shift))})

    def test_factor_and_shift(self) -> None:
        """The error of a factor 1 + e is e; that of a small shift s is pi s, as cos and sin have the same norm."""
        reference = self.history(2000)
        self.assertAlmostEqual(force_history_error(self.history(2000, 1.03), reference), 0.03, delta=1e-9)
        self.assertAlmostEqual(force_history_error(self.history(2000, shift=0.01), reference), 0.01 * np.pi, delta=1e-4)

    def test_rows(self) -> None:
        """Linear interpolation between rows has the error sqrt(30)/60 (pi h)^2/2 of the norm of sin."""
        spacing = 1 / 40
        found = force_history_error(self.history(40), self.history(4000))
        self.assertAlmostEqual(found / ((np.pi * spacing)**2 / 2 * math.sqrt(1 / 30)), 1, delta=0.01)

    def test_common_time(self) -> None:
        """Only the common time counts; without force in it the error is NaN."""
        reference = self.history(2000)
        self.assertAlmostEqual(force_history_error(self.history(1000, 1.02, last=0.5), reference), 0.02, delta=1e-6)
        nothing = History({"time": reference.time, "force": 0 * reference.time})
        self.assertTrue(math.isnan(force_history_error(reference, nothing)))

    def test_text(self) -> None:
        """Errors are rounded by their size; that of the force history has no sign."""
        self.assertEqual([_percent(0.01234, "peak_force"), _percent(-0.3, "peak_force"), _percent(2.5, "peak_force"),
                          _percent(0.01234, "force_history"), _percent(math.nan, "peak_force")],
                         ["+1.23", "-30.0", "+250", "1.23", ""])
