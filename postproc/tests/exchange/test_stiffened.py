"""Tests of stiffened, stepped and curved panels: properties into zones, beams into stringers, cylinders into radii."""

import math
import re
import unittest
from collections.abc import Sequence

import numpy as np

from implam_post.exchange.bulk_profiles import _SHAPES
from implam_post.exchange.export import to_abaqus, to_nastran
from implam_post.exchange.results import read_panel, split
from implam_post.exchange.shell_mesh import shell_mesh
from implam_post.exchange.webs import webs_of
from implam_post.io.deck import Deck, read_deck
from implam_post.laminate.decks import plies_of
from implam_post.laminate.zones import LayUp, with_lines, zones_of
from tests.bulk import Bulk, free
from tests.exchange.test_export import ExportTest
from tests.exchange.test_from_nastran import WITHOUT, ImportTest

RADIUS = 0.5
PLY = 0.125e-3
SKIN = ("PCOMP", 1, *7 * (None,), 1, PLY, 45.0, None, 1, PLY, 0.0, None, 1, PLY, 90.0)
METAL = ("MAT1", 9, 70e9, 27e9, None, 2700.0)


def arc(x: float, y: float) -> tuple[float, float, float]:
    """Return a point of a cylinder along x whose convex side is struck; y is the arc length."""
    angle = (y - 0.075) / RADIUS
    return x, RADIUS * math.sin(angle), RADIUS * (1 - math.cos(angle))


def stack(number: int, *angles: float, offset: float | None = None) -> tuple[object, ...]:
    """Return a PCOMP of plies of material 1."""
    return ("PCOMP", number, offset, *6 * (None,), *(field for angle in angles for field in (1, PLY, angle, None)))


