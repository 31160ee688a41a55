"""Plies with two moduli along the fibres."""

import unittest

from implam_post.laminate.decks import bending_modulus


class Moduli(unittest.TestCase):
    """The modulus that other programs get."""

    def test_bending_modulus_lies_between_both(self):
        """It is that of a beam with two moduli, and the modulus itself if both are equal."""
        self.assertAlmostEqual(113.528421, bending_modulus(130.0, 100.0), places=6)
        self.assertEqual(130.0, bending_modulus(130.0, 130.0))


if __name__ == "__main__":
    unittest.main()
