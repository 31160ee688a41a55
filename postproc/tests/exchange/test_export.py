"""Tests of implam-to-nastran and implam-to-abaqus: damage, separate grids, cards, and re-import."""

import contextlib
import importlib.util
import io
import itertools
import re
import tempfile
import unittest
from collections import Counter
from pathlib import Path

import h5py
import numpy as np

from implam_post.exchange.abaqus import abaqus_input
from implam_post.exchange.degradation import CRACKING, CRUSHING, FIBRE, Degradation
from implam_post.exchange.export import to_abaqus, to_nastran
from implam_post.exchange.nastran import card, nastran_deck, real, same
from implam_post.exchange.panel import Panel, Stack
from implam_post.exchange.results import read_panel
from implam_post.exchange.shell_mesh import ShellMesh, shell_mesh
from implam_post.io.deck import read_deck
from implam_post.laminate.decks import plies_of
from implam_post.laminate.sections import Material, Ply, section_of
from tests.io.test_fields import write_fields

DECK = """
&case name='damaged' /
&plate length=12, 12 edges='clamped','clamped','simple','simple' symmetry='quarter' /
&mesh elements=3, 3 /
&material name='Carbon/A' density=1.58e-9 E1=139e3 E2=9.4e3 G12=4.5e3 G13=4.6e3 G23=2.98e3 nu12=0.309
          XT=1517 XC=1590 YT=46 YC=253 S12=105 Sf=500 Sm23=105 /
&material name='metal' density=2.7e-9 E=70e3 nu=0.33 XT=300 YT=300 YC=300 S12=200 Sf=200 Sm23=200 /
&laminate materials='carbon/a', 'metal', 'carbon/a' angles=45, 0, 90 thicknesses=0.1, 0.2, 0.3 /
&ply_damage d=100 e=2e-3 /
&delamination below_ply=2 G_c=1 zone=12,12 starter=2 /
&pressure value=0.25 /
&static /
"""
WITHOUT_PYNASTRAN = None if importlib.util.find_spec("pyNastran") else "pyNastran is not installed"


class ExportTest(unittest.TestCase):
    """Each test has results: a quarter of 3 x 3 cells with lines at 0, 1, 3 and 6.

    At the last time the cells along x are delaminated below ply 2, ply 3 has cracks in the first two of them and ply 1
    has failed in all modes in the cell at the corner of the plate.
    """

    def setUp(self) -> None:
        """Write results with their deck."""
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.results = self.folder / "damaged.h5"
        write_fields(self.results)
        self.keep_deck(DECK)

    def keep_deck(self, text: str) -> None:
        """Store a deck in the results and write it to their folder."""
        (self.folder / "damaged.nml").write_text(text)
        with h5py.File(self.results, "a") as file:
            if "provenance" in file:
                del file["provenance"]
            file["provenance/deck"] = np.bytes_(text)

    def panel(self, time: float | None = None) -> Panel:
        """Return the panel of the results."""
        return read_panel(self.results, time)

    def run_command(self, command: object, *arguments: object) -> tuple[int, str]:
        """Return exit code and text of a command."""
        text = io.StringIO()
        with contextlib.redirect_stdout(text), contextlib.redirect_stderr(text):
            code = command([str(argument) for argument in arguments])
        return code, text.getvalue()


class DegradationTest(unittest.TestCase):
    """Degraded constants by Table 2 of Li et al."""

    def test_modes(self) -> None:
        """Each mode divides its constants by d, several modes by d each, down to the lower limit."""
        material = Material(1, 1000.0, 100.0, 10.0, 20.0, 30.0, 0.3, strengths=(("XT", 1.0),))
        rule = Degradation(10.0, 0.02)
        for failures, expected in (
                (0, (1, 1, 1, 1, 1, 1)), (CRACKING, (1, 0.1, 0.1, 1, 1, 0.1)), (CRUSHING, (1, 0.1, 1, 1, 1, 0.1)),
                (FIBRE, (0.1, 0.1, 0.1, 0.1, 0.1, 0.1)), (CRACKING | CRUSHING, (1, 0.02, 0.1, 1, 1, 0.02)),
                (FIBRE | CRACKING, (0.1, 0.02, 0.02, 0.1, 0.1, 0.02)),
                (FIBRE | CRACKING | CRUSHING, (0.1, 0.02, 0.02, 0.1, 0.1, 0.02))):
            with self.subTest(failures):
                left = rule.degraded(material, failures)
                np.testing.assert_allclose([left.e1 / 1000, left.e2 / 100, left.g12 / 10, left.g13 / 20, left.g23 / 30,
                                            left.nu12 / 0.3], expected, rtol=1e-12)
                self.assertEqual(bool(left.strengths), not failures)