class CurvedTest(ImportTest):
    """Grids on a cylinder."""

    def curved(self, bulk: Bulk, *options: str) -> Deck:
        """Return the deck of a panel, which has the sides of the flat one."""
        deck = self.deck(bulk, *options)
        np.testing.assert_allclose(deck.lengths(), (0.2, 0.15), rtol=1e-8)
        return deck

    def test_radius(self) -> None:
        """The radius is positive where the convex side is struck; the lengths are those of the arc."""
        for place, options, radii in (
                (arc, (), (0, RADIUS)), (arc, ("--struck", "last"), (0, -RADIUS)),
                (lambda x, y: (x, arc(x, y)[1], -arc(x, y)[2]), (), (0, -RADIUS))):
            deck = self.curved(Bulk(place=place, write=free, theta=30.0), *options)
            np.testing.assert_allclose(deck.numbers("plate", "curvature_radius"), radii, rtol=1e-6)
            self.assertEqual(deck.edges(), 4 * ["simple"])
            self.assertEqual(deck.value("plate", "in_plane"), "fixed")
            sign = -1 if options else 1
            self.assertAlmostEqual(plies_of(deck)[0].angle, sign * 75.0)

    def test_along_other_axes(self) -> None:
        """A cylinder along z, and one whose middle is not at a basic axis."""
        deck = self.deck(Bulk(place=lambda x, y: (arc(x, y)[1], 0.3 + arc(x, y)[2], x), write=free))
        np.testing.assert_allclose(deck.lengths(), (0.15, 0.2), rtol=1e-8)
        np.testing.assert_allclose(np.abs(deck.numbers("plate", "curvature_radius")), (RADIUS, 0), rtol=1e-6)
        middle = 0.4
        deck = self.curved(Bulk(edges=4 * ("12345",), write=free, place=lambda x, y: (
            x, RADIUS * math.sin(y / RADIUS + middle), -RADIUS * math.cos(y / RADIUS + middle))))
        np.testing.assert_allclose(deck.numbers("plate", "curvature_radius"), (0, RADIUS), rtol=1e-6)
        self.assertIn("x, (0, ", (self.folder / "panel.nml").read_text().splitlines()[1])

    def test_cylindrical_systems(self) -> None:
        """Grids and their displacements in a CORD2C: its components are normal, circumferential and axial."""
        system = ("CORD2C", 7, None, 0.0, 0.0, RADIUS, 1.0, 0.0, RADIUS, 0.0, 0.0, -1.0)
        bulk = Bulk(edges=("1", "1", "123", "123"), write=free, more=[system],
                    place=lambda x, y: (RADIUS, math.degrees((y - 0.075) / RADIUS) + 20, x))
        text = re.sub(r"^(GRID,\d+),,([^\n]*)", r"\1,7,\2,7", bulk.text(), flags=re.MULTILINE)
        code, printed = self.run_command(text, "--struck", "last")
        self.assertEqual(code, 0, printed)
        deck = read_deck(self.folder / "panel.nml")
        np.testing.assert_allclose(deck.lengths(), (0.2, 0.15), rtol=1e-6)
        self.assertAlmostEqual(abs(deck.numbers("plate", "curvature_radius")[1]), RADIUS, 6)
        self.assertEqual(deck.edges(), 4 * ["simple"])
        # Radial, circumferential and axial: straight edges are held in all, the others in their normal only.
        self.assertEqual(sorted({(group["direction"][0], group["component"][0]) for group in deck.groups["line"]}),
                         [("x", "u"), ("x", "v")])
        self.assertIn("its lengths are those of the arc", printed)

    def test_paraboloid(self) -> None:
        """Grids of an exported panel: positions in its plane, also with two radii."""
        def place(x: float, y: float) -> tuple[float, float, float]:
            return x, y, ((x - 0.1)**2 / 0.8 - (y - 0.075)**2) / 2
        deck = self.curved(Bulk(place=place, write=free))
        np.testing.assert_allclose(deck.numbers("plate", "curvature_radius"), (0.8, -1), rtol=1e-6)

    def test_refused(self) -> None:
        """Other surfaces, and too much of a cylinder."""
        self.refused(Bulk(place=lambda x, y: (x, y, 0.003 * math.cos(40 * x)), write=free), "CQUAD4",
                     "neither in a plane nor on a cylinder along a basic axis")
        self.refused(Bulk(place=lambda x, y: (x, 0.1 * math.sin(y / 0.1), 0.1 * math.cos(y / 0.1)), write=free),
                     "cover 85.94 degrees of a cylinder")
        web = Bulk(write=free, more=[("GRID", 900, None, 0.0, 0.0, 0.02), ("GRID", 901, None, 0.2, 0.0, 0.02),
                                     ("CQUAD4", 99, 1, 1, 9, 901, 900)])
        self.refused(web, "webs as CBAR or CBEAM")


