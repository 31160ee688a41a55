"""Tests of implam-from-nastran: conversion of cards, remarks, and errors."""

import contextlib
import importlib.util
import io
import os
import re
import tempfile
import unittest
from pathlib import Path
from typing import ClassVar
from unittest import mock

import numpy as np

from implam_post.exchange import from_nastran
from implam_post.io.deck import Deck, read_deck
from implam_post.laminate.decks import plies_of
from tests.bulk import LAMINATE, MATERIALS, Bulk, free, large, small

WITHOUT = None if importlib.util.find_spec("pyNastran") else "pyNastran is not installed"


class ImportTest(unittest.TestCase):
    """Each test has a folder for the files."""

    def setUp(self) -> None:
        """Make the folder."""
        if WITHOUT:
            self.skipTest(WITHOUT)
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def run_command(self, text: str, *options: str) -> tuple[int, str]:
        """Return exit code and text of the command on a file."""
        path = self.folder / "panel.bdf"
        path.write_text(text)
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            try:
                code = from_nastran.main([str(path), "-o", str(self.folder / "panel.nml"), *options])
            except SystemExit as end:
                code = end.code
        return code, printed.getvalue()

    def deck(self, bulk: Bulk, *options: str) -> Deck:
        """Return the deck of a panel."""
        code, printed = self.run_command(bulk.text(), *options)
        self.assertEqual(code, 0, printed)
        return read_deck(self.folder / "panel.nml")

    def refused(self, bulk: Bulk, *words: str, options: tuple[str, ...] = ()) -> None:
        """Fail unless the panel is refused in one sentence with these words and exit code 2."""
        code, printed = self.run_command(bulk.text(), *options)
        self.assertEqual((code, printed.count("\n")), (2, 1), printed)
        for word in words:
            self.assertIn(word, printed)