class PanelTest(ExportTest):
    """Panels read from results and decks."""

    def test_full_plate(self) -> None:
        """The quarter is mirrored: cells by their state at the last time and at the first."""
        panel = self.panel()
        np.testing.assert_array_equal(panel.x, [-6, -3, -1, 0, 1, 3, 6])
        states = Counter(panel.stacks.values())
        self.assertEqual(states, {
            (Stack(1, 3, (0, 0, 0)),): 20, (Stack(1, 3, (7, 0, 0)),): 4,
            (Stack(1, 2, (0, 0)), Stack(3, 3, (2,))): 8, (Stack(1, 2, (0, 0)), Stack(3, 3, (0,))): 4})
        for corner in ((0, 0), (5, 0), (0, 5), (5, 5)):
            self.assertEqual(panel.stacks[corner], (Stack(1, 3, (7, 0, 0)),))
        self.assertEqual(sum(len(stacks) > 1 for stacks in self.panel(0.5).stacks.values()), 4)

    def test_modelled_whole(self) -> None:
        """Results of a full plate are not mirrored."""
        write_fields(self.results, part="whole")
        self.keep_deck(DECK)
        self.assertEqual(self.panel().cells, (3, 3))
        write_fields(self.results, part="eighth")
        self.keep_deck(DECK)
        self.assertEqual(self.run_command(to_nastran, self.results)[0], 4)

    def test_sections(self) -> None:
        """One section for each kind of stack, at its z from the mid-plane of the laminate."""
        sections = {section.title: section for section in self.panel().sections()}
        self.assertEqual(list(sections), [
            "plies 1 to 3", "plies 1 to 3, 1 fibres and cracked and crushed", "plies 1 to 2", "plies 3 to 3, 3 cracked",
            "plies 3 to 3"])
        np.testing.assert_allclose([section.middle for section in sections.values()], [0, 0, -0.15, 0.15, 0.15],
                                   atol=1e-15)

    def test_deck(self) -> None:
        """Equal cells over the full plate, delaminated in the starter: here the cells that touch the struck point."""
        panel = read_panel(self.folder / "damaged.nml")
        np.testing.assert_allclose(panel.x, np.linspace(-6, 6, 7))
        self.assertEqual({cell for cell, stacks in panel.stacks.items() if len(stacks) > 1},
                         {(2, 2), (3, 2), (2, 3), (3, 3)})
        self.keep_deck(DECK.replace("starter=2", "starter=6.1"))
        panel = read_panel(self.folder / "damaged.nml")
        self.assertEqual(sum(len(stacks) > 1 for stacks in panel.stacks.values()), 16)
        self.assertEqual((panel.pressure, panel.in_plane, list(panel.edges)),
                         (0.25, "fixed", ["clamped", "clamped", "simple", "simple"]))

    def test_several_interfaces_of_a_deck(self) -> None:
        """Starters of different sizes have different stacks."""
        self.keep_deck(DECK + "&delamination below_ply=1 G_c=1 zone=12,12 starter=8 /")
        panel = read_panel(self.folder / "damaged.nml")
        self.assertEqual(Counter(tuple((stack.first, stack.last) for stack in stacks)
                                 for stacks in panel.stacks.values()),
                         {((1, 1), (2, 2), (3, 3)): 4, ((1, 1), (2, 3)): 12, ((1, 3),): 20})

    def apart(self, delamination: str, *changes: tuple[str, str]) -> Counter:
        """Return how many cells of a deck of 6 by 6 are delaminated below each ply."""
        deck = DECK.replace("&delamination below_ply=2 G_c=1 zone=12,12 starter=2 /", delamination)
        deck = deck.replace("symmetry='quarter'", "").replace("elements=3, 3", "elements=6, 6")
        for change in changes:
            deck = deck.replace(*change)
        self.keep_deck(deck)
        panel = read_panel(self.folder / "damaged.nml")
        return Counter(ply for cell in panel.stacks for ply in panel.delaminated(cell))

    def test_starters_by_law(self) -> None:
        """A front has a default starter, a cohesive interface only that of its key; strengths make it cohesive."""
        front, cohesive = {2: 4}, {}
        without = (" YT=46", ""), ("S12=105", "")
        for keys, changes, expected in (
                ("", (), cohesive), ("growth='equilibrium'", (), front), ("law='front'", (), front),
                ("law='cohesive'", (), cohesive), ("law='cohesive' starter=6.1", (), {2: 16}), ("", without, front),
                ("strength_opening=9 strength_shear=9", without, cohesive), ("strength_shear=9", without, front)):
            with self.subTest(keys, changes=changes):
                self.assertEqual(self.apart(f"&delamination below_ply=2 G_c=1 {keys} /", *changes), expected)

    def test_places_of_starters(self) -> None:
        """A circle, a centre away from the struck point, an eccentric impact, and a strip across the zone."""
        start = "&delamination below_ply=2 G_c=1 zone=10,8"
        struck = "&pressure", "&impactor mass=1 velocity=1 radius=1 at=4, 0 /\n&pressure"
        for keys, changes, expected in (
                ("starter=6", (), 4), ("starter=7 starter_shape='round'", (), 12), ("starter=4 starter_at=3,-3", (), 1),
                ("starter=6.1", (struck,), 12), ("starter_strip=-2.1, 4", (), 3 * 4)):
            with self.subTest(keys):
                self.assertEqual(self.apart(f"{start} {keys} /", *changes), {2: expected})

    def test_interfaces_by_word(self) -> None:
        """Interfaces are where the angle or the material changes."""
        delamination = "&delamination below_ply='all' G_c=1 zone=12,12 starter=2 /"
        angles = "angles=45, 0, 90", "angles=90, 90, -90"
        self.assertEqual(self.apart(delamination, angles), {1: 4, 2: 4})
        self.assertEqual(self.apart(delamination, angles, ("'metal', ", "'carbon/a', ")), {})

    def test_unwritten_groups(self) -> None:
        """Frames and lines of the deck are listed in notes, as they are not exported."""
        self.keep_deck(DECK + "&support window=10, 10 /\n&line at=0 displacement=0 /")
        code, text = self.run_command(to_nastran, self.results)
        self.assertEqual(code, 0, text)
        self.assertIn("note: &support is not written", text)
        self.assertIn("note: &line is not written", text)

    def test_refused(self) -> None:
        """Results without the state of a model of the deck, times out of range, and invalid decks are refused."""
        with h5py.File(self.results, "a") as file:
            for group in file["times"].values():
                del group["cells/ply_1_failure"]
        code, text = self.run_command(to_nastran, self.results)
        self.assertEqual((code, text.count("\n")), (4, 1), text)
        self.assertIn("run again with 'ply_damage' among the fields", text)
        self.assertEqual(self.run_command(to_nastran, self.folder / "none.nml")[0], 4)
        self.assertEqual(self.run_command(to_nastran, self.folder / "damaged.nml", "--time", "1")[0], 1)
        self.assertEqual(self.run_command(to_nastran, self.results, "--time", "7")[0], 1)
        for change, key in ((("'clamped','clamped'", "'clamped','glued'"), "edges"),
                            (("'clamped','clamped'", "'elastic','clamped'"), "cannot be exported"),
                            (("elements=3, 3", "elements=3"),
                            "elements"), (("below_ply=2", "below_ply=3"), "below_ply"), (("d=100", "d=0.5"), "d must")):
            self.keep_deck(DECK.replace(*change))
            code, text = self.run_command(to_abaqus, self.folder / "damaged.nml")
            self.assertEqual((code, text.count("\n")), (2, 1), text)
            self.assertIn(key, text)