class ZonesTest(ImportTest):
    """Properties of elements."""

    def zones(self, laminate: Sequence[tuple[object, ...]], bulk: Bulk | None = None, *options: str) -> Deck:
        """Return the deck of a panel of 4 by 3 elements, two of which have property 2."""
        bulk = bulk or Bulk(write=free, theta=0.0)
        bulk.laminate, bulk.property_of = list(laminate), lambda i, j: 2 if i in (1, 2) and j == 1 else 1
        return self.deck(bulk, *options)

    def test_doublers(self) -> None:
        """Plies on either face by Z0 or ZOFFS; the skin is at the grids."""
        for offset, options, face in ((-1.5 * PLY, (), "back"), (-3.5 * PLY, (), "front"),
                                      (-1.5 * PLY, ("--struck", "last"), "front")):
            angles = (45.0, 0.0, 90.0, 30.0, 60.0) if offset > -3 * PLY else (30.0, 60.0, 45.0, 0.0, 90.0)
            deck = self.zones([SKIN, stack(2, *angles, offset=offset)], None, *options)
            zones = zones_of(deck, plies_of(deck))
            self.assertEqual(len(plies_of(deck)), 3)
            doubler, = zones.doublers
            self.assertEqual((doubler.face, len(zones.drops)), (face, 0))
            np.testing.assert_allclose(doubler.area.size, (0.1, 0.05), rtol=1e-6)
            np.testing.assert_allclose(doubler.area.at, (0, 0), atol=1e-9)
            self.assertEqual([ply.angle for ply in doubler.plies], [-60, -30] if options else [30, 60])

    def test_without_offsets(self) -> None:
        """All mid-planes at the grids: plies are added at the back, which the report says."""
        self.zones([SKIN, stack(2, 45.0, 0.0, 90.0, 30.0)])
        _, printed = self.run_command((self.folder / "panel.bdf").read_text())
        self.assertRegex(printed, "PCOMP, line [0-9]+: its plies are moved by 6.25e-05 along the normal")

    def test_ply_drops(self) -> None:
        """Missing plies with either face flat."""
        for offset, flat_face in ((-1.5 * PLY, "front"), (-0.5 * PLY, "back")):
            deck = self.zones([SKIN, stack(2, 45.0, 90.0, offset=offset)])
            drop, = zones_of(deck, plies_of(deck)).drops
            self.assertEqual((drop.missing, drop.flat_face), ((2,), flat_face))

    def test_rectangles(self) -> None:
        """An L becomes two rectangles that do not overlap."""
        bulk = Bulk(write=free, theta=0.0, laminate=[SKIN, stack(2, 45.0, 0.0, 90.0, 0.0, offset=-1.5 * PLY)],
                    property_of=lambda i, j: 2 if (i, j) in ((0, 0), (1, 0), (1, 1)) else 1)
        deck = self.deck(bulk)
        zones = zones_of(deck, plies_of(deck))
        self.assertEqual(len(zones.doublers), 2)
        self.assertAlmostEqual(sum(math.prod(doubler.area.size) for doubler in zones.doublers), 3 * 0.05**2)
        for i in range(4):
            for j in range(3):
                plies = zones.at(0.05 * (i - 1.5), 0.05 * (j - 1)).numbers
                self.assertEqual(len(plies), 4 if bulk.property_of(i, j) == 2 else 3)

    def test_refused(self) -> None:
        """Plies of several thicknesses, and skew elements."""
        thick = (*stack(2, 45.0, 0.0, 90.0, 30.0, offset=-1.5 * PLY), 1, 2 * PLY, 0.0)
        bulk = Bulk(write=free, theta=0.0, laminate=[SKIN, thick], property_of=lambda i, j: 1 + (i == 1))
        self.refused(bulk, "PCOMP", "differ in thickness, where those of a doubler have one")
        skew = Bulk(write=free, theta=0.0, laminate=[SKIN, stack(2, 45.0, 0.0, 90.0, 30.0)],
                    property_of=bulk.property_of, place=lambda x, y: (x + 0.3 * x * (0.2 - x) * y, y, 0.0))
        self.refused(skew, "CQUAD4", "must be rectangles along the edges")


