"""The rectangle covered by the quadrilaterals of bulk data, and its axes."""

import contextlib
import io
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from implam_post.exchange.bulk_cards import BulkCard
from implam_post.exchange.bulk_data import BulkData
from implam_post.exchange.bulk_elements import NEAR, Quadrilateral, check_cover, read_quadrilaterals
from implam_post.exchange.bulk_surface import Surface, surface_of
from implam_post.exchange.remarks import Remarks
from implam_post.io.errors import DeckError

# Material axes are the same within this angle, degrees.
_SAME_ANGLE = 1e-4


@dataclass(frozen=True)
class Shape:
    """The panel in its own axes: x and y along its edges, the origin at its centre, z from the struck face to the back.

    Rows of `axes` are these axes in the basic system of the file; `places` has x and y of each grid, on a cylinder
    along its arc. `turn` is 1 if fibre angles count from x to y, -1 if the last ply is at the struck face.
    `quads` are the elements of the file, `spread` those with positions in the axes of the panel instead of corners in
    the basic system.
    """

    lengths: tuple[float, float]
    origin: np.ndarray
    axes: np.ndarray
    places: dict[int, np.ndarray]
    elements: tuple[int, int]
    turn: int
    quads: Sequence[Quadrilateral]
    spread: Sequence[Quadrilateral]
    surface: Surface

    @property
    def finer(self) -> tuple[int, int]:
        """Number of elements along x and y that has the lines of four-node elements, too."""
        share = 1 if self.quads[0].card.name == "CQUAD8" else 2
        return share * self.elements[0], share * self.elements[1]

    def rounded(self, place: float) -> float:
        """Return a position without the round-off of the file, to a millionth of the panel or less."""
        return round(float(place), 5 - math.floor(math.log10(max(self.lengths)))) + 0.0

    @property
    def properties(self) -> set[int]:
        """Numbers of the properties of the elements."""
        return {quad.read.pid for quad in self.quads}


def read_shape(bulk: BulkData, systems: Mapping[int, Any], grids: Mapping[int, tuple[BulkCard, Any]],
               struck_last: bool, remarks: Remarks) -> Shape:
    """Return the rectangle; `struck_last` if the last ply is at the struck face."""
    points = {number: _position(bulk, systems, *grid) for number, grid in grids.items()}
    quads = read_quadrilaterals(bulk, points, remarks)
    normal = quads[0].normal
    for quad in quads:
        if quad.normal @ normal < -np.sqrt(0.5):
            raise bulk.error(quad.card, "its corners are numbered in the opposite sense to those of the element in "
                                        f"line {quads[0].card.line}, so that the order of plies is reversed: number "
                                        "all in the same sense.")
    used = {number: points[number] for quad in quads for number in quad.read.nodes if number}
    surface = _surface(bulk, quads, used, struck_last)
    local = {number: surface.position(point) for number, point in used.items()}
    low, high = (limit(list(local.values()), axis=0) for limit in (np.min, np.max))
    middle = (low + high) / 2
    lengths = high - low
    turn = -1 if struck_last else 1
    spread = [replace(quad, corners=np.array([[*local[number][:2], 0.0] for number in quad.read.nodes[:4]]),
                      normal=np.array([0.0, 0.0, turn])) for quad in quads]
    check_cover(bulk, spread, np.eye(3), {number: np.array([*place[:2], 0.0]) for number, place in local.items()})
    if any(surface.curvatures):
        remarks.note(f"the panel is curved: radius {_radius(surface)}"
                     + (", and its lengths are those of the arc" if surface.is_rolled else ""))
    places = {number: (place - middle)[:2] for number, place in local.items()}
    spread = [replace(quad, corners=quad.corners - [*middle[:2], 0.0]) for quad in spread]
    sides = [_plain(length) for length in lengths[:2]]
    shape = Shape((sides[0], sides[1]), _origin(surface, middle), surface.axes, places,
                 _elements(spread, lengths), turn, quads, spread, replace(surface, origin=_origin(
                     surface, middle)))
    if not surface.is_rolled:
        return shape
    return replace(shape, lengths=(shape.rounded(sides[0]), shape.rounded(sides[1])))


def _surface(bulk: BulkData, quads: Sequence[Quadrilateral], points: Mapping[int, np.ndarray], struck_last: bool
             ) -> Surface:
    """Return the plane or curved surface of the panel."""
    if any(quad.normal @ quads[0].normal < 1 - NEAR for quad in quads):
        return surface_of(quads, points, struck_last)
    axes = _axes(quads[0], struck_last)
    heights = [float(axes[2] @ point) for point in points.values()]
    sides = np.ptp([axes @ point for point in points.values()], axis=0)
    if sides[2] > NEAR * max(sides):
        raise bulk.missing("the grids of the panel do not lie in one plane.")
    return Surface(axes, axes[2] * (min(heights) + max(heights)) / 2)


def _origin(surface: Surface, middle: np.ndarray) -> np.ndarray:
    """Return the centre of the panel in the basic system; that of a curved panel is the origin of its surface."""
    if any(surface.curvatures):
        return surface.origin
    return np.asarray(surface.origin + surface.axes.T @ np.array([*middle[:2], 0.0]))


