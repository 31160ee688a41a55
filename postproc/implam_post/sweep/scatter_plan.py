"""Inputs that scatter: keys of a deck, coefficients of variation with their sources, and values for each run."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from implam_post.io.deck import Deck, as_number, system_of_deck
from implam_post.io.deck_text import KeyPath, deck_value, key_path, set_keys
from implam_post.io.errors import DeckError
from implam_post.io.units import SYSTEMS
from implam_post.sweep.samples import METHODS, draw

MAX_RUNS = 10_000
THICKNESS, PLACE = "thickness", "place"


@dataclass(frozen=True)
class Kind:
    """A kind of inputs: keys by group, coefficient of variation, and its source.

    For the place of impact it is a standard deviation along x and y, in metres.
    """

    name: str
    keys: dict[str, tuple[str, ...]]
    variation: float
    source: str


KINDS = (
    Kind(THICKNESS, {"laminate": ("thicknesses", "ply_thickness")}, 0.023,
         "equal for all plies, uniform within 4 % (Qu, dissertation, University of Florida 2004, table 8-14)"),
    Kind("moduli", {"material": ("E", "E1", "E1c", "E2", "G12", "G13", "G23")}, 0.03,
         "AS4/epoxy (Qu 2004, table 8-12); G13 as G12, since plies are transversely isotropic, E1c as E1, since both "
         "follow the content of fibres"),
    Kind("strengths", {"material": ("XT", "XC", "YT", "YC", "S12", "Sf", "Sm23"),
                       "delamination": ("strength_opening", "strength_shear")}, 0.06,
         "smallest modified coefficient of variation of a strength by CMH-17-1G"),
    Kind("toughness", {"material": ("G_ft", "G_fc", "G_mt", "G_mc"), "delamination": ("G_c", "G_Ic", "G_IIc")}, 0.12,
         "twice that of a strength, as toughness is proportional to the square of the measured load"),
    Kind("speed", {"impactor": ("velocity", "energy")}, 0.002,
         "5 mm/s, the accuracy of velocity by ASTM D7136, at 2.5 m/s"),
    Kind(PLACE, {"impactor": ("at",)}, 0.58e-3,
         "uniform within 1 mm, the tolerance of the window of the frame by ASTM D7136 (75 and 125 mm, +-1 mm)"),
)


@dataclass(frozen=True)
class Input:
    """An input that scatters: name of its column, key, kind and coefficient of variation."""

    column: str
    path: KeyPath
    kind: str
    variation: float


@dataclass(frozen=True)
class Scatter:
    """The table [scatter] of a sweep: number of runs, seed, method, and coefficients other than the defaults."""

    number: int
    seed: int
    method: str
    variations: Mapping[str, float]
    keys: Mapping[KeyPath, float]

    def inputs(self, deck: Deck) -> list[Input]:
        """Return the inputs of a deck that scatter: those given in it, in the order of KINDS."""
        stated = [found for kind in KINDS[:-1] for found in self._inputs_of(kind, deck)]
        for path in self.keys:
            if not any(_names(path, found.path) for found in stated):
                raise DeckError(f"[scatter] {path}: the deck does not have this key.")
        return [found for found in [*stated, *self._places(deck)] if found.variation > 0]

    def note(self, deck: Deck) -> str:
        """Return the reason why the place of impact does not scatter; empty if it does, or without an impact."""
        if not deck.has("impactor") or self.variations.get(PLACE) == 0:
            return ""
        if str(deck.value("plate", "symmetry", "none")).lower() != "none":
            return "the place of impact does not scatter: the deck models a part of the plate (symmetry of &plate)."
        if PLACE not in self.variations and system_of_deck(deck) not in SYSTEMS:
            return (f"the place of impact does not scatter: its default, {KINDS[-1].variation:g} m, needs the units of "
                    "the deck (&case units).")
        return ""

    def _inputs_of(self, kind: Kind, deck: Deck) -> Iterator[Input]:
        """Yield the inputs of a kind that are given in a deck."""
        for group, keys in kind.keys.items():
            groups = deck.groups.get(group, [])
            for place, entry in enumerate(groups, start=1):
                for key in keys:
                    if key.lower() in entry:
                        path = KeyPath(group, place if len(groups) > 1 else None, key)
                        # The coefficient of a numbered group has precedence over that of all groups.
                        own = [value for given, value in sorted(self.keys.items(), key=lambda item: not item[0].number)
                               if _names(given, path)]
                        yield Input(f"{THICKNESS if kind.name == THICKNESS else path} factor", path, kind.name,
                                    [*own, self.variations.get(kind.name, kind.variation)][0])

    def _places(self, deck: Deck) -> Iterator[Input]:
        """Yield the place of impact along x and y."""
        if deck.has("impactor") and not self.note(deck):
            system = system_of_deck(deck)
            default = KINDS[-1].variation / SYSTEMS[system][0] if system in SYSTEMS else 0.0
            spread = self.variations.get(PLACE, default)
            for axis in ("x", "y"):
                yield Input(f"place {axis}", KeyPath("impactor", None, "at"), PLACE, spread)

    def set(self, text: str, name: str, run: int) -> tuple[str, dict[str, float]]:
        """Return the deck of a run, counted from 0, and its random samples: factors, and shifts of the place."""
        deck, drawn, settings = Deck(text, Path(name)), {}, {}
        for found in self.inputs(deck):
            drawn[found.column] = value = self._values(found)[run]
            group = deck.groups[found.path.group][(found.path.number or 1) - 1]
            where = f"{name}: &{found.path.group} {found.path.key}"
            numbers = [as_number(number, where) for number in group.get(found.path.key.lower(), [0.0, 0.0])]
            if found.kind == PLACE:
                numbers[found.column.endswith("y")] += value
                group["at"] = numbers
            else:
                power = 2 if found.path.key.lower() == "energy" else 1
                numbers = [number * value**power for number in numbers]
            settings[found.path] = deck_value(numbers)
        return set_keys(text, settings, name), drawn

    def _values(self, found: Input) -> list[float]:
        """Return the samples of an input for all runs, which do not depend on other inputs.

        The first group of a name has the same samples as a single one, so that variants without the second are paired.
        """
        column = found.column.replace("[1].", ".")
        for tied, leader in (("G13", "G12"), ("E1c", "E1")):
            column = column.replace(f"{tied} factor", f"{leader} factor")
        return _drawn(column, found.kind == PLACE, found.variation, self.number, self.seed, self.method)


def _names(given: KeyPath, path: KeyPath) -> bool:
    """Return whether a key in the file of a sweep means this key of the deck; without a number it means all."""
    same = (given.group, given.key.lower()) == (path.group, path.key.lower())
    return same and (not given.number or given.number == (path.number or 1))


@cache
def _drawn(column: str, is_place: bool, variation: float, number: int, seed: int, method: str) -> list[float]:
    """Return the distribution: shifts with mean 0 for a place, otherwise lognormal factors with mean 1."""
    shape = {"distribution": "normal", "mean": 0.0} if is_place else {"distribution": "lognormal", "mean": 1.0}
    return draw(column, shape | {"deviation": variation}, number, seed, method)


def read_scatter(table: Mapping[str, object] | None) -> Scatter | None:
    """Return the settings of the table [scatter]; None without it."""
    if table is None:
        return None
    if not isinstance(table, Mapping):
        raise DeckError("scatter must be a table: [scatter].")
    number, seed, method = table.get("number"), table.get("seed", 1), table.get("method", "random")
    are_integers = all(isinstance(value, int) and not isinstance(value, bool) for value in (number, seed))
    if not are_integers or not 1 <= number <= MAX_RUNS or method not in METHODS:
        raise DeckError(f"[scatter] needs a number of runs from 1 to {MAX_RUNS}, an integer seed, and a method, one of "
                        f"{', '.join(METHODS)}.")
    kinds, variations, keys = {kind.name for kind in KINDS}, {}, {}
    known = {f"{group}.{key}".lower() for kind in KINDS if kind.name not in (THICKNESS, PLACE)
             for group, names in kind.keys.items() for key in names}
    for name, value in table.items():
        if name in ("number", "seed", "method"):
            continue
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not (
                math.isfinite(value) and value >= 0 and (value < 1 or name == PLACE)):
            raise DeckError(f"[scatter] {name} = {value!r}: a coefficient of variation must be at least 0 and less "
                            f"than 1{', that of the place at least 0, in units of the deck' if name == PLACE else ''}.")
        path = key_path(name)
        if name not in kinds and (path is None or f"{path.group}.{path.key}".lower() not in known):
            raise DeckError(f"[scatter] '{name}' is not one of number, seed, method, {', '.join(sorted(kinds))}, or a "
                            "key of these, such as material.YT or delamination[1].G_IIc.")
        if name in kinds:
            variations[name] = float(value)
        else:
            keys[path] = float(value)
    return Scatter(number, seed, method, variations, keys)