class BeamsTest(ImportTest):
    """Beams on lines of the panel."""

    def beams(self, *cards: tuple[object, ...], offset: float | None = 0.0101875, kind: str = "CBAR",
              place: object = None, vector: tuple[float, float, float] = (0.0, 0.0, 1.0)) -> str:
        """Return the report on a panel with two elements of property 5 along x at its middle grids."""
        bulk = Bulk(cells=(4, 4), write=free, laminate=[SKIN], theta=0.0, **({"place": place} if place else {}))
        elements = [(kind, 100 + i, 5, bulk.number(2 * i, 4), bulk.number(2 * i + 2, 4), *vector, None, None, None,
                     *2 * (None if offset is None else 0.0, None if offset is None else 0.0, offset)) for i in (0, 1)]
        bulk.more = [*elements, METAL, *cards]
        code, printed = self.run_command(bulk.text())
        self.assertEqual(code, 0, printed)
        self.read = read_deck(self.folder / "panel.nml")
        return printed

    def stringer(self) -> dict[str, object]:
        """Return the values of the only stringer."""
        group, = self.read.groups["stringer"]
        return {key: values[0] for key, values in group.items()}

    def test_blade(self) -> None:
        """A rectangle whose foot is on the face."""
        report = self.beams(("PBARL", 5, 9, None, "BAR", None, None, None, None, 0.002, 0.02))
        self.assertEqual(self.stringer(), {
            "name": "stringer_1", "along": "x", "at": 0, "from": -0.1, "to": 0, "face": "back", "section": "blade",
            "height": 0.02, "thickness": 0.002, "e": 70e9, "g": 27e9, "density": 2700})
        self.assertRegex(report, "  CBAR     2, lines")
        self.assertNotIn("not in the deck", report)

    def test_plane_two(self) -> None:
        """The same rectangle turned by its orientation vector, on the other face."""
        self.beams(("PBARL", 5, 9, None, "BAR", None, None, None, None, 0.02, 0.002), vector=(0.0, 1.0, 0.0),
                   offset=-0.0101875)
        found = self.stringer()
        self.assertEqual([found[key] for key in ("face", "section", "height", "thickness")],
                         ["front", "blade", 0.02, 0.002])

    def test_given(self) -> None:
        """PBAR and PBEAM, with the centroid of the latter at N1; the skin's half thickness is not in the eccentricity.
        """
        half = 1.5 * PLY
        for kind, card in (("CBAR", ("PBAR", 5, 9, 4e-5, 1e-9, 2e-10, 3e-11, 0.5, None, *8 * (None,), 0.6, 0.6)),
                           ("CBEAM", ("PBEAM", 5, 9, 4e-5, 1e-9, 2e-10, None, 3e-11, 0.5, *8 * (None,),
                                      0.6, 0.6, *6 * (None,), *4 * (None,), 2e-3, 0.0, 2e-3, 0.0))):
            with self.subTest(kind):
                self.beams(card, kind=kind)
                found = self.stringer()
                shift = 2e-3 if kind == "CBEAM" else 0
                self.assertEqual(found["section"], "given")
                for key, value in (("ea", 2.8e6), ("ei", 70), ("ei_lateral", 14), ("gj", 0.81), ("e", 70e9),
                                   ("g", 27e9 * 0.6 * 1.2), ("mass_per_length", 2700 * 4e-5 + 0.5),
                                   ("eccentricity", 0.0101875 - half + shift)):
                    self.assertAlmostEqual(found[key], value, delta=1e-8 * value)

    def test_t(self) -> None:
        """A T with its cap outwards, as a CBEAM whose axis is the shear centre, is a T; turned it is given."""
        dimensions = 0.016, 0.021, 0.001, 0.002
        foot = 0.0205 + 1.5 * PLY
        self.beams(("PBEAML", 5, 9, None, "T", None, None, None, None, *dimensions), kind="CBEAM", offset=foot)
        found = self.stringer()
        self.assertEqual([found[key] for key in ("section", "height", "thickness", "cap_width", "cap_thickness")],
                         ["T", 0.02, 0.002, 0.016, 0.001])
        self.beams(("PBEAML", 5, 9, None, "T2", None, None, None, None, *dimensions), kind="CBEAM", offset=0.0006875)
        found = self.stringer()
        area = 0.016 * 0.001 + 0.02 * 0.002
        self.assertEqual(found["section"], "given")
        self.assertAlmostEqual(found["eccentricity"], 0.0005 + 0.04e-3 * 0.0105 / area, 6)

    def test_sections(self) -> None:
        """Areas and second moments of the types are those of their outlines, cut into strips."""
        outlines = {
            "BAR": ((3.0, 8.0), lambda y: 3.0, 0.0, 8.0),
            "T": ((10.0, 20.0, 2.0, 1.5), lambda y: 10.0 if y > 18 else 1.5, 0.0, 20.0),
            "T2": ((10.0, 20.0, 2.0, 1.5), lambda y: 10.0 if y < 2 else 1.5, 0.0, 20.0),
            "I": ((20.0, 8.0, 12.0, 1.5, 2.0, 3.0), lambda y: 8.0 if y < 2 else 12.0 if y > 17 else 1.5, 0.0, 20.0),
            "I1": ((8.0, 1.5, 16.0, 20.0), lambda y: 9.5 if y < 2 or y > 18 else 1.5, 0.0, 20.0),
            "BOX": ((10.0, 20.0, 2.0, 1.5), lambda y: 10.0 if y < 2 or y > 18 else 3.0, 0.0, 20.0),
            "ROD": ((4.0,), lambda y: 2 * math.sqrt(max(16 - y * y, 0)), -4.0, 4.0),
            "TUBE": ((4.0, 3.0), lambda y: 2 * (math.sqrt(max(16 - y * y, 0)) - math.sqrt(max(9 - y * y, 0))), -4.0,
                     4.0)}
        self.assertEqual(set(outlines), set(_SHAPES))
        for kind, (sizes, width, low, high) in outlines.items():
            with self.subTest(kind):
                y = low + (np.arange(200000) + 0.5) * (high - low) / 200000
                strips = np.array([width(each) for each in y]) * (high - low) / 200000
                area = strips.sum()
                moment = (strips * (y - (strips @ y) / area)**2).sum()
                found = _SHAPES[kind](*sizes)
                np.testing.assert_allclose((found["area"], found["moments"][0]), (area, moment), rtol=1e-4)

    def test_on_a_cylinder(self) -> None:
        """Offsets along the normal of the surface and along that of its middle."""
        self.beams(("PBARL", 5, 9, None, "BAR", None, None, None, None, 0.002, 0.02), place=arc)
        self.assertEqual(self.stringer()["section"], "blade")

    def test_no_stringer(self) -> None:
        """One sentence for each beam that a deck cannot have; the others are read."""
        bar = ("PBARL", 5, 9, None, "BAR", None, None, None, None, 0.002, 0.02)
        for more, keys, words in (
                ((), {}, "there is no PBAR or PBARL with number 5"),
                ((bar,), {"offset": None}, "its centroid lies within the panel"),
                ((bar,), {"vector": (0.0, 1.0, 1.0)}, "its planes are not normal to the panel"),
                ((("PBARL", 5, 9, None, "HAT", None, None, None, None, 0.02, 0.001, 0.02, 0.01),), {},
                 "TYPE HAT is not read"),
                ((("PBAR", 5, 8, 4e-5, 1e-9, 2e-10, 3e-11),), {}, "has no MAT1 with number 8"),
                ((("PBAR", 5, 9, 4e-5, 1e-9, 2e-10, None),), {}, "its I normal to the panel and its J must be"),
                ((("PBEAM", 5, 9, 4e-5, 1e-9, 2e-10, None, 3e-11, None, *8 * (None,), "YES", 1.0, 2e-5, 1e-9, 2e-10,
                   None, 3e-11, None),), {"kind": "CBEAM"}, "its section is tapered")):
            with self.subTest(words):
                report = self.beams(*more, **keys)
                self.assertRegex(report, f"{keys.get('kind', 'CBAR')}, lines [0-9-]+: it is no stringer of the deck: "
                                         f"[^\n]*{words}")
                self.assertFalse(self.read.has("stringer"))
        bulk = Bulk(cells=(4, 4), write=free, laminate=[SKIN], theta=0.0)
        for ends, more, words in (((bulk.number(0, 0), bulk.number(2, 2)), {}, "not parallel to an edge"),
                                  ((bulk.number(0, 4), bulk.number(2, 4)), {"pins": 4}, "hinges"),
                                  ((bulk.number(0, 4), bulk.number(2, 4)), {"offt": "GGO"}, "OFFT GGO is not read"),
                                  ((bulk.number(0, 4), bulk.number(2, 4)), {"side": 0.01}, "offset is not normal")):
            bulk.more = [METAL, bar, ("CBAR", 100, 5, *ends, 0.0, 0.0, 1.0, more.get("offt"), more.get("pins"), None,
                                      *2 * (0.0, more.get("side", 0.0), 0.0101875))]
            code, printed = self.run_command(bulk.text())
            self.assertEqual(code, 0, printed)
            self.assertRegex(printed, f"CBAR, line [0-9]+: it is no stringer of the deck: [^\n]*{words}")


