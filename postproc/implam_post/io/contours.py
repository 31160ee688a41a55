"""Regions of plates where a field, given at the nine points of elements, is above a level, as polygons.

The field is linear in each of eight triangles per element, so that outlines are smooth. The level is chosen so that the
region has a given area. For a cohesive law this area is the integral of the share of the toughness that is dissipated;
it lies between the failed and the damaged area.
"""

import numpy as np

# Simpson weights of corners, mid-sides and centre, as fractions of the area of an element.
WEIGHTS = np.array([1, 1, 1, 1, 4, 4, 4, 4, 16]) / 36
# Triangles of an element: corner, mid-side, centre, counter-clockwise; they are symmetric, so that mirror images agree.
_TRIANGLES = np.array([three for corner in range(4) for three in ((corner, 4 + corner, 8),
                                                                  (corner, 8, 4 + (corner + 3) % 4))])
_QUADS = np.array([(corner, 4 + corner, 8, 4 + (corner + 3) % 4) for corner in range(4)])
# Bisections of the level, which is between 0 and 1: enough for round-off accuracy.
_HALVINGS = 50
# Points coincide within this fraction of the largest coordinate: mirror images differ by round-off.
GRAIN = 1e-7


def area(cells: np.ndarray) -> float:
    """Return the total area of cells in plan."""
    return float(np.sum(areas(cells)))


def areas(cells: np.ndarray) -> np.ndarray:
    """Return the area of each polygon, (polygons, corners, 2)."""
    x, y = cells[..., 0], cells[..., 1]
    return np.asarray(np.abs(np.sum(x * np.roll(y, -1, axis=-1) - y * np.roll(x, -1, axis=-1), axis=-1)) / 2)


def nine_points(corners: np.ndarray) -> np.ndarray:
    """Return corners, mid-sides and centre of elements with straight edges, (elements, 9, 2)."""
    sides = (corners + np.roll(corners, -1, axis=1)) / 2
    return np.concatenate([corners, sides, corners.mean(axis=1, keepdims=True)], axis=1)


def region(corners: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """Return polygons, (polygons, 4, 2), of the largest shares, (elements, 9), with an area equal to their integral."""
    return above(corners, shares, level_of(corners, shares))


def level_of(corners: np.ndarray, shares: np.ndarray) -> float:
    """Return the level for which the area of larger shares equals the integral of shares; infinity if all are zero."""
    reached = shares.max(axis=1, initial=0) > 0
    corners, shares = corners[reached], shares[reached]
    if not len(corners):
        return np.inf
    content = float(np.sum(areas(corners) * (shares @ WEIGHTS)))
    triangles = areas(nine_points(corners)[:, _TRIANGLES]).ravel()
    values = np.sort(shares[:, _TRIANGLES].reshape(-1, 3), axis=1)
    low, high = np.nextafter(0, 1), float(np.nextafter(values.max(), 2))
    for _ in range(_HALVINGS):
        level = (low + high) / 2
        low, high = (level, high) if np.sum(triangles * _part_above(values, level)) >= content else (low, level)
    # The area is discontinuous at a level where shares are uniform over elements: the nearer value is chosen.
    beyond = [abs(np.sum(triangles * _part_above(values, level)) - content) for level in (low, high)]
    return low if beyond[0] <= beyond[1] else high


def above(corners: np.ndarray, shares: np.ndarray, level: float) -> np.ndarray:
    """Return polygons, (polygons, 4, 2), where shares, (elements, 9), are at least a level."""
    reached = shares.max(axis=1, initial=0) >= level
    return _cut(nine_points(corners[reached]), shares[reached], level)


def _part_above(values: np.ndarray, level: float) -> np.ndarray:
    """Return the fraction of each triangle where a linear field, with ascending corner values, is at least a level."""
    least, middle, most = values.T
    with np.errstate(divide="ignore", invalid="ignore"):
        below = (level - least)**2 / ((middle - least) * (most - least))
        above = (most - level)**2 / ((most - middle) * (most - least))
    return np.select([level <= least, level <= middle, level <= most], [1.0, 1 - below, above], 0.0)


def _cut(points: np.ndarray, shares: np.ndarray, level: float) -> np.ndarray:
    """Return the parts of elements above a level: quarters of elements entirely above, parts of triangles of others."""
    entire = np.all(shares >= level, axis=1)
    quarters = points[entire][:, _QUADS].reshape(-1, 4, 2)
    triangles, values = points[~entire][:, _TRIANGLES].reshape(-1, 3, 2), shares[~entire][:, _TRIANGLES].reshape(-1, 3)
    inside = values >= level
    pieces = [quarters]
    for count in (1, 2, 3):
        chosen = inside.sum(axis=1) == count
        # The corner on the other side of the level than the other two comes first.
        odd = np.argmax(inside[chosen] if count == 1 else ~inside[chosen], axis=1) if count < 3 else 0
        order = (np.reshape(odd, (-1, 1)) + np.arange(3)) % 3
        (first, second, third), (a, b, c) = (np.moveaxis(np.take_along_axis(
            array[chosen], order[..., None] if array.ndim == 3 else order, axis=1), 1, 0)
            for array in (triangles, values))
        if count == 3:
            pieces.append(np.stack([first, second, third, third], axis=1))
            continue
        to_second, to_third = ((level - a) / (other - a) for other in (b, c))
        near, far = first + to_second[:, None] * (second - first), first + to_third[:, None] * (third - first)
        pieces.append(np.stack([first, near, far, far] if count == 1 else [near, second, third, far], axis=1))
    return np.concatenate(pieces)


def outline(cells: np.ndarray) -> np.ndarray:
    """Return the boundary edges of cells, (edges, 2 ends, 2), with the cells on their left; inner edges cancel."""
    if not len(cells):
        return np.empty((0, 2, 2))
    edges = np.stack([cells, np.roll(cells, -1, axis=1)], axis=2).reshape(-1, 2, 2)
    places = np.round(edges / (np.abs(cells).max() * GRAIN)).astype(np.int64)
    ends = places @ [2**32, 1]
    forward = ends[:, 0] < ends[:, 1]
    _, first, edge = np.unique(np.sort(ends, axis=1), axis=0, return_index=True, return_inverse=True)
    balance = np.zeros(len(first), dtype=int)
    np.add.at(balance, edge.ravel(), np.where(forward, 1, -1) * (ends[:, 0] != ends[:, 1]))
    kept = balance != 0
    turned = (balance[kept] > 0) != forward[first[kept]]
    return np.asarray(np.where(turned[:, None, None], edges[first[kept]][:, ::-1], edges[first[kept]]))
