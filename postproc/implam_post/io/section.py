"""A section through the plate along a line: layers with their deflection, delaminations, failures of plies."""

from dataclasses import dataclass

import numpy as np

from implam_post.io.contours import level_of
from implam_post.io.errors import FileError
from implam_post.io.fields import IMAGES, MODES, Fields, deck_in, opened, struck_point
from implam_post.io.shapes import heights_of

__all__ = ["Section", "section_at"]
# Points at which a layer of an element is given along the line.
_POINTS = 17
# Elements that the line touches within this part of their sides belong to the section.
_TOUCHES = 1e-9


@dataclass(frozen=True)
class Section:
    """Layers of elements along a line, a row for each; `along` has distances from the struck point, (rows, points).

    `height` is that of the stress-free plate, from the struck point along z, `deflection` that of the layer, `share`
    the delaminated fraction of the interface on top of it, `opening` the gap there (NaN: not written), and `levels`
    the fraction, by ply above, from which this interface counts as delaminated. `failures` has the sums of modes by
    ply and row, `crushed` whether the fibres failed in compression, if known. `middles` are the middles of the parts
    of the line, from the centre of the plate, (rows, 2); the numbers of plies are those of the laminate, and a layer
    of doublers alone begins after its last one."""

    angle: float
    time: float
    along: np.ndarray
    height: np.ndarray
    deflection: np.ndarray
    opening: np.ndarray
    share: np.ndarray
    first_ply: np.ndarray
    last_ply: np.ndarray
    levels: dict[int, float]
    failures: dict[int, np.ndarray]
    crushed: dict[int, np.ndarray]
    middles: np.ndarray

    @property
    def delaminated(self) -> np.ndarray:
        """Whether the interface on top of a layer is delaminated, at each point."""
        level = np.array([self.levels.get(int(ply) - 1, np.inf) for ply in self.first_ply])
        return np.asarray(self.share >= level[:, None])

    def failed(self, ply: int, mode: str) -> np.ndarray:
        """Return the rows in which a ply failed in a mode; layers without the ply have no failure of it."""
        return np.flatnonzero(self.failures[ply] & MODES[mode] > 0)

    @property
    def damaged(self) -> tuple[float, float]:
        """Least and greatest distance from the struck point at which something is delaminated or has failed."""
        rows = np.any([values > 0 for values in self.failures.values()], axis=0) if self.failures else np.zeros(
            len(self.along), dtype=bool)
        places = np.concatenate([self.along[self.delaminated], self.along[rows].ravel()])
        return (float(places.min()), float(places.max())) if len(places) else (0.0, 0.0)


def section_at(fields: Fields, angle: float, place: int = -1) -> Section:
    """Return the section through the struck point at an angle from x, in degrees, at one of the times."""
    snapshot = fields.snapshots[place]
    mesh, middle = snapshot.mesh, struck_point(fields)
    direction = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    # Mirror images are inverse to themselves: the line of the full plate is mirrored into the modelled part.
    parts = [_crossed(mesh.corners, middle * np.array(signs), direction * np.array(signs))
             for signs in IMAGES[fields.part]]
    row = np.concatenate([elements for elements, _, _ in parts])
    along, places = (np.concatenate([part[number] for part in parts]) for number in (1, 2))
    order = np.lexsort((mesh.first_ply[row], along[:, 0]))
    row, along, places = row[order], along[order], places[order]
    deflection, opening = _at_points(fields, place)
    owns = {below: snapshot.of_interface(below) for below in mesh.interfaces}
    levels = {below: max(level_of(mesh.corners[own], snapshot.shares[own]), 1e-9) for below, own in owns.items()}
    failed, pressed = ({ply: flags[row] for ply, flags in given.items()} for given in (
        snapshot.failures | snapshot.added, snapshot.crushed))
    deck = deck_in(fields.path)
    height = heights_of(deck, middle + along[..., None] * direction) - heights_of(deck, middle)
    return Section(angle, snapshot.time, along, height, _between(deflection[row], places),
                   _between(opening[row], places), _between(snapshot.shares[row], places),
                   mesh.first_ply[row].astype(int), mesh.last_ply[row].astype(int), levels, failed, pressed,
                   middle + along.mean(axis=1)[:, None] * direction)


def _crossed(corners: np.ndarray, start: np.ndarray, direction: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return the parallelograms that a line crosses, distances from its start, (rows, points), and places in them."""
    first, second = corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0]
    size = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]

    def within(vectors: np.ndarray) -> np.ndarray:
        """Return the components of vectors along both sides."""
        x, y = np.broadcast_to(vectors, first.shape).T
        return np.asarray(np.stack([x * second[:, 1] - y * second[:, 0],
                                    first[:, 0] * y - first[:, 1] * x], axis=1) / size[:, None])

    origin, step = within(start - corners[:, 0]), within(direction)
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.sort(np.stack([-origin / step, (1 - origin) / step]), axis=0)
    beside = np.abs(step) * np.sqrt(np.abs(size))[:, None] < _TOUCHES
    inside = (origin > -_TOUCHES) & (origin < 1 + _TOUCHES)
    begin = np.where(beside, np.where(inside, -np.inf, np.inf), ends[0]).max(axis=1)
    end = np.where(beside, np.where(inside, np.inf, -np.inf), ends[1]).min(axis=1)
    rows = np.flatnonzero(end - begin > _TOUCHES * np.sqrt(np.abs(size)))
    along = begin[rows, None] + (end - begin)[rows, None] * np.linspace(0, 1, _POINTS)
    return rows, along, np.clip(origin[rows, None] + along[..., None] * step[rows, None], 0, 1)


def _between(values: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return values at places in elements, linear in eight triangles of each as in the maps."""
    high = places > 0.5
    # From the nearest corner: parts of the way to the mid-sides.
    first, second = np.moveaxis(2 * np.where(high, 1 - places, places), -1, 0)
    corner = np.where(high[..., 1], np.where(high[..., 0], 2, 3), np.where(high[..., 0], 1, 0))
    along_first, along_second = np.where(high[..., 1], 6, 4), np.where(high[..., 0], 5, 7)
    rows = np.arange(len(values))[:, None]
    nearest, middle = values[rows, corner], values[rows, 8]
    beside = np.where(first >= second, values[rows, along_first], values[rows, along_second])
    longer, shorter = np.maximum(first, second), np.minimum(first, second)
    return np.asarray(nearest + longer * (beside - nearest) + shorter * (middle - beside))


def _at_points(fields: Fields, place: int) -> tuple[np.ndarray, np.ndarray]:
    """Return deflection and opening at the nine points of the elements; 0 and NaN if they are not written."""
    with opened(fields.path) as file:
        group = file["times"][sorted(file["times"])[place]]
        connectivity = file[f"meshes/{int(group['mesh'][()]):08d}/connectivity"][()]
        points = group.get("points", {})
        deflection, opening = (points[name][()][:, 2][connectivity] if name in points else
                               np.full(connectivity.shape, missing)
                               for name, missing in (("displacement", 0.0), ("jump", np.nan)))
    if not np.all(np.isfinite(deflection)):
        raise FileError(f"{fields.path} is damaged: its displacement is not finite.")
    return deflection, opening
