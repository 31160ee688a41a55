"""Statistics of runs that differ in random inputs: means with their scatter, and differences of two variants."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit

LOW, HIGH = 0.05, 0.95
# Probability with which no difference is taken for one, either way.
_RISK = 0.05


@dataclass(frozen=True)
class Spread:
    """Statistics of a figure over runs: their number, mean, standard deviation, and the 5 and 95 % points."""

    number: int
    mean: float
    deviation: float
    low: float
    high: float

    @property
    def error(self) -> float:
        """Return the standard deviation of the mean; NaN of a single run."""
        return self.deviation / math.sqrt(self.number) if self.number > 1 else math.nan


@dataclass(frozen=True)
class Difference:
    """How much larger a figure is in a second variant than in the first, over pairs of runs with the same inputs."""

    number: int
    first: float
    mean: float
    error: float

    @property
    def least(self) -> float:
        """Return the least difference that exceeds the scatter of its mean; NaN of fewer than two pairs."""
        return stdtrit(self.number - 1, 1 - _RISK / 2) * self.error if self.number > 1 else math.nan

    @property
    def differs(self) -> bool:
        """Return whether the difference is larger than the scatter of its mean."""
        return self.number > 1 and abs(self.mean) > self.least


def spread_of(values: Sequence[float]) -> Spread:
    """Return mean and scatter of the values that are there.

    Points of 5 and 95 % are those that are unbiased for the median whatever the distribution; of fewer than 14 runs
    they are the least and the largest one.
    """
    found = np.array([value for value in values if math.isfinite(value)])
    if not len(found):
        return Spread(0, *4 * (math.nan,))
    deviation = float(np.std(found, ddof=1)) if len(found) > 1 else math.nan
    low, high = np.quantile(found, (LOW, HIGH), method="median_unbiased")
    return Spread(len(found), float(np.mean(found)), deviation, float(low), float(high))


def difference_of(first: Sequence[float], second: Sequence[float]) -> Difference:
    """Return the difference of two variants, run by run, where both have the figure."""
    pairs = np.array([pair for pair in zip(first, second, strict=True) if all(map(math.isfinite, pair))])
    if not len(pairs):
        return Difference(0, *3 * (math.nan,))
    changes = pairs[:, 1] - pairs[:, 0]
    error = float(np.std(changes, ddof=1) / math.sqrt(len(changes))) if len(changes) > 1 else math.nan
    return Difference(len(changes), float(np.mean(pairs[:, 0])), float(np.mean(changes)), error)


def spreads(figures: Sequence[Mapping[str, float]]) -> dict[str, Spread]:
    """Return the statistics of every figure that a run has, runs without a result left out."""
    names = dict.fromkeys(name for run in figures for name in run)
    return {name: spread_of([run.get(name, math.nan) for run in figures]) for name in names}


def differences(first: Sequence[Mapping[str, float]], second: Sequence[Mapping[str, float]]) -> dict[str, Difference]:
    """Return the differences of every figure that both variants have."""
    names = [name for name in dict.fromkeys(name for run in first for name in run)
             if any(name in run for run in second)]
    return {name: difference_of(*([run.get(name, math.nan) for run in runs] for runs in (first, second)))
            for name in names}