class CardsTest(ImportTest):
    """Conversion of the cards."""

    def test_small_large_and_free_fields(self) -> None:
        """All formats give the same deck with the numbers of the file."""
        texts = []
        for write in (small, large, free):
            deck = self.deck(Bulk(write=write))
            texts.append((self.folder / "panel.nml").read_text())
            self.assertEqual(deck.lengths(), (0.2, 0.15))
            self.assertEqual(deck.edges(), 4 * ["simple"])
            self.assertEqual(deck.value("plate", "in_plane"), "fixed")
            self.assertEqual(deck.numbers("mesh", "elements"), [2, 2])
        self.assertEqual(len(set(texts)), 1)

    def test_symmetric_laminate(self) -> None:
        """SYM adds the plies in reverse order; blank material and thickness are those of the preceding ply."""
        plies = plies_of(self.deck(Bulk()))
        self.assertEqual([ply.angle for ply in plies], [45, -45, 0, 0, -45, 45])
        self.assertEqual([ply.thickness for ply in plies], [0.125e-3, 0.125e-3, 0.25e-3, 0.25e-3, 0.125e-3, 0.125e-3])
        self.assertEqual([ply.material.name for ply in plies], ["MAT8_1", "MAT8_1", *2 * ["MAT1_2"], *2 * ["MAT8_1"]])
        carbon, metal = plies[0].material, plies[2].material
        self.assertEqual((carbon.e1, carbon.e2, carbon.nu12, carbon.g12, carbon.g13, carbon.g23, carbon.density),
                         (139e9, 9.4e9, 0.309, 4.5e9, 4.6e9, 2.98e9, 1580))
        self.assertEqual(dict(carbon.strengths), {"XT": 1517e6, "XC": 1590e6, "YT": 46e6, "YC": 253e6, "S12": 105e6})
        self.assertEqual((metal.e1, metal.nu12, metal.isotropic, metal.density), (70e9, 0.33, True, 2700))

    def test_global_plies(self) -> None:
        """A PCOMPG is equivalent to a PCOMP."""
        card = ("PCOMPG", 1, None, None, None, None, None, None, None, 101, 1, 0.1e-3, 30.0, None, None, None, None,
                102, 1, 0.2e-3, 90.0)
        plies = plies_of(self.deck(Bulk(laminate=[card])))
        self.assertEqual([(ply.thickness, ply.angle) for ply in plies], [(0.1e-3, 30), (0.2e-3, 90)])
        twice = tuple(101 if field == 102 else field for field in card)
        self.refused(Bulk(laminate=[twice]), "PCOMPG: global ply 101 is given twice")

    def test_isotropic_material_by_two_moduli(self) -> None:
        """NU follows from E and G."""
        material = ("MAT1", 2, 70e9, 28e9, None, 2700.0)
        deck = self.deck(Bulk(materials=[MATERIALS[0], material]))
        self.assertAlmostEqual(plies_of(deck)[2].material.nu12, 0.25)

    def test_elements(self) -> None:
        """A nine-node element for two by two CQUAD4, or for one CQUAD8."""
        self.assertEqual(self.deck(Bulk(cells=(8, 5))).numbers("mesh", "elements"), [4, 3])
        self.assertEqual(self.deck(Bulk(cells=(8, 5), eight=True)).numbers("mesh", "elements"), [8, 5])

    def test_fields_too_many(self) -> None:
        """Values after the ninth field of a line with commas, which would be lost, are refused; marks are not."""
        text = Bulk(write=free).text()
        line = next(line for line in text.splitlines() if line.startswith("MAT8"))
        whole = ",".join([*line.split(","), *9 * [""]][:9])
        for behind in (",1.-6,2.-5", ",,2.-5", ",+A,2"):
            code, printed = self.run_command(text.replace(line, whole + behind))
            self.assertEqual((code, printed.count("\n")), (2, 1), printed)
            self.assertIn("MAT8: ", printed)
            self.assertIn("follows the last field", printed)

    def test_planes(self) -> None:
        """The panel may lie in any coordinate plane; x is the first basic axis in it."""
        angles = [45, -45, 0, 0, -45, 45]
        for place, expected in ((lambda x, y: (x, 2.0, -y), "x, -z, y"), (lambda x, y: (7.0, x, y), "y, z, x"),
                                (lambda x, y: (x - 0.1, y + 3, 1.0), "x, y, z")):
            deck = self.deck(Bulk(place=place, write=large))
            self.assertIn(f"are {expected} of the file.", (self.folder / "panel.nml").read_text())
            self.assertEqual(deck.lengths(), (0.2, 0.15))
            self.assertEqual([ply.angle for ply in plies_of(deck)], angles)

    def test_panel_along_the_second_axis(self) -> None:
        """Elements whose first side runs along -y: lengths, supports and angles follow x of the basic system."""
        bulk = Bulk(place=lambda x, y: (y, 0.2 - x, 0.0), edges=("12345", "1235", "1234", ""), write=large)
        deck = self.deck(bulk)
        self.assertEqual(deck.lengths(), (0.15, 0.2))
        self.assertEqual(deck.edges(), ["simple", "free", "simple", "clamped"])
        self.assertEqual([ply.angle for ply in plies_of(deck)], [-45, 45, 90, 90, 45, -45])

    def test_material_axis(self) -> None:
        """THETA rotates the plies, MCID is the x axis of a system."""
        angles = [75, -15, 30, 30, -15, 75]
        self.assertEqual([ply.angle for ply in plies_of(self.deck(Bulk(theta=30.0)))], angles)
        self.assertEqual([ply.angle for ply in plies_of(self.deck(Bulk(theta=30.0, eight=True)))], angles)
        self.assertEqual([ply.angle for ply in plies_of(self.deck(Bulk(theta=0)))], [45, -45, 0, 0, -45, 45])
        system = ("CORD2R", 5, None, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, float(np.sqrt(3)), 1.0, 0.0)
        deck = self.deck(Bulk(theta=5, more=[system], write=large))
        np.testing.assert_allclose([ply.angle for ply in plies_of(deck)], angles, atol=1e-6)

    def test_turned_elements(self) -> None:
        """Elements numbered in the opposite sense reverse the order of plies: z is their normal, y changes sign."""
        plies = (*LAMINATE[0][:8], None, *LAMINATE[0][9:])
        bulk = Bulk(turned=True, laminate=[plies])
        deck = self.deck(bulk)
        self.assertIn("are x, -y, -z of the file.", (self.folder / "panel.nml").read_text())
        # The first side runs along -x: an angle of 45 degrees there is also 45 from x, as both senses change.
        self.assertEqual([ply.angle for ply in plies_of(deck)], [45, -45, 0])

    def test_struck_on_the_last_ply(self) -> None:
        """Plies in reverse order; y changes sign, and with it angles and edges along y."""
        plies = (*LAMINATE[0][:8], None, *LAMINATE[0][9:])
        bulk = Bulk(laminate=[plies], edges=("1234", "1234", "12345", "1235"))
        deck = self.deck(bulk, "--struck", "last")
        self.assertEqual([ply.angle for ply in plies_of(deck)], [0, 45, -45])
        self.assertEqual(deck.edges(), ["simple", "simple", "simple", "clamped"])

    def test_edges(self) -> None:
        """Clamped, simple and free edges; in-plane rigid-body motion may be suppressed at single grids."""
        bulk = Bulk(edges=("345", "34", "35", ""))
        self.assertEqual(self.deck(bulk).edges(), ["clamped", "simple", "simple", "free"])
        self.assertEqual(self.deck(bulk).value("plate", "in_plane"), "free")
        bulk.more = [("SPC1", 1, "12", 1), ("SPC1", 1, "2", bulk.number(8, 0))]
        self.assertEqual(self.deck(bulk).value("plate", "in_plane"), "free")
        bulk.more.append(("SPC1", 1, "1", bulk.number(4, 2), bulk.number(4, 4)))
        self.refused(bulk, "in-plane, which is not the support of an entire edge")
        self.assertEqual(self.deck(Bulk(edges=("", "", "", ""))).edges(), 4 * ["free"])

    def test_softer_supports_are_reported(self) -> None:
        """Deflection only is a simple support, with the rotation about the edge a clamp; both cause a remark."""
        code, printed = self.run_command(Bulk(edges=("123", "1235", "1235", "1235")).text())
        self.assertEqual(code, 0, printed)
        self.assertEqual(read_deck(self.folder / "panel.nml").edges(), ["simple", "clamped", "simple", "simple"])
        self.assertIn("edge x-min: simple; in the file the rotation along the edge is free", printed)
        self.assertIn("edge x-max: clamped; in the file the rotation along the edge is free", printed)
        self.assertNotIn("edge y-min", printed)

    def test_rotation_about_the_normal_does_not_count(self) -> None:
        """All grids may be constrained, by PS or by a card with THRU."""
        bulk = Bulk(more=[("SPC1", 1, "6", 1, "THRU", 63)])
        self.assertEqual(self.deck(bulk).edges(), 4 * ["simple"])

    def test_sets_of_supports(self) -> None:
        """The case control or --spc selects a set, also an SPCADD; a single set is the default."""
        bulk = Bulk(more=[("SPC1", 2, "12345", *Bulk().on_edge(0)), ("SPCADD", 9, 1, 2)])
        self.refused(bulk, "choose one with --spc")
        for number, edge in ((1, "simple"), (9, "clamped")):
            self.assertEqual(self.deck(bulk, "--spc", str(number)).edges()[0], edge)
        bulk.head = "SOL 101\nCEND\nSPC = 9\nBEGIN BULK\n"
        self.assertEqual(self.deck(bulk).edges()[0], "clamped")
        self.refused(bulk, "SPC = 7 of --spc", options=("--spc", "7"))

    def test_spc_cards(self) -> None:
        """SPC constrains single grids; prescribed displacements are refused."""
        bulk = Bulk(edges=("1234", "1234", "1235", ""))
        bulk.more = [("SPC", 1, grid, "1235", 0.0) for grid in bulk.on_edge(3)]
        self.assertEqual(self.deck(bulk).edges(), 4 * ["simple"])
        bulk.more[1] = ("SPC", 1, bulk.on_edge(3)[1], "1235", 1e-3)
        self.refused(bulk, "SPC: prescribed displacements are not supported")


