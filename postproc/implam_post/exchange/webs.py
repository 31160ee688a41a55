"""Stringers by sizes as shells: webs on the grids of the panel, and caps on their free edges."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from implam_post.exchange.panel import Panel
from implam_post.exchange.shell_mesh import ShellMesh
from implam_post.exchange.stringer_lines import LinePoint, line_of
from implam_post.exchange.stringers import Stringer

# A web has at least this many elements over its height, and a cap over its width.
_LEAST = 2


class Fixed(NamedTuple):
    """A constrained component of a node."""

    node: int
    component: int


class Equal(NamedTuple):
    """A component in which a node moves as another one."""

    node: int
    other: int
    component: int


@dataclass
class Webs:
    """Nodes beyond those of the panel, elements of eight nodes by stringer and part, and constraints of the ends."""

    nodes: dict[int, np.ndarray] = field(default_factory=dict)
    elements: dict[tuple[int, str], list[list[int]]] = field(default_factory=dict)
    fixed: list[Fixed] = field(default_factory=list)
    equal: list[Equal] = field(default_factory=list)


def webs_of(panel: Panel, mesh: ShellMesh) -> Webs:
    """Return the shells of all stringers that have sizes.

    A web begins at the grids, in the mid-plane of the laminate, and ends at its free edge or in the middle of its cap.
    """
    webs = Webs()
    for number, stringer in enumerate(panel.stringers):
        if stringer.section.web is not None:
            _Builder(panel, mesh, stringer, number, webs).build()
    return webs


class _Builder:
    """The shells of one stringer."""

    def __init__(self, panel: Panel, mesh: ShellMesh, stringer: Stringer, number: int, webs: Webs) -> None:
        """Prepare rows of nodes along the stringer."""
        self.panel, self.stringer, self.number, self.webs = panel, stringer, number, webs
        self.first = len(mesh.coordinates) + 1
        sides = line_of(panel, mesh, stringer)
        self.cells = len(sides)
        self.points: list[LinePoint] = [sides[0][0]]
        for side, following in zip(sides, [*sides[1:], None], strict=True):
            # The face of a point between two cells is at the mean of both.
            end = side[2] if following is None else side[2]._replace(face=(side[2].face + following[0].face) / 2)
            self.points += [side[1], end]

    def build(self) -> None:
        """Add nodes, elements and constraints."""
        section = self.stringer.section
        length = np.linalg.norm(self.points[-1].position - self.points[0].position) / self.cells
        beyond = section.web[0] + (section.cap[1] / 2 if section.cap else 0.0)
        count = max(_LEAST, round(beyond / length))
        rows = [[self._on_web(point, place / (2 * count), beyond, bool(place % 2) and bool(index % 2))
                 for index, point in enumerate(self.points)] for place in range(2 * count + 1)]
        rows[0] = [point.grid for point in self.points]
        self._shells("WEB", rows)
        self._constrain(rows[1:])
        if section.cap:
            self._cap(rows[-1], section.cap[0], length, beyond)

    def _cap(self, middle: list[int], width: float, length: float, beyond: float) -> None:
        """Add the cap, whose middle row is the free edge of the web."""
        count = max(1, round(width / 2 / length))
        across = np.eye(3)[1 - self.stringer.axis]
        rows = []
        for place in range(-2 * count, 2 * count + 1):
            rows.append(middle if place == 0 else [
                self._node(self._place(point, beyond) + place / (4 * count) * width * (
                    across - across @ point.normal * point.normal), bool(place % 2) and bool(index % 2))
                for index, point in enumerate(self.points)])
        self._shells("CAP", rows)
        self._constrain([row for row in rows if row is not middle])

    def _place(self, point: LinePoint, beyond: float) -> np.ndarray:
        """Return the position at a distance from the face outwards."""
        return np.asarray(point.position + (point.face + self.stringer.outwards * beyond) * point.normal)

    def _on_web(self, point: LinePoint, share: float, beyond: float, is_centre: bool) -> int:
        """Return a node of the web at a share of its height above the grid."""
        edge = self._place(point, beyond)
        return self._node(point.position + share * (edge - point.position), is_centre)

    def _node(self, position: np.ndarray, is_centre: bool) -> int:
        """Return the number of a new node; 0 in the centre of an element."""
        if is_centre:
            return 0
        number = self.first + len(self.webs.nodes)
        self.webs.nodes[number] = position
        return number

    def _shells(self, part: str, rows: list[list[int]]) -> None:
        """Add the elements between rows of nodes."""
        found = self.webs.elements.setdefault((self.number, part), [])
        for low in range(0, len(rows) - 1, 2):
            for left in range(0, 2 * self.cells, 2):
                found.append([rows[low + row][left + column] for row, column in (
                    (0, 0), (0, 2), (2, 2), (2, 0), (0, 1), (1, 2), (2, 1), (1, 0))])

    def _constrain(self, rows: list[list[int]]) -> None:
        """Hold the ends at supported edges as the section of a beam: across and normal to the panel, and along the
        stringer at clamped ones.
        """
        axis = self.stringer.axis
        lines = (self.panel.x, self.panel.y)[axis]
        for far, index in enumerate((0, -1)):
            edge = self.panel.edges[2 * axis + far]
            if edge == "free" or abs(self.stringer.ends[index] - lines[index]) > 1e-6 * np.ptp(lines):
                continue
            for row in rows:
                if not row[index]:
                    continue
                self.webs.fixed += [Fixed(row[index], 2 - axis), Fixed(row[index], 3)]
                if edge == "clamped" and self.panel.in_plane == "fixed":
                    self.webs.fixed.append(Fixed(row[index], axis + 1))
                elif edge == "clamped":
                    self.webs.equal.append(Equal(row[index], self.points[index].grid, axis + 1))


def rows_of(webs: Webs, first: int) -> Iterator[tuple[tuple[int, str], list[tuple[int, list[int]]]]]:
    """Return for each part of a stringer its elements with their numbers, which begin with `first`."""
    for part, elements in webs.elements.items():
        yield part, list(enumerate(elements, first))
        first += len(elements)