class MeshTest(ExportTest):
    """Grids and elements."""

    def mesh(self, with_middles: bool = True) -> ShellMesh:
        """Return the mesh of the last time."""
        return shell_mesh(self.panel(), with_middles)

    def test_grids_separate_inside_only(self) -> None:
        """Two grids at each place with delaminated cells only; at the border of the delamination one for all plies."""
        mesh = self.mesh()
        places = Counter(map(tuple, mesh.coordinates))
        self.assertEqual(len(places), 13 * 13)
        apart = {place for place, count in places.items() if count == 2}
        self.assertEqual(apart, {(x, y, 0) for x, _, _ in places for y in (-0.5, 0, 0.5)})
        self.assertEqual(len(self.mesh(False).coordinates), len(mesh.coordinates) - 36 - 12)

    def test_elements(self) -> None:
        """Each layer covers its cells, counter-clockwise; elements at the struck face come first."""
        mesh = self.mesh()
        self.assertEqual((len(mesh.elements), mesh.struck), (48, 36))
        area = Counter()
        for place, element in enumerate(mesh.elements):
            self.assertEqual(element.stack.first == 1, place < mesh.struck)
            for corners in element.quarters:
                x, y, _ = mesh.coordinates[np.array(corners) - 1].T
                self.assertTrue(x[1] > x[0] and y[2] > y[1] and x[0] == x[3] and y[0] == y[1])
                area[element.stack.first] += (x[1] - x[0]) * (y[3] - y[0])
            eight = mesh.coordinates[np.array(element.eight) - 1]
            np.testing.assert_allclose(eight[4:], (eight[:4] + np.roll(eight[:4], -1, axis=0)) / 2)
        self.assertAlmostEqual(area[1], 144)
        self.assertAlmostEqual(area[3], 24)

    def test_layers_share_no_grid_inside(self) -> None:
        """The lower and the upper layer share grids only at the border of the delamination."""
        mesh = self.mesh()
        upper, lower = (Counter(grid for element in mesh.elements if (element.stack.first, element.stack.last) == plies
                                for row in element.grids for grid in row) for plies in ((1, 2), (3, 3)))
        shared = mesh.coordinates[np.array(sorted(set(upper) & set(lower))) - 1]
        self.assertEqual({abs(y) for _, y, _ in shared}, {1.0})

    def test_imperfection(self) -> None:
        """Grids have the initial deflection of the full plate, towards the back."""
        deck = DECK.replace("symmetry='quarter'", "symmetry='quarter' imperfection=0.5 half_waves=1, 3")
        self.keep_deck(deck)
        x, y, z = self.mesh().coordinates.T
        np.testing.assert_allclose(z, -0.5 * np.cos(np.pi * x / 12) * np.cos(np.pi * y / 4), atol=1e-9)
        self.assertIn("initial deflection in the coordinates of the nodes, amplitude 0.5",
                      self.run_command(to_abaqus, self.results)[1])
        nodes = (self.folder / "damaged_panel.inp").read_text().partition("*NODE")[2].splitlines()[1:]
        np.testing.assert_allclose([float(node.split(",")[3]) for node in nodes[:9]],
                                   self.mesh(False).coordinates[:9, 2])
        self.keep_deck(deck.replace("half_waves=1, 3", "half_waves=3"))
        self.assertEqual(self.run_command(to_nastran, self.results)[0], 2)

    def test_curvature(self) -> None:
        """Grids lie on the cylinder or paraboloid, the convex side struck, with an imperfection added."""
        deck = DECK.replace("symmetry='quarter'", "symmetry='quarter' curvature_radius=0, 20")
        self.keep_deck(deck)
        mesh = self.mesh()
        _, y, z = mesh.coordinates.T
        np.testing.assert_allclose(z, y**2 / 40, atol=1e-9)
        self.assertIn("curvature in the coordinates of the nodes, radii 0, 20",
                      self.run_command(to_abaqus, self.results)[1])
        self.keep_deck(deck.replace("radius=0, 20", "radius=-40, 20 imperfection=0.5"))
        x, y, z = self.mesh().coordinates.T
        np.testing.assert_allclose(z, -x**2 / 80 + y**2 / 40 + 0.5 * np.cos(np.pi * x / 12) * np.cos(np.pi * y / 12),
                                   atol=1e-9)
        self.keep_deck(deck.replace("radius=0, 20", "radius=20"))
        self.assertEqual(self.run_command(to_nastran, self.results)[0], 2)

    def test_supports(self) -> None:
        """Clamped and simple edges with all their grids, corners with both constraints; no rigid-body motion."""
        mesh = self.mesh()
        self.assertEqual({held: len(grids) for held, grids in mesh.supports.items()}, {
            "12345": 2 * (13 + 3), "1235": 2 * 11})
        self.keep_deck(DECK.replace("edges='clamped','clamped','simple','simple'", "edges='simple' in_plane='free'"))
        held = self.mesh().supports
        self.assertEqual({components: len(grids) for components, grids in held.items()}, {
            "12345": 1, "2345": 1, "345": 2, "35": 22, "34": 2 * (11 + 3)})