STIFFENED = """
&case name='stiffened' /
&plate length=240, 160 edges='clamped' in_plane='{in_plane}' curvature_radius=0, 800 /
&mesh elements=6, 4 /
&material name='ply' density=1.6e-9 E1=139e3 E2=9.4e3 G12=4.5e3 G13=4.6e3 G23=2.98e3 nu12=0.309 /
&laminate materials='ply' stacking='[45/-45/0/90]s' ply_thickness=0.2 /
&doubler name='pad' face='back' at=-60,40 size=60,30 materials='ply' stacking='[0/30]' ply_thickness=0.25 /
&ply_drop plies=4,5 at=0,-60 size=240,40 flat_face='back' /
&stringer name='blade' along='x' at=37 height=20 thickness=2 E=53e3 G=20e3 density=1.6e-9 /
&stringer name='tee' along='y' at=60 from=-80 to=20 face='front' section='T' height=20 thickness=2 cap_width=12
          cap_thickness=1.5 E=53e3 G=20e3 density=1.6e-9 /
&stringer name='any' along='x' at=0 section='given' EA=2e6 EI=5e7 GJ=1e6 mass_per_length=6e-8 eccentricity=9 /
&static /
"""


class RoundTripTest(ExportTest):
    """Decks with zones, stringers and a radius, and the files of other programs."""

    def setUp(self) -> None:
        """Write the deck."""
        super().setUp()
        self.keep(STIFFENED.format(in_plane="fixed"))

    def keep(self, text: str) -> None:
        """Write the deck to the folder."""
        self.path = self.folder / "stiffened.nml"
        self.path.write_text(text)

    def test_nastran(self) -> None:
        """The deck of the exported file has the same plies at each place, radius, and stiffness of the stringers."""
        if WITHOUT:
            self.skipTest(WITHOUT)
        from implam_post.exchange import from_nastran
        self.assertEqual(self.run_command(to_nastran, self.path)[0], 0)
        again = self.folder / "again.nml"
        code, printed = self.run_command(from_nastran.main, self.folder / "stiffened_panel.bdf", "-o", again)
        self.assertEqual(code, 0, printed)
        one, other = read_panel(self.path), read_panel(again)
        np.testing.assert_allclose(other.curvature, one.curvature, rtol=1e-6)
        zones = [zones_of(deck, plies_of(deck)) for deck in map(read_deck, (self.path, again))]
        for x in np.linspace(-119, 119, 60):
            for y in np.linspace(-79, 79, 60):
                found, expected = (each.at(x, y) for each in zones[::-1])
                self.assertEqual(found.numbers, expected.numbers)
                self.assertAlmostEqual(found.front, expected.front, 9)
        self.assertEqual([ply.angle for ply in zones[1].plies], [ply.angle for ply in zones[0].plies])
        order = {(stringer.axis, stringer.at): stringer for stringer in one.stringers}
        self.assertEqual(len(other.stringers), 3)
        for stringer in other.stringers:
            own = order[stringer.axis, stringer.at]
            self.assertEqual((stringer.face, stringer.section.web is None), (own.face, own.name != "blade"))
            for key in ("area", "bending", "torsion", "shear_area"):
                modulus = {"torsion": "shear_modulus", "shear_area": "shear_modulus"}.get(key, "modulus")
                self.assertAlmostEqual(getattr(stringer.section, key) * getattr(stringer.section, modulus) / (
                    getattr(own.section, key) * getattr(own.section, modulus)), 1, 7)
            self.assertAlmostEqual(stringer.section.mass / own.section.mass, 1, 7)

    def test_elements(self) -> None:
        """Two CBAR per side of a cell, from grids of the line; their offsets are those of the centroid."""
        if WITHOUT:
            self.skipTest(WITHOUT)
        from pyNastran.bdf.bdf import read_bdf
        self.assertEqual(self.run_command(to_nastran, self.path, "--z0")[0], 0)
        model = read_bdf(str(self.folder / "stiffened_panel.bdf"), debug=None)
        bars = [element for element in model.elements.values() if element.type == "CBAR"]
        blade = [bar for bar in bars if bar.pid_ref.type == "PBARL"]
        self.assertAlmostEqual(sum(bar.Length() for bar in blade), 240, 6)
        heights = {round(float(np.linalg.norm(bar.wa)), 6) for bar in blade}
        self.assertEqual(heights, {10.8, 11.3})
        for bar in blade:
            self.assertAlmostEqual(bar.ga_ref.xyz[1], 37, 9)
            slope = bar.wa[1] / bar.wa[2]
            self.assertAlmostEqual(slope, -37 / 800, 5)
        held = {grid for each in model.spcs[1] if each.components == "6" for grid in each.node_ids}
        self.assertEqual(set(model.nodes) - held, {grid for bar in bars for grid in bar.node_ids})
        self.assertAlmostEqual(sum(bar.Mass() for bar in blade) / (240 * 40 * 1.6e-9), 1, 6)

    def test_abaqus(self) -> None:
        """Webs and caps as shells, held at the ends of the plate; a section without sizes is not written."""
        code, printed = self.run_command(to_abaqus, self.path)
        self.assertEqual(code, 0, printed)
        self.assertIn("3 stringers", printed)
        self.assertIn("note: the stringer 'any' is not written, as its section has no sizes: add a beam.", printed)
        text = (self.folder / "stiffened_panel.inp").read_text()
        self.assertEqual(re.findall(r"TYPE=S8R, ELSET=(\w+)", text), ["ALL_SHELLS", "WEB_1", "WEB_2", "CAP_2"])
        self.assertIn("*SHELL SECTION, ELSET=CAP_2, MATERIAL=STRINGER_2, ORIENTATION=ALONG_CAP_2\n1.5\n", text)

    def test_webs(self) -> None:
        """A web reaches from the grids to its free edge on the local face; ends move with a free clamp."""
        panel = read_panel(self.path)
        webs = webs_of(panel, shell_mesh(panel, with_middles=False))
        areas = {}
        places = {number + 1: place for number, place in enumerate(shell_mesh(panel, False).coordinates)} | webs.nodes
        for part, elements in webs.elements.items():
            corners = np.array([[places[node] for node in element[:4]] for element in elements])
            areas[part] = np.linalg.norm(np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]),
                                         axis=1).sum() / 2
        self.assertAlmostEqual(areas[0, "WEB"], 240 * 20.8 + 60 * 0.25, delta=12)
        # On the struck face, the convex one, the edge of the web is longer than the arc of the skin.
        self.assertAlmostEqual(areas[1, "WEB"] / (100.1 * 21.55), 1, 1)
        self.assertAlmostEqual(areas[1, "CAP"] / (100 * 12), 1.03, 1)
        held = {(node, component) for node, component in webs.fixed}
        self.assertEqual({component for _, component in held}, {1, 2, 3})
        self.assertEqual(webs.equal, [])
        self.keep(STIFFENED.format(in_plane="free"))
        panel = read_panel(self.path)
        webs = webs_of(panel, shell_mesh(panel, with_middles=False))
        self.assertEqual({each.component for each in webs.equal}, {1, 2})

    def test_refused(self) -> None:
        """Stringers off the plate or without sizes, and wrong doublers and ply drops."""
        text = STIFFENED.format(in_plane="fixed")
        for old, new, words in (("at=37", "at=90", "'blade' does not lie on the plate"),
                                (" thickness=2 E", " E", "thickness is required"),
                                ("EA=2e6", "EA=0", "of 'any' must be greater than zero"),
                                ("plies=4,5", "plies=9", "plies must be integers from 1 to 8"),
                                ("[0/30]'", "[0//30]'", "cannot be read from character 4"),
                                ("size=60,30", "size=60", "size must be two numbers"),
                                ("face='back'", "face='side'", "'side' is not one of front, back")):
            with self.subTest(words):
                self.keep(text.replace(old, new, 1))
                code, printed = self.run_command(to_nastran, self.path)
                self.assertEqual((code, printed.count("\n")), (2, 1), printed)
                self.assertIn(words, printed)

    def test_bond(self) -> None:
        """A bond that may delaminate is rigid, except where it has a starter; the command says so."""
        text = STIFFENED.format(in_plane="fixed")
        for starter, parts in (("", {((1, 2, 3, 4, 5, 6, 7, 8, 9, 10),)}),
                               ("starter=30 starter_at=-60,40", {((1, 2, 3, 4, 5, 6, 7, 8), (9, 10))})):
            self.keep(text.replace("&static /", f"&delamination doubler='pad' G_c=1 {starter} /\n&static /"))
            code, printed = self.run_command(to_nastran, self.path)
            self.assertEqual(code, 0, printed)
            self.assertIn("the bond of doublers on the back is written as rigid", printed)
            panel = read_panel(self.path)
            found = [tuple(panel.section(stack).numbers for stack in stacks) for stacks in panel.stacks.values()]
            self.assertEqual({numbers for numbers in found if any(9 in part for part in numbers)}, parts)

    def test_lines(self) -> None:
        """Lines of equal cells move to what they must follow, or one is added."""
        np.testing.assert_allclose(with_lines(np.linspace(0, 4, 5), [1.2, 2.9]), [0, 1.2, 2, 2.9, 4])
        np.testing.assert_allclose(with_lines(np.linspace(0, 4, 5), [1.2, 1.3, 0.1]), [0, 0.1, 1.2, 1.3, 2, 3, 4])

    def test_sublaminates(self) -> None:
        """Plies of doublers belong to the outermost sublaminates."""
        self.assertEqual(split((7, 8, 1, 2, 3, 4, 9), [2], 4), [(7, 8, 1, 2), (3, 4, 9)])
        self.assertEqual(split((1, 2, 4, 9), [1, 3], 4), [(1,), (2,), (4, 9)])
        self.assertEqual(split((1, 2, 3), [], 3), [(1, 2, 3)])
        self.assertEqual(split((5, 1, 2, 6), [], 4), [(5, 1, 2, 6)])
        self.keep(STIFFENED.format(in_plane="fixed").replace(
            "&static /", "&delamination below_ply=6 law='front' G_c=1 zone=200,120 starter=30 starter_at=-60,40 /\n"
                         "&static /"))
        panel = read_panel(self.path)
        lower = {panel.section(found[1]).numbers for found in panel.stacks.values() if len(found) > 1}
        self.assertIn((7, 8, 9, 10), lower)
        section = next(panel.section(found[1]) for found in panel.stacks.values()
                       if len(found) > 1 and found[1].lay_up == LayUp((7, 8, 9, 10), found[1].lay_up.front))
        self.assertAlmostEqual(section.first_face, 0.4)
        self.assertAlmostEqual(section.last_face, 1.3)
        self.assertEqual(section.title, "plies 7 to 10")


if __name__ == "__main__":
    unittest.main()
