"""Tests of the replacement of files."""

import errno
import re
import tempfile
import unittest
from pathlib import Path

from implam_post.io.errors import FileError
from implam_post.io.files import read_deck_text, replaced, write_text

PACKAGE = Path(__file__).parents[2] / "implam_post"

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

    def test_a_device_is_written_itself(self) -> None:
        """A file that is no regular file is neither replaced nor removed; a folder is reported."""
        write_text(Path("/dev/null"), "text")
        self.assertTrue(Path("/dev/null").is_char_device())
        with tempfile.TemporaryDirectory() as folder:
            self.assertRaises(FileError, write_text, Path(folder), "text")

    def test_characters_of_decks(self) -> None:
        """Decks in UTF-8 and in Latin 1 are read as the program reads them; bytes of no text are refused."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "deck.nml"
            for data, text in ((b"! Pr\xfcfung\r\n", "! Prüfung\n"), ("\ufeff! Prüfung".encode(), "! Prüfung")):
                path.write_bytes(data)
                self.assertEqual(read_deck_text(path), text)
            path.write_bytes(b"&case /\n\0")
            with self.assertRaisesRegex(FileError, "it is not a text file"):
                read_deck_text(path)

    def test_all_results_are_replaced(self) -> None:
        """No result is written under its own name, where a full disk would leave an empty file or a part of it."""
        for path in sorted(PACKAGE.rglob("*.py")):
            for line in path.read_text(encoding="utf-8").splitlines():
                if re.search(r"\b(savefig|write_bytes)\(|\.(save|write_text)\(|h5py\.File\([^)]*\"w\"", line):
                    with self.subTest(path.name, line=line.strip()):
                        self.assertRegex(line, r"\((draft|stream)\b|\bdraft\.write_|backing_store=False")


if __name__ == "__main__":
    unittest.main()