class ImpactTest(ImportTest):
    """The groups of the impact."""

    def test_to_fill_in(self) -> None:
        """Without options they are comments."""
        deck = self.deck(Bulk())
        self.assertFalse(deck.has("impactor") or deck.has("time") or deck.has("static"))
        self.assertIn("\n! &impactor", (self.folder / "panel.nml").read_text())

    def test_given(self) -> None:
        """With mass, velocity and radius there is an impactor and a patch half as wide; with end and step a &time."""
        impact = ("--mass", "0.5", "--velocity", "2", "--radius", "8e-3")
        deck = self.deck(Bulk(), *impact)
        self.assertEqual([deck.number("impactor", key) for key in ("mass", "velocity", "radius")], [0.5, 2, 8e-3])
        self.assertEqual(deck.number("mesh", "patch"), 4e-3)
        self.assertFalse(deck.has("time"))
        deck = self.deck(Bulk(), *impact, "--end", "1e-3", "--step", "5e-6")
        self.assertEqual([deck.number("time", key) for key in ("end", "step")], [1e-3, 5e-6])

    def test_wrong_options(self) -> None:
        """One sentence and exit code 1."""
        for options in (("--mass", "0.5"), ("--mass", "-1", "--velocity", "2", "--radius", "1"), ("--end", "1"),
                        ("--struck", "middle")):
            with self.subTest(options):
                self.assertEqual(self.run_command(Bulk().text(), *options)[0], 1)


