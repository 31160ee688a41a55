"""Tests of stacking sequences."""

import unittest

from implam_post.io.errors import DeckError
from implam_post.laminate.decks import plies_of
from implam_post.laminate.stacking import angles_of
from implam_post.reference.decks import impactor_of
from tests.decks import SUN_CHEN, deck


class StackingTest(unittest.TestCase):
    """Notation of stacking sequences, and its use in decks."""

    def test_sequences(self) -> None:
        """The same sequences as in the test of the solver."""
        plies = {
            "[45/0/-45/90]2s": [45, 0, -45, 90, 45, 0, -45, 90, 90, -45, 0, 45, 90, -45, 0, 45],
            "[0_2/90]s": [0, 0, 90, 90, 0, 0],
            "[0/90~]s": [0, 90, 0],
            "[0~]s": [0],
            "[+-45/0]_2": [45, -45, 0, 45, -45, 0],
            "[±45_2]": [45, -45, 45, -45],
            "[-+30]T": [-30, 30],
            "[(0/90)2/45]s": [0, 90, 0, 90, 45, 45, 90, 0, 90, 0],
            "[0/90]s2": [0, 90, 90, 0, 0, 90, 90, 0],
            " [ 0 / 22.5 ] ": [0, 22.5],
            "0_3/-90": [0, 0, 0, -90],
        }
        for sequence, angles in plies.items():
            with self.subTest(sequence):
                self.assertEqual(angles_of(sequence), angles)

    def test_faults(self) -> None:
        """Invalid sequences are refused with the position of the error."""
        for sequence, place in {"[45/x]2s": 5, "[0/90": 6, "0/90]": 5, "[0/]": 4, "[0/90s]": 6, "[0/400]": 4,
                                "[02/90]": 2, "[45/-045]": 5, "[00.5]": 2,
                                "[0]2000": 4, "[0/90~]": 8, "[0,90]": 3, "[0/\N{MINUS SIGN}45]": 4}.items():
            with self.subTest(sequence), self.assertRaisesRegex(DeckError, f"character {place} on"):
                angles_of(sequence)

    def test_deck(self) -> None:
        """Stacking with one thickness gives the same section as lists, energy the same velocity."""
        listed = deck(SUN_CHEN)
        shorthand = deck(SUN_CHEN, ("angles=0,90,0,90,0,0,90,0,90,0", "stacking='[0/90/0/90/0]s'"),
                    ("thicknesses=10*0.269e-3", "ply_thickness=0.269e-3"), ("velocity=3", "energy=38.4165e-3"))
        self.assertEqual(plies_of(shorthand), plies_of(listed))
        self.assertAlmostEqual(impactor_of(shorthand).velocity, 3, delta=1e-12)
        with self.assertRaisesRegex(DeckError, "angles and thicknesses"):
            plies_of(deck(SUN_CHEN, ("angles=", "ply_thickness=1e-3 angles=")))
