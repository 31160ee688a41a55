"""Grids and elements of a panel; sublaminates have coincident grids where they are delaminated."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from implam_post.exchange.panel import Cell, Panel, Stack

# Corners, then mid-sides of a cell in its 3 by 3 nodes, counter-clockwise.
EIGHT = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
Place = tuple[int, int]


class Element(NamedTuple):
    """A stack over a cell and its 3 by 3 grids, the first index along x."""

    stack: Stack
    grids: tuple[tuple[int, int, int], ...]

    @property
    def eight(self) -> list[int]:
        """Corners, then mid-sides, counter-clockwise from the corner of least x and y."""
        return [self.grids[i][j] for i, j in EIGHT]

    @property
    def quarters(self) -> list[list[int]]:
        """Corners of the four quadrilaterals of the cell, in the order of `eight`."""
        return [[self.grids[i][j], self.grids[i + 1][j], self.grids[i + 1][j + 1], self.grids[i][j + 1]]
                for j in (0, 1) for i in (0, 1)]


@dataclass(frozen=True)
class ShellMesh:
    """Grids numbered from 1, elements (those at the struck face first), and the grids with each support.

    Supports are the digits of the constrained components: 1 to 3 along x, y and z, 4 to 6 about them. At each place, in
    half-lines, `places` has the grid of each first ply of a stack.
    """

    coordinates: np.ndarray
    elements: list[Element]
    struck: int
    supports: dict[str, list[int]]
    places: dict[Place, dict[int, int]]


def shell_mesh(panel: Panel, with_middles: bool) -> ShellMesh:
    """Number the grids line by line and build the elements; `with_middles` keeps the middle grid of each cell."""
    numbers, coordinates = _numbered(panel, with_middles)
    elements = [_element(cell, stack, numbers) for cell, stacks in sorted(panel.stacks.items()) for stack in stacks]
    elements.sort(key=lambda element: element.stack.first > 1)
    struck = sum(element.stack.first == 1 for element in elements)
    return ShellMesh(np.array(coordinates), elements, struck, _supports(panel, numbers), numbers)


def _numbered(panel: Panel, with_middles: bool) -> tuple[dict[Place, dict[int, int]], list[tuple[float, float, float]]]:
    """Return for each place and each first ply of a stack its grid, and the coordinates of the grids.

    At the border of a delamination, next to an intact cell, the sublaminates share one grid.
    """
    x, y = (halved(lines) for lines in (panel.x, panel.y))
    numbers: dict[Place, dict[int, int]] = {}
    coordinates: list[tuple[float, float, float]] = []
    for j in range(len(y)):
        for i in range(len(x)):
            if i % 2 and j % 2 and not with_middles:
                continue
            delaminated = frozenset.intersection(*(panel.delaminated(cell) for cell in around(panel, i, j)))
            numbers[i, j] = {}
            for first in (1, *(below + 1 for below in sorted(delaminated))):
                coordinates.append((float(x[i]), float(y[j]), panel.initial_deflection(x[i], y[j])))
                numbers[i, j][first] = len(coordinates)
    return numbers, coordinates


def halved(lines: np.ndarray) -> np.ndarray:
    """Return the lines and the midpoints between neighbouring lines."""
    halved = np.empty(2 * len(lines) - 1)
    halved[::2], halved[1::2] = lines, (lines[1:] + lines[:-1]) / 2
    return halved


def around(panel: Panel, i: int, j: int) -> list[Cell]:
    """Return the cells that share a place."""
    columns, rows = ([place for place in {(line - 1) // 2, line // 2} if 0 <= place < count]
                     for line, count in zip((i, j), panel.cells, strict=True))
    return [(column, row) for column in columns for row in rows]


def _element(cell: Cell, stack: Stack, numbers: dict[Place, dict[int, int]]) -> Element:
    """Return the element of a stack: at each place the grid of the greatest first ply up to its own; 0 if none."""
    def grid(place: Place) -> int:
        at = numbers.get(place, {})
        return at[max(first for first in at if first <= stack.first)] if at else 0

    return Element(stack, tuple(tuple(grid((2 * cell[0] + i, 2 * cell[1] + j)) for j in range(3)) for i in range(3)))


def _supports(panel: Panel, numbers: dict[Place, dict[int, int]]) -> dict[str, list[int]]:
    """Return the grids on the edges by their constrained components."""
    held: dict[int, set[str]] = {}
    last = tuple(2 * count for count in panel.cells)
    for place, grids in numbers.items():
        for number, edge in enumerate(panel.edges):
            axis, far = divmod(number, 2)
            if place[axis] == (last[axis] if far else 0):
                for grid in grids.values():
                    held.setdefault(grid, set()).update(held_by_edge(edge, axis, panel.in_plane))
    # The in-plane rigid motions that the edges leave. Edges that hold the displacement along themselves only leave
    # the rotation, unless opposite edges do.
    held.setdefault(numbers[0, 0][1], set()).update({"1", "2"}.difference(*held.values()))
    supported = [edge != "free" for edge in panel.edges]
    opposite = all(supported[:2]) or all(supported[2:])
    if not any(supported) or panel.in_plane == "free" or (panel.in_plane == "tangential" and not opposite):
        held.setdefault(numbers[last[0], 0][1], set()).add("2")
    supports: dict[str, list[int]] = {}
    for grid, components in sorted(held.items()):
        if components:
            supports.setdefault("".join(sorted(components)), []).append(grid)
    return supports


def held_by_edge(edge: str, axis: int, in_plane: str) -> str:
    """Return the components constrained at an edge whose normal is x (`axis` 0) or y (1).

    A simple support constrains the rotation of the director along the edge, whose axis is the normal of the edge.
    """
    if edge == "free":
        return ""
    turns = "45" if edge == "clamped" else "45"[axis]
    return {"fixed": "12", "free": "", "tangential": "21"[axis]}[in_plane] + "3" + turns
