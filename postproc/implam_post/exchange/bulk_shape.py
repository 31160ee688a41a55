"""The rectangle covered by the quadrilaterals of bulk data, and its axes."""

import contextlib
import io
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from implam_post.exchange.bulk_cards import BulkCard
from implam_post.exchange.bulk_data import BulkData, ranges
from implam_post.exchange.remarks import Remarks
from implam_post.io.errors import DeckError

_NEAR = 1e-6
_IGNORED = {"CQUAD4": {8: "ZOFFS", 11: "T1", 12: "T2", 13: "T3", 14: "T4"},
            "CQUAD8": {16: "ZOFFS", 11: "T1", 12: "T2", 13: "T3", 14: "T4"}}

# Shell and solid elements that may model a part of a panel.
_OTHERS = ("CTRIA3", "CTRIA6", "CTRIAR", "CQUADR", "CQUAD", "CSHEAR", "CHEXA", "CPENTA", "CTETRA")


@dataclass(frozen=True)
class Shape:
    """The panel in its own axes: x and y along its edges, the origin at its centre, z from the struck face to the back.

    Rows of `axes` are these axes in the basic system of the file; `places` has x and y of each grid. `turn` is 1 if
    fibre angles count from x to y, -1 if the last ply is at the struck face. `quads` are the elements of the file.
    """

    lengths: tuple[float, float]
    origin: np.ndarray
    axes: np.ndarray
    places: dict[int, np.ndarray]
    elements: tuple[int, int]
    turn: int
    quads: Sequence["_Quadrilateral"]

    @property
    def properties(self) -> set[int]:
        """Numbers of the properties of the elements."""
        return {quad.read.pid for quad in self.quads}


@dataclass(frozen=True)
class _Quadrilateral:
    """An element: card, object of pyNastran, corners (4, 3), normal."""

    card: BulkCard
    read: Any
    corners: np.ndarray
    normal: np.ndarray


def read_shape(bulk: BulkData, systems: Mapping[int, Any], grids: Mapping[int, tuple[BulkCard, Any]],
               struck_last: bool, remarks: Remarks) -> Shape:
    """Return the rectangle; `struck_last` if the last ply is at the struck face."""
    points = {number: _position(bulk, systems, *grid) for number, grid in grids.items()}
    quads = _quadrilaterals(bulk, points, remarks)
    normal = quads[0].normal
    for quad in quads:
        if quad.normal @ normal < _NEAR - 1:
            raise bulk.error(quad.card, "its corners are numbered in the opposite sense to those of the element in "
                                        f"line {quads[0].card.line}, so that the order of plies is reversed: number "
                                        "all in the same sense.")
        if quad.normal @ normal < 1 - _NEAR:
            raise bulk.error(quad.card, f"its normal differs from that of the element in line {quads[0].card.line}: "
                                        "the panel is not flat.")
    axes = _axes(quads[0], struck_last)
    used = {number for quad in quads for number in quad.read.nodes if number}
    local = {number: axes @ points[number] for number in used}
    low, high = (limit(list(local.values()), axis=0) for limit in (np.min, np.max))
    lengths = high - low
    if lengths[2] > _NEAR * max(lengths):
        raise bulk.missing("the grids of the panel do not lie in one plane.")
    area = sum(np.linalg.norm(np.cross(quad.corners[2] - quad.corners[0], quad.corners[3] - quad.corners[1])) / 2
               for quad in quads)
    if abs(area - lengths[0] * lengths[1]) > _NEAR * area:
        raise _no_rectangle(bulk, quads, axes, area, lengths)
    _refuse_cuts(bulk, local, max(lengths))
    middle = (low + high) / 2
    return Shape((_plain(lengths[0]), _plain(lengths[1])), axes.T @ middle, axes,
                 {number: (place - middle)[:2] for number, place in local.items()}, _elements(quads, axes, lengths),
                 -1 if struck_last else 1, quads)


def _no_rectangle(bulk: BulkData, quads: Sequence[_Quadrilateral], axes: np.ndarray, area: float, lengths: np.ndarray
                  ) -> DeckError:
    """Return an error about elements that cover no rectangle along the axes, or one along other axes."""
    side = axes @ (quads[0].corners[1] - quads[0].corners[0])
    turned = np.array([side[:2], [-side[1], side[0]]]) / max(np.linalg.norm(side), np.finfo(float).tiny)
    places = np.concatenate([quad.corners for quad in quads]) @ axes[:2].T @ turned.T
    if abs(area - np.prod(np.ptp(places, axis=0))) < _NEAR * area:
        return bulk.error(quads[0].card, f"its first side is at {_plain(np.degrees(np.arctan2(side[1], side[0]))):.6g} "
                                         "degrees to the basic system, to which the panel's edges must be parallel: "
                                         "give the grids in the axes of the edges.")
    others = _other_elements(bulk) or " A panel has no holes, notches or skew edges."
    return bulk.missing(f"the CQUAD4 and CQUAD8 do not form a rectangle: they cover {area:.6g} of the "
                        f"{lengths[0]:.6g} by {lengths[1]:.6g} around them.{others}")