class ReportTest(ImportTest):
    """The report on the cards."""

    def test_cards_with_their_lines(self) -> None:
        """Cards that are read, read in part and ignored."""
        head = "SOL 101\nCEND\nSPC=1\nBEGIN BULK\nPARAM,POST,-1\n$ a comment\nPARAM,COUPMASS,1\nEIGRL,1,,,10\n"
        bulk = Bulk(head=head, more=[("PLOAD4", 1, number, 1e3) for number in range(1, 6)])
        bulk.laminate = [(*LAMINATE[0][:3], 0.5, *LAMINATE[0][4:])]
        bulk.materials = [(*MATERIALS[0][:9], 1e-6, 3e-5, 20.0, *MATERIALS[0][12:]), MATERIALS[1]]
        text = bulk.text() + "ENDDATA\nGRID,999,,0.,0.,0.\n"
        lines = text.splitlines()
        code, printed = self.run_command(text)
        self.assertEqual(code, 0, printed)

        def first(name: str) -> int:
            return next(number for number, line in enumerate(lines, 1) if line.startswith(name))

        self.assertIn("lines 1-4: executive and case control", printed)
        self.assertRegex(printed, rf"GRID     20, lines {first('GRID')}-{first('GRID') + 19}\n")
        for name, text in (("MAT8", "TREF is ignored, as it differs"), ("PCOMP", "NSM is distributed over the plies")):
            self.assertIn(f"{name}, line {first(name)}: {text}", printed)
        ignored = printed[printed.index("ignored:"):]
        self.assertRegex(ignored, r"PARAM    2, lines 5-7\n")
        self.assertRegex(ignored, r"EIGRL    1, line 8\n")
        self.assertRegex(ignored, rf"PLOAD4   5, lines {first('PLOAD4')}-{first('PLOAD4') + 4}\n")
        self.assertNotIn("GRID", ignored)

    def test_lines_apart(self) -> None:
        """Cards with others between them have separate line numbers."""
        bulk = Bulk(more=[("PLOAD4", 1, 1, 1e3), ("FORCE", 1, 5, 0, 1.0, 0.0, 0.0, 1.0), ("PLOAD4", 1, 2, 1e3)])
        last = len(bulk.text().splitlines())
        self.assertIn(f"PLOAD4   2, lines {last - 2}, {last}\n", self.run_command(bulk.text())[1])

    def test_what_counts_otherwise(self) -> None:
        """Remarks on offsets, a redundant modulus, a missing density and strengths given as strains."""
        laminate = (*LAMINATE[0][:2], 0.0, *LAMINATE[0][3:])
        materials = [(*MATERIALS[0][:6], None, *MATERIALS[0][7:8], None, *MATERIALS[0][9:], None, None, 1.0),
                     (*MATERIALS[1][:3], 26.2e9, *MATERIALS[1][4:])]
        bulk = Bulk(laminate=[laminate], materials=materials)
        code, printed = self.run_command(bulk.text())
        self.assertEqual(code, 0, printed)
        for text in ("Z0 is ignored", "G1Z is blank", "RHO is blank", "XT is ignored", "G is ignored"):
            self.assertIn(text, printed)
        carbon = plies_of(read_deck(self.folder / "panel.nml"))[0].material
        self.assertEqual((carbon.g13, carbon.strengths), (4.5e9, ()))

    def test_default_offset_is_not_reported(self) -> None:
        """Z0 of minus half the thickness is the default and causes no remark."""
        bulk = Bulk(laminate=[(*LAMINATE[0][:2], -0.5e-3, *LAMINATE[0][3:])])
        self.assertNotIn("Z0", self.run_command(bulk.text())[1])

    def test_name_that_is_no_text(self) -> None:
        """The comment of the deck has the name with question marks for bytes that are not text."""
        path = self.folder / os.fsdecode(b"pan\xe9l\n.bdf")
        path.write_text(Bulk().text())
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(from_nastran.main([str(path)]), 0)
        self.assertIn("! Panel of pan?l?.bdf.", path.with_suffix(".nml").read_text())

    def test_a_deck_is_not_replaced_unasked(self) -> None:
        """Only -o may replace an existing deck."""
        (self.folder / "panel.bdf").write_text(Bulk().text())
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            self.assertEqual(from_nastran.main([str(self.folder / "panel.bdf")]), 0)
            self.assertEqual(from_nastran.main([str(self.folder / "panel.bdf")]), 4)
            self.assertEqual(from_nastran.main([str(self.folder / "none.bdf")]), 4)


