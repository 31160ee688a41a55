"""Tests of smooth regions: area, closed outlines, symmetry."""

import unittest

import numpy as np

from implam_post.io.contours import WEIGHTS, area, nine_points, outline, region
from implam_post.plot.plan_frame import outlines

EDGES = np.linspace(0, 1, 21)


def elements(edges: np.ndarray = EDGES) -> np.ndarray:
    """Return the corners of a square grid of elements, counter-clockwise."""
    sides = np.stack([edges[:-1], edges[1:]], axis=1)
    return np.array([[(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])] for y in sides for x in sides])


def disc(radius: float, width: float) -> tuple[np.ndarray, np.ndarray]:
    """Return elements and shares of a quarter of a disc whose share falls to zero over a width."""
    corners = elements()
    distance = np.hypot(*np.moveaxis(nine_points(corners), -1, 0))
    return corners, np.clip((radius - distance) / width + 0.5, 0, 1)


class ContoursTest(unittest.TestCase):
    """Regions of known fields."""

    def test_area_is_the_integral(self) -> None:
        """The area is Simpson's integral of the shares to round-off, and that of the disc to the size of elements."""
        for radius, width in ((0.5, 0.2), (0.7, 0.05), (0.2, 0.4)):
            corners, shares = disc(radius, width)
            content = float(np.sum(shares @ WEIGHTS)) / len(corners)
            cells = region(corners, shares)
            self.assertAlmostEqual(area(cells) / content, 1, delta=1e-12)
            if width < radius:
                self.assertAlmostEqual(content, np.pi / 4 * (radius**2 + width**2 / 12), delta=2e-3)

    def test_outline_is_round(self) -> None:
        """The outline of a disc of radius .5 is within .004, a tenth of an element; cells would be .035 off."""
        edges = outline(region(*disc(0.5, 0.2)))
        distance = np.hypot(*np.moveaxis(edges, -1, 0)).ravel()
        free = np.all(edges.reshape(-1, 2) > 1e-9, axis=1)
        self.assertLess(np.ptp(distance[free]), 0.008)

    def test_slight_damage_has_small_area(self) -> None:
        """A share of .001 everywhere has an area of .001 of the plate, not the full plate."""
        corners = elements()
        shares = np.full((len(corners), 9), 1e-3)
        shares[0] = 0.5
        self.assertAlmostEqual(float(np.sum(shares @ WEIGHTS)) / len(corners), 2.2475e-3)
        self.assertLessEqual(area(region(corners, shares)), 1 / len(corners) + 1e-12)
        self.assertEqual(len(region(corners, np.zeros_like(shares))), 0)

    def test_a_hole_turns_the_other_way(self) -> None:
        """A ring has two closed outlines with opposite senses; the sum of their signed areas is that of the ring."""
        corners, shares = disc(0.8, 0.1)
        _, inner = disc(0.4, 0.1)
        whole = np.concatenate([(corners * signs)[:, ::sign] for signs, sign in
                                (((1, 1), 1), ((-1, 1), -1), ((-1, -1), 1), ((1, -1), -1))])
        cells = region(whole, np.concatenate([(shares - inner)[:, order] for order in (
            [*range(9)], [3, 2, 1, 0, 6, 5, 4, 7, 8], [*range(9)], [3, 2, 1, 0, 6, 5, 4, 7, 8])]))
        path = outlines(cells)
        self.assertEqual(np.count_nonzero(path.codes == path.MOVETO), 2)
        loops = np.split(path.vertices, np.flatnonzero(path.codes == path.MOVETO)[1:])
        turned = [np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]) / 2 for x, y in (loop.T for loop in loops)]
        self.assertLess(min(turned), 0)
        self.assertAlmostEqual(sum(turned), area(cells), delta=1e-9)


if __name__ == "__main__":
    unittest.main()