def _other_elements(bulk: BulkData) -> str:
    """Return a sentence on elements that are not supported; empty if there are none."""
    cards = list(bulk.named(*_OTHERS))
    if not cards:
        return ""
    names = " and ".join(dict.fromkeys(card.name for card in cards))
    lines = ranges((card.line for card in cards), [card.line for card in bulk.cards])
    return f" {names}, {lines}, cannot be used: mesh the panel with CQUAD4 or CQUAD8 only."


def _refuse_cuts(bulk: BulkData, places: Mapping[int, np.ndarray], size: float) -> None:
    """Refuse coincident grids: elements that share no grid are not connected."""
    first_at: dict[tuple[int, int], int] = {}
    for number, place in sorted(places.items()):
        first = first_at.setdefault(tuple(np.round(place[:2] / (1e-5 * size)).astype(int)), number)
        if first != number:
            raise bulk.missing(f"the grids {first} and {number} coincide: the elements are not connected there.")


def read_grids(bulk: BulkData) -> dict[int, tuple[BulkCard, Any]]:
    """Return the grids by number; a grid may be given twice if both cards are equal."""
    from pyNastran.bdf.cards.nodes import GRID
    defaults = _grid_defaults(bulk)
    grids: dict[int, tuple[BulkCard, Any]] = {}
    for card in bulk.named("GRID"):
        grid = bulk.read(card, GRID)
        for name, (field, value) in defaults.items():
            if card.fields.field(field) is None:
                setattr(grid, name, value)
        if grid.nid in grids and grids[grid.nid][0].fields.card != card.fields.card:
            raise bulk.error(card, f"grid {grid.nid} differs from that in line {grids[grid.nid][0].line}.")
        grids[grid.nid] = card, grid
    return grids


def _grid_defaults(bulk: BulkData) -> dict[str, tuple[int, Any]]:
    """Return the defaults of GRDSET for blank fields of GRID: field number in GRID and value, by name."""
    from pyNastran.bdf.cards.nodes import GRDSET
    cards = list(bulk.named("GRDSET"))
    if not cards:
        return {}
    if len(cards) > 1:
        raise bulk.error(cards[1], f"there is another one in line {cards[0].line}; only one is allowed.")
    found = bulk.read(cards[0], GRDSET)
    return {"cp": (2, found.cp), "cd": (6, found.cd), "ps": (7, str(found.ps or ""))}


def read_systems(bulk: BulkData) -> dict[int, Any]:
    """Return the basic system and those of CORD2R cards, ready to transform."""
    from pyNastran.bdf.bdf import BDF
    model = BDF(debug=None)
    cards = list(bulk.named("CORD2R"))
    for card in cards:
        system = _system(bulk, card)
        model.coords[system.cid] = system
    for card in cards:
        system = model.coords[bulk.integer(card, 1)]
        if system.rid not in model.coords:
            raise _no_system(bulk, card, system.rid)
        if not _ends_in_basic(system, model.coords):
            raise bulk.error(card, f"system {system.cid} refers to itself through system {system.rid}.")
        system.cross_reference(model)
    for card in cards:
        _without_prints(model.coords[bulk.integer(card, 1)].setup, bulk, card)
    return dict(model.coords)


def _system(bulk: BulkData, card: BulkCard) -> Any:
    """Return the system of a CORD2R."""
    from pyNastran.bdf.cards.coordinate_systems import CORD2R
    return _without_prints(lambda: bulk.read(card, CORD2R), bulk, card)


def _without_prints(define: Callable[[], Any], bulk: BulkData, card: BulkCard) -> Any:
    """Return the axes of a system; suppress what pyNastran prints on collinear points."""
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            return define()
    except (DeckError, RuntimeError) as error:
        raise bulk.error(card, "its points A, B and C are collinear.") if "norm(v)" in str(error) else error from None


def _ends_in_basic(system: Any, systems: Mapping[int, Any]) -> bool:
    """Return whether the reference systems of a system end at the basic system."""
    for _ in systems:
        if not system.rid:
            return True
        system = systems.get(system.rid, system)
    return False


