"""Stringers from the CBAR and CBEAM of bulk data whose grids are those of the panel."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from implam_post.exchange.bulk_cards import BulkCard
from implam_post.exchange.bulk_data import BulkData
from implam_post.exchange.bulk_profiles import PROPERTIES, NoStringer, Profile, read_profile
from implam_post.exchange.bulk_shape import Shape
from implam_post.exchange.remarks import Remarks
from implam_post.exchange.stringers import SHEAR_CORRECTION, Section, Stringer, section_of_sizes
from implam_post.io.errors import DeckError
from implam_post.laminate.zones import Zones

# Two directions are the same within this angle, radians; two places within this part of the panel.
_SAME_DIRECTION, _SAME_PLACE = 0.02, 1e-6


@dataclass(frozen=True)
class Beam:
    """An element on a line of the panel."""

    axis: int
    at: float
    ends: tuple[float, float]
    face: str
    section: Section
    property: int


class _Reader:
    """Elements and properties of a file."""

    def __init__(self, bulk: BulkData, systems: Mapping[int, Any], grids: Mapping[int, tuple[BulkCard, Any]],
                 shape: Shape, zones: Zones, middle: float, remarks: Remarks) -> None:
        """Keep what elements refer to; `middle` is z of the mid-plane of the skin from the grids."""
        self.bulk, self.systems, self.grids, self.shape = bulk, systems, grids, shape
        self.zones, self.middle, self.remarks = zones, middle, remarks
        self._profiles: dict[int, Profile] = {}

    def beams(self) -> Iterator[Beam]:
        """Return the elements that can be stringers; add a remark on each other one between grids of the panel."""
        from pyNastran.bdf.cards.elements.bars import CBAR
        from pyNastran.bdf.cards.elements.beam import CBEAM
        for card in self.bulk.named("CBAR", "CBEAM"):
            if not {self.bulk.integer(card, field) for field in (3, 4)} <= self.shape.places.keys():
                continue
            read = self.bulk.read(card, CBAR if card.name == "CBAR" else CBEAM)
            try:
                beam = self._beam(card, read)
            except NoStringer as reason:
                self.remarks.add(card, f"it is no stringer of the deck: {reason}")
                continue
            self.bulk.also_read.add(card)
            yield beam

    def _beam(self, card: BulkCard, read: Any) -> Beam:
        """Return the element as a part of a stringer."""
        ends = [self.shape.places[number] for number in (read.ga, read.gb)]
        side = ends[1] - ends[0]
        axis = int(np.argmax(np.abs(side)))
        if abs(side[1 - axis]) > _SAME_DIRECTION * abs(side[axis]):
            raise NoStringer("it is not parallel to an edge of the panel")
        if read.pa or read.pb:
            raise NoStringer("it has hinges, PA or PB")
        profile = self._profile(card, read.pid)
        middle = (ends[0] + ends[1]) / 2
        is_first, sense = self._plane(card, read, middle)
        heights = [self._height(read, number, offset) for number, offset in ((read.ga, read.wa), (read.gb, read.wb))]
        if abs(heights[1] - heights[0]) > _SAME_DIRECTION * max(map(abs, heights)):
            raise NoStringer("the offsets of its ends differ")
        height = heights[0] + sense * profile.centroid[0 if is_first else 1] - self.middle
        if abs(profile.centroid[1 if is_first else 0]) > _SAME_DIRECTION * abs(height):
            raise NoStringer("its centroid lies beside its line")
        face = "front" if height < 0 else "back"
        outwards = -1 if face == "front" else 1
        eccentricity = outwards * (height - self._face(middle, axis, outwards))
        thickness = sum(ply.thickness for ply in self.zones.laminate)
        if eccentricity < -1e-3 * thickness:
            raise NoStringer("its centroid lies within the panel, where that of a stringer lies on a face or beyond: "
                             "give its offset")
        low, high = sorted(float(end[axis]) for end in ends)
        section = _section(profile, is_first, sense * outwards, max(eccentricity, 0.0), card, self.remarks)
        return Beam(axis, float(middle[1 - axis]), (low, high), face, section, read.pid)

    def _profile(self, card: BulkCard, number: int) -> Profile:
        """Return the section of a property."""
        if number not in self._profiles:
            names = PROPERTIES[card.name]
            found = next((each for each in self.bulk.named(*names) if self.bulk.integer(each, 1) == number), None)
            if found is None:
                raise NoStringer(f"there is no {' or '.join(names)} with number {number}")
            try:
                self._profiles[number] = read_profile(self.bulk, found, self.remarks)
            except DeckError as error:
                raise found.error(str(error)) if ":" not in str(error) else error from None
            self.bulk.also_read.add(found)
        return self._profiles[number]

    def _vector(self, values: np.ndarray, number: int, is_basic: bool) -> np.ndarray:
        """Return a vector in the displacement system of a grid, or in the basic system, in the latter."""
        card, grid = self.grids[number]
        if is_basic or not grid.cd:
            return np.asarray(values, dtype=float)
        return np.asarray(values @ basis(self.bulk, self.systems, card, grid, self.position(number)))

    def position(self, number: int) -> np.ndarray:
        """Return the position of a grid in the basic system."""
        grid = self.grids[number][1]
        return np.array(self.systems[grid.cp].transform_node_to_global(grid.xyz))

    def _plane(self, card: BulkCard, read: Any, place: np.ndarray) -> tuple[bool, int]:
        """Return whether plane 1 of the element is normal to the panel, and the sign of z along its axis y, or else z.
        """
        offt = str(read.offt or "GGG").upper() if isinstance(read.offt, str) else "GGG"
        if offt[0] not in "GB" or offt[1:] != "GG":
            raise NoStringer(f"OFFT {offt} is not read, but GGG and BGG")
        along = self.position(read.gb) - self.position(read.ga)
        if read.g0:
            if read.g0 not in self.grids:
                raise card.error(f"grid {read.g0} does not exist.")
            vector = self.position(read.g0) - self.position(read.ga) - self._vector(read.wa, read.ga, False)
        else:
            vector = self._vector(np.array(read.x, dtype=float), read.ga, offt[0] == "B")
        along = along / np.linalg.norm(along)
        second = np.cross(along, vector)
        if np.linalg.norm(second) < 1e-6 * np.linalg.norm(vector) or not np.linalg.norm(vector) > 0:
            raise card.error("its orientation vector is parallel to it.")
        second = second / np.linalg.norm(second)
        first = np.cross(second, along)
        for normal in (self.shape.surface.frame(place)[2], self.shape.axes[2]):
            for is_first, direction in ((True, first), (False, second)):
                if np.linalg.norm(np.cross(direction, normal)) < _SAME_DIRECTION:
                    return is_first, int(np.sign(direction @ normal))
        raise NoStringer("its planes are not normal to the panel")

    def _height(self, read: Any, number: int, offset: np.ndarray) -> float:
        """Return z of the axis of an element from a grid."""
        vector = self._vector(offset, number, False)
        size = float(np.linalg.norm(vector))
        for normal in (self.shape.surface.frame(self.shape.places[number])[2], self.shape.axes[2]):
            if np.linalg.norm(np.cross(vector, normal)) <= _SAME_DIRECTION * size:
                return size * float(np.sign(vector @ normal))
        raise NoStringer("its offset is not normal to the panel")

    def _face(self, place: np.ndarray, axis: int, outwards: int) -> float:
        """Return z of the face from the mid-plane of the skin; on the edge of a zone the mean of both sides."""
        faces, every = [], self.zones.plies
        for side in (-1, 1):
            beside = np.array(place, dtype=float)
            beside[1 - axis] += side * _SAME_PLACE * max(self.shape.lengths)
            if abs(beside[1 - axis]) < self.shape.lengths[1 - axis] / 2:
                lay_up = self.zones.at(*beside)
                faces.append(lay_up.front + (outwards > 0) * sum(every[ply - 1].thickness for ply in lay_up.numbers))
        return float(np.mean(faces))


def basis(bulk: BulkData, systems: Mapping[int, Any], card: BulkCard, grid: Any, point: np.ndarray) -> np.ndarray:
    """Return the directions of the displacement components of a grid in the basic system, as rows."""
    if grid.cd not in systems:
        raise bulk.error(card, f"there is no CORD2R or CORD2C of coordinate system {grid.cd}.")
    system = systems[grid.cd]
    rows = np.array([system.i, system.j, system.k])
    if system.type == "CORD2C":
        x, y, _ = rows @ (point - system.origin)
        radius = np.hypot(x, y)
        if not radius > 0:
            raise bulk.error(card, f"the grid lies on the axis of coordinate system {grid.cd}, its CD.")
        rows = np.array([[x, y, 0], [-y, x, 0], [0, 0, radius]]) / radius @ rows
    return rows


def _section(profile: Profile, is_first: bool, side: int, eccentricity: float, card: BulkCard, remarks: Remarks
             ) -> Section:
    """Return the section of a stringer: a blade or T if its foot is on the face.

    `side` is the sign of the outward direction along y of the element, if `is_first`, or else along its z.
    """
    web, cap = _sizes(profile, is_first, side)
    if web is not None and profile.density:
        sized = section_of_sizes(web, cap, profile.modulus, profile.shear_modulus, profile.density)
        if abs(sized.eccentricity - eccentricity) < 1e-4 * web[0]:
            return sized
    shear = profile.shear_areas[0 if is_first else 1]
    if shear is None:
        remarks.add(card, "its shear factor is blank, so that it has no shear deformation; the deck has 5/6")
        shear = SHEAR_CORRECTION * profile.area
    bending, lateral = profile.moments if is_first else profile.moments[::-1]
    if min(bending, profile.torsion) <= 0:
        raise NoStringer("its I normal to the panel and its J must be greater than zero")
    return Section(profile.modulus, profile.shear_modulus, profile.area, bending, lateral, profile.torsion, shear,
                   profile.mass, eccentricity)


def _sizes(profile: Profile, is_first: bool, side: int
           ) -> tuple[tuple[float, float] | None, tuple[float, float] | None]:
    """Return height and thickness of the web, and width and thickness of the cap, of a blade or T."""
    if len(profile.sizes) == 2:
        width, height = profile.sizes if is_first else profile.sizes[::-1]
        return (height, width), None
    if len(profile.sizes) == 4 and is_first and profile.flange == side:
        width, flange, height, web = profile.sizes
        return (height, web), (width, flange)
    return None, None


def read_stringers(bulk: BulkData, systems: Mapping[int, Any], grids: Mapping[int, tuple[BulkCard, Any]], shape: Shape,
                   zones: Zones, middle: float, remarks: Remarks) -> list[Stringer]:
    """Return the stringers; `middle` is z of the mid-plane of the skin from the grids."""
    near = _SAME_PLACE * max(shape.lengths)
    rows: list[Beam] = []
    for beam in sorted(_Reader(bulk, systems, grids, shape, zones, middle, remarks).beams(),
                       key=lambda each: (each.axis, each.face, round(each.at / near), each.property, each.ends)):
        last = rows[-1] if rows else None
        if last and (last.axis, last.face, last.property) == (beam.axis, beam.face, beam.property) and abs(
                last.at - beam.at) < near and abs(last.ends[1] - beam.ends[0]) < near and _same(last.section,
                                                                                               beam.section):
            rows[-1] = replace(last, ends=(last.ends[0], beam.ends[1]))
        else:
            rows.append(beam)
    return [Stringer(f"stringer_{number}", beam.axis, shape.rounded(beam.at),
                     (shape.rounded(beam.ends[0]), shape.rounded(beam.ends[1])), beam.face, beam.section)
            for number, beam in enumerate(rows, 1)]


def _same(one: Section, other: Section) -> bool:
    """Return whether two sections of one property have the same place."""
    return (one.web is None) == (other.web is None) and abs(one.eccentricity - other.eccentricity) <= 1e-4 * max(
        one.eccentricity, np.sqrt(one.area))
