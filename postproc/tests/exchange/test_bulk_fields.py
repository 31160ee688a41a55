"""Tests of implam-from-nastran on indented lines, WTMASS, NSM, temperatures, supports and defaults."""

import contextlib
import io
import unittest
from pathlib import Path

from implam_post.exchange import from_nastran
from implam_post.io.deck import read_deck
from implam_post.laminate.decks import plies_of
from implam_post.laminate.sections import natural_shear_correction
from tests.bulk import LAMINATE, MATERIALS, Bulk, free, large, small
from tests.exchange.test_from_nastran import ImportTest

HEAD = "SOL 101\nCEND\nSPC = 1\nTEMP(LOAD) = 4\nBEGIN BULK\n"


class BlanksTest(ImportTest):
    """Indented lines."""

    def text_of_deck(self, text: str) -> str:
        """Return the deck of a file."""
        code, printed = self.run_command(text)
        self.assertEqual(code, 0, printed)
        return (self.folder / "panel.nml").read_text()

    def test_names_anywhere_in_their_field(self) -> None:
        """A file with all cards indented gives the same deck as without indents."""
        expected = self.text_of_deck(Bulk(write=free).text())
        indented = "\n".join("  " + line if line[0] != "," else line for line in Bulk(write=free).text().splitlines())
        self.assertEqual(self.text_of_deck(indented), expected)
        for write in (small, large):
            lines = Bulk(write=write).text().splitlines()
            moved = [" " + line[:8].rstrip().ljust(7) + line[8:] if line[0].isalpha() and line[7] == " " else line
                     for line in lines]
            self.assertNotEqual(moved, lines)
            self.assertEqual(self.text_of_deck("\n".join(moved)), expected)

    def test_blank_before_the_end(self) -> None:
        """ENDDATA may be indented, and indented continuations are still continuations."""
        text = Bulk().text()
        for end in ("  ENDDATA\n", "\tENDDATA\n", "          enddata\n"):
            self.assertEqual(self.text_of_deck(text + end + "GRID,1,,7.,7.,7.\nrubbish,,\n"), self.text_of_deck(text))
        self.assertEqual(self.text_of_deck(text.replace("\n+ ", "\n  ")), self.text_of_deck(text))

    def test_names_beyond_their_field(self) -> None:
        """A card with its name outside of the first field is refused; the message has the name and the line."""
        for line, name in (("     CQUAD4       1", "CQUAD4"), ("\tGRID\t7", "GRID"), ("        MAT8    3", "MAT8")):
            text = Bulk(head="$\n").text() + line + "\n"
            code, printed = self.run_command(text)
            self.assertEqual((code, printed.count("\n")), (2, 1), printed)
            self.assertIn(f"panel.bdf:{len(text.splitlines())}: {name}: it begins in column", printed)

    def test_byte_order_marks(self) -> None:
        """Comments are not part of the first card or of the deck."""
        path = self.folder / "panel.bdf"
        path.write_bytes(b"\xef\xbb\xbf" + Bulk(head="GRDSET,,,,,,,6\n").text().encode())
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(from_nastran.main([str(path), "-o", str(self.folder / "panel.nml")]), 0)
        deck = self.folder / "panel.nml"
        plain = read_deck(deck)
        deck.write_bytes(b"\xef\xbb\xbf" + deck.read_bytes())
        self.assertEqual(plies_of(read_deck(deck)), plies_of(plain))