class NastranTest(ExportTest):
    """Cards and re-import."""

    def test_numbers(self) -> None:
        """Numbers have all digits, in large fields if necessary."""
        for number, eight, sixteen in ((139e9, "1.39+11", "139000000000.0"), (0.125e-3, "0.000125", "0.000125"),
                                       (1e-7, "1.-7", "1.-7"), (-1 / 3, "-3.333-1", "-3.33333333333-1"),
                                       (0.0, "0.0", "0.0"), (-45.0, "-45.0", "-45.0")):
            self.assertEqual((real(number, 8), real(number, 16)), (eight, sixteen))
        self.assertTrue(same(139e9, 8) and same(0.125e-3, 8) and not same(0.1333333e-3, 8) and same(0.1333333e-3, 16))
        self.assertEqual(list(card("GRID", 1, None, 0.1333333e-3, 0.0, 1.0)), [
            "GRID*   1                               0.0001333333    0.0", "*       1.0"])
        self.assertEqual(list(card("X", 0.1333333e-3)), ["X*      0.0001333333", "*"])
        self.assertEqual(list(card("SPC1", 1, 3, *range(1, 8), None)), [
            "SPC1    1       3       1       2       3       4       5       6", "+       7"])

    def test_cards(self) -> None:
        """One card per grid, element, section and material; stacks off the mid-plane have offsets."""
        lines = list(nastran_deck(self.panel(), "damaged.h5"))
        names = Counter(re.split(r"[ *]", line)[0] for line in lines)
        self.assertEqual([names[name] for name in ("GRID", "CQUAD4", "PCOMP", "MAT8", "MAT1", "PLOAD2", "ENDDATA")],
                         [169 + 39, 4 * 48, 5, 3, 1, 1, 1])
        self.assertEqual(sum(line.startswith("CQUAD4") and len(line) > 64 for line in lines), 4 * (12 + 12))
        self.assertIn("PLOAD2  1       0.25    1       THRU    144", lines)
        with_z0 = list(nastran_deck(self.panel(), "damaged.h5", with_z0=True))
        self.assertFalse(any(line.startswith("CQUAD4") and len(line) > 64 for line in with_z0))
        # Z0 of stacks off the mid-plane; the full laminate has the default of Nastran.
        places = [line[16:24].strip() for line in with_z0 if line.startswith("PCOMP")]
        self.assertEqual(places, ["", "", "-0.3", "0.0", "0.0"])

    def test_temperature(self) -> None:
        """A change of temperature, expansion and TREF; notes on what is not written."""
        cured = DECK.replace("nu=0.33", "nu=0.33 alpha1=23e-6 alpha2=23e-6").replace("nu12=0.309",
                                                                                   "nu12=0.309 alpha2=28e-6")
        self.keep_deck(cured + "&thermal delta_T=-145 /")
        lines = list(nastran_deck(self.panel(), "damaged.h5"))
        self.assertEqual(lines.index("TEMPERATURE(LOAD) = 2"), lines.index("LOAD = 1") + 1)
        self.assertEqual(lines[-2], "TEMPD   2       -145.0")
        for name, field in (("PCOMP", (48, 56)), ("MAT1", (48, 56))):
            found = {line[slice(*field)].strip() for line in lines if line.startswith(name)}
            self.assertEqual(found, {"0.0"} if name == "PCOMP" else {"2.3-5"})
        # A1 and A2 of the undamaged and a failed ply, both in small fields.
        texts = [after[8:24].split() for line, after in itertools.pairwise(lines) if line.startswith("MAT8 ")]
        self.assertEqual(texts, 2 * [["0.0", "2.8-5"]])
        self.assertIn("change of temperature: -145", self.run_command(to_nastran, self.results)[1])
        text = "\n".join(abaqus_input(self.panel(), "damaged.h5"))
        self.assertEqual(text.count("*EXPANSION, TYPE=ORTHO\n0, 2.8e-05, 2.8e-05"), 3)
        self.assertIn("*INITIAL CONDITIONS, TYPE=TEMPERATURE\nPANEL, 0.\n", text)
        self.assertIn("*TEMPERATURE\nPANEL, -145\n", text)
        self.keep_deck(cured)
        text = "\n".join(nastran_deck(self.panel(), ""))
        self.assertIn("2.8-5", text)
        self.assertNotIn("TEMP", text)
        self.keep_deck(DECK + "&thermal delta_T=-145 /")
        self.assertIn("note: the change of temperature is not written, as no material", self.run_command(
            to_abaqus, self.results)[1])

    def test_temperature_alone(self) -> None:
        """A deck whose only load is the cooling has a step in Abaqus and no PLOAD2."""
        self.keep_deck(DECK.replace("&pressure value=0.25 /", "&thermal delta_T=-80 /").replace(
            "nu12=0.309", "nu12=0.309 alpha1=1e-6"))
        text = "\n".join(abaqus_input(self.panel(), ""))
        self.assertIn("*STATIC\n*TEMPERATURE\nPANEL, -80\n", text)
        self.assertNotIn("DLOAD", text)
        self.assertNotIn("LOAD = 1", "\n".join(nastran_deck(self.panel(), "")))

    def test_notes(self) -> None:
        """What a deck has beyond the export is reported, and at the top of the file."""
        deck = DECK.replace("thicknesses", "shear_correction='energy' thicknesses").replace(
            "value=0.25", "value=0.25 distribution='sine'")
        self.keep_deck(deck + "&initial_state from='x_restart.h5' /")
        for source, notes in ((self.folder / "damaged.nml", 3), (self.results, 2)):
            code, text = self.run_command(to_nastran, source)
            self.assertEqual((code, text.count("note: ")), (0, notes), text)
            self.assertIn("the pressure is not written, as its distribution is a sine", text)
            self.assertIn("the shear correction of &laminate is not written", text)
            written = (self.folder / "damaged_panel.bdf").read_text().split("SOL 101")[0]
            self.assertEqual(written.count("is not written"), notes)

    def test_shear_correction(self) -> None:
        """The one by energy is reported in capitals, too, and as the default of plies of unequal shear moduli."""
        for change in (("thicknesses", "shear_correction='ENERGY' thicknesses"), ("E=70e3", "E=70")):
            text = DECK.replace(*change)
            self.keep_deck(text)
            self.assertIn("the shear correction of &laminate is not written", self.run_command(
                to_nastran, self.folder / "damaged.nml")[1])

    def test_without_a_pressure(self) -> None:
        """No load unless it is requested."""
        self.keep_deck(DECK.replace("&pressure value=0.25 /", ""))
        self.assertFalse([line for line in nastran_deck(self.panel(), "") if "LOAD" in line])
        self.assertEqual(self.run_command(to_nastran, self.results, "--pressure", "3.5")[0], 0)
        self.assertIn("PLOAD2  1       3.5 ", (self.folder / "damaged_panel.bdf").read_text())

    @unittest.skipIf(WITHOUT_PYNASTRAN, WITHOUT_PYNASTRAN)
    def test_stiffness_that_pynastran_reads(self) -> None:
        """A, B and D of each element about its grids are those of its degraded plies at their z."""
        from pyNastran.bdf.bdf import read_bdf
        panel = self.panel()
        for with_z0 in (False, True):
            path = self.folder / "back.bdf"
            path.write_text("\n".join(nastran_deck(panel, "", with_z0)))
            model = read_bdf(str(path), debug=None)
            mesh = shell_mesh(panel, with_middles=True)
            self.assertEqual(len(model.elements), 4 * len(mesh.elements))
            for number, element in enumerate(mesh.elements):
                found = model.elements[4 * number + 1]
                self.assertEqual(list(found.node_ids), element.quarters[0])
                expected = _section(panel, element.stack)
                a, b, d = _about_grids(found.pid_ref.get_ABD_matrices(), found.zoffset)
                for read, own in ((a, expected.a), (b, expected.b), (d, expected.d)):
                    np.testing.assert_allclose(read, own, atol=1e-9 * np.max(np.abs(expected.a)))

    @unittest.skipIf(WITHOUT_PYNASTRAN, WITHOUT_PYNASTRAN)
    def test_round_trip(self) -> None:
        """Export and re-import keeps plies, materials, sides and supports."""
        from implam_post.exchange import from_nastran
        from tests.bulk import MATERIALS, Bulk, large
        laminate = ("PCOMP", 1, *7 * (None,), 1, 0.1333333e-3, 22.5, None, 2, 0.2e-3, -67.25, None, 1, 0.127e-3, 90.0)
        bulk = Bulk(cells=(12, 8), lengths=(0.3, 0.2), write=large, laminate=[laminate],
                    edges=("12345", "1234", "1235", ""), more=[("TEMPD", 3, 20.0)],
                    materials=[(*MATERIALS[0][:9], -1e-7, 28e-6, 170.0, *MATERIALS[0][12:]),
                               (*MATERIALS[1], 23e-6, 170.0)])
        first, deck, last = (self.folder / name for name in ("first.bdf", "panel.nml", "last.bdf"))
        first.write_text(bulk.text())
        self.assertEqual(self.run_command(from_nastran.main, first, "-o", deck)[0], 0)
        self.assertEqual(self.run_command(to_nastran, deck, "-o", last)[0], 0)
        one, other = (_read_back(path) for path in (first, last))
        self.assertEqual(one, other)
        again = self.folder / "again.nml"
        self.assertEqual(self.run_command(from_nastran.main, last, "-o", again)[0], 0)
        (before, after) = (read_deck(path) for path in (deck, again))
        for deck in (before, after):
            self.assertEqual([ply.material.expansion for ply in plies_of(deck)],
                             [(-1e-7, 28e-6), (23e-6, 23e-6), (-1e-7, 28e-6)])
        self.assertEqual((before.lengths(), before.edges(), plies_of(before), before.number("thermal", "delta_T")),
                         (after.lengths(), after.edges(), plies_of(after), after.number("thermal", "delta_T")))


