"""Doublers and ply drops from the properties of elements."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from implam_post.exchange.bulk_cards import BulkCard
from implam_post.exchange.bulk_data import BulkData
from implam_post.exchange.bulk_elements import NEAR, Quadrilateral
from implam_post.exchange.bulk_laminate import Laminate, same_plies
from implam_post.exchange.bulk_shape import Shape
from implam_post.exchange.remarks import Remarks
from implam_post.laminate.sections import Ply
from implam_post.laminate.zones import Doubler, PlyDrop, Rectangle, Zones

# Largest distance of plies from their place in the deck, over the thickness of the panel, that is not reported.
_SAME_HEIGHT = 1e-4


class Stack(NamedTuple):
    """Plies from the struck face on, z of the struck face from the grids, their property, and elements that have it."""

    plies: list[Ply]
    front: float
    card: BulkCard
    places: list[int]

    @property
    def thickness(self) -> float:
        """Thickness of the plies."""
        return sum(ply.thickness for ply in self.plies)

    @property
    def middle(self) -> float:
        """z of the mid-plane from the grids."""
        return self.front + self.thickness / 2


class Change(NamedTuple):
    """How plies differ from those of the skin: plies added on the struck face, numbers of missing plies and the flat
    face of the ply drop, plies added on the back; and z of the struck face from the mid-plane of the skin.
    """

    front: tuple[Ply, ...]
    missing: tuple[int, ...]
    flat_face: str
    back: tuple[Ply, ...]
    height: float


def read_zones(bulk: BulkData, shape: Shape, laminates: Mapping[int, Laminate], plies: Mapping[int, list[Ply]],
               remarks: Remarks) -> tuple[Zones, float]:
    """Return the plies of the panel, and z of the mid-plane of its skin from the grids; `plies` are those of each
    property from the struck face on, with angles from x of the panel.

    The skin is the stack whose mid-plane is at the grids, of several the one with the largest area.
    """
    stacks = _stacks(shape, laminates, plies)
    areas = [sum(_area(shape.spread[place]) for place in stack.places) for stack in stacks]
    near = _SAME_HEIGHT * max(stack.thickness for stack in stacks)
    skin = stacks[max(range(len(stacks)), key=lambda number: (abs(stacks[number].middle) <= near, areas[number]))]
    _remark_offset(shape, skin, laminates, remarks)
    changes = [(stack, _change(bulk, skin, stack, remarks)) for stack in stacks if stack is not skin]
    zones = Zones(skin.plies, [*_doublers(bulk, shape, changes)], [*_drops(bulk, shape, changes)])
    return zones, skin.middle


def _area(quad: Quadrilateral) -> float:
    """Return the area of an element."""
    diagonals = quad.corners[2] - quad.corners[0], quad.corners[3] - quad.corners[1]
    return float(np.linalg.norm(np.cross(*diagonals))) / 2


def _stacks(shape: Shape, laminates: Mapping[int, Laminate], plies: Mapping[int, list[Ply]]) -> list[Stack]:
    """Return the different stacks of the elements."""
    found: list[Stack] = []
    of_element: dict[tuple[int, float], Stack] = {}
    for place, quad in enumerate(shape.quads):
        number, offset = quad.read.pid, float(quad.read.zoffset or 0.0)
        if (stack := of_element.get((number, offset))) is None:
            thickness = sum(ply.thickness for ply in plies[number])
            first = offset + laminates[number].first_face
            new = Stack(plies[number], first if shape.turn > 0 else -(first + thickness), laminates[number].card, [])
            stack = next((other for other in found if same_plies(other.plies, new.plies)
                          and abs(other.front - new.front) <= _SAME_HEIGHT * thickness), new)
            of_element[number, offset] = stack
            if stack is new:
                found.append(new)
        stack.places.append(place)
    return found


def _remark_offset(shape: Shape, skin: Stack, laminates: Mapping[int, Laminate], remarks: Remarks) -> None:
    """Add remarks if the mid-plane of the skin is not at the grids."""
    if abs(skin.middle) <= _SAME_HEIGHT * skin.thickness:
        return
    for place in skin.places:
        quad = shape.quads[place]
        if quad.read.zoffset:
            remarks.add(quad.card, "ZOFFS is ignored")
        laminate = laminates[quad.read.pid]
        if abs(laminate.first_face + skin.thickness / 2) > _SAME_HEIGHT * skin.thickness:
            remarks.add(laminate.card, "Z0 is ignored: the grids and the supports are at the mid-plane of the panel")


def _change(bulk: BulkData, skin: Stack, stack: Stack, remarks: Remarks) -> Change:
    """Return how a stack differs from the skin: at the height of the file and with the most plies of the skin, or else
    plies added only, or missing only, as near to that height as possible.
    """
    of_skin = f"{skin.card.name} {skin.card.fields.field(1)}"
    height, near = stack.front - skin.middle, _SAME_HEIGHT * skin.thickness
    found = list(_descriptions(skin.plies, stack.plies))
    for change in found:
        if abs(change.height - height) <= near:
            return change
    single = [change for change in found if not change.missing or not (change.front or change.back)]
    if not single:
        raise bulk.error(stack.card, f"its lay-up differs from that of {of_skin} in line {skin.card.line}, the "
                                     "laminate of the panel, by more than plies added on its faces, as a &doubler, or "
                                     "missing, as in a &ply_drop.")
    change = min(single, key=lambda each: abs(each.height - height))
    remarks.add(stack.card, f"its plies are moved by {abs(change.height - height):.4g} along the normal: a doubler is "
                            f"bonded to a face of {of_skin}, and a ply drop leaves one face flat")
    return change


def _descriptions(skin: Sequence[Ply], plies: Sequence[Ply]) -> Iterator[Change]:
    """Return the changes that give these plies, those with the most plies of the skin first."""
    half = sum(ply.thickness for ply in skin) / 2
    for kept in range(min(len(skin), len(plies)), 0, -1):
        # Plies on the back first, the default of a doubler.
        for before in range(len(plies) - kept + 1):
            missing = _missing(skin, plies[before:before + kept])
            if missing is None:
                continue
            front, back = tuple(plies[:before]), tuple(plies[before + kept:])
            above = sum(ply.thickness for ply in front)
            gone = sum(skin[number - 1].thickness for number in missing)
            yield Change(front, missing, "front", back, -half - above)
            if missing:
                yield Change(front, missing, "back", back, gone - half - above)


def _missing(skin: Sequence[Ply], plies: Sequence[Ply]) -> tuple[int, ...] | None:
    """Return the numbers of the plies of the skin that are missing; None if the plies are others."""
    missing, following = [], 0
    for number, ply in enumerate(skin, 1):
        if following < len(plies) and same_plies([ply], [plies[following]]):
            following += 1
        else:
            missing.append(number)
    return tuple(missing) if following == len(plies) else None


def _doublers(bulk: BulkData, shape: Shape, changes: Sequence[tuple[Stack, Change]]) -> Iterator[Doubler]:
    """Return the doublers: a rectangle or several for equal plies on a face."""
    number = 0
    for face in ("front", "back"):
        for plies, stacks in _equal([(stack, getattr(change, face)) for stack, change in changes]):
            if max(ply.thickness for ply in plies) - min(ply.thickness for ply in plies) > 1e-9 * plies[0].thickness:
                raise bulk.error(stacks[0].card, "the plies that it adds differ in thickness, where those of a doubler "
                                                 "have one: split the thicker ones into equal plies.")
            for area in _rectangles(bulk, shape, stacks):
                number += 1
                yield Doubler(f"doubler_{number}", face, area, plies)


def _drops(bulk: BulkData, shape: Shape, changes: Sequence[tuple[Stack, Change]]) -> Iterator[PlyDrop]:
    """Return the ply drops."""
    given = [(stack, (change.missing, change.flat_face) if change.missing else ()) for stack, change in changes]
    for (missing, flat_face), stacks in _equal(given):
        for area in _rectangles(bulk, shape, stacks):
            yield PlyDrop(missing, area, flat_face)


def _equal(given: Sequence[tuple[Stack, tuple]]) -> list[tuple[tuple, list[Stack]]]:
    """Return the stacks by equal values, those without a value left out."""
    found: list[tuple[tuple, list[Stack]]] = []
    for stack, value in given:
        if not value:
            continue
        for other, stacks in found:
            if other == value:
                stacks.append(stack)
                break
        else:
            found.append((value, [stack]))
    return found


def _rectangles(bulk: BulkData, shape: Shape, stacks: Sequence[Stack]) -> Iterator[Rectangle]:
    """Return rectangles that cover the elements of stacks once."""
    near = NEAR * max(shape.lengths)
    quads = [shape.spread[place] for stack in stacks for place in stack.places]
    boxes = []
    for quad in quads:
        low, high = quad.corners.min(axis=0)[:2], quad.corners.max(axis=0)[:2]
        if np.prod(high - low) - _area(quad) > NEAR * _area(quad):
            raise bulk.error(quad.card, "the elements of a doubler or ply drop must be rectangles along the edges of "
                                        "the panel.")
        boxes.append((low, high))
    lines = [_distinct(np.array([corner[axis] for box in boxes for corner in box]), near) for axis in (0, 1)]
    covered = np.zeros([len(each) - 1 for each in lines], dtype=bool)
    for low, high in boxes:
        spans = [slice(*np.searchsorted(lines[axis], (low[axis] - near, high[axis] - near))) for axis in (0, 1)]
        covered[tuple(spans)] = True
    while covered.any():
        i, j = np.argwhere(covered)[0]
        right = next((column for column in range(i, len(covered)) if not covered[column, j]), len(covered))
        top = next((row for row in range(j, covered.shape[1]) if not covered[i:right, row].all()), covered.shape[1])
        covered[i:right, j:top] = False
        (left, end), (bottom, high) = (lines[0][i], lines[0][right]), (lines[1][j], lines[1][top])
        left, end, bottom, high = map(shape.rounded, (left, end, bottom, high))
        yield Rectangle((shape.rounded((left + end) / 2), shape.rounded((bottom + high) / 2)),
                        (shape.rounded(end - left), shape.rounded(high - bottom)))


def _distinct(places: np.ndarray, near: float) -> np.ndarray:
    """Return places in ascending order, equal ones once."""
    ordered = np.sort(places)
    return ordered[np.concatenate([[True], np.diff(ordered) > near])]