class MassTest(ImportTest):
    """PARAM,WTMASS converts weights to masses."""

    def density(self, text: str) -> float:
        """Return the density of the first ply."""
        code, printed = self.run_command(text)
        self.assertEqual(code, 0, printed)
        self.printed = printed
        return plies_of(read_deck(Path(self.folder / "panel.nml")))[0].material.density

    def test_factor(self) -> None:
        """In any format, in the bulk data or the case control; other parameters are ignored."""
        for write in (small, large, free):
            bulk = Bulk(write=write, more=[("PARAM", "WTMASS", 2.59e-3), ("PARAM", "POST", -1)])
            self.assertAlmostEqual(self.density(bulk.text()), 1580 * 2.59e-3, delta=1e-9)
            self.assertIn("WTMASS   0.00259, line", self.printed)
            self.assertIn("PARAM    1, line", self.printed)
        self.assertAlmostEqual(self.density(HEAD.replace("BEGIN", "PARAM,WTMASS,2.59-3\nBEGIN") + Bulk().text()),
                               1580 * 2.59e-3, delta=1e-9)
        self.assertEqual(self.density(Bulk().text()), 1580)

    def test_nonstructural_mass(self) -> None:
        """NSM times WTMASS is mass per area; densities times thicknesses add up to it."""
        laminate = [(*LAMINATE[0][:3], 0.5, *LAMINATE[0][4:])]
        own = 4 * 0.125e-3 * 1580 + 2 * 0.25e-3 * 2700
        for factor, more in ((1.0, []), (2.59e-3, [("PARAM", "WTMASS", 2.59e-3)])):
            plies = plies_of(self.deck(Bulk(laminate=laminate, more=more)))
            self.assertAlmostEqual(sum(ply.material.density * ply.thickness for ply in plies) / factor, own + 0.5, 9)
        self.refused(Bulk(laminate=[(*LAMINATE[0][:3], -0.5, *LAMINATE[0][4:])]), "NSM must not be negative")

    def test_factors_that_are_none(self) -> None:
        """A WTMASS that is not a number or not positive, or two of them, are refused."""
        for more in ([("PARAM", "WTMASS", 0.0)], [("PARAM", "WTMASS", "YES")], [("PARAM", "WTMASS")],
                     [("PARAM", "WTMASS", 1.0), ("PARAM", "WTMASS", 2.0)]):
            self.refused(Bulk(more=more), "PARAM")
        self.refused(Bulk(head=HEAD.replace("BEGIN", "PARAM,WTMASS,none\nBEGIN")), "WTMASS,none in the case control")


class TemperatureTest(ImportTest):
    """A1, A2, TREF and TEMPD."""

    def imported(self, bulk: Bulk) -> str:
        """Return the text of the deck."""
        code, self.printed = self.run_command(bulk.text())
        self.assertEqual(code, 0, self.printed)
        return (self.folder / "panel.nml").read_text()

    def cured(self, reference: float | None = 180.0, laminate: float | None = None, **more: object) -> Bulk:
        """Return a panel whose plies have thermal expansion."""
        materials = [(*MATERIALS[0][:9], -0.3e-6, 28e-6, reference, *MATERIALS[0][12:]),
                     (*MATERIALS[1], 23e-6, reference)]
        return Bulk(materials=materials, laminate=[(*LAMINATE[0][:6], laminate, *LAMINATE[0][7:])], **more)

    def test_expansion_and_change(self) -> None:
        """The case control selects the temperature; TREF is that of the materials or of the laminate."""
        temperature = [("TEMPD", 4, 20.0, 5, 70.0)]
        text = self.imported(self.cured(head=HEAD, more=temperature))
        self.assertIn("alpha1=-3e-7 alpha2=2.8e-5", text)
        self.assertIn("alpha1=2.3e-5 alpha2=2.3e-5", text)
        self.assertIn("\n&thermal   delta_T=-160 /\n", text)
        self.assertIn("set 5 is ignored", self.printed)
        self.assertIn("PCOMP, line 38: TREF is blank: that of the materials is used", self.printed)
        self.assertIn("delta_T=20 /", self.imported(self.cured(180.0, 0.0, head=HEAD, more=temperature)))
        self.assertNotIn("is blank", self.printed)
        self.assertIn("delta_T=-110 /", self.imported(self.cured(130.0, head=HEAD, more=temperature)))
        self.assertIn("delta_T=-100 /", self.imported(self.cured(180.0, 120.0, head=HEAD, more=temperature)))
        self.assertIn("delta_T=20 /", self.imported(self.cured(None, head=HEAD, more=temperature)))
        self.assertIn("delta_T=-160 /", self.imported(self.cured(more=[("TEMPD", 9, 20.0)])))

    def test_reference_alone(self) -> None:
        """Without a temperature the deck has TREF in a comment, which the report mentions."""
        text = self.imported(self.cured())
        self.assertIn("! Stress-free at TREF = 180: &thermal  delta_T=", text)
        self.assertIn("TREF is written as a comment of the deck", self.printed)
        self.assertIn("! alpha1 and alpha2 are used with &thermal", self.imported(self.cured(None)))
        self.assertNotIn("thermal", self.imported(Bulk()))
        text = self.imported(self.cured(head=HEAD.replace("4", "1"), more=[("TEMPD", 4, 20.0)]))
        self.assertNotIn("\n&thermal", text)

    def test_temperatures_that_differ(self) -> None:
        """Two reference temperatures, two sets, or temperatures of single grids are refused."""
        bulk = self.cured(head=HEAD, more=[("TEMPD", 4, 20.0)])
        bulk.materials[1] = (*bulk.materials[1][:-1], 20.0)
        self.refused(bulk, "its TREF differs from that of the MAT8")
        self.refused(self.cured(head=HEAD.replace("BEGIN", "TEMP = 5\nBEGIN")), "the temperature sets [4, 5]")
        text = self.imported(self.cured(head=HEAD, more=[("TEMPD", 4, 20.0), ("TEMP", 4, 1, 50.0)]))
        self.assertNotIn("\n&thermal", text)
        self.assertIn("single grids or elements have other temperatures", self.printed)


