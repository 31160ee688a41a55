"""Cells of a panel that are delaminated by the starters of its deck, chosen as in the solver."""

import itertools
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from implam_post.io.deck import Deck, as_number
from implam_post.io.namelist import Group
from implam_post.laminate.sections import Ply

# Keys of a front; without a law, one of them makes the interface a front (src/delamination/delamination_deck.f90).
_FRONT_KEYS = ("energy_release", "growth", "tie", "penalty", "unloading", "smoothing", "contact_exponent")
# Strengths of a cohesive law, and those of the adjacent plies that are their defaults.
_STRENGTHS = {"strength_opening": "YT", "strength_shear": "S12"}
# Fraction of the plate area that the starter of a front covers by default.
_DEFAULT_PART = 0.0005
# Smallest difference of fibre angles, degrees, between plies that have an interface.
_SAME_ANGLE = 1e-6


def starters_of(deck: Deck, plies: Sequence[Ply], x: np.ndarray, y: np.ndarray, images: Iterable[tuple[int, int]]
                ) -> list[tuple[int, np.ndarray]]:
    """Return for each starter the ply above it and its cells, (columns, rows), of the full plate.

    `x` and `y` are the lines between cells; `images` are the signs of x and y under the symmetry of the deck.
    """
    found = []
    struck = _pair(deck, deck.groups.get("impactor", [{}])[0], "impactor", "at")
    for group in deck.groups.get("delamination", []):
        for below_ply in _interfaces(deck, group, plies):
            cells = _cells(deck, group, below_ply < len(plies) and _is_front(group, plies[below_ply - 1:below_ply + 1]),
                           x - struck[0], y - struck[1])
            found.append((below_ply, np.any([cells[::along, ::across] for along, across in images], axis=0)))
    return found


def _interfaces(deck: Deck, group: Group, plies: Sequence[Ply]) -> Iterator[int]:
    """Yield the plies above the interfaces of a group; the bond of doublers on the back, always cohesive, is below the
    last, and that on the struck face is rigid in exports.
    """
    if "doubler" in group:
        names = {str(name).lower() for name in group["doubler"]}
        if not any(str(other.get("face", ["back"])[0]).lower() == "front" for other in deck.groups.get("doubler", [])
                   if str(other.get("name", [""])[0]).lower() in names):
            yield len(plies)
        return
    named = group.get("below_ply", [0.0])
    if str(named[0]).lower() in ("all", "between_angles"):
        named = [float(place) for place, (above, below) in enumerate(itertools.pairwise(plies), start=1)
                 if abs((below.angle - above.angle + 90) % 180 - 90) > _SAME_ANGLE
                 or above.material.name.lower() != below.material.name.lower()]
    for value in named:
        below_ply = as_number(value, f"{deck.path.name}: &delamination below_ply")
        if below_ply not in range(1, len(plies)):
            raise deck.error("delamination", f"below_ply must be integers from 1 to {len(plies) - 1}.")
        yield int(below_ply)


def _is_front(group: Group, beside: Sequence[Ply]) -> bool:
    """Return whether the interface between two plies delaminates by a front rather than a cohesive law."""
    if "law" in group:
        return str(group["law"][0]).lower() == "front"
    return any(key in group for key in _FRONT_KEYS) or not all(
        key in group or all(dict(ply.material.strengths).get(of_plies, 0) > 0 for ply in beside)
        for key, of_plies in _STRENGTHS.items())


def _cells(deck: Deck, group: Group, is_front: bool, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return the cells of a starter, (columns, rows); `x` and `y` are measured from the struck point."""
    if "starter_strip" in group:
        first, last = _pair(deck, group, "delamination", "starter_strip")
        _, width = _pair(deck, group, "delamination", "zone", (np.inf, np.inf))
        return np.outer((_middles(x) > first) & (_middles(x) < last), _within(y, width))
    if "starter" not in group and not is_front:
        return np.zeros((len(x) - 1, len(y) - 1), dtype=bool)
    side = (as_number(group["starter"][0], f"{deck.path.name}: &delamination starter") if "starter" in group
            else np.sqrt(_DEFAULT_PART * np.prod(deck.lengths())))
    centre = _pair(deck, group, "delamination", "starter_at")
    x, y = x - centre[0], y - centre[1]
    cells = np.outer(_within(x, side), _within(y, side))
    if str(group.get("starter_shape", ["square"])[0]).lower() == "round":
        cells &= (2 * np.hypot.outer(_middles(x), _middles(y)) < side) | np.outer(_touching(x), _touching(y))
    return cells


def _middles(lines: np.ndarray) -> np.ndarray:
    """Return the midpoints between lines."""
    return (lines[1:] + lines[:-1]) / 2


def _touching(lines: np.ndarray) -> np.ndarray:
    """Return which cells touch 0."""
    rounding = 1e-9 * np.ptp(lines)
    return (lines[1:] > -rounding) & (lines[:-1] < rounding)


def _within(lines: np.ndarray, extent: float) -> np.ndarray:
    """Return which cells have their centre within an extent about 0, border excluded, or touch 0."""
    return (2 * np.abs(_middles(lines)) < extent - 1e-9 * np.ptp(lines)) | _touching(lines)


def _pair(deck: Deck, group: Group, name: str, key: str, default: tuple[float, float] = (0.0, 0.0)
          ) -> tuple[float, float]:
    """Return the two numbers of a key, or its default."""
    if key not in group:
        return default
    first, second = deck.spread(group[key], 2, name)
    where = f"{deck.path.name}: &{name} {key}"
    return as_number(first, where), as_number(second, where)
