"""Doublers and ply drops of a deck: the plies at each place of the plate, numbered and stacked as in the solver."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from implam_post.io.deck import Deck, as_number
from implam_post.io.errors import DeckError
from implam_post.io.namelist import Group
from implam_post.laminate.decks import materials_of
from implam_post.laminate.sections import Ply
from implam_post.laminate.stacking import angles_of

FACES = ("front", "back")


class Rectangle(NamedTuple):
    """A rectangle: its centre and sides."""

    at: tuple[float, float]
    size: tuple[float, float]

    def contains(self, x: float, y: float) -> bool:
        """Return whether a point lies within it."""
        return all(abs(place - middle) < side / 2
                   for place, middle, side in zip((x, y), self.at, self.size, strict=True))

    def edges(self, axis: int) -> tuple[float, float]:
        """Return the coordinates of its two edges across an axis."""
        return self.at[axis] - self.size[axis] / 2, self.at[axis] + self.size[axis] / 2


class Doubler(NamedTuple):
    """Plies added on a face; `may_separate` is whether their bond is an interface, so that they are a layer."""

    name: str
    face: str
    area: Rectangle
    plies: tuple[Ply, ...]
    may_separate: bool = False


class PlyDrop(NamedTuple):
    """Plies of the laminate, counted from 1, that are missing."""

    missing: tuple[int, ...]
    area: Rectangle
    flat_face: str


class LayUp(NamedTuple):
    """The plies at a place: their numbers from the struck face on, and z of the struck face from the mid-plane of the
    laminate. Plies of doublers are numbered after those of the laminate.
    """

    numbers: tuple[int, ...]
    front: float


@dataclass(frozen=True)
class Zones:
    """Doublers and ply drops of a laminate."""

    laminate: Sequence[Ply]
    doublers: Sequence[Doubler] = ()
    drops: Sequence[PlyDrop] = ()

    @property
    def plies(self) -> list[Ply]:
        """All plies by their number less one: those of the laminate, then those of each doubler."""
        return [*self.laminate, *(ply for doubler in self.doublers for ply in doubler.plies)]

    def edges(self, axis: int) -> list[float]:
        """Return the coordinates of all edges across an axis."""
        return [edge for zone in (*self.doublers, *self.drops) for edge in zone.area.edges(axis)]

    def at(self, x: float, y: float) -> LayUp:
        """Return the plies at a place."""
        drops = [drop for drop in self.drops if drop.area.contains(x, y)]
        missing = {number for drop in drops for number in drop.missing}
        numbers = [number for number in range(1, len(self.laminate) + 1) if number not in missing]
        height = sum(ply.thickness for ply in self.laminate)
        front = -height / 2
        if drops and drops[-1].flat_face == "back":
            front = height / 2 - sum(self.laminate[number - 1].thickness for number in numbers)
        following = len(self.laminate) + 1
        for doubler in self.doublers:
            added = range(following, following + len(doubler.plies))
            following = added.stop
            if doubler.area.contains(x, y):
                is_front = doubler.face == "front"
                numbers = [*added, *numbers] if is_front else [*numbers, *added]
                front -= sum(ply.thickness for ply in doubler.plies) if is_front else 0.0
        return LayUp(tuple(numbers), float(front))

    def may_separate(self, x: float, y: float, face: str) -> bool:
        """Return whether a doubler on a face has a layer of its own at a place."""
        return any(doubler.may_separate and doubler.face == face and doubler.area.contains(x, y)
                   for doubler in self.doublers)


def zones_of(deck: Deck, laminate: Sequence[Ply]) -> Zones:
    """Return the doublers and ply drops of a deck."""
    doublers = [_doubler(deck, group) for group in deck.groups.get("doubler", [])]
    drops = [_drop(deck, group, len(laminate)) for group in deck.groups.get("ply_drop", [])]
    return Zones(laminate, doublers, drops)


def _doubler(deck: Deck, group: Group) -> Doubler:
    """Return a doubler."""
    def text(key: str, default: str | None = None) -> str:
        return str(deck.single(group.get(key, []), "doubler", key, default))

    try:
        angles = angles_of(text("stacking"))
    except DeckError as error:
        raise deck.error("doubler", str(error)) from None
    materials = materials_of(deck)
    names = [str(name).lower() for name in deck.spread(group.get("materials", []), len(angles), "doubler")]
    if unknown := [name for name in names if name not in materials]:
        raise deck.error("doubler", f"no &material is named '{unknown[0]}'.")
    thickness = as_number(deck.single(group.get("ply_thickness", []), "doubler", "ply_thickness", None),
                          f"{deck.path.name}: &doubler ply_thickness")
    if thickness <= 0:
        raise deck.error("doubler", "ply_thickness must be greater than zero.")
    plies = tuple(Ply(materials[name], angle, thickness) for name, angle in zip(names, angles, strict=True))
    bonds = {str(name).lower() for interface in deck.groups.get("delamination", [])
             for name in interface.get("doubler", [])}
    return Doubler(text("name"), _face(deck, "doubler", text("face", "back")), _rectangle(deck, "doubler", group),
                   plies, text("name").lower() in bonds)


def _drop(deck: Deck, group: Group, plies: int) -> PlyDrop:
    """Return a ply drop."""
    missing = [as_number(value, f"{deck.path.name}: &ply_drop plies") for value in group.get("plies", [])]
    if not missing or any(value not in range(1, plies + 1) for value in missing):
        raise deck.error("ply_drop", f"plies must be integers from 1 to {plies}.")
    flat_face = str(deck.single(group.get("flat_face", []), "ply_drop", "flat_face", "front"))
    return PlyDrop(tuple(map(int, missing)), _rectangle(deck, "ply_drop", group), _face(deck, "ply_drop", flat_face))


def _face(deck: Deck, name: str, word: str) -> str:
    """Return the name of a face."""
    if word.lower() not in FACES:
        raise deck.error(name, f"'{word}' is not one of {', '.join(FACES)}.")
    return word.lower()


def _rectangle(deck: Deck, name: str, group: Group) -> Rectangle:
    """Return the rectangle of a zone."""
    pairs = []
    for key in ("at", "size"):
        values = [as_number(value, f"{deck.path.name}: &{name} {key}") for value in group.get(key, [])]
        if len(values) != 2 or (key == "size" and min(values) <= 0):
            raise deck.error(name, f"{key} must be two numbers, those of a size greater than zero.")
        pairs.append((values[0], values[1]))
    return Rectangle(*pairs)


def with_lines(lines: np.ndarray, required: Sequence[float]) -> np.ndarray:
    """Return lines between cells with the nearest one moved to each required place, or a line added there if the
    nearest one is required elsewhere; the first and last line are edges of the plate.
    """
    lines = np.array(lines, dtype=float)
    near = 1e-9 * np.ptp(lines)
    taken = {0, len(lines) - 1}
    for place in sorted(required):
        nearest = int(np.argmin(np.abs(lines - place)))
        if abs(lines[nearest] - place) <= near:
            taken.add(nearest)
        elif nearest in taken:
            index = int(np.searchsorted(lines, place))
            lines = np.insert(lines, index, place)
            taken = {number + (number >= index) for number in taken} | {index}
        else:
            lines[nearest] = place
            taken.add(nearest)
    return lines