class WithoutPyNastranTest(unittest.TestCase):
    """The message without pyNastran."""

    def test_it_is_named(self) -> None:
        """One sentence, exit code 1."""
        with tempfile.TemporaryDirectory() as folder, mock.patch.dict(
                "sys.modules", {"pyNastran.bdf.bdf_interface.bdf_card": None, "pyNastran": None}):
            path = Path(folder) / "panel.bdf"
            path.write_text(Bulk().text())
            printed = io.StringIO()
            with contextlib.redirect_stderr(printed):
                self.assertEqual(from_nastran.main([str(path)]), 1)
        self.assertEqual(printed.getvalue().count("\n"), 1)
        self.assertIn("pip install 'implam-post[nastran]'", printed.getvalue())


class ShellTest(ImportTest):
    """A PSHELL of one material is a laminate of one ply."""

    METAL: ClassVar = [("MAT1", 2, 70e9, None, 0.33, 2700.0)]

    def test_one_ply(self) -> None:
        """Material, thickness and non-structural mass."""
        texts = []
        for laminate in (("PSHELL", 1, 2, 2e-3, 2, None, 2, None, 0.4),
                         ("PCOMP", 1, None, 0.4, None, None, None, None, None, 2, 2e-3, 0.0)):
            self.deck(Bulk(laminate=[laminate], materials=self.METAL))
            texts.append((self.folder / "panel.nml").read_text())
        self.assertEqual(*texts)
        self.assertIn("density=2900", texts[0])

    def test_refused(self) -> None:
        """Sections that are not a homogeneous plate."""
        for fields in ((2, 2e-3), (2, 2e-3, 2, 3.0, 2), (2, 2e-3, 3, None, 2), (2, None, 2, None, 2)):
            self.refused(Bulk(laminate=[("PSHELL", 1, *fields)], materials=self.METAL), "PSHELL")


