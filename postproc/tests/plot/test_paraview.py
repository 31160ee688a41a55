"""Tests of the files for ParaView: position of the sphere, damage through the plate, validity of the files."""

import ast
import contextlib
import io
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

import h5py
import numpy as np

from implam_post.io.fields import area, read_fields
from implam_post.plot import paraview
from implam_post.plot.paraview import plan_of, sphere
from tests.io.test_fields import TIMES, write_fields
from tests.plot.test_pictures import DECK

THICKNESS, RADIUS = 3e-3, 1e-2
CURVED = DECK.replace("&plate ", "&plate curvature_radius=0, 20 ")


class ParaviewTest(unittest.TestCase):
    """Each test has fields with a deck, and a history, in its own folder."""

    def setUp(self) -> None:
        """Write them."""
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.path = self.folder / "case.h5"
        write_fields(self.path)
        with h5py.File(self.path, "a") as file:
            file["provenance/deck"] = np.bytes_(DECK)
        (self.folder / "case_history.csv").write_text("time,impactor_displacement\n0,0\n1,1e-3\n2,0\n")

    def write(self) -> set[str]:
        """Run the command; return the names of the files it prints."""
        text = io.StringIO()
        with contextlib.redirect_stdout(text):
            self.assertEqual(paraview.main([str(self.path)]), 0)
        return {Path(line).name for line in text.getvalue().splitlines()}

    def test_sphere(self) -> None:
        """Its area is nearly that of a sphere; all normals point outwards or all inwards."""
        points, triangles = sphere(2.0)
        first, second, third = (points[triangles[:, corner]] for corner in range(3))
        normals = np.cross(second - first, third - first)
        self.assertAlmostEqual(np.linalg.norm(normals, axis=1).sum() / 2 / (16 * np.pi), 1, delta=0.01)
        wide = np.linalg.norm(normals, axis=1) > 1e-9
        self.assertEqual(len(set(np.sign(np.sum(normals * first, axis=1)[wide]))), 1)

    def test_impactor_moves(self) -> None:
        """Its lowest point is at the struck face, -h/2, at first contact, and then moves by the displacement."""
        self.assertEqual(self.write(), {"case_paraview.h5", "case_paraview.py", "case_through.xdmf",
                                        "case_impactor.xdmf"})
        with h5py.File(self.folder / "case_paraview.h5") as file:
            for number, depth in enumerate((0.5e-3, 1e-3, 0.5e-3), start=1):
                nose = file[f"{number:08d}/sphere"][()][:, 2].max()
                self.assertAlmostEqual(nose, depth - THICKNESS / 2)
                self.assertAlmostEqual(np.ptp(file[f"{number:08d}/sphere"][()][:, 2]), 2 * RADIUS)

    def test_through_the_thickness(self) -> None:
        """Number and first of delaminated interfaces, and fraction of failed plies, over the full plate."""
        self.write()
        with h5py.File(self.folder / "case_paraview.h5") as file:
            for number, expected in enumerate((4, 12, 24), start=1):
                group = file[f"{number:08d}"]
                cells = group["points"][()][group["cells"][()]][..., :2]
                delaminated = group["delaminated_interfaces"][()] > 0
                self.assertAlmostEqual(area(cells), 144)
                self.assertAlmostEqual(area(cells[delaminated]), expected)
                self.assertEqual(set(group["first_delaminated_below_ply"][()][delaminated]), {2})
        cells, values = plan_of(read_fields(self.path).snapshots[-1])
        failed = dict(zip(map(tuple, cells[:, 0]), values["share_of_plies_failed"], strict=True))
        self.assertEqual({corner: round(3 * share) for corner, share in failed.items() if share},
                         {(0, 0): 1, (1, 0): 1, (3, 3): 1})

    def test_curved_plate(self) -> None:
        """The plan lies on the back face of the cylinder, and the impactor starts on its struck face."""
        with h5py.File(self.path, "a") as file:
            del file["provenance/deck"]
            file["provenance/deck"] = np.bytes_(CURVED)
        self.write()
        with h5py.File(self.folder / "case_paraview.h5") as file:
            points = file["00000001/points"][()]
            np.testing.assert_allclose(points[:, 2], points[:, 1]**2 / 40 + THICKNESS / 2)
            self.assertAlmostEqual(file["00000001/sphere"][()][:, 2].max(), 0.5e-3 - THICKNESS / 2)

    def test_files_belong_together(self) -> None:
        """The XDMF refers to existing data at the times of the fields; the state file is valid Python."""
        self.write()
        ast.parse((self.folder / "case_paraview.py").read_text())
        with h5py.File(self.folder / "case_paraview.h5") as file:
            for name in ("through", "impactor"):
                root = ElementTree.parse(self.folder / f"case_{name}.xdmf").getroot()
                self.assertEqual([float(time.get("Value")) for time in root.iter("Time")], list(TIMES))
                for item in root.iter("DataItem"):
                    where, path = item.text.split(":")
                    self.assertEqual(where, "case_paraview.h5")
                    self.assertEqual(list(file[path].shape), [int(size) for size in item.get("Dimensions").split()])


if __name__ == "__main__":
    unittest.main()
