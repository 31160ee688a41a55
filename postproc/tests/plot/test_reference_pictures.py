"""Pictures compared with those in tests/pictures; the environment variable IMPLAM_KEEP_PICTURES=1 replaces those."""

import contextlib
import io
import os
import tempfile
import unittest
from pathlib import Path

import h5py
import matplotlib
import numpy as np
from PIL import Image

from implam_post.io.fields import read_fields
from implam_post.plot import command as plot
from implam_post.plot import movie
from implam_post.plot.plan import delamination_figure, projected_figure
from implam_post.plot.style import PictureStyle
from tests.io.test_fields import write_fields
from tests.plot.test_pictures import DECK, history

KEPT = Path(__file__).parent / "pictures"
NAMES = ("delamination", "projected", "front", "matrix", "fibres", "section", "history_response", "history_energies")
# Root of the mean square, of 255, over blocks of 4 x 4 dots, so that a line drawn a little otherwise by another version
# of the library does not count. Pictures are kept in 64 colours, which makes up to 1.0; the faults below make 15 and
# more.
TOLERANCE, BLOCK = 3.0, 4


def blocks(path: Path) -> np.ndarray:
    """Return the means over the blocks of a picture, for each colour."""
    dots = np.asarray(Image.open(path).convert("RGB"), dtype=float)
    rows, columns = (size // BLOCK * BLOCK for size in dots.shape[:2])
    return dots[:rows, :columns].reshape(rows // BLOCK, BLOCK, columns // BLOCK, BLOCK, 3).mean(axis=(1, 3))


def difference(one: Path, other: Path) -> float:
    """Return the difference of two pictures; infinity if their sizes differ."""
    first, second = blocks(one), blocks(other)
    return float(np.sqrt(np.mean((first - second)**2))) if first.shape == second.shape else float("inf")


class ReferencePicturesTest(unittest.TestCase):
    """The pictures of a small run in SI units."""

    def setUp(self) -> None:
        """Write fields with a deck in them, and a history."""
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.write()

    def write(self) -> None:
        """Write the run."""
        write_fields(self.folder / "case.h5", "whole")
        with h5py.File(self.folder / "case.h5", "a") as file:
            file["provenance/deck"] = np.bytes_(DECK)
        of = history("case")
        np.savetxt(self.folder / "case_history.csv", np.column_stack(list(of.columns.values())), delimiter=",",
                   header=",".join(of.columns), comments="")

    def draw(self) -> dict[str, Path]:
        """Draw all pictures; return them by name."""
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(plot.main([str(self.folder / "case.h5"), "--dpi", "50"]), 0)
            self.assertEqual(movie.main([str(self.folder / "case.h5"), "--dpi", "50"]), 0)
        with Image.open(self.folder / "case.gif") as film:
            film.seek(film.n_frames - 1)
            film.convert("RGB").save(self.folder / "case_movie.png")
        return {name: self.folder / f"case_{name}.png" for name in (*NAMES, "movie")}

    def test_pictures_are_those_kept(self) -> None:
        """All pictures, including the projected delamination by time."""
        drawn = self.draw()
        by_time = projected_figure(read_fields(self.folder / "case.h5"), PictureStyle("SI", projected="time"))
        drawn["projected_by_time"] = self.folder / "by_time.png"
        by_time.savefig(drawn["projected_by_time"], dpi=50)
        if os.environ.get("IMPLAM_KEEP_PICTURES"):
            KEPT.mkdir(exist_ok=True)
            for name, path in drawn.items():
                Image.open(path).convert("RGB").quantize(64).save(KEPT / f"{name}.png", optimize=True)
        for name, path in drawn.items():
            with self.subTest(name):
                self.assertLess(difference(path, KEPT / f"{name}.png"), TOLERANCE)

    def test_a_fault_shows(self) -> None:
        """Later delamination and a larger font exceed the tolerance."""
        with h5py.File(self.folder / "case.h5", "a") as file:
            file["times/00000002/cells/delaminated_above"][...] = file["times/00000001/cells/delaminated_above"][()]
        fields = read_fields(self.folder / "case.h5")
        faulty = {"projected_by_time": projected_figure(fields, PictureStyle("SI", projected="time")),
                  "delamination": delamination_figure(fields, PictureStyle("SI"))}
        with matplotlib.rc_context({"font.size": 14}):
            self.write()
            fields = read_fields(self.folder / "case.h5")
            faulty["projected"] = projected_figure(fields, PictureStyle("SI"))
        for name, figure in faulty.items():
            figure.savefig(self.folder / f"{name}.png", dpi=50)
            with self.subTest(name):
                self.assertGreater(difference(self.folder / f"{name}.png", KEPT / f"{name}.png"), TOLERANCE)


if __name__ == "__main__":
    unittest.main()
