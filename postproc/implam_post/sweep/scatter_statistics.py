"""Statistics of runs with random inputs: means with their scatter, and differences of two variants."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit

LOW, HIGH = 0.05, 0.95
# Significance level of the two-sided paired t-test.
_RISK = 0.05


@dataclass(frozen=True)
class Spread:
    """Statistics of a figure over runs: number, mean, standard deviation, 5 and 95 % points."""

    number: int
    mean: float
    deviation: float
    low: float
    high: float

    @property
    def error(self) -> float:
        """Standard error of the mean; NaN for a single run."""
        return self.deviation / math.sqrt(self.number) if self.number > 1 else math.nan


@dataclass(frozen=True)
class Difference:
    """Difference of a figure, second variant minus first, over pairs of runs with the same random inputs."""

    number: int
    first: float
    mean: float
    error: float

    @property
    def least(self) -> float:
        """Smallest significant difference; NaN for fewer than two pairs."""
        return stdtrit(self.number - 1, 1 - _RISK / 2) * self.error if self.number > 1 else math.nan

    @property
    def differs(self) -> bool:
        """Whether the difference is significant."""
        return self.number > 1 and abs(self.mean) > self.least


def spread_of(values: Sequence[float]) -> Spread:
    """Return the statistics of the finite values.

    The 5 and 95 % points are median-unbiased for any distribution; of fewer than 14 runs they are the smallest and the
    largest value.
    """
    found = np.array([value for value in values if math.isfinite(value)])
    if not len(found):
        return Spread(0, *4 * (math.nan,))
    deviation = float(np.std(found, ddof=1)) if len(found) > 1 else math.nan
    low, high = np.quantile(found, (LOW, HIGH), method="median_unbiased")
    return Spread(len(found), float(np.mean(found)), deviation, float(low), float(high))


def difference_of(first: Sequence[float], second: Sequence[float]) -> Difference:
    """Return the difference of two variants over the pairs in which both have the figure."""
    pairs = np.array([pair for pair in zip(first, second, strict=True) if all(map(math.isfinite, pair))])
    if not len(pairs):
        return Difference(0, *3 * (math.nan,))
    changes = pairs[:, 1] - pairs[:, 0]
    error = float(np.std(changes, ddof=1) / math.sqrt(len(changes))) if len(changes) > 1 else math.nan
    return Difference(len(changes), float(np.mean(pairs[:, 0])), float(np.mean(changes)), error)


def spreads(figures: Sequence[Mapping[str, float]]) -> dict[str, Spread]:
    """Return the statistics of all figures; runs without a result are omitted."""
    names = dict.fromkeys(name for run in figures for name in run)
    return {name: spread_of([run.get(name, math.nan) for run in figures]) for name in names}


def differences(first: Sequence[Mapping[str, float]], second: Sequence[Mapping[str, float]]) -> dict[str, Difference]:
    """Return the differences of all figures that both variants have."""
    names = [name for name in dict.fromkeys(name for run in first for name in run)
             if any(name in run for run in second)]
    return {name: difference_of(*([run.get(name, math.nan) for run in runs] for runs in (first, second)))
            for name in names}
