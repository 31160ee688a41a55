"""The quadrilaterals of bulk data, and whether they cover a rectangle once."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from implam_post.exchange.bulk_cards import KNOWN, BulkCard
from implam_post.exchange.bulk_data import BulkData, ranges
from implam_post.exchange.remarks import Remarks
from implam_post.io.errors import DeckError

NEAR = 1e-6
_IGNORED = {"CQUAD4": {11: "T1", 12: "T2", 13: "T3", 14: "T4"},
            "CQUAD8": {11: "T1", 12: "T2", 13: "T3", 14: "T4"}}
# Elements of surfaces and volumes, which may model a part of a panel: CQUADR, CQDMEM1, CTRIA3, CHEXA, ...
_OTHERS = re.compile("C(QUAD|QD|TRI|TRMEM|TRPLT|TRBSC|TRSHL|SHEAR|TWIST|HEX|PENTA|TETRA|PYRA|IHEX|IFQUAD|IFHEX|PLST)")
# Two grids are at one place if they are nearer than this fraction of the panel.
_COINCIDENT = 1e-5
# Points of an element, from its centre towards its corners, that must not lie inside another one.
_SAMPLES = (0.0, 0.5, 0.9)
Mark = tuple[int, ...]


@dataclass(frozen=True)
class Quadrilateral:
    """An element: card, object of pyNastran, corners (4, 3), normal."""

    card: BulkCard
    read: Any
    corners: np.ndarray
    normal: np.ndarray


def read_quadrilaterals(bulk: BulkData, points: Mapping[int, np.ndarray], remarks: Remarks) -> list[Quadrilateral]:
    """Return the elements."""
    from pyNastran.bdf.cards.elements.shell import CQUAD4, CQUAD8
    quads: list[Quadrilateral] = []
    first: dict[int, BulkCard] = {}
    for card in bulk.named("CQUAD4", "CQUAD8"):
        read = bulk.read(card, CQUAD4 if card.name == "CQUAD4" else CQUAD8)
        if (other := first.setdefault(read.eid, card)) is not card:
            raise bulk.error(card, f"number {read.eid} is used by the {other.name} in line {other.line}.")
        for place, number in enumerate(read.nodes):
            if number not in points and (number or place < 4):
                raise bulk.error(card, f"grid {number or 0} does not exist.")
        corners = np.array([points[number] for number in read.nodes[:4]])
        normal = np.cross(corners[2] - corners[0], corners[3] - corners[1])
        if not np.linalg.norm(normal) > 0:
            raise bulk.error(card, "its area is zero.")
        remarks.ignored(card, _IGNORED[card.name])
        quads.append(Quadrilateral(card, read, corners, normal / np.linalg.norm(normal)))
    if not quads:
        raise bulk.missing(f"there is no CQUAD4 and no CQUAD8.{_other_elements(bulk)}")
    return quads


def check_cover(bulk: BulkData, quads: Sequence[Quadrilateral], axes: np.ndarray, places: Mapping[int, np.ndarray]
                ) -> None:
    """Refuse elements that do not cover a rectangle along the axes, each part of it once; `places` are in the axes."""
    every = np.array(list(places.values()))
    lengths = np.ptp(every, axis=0)
    marks: dict[int, Mark] = {number: tuple(np.round(place[:2] / (_COINCIDENT * max(lengths))).astype(int))
             for number, place in places.items()}
    alone = _sides_alone(quads, marks)
    area = sum(np.linalg.norm(np.cross(quad.corners[2] - quad.corners[0], quad.corners[3] - quad.corners[1])) / 2
               for quad in quads)
    low, high = np.min(every, axis=0)[:2], np.max(every, axis=0)[:2]
    inside = [quad for quad, one, two in alone if not _on_border(places[one], places[two], low, high)]
    for quad in inside:
        _refuse_overlap(quad, quads, axes)
    if abs(area - lengths[0] * lengths[1]) > NEAR * area:
        raise _no_rectangle(bulk, quads, axes, area, lengths)
    _refuse_cuts(bulk, marks)


def _sides_alone(quads: Sequence[Quadrilateral], marks: Mapping[int, Mark]) -> list[tuple[Quadrilateral, int, int]]:
    """Return element and grids of each side that one element has; refuse two elements on the same part of a side."""
    sides: dict[tuple[Mark, Mark], tuple[Quadrilateral, int, int]] = {}
    for quad in quads:
        grids = quad.read.nodes[:4]
        for one, two in zip(grids, [*grids[1:], grids[0]], strict=True):
            other = sides.setdefault((marks[one], marks[two]), (quad, one, two))[0]
            if other is not quad:
                raise _overlap(other, quad)
    return [side for (one, two), side in sides.items() if (two, one) not in sides]


def _on_border(one: np.ndarray, two: np.ndarray, low: np.ndarray, high: np.ndarray) -> bool:
    """Return whether both ends of a side lie on the same edge of the rectangle."""
    near = _COINCIDENT * max(high - low)
    return any(abs(one[axis] - edge) < near and abs(two[axis] - edge) < near
               for axis in (0, 1) for edge in (low[axis], high[axis]))


def _overlap(first: Quadrilateral, second: Quadrilateral) -> DeckError:
    """Return an error about two elements that overlap."""
    return second.card.error(f"it overlaps the {first.card.name} in line {first.card.line}: each place of the panel "
                             "needs one element.")


def _refuse_overlap(quad: Quadrilateral, quads: Sequence[Quadrilateral], axes: np.ndarray) -> None:
    """Refuse an element that has a part of the panel in common with another one."""
    corners = np.array([other.corners for other in quads]) @ axes[:2].T
    sides = np.roll(corners, -1, axis=1) - corners
    sizes = np.linalg.norm(sides, axis=2)
    middle = quad.corners.mean(axis=0)
    for share in _SAMPLES:
        for point in middle + share * (quad.corners - middle):
            towards = axes[:2] @ point - corners
            left = (sides[..., 0] * towards[..., 1] - sides[..., 1] * towards[..., 0]) * (axes[2] @ quad.normal)
            for number in np.flatnonzero((left > NEAR * sizes * sizes.max()).all(axis=1)):
                if quads[number] is not quad:
                    raise _overlap(*sorted((quads[number], quad), key=lambda each: each.card.line))


def _no_rectangle(bulk: BulkData, quads: Sequence[Quadrilateral], axes: np.ndarray, area: float, lengths: np.ndarray
                  ) -> DeckError:
    """Return an error about elements that cover no rectangle along the axes, or one along other axes."""
    side = axes @ (quads[0].corners[1] - quads[0].corners[0])
    turned = np.array([side[:2], [-side[1], side[0]]]) / max(np.linalg.norm(side), np.finfo(float).tiny)
    corners = np.concatenate([quad.corners for quad in quads]) @ axes[:2].T @ turned.T
    if abs(area - np.prod(np.ptp(corners, axis=0))) < NEAR * area:
        degrees = float(f"{np.degrees(np.arctan2(side[1], side[0])):.6g}")
        return bulk.error(quads[0].card, f"its first side is at {degrees:.6g} degrees to the basic system, to which "
                                         "the panel's edges must be parallel: give the grids in the axes of the edges.")
    others = _other_elements(bulk) or " A panel has no holes, notches or skew edges."
    return bulk.missing(f"the CQUAD4 and CQUAD8 do not form a rectangle: they cover {area:.6g} of the "
                        f"{lengths[0]:.6g} by {lengths[1]:.6g} around them.{others}")


def _other_elements(bulk: BulkData) -> str:
    """Return a sentence on elements that are not supported; empty if there are none."""
    cards = [card for card in bulk.cards if card.name not in KNOWN and _OTHERS.match(card.name)]
    if not cards:
        return ""
    names = " and ".join(dict.fromkeys(card.name for card in cards))
    lines = ranges((card.line for card in cards), [card.line for card in bulk.cards])
    return f" {names}, {lines}, cannot be used: mesh the panel with CQUAD4 or CQUAD8 only."


def _refuse_cuts(bulk: BulkData, marks: Mapping[int, Mark]) -> None:
    """Refuse coincident grids: elements that share no grid are not connected."""
    first_at: dict[Mark, int] = {}
    for number, mark in sorted(marks.items()):
        first = first_at.setdefault(mark, number)
        if first != number:
            raise bulk.missing(f"the grids {first} and {number} coincide: the elements are not connected there.")
