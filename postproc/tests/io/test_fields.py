"""Tests of the fields and their pictures, on a small NAME.h5 written here in the solver's layout."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

from implam_post.io.errors import FileError, ImplamError
from implam_post.io.fields import MODES, area, extents, outline, read_fields
from implam_post.io.history import ENERGIES, History
from implam_post.io.quantities import growth_rows
from implam_post.plot import command as plot
from implam_post.plot.front import front_figure
from implam_post.plot.plan import title_of

EDGES = np.array([0.0, 1.0, 3.0, 6.0])
CELLS = [(i, j) for j in range(3) for i in range(3)]
TIMES = (0.5, 1.0, 1.5)
PICTURES = ("delamination", "projected", "front", "matrix", "fibres")


def write_fields(path: Path, part: str = "quarter", times: tuple[float, ...] = TIMES) -> None:
    """Write 3 x 3 cells of unequal sizes, each with layers of plies 1-2 and 3.

    The starter is cell (0, 0); cell (1, 0) delaminates at the second time, cell (2, 0) at the third. G/G_c of cells
    next to them is their distance from the corner, and half of it at the first time. Ply 3 cracks in cells
    (0, 0) and (1, 0); ply 1 fails in all three modes in cell (2, 2).
    """
    corners, first, last = [], [], []
    for i, j in CELLS:
        for plies in ((1, 2), (3, 3)):
            corners += [(EDGES[i + a], EDGES[j + b]) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
            first.append(plies[0])
            last.append(plies[1])
    elements = len(first)
    with h5py.File(path, "w") as file:
        file["part"] = np.bytes_(part)
        mesh = file.create_group("meshes/00000001")
        mesh["coordinates"] = np.column_stack([corners, np.zeros(4 * elements)])
        mesh["connectivity"] = np.pad(np.arange(4 * elements).reshape(-1, 4), ((0, 0), (0, 5)), mode="edge")
        mesh["cells/first_ply"], mesh["cells/last_ply"] = first, last
        file.create_group("times")
        for number, time in enumerate(times, start=1):
            group = file.create_group(f"times/{number:08d}")
            group["time"], group["step"], group["mesh"] = time, number, 1
            for name, value in flags(number).items():
                group[f"cells/{name}"] = value.astype(float)


def flags(number: int) -> dict[str, np.ndarray]:
    """Return the fields of a time by element."""
    apart, release, back, front = (np.zeros((len(CELLS), 2)) for _ in range(4))
    for i in range(number):
        apart[CELLS.index((i, 0)), 1] = 1
    back[[CELLS.index((0, 0)), CELLS.index((1, 0))], 1] = 2
    front[CELLS.index((2, 2)), 0] = 7
    # The solver writes zero for plies that an element does not have; other values must not count.
    back[CELLS.index((2, 2)), 0] = 2
    for i, j in CELLS:
        beside = (i, j) == (number, 0) or (j == 1 and i < number)
        release[CELLS.index((i, j)), 1] = beside * (i + j) / (1 + (number == 1))
    named = {"delaminated_above": apart, "energy_release_above": release, "ply_1_failure": front,
             "ply_2_failure": 0 * front, "ply_3_failure": back}
    return {name: values.ravel() for name, values in named.items()}


class FieldsTest(unittest.TestCase):
    """Reading and plotting."""

    def setUp(self) -> None:
        """Write the file."""
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.path = self.folder / "case.h5"
        write_fields(self.path)

    def write_history(self, name: str = "case_history.csv") -> Path:
        """Write a history with growth."""
        time = np.linspace(0, 1.5, 7)
        columns = {name: np.ones(7) for name in (*ENERGIES, "energy_error", "force", "indentation", "deflection")}
        columns = {"time": time, **columns, "delaminated_area": 4 * np.floor(1 + 2 * time)}
        path = self.folder / name
        np.savetxt(path, np.column_stack(list(columns.values())), delimiter=",", header=",".join(columns), comments="")
        return path

    def plot(self, *arguments: object) -> tuple[int, str]:
        """Run the command without output."""
        text = io.StringIO()
        with contextlib.redirect_stdout(text), contextlib.redirect_stderr(text):
            code = plot.main([str(argument) for argument in arguments])
        return code, text.getvalue()

    def test_delamination_of_the_full_plate(self) -> None:
        """A quarter is mirrored to the full plate, with the delamination at each time."""
        fields = read_fields(self.path)
        self.assertEqual(fields.snapshots[0].mesh.interfaces, [2])
        for place, expected in enumerate((4, 12, 24)):
            self.assertAlmostEqual(area(fields.delaminated(place, 2)), expected)
            self.assertAlmostEqual(fields.interface(place, 2).area, expected)
            self.assertAlmostEqual(fields.projected_area(place), expected)
        self.assertEqual(extents(fields.delaminated(2, 2)), (12, 2))
        self.assertEqual(fields.interface(2, 2).extents, (12, 2))
        self.assertAlmostEqual(float(np.mean(fields.delaminated(2, 2))), 0)

    def test_times_and_interfaces_that_are_not_there(self) -> None:
        """A missing time or interface is an error, not an interface without delamination."""
        fields = read_fields(self.path)
        for ask in (fields.delaminated, fields.interface):
            for place, below_ply, sentence in ((0, 1, "no interface below ply 1; it has 2"),
                                               (3, 2, "index 3: indices are 0 to 2"), (-4, 2, "0 to 2")):
                with self.subTest(ask=ask.__name__, place=place), self.assertRaisesRegex(ImplamError, sentence):
                    ask(place, below_ply)
        for ask in (fields.projected, fields.projected_area):
            self.assertRaisesRegex(ImplamError, "index 3", ask, 3)

    def test_damage_is_no_delamination(self) -> None:
        """Shares are areas: a share of .001 is not a delaminated cell; figures are those of the file.

        Cells (0, 0) to (2, 0) have shares of 1, .999 and .001, and areas of 1, 2 and 3; the first time is no starter.
        """
        write_fields(self.path, "whole")
        with h5py.File(self.path, "a") as file:
            shares = file["times/00000003/cells/delaminated_above"]
            shares[2 * CELLS.index((1, 0)) + 1], shares[2 * CELLS.index((2, 0)) + 1] = 0.999, 0.001
            figures = file.create_group("times/00000003/interfaces")
            for name, value in (("ply_above", 2), ("is_cohesive", 1), ("stage", 2), ("area", 2.5)):
                figures[name] = np.array([[float(value)]])
            figures["bounds"], figures["projected_area"] = np.array([[0, 3, 0, 1.0]]), np.array([[2.25]])
        fields = read_fields(self.path)
        self.assertEqual(np.count_nonzero(fields.snapshots[2].delaminated), 2)
        self.assertAlmostEqual(area(fields.delaminated(2, 2)), 3)
        self.assertEqual(len(fields.starter(2)), 0)
        self.assertEqual((fields.interface(2, 2).area, fields.projected_area(2)), (2.5, 2.25))
        self.assertEqual(title_of(fields, 2), "below ply 2: dissipated area 2.5\nfailed over 3 by 1")
        with h5py.File(self.path, "a") as file:
            starter = np.zeros(2 * len(CELLS), dtype=int)
            starter[2 * CELLS.index((0, 0)) + 1] = 1
            file["meshes/00000001/cells/starter_above"] = starter
        self.assertAlmostEqual(area(read_fields(self.path).starter(2)), 1)

    def test_full_plate_is_not_mirrored(self) -> None:
        """A run of the full plate is not mirrored."""
        write_fields(self.path, part="whole")
        self.assertAlmostEqual(area(read_fields(self.path).delaminated(2, 2)), 6)

    def test_outline_has_no_inner_edges(self) -> None:
        """Edges on symmetry lines and between cells of different sizes are not part of the outline."""
        fields = read_fields(self.path)
        edges = outline(fields.delaminated(2, 2))
        self.assertAlmostEqual(float(np.sum(np.abs(edges[:, 1] - edges[:, 0]))), 2 * (12 + 2))
        self.assertEqual(len(outline(np.empty((0, 4, 2)))), 0)

    def test_outline_with_a_waist(self) -> None:
        """Missing cells at the axis leave edges in the outline."""
        mesh = read_fields(self.path).snapshots[0].mesh
        cells = mesh.corners[::2][[CELLS.index(cell) for cell in ((0, 0), (1, 0), (1, 1))]]
        self.assertAlmostEqual(float(np.sum(np.abs(np.diff(outline(cells), axis=1)))), 2 * (3 + 3))

    def test_failures_by_mode(self) -> None:
        """Bits are modes; only elements that contain the ply count."""
        last = read_fields(self.path).snapshots[-1]
        self.assertAlmostEqual(area(last.failed_cells(3, "matrix cracking")), 1 + 2)
        self.assertEqual(len(last.failed_cells(3, "fibre failure")), 0)
        for mode in MODES:
            self.assertAlmostEqual(area(last.failed_cells(1, mode)), 9)

    def test_release_along_the_front(self) -> None:
        """Cells ahead of the front with G/G_c; the picture has one line per time and the front in plan."""
        fields = read_fields(self.path)
        cells, ratio = fields.snapshots[0].release(2)
        self.assertEqual(sorted(ratio), [0.5, 0.5])
        self.assertAlmostEqual(area(cells), 2 + 2)
        around, in_plan = front_figure(fields).axes[:2]
        lines = [line for line in around.lines if line.get_marker() == "."]
        self.assertEqual([len(line.get_xdata()) for line in lines], [2, 3, 3])
        np.testing.assert_allclose(lines[0].get_xdata(), np.degrees(np.arctan([0.5 / 2, 2 / 0.5])))
        self.assertEqual(in_plan.get_title(), "time 1.5")
        self.assertEqual(np.max(in_plan.collections[0].get_array()), 3)
        around, in_plan = front_figure(fields, [0.6]).axes[:2]
        self.assertEqual([len(line.get_xdata()) for line in around.lines], [2, 2])
        self.assertEqual(in_plan.get_title(), "time 0.5")

    def test_times_asked_for(self) -> None:
        """A time outside the fields is reported."""
        self.assertEqual(self.plot(self.path, "--times", "0.5", "1.5")[0], 0)
        code, text = self.plot(self.path, "--times", "2")
        self.assertEqual((code, text.count("outside the times of the fields")), (1, 1), text)

    def test_plots_beside_the_fields(self) -> None:
        """Pictures of delamination, plies and, if there is one, the history; --output changes their folder."""
        code, text = self.plot(self.path)
        self.assertEqual(code, 0, text)
        self.assertEqual({path.name for path in self.folder.glob("*.png")},
                         {f"case_{name}.png" for name in PICTURES})
        self.write_history()
        self.assertEqual(self.plot(self.path, "--output", self.folder / "plots")[0], 0)
        self.assertEqual({path.name for path in (self.folder / "plots").iterdir()},
                         {f"case_{name}.png" for name in (*PICTURES, "history_response", "history_energies")})

    def test_one_small_picture(self) -> None:
        """--save draws one picture, below 150 kB; it needs a history and one NAME.h5."""
        picture = self.folder / "doc" / "picture.png"
        self.assertEqual(self.plot(self.path, "--save", picture)[0], 4)
        history = self.write_history("other.csv")
        self.assertEqual(self.plot(self.path, "--history", history, "--save", picture)[0], 0)
        self.assertLess(picture.stat().st_size, 150_000)
        self.assertEqual([path.name for path in self.folder.rglob("*.png")], ["picture.png"])
        self.assertEqual(self.plot(history, "--save", picture)[0], 1)

    def test_without_damage(self) -> None:
        """A run without interfaces and failures is reported and not drawn."""
        with h5py.File(self.path, "a") as file:
            for group in file["times"].values():
                del group["cells"]
            file["meshes/00000001/cells/first_ply"][()] = 1
            file["meshes/00000001/cells/last_ply"][()] = 3
        code, text = self.plot(self.path)
        self.assertEqual((code, text.count("no interfaces and no ply failures")), (0, 1), text)
        self.assertEqual(self.plot(self.path, "--history", self.write_history(), "--save", self.folder / "a.png")[0], 4)

    def test_what_is_no_file_of_fields(self) -> None:
        """Missing, other and empty files are reported in one sentence."""
        foreign = self.folder / "foreign.h5"
        with h5py.File(foreign, "w") as file:
            file["x"] = 1
        text = self.folder / "text.h5"
        text.write_text("no HDF5")
        empty = self.folder / "empty.h5"
        write_fields(empty, times=())
        for path in (self.folder / "none.h5", foreign, text, empty):
            with self.subTest(path.name):
                self.assertRaises(FileError, read_fields, path)
                self.assertEqual(self.plot(path)[0], 4)

    def test_growth_rows(self) -> None:
        """Rows at which the area has risen; none without the column."""
        history = History({"time": np.arange(4.0), "delaminated_area": np.array([1, 1, 2, 2.0])})
        self.assertEqual(list(growth_rows(history)), [2])
        self.assertEqual(len(growth_rows(History({"time": np.arange(4.0)}))), 0)
