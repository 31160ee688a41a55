"""Tests of the section on doublers and stringers."""

import unittest
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from implam_post.io.deck import Deck
from implam_post.io.history import History
from implam_post.plot.style import PictureStyle
from implam_post.report.stiffeners import HEAD, stiffener_rows

PANEL = """&case units='SI' /
&plate length=400e-3, 306e-3  edges='clamped' /
&doubler name='flange' at=0, -51e-3 size=400e-3, 36e-3 materials='a' stacking='[45/-45]s' ply_thickness=0.25e-3 /
&stringer name='left' at=-51e-3 height=30e-3 thickness=3e-3 E=50e9 density=1600 /
&stringer name='frame' along='Y' section='T' face='front' height=60e-3 thickness=3e-3 cap_width=20e-3
          cap_thickness=4e-3 E=50e9 density=1600 /
&stringer name='beam' section='given' EA=1e6 EI=1 GJ=1 mass_per_length=1 /
"""
SUMMARY = {"plate_size": [400e-3, 306e-3],
           "plies": [{"thickness": 0.25e-3}, *4 * [{"thickness": 0.25e-3, "doubler": "flange"}]]}
COLUMNS = {"time": np.array([0, 1e-3, 2e-3]), "stringer_force_1": np.array([0, -2500.0, 1800.0]),
           "stringer_strain_1": np.array([0, 1e-3, -2e-3])}


def rows_of(text: str, columns: dict[str, np.ndarray] | None) -> list[tuple[str, ...]]:
    """Return the rows of a deck and a history."""
    history = None if columns is None else History(columns)
    return stiffener_rows(SimpleNamespace(deck=Deck(text, Path("panel.nml")), summary=SUMMARY, columns=history),
                          PictureStyle("SI"))


class StiffenerRowsTest(unittest.TestCase):
    """Rows of decks."""

    def test_places_and_sections(self) -> None:
        """Each doubler and stringer has a row with its place, on the struck face or the back, and its section."""
        doubler, left, frame, beam = rows_of(PANEL, None)
        self.assertEqual(doubler, ("doubler 'flange'", "400 mm by 36 mm about (0, -51) mm, back face",
                                   "4 plies, 1 mm", "", ""))
        self.assertEqual(left[:3], ("stringer 'left'", "y = -51 mm, back face", "blade, 30 mm by 3 mm"))
        self.assertEqual(frame[:3], ("stringer 'frame'", "x = 0 mm, front face", "T, 60 mm by 3 mm, cap 20 mm by 4 mm"))
        self.assertEqual(beam[2:], ("given stiffness", "-", "-"))
        self.assertTrue(all(len(row) == len(HEAD) for row in (doubler, left, frame, beam)))

    def test_largest_magnitude(self) -> None:
        """The value of largest magnitude keeps its sign and has its time."""
        left = rows_of(PANEL, COLUMNS)[1]
        self.assertEqual(left[3:], ("-2.5 kN at 1 ms", "-0.2 % at 2 ms"))

    def test_plain_plate(self) -> None:
        """No section."""
        self.assertEqual(rows_of("&plate length=0.2, 0.2 edges='free' /", None), [])