def _no_system(bulk: BulkData, user: BulkCard, number: int) -> DeckError:
    """Return an error about a coordinate system that is not given as a CORD2R."""
    for card in bulk.cards:
        # A CORD1R, CORD1C or CORD1S may define two systems, in fields 1 and 5.
        fields = (1, 5) if card.name.startswith("CORD1") else (1,)
        if card.name.startswith("CORD") and str(number) in [str(card.fields.field(field) or "") for field in fields]:
            return bulk.error(card, f"coordinate system {number}, which the {user.name} in line {user.line} uses, "
                                    "must be a CORD2R, rectangular and defined by points.")
    return bulk.error(user, f"there is no CORD2R of coordinate system {number}.")


def _position(bulk: BulkData, systems: Mapping[int, Any], card: BulkCard, grid: Any) -> np.ndarray:
    """Return the position of a grid in the basic system."""
    if grid.cp not in systems:
        raise _no_system(bulk, card, grid.cp)
    return np.array(systems[grid.cp].transform_node_to_global(grid.xyz))


def _quadrilaterals(bulk: BulkData, points: Mapping[int, np.ndarray], remarks: Remarks) -> list[_Quadrilateral]:
    """Return the elements."""
    from pyNastran.bdf.cards.elements.shell import CQUAD4, CQUAD8
    quads: list[_Quadrilateral] = []
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
        quads.append(_Quadrilateral(card, read, corners, normal / np.linalg.norm(normal)))
    if not quads:
        raise bulk.missing(f"there is no CQUAD4 and no CQUAD8.{_other_elements(bulk)}")
    return quads


def _axes(quad: _Quadrilateral, struck_last: bool) -> np.ndarray:
    """Return the axes of the panel: z from struck face to back, x the first in-plane axis of the basic system."""
    normal = quad.normal
    along = int(np.argmax(np.abs(normal)))
    if abs(normal[along]) < 1 - _NEAR:
        raise quad.card.error("the panel is not parallel to a plane of the basic coordinate system: give the grids in "
                              "axes of the panel.")
    z = np.zeros(3)
    z[along] = np.sign(normal[along]) * (-1 if struck_last else 1)
    x = np.eye(3)[1 if along == 0 else 0]
    return np.array([x, np.cross(z, x), z])


def _elements(quads: Sequence[_Quadrilateral], axes: np.ndarray, lengths: np.ndarray) -> tuple[int, int]:
    """Return the number of nine-node elements along x and y that gives about as many nodes as these elements have."""
    corners = np.concatenate([quad.corners for quad in quads]) @ axes.T
    cells = [np.count_nonzero(np.diff(np.sort(corners[:, axis])) > _NEAR * lengths[axis]) for axis in (0, 1)]
    if cells[0] * cells[1] != len(quads):
        cells = [round(np.sqrt(len(quads) * lengths[axis] / lengths[1 - axis])) for axis in (0, 1)]
    share = 1 if quads[0].card.name == "CQUAD8" else 2
    return max(2, -(-cells[0] // share)), max(2, -(-cells[1] // share))


def material_angle(bulk: BulkData, systems: Mapping[int, Any], shape: Shape) -> float:
    """Return the angle from x to the material axis, which must be the same for all elements."""
    angles = [_angle(bulk, quad, shape.axes, systems) for quad in shape.quads]
    for quad, angle in zip(shape.quads, angles, strict=True):
        if abs((angle - angles[0] + 90) % 180 - 90) > 1e-4:
            raise bulk.error(quad.card, f"its material axis is {_plain(angle):g} degrees from x, that of line "
                                        f"{shape.quads[0].card.line} {_plain(angles[0]):g}: a panel has one laminate.")
    return _plain(angles[0])


def _angle(bulk: BulkData, quad: _Quadrilateral, axes: np.ndarray, systems: Mapping[int, Any]) -> float:
    """Return the angle of the material axis: x of MCID, or the first side rotated by THETA about the normal."""
    given = quad.read.theta_mcid
    if isinstance(given, float):
        direction = quad.corners[1] - quad.corners[0]
        theta = np.radians(given)
        direction = np.cos(theta) * direction + np.sin(theta) * np.cross(quad.normal, direction)
    elif given in systems:
        direction = systems[given].i
    else:
        raise _no_system(bulk, quad.card, given)
    x, y, _ = axes @ direction
    if np.hypot(x, y) < _NEAR * np.linalg.norm(direction):
        raise bulk.error(quad.card, f"the x axis of coordinate system {given} is normal to the panel.")
    return float(np.degrees(np.arctan2(y, x)))


def _plain(number: float) -> float:
    """Return a number without round-off in its last digits."""
    plain = float(f"{number:.10g}")
    return plain if abs(plain) > 1e-9 else 0.0