def _section(panel: Panel, stack: Stack) -> object:
    """Return A, B and D of a stack about the mid-plane of the laminate, from the constants of the deck."""
    z = np.concatenate([[0.0], np.cumsum([ply.thickness for ply in panel.plies])])
    plies = [Ply(panel.degradation.degraded(ply.material, failed), ply.angle, ply.thickness)
             for ply, failed in zip(panel.plies[stack.first - 1:stack.last], stack.failures, strict=True)]
    own = section_of(plies)
    middle = (z[stack.first - 1] + z[stack.last] - z[-1]) / 2
    return type(own)(own.a, own.b + middle * own.a, own.d + 2 * middle * own.b + middle**2 * own.a, own.s, own.mass,
                     own.thickness)


def _about_grids(abd: np.ndarray, offset: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return A, B and D about the grids of an element with an offset."""
    a, b, d = abd[:3, :3], abd[:3, 3:], abd[3:, 3:]
    return a, b + offset * a, d + 2 * offset * b + offset**2 * a


def _read_back(path: Path) -> object:
    """Return lay-up, materials and sides as read by pyNastran."""
    from pyNastran.bdf.bdf import read_bdf
    model = read_bdf(str(path), debug=None, punch=path.name == "first.bdf")
    laminate, = model.properties.values()
    places = np.array([grid.get_position() for grid in model.nodes.values()])
    materials = [(kind.type, *(getattr(kind, name) for name in (
        ("e11", "e22", "nu12", "g12", "g1z", "g2z", "rho", "Xt", "Xc", "Yt", "Yc", "S") if kind.type == "MAT8" else
        ("e", "nu", "rho")))) for kind in (model.materials[mid] for mid in laminate.material_ids)]
    return (list(laminate.thicknesses), list(laminate.thetas), materials,
            [float(f"{side:.12g}") for side in np.ptp(places, axis=0)])


class AbaqusTest(ExportTest):
    """Keywords of the input."""

    def test_input(self) -> None:
        """Nodes without cell centres, S8R in sets by section, offsets over thickness, supports, pressure."""
        lines = list(abaqus_input(self.panel(), "damaged.h5"))
        text = "\n".join(lines)
        start, end = (lines.index(word) for word in ("*NODE, NSET=PANEL", "*ELEMENT, TYPE=S8R, ELSET=ALL_SHELLS"))
        self.assertEqual(end - start - 1, 169 + 39 - 48)
        self.assertEqual(re.findall(r"COMPOSITE(?:, OFFSET=(.*))?", text), ["", "", "0.5", "-0.5", "-0.5"])
        self.assertEqual(sum(len(re.findall(r"\d+", block)) for block in
                             re.findall(r"ELSET=SECTION_\d\n((?:[\d, ]+\n)+)", text)), 48)
        self.assertIn("*MATERIAL, NAME=M1_CARBON_A\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n"
                      "139000, 9400, 9400, 0.309, 0, 0, 4500, 4600\n2980\n*DENSITY\n1.58e-09\n", text)
        self.assertIn("139000, 94, 94, 0.00309, 0, 0, 45, 4600\n2980\n", text)
        self.assertIn("COMPOSITE\n0.1, 3, M1_CARBON_A, AT_45\n0.2, 3, M2_METAL, AT_0\n0.3, 3, M1_CARBON_A, AT_90\n",
                      text)
        self.assertIn("*ORIENTATION, NAME=AT_90\n0, 1, 0, -1, 0, 0\n3, 0.", text)
        self.assertIn("1, 36, 1\n*STEP\n*STATIC\n*DLOAD\nSTRUCK, P, 0.25", text)
        self.assertTrue(all(len(line) <= 255 for line in lines))

    def test_orientations(self) -> None:
        """Each layer has an orientation that exists, also for an angle of -0."""
        self.keep_deck(DECK.replace("angles=45, 0, 90", "angles=0, -0, 90"))
        text = "\n".join(abaqus_input(self.panel(), ""))
        defined, used = (set(re.findall(pattern, text)) for pattern in (r"\*ORIENTATION, NAME=(\w+)", r", (AT_\w+)"))
        self.assertEqual(defined, {"AT_0", "AT_90"})
        self.assertEqual(used, defined)

    def test_command(self) -> None:
        """It prints a summary of the panel."""
        code, text = self.run_command(to_abaqus, self.results)
        self.assertEqual(code, 0, text)
        self.assertIn("36 cells, of which 12 are delaminated and 12 have failed plies; 5 sections, 4 materials", text)
        self.assertTrue((self.folder / "damaged_panel.inp").exists())
