"""Grids of a panel along its stringers."""

from typing import NamedTuple

import numpy as np

from implam_post.exchange.panel import Panel
from implam_post.exchange.shell_mesh import Place, ShellMesh, around, halved
from implam_post.exchange.stringers import Stringer
from implam_post.io.errors import ImplamError


class LinePoint(NamedTuple):
    """A point of the line of a stringer: the grid of the sublaminate that it is bonded to, 0 between corners of a mesh
    without middles; its position, the normal of the panel towards the back, and z of the face from the grid.
    """

    grid: int
    position: np.ndarray
    normal: np.ndarray
    face: float


def line_of(panel: Panel, mesh: ShellMesh, stringer: Stringer) -> list[list[LinePoint]]:
    """Return the three points of each side of a cell that a stringer covers, in ascending order.

    Where the cells on the two sides of the line differ in thickness, the face is at the mean of both.
    """
    across, along = (panel.x, panel.y)[1 - stringer.axis], (panel.x, panel.y)[stringer.axis]
    near = 1e-6 * max(np.ptp(panel.x), np.ptp(panel.y))
    column = int(np.argmin(np.abs(across - stringer.at)))
    middles = (along[1:] + along[:-1]) / 2
    covered = np.flatnonzero((middles > stringer.ends[0]) & (middles < stringer.ends[1]))
    ends = [abs(along - end).min() for end in stringer.ends]
    if abs(across[column] - stringer.at) > near or max(ends) > near:
        raise ImplamError(f"the stringer '{stringer.name}' does not lie on lines of the mesh.")
    return [[_point(panel, mesh, stringer, int(cell), 2 * cell + half, 2 * column) for half in (0, 1, 2)]
            for cell in covered]


def _point(panel: Panel, mesh: ShellMesh, stringer: Stringer, cell: int, along: int, across: int) -> LinePoint:
    """Return a point on the side of a cell; `along` and `across` are its half-lines."""
    place: Place = (along, across) if stringer.axis == 0 else (across, along)
    x, y = (halved(lines)[index] for lines, index in zip((panel.x, panel.y), place, strict=True))
    beside = [other for other in around(panel, *place) if other[stringer.axis] == cell]
    face = sum(panel.outer_face(other, stringer.outwards) for other in beside) / len(beside)
    grids = mesh.places.get(place, {})
    grid = (grids[max(grids)] if stringer.outwards > 0 else grids[1]) if grids else 0
    return LinePoint(grid, np.array([x, y, panel.initial_deflection(x, y)]), panel.normal(x, y), face)
