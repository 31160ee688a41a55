"""Tests of connections of the panel: rigid bodies, beams, springs, equations and masses at its grids."""

from implam_post.io.deck import read_deck
from tests.bulk import Bulk
from tests.exchange.test_from_nastran import ImportTest

FREE = ("", "", "", "")
OUTSIDE = ("GRID", 900, None, 0.0, 0.0, 0.0)
EDGE = Bulk().on_edge(0)
NOTHING = "nothing supports the panel: all its edges are free in the deck"


class ConnectionTest(ImportTest):
    """Panels that something else supports."""

    def report(self, *more: tuple[object, ...], edges: tuple[str, str, str, str] = FREE) -> str:
        """Return the report, whose notes on free edges are in the deck, too."""
        code, printed = self.run_command(Bulk(edges=edges, more=list(more)).text())
        self.assertEqual(code, 0, printed)
        self.edges = read_deck(self.folder / "panel.nml").edges()
        text = (self.folder / "panel.nml").read_text()
        for line in printed.splitlines():
            if "free in the deck" in line:
                self.assertIn(f"! {line.strip()}\n", text)
        return printed

    def test_rigid_body_that_is_fixed(self) -> None:
        """An RBE2 to a grid constrained in all components is a support in its components."""
        for held, kind in (("123456", "clamped"), ("1234", "simple")):
            text = self.report(OUTSIDE, ("SPC1", 1, 123456, 900), ("RBE2", 800, 900, held, *EDGE))
            self.assertEqual(self.edges, [kind, "free", "free", "free"])
            self.assertRegex(text, "RBE2, line [0-9]+: read as a support, since grid 900 is constrained in all")
            self.assertRegex(text, "  RBE2     1, line [0-9]+\nread in part")
            self.assertNotIn("nothing supports", text)

    def test_rigid_body_that_moves(self) -> None:
        """Its edge is free in the deck, which the report says; another RBE2 is of no interest."""
        text = self.report(OUTSIDE, ("SPC1", 1, 123, 900), ("RBE2", 800, 900, 123456, *EDGE, None),
                           ("RBE2", 801, 900, 123456, 901))
        self.assertEqual(self.edges, 4 * ["free"])
        self.assertRegex(text, "RBE2, line [0-9]+: it connects the edge x-min to something that is not in the deck")
        self.assertRegex(text, "edge x-min: free in the deck, although the RBE2 in line [0-9]+ may support it")
        self.assertIn(NOTHING, text)
        self.assertNotIn("RBE2, lines", text)

    def test_other_connections(self) -> None:
        """Beams, springs, equations and rigid elements of other kinds."""
        end = EDGE[2]
        for card in (("CBAR", 1, 1, end, 900, 0.0, 1.0, 0.0), ("CBEAM", 1, 1, 900, end, 0.0, 1.0, 0.0),
                     ("CBUSH", 1, 1, end, None, None, None, None, 0), ("CELAS2", 1, 1e3, end, 3),
                     ("CROD", 1, 1, end, 900), ("RBAR", 1, 900, end, 123456, None, None, 123456),
                     ("RBE3", 1, None, 900, 123, 1.0, 123, *EDGE), ("MPC", 1, end, 3, 1.0, 900, 3, -1.0),
                     ("CQUADR", 99, 1, EDGE[1], end, 900, 901), ("RJOINT", 1, end, 900, 123), ("SUPORT", end, 3),
                     ("SUPORT1", 1, end, 3), ("GENEL", 1, None, end, 1, end, 2), ("RSSCON", 1, "GRID", end, 900, 901)):
            with self.subTest(card):
                text = self.report(OUTSIDE, card, edges=("", "1234", "1235", "1235"))
                self.assertRegex(text, f"{card[0]}, line [0-9]+: it connects the edge x-min to something")
                self.assertRegex(text, f"edge x-min: free in the deck, although the {card[0]} in line [0-9]+ may")
                self.assertNotIn("nothing supports", text)
                text = self.report(OUTSIDE, card, edges=("1234", "1234", "1235", "1235"))
                self.assertNotIn("may support", text)

    def test_inside(self) -> None:
        """Stiffeners and masses inside the panel; loads and outputs are no connections."""
        bulk = Bulk()
        text = self.report(OUTSIDE, ("CBAR", 1, 1, bulk.number(2, 2), bulk.number(4, 2), 0.0, 0.0, 1.0),
                           ("CONM2", 2, bulk.number(4, 2), None, 2.0), ("FORCE", 1, EDGE[0], 0, 1.0, 0.0, 0.0, 1.0),
                           ("PLOTEL", 3, EDGE[0], EDGE[1]), edges=("1234", "1234", "1235", "1235"))
        self.assertRegex(text, "CBAR, line [0-9]+: it connects grids inside the panel to something that is not")
        self.assertRegex(text, "CONM2, line [0-9]+: its mass at grids inside the panel is not in the deck")
        self.assertEqual(text.count("not in the deck"), 2)

    def test_no_support_at_all(self) -> None:
        """A panel without any support, and one whose supports belong to other grids."""
        self.assertIn(NOTHING, self.report())
        text = self.report(OUTSIDE, ("SPC1", 1, 123456, 900))
        self.assertIn(NOTHING, text)
        self.assertRegex(text, "SPC1, line [0-9]+: none of its grids belongs to the panel")
        self.assertNotIn(NOTHING, self.report(edges=("1234", "", "", "")))
