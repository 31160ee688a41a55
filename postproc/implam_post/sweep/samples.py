"""Random samples of quantities, reproducible on every machine; each name has its own stream of random numbers."""

import math
import random
from collections.abc import Callable, Mapping
from statistics import NormalDist

from implam_post.io.errors import DeckError

Quantile = Callable[[float], float]
METHODS = ("random", "latin_hypercube")
_PARAMETERS = {"uniform": ("low", "high"), "normal": ("mean", "deviation"), "lognormal": ("mean", "deviation")}


def draw(name: str, distribution: object, number: int, seed: int, method: str) -> list[float]:
    """Return `number` samples of a quantity.

    With "random", a larger number begins with the same samples. With "latin_hypercube", each of `number` intervals of
    equal probability contains one sample, in random order. Streams depend on seed and name only, so that another
    quantity does not change the samples of this one.
    """
    quantile = _quantile(name, distribution)
    # Of this generator only random() is guaranteed to give the same numbers in every version of Python. numpy's
    # Generator and scipy.stats.qmc have no such guarantee, but a sweep continues only with the same decks.
    stream = random.Random(f"{seed} {name}")
    shares = [stream.random() for _ in range(number)]
    if method == "latin_hypercube":
        keys = [stream.random() for _ in range(number)]
        order = sorted(range(number), key=keys.__getitem__)
        shares = [(place + share) / number for place, share in zip(order, shares, strict=True)]
    return [quantile(min(max(share, 2.0**-54), 1 - 2.0**-53)) for share in shares]


def _quantile(name: str, distribution: object) -> Quantile:
    """Return the quantile function of a distribution given by its table in the file."""
    if not isinstance(distribution, Mapping) or distribution.get("distribution") not in _PARAMETERS:
        raise DeckError(f"{name}: a distribution is required, one of {', '.join(_PARAMETERS)}.")
    kind = distribution["distribution"]
    names = _PARAMETERS[kind]
    values = [distribution.get(parameter) for parameter in names]
    finite = [isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
              for value in values]
    if set(distribution) != {"distribution", *names} or not all(finite):
        raise DeckError(f"{name}: {kind} needs {' and '.join(names)}, finite numbers, and no other keys.")
    if kind == "uniform":
        low, high = values
        if low >= high:
            raise DeckError(f"{name}: low must be less than high.")
        return lambda share: low + share * (high - low)
    mean, deviation = values
    if deviation <= 0 or (kind == "lognormal" and mean <= 0):
        also = " and the mean" if kind == "lognormal" else ""
        raise DeckError(f"{name}: the deviation{also} must be greater than zero.")
    if kind == "normal":
        return NormalDist(mean, deviation).inv_cdf
    spread = math.log1p((deviation / mean)**2)
    logarithm = NormalDist(math.log(mean) - spread / 2, math.sqrt(spread))
    return lambda share: math.exp(logarithm.inv_cdf(share))
