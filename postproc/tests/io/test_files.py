"""Tests of the replacement of files."""

import errno
import tempfile
import unittest
from pathlib import Path

from implam_post.io.errors import FileError
from implam_post.io.files import replaced, write_text


class FilesTest(unittest.TestCase):
    """A file is replaced as a whole or not at all."""

    def test_failures_leave_nothing(self) -> None:
        """A full disk, and any other failure: the old file stays, without a draft."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "page.html"
            write_text(path, "old")
            for failure, expected in ((OSError(errno.ENOSPC, "no space"), FileError), (ValueError("x"), ValueError)):
                with self.assertRaises(expected), replaced(path) as draft:
                    draft.write_text("half")
                    raise failure
                self.assertEqual([found.name for found in Path(folder).iterdir()], ["page.html"])
            self.assertEqual(path.read_text(), "old")


if __name__ == "__main__":
    unittest.main()
