"""Tests of pictures: units, styles, cracks, projected delamination, measured curves, file formats."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import h5py
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from PIL import Image

from implam_post.io.fields import Fields, Mesh, Snapshot, area, read_fields
from implam_post.io.history import ENERGIES, History, read_history
from implam_post.plot import command, movie, pictures
from implam_post.plot.curves import axis_of_column, rows_of_growth
from implam_post.plot.failures import along_fibres, failures_figure
from implam_post.plot.front import front_figure
from implam_post.plot.plan import delamination_figure, depth_colours, projected_figure
from implam_post.plot.plan_frame import caption
from implam_post.plot.style import PictureStyle, lay_out
from implam_post.report.pictures import history_pictures
from implam_post.sweep.scatter_plots import share_figure
from implam_post.sweep.scatter_results import EndedRun, Group
from tests.io.test_fields import write_fields

DECK = """&case units='SI' /
&plate length=10, 10 edges='simple' /
&material name='ply' density=1580 E1=1e11 E2=1e10 G12=5e9 G23=3e9 nu12=0.3 /
&laminate materials='ply' stacking='[30/-30/90]' ply_thickness=1e-3 /
&impactor mass=1 energy=2 radius=1e-2 /
"""


def history(name: str, factor: float = 1.0) -> History:
    """Return an impact of 2 ms that ends with separation."""
    time = np.linspace(0, 3e-3, 31)
    force = factor * np.maximum(np.sin(np.pi * time / 2e-3), 0) * 2000 * (time < 2e-3)
    rest = {name: np.zeros(31) for name in (*ENERGIES, "energy_error")}
    return History({"time": time, "force": force, "indentation": np.where(force > 0, 1e-4, -2e-3),
                    "deflection": 1e-3 * force / 2000, **rest}, name)


def many_interfaces(path: Path, count: int) -> Fields:
    """Return two times of a square plate with interfaces below all plies but the last two; every third ply cracks."""
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], dtype=float)
    plies = np.arange(1, count + 2)
    mesh = Mesh(np.tile(corners, (count + 1, 1, 1)), plies, plies, np.zeros(count + 1, dtype=bool))
    failures = {int(ply): np.where(plies == ply, 2 * (ply % 3 == 0), 0) for ply in plies}
    return Fields(str(path), "whole", [
        Snapshot(time, mesh, np.ones((count + 1, 9)) * (plies[:, None] > 1) * time, failures, np.zeros(count + 1))
        for time in (0.5, 1.0)])


class PicturesTest(unittest.TestCase):
    """Each test draws into its own folder, or checks a figure."""

    def setUp(self) -> None:
        """Write fields with a deck in them."""
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.path = self.folder / "case.h5"
        write_fields(self.path, part="whole")
        with h5py.File(self.path, "a") as file:
            file["provenance/deck"] = np.bytes_(DECK)

    def write(self, of: History, name: str) -> Path:
        """Write a history as a file."""
        path = self.folder / name
        np.savetxt(path, np.column_stack(list(of.columns.values())), delimiter=",", header=",".join(of.columns),
                   comments="")
        return path

    def plot(self, *arguments: object) -> tuple[int, str]:
        """Run the command without output."""
        text = io.StringIO()
        with contextlib.redirect_stdout(text), contextlib.redirect_stderr(text):
            code = command.main([str(argument) for argument in arguments])
        return code, text.getvalue()

    def test_axes_have_units_and_runs_their_styles(self) -> None:
        """2 kN at 1 ms are drawn as 2 and 1; line styles of two runs differ; no indentation after separation."""
        axes = Figure().subplots()
        pictures.draw_response(axes, [history("a"), history("b", 0.5)], "force", PictureStyle("SI"))
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("time [ms]", "contact force [kN]"))
        lines = axes.get_lines()
        self.assertAlmostEqual(np.max(lines[0].get_ydata()), 2.0, delta=1e-9)
        self.assertAlmostEqual(lines[0].get_xdata()[np.argmax(lines[0].get_ydata())], 1.0, delta=1e-9)
        self.assertNotEqual(lines[0].get_linestyle(), lines[1].get_linestyle())
        shown = pictures.response_of(history("a"), "indentation")
        self.assertTrue(np.isnan(shown[-1]))
        self.assertEqual(np.nanmin(shown), 1e-4)

    def test_same_response_in_other_units(self) -> None:
        """The same impact in mm, t and s has the same picture."""
        si, other = history("a"), history("a")
        other = History(other.columns | {"deflection": 1e3 * other["deflection"]}, "a")
        drawn = []
        for of, system in ((si, "SI"), (other, "mm-t-s")):
            axes = Figure().subplots()
            pictures.draw_response(axes, [of], "deflection", PictureStyle(system))
            drawn.append((axes.get_ylabel(), axes.get_lines()[0].get_ydata()))
        self.assertEqual(drawn[0][0], drawn[1][0])
        np.testing.assert_allclose(drawn[0][1], drawn[1][1], rtol=1e-12)

    def test_load_factors(self) -> None:
        """For load steps all axes, legends and titles have load factors, with or without a summary."""
        with h5py.File(self.path, "a") as file:
            del file["provenance/deck"]
            file["provenance/deck"] = np.bytes_(f"{DECK}&static steps=2 /\n")
        path, style = self.write(history("case"), "case_history.csv"), PictureStyle("SI")
        goes_on, fields = read_history(path), read_fields(self.path)
        (self.folder / "case_summary.json").write_text('{"load_factor_reached": 1}')
        self.path.rename(self.folder / "moved.h5")
        ended = read_history(path)
        (self.folder / "moved.h5").rename(self.path)
        (self.folder / "case_summary.json").write_text('{"time_reached": 1}')
        self.assertEqual(read_history(path).by_load_steps, False)
        for loaded in (goes_on, ended):
            axes = Figure().subplots(2)
            pictures.draw_response(axes[0], [loaded], "force", style)
            pictures._stack(axes[1], loaded, style)
            labels = {part.get_xlabel() for figure in (f for name, f in history_pictures(loaded, style) if
                      "against load factor" in name) for part in figure.axes} | {part.get_xlabel() for part in axes}
            self.assertEqual(labels, {"load factor"})
            self.assertEqual(axis_of_column("time", loaded.time, loaded, style).label, "load factor")
        pictures.draw_response(axes[0], [goes_on, history("a")], "force", style)
        self.assertEqual(axes[0].get_xlabel(), "time (the deck's units), load factor")
        left, right = front_figure(fields, style=style).axes[:2]
        self.assertEqual(left.get_legend().get_title().get_text(), "load factor")
        self.assertRegex(right.get_title(), "^load factor")
        self.assertRegex(caption(fields, style), "State at load factor 1.5;")
        with mock.patch.object(movie, "FigureCanvasAgg") as canvas:
            canvas.return_value.buffer_rgba.return_value = np.zeros((1, 1, 4), np.uint8)
            movie.frames(fields, goes_on, style)
        plan, below = canvas.call_args.args[0].axes
        self.assertEqual((plan.get_title(), below.get_xlabel()), ("load factor 1.5", "load factor"))

    def test_projected_interfaces(self) -> None:
        """A delamination is drawn as one region; the title has its area."""
        fields = read_fields(self.path)
        axes = projected_figure(fields, PictureStyle("SI")).axes[0]
        cells = fields.delaminated(2, 2)
        regions = [part.get_path() for part in axes.patches if isinstance(part, PathPatch)]
        self.assertEqual([np.count_nonzero(path.codes == path.MOVETO) for path in regions], [1, 1, 1])
        self.assertIn(f"{float(f'{1e6 * area(cells):.4g}'):.0f} mm²", axes.get_title())
        self.assertEqual(axes.get_xlabel(), "x [mm]")

    def test_cracks_run_along_fibres(self) -> None:
        """The lines of a ply have its angle, from the deck in the file, and are within their cells."""
        square = np.array([[[0, 0], [2, 0], [2, 1], [0, 1]]], dtype=float)
        for angle in (0, 30, 90, -45):
            line = along_fibres(square, angle)[0]
            run = line[1] - line[0]
            self.assertAlmostEqual(run[0] * np.sin(np.radians(angle)), run[1] * np.cos(np.radians(angle)))
            self.assertTrue(np.all(line >= -1e-12) and np.all(line <= [2 + 1e-12, 1 + 1e-12]), line)
            self.assertGreater(np.hypot(*run), 0.99)
        figure = failures_figure(read_fields(self.path), ("matrix cracking",), PictureStyle("SI"))
        self.assertIn("none of these failures in ply 2\n", figure.get_suptitle())
        third = figure.axes[1]
        self.assertEqual(third.get_title(), "ply 3, 90°")
        lines = [segment for part in third.collections if isinstance(part, LineCollection)
                 for segment in part.get_segments()]
        self.assertEqual(len(lines), 2)
        self.assertTrue(all(abs(segment[0, 0] - segment[1, 0]) < 1e-9 for segment in lines))

    def test_pages_of_many_interfaces(self) -> None:
        """Thirty interfaces and 32 plies are on a page with one bar of colours, and no map outside it."""
        fields = many_interfaces(self.folder / "none.h5", 30)
        style = PictureStyle("SI")
        for figure in (delamination_figure(fields, style), failures_figure(fields, style=style),
                       projected_figure(fields, style)):
            lay_out(figure)
            self.assertTrue(np.all(np.array(figure.get_size_inches()) <= (7.5, 10)), figure.get_size_inches())
            bars = [axes for axes in figure.axes if axes.get_label() == "<colorbar>"]
            self.assertLessEqual(len(bars), 1)
            inside = figure.bbox.padded(1)
            for axes in figure.axes:
                if axes.get_visible() and axes.get_title():
                    box = axes.title.get_window_extent()
                    self.assertTrue(inside.x0 <= box.x0 and box.x1 <= inside.x1 and box.y1 <= inside.y1,
                                    axes.get_title())
        titles = [axes.get_title() for axes in delamination_figure(fields, PictureStyle("SI")).axes if axes.get_title()]
        self.assertEqual(len(titles), 30)
        self.assertEqual(titles[0], "below ply 1: 4000000 mm²")

    def test_lowest_maps_have_axes(self) -> None:
        """With an incomplete last row every column ends with a map that has the label of its axis."""
        figure = delamination_figure(many_interfaces(self.folder / "none.h5", 7), PictureStyle("SI"))
        maps = [axes for axes in figure.axes if axes.get_title()]
        columns = len({round(axes.get_position().x0, 2) for axes in maps})
        self.assertEqual(sum(axes.get_xlabel() != "" for axes in maps), columns)

    def test_no_place_without_an_interface(self) -> None:
        """The projected region is filled with colours of interfaces, also where interpolated shares are too small."""
        corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
        mesh = Mesh(np.stack([corners, corners, corners]), np.array([1, 2, 3]), np.array([1, 2, 3]), np.zeros(3, bool))
        shares = np.zeros((3, 9))
        shares[1, [0, 3, 7]], shares[2, [1, 2, 5]] = 1, 1
        fields = Fields(str(self.folder / "none.h5"), "whole", [Snapshot(1.0, mesh, shares, {}, np.zeros(3))])
        region = sum(area(cells) for cells in fields.projected_rest(0))
        self.assertAlmostEqual(region, area(fields.projected(0)))

    def test_pictures_of_a_compression(self) -> None:
        """A compression has no empty panels of contact; a run with contact has all four."""
        of = history("a")
        struck, pressed = History(dict(of.columns), "a"), History(of.columns | {
            "force": np.zeros(31), "far_field_stress": np.linspace(0, 1e8, 31), "shortening": np.linspace(0, 1e-3, 31),
            "nominal_strain": np.linspace(0, 1e-2, 31)}, "b")
        self.assertIsNone(pictures.plot_response([pressed], self.folder / "b.png"))
        with mock.patch.object(Figure, "savefig", autospec=True, side_effect=Figure.savefig) as saved:
            pictures.plot_response([struck, pressed], self.folder / "a.png")
        axes = saved.call_args.args[0].axes
        self.assertEqual(len(axes), 4)
        self.assertEqual([len(axes[0].get_lines()), len(axes[2].get_lines())], [1, 2])

    def test_growth_is_marked_from_first_growth_on(self) -> None:
        """Rows in which an interface only softens are not growth."""
        of = history("a")
        rows = np.arange(31)
        of = History(of.columns | {"delaminated_area": np.clip(rows - 4, 0, 12) * 1e-6,
                                   "stage_below_2": np.select([rows < 4, rows < 9], [0, 1], 2)}, "a")
        self.assertEqual(list(rows_of_growth(of)), list(range(9, 17)))

    def test_struck_aside(self) -> None:
        """The picture is centred at the struck point of the deck and shows the entire delaminated area."""
        with h5py.File(self.path, "a") as file:
            del file["provenance/deck"]
            file["provenance/deck"] = np.bytes_(DECK.replace("radius=1e-2", "radius=1e-2 at=2, 1"))
        fields = read_fields(self.path)
        cells = fields.delaminated(2, 2)
        for figure in (projected_figure(fields, PictureStyle("SI")), delamination_figure(fields, PictureStyle("SI"))):
            axes = figure.axes[0]
            low, high = np.transpose([axes.get_xlim(), axes.get_ylim()])
            self.assertTrue(np.all(cells > low) and np.all(cells < high), (low, high))
            np.testing.assert_allclose((low + high) / 2, (2, 1))

    def test_movie(self) -> None:
        """A picture for each time, each with more delaminated cells than the one before."""
        self.write(history("case"), "case_history.csv")
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(movie.main([str(self.path), "--dpi", "50"]), 0)
        with Image.open(self.folder / "case.gif") as film:
            self.assertEqual(film.n_frames, 3)
        colour = np.round(255 * np.array(depth_colours(1)[0][:3])).astype(int)
        blue = [np.count_nonzero(np.all(np.asarray(picture) == colour, axis=2))
                for picture in movie.frames(read_fields(self.path), None, PictureStyle("SI", 50))]
        self.assertTrue(blue[0] < blue[1] < blue[2], blue)

    def test_measured_curve_and_kinds_of_files(self) -> None:
        """A measured force is in the legend; PDF and SVG are written; a curve without known columns is refused."""
        run, measured = self.write(history("a"), "a_history.csv"), self.folder / "m.csv"
        measured.write_text("time,force\n0,0\n1e-3,1900\n2e-3,10\n")
        plain = self.plot(run, "--units", "SI", "--format", "svg")
        self.assertEqual(plain[0], 0, plain[1])
        before = (self.folder / "a_history_response.svg").stat().st_size
        drawn = self.plot(run, "--units", "SI", "--format", "svg", "--measured", measured)
        self.assertEqual(drawn[0], 0, drawn[1])
        self.assertGreater((self.folder / "a_history_response.svg").stat().st_size, before)
        self.assertEqual(self.plot(self.path, "--format", "pdf", "--font-size", 14)[0], 0)
        self.assertTrue((self.folder / "case_projected.pdf").read_bytes().startswith(b"%PDF"))
        measured.write_text("time,load\n0,0\n1e-3,1900\n")
        self.assertEqual(self.plot(run, "--measured", measured)[0], 4)
        self.assertEqual(self.plot(run, "--dpi", "1")[0], 1)

    def test_nothing_is_drawn_of_faulty_input(self) -> None:
        """All files are read before the first picture is written."""
        good, bad = self.write(history("a"), "a_history.csv"), self.folder / "b_history.csv"
        bad.write_text("time,force\n0,0\nx,1\n")
        files = sorted(self.folder.iterdir())
        for words in ((good, bad), (self.path, bad), (self.path, "--measured", self.folder / "none.csv"),
                      (good, "--undamaged", self.folder / "none_summary.json")):
            self.assertEqual(self.plot(*words)[0], 4)
            self.assertEqual(sorted(self.folder.iterdir()), files)

    def test_titles_are_whole(self) -> None:
        """Titles of axes with equal scales are within the picture for any shape of the damage."""
        for length, width in ((57, 32), (38, 14), (20, 20), (15, 45)):
            corners = np.array([[0, 0], [length, 0], [length, width], [0, width]]) - np.array([length, width]) / 2
            mesh = Mesh(np.stack([corners, corners / 2]), *2 * [np.array([2, 3])], np.zeros(2, dtype=bool))
            snapshot = Snapshot(1.0, mesh, np.ones((2, 9)), {}, np.zeros(2))
            figure = projected_figure(Fields("none.h5", "whole", [snapshot]), PictureStyle("mm-t-s"))
            lay_out(figure)
            beyond = figure.axes[0].title.get_window_extent().y1 - figure.bbox.height
            self.assertLess(beyond, 0, (length, width))

    def test_shares_of_runs(self) -> None:
        """The map has the fraction of runs of each group at a place, and titles within the picture."""
        for groups, length, width in ((1, 57, 32), (2, 15, 45), (4, 20, 20)):
            corners = np.array([[0, 0], [length, 0], [length, width], [0, width]]) - np.array([length, width]) / 2
            mesh = Mesh(corners[None], *2 * [np.array([2])], np.zeros(1, dtype=bool))
            plate = Fields("none.h5", "whole", [Snapshot(1.0, mesh, np.ones((1, 9)), {}, np.zeros(1))])
            runs = [EndedRun(None, None, {}, 0.0, region) for region in (corners[None], corners[None] / 2)]
            figure = share_figure([Group(f"variant {place}", runs, plate=plate) for place in range(groups)],
                                  PictureStyle("mm-t-s"))
            lay_out(figure)
            shares = figure.axes[0].images[0].get_array()
            self.assertEqual(set(np.unique(shares)), {0, 0.5, 1})
            self.assertAlmostEqual(np.sum(shares == 1) / np.sum(shares > 0), 0.25, delta=0.02)
            for axes in figure.axes[:groups]:
                self.assertLess(axes.title.get_window_extent().y1, figure.bbox.height, (groups, length, width))
