"""The deck: its groups, and the values of their keys or defaults."""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from implam_post.io.errors import DeckError
from implam_post.io.files import read_deck_text, text_of
from implam_post.io.namelist import Value, read_namelist
from implam_post.io.units import SYSTEMS, system_of


class Deck:
    """The groups of a deck; methods return values of keys or defaults."""

    def __init__(self, text: str, path: Path, adopted: str | None = None) -> None:
        """Read the groups from `text`; `path` names the deck in messages.

        `adopted` lists the values of published materials in a run, one per line: &material 1 E1 = 130e9 [source];
        None: the deck does not come from a run.
        """
        self.path, self.has_adopted = path, adopted is not None
        self.groups = read_namelist(text, path.name)
        for group, place, key, value in re.findall(r"&(\w+) (\d+) (\w+) = (\S+) \[", adopted or ""):
            given = read_namelist(f"&{group} {key}={value} /", path.name)[group][0]
            self.groups[group][int(place) - 1] = given | self.groups[group][int(place) - 1]

    @property
    def name(self) -> str:
        """Name of the case, with which the names of the results begin."""
        return str(self.value("case", "name", self.path.stem))

    @property
    def directory(self) -> Path:
        """Folder of the results."""
        return Path(str(self.value("output", "directory", ".")))

    def has(self, group: str) -> bool:
        """Return whether the deck has a group of this name."""
        return group.lower() in self.groups

    def values(self, group: str, key: str) -> list[Value]:
        """Return all values of a key; empty if the deck does not have it."""
        found = self.groups.get(group.lower(), [])
        if len(found) > 1:
            raise self.error(group, "is given more than once.")
        return found[0].get(key.lower(), []) if found else []

    def value(self, group: str, key: str, default: Value | None = None) -> Value:
        """Return the value of a key, or `default` if the deck does not have it; a key without a default is required."""
        return self.single(self.values(group, key), group, key, default)

    def number(self, group: str, key: str, default: float | None = None) -> float:
        """Return the value of a key as a number; see `value`."""
        return as_number(self.value(group, key, default), f"{self.path.name}: &{group} {key}")

    def numbers(self, group: str, key: str) -> list[float]:
        """Return all values of a key as numbers; empty if the deck does not have it."""
        return [as_number(value, f"{self.path.name}: &{group} {key}") for value in self.values(group, key)]

    def choice(self, group: str, key: str, allowed: Iterable[str]) -> str:
        """Return a word, one of `allowed`, the first of which is the default."""
        allowed = list(allowed)
        word = str(self.value(group, key, allowed[0])).lower()
        if word not in allowed:
            raise self.error(group, f"{key} = '{word}' is not one of {', '.join(allowed)}.")
        return word

    def lengths(self) -> tuple[float, float]:
        """Return the sides of the full plate along x and y."""
        sides = self.numbers("plate", "length")
        if len(sides) != 2 or min(sides) <= 0:
            raise self.error("plate", "length must be the two sides of the plate, greater than zero.")
        return sides[0], sides[1]

    def edges(self) -> list[str]:
        """Return the supports at x-min, x-max, y-min and y-max."""
        return [str(edge).lower() for edge in self.spread(self.values("plate", "edges"), 4, "plate")]

    def error(self, group: str, sentence: str) -> DeckError:
        """Return an error that names deck and group."""
        return DeckError(f"{self.path.name}: &{group}: {sentence}")

    def single(self, values: list[Value], group: str, key: str, default: Value | None) -> Value:
        """Return the only value of a key, or its default."""
        if len(values) > 1:
            raise self.error(group, f"{key} must be one value.")
        if values:
            return values[0]
        if default is None:
            raise self.error(group, f"{key} is required.")
        return default

    def spread(self, values: list[Value], count: int, group: str) -> list[Value]:
        """Return `count` values; a single value is repeated."""
        if len(values) not in (1, count):
            raise self.error(group, f"a list has {len(values)} values where 1 or {count} are required.")
        return values if len(values) == count else count * values


def as_number(value: Value, where: str) -> float:
    """Return `value` if it is a finite number."""
    if isinstance(value, (bool, str)) or not np.isfinite(value):
        raise DeckError(f"{where}: {value!r} is not a number.")
    return value


def recorded_deck(provenance: Mapping[str, Any], path: Path) -> Deck:
    """Return the deck of a run from the provenance in its results, with the values of published materials."""
    deck, adopted = (text if isinstance(text, str) else text_of(text[()])
                     for text in (provenance["deck"], provenance.get("library", "")))
    return Deck(deck, path, adopted)


def read_deck(path: Path | str) -> Deck:
    """Read the deck from its file."""
    path = Path(path)
    return Deck(read_deck_text(path), path)


def system_of_deck(deck: Deck | None) -> str:
    """Return the system of units of a deck: the one it gives, else that in which the first density is of a solid."""
    if deck is None:
        return ""
    try:
        named = str(deck.value("case", "units", "")).lower()
    except DeckError:
        return ""
    densities = [group["density"][0] for group in deck.groups.get("material", []) if "density" in group]
    density = next((value for value in densities if isinstance(value, float)), None)
    return next((name for name in SYSTEMS if name.lower() == named), "") or system_of(density)
