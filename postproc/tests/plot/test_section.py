"""Tests of sections through the plate: geometry, symmetry, heights of plies, openings, failures, dent."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

from implam_post.io.fields import read_fields
from implam_post.io.history import History
from implam_post.io.section import section_at
from implam_post.laminate.sections import Material, Ply
from implam_post.laminate.zones import Doubler, PlyDrop, Rectangle, Zones
from implam_post.plot import command as plot
from implam_post.plot.section import dent_of, section_figure
from implam_post.plot.section_drawing import Plate
from implam_post.plot.style import PictureStyle, lay_out
from tests.io.test_fields import write_fields
from tests.plot.test_pictures import DECK

SI = PictureStyle("SI")
# Cells of write_fields are 1, 2 and 3 long; ply 3 is below the interface.
OPENING, DEFLECTION = 2e-4, 1e-3


class SectionTest(unittest.TestCase):
    """A quarter with a delamination below ply 2 in the cells along x."""

    def setUp(self) -> None:
        """Write the fields: the lower layer is deflected more by the opening."""
        self.path = Path(self.enterContext(tempfile.TemporaryDirectory())) / "case.h5"
        self.write("quarter")

    def write(self, part: str, opening: float = OPENING) -> None:
        """Write fields with a deflection that increases along x, and an opening everywhere."""
        write_fields(self.path, part)
        with h5py.File(self.path, "a") as file:
            file["provenance/deck"] = np.bytes_(DECK.replace("[30/-30/90]", "[0/90/0]"))
            places = file["meshes/00000001/coordinates"][()]
            lower = np.tile(np.repeat([0.0, 1.0], 4), len(places) // 8)
            zero = np.zeros(len(places))
            for group in file["times"].values():
                w = DEFLECTION * np.abs(places[:, 0]) + opening * lower
                group["points/displacement"] = np.column_stack([zero, zero, w])
                group["points/jump"] = np.column_stack([zero, zero, opening * lower])

    def test_lengths_of_parts(self) -> None:
        """Along and across x, and along a diagonal, parts add up to the length of the plate in both layers."""
        fields = read_fields(self.path)
        for angle, length in ((0, 12), (90, 12), (45, 12 * np.sqrt(2)), (-45, 12 * np.sqrt(2)),
                              (30, 12 / np.cos(np.pi / 6))):
            section = section_at(fields, angle)
            for first in (1, 3):
                own = section.along[section.first_ply == first]
                parts = np.unique(np.round(own[:, [0, -1]], 9), axis=0)
                self.assertAlmostEqual(float(np.sum(parts[:, 1] - parts[:, 0])), length, msg=f"{angle} {first}")

    def test_delamination_on_the_line(self) -> None:
        """The section along x is delaminated over all of it, that across x to the side of the first cells."""
        fields = read_fields(self.path)
        for angle, reach in ((0, 6), (90, 1), (45, np.sqrt(2))):
            section = section_at(fields, angle)
            found = section.along[section.delaminated]
            self.assertAlmostEqual(float(found.max()), reach, delta=1e-6)
            self.assertAlmostEqual(float(found.min()), -reach, delta=1e-6)
        self.assertTrue(np.all(section_at(fields, 0).first_ply[np.any(section_at(fields, 0).delaminated, axis=1)] == 3))

    def test_values_of_points(self) -> None:
        """Deflection and opening at the ends of parts are those of the points, with mirror images."""
        section = section_at(read_fields(self.path), 0)
        lower = section.first_ply == 3
        np.testing.assert_allclose(section.opening[lower], OPENING)
        np.testing.assert_allclose(section.deflection[~lower][:, [0, -1]],
                                   DEFLECTION * np.abs(section.along[~lower][:, [0, -1]]), atol=1e-12)

    def test_failures(self) -> None:
        """Ply 3 is cracked in the cells up to 3 from the struck point, ply 1 nowhere on these lines."""
        section = section_at(read_fields(self.path), 0)
        cracked = section.failed(3, "matrix cracking")
        self.assertAlmostEqual(float(np.abs(section.along[cracked]).max()), 3)
        self.assertEqual(len(section.failed(1, "fibre failure")), 0)
        diagonal = section_at(read_fields(self.path), 45)
        self.assertGreater(len(diagonal.failed(1, "fibre failure")), 0)

    def test_drawn_heights(self) -> None:
        """Plies are drawn between their faces, deformed; the gap is filled, from the upper to the lower layer."""
        fields = read_fields(self.path)
        axes = section_figure(fields, SI, angles=[0]).axes[0]
        bands = next(part for part in axes.collections if isinstance(part, PolyCollection))
        paths = [path.vertices for path in bands.get_paths()]
        heights = np.array([np.ptp(path[:, 1][np.isclose(path[:, 0], path[:, 0].max())]) for path in paths])
        np.testing.assert_allclose(heights, 1e-3, atol=1e-9)
        names = [text.get_text() for text in axes.figure.legends[0].get_texts()]
        self.assertIn("delamination, open", names)
        self.assertNotIn("delamination, closed", names)

    def test_curved_plate(self) -> None:
        """A section has the height of the stress-free cylinder, from the struck point on, in its direction."""
        with h5py.File(self.path, "a") as file:
            del file["provenance/deck"]
            file["provenance/deck"] = np.bytes_(DECK.replace("&plate ", "&plate curvature_radius=0, 20 "))
        for angle, share in ((0, 0.0), (90, 1.0), (45, 0.5)):
            section = section_at(read_fields(self.path), angle)
            np.testing.assert_allclose(section.height, share * section.along**2 / 40, atol=1e-12)

    def test_closed_and_unknown_gaps(self) -> None:
        """Without an opening a delamination is closed; without the field its gap is not known."""
        self.write("quarter", 0.0)
        names = self.names()
        self.assertIn("delamination, closed", names)
        self.assertNotIn("delamination, open", names)
        with h5py.File(self.path, "a") as file:
            for group in file["times"].values():
                del group["points/jump"]
        self.assertIn("delamination, gap not written", self.names())

    def names(self, angle: float = 0.0) -> list[str]:
        """Return the entries of the legend."""
        return [text.get_text() for text in
                section_figure(read_fields(self.path), SI, angles=[angle]).legends[0].get_texts()]

    def test_torn_and_crushed_fibres(self) -> None:
        """Fibres are crushed where the file says so, torn elsewhere, and just failed if it has no such field."""
        self.assertIn("fibre failure", self.names(45))
        for value, name in ((0.0, "fibres torn"), (1.0, "fibres crushed")):
            with h5py.File(self.path, "a") as file:
                for group in file["times"].values():
                    for ply in (1, 2, 3):
                        field = f"cells/ply_{ply}_fibres_crushed"
                        if field in group:
                            del group[field]
                        group[field] = np.full(len(file["meshes/00000001/connectivity"]), value)
            self.assertIn(name, self.names(45))

    def test_cracks_by_the_direction_of_the_section(self) -> None:
        """A crack of a ply whose fibres run along the section is in its plane, otherwise a line through the ply."""
        for angle, name in ((0, "matrix crack in the plane of the section"),
                            (45, "matrix crack (a line for each element)")):
            figure = section_figure(read_fields(self.path), SI, angles=[angle])
            self.assertIn(name, [text.get_text() for text in figure.legends[0].get_texts()])
            lines = [part for part in figure.axes[0].collections if isinstance(part, LineCollection)]
            self.assertGreater(len(lines[-1].get_segments()), 0)

    def test_dent(self) -> None:
        """The dent is that of the history, under contact the indentation, and is drawn to its depth."""
        time = np.linspace(0, 1.5, 4)
        of = History({"time": time, "force": np.array([0, 1.0, 1.0, 0]), "indentation": np.full(4, 4e-4),
                      "dent_indentation": np.full(4, 1e-4)}, "case_history.csv")
        fields = read_fields(self.path)
        self.assertEqual(dent_of(fields, of, 1.5).depth, 1e-4)
        self.assertEqual(dent_of(fields, of, 1.0).depth, 4e-4)
        self.assertIsNone(dent_of(fields, None, 1.0))
        dent = dent_of(fields, of, 1.5)
        self.assertAlmostEqual(dent.at(np.array([0.0]))[0], 1e-4)
        self.assertEqual(dent.at(np.array([np.sqrt(2 * 1e-2 * 1e-4) + 1e-9]))[0], 0)
        names = [text.get_text() for text in section_figure(fields, SI, of).legends[0].get_texts()]
        self.assertTrue(any("0.1 mm" in name for name in names), names)

    def test_by_the_command(self) -> None:
        """The picture is written with the others, at the angles given; without a deck there is none."""
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            self.assertEqual(plot.main([str(self.path), "--sections", "0", "45", "90"]), 0)
        self.assertIn("case_section.png", printed.getvalue())
        figure = section_figure(read_fields(self.path), SI)
        lay_out(figure)
        self.assertEqual([axes.get_title().splitlines()[0] for axes in figure.axes],
                         ["section along the fibres of the struck ply, 0° from x",
                          "section across the fibres of the struck ply, 90° from x"])
        for axes in figure.axes:
            self.assertLess(axes.title.get_window_extent().y1, figure.bbox.height)
        box = figure.legends[0].get_window_extent()
        self.assertTrue(box.x0 >= 0 and box.x1 <= figure.bbox.width)
        with h5py.File(self.path, "a") as file:
            del file["provenance"]
        self.assertIsNone(section_figure(read_fields(self.path), SI))


class LayerTest(unittest.TestCase):
    """The plies of layers at places with doublers and ply drops, and their depths."""

    def test_layers(self) -> None:
        """Plies of rigid doublers belong to the outermost layer, those that may come off are a layer."""
        material = Material(1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.3)
        ply, area = Ply(material, 0.0, 0.25), Rectangle((0.0, 0.0), (2.0, 2.0))
        pad = Doubler("pad", "back", area, (ply, ply))
        cases = (((pad,), (), 1, 4, (1, 2, 3, 4, 5, 6), 0.0), ((pad,), (), 1, 2, (1, 2), 0.0),
                 ((pad,), (), 3, 4, (3, 4, 5, 6), 0.5), ((pad._replace(face="front"),), (), 1, 2, (5, 6, 1, 2), -0.5),
                 ((pad._replace(may_separate=True),), (), 1, 4, (1, 2, 3, 4), 0.0),
                 ((pad._replace(may_separate=True),), (), 5, 4, (5, 6), 1.0),
                 ((pad._replace(face="front", may_separate=True),), (), 1, 4, (1, 2, 3, 4), 0.0),
                 ((pad._replace(face="front", may_separate=True),), (), 0, 0, (5, 6), -0.5),
                 ((), (PlyDrop((1,), area, "back"),), 1, 4, (2, 3, 4), 0.25))
        for doublers, drops, first, last, plies, depth in cases:
            with self.subTest(plies):
                plate = Plate(Zones([ply] * 4, doublers, drops))
                layer = plate.layer(np.zeros(2), first, last)
                self.assertEqual(layer.plies, plies)
                np.testing.assert_allclose(layer.depths, depth + 0.25 * np.arange(len(plies) + 1), atol=1e-12)
                self.assertEqual(plate.layer(np.array([3.0, 0.0]), first, min(last, 4)).plies,
                                 tuple(range(max(first, 1), last + 1)))


if __name__ == "__main__":
    unittest.main()
