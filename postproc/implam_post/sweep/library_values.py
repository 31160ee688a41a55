"""Write the values of published materials into a deck, so that they can scatter like values of the deck."""

import re
import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path

from implam_post.io.deck import Deck, system_of_deck
from implam_post.io.deck_text import KeyPath, deck_value, set_keys
from implam_post.io.errors import DeckError, FileError, reason
from implam_post.io.program import environment
from implam_post.io.units import SYSTEMS

# Values by material and key, in SI, with their units.
Library = dict[str, dict[str, tuple[float, str]]]
# Powers of length, mass and time in the units of the table.
_UNITS = {"Pa": (-1, 1, -2), "J/m^2": (0, 1, -2), "kg/m^3": (-3, 1, 0), "-": (0, 0, 0)}
_TOUGHNESSES = ("G_Ic", "G_IIc", "eta")
_ROW = re.compile(r"\s+(\w+)\s+(Pa|J/m\^2|kg/m\^3|-|unit)\s+(.*)")
_WAITING = 60.0


def asking(program: Sequence[str] | None) -> Callable[[], Library]:
    """Return a function that requests the table of published materials from the program."""
    def request() -> Library:
        if program is None:
            raise FileError("the deck has a published material, whose values only the program has: give --program.")
        try:
            ended = subprocess.run([program[-1], "explain", "materials"], stdin=subprocess.DEVNULL, capture_output=True,
                                   text=True, timeout=_WAITING, check=False, env=environment())
        except (OSError, subprocess.TimeoutExpired) as error:
            raise FileError(f"the program {program[-1]} does not list published materials ({reason(error)}).") from None
        return read_library(ended.stdout)
    return request


def read_library(text: str) -> Library:
    """Return the table of `implam explain materials`; empty if there is none."""
    library: Library = {}
    names: list[str] = []
    for key, unit, cells in (match.groups() for match in map(_ROW.match, text.splitlines()) if match):
        if key == "key":
            names = cells.split()
            library = {name: {} for name in names}
            continue
        words = re.findall(r"-(?:\s|$)|\S+ \S+", f"{cells} ")
        if len(words) == len(names):
            for name, word in zip(names, words, strict=True):
                if word.strip() != "-":
                    library[name][key] = (float(word.split()[0]), unit)
    return library


def adopt(text: str, name: str, request: Callable[[], Library]) -> str:
    """Return a deck with the values of its published materials; values given in the deck are kept."""
    deck = Deck(text, Path(name))
    materials = deck.groups.get("material", [])
    named = {place: str(group["library"][0]) for place, group in enumerate(materials, start=1) if group.get("library")}
    if not named:
        return text
    library, system = request(), system_of_deck(deck)
    if system not in SYSTEMS:
        raise DeckError(f"{name}: a published material needs the units of the deck (&case units).")
    settings: dict[KeyPath, str] = {}

    def take(group: str, place: int, key: str, values: dict[str, tuple[float, str]]) -> None:
        if key in values and key.lower() not in deck.groups[group][place - 1]:
            value, unit = values[key]
            for size, power in zip(SYSTEMS[system], _UNITS[unit], strict=True):
                value /= size**power
            settings[KeyPath(group, place, key)] = deck_value(value)

    for place, published in named.items():
        if published.lower() not in library:
            raise DeckError(f"{name}: '{published}' is not one of the published materials {', '.join(library)}.")
        for key in library[published.lower()]:
            if key not in _TOUGHNESSES:
                take("material", place, key, library[published.lower()])
    # Interfaces have the toughness of the material if the deck has only one (src/case/deck_library.f90).
    if len({str(group.get("library", [""])[0]).lower() for group in materials}) == 1:
        for place, group in enumerate(deck.groups.get("delamination", []), start=1):
            for key in () if {"g_c", "g_ic", "g_iic"} & group.keys() else _TOUGHNESSES:
                take("delamination", place, key, library[named[1].lower()])
    return set_keys(text, settings, name)
