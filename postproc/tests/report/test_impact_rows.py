"""Tests of the section on the test of an impact, and of the copy of the deck."""

import unittest
from pathlib import Path
from types import SimpleNamespace

from implam_post.io.deck import Deck
from implam_post.plot.style import PictureStyle
from implam_post.report.command import _event, _interfaces_head, _rounded_deck
from implam_post.report.impact import impact_rows

PANEL = """&case units='SI' /
&plate length=150e-3, 100e-3  edges='free' /
&support window=125e-3, 75e-3  unilateral=.true.  bearing='edge' /
&support clamps=50e-3,44e-3, -50e-3,44e-3  clamp_force=1100 /
&impactor mass=5.5  energy=28.1  radius=8e-3  at=0, 5e-3 /
"""
SUMMARY = {"plies": 32 * [{"thickness": 0.131e-3}], "energy_impact": 28.1, "peak_force": 1.0}


def rows_of(text: str, system: str = "SI", summary: dict[str, object] | None = None) -> dict[str, tuple[str, str]]:
    """Return values and remarks of the rows by their labels."""
    run = SimpleNamespace(deck=Deck(text, Path("panel.nml")), summary=summary or SUMMARY)
    return {label: (value, remark) for label, value, remark in impact_rows(run, PictureStyle(system))}


class ImpactRowsTest(unittest.TestCase):
    """Rows of decks."""

    def test_panel_on_a_frame(self) -> None:
        """All that ASTM D7136 asks for; the velocity follows from the energy."""
        rows = rows_of(PANEL)
        self.assertEqual(rows["impact velocity"][0], "3.197 m/s")
        self.assertEqual(rows["mass of the impactor"][0], "5.5 kg")
        self.assertEqual(rows["nose of the impactor"][0], "hemisphere of 16 mm in diameter")
        self.assertEqual(rows["impact energy per thickness"][0], "6.703 J/mm")
        self.assertEqual(rows["panel"], ("150 mm by 100 mm, 4.19 mm thick", "32 plies"))
        self.assertEqual(rows["frame, window"][0], "125 mm by 75 mm")
        self.assertIn("may lift off", rows["frame, window"][1])
        self.assertEqual(rows["clamps"], ("2 at (50, 44) mm, (-50, 44) mm", "x, y; 1.1 kN each"))
        self.assertEqual(rows["struck point, from the centre"][0], "(0, 5) mm")

    def test_other_units_and_supports(self) -> None:
        """The energy per thickness is in J/mm in any system; edges that differ are named."""
        text = PANEL.replace("'SI'", "'mm-t-s'").replace("e-3", "")
        text = text.replace("'free'", "'clamped','free','simple','free'")
        rows = rows_of(text.replace("28.1", "28100"), "mm-t-s", SUMMARY | {
            "plies": 32 * [{"thickness": 0.131}], "energy_impact": 28100.0})
        self.assertEqual(rows["impact energy per thickness"][0], "6.703 J/mm")
        self.assertEqual(rows["edges of the panel"][0], "x-min clamped, x-max free, y-min simple, y-max free")

    def test_bearing_of_a_frame(self) -> None:
        """Choices of a deck may be in capitals; sides may have another bearing than the ends."""
        rows = rows_of(PANEL.replace("'edge'", "'EDGE'"))
        self.assertIn("supports at the edge of its window, the panel", rows["frame, window"][1])
        rows = rows_of(PANEL.replace("unilateral=.true.  bearing='edge'", "bearing='face'  sides='Edge'"))
        self.assertIn("supports on its face, its sides along x at the edge of its window", rows["frame, window"][1])

    def test_without_an_impactor(self) -> None:
        """No section."""
        self.assertEqual(rows_of(PANEL[:PANEL.index("&impactor")]), {})

    def test_large_areas_have_no_exponent(self):
        """14220 mm², as in the summary of a run, without an exponent up to seven digits."""
        self.assertEqual(PictureStyle("SI").shown("area", 14220.4e-6, 4), "14220 mm²")
        self.assertEqual(PictureStyle("SI").shown("area", 123.4e-6, 4), "123.4 mm²")
        self.assertEqual(PictureStyle("SI").shown("area", 14.22, 4), "1.422e+07 mm²")

    def test_events_before_the_run(self) -> None:
        """An interface damaged by the impact has its onset before the compression, one without damage has none."""
        style = PictureStyle("SI")
        entry = {"onset": None, "onset_before_run": True, "first_growth": None, "first_growth_before_run": False}
        self.assertEqual(_event(entry, "onset", {}, style), "before this run")
        self.assertEqual(_event(entry, "first_growth", {}, style), "none")
        self.assertNotIn("threshold force (closed form)", _interfaces_head({}))
        self.assertIn("threshold force (closed form)", _interfaces_head(SUMMARY))

    def test_digits_of_random_inputs(self) -> None:
        """Numbers of ten and more digits have six, others and words stay."""
        deck = "&material name='T700/M21' XT=2083123456.1234567 nu12=0.30912345678901 E1=139e9 t=0.1333333e-3 /"
        self.assertEqual(_rounded_deck({"provenance": {"deck": deck}}),
                         "&material name='T700/M21' XT=2.08312e+09 nu12=0.309123 E1=139e9 t=0.1333333e-3 /")


if __name__ == "__main__":
    unittest.main()