class RefusedTest(ImportTest):
    """Errors of the file are one sentence and exit code 2."""

    def test_shapes(self) -> None:
        """Not rectangular, not flat, not along the axes, not connected, without elements or grids."""
        without = re.sub(r"CQUAD4 +12 .*\n", "", Bulk().text())
        code, printed = self.run_command(without)
        self.assertEqual((code, printed.count("\n")), (2, 1), printed)
        self.assertIn("do not form a rectangle", printed)
        self.refused(Bulk(place=lambda x, y: (x + 0.3 * y, y, 0.0), write=large), "do not form a rectangle")
        self.refused(Bulk(place=lambda x, y: (0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y, 0.0), write=large),
                     "its first side is at 36.8699 degrees")
        self.refused(Bulk(place=lambda x, y: (x, y, x * y), write=large), "its normal differs from that of the element")
        self.refused(Bulk(place=lambda x, y: (x, 0.8 * y, 0.6 * y), write=large), "is not parallel to a plane")
        self.assertIn("there is no CQUAD4", self.run_command(re.sub(r"CQUAD4.*\n", "", Bulk().text()))[1])
        printed = self.run_command(Bulk().text().replace("CQUAD4", "CQUADR"))[1]
        self.assertIn("CQUADR, lines", printed)
        self.assertIn("mesh the panel with CQUAD4 or CQUAD8 only", printed)
        self.assertIn("=(3): replicated cards", self.run_command("GRID,1\n=(3)\n")[1])
        self.assertIn("grid 3 does not exist", self.run_command(re.sub(r"GRID +3 .*\n", "", Bulk().text()))[1])
        bulk = Bulk(more=[("GRID", 99, None, 0.1, 0.1, 0.0)])
        cut = bulk.text().replace(small("CQUAD4", 11, 1, 41, 43, 61, 59)[0], small("CQUAD4", 11, 1, 99, 43, 61, 59)[0])
        code, printed = self.run_command(cut)
        self.assertEqual(code, 2, printed)
        self.assertIn("the grids 41 and 99 coincide", printed)

    def test_laminates(self) -> None:
        """Two properties, a missing one, options of the laminate that are not supported, missing materials."""
        other = ("PCOMP", 2, *LAMINATE[0][2:11], 30.0, *LAMINATE[0][12:])
        two = Bulk(laminate=[*LAMINATE, other]).text().replace(small("CQUAD4", 3, 1)[0], small("CQUAD4", 3, 2)[0])
        code, printed = self.run_command(two)
        self.assertEqual((code, printed.count("\n")), (2, 1), printed)
        self.assertIn("its lay-up differs from that of PCOMP 1", printed)
        same = two.replace("30.", "45.")
        self.assertEqual(self.run_command(same)[0], 0)
        weak = small("MAT8", 3, *MATERIALS[0][2:12], 1e9, *MATERIALS[0][13:])
        other = ("PCOMP", 2, *LAMINATE[0][2:9], 3, *LAMINATE[0][10:13], 3, *LAMINATE[0][14:])
        weaker = Bulk(laminate=[*LAMINATE, other]).text().replace(small("CQUAD4", 3, 1)[0], small("CQUAD4", 3, 2)[0])
        code, printed = self.run_command(weaker + "\n".join(weak))
        self.assertEqual(code, 2, printed)
        self.assertIn("its lay-up differs from that of PCOMP 1", printed)
        self.refused(Bulk(laminate=[]), "property 1")
        self.refused(Bulk(laminate=[(*LAMINATE[0][:8], "SMEAR", *LAMINATE[0][9:])]), "LAM = SMEAR")
        self.refused(Bulk(laminate=[*LAMINATE, *LAMINATE]), "number 1 is used")
        self.refused(Bulk(materials=MATERIALS[:1]), "there is no MAT1 or MAT8 with number 2")
        self.refused(Bulk(materials=[*MATERIALS, ("MAT1", 1, 70e9, None, 0.3)]), "number 1 is used by the MAT8")

    def test_materials(self) -> None:
        """Moduli that are missing, inconsistent or not positive definite."""
        metal = MATERIALS[1]
        for material, text in (((*metal[:3], 20e9, *metal[4:]), "contradicts E and NU"),
                               ((*metal[:4], None, *metal[5:]), "two of E, G and NU"),
                               (("MAT1", 2, 70e9, None, 0.6), "below 0.5")):
            self.refused(Bulk(materials=[MATERIALS[0], material]), text)
        carbon = MATERIALS[0]
        for material, text in (((*carbon[:7], None, *carbon[8:]), "G2Z is required"),
                               ((*carbon[:4], 4.0, *carbon[5:]), "NU12 squared"),
                               ((*carbon[:5], 0.0, *carbon[6:]), "greater than zero"),
                               ((*carbon[:2], "steel", *carbon[3:]), "E11")):
            self.refused(Bulk(materials=[material, metal]), text)

    def test_axes(self) -> None:
        """Material axes that differ, and missing coordinate systems."""
        turned = Bulk().text().replace(small("CQUAD4", 3, 1, 5, 7, 25, 23, None)[0],
                                       small("CQUAD4", 3, 1, 5, 7, 25, 23, 10.0)[0])
        code, printed = self.run_command(turned)
        self.assertEqual((code, printed.count("\n")), (2, 1), printed)
        self.assertIn("material axis is 10 degrees", printed)
        metal = turned.replace(small(*LAMINATE[0])[0], small("PSHELL", 1, 2, 1e-3, 2, None, 2)[0], 1)
        for line in small(*LAMINATE[0])[1:]:
            metal = metal.replace(line + "\n", "")
        self.assertEqual(self.run_command(metal)[0], 0)
        self.assertEqual([ply.angle for ply in plies_of(read_deck(self.folder / "panel.nml"))], [0])
        self.refused(Bulk(theta=3), "coordinate system 3")

    def test_supports(self) -> None:
        """Constraints on parts of edges or inside, and unsupported kinds of edges."""
        bulk = Bulk(edges=("1234", "1234", "1235", ""))
        bulk.more = [("SPC1", 1, "3", *bulk.on_edge(3)[:3])]
        self.refused(bulk, "on the edge y-max", "only entire edges can be supported")
        self.refused(Bulk(more=[("SPC1", 1, "3", 41)]), "it constrains grid 41, which is not on an edge")
        self.refused(Bulk(edges=("15", "1234", "24", "1235")), "line of symmetry")
        self.refused(Bulk(edges=("12", "34", "35", "35")), "x-min is constrained, but not its deflection")
        self.refused(Bulk(cells=(1, 1)), "no grid between its corners")
        self.refused(Bulk(more=[("SPC1", 1, "3", 1, "THRU")]), "SPC1: no grid follows THRU after 1")
        self.refused(Bulk(more=[("SPC1", 1, "3", 9, "THRU", 1)]), "SPC1: 9 THRU 1: the second number must")

    def test_corners(self) -> None:
        """Corners are compared with their edges; different rotations cause only a remark."""
        inner = Bulk().on_edge(0)[1:-1]
        bulk = Bulk(edges=("", "34", "35", "35"), more=[("SPC1", 1, "34", *inner)])
        code, printed = self.run_command(bulk.text())
        self.assertEqual(code, 0, printed)
        self.assertEqual(read_deck(self.folder / "panel.nml").edges(), 4 * ["simple"])
        self.assertIn("edge x-min and y-min: rotations of the corner grid 1 are free", printed)
        self.assertEqual(self.deck(Bulk(edges=4 * ("3",), more=[("SPC1", 1, "45", 1)])).edges(), 4 * ["simple"])
        self.refused(Bulk(edges=("3", "3", "", ""), more=[("SPC1", 1, "45", 1)]), "it constrains grid 1")
        self.refused(Bulk(edges=("", "34", "", ""), more=[("SPC1", 1, "34", *inner)]),
                     "the corner grid 1 is not constrained in component 3")

    def test_files(self) -> None:
        """Cards that change others, fields that cannot be read, grids that differ."""
        self.refused(Bulk(more=[("INCLUDE", "'more.bdf'")], write=free), "INCLUDE: it is not supported")
        self.refused(Bulk(more=2 * [("GRDSET", None, None, None, None, None, None, 6)]), "GRDSET: there is another one")
        self.refused(Bulk(more=[("GRID", 1, None, 5.0, 0.0, 0.0)]), "grid 1 differs from that in line 1")
        self.refused(Bulk(more=[("SPC1", 1, "7", 1)]), "SPC1")
        for text in ("nan", "1e400", "1.+400"):
            self.refused(Bulk(materials=[(*MATERIALS[0][:2], text, *MATERIALS[0][3:]), MATERIALS[1]]),
                         f"{text} is not a finite number")
        self.refused(Bulk(materials=[(*MATERIALS[0][:2], "139_000.", *MATERIALS[0][3:]), MATERIALS[1]]),
                     "field 2, '139_000.', is not a number")
        self.refused(Bulk(more=[("CQUAD4", 99, 1, 0, 1, 3, 21)]), "grid 0 does not exist")
        self.refused(Bulk(head="+,1,2\n"), "the continuation belongs to no card")
        self.refused(Bulk(more=[("GRID", 99, 4, 5.0, 0.0, 0.0)]), "coordinate system 4")
