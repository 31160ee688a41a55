"""Commands that read damaged NAME.h5: they draw, or end with one sentence, without a traceback.

The environment variable IMPLAM_SPOILT is the number of files (default 40); 400 take five minutes."""

import os
import random
import re
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

from implam_post.exchange import results
from implam_post.io.errors import FileError, ImplamError
from implam_post.io.fields import read_fields
from implam_post.io.history import read_columns
from implam_post.plot import command as plot
from implam_post.plot import movie, paraview
from tests.io.test_fields import write_fields
from tests.plot.test_pictures import DECK
from tests.program import run_quietly

# Words on the internals of libraries, which messages must not contain.
INTERNALS = re.compile(
    r"numpy|h5py|ufunc|dtype|array|attribute|subscript|synchronously|Unable to|Errno|NoneType|\bindex")
FILES = int(os.environ.get("IMPLAM_SPOILT", "40"))


def spoil(data: bytes, stream: random.Random) -> bytes:
    """Return a truncated file, or one with some bytes or a section replaced."""
    kind = stream.randrange(4)
    if kind == 0:
        return data[:stream.randrange(len(data))]
    spoilt = bytearray(data)
    if kind == 1:
        first = stream.randrange(len(data))
        spoilt[first:first + 512] = bytes(min(512, len(data) - first))
    for _ in range(stream.choice((1, 8, 64)) if kind > 1 else 0):
        spoilt[stream.randrange(len(data))] = stream.randrange(256)
    return bytes(spoilt)


class DamagedFilesTest(unittest.TestCase):
    """Files with random damage, the same in each test run."""

    def test_spoilt_bytes(self) -> None:
        """Each command succeeds or ends with one sentence."""
        stream = random.Random(1)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "case.h5"
            write_fields(path, "whole")
            with h5py.File(path, "a") as file:
                file["provenance/deck"] = np.bytes_(DECK)
            data = path.read_bytes()
            for number in range(FILES):
                path.write_bytes(spoil(data, stream))
                with self.subTest(number):
                    try:
                        read_fields(path)
                        commands = (plot.main, movie.main, paraview.main)
                    except FileError as error:
                        self.assertEqual(len(str(error).splitlines()), 1, error)
                        self.assertNotRegex(str(error), INTERNALS)
                        commands = (plot.main,)
                    for command in commands if number % 8 == 0 else ():
                        code, printed = run_quietly(command, path)
                        self.assertIn(code, (0, 1, 2, 4), printed)
                        self.assertNotIn("Traceback", printed)
                    try:
                        results.read_panel(path)
                    except ImplamError as error:
                        self.assertEqual(len(str(error).splitlines()), 1, error)

    def test_arrays_of_other_sizes_and_kinds(self) -> None:
        """Values that are not numbers, of wrong length or out of range, or that do not form a plate, are reported."""
        faults = {"meshes/00000001/connectivity": -1, "meshes/00000001/cells/first_ply": 0,
                  "meshes/00000001/coordinates": np.nan, "times/00000002/cells/delaminated_above": np.inf,
                  "times/00000002/time": np.nan, "times/00000001/mesh": 7}
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "case.h5"
            for name, value in faults.items():
                write_fields(path)
                with self.subTest(name), h5py.File(path, "a") as file:
                    file[name][...] = value
                with self.assertRaisesRegex(FileError, "damaged"):
                    read_fields(path)
            for name in ("times/00000003/cells/ply_3_failure", "meshes/00000001/cells/last_ply"):
                write_fields(path)
                with h5py.File(path, "a") as file:
                    del file[name]
                    file[name] = np.zeros(3)
                with self.subTest(name), self.assertRaisesRegex(FileError, "damaged"):
                    read_fields(path)

    def test_members_of_other_kinds(self) -> None:
        """With a text, a group, an empty list or nothing instead of each member: fields, or a plain message."""
        with tempfile.TemporaryDirectory() as folder:
            path, names = Path(folder) / "case.h5", []
            write_fields(path)
            with h5py.File(path) as file:
                file.visit(names.append)
            for name in names:
                for kind, value in (("text", np.bytes_("x")), ("empty", np.zeros(0)), ("group", None),
                                    ("nothing", None)):
                    write_fields(path)
                    with h5py.File(path, "a") as file:
                        del file[name]
                        if kind == "group":
                            file.create_group(name)
                        elif kind != "nothing":
                            file[name] = value
                    with self.subTest(name=name, kind=kind):
                        try:
                            read_fields(path)
                        except FileError as error:
                            self.assertNotRegex(str(error), INTERNALS)
                            if kind == "nothing" and name.endswith("time"):
                                self.assertIn("(it has no time)", str(error))

    def test_cells_that_are_no_plate(self) -> None:
        """A moved point (cells without plies) and a missing ply are reported by the export of panels."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "case.h5"
            for name, place, value in (("coordinates", (0, 0), 0.5), ("cells/last_ply", 0, 1)):
                write_fields(path, "whole")
                with self.subTest(name), h5py.File(path, "a") as file:
                    file["provenance/deck"] = np.bytes_(DECK)
                    file[f"meshes/00000001/{name}"][place] = value
                with self.assertRaisesRegex(FileError, "do not form a plate of 3 plies"):
                    results.read_panel(path)

    def test_histories(self) -> None:
        """A truncated or damaged row is reported with its line, in plain words."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "case_history.csv"
            for rows, expected in (("0,1\n1,\n", "a cell in line 4 that is not a number"),
                               ("0,1\n1,2\n\n2\n", "1 cells under 2 names in line 6"),
                               ("0,1\n1,2.5e-", "is truncated in line 4"),
                               ("0,1\n1,2", "is truncated in line 4, which has no end of line"),
                               ("", "has no rows")):
                path.write_text(f"# a comment\ntime, force\n{rows}", encoding="utf-8")
                with self.subTest(rows), self.assertRaisesRegex(FileError, expected):
                    read_columns(path)


if __name__ == "__main__":
    unittest.main()
