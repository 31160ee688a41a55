"""The surface of a panel: a plane, a cylinder or a shallow paraboloid, and positions on it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from implam_post.exchange.bulk_elements import NEAR, Quadrilateral
from implam_post.io.errors import DeckError

# Largest distance of a grid from the surface, over the rise and over the size of the panel.
_NEAR_RISE, _NEAR_SIZE = 1e-3, 1e-5
# Distances over the size of the panel that are round-off.
_ROUND_OFF = 1e-9
# Largest component of a normal of the elements along the axis of a cylinder.
_ALONG_AXIS = 1e-3
# Longest arc over radius: the rise of a shallow shell is at most an eighth of its span (src/mesh/plate_deck.f90).
_LONGEST_ARC = 1.0


@dataclass(frozen=True)
class Surface:
    """Axes of a panel, rows in the basic system, z from the struck face to the back; a point of its surface, from
    which positions count; and the curvatures of its lines along x and y, positive where the middle of the panel lies
    nearest to the impactor.

    Positions on a cylinder (`is_rolled`) are arc lengths, those on a paraboloid coordinates in the plane of x and y.
    """

    axes: np.ndarray
    origin: np.ndarray
    curvatures: tuple[float, float] = (0.0, 0.0)
    is_rolled: bool = False

    def position(self, point: np.ndarray) -> np.ndarray:
        """Return x and y of a point of the basic system, and its distance from the surface."""
        local = self.axes @ (point - self.origin)
        if not self.is_rolled:
            return np.array([*local[:2], local[2] - np.dot(self.curvatures, local[:2]**2) / 2])
        axis = int(self.curvatures[0] == 0)
        radius = 1 / self.curvatures[axis]
        # The sign of the radius is that of z of the centre of the circle.
        angle = np.arctan2(local[axis], (radius - local[2]) * np.sign(radius))
        local[2] = (abs(radius) - np.hypot(local[axis], radius - local[2])) * np.sign(radius)
        local[axis] = abs(radius) * angle
        return local

    def frame(self, place: Sequence[float]) -> np.ndarray:
        """Return the directions of x and y along the surface and of its normal at a position, as rows."""
        slopes = np.multiply(self.curvatures, place[:2])
        if self.is_rolled:
            slopes = np.tan(slopes)
        normal = np.array([-slopes[0], -slopes[1], 1.0])
        along = np.array([1.0, 0.0, slopes[0]])
        normal, along = normal / np.linalg.norm(normal), along / np.linalg.norm(along)
        return np.array([along, np.cross(normal, along), normal]) @ self.axes


def surface_of(quads: Sequence[Quadrilateral], points: Mapping[int, np.ndarray], struck_last: bool) -> Surface:
    """Return the surface on which the grids of curved elements lie; `points` are these grids."""
    normals = np.array([quad.normal * np.linalg.norm(np.cross(
        quad.corners[2] - quad.corners[0], quad.corners[3] - quad.corners[1])) for quad in quads])
    normal = normals.sum(axis=0)
    places = np.array(list(points.values()))
    found = [surface for surface in (_paraboloid(normal, places, struck_last),
                                     _cylinder(quads, normal, places, struck_last)) if surface is not None]
    if not found:
        raise _no_surface(quads)
    # Three grids along an arc lie on both surfaces: they are then those of a cylinder.
    least = _ROUND_OFF * np.ptp(places, axis=0).max()
    error, surface = min(found, key=lambda each: (max(each[0], least), not each[1].is_rolled))
    rise = max(abs(curvature) * np.ptp(places @ surface.axes[axis])**2 / 8
               for axis, curvature in enumerate(surface.curvatures))
    if error > max(_NEAR_RISE * rise, _NEAR_SIZE * np.ptp(places, axis=0).max()):
        raise _no_surface(quads)
    if surface.is_rolled:
        arcs = [surface.position(place) for place in places] * np.array([*np.abs(surface.curvatures), 0.0])
        if (covered := np.ptp(arcs, axis=0).max()) > _LONGEST_ARC * (1 + NEAR):
            raise quads[0].card.error(f"the elements cover {np.degrees(covered):.4g} degrees of a cylinder: shallow "
                                      f"shells cover up to {np.degrees(_LONGEST_ARC):.3g}; give a part of it.")
    return surface


def _no_surface(quads: Sequence[Quadrilateral]) -> DeckError:
    """Return an error about grids off any surface that a deck can have."""
    first = quads[0]
    other = next(quad for quad in quads if quad.normal @ first.normal < 1 - NEAR)
    return other.card.error(f"its normal differs from that of the element in line {first.card.line}, and the grids lie "
                            "neither in a plane nor on a cylinder along a basic axis: give skins with one radius, and "
                            "webs as CBAR or CBEAM with offsets.")


def _basic_axes(z: np.ndarray) -> np.ndarray:
    """Return the axes of a panel parallel to a basic plane: x is the first basic axis in it."""
    x = np.eye(3)[1 if abs(z[0]) > NEAR else 0]
    return np.array([x, np.cross(z, x), z])


def _unit_normal(normal: np.ndarray, struck_last: bool) -> np.ndarray | None:
    """Return z if the mean normal is along a basic axis."""
    normal = normal / np.linalg.norm(normal)
    along = int(np.argmax(np.abs(normal)))
    if abs(normal[along]) < 1 - NEAR:
        return None
    return np.asarray(np.eye(3)[along] * np.sign(normal[along]) * (-1 if struck_last else 1))


def _paraboloid(normal: np.ndarray, places: np.ndarray, struck_last: bool) -> tuple[float, Surface] | None:
    """Return the paraboloid nearest to the grids and their largest distance from it."""
    z = _unit_normal(normal, struck_last)
    if z is None:
        return None
    axes = _basic_axes(z)
    local = places @ axes.T
    middle = (local.min(axis=0) + local.max(axis=0)) / 2
    squares = (local[:, :2] - middle[:2])**2 / 2
    factors = np.column_stack([squares, np.ones(len(local))])
    found = np.linalg.lstsq(factors, local[:, 2], rcond=None)[0]
    distances = factors @ found - local[:, 2]
    sides = np.ptp(local[:, :2], axis=0)
    # A line whose rise is round-off is straight.
    curvatures = [curvature if abs(curvature) * side**2 / 8 > _NEAR_SIZE * sides.max() else 0.0
                  for curvature, side in zip(found[:2], sides, strict=True)]
    return np.abs(distances).max(), Surface(axes, axes.T @ np.array([*middle[:2], found[2]]),
                                            (float(curvatures[0]), float(curvatures[1])))


def _cylinder(quads: Sequence[Quadrilateral], normal: np.ndarray, places: np.ndarray, struck_last: bool
              ) -> tuple[float, Surface] | None:
    """Return the cylinder along a basic axis nearest to the grids and their largest distance from it."""
    along = np.abs([quad.normal for quad in quads]).max(axis=0)
    axis = int(np.argmin(along))
    if along[axis] > _ALONG_AXIS:
        return None
    across = [other for other in range(3) if other != axis]
    plane = places[:, across]
    factors = np.column_stack([2 * plane, np.ones(len(plane))])
    solution = np.linalg.lstsq(factors, (plane**2).sum(axis=1), rcond=None)[0]
    centre = solution[:2]
    radius = float(np.sqrt(solution[2] + centre @ centre))
    spokes = plane - centre
    error = np.abs(np.hypot(*spokes.T) - radius).max()
    mean = spokes.mean(axis=0)
    if np.hypot(*mean) < NEAR * radius:
        return None
    angles = np.arctan2(mean[0] * spokes[:, 1] - mean[1] * spokes[:, 0], spokes @ mean)
    turn = (angles.max() + angles.min()) / 2 + np.arctan2(mean[1], mean[0])
    outwards = np.zeros(3)
    outwards[across] = np.cos(turn), np.sin(turn)
    outwards[np.abs(outwards) < NEAR] = 0.0
    side = np.sign(outwards @ normal) * (-1 if struck_last else 1)
    z = side * outwards / np.linalg.norm(outwards)
    axes = _basic_axes(z) if np.abs(z).max() > 1 - NEAR else np.array([
        np.eye(3)[axis], np.cross(z, np.eye(3)[axis]), z])
    origin = np.zeros(3)
    origin[across] = centre + radius * outwards[across]
    origin[axis] = (places[:, axis].min() + places[:, axis].max()) / 2
    # The centre of the circle is behind the struck face, at z > 0, if the outward normal points to the impactor.
    curvatures = [0.0, 0.0]
    curvatures[int(abs(axes[0][axis]) > 0.5)] = -side / radius
    return error, Surface(axes, origin, (float(curvatures[0]), float(curvatures[1])), is_rolled=True)
