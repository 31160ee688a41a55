"""Tests of random samples: distributions and reproducibility."""

import statistics
import unittest

from implam_post.io.errors import DeckError
from implam_post.sweep.samples import draw

UNIFORM = {"distribution": "uniform", "low": 2, "high": 4}
NORMAL = {"distribution": "normal", "mean": 10, "deviation": 0.5}
LOGNORMAL = {"distribution": "lognormal", "mean": 3, "deviation": 0.9}


class SamplesTest(unittest.TestCase):
    """Moments, strata and repeatability."""

    def test_moments(self) -> None:
        """Mean and deviation of 4000 samples are the given ones within four standard errors."""
        for distribution, mean, deviation in ((UNIFORM, 3, 2 / 12**0.5), (NORMAL, 10, 0.5), (LOGNORMAL, 3, 0.9)):
            found = draw("x", distribution, 4000, 1, "random")
            self.assertAlmostEqual(statistics.mean(found), mean, delta=4 * deviation / 4000**0.5)
            self.assertAlmostEqual(statistics.stdev(found) / deviation, 1, delta=0.1)

    def test_latin_hypercube(self) -> None:
        """Each interval of equal probability has one sample, and the order differs between names."""
        found = [draw(name, UNIFORM, 50, 1, "latin_hypercube") for name in ("x", "y")]
        for values in found:
            self.assertEqual(sorted(int((value - 2) * 25) for value in values), list(range(50)))
        self.assertNotEqual(*found)
        self.assertNotEqual(found[0], sorted(found[0]))

    def test_the_same_everywhere(self) -> None:
        """Numbers are the same in every version of Python; more samples begin with the same ones; seeds differ."""
        found = draw("impactor.mass", UNIFORM, 3, 1, "random")
        for value, expected in zip(found, (3.6398311227842406, 2.9241059264754803, 3.887768357058477), strict=True):
            self.assertEqual(value, expected)
        self.assertEqual(draw("impactor.mass", UNIFORM, 9, 1, "random")[:3], found)
        self.assertNotEqual(draw("impactor.mass", UNIFORM, 3, 2, "random"), found)

    def test_refused(self) -> None:
        """Invalid distributions are refused."""
        for wrong in (3, {}, {"distribution": "beta"}, {"distribution": "uniform", "low": 1},
                      {**UNIFORM, "mean": 3}, {**UNIFORM, "low": 4}, {**NORMAL, "deviation": 0},
                      {**LOGNORMAL, "mean": -1}, {**NORMAL, "mean": "a"}, {**NORMAL, "mean": float("nan")}):
            with self.assertRaises(DeckError):
                draw("x", wrong, 2, 1, "random")