def _radius(surface: Surface) -> str:
    """Return the radii of the lines along x and y as text."""
    return " and ".join(f"{1 / curvature:.6g} along {axis}" for axis, curvature in zip(
        "xy", surface.curvatures, strict=True) if curvature)


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
    """Return the basic system and those of CORD2R and CORD2C cards, ready to transform."""
    from pyNastran.bdf.bdf import BDF
    model = BDF(debug=None)
    cards = list(bulk.named("CORD2R", "CORD2C"))
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
    """Return the system of a CORD2R or CORD2C."""
    from pyNastran.bdf.cards.coordinate_systems import CORD2C, CORD2R
    return _without_prints(lambda: bulk.read(card, CORD2C if card.name == "CORD2C" else CORD2R), bulk, card)


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
    """Return an error about a coordinate system that is not given as a CORD2R, or where it is needed as a CORD2C."""
    for card in bulk.cards:
        # A CORD1R, CORD1C or CORD1S may define two systems, in fields 1 and 5.
        fields = (1, 5) if card.name.startswith("CORD1") else (1,)
        if card.name.startswith("CORD") and str(number) in [str(card.fields.field(field) or "") for field in fields]:
            return bulk.error(card, f"coordinate system {number}, which the {user.name} in line {user.line} uses, "
                                    "must be a CORD2R, rectangular and defined by points, or for grids a CORD2C.")
    return bulk.error(user, f"there is no CORD2R of coordinate system {number}.")


def _position(bulk: BulkData, systems: Mapping[int, Any], card: BulkCard, grid: Any) -> np.ndarray:
    """Return the position of a grid in the basic system."""
    if grid.cp not in systems:
        raise _no_system(bulk, card, grid.cp)
    return np.array(systems[grid.cp].transform_node_to_global(grid.xyz))


def _axes(quad: Quadrilateral, struck_last: bool) -> np.ndarray:
    """Return the axes of the panel: z from struck face to back, x the first in-plane axis of the basic system."""
    normal = quad.normal
    along = int(np.argmax(np.abs(normal)))
    if abs(normal[along]) < 1 - NEAR:
        raise quad.card.error("the panel is not parallel to a plane of the basic coordinate system: give the grids in "
                              "axes of the panel.")
    z = np.zeros(3)
    z[along] = np.sign(normal[along]) * (-1 if struck_last else 1)
    x = np.eye(3)[1 if along == 0 else 0]
    return np.array([x, np.cross(z, x), z])


def _elements(quads: Sequence[Quadrilateral], lengths: np.ndarray) -> tuple[int, int]:
    """Return the number of nine-node elements along x and y that gives about as many nodes as these elements have."""
    corners = np.concatenate([quad.corners for quad in quads])
    cells = [np.count_nonzero(np.diff(np.sort(corners[:, axis])) > NEAR * lengths[axis]) for axis in (0, 1)]
    if cells[0] * cells[1] != len(quads):
        cells = [round(np.sqrt(len(quads) * lengths[axis] / lengths[1 - axis])) for axis in (0, 1)]
    share = 1 if quads[0].card.name == "CQUAD8" else 2
    return max(2, -(-cells[0] // share)), max(2, -(-cells[1] // share))


def material_angles(bulk: BulkData, systems: Mapping[int, Any], shape: Shape) -> dict[int, float]:
    """Return the angle from x to the material axis by property; it must be the same for all elements of one.

    On a doubly curved panel a direction turns by up to the product of the slopes, which shallow shells neglect.
    """
    slopes = np.multiply(shape.surface.curvatures, shape.lengths) / 2
    near = _SAME_ANGLE + abs(np.degrees(np.prod(slopes)))
    found: dict[int, list[tuple[BulkCard, float]]] = {}
    for quad, spread in zip(shape.quads, shape.spread, strict=True):
        angle = _angle(bulk, quad, shape.surface.frame(spread.corners.mean(axis=0)), systems)
        of_property = found.setdefault(quad.read.pid, [])
        card, first = of_property[0] if of_property else (quad.card, angle)
        beyond = (angle - first + 90) % 180 - 90
        if abs(beyond) > 2 * near:
            raise bulk.error(quad.card, f"its material axis is {_plain(angle):g} degrees from x, that of line "
                                        f"{card.line} {_plain(first):g}: elements of one property have one laminate.")
        of_property.append((quad.card, first + beyond))
    return {number: _plain(float(np.mean([angle for _, angle in angles]))) for number, angles in found.items()}


def _angle(bulk: BulkData, quad: Quadrilateral, axes: np.ndarray, systems: Mapping[int, Any]) -> float:
    """Return the angle of the material axis: x of MCID, or the first side rotated by THETA about the normal."""
    given = quad.read.theta_mcid
    if isinstance(given, float):
        direction = quad.corners[1] - quad.corners[0]
        theta = np.radians(given)
        direction = np.cos(theta) * direction + np.sin(theta) * np.cross(quad.normal, direction)
    elif given in systems and systems[given].type == "CORD2R":
        direction = systems[given].i
    else:
        raise _no_system(bulk, quad.card, given)
    x, y, _ = axes @ direction
    if np.hypot(x, y) < NEAR * np.linalg.norm(direction):
        raise bulk.error(quad.card, f"the x axis of coordinate system {given} is normal to the panel.")
    return float(np.degrees(np.arctan2(y, x)))


def _plain(number: float) -> float:
    """Return a number without round-off in its last digits."""
    plain = float(f"{number:.10g}")
    return plain if abs(plain) > 1e-9 else 0.0