class InPlaneTest(ImportTest):
    """Edges constrained in one in-plane direction, or differently from others."""

    def lines(self, *edges: str, **more: object) -> list[tuple[object, ...]]:
        """Return place, direction and component of the lines of a deck."""
        deck = self.deck(Bulk(edges=edges, **more))
        self.assertEqual(deck.value("plate", "in_plane"), "free")
        return [tuple(group[key][0] for key in ("at", "direction", "component"))
                for group in deck.groups.get("line", [])]

    def test_simple_supports_held_along_themselves(self) -> None:
        """SS1: v on edges x = constant, u on edges y = constant."""
        self.assertEqual(self.lines("234", "234", "135", "135"),
                         [(-0.1, "y", "v"), (0.1, "y", "v"), (-0.075, "x", "u"), (0.075, "x", "u")])
        self.assertEqual(self.lines("3", "3", "13", ""), [(-0.075, "x", "u")])

    def test_edges_that_differ(self) -> None:
        """One edge constrained in both directions, one in its normal direction; components rotate with the panel."""
        self.assertEqual(self.lines("1234", "34", "35", "35"), [(-0.1, "y", "u"), (-0.1, "y", "v")])
        self.assertEqual(self.lines("134", "1234", "35", "35"), [(-0.1, "y", "u"), (0.1, "y", "u"), (0.1, "y", "v")])
        turned = {"place": lambda x, y: (y, 0.2 - x, 0.0), "write": large}
        self.assertEqual(self.lines("1345", "35", "34", "34", **turned), [(0.1, "x", "u")])

    def test_edges_alike_need_no_lines(self) -> None:
        """In-plane constraints in both directions on all edges are in_plane='fixed', none are 'free'."""
        self.assertNotIn("line", self.deck(Bulk()).groups)
        self.assertNotIn("line", self.deck(Bulk(edges=("34", "34", "35", "35"))).groups)


class DefaultsTest(ImportTest):
    """Defaults of blank fields by other cards or options."""

    def test_grdset(self) -> None:
        """GRDSET gives constrained components and the coordinate system of grids without their own."""
        bulk = Bulk(edges=("34", "34", "35", "35"), more=[("GRDSET", None, None, None, None, None, None, 126)])
        self.refused(bulk, "in-plane, which is not the support of an entire edge")
        bulk.more = [("GRDSET", None, None, None, None, None, None, 6)]
        self.assertEqual(self.deck(bulk).edges(), 4 * ["simple"])
        bulk.more = [("GRDSET", None, 4, None, None, None, None, 6), ("CORD2R", 4, None, *3 * [0.0], 0.0, 0.0, 1.0,
                                                                       0.0, 1.0, 0.0)]
        self.assertEqual(self.deck(bulk).lengths(), (0.15, 0.2))
        bulk.more = [("GRDSET", None, 9)]
        self.refused(bulk, "coordinate system 9")

    def test_shear_modulus_by_an_option(self) -> None:
        """--g2z is used only where G2Z is blank."""
        carbon = MATERIALS[0]
        bulk = Bulk(materials=[(*carbon[:7], None, *carbon[8:]), MATERIALS[1]])
        self.refused(bulk, "G2Z is required, on the card or with --g2z")
        self.assertEqual(plies_of(self.deck(bulk, "--g2z", "3.1e9"))[0].material.g23, 3.1e9)
        self.assertEqual(plies_of(self.deck(Bulk(), "--g2z", "3.1e9"))[0].material.g23, 2.98e9)
        self.assertEqual(self.run_command(bulk.text(), "--g2z", "0")[0], 1)

    def test_no_transverse_shear_deformation(self) -> None:
        """Moduli that stand for it are 100 times E1 in the deck, which is said; smaller ones are those of the file."""
        carbon = MATERIALS[0]
        for given, expected in (((1e15, 1e15), (139e11, 139e11)), ((4.6e9, 1e20), (4.6e9, 139e11)),
                                ((1e16, None), (139e11, 3.1e9)), ((139e10, 2.98e9), (139e10, 2.98e9))):
            bulk = Bulk(materials=[(*carbon[:6], *given, *carbon[8:]), MATERIALS[1]])
            material = plies_of(self.deck(bulk, "--g2z", "3.1e9"))[0].material
            self.assertEqual((material.g13, material.g23), expected)
            text = self.run_command(bulk.text(), "--g2z", "3.1e9")[1]
            self.assertEqual(text.count("is taken as no transverse shear deformation: 1.39e+13 has"),
                             expected.count(139e11))

    def test_elements_beside_a_patch(self) -> None:
        """At least three elements per direction, two without an impact."""
        impact = ("--mass", "1", "--velocity", "1", "--radius", "0.01")
        self.assertEqual(self.deck(Bulk(), *impact).numbers("mesh", "elements"), [3, 3])
        self.assertEqual(self.deck(Bulk(cells=(8, 3)), *impact).numbers("mesh", "elements"), [4, 3])
        self.assertEqual(self.deck(Bulk()).numbers("mesh", "elements"), [2, 2])

    def test_sandwich(self) -> None:
        """A honeycomb core causes the shear stiffness from equilibrium; equal plies keep the default."""
        core = ("MAT8", 2, 1e6, 1e6, 0.1, 1e6, 130e6, 60e6, 48.0)
        bulk = Bulk(materials=[MATERIALS[0], core])
        self.assertEqual(self.deck(bulk).value("laminate", "shear_correction"), "energy")
        self.assertEqual(natural_shear_correction(plies_of(self.deck(bulk))), "energy")
        # Its shear moduli exceed its own in-plane moduli, but not those of the skins.
        materials = {ply.material.e1: ply.material for ply in plies_of(self.deck(bulk))}
        self.assertEqual((materials[1e6].g13, materials[1e6].g23), (130e6, 60e6))
        bulk = Bulk(materials=[MATERIALS[0], (*core[:6], 1e20, 1e20, 48.0)])
        materials = {ply.material.e1: ply.material for ply in plies_of(self.deck(bulk))}
        self.assertEqual((materials[1e6].g13, materials[1e6].g23), (1e11, 1e11))
        self.assertEqual(self.deck(Bulk()).values("laminate", "shear_correction"), [])


if __name__ == "__main__":
    unittest.main()
