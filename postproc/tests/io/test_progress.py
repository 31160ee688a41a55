"""Tests of the progress that long commands show."""

import io
import unittest
from unittest.mock import patch

from implam_post.io.progress import Progress, duration


class Terminal(io.StringIO):
    """Text that says it is a terminal."""

    def isatty(self) -> bool:
        """Say so."""
        return True


class ProgressTest(unittest.TestCase):
    """Lines in a file, a bar on a terminal, and the time left by the mean so far."""

    def test_lines(self) -> None:
        """A line a run, the time left in all but the last, no control characters."""
        text = io.StringIO()
        with patch("time.monotonic", side_effect=[100.0, 130.0, 160.0, 190.0]), Progress(3, text) as progress:
            for number, failure in ((1, ""), (2, "broke"), (3, "")):
                progress.tick()
                progress.end_run(f"case {number}", failure)
        self.assertEqual(text.getvalue(), "[1/3] case 1: done, 60 s left\n[2/3] case 2: broke, 30 s left\n"
                         "[3/3] case 3: done\n")

    def test_bar(self) -> None:
        """The bar fills, and failures stand in lines of their own."""
        text = Terminal()
        with Progress(4, text) as progress:
            progress.end_run("case 1")
            progress.end_run("case 2", "broke")
        parts = text.getvalue().split("\r")
        self.assertIn("[######..................] 1/4, 0.0 s left", parts[2])
        self.assertEqual((parts[3].rstrip(), parts[3][-1]), ("case 2: broke", "\n"))
        self.assertIn("[############............] 2/4, 1 failed", parts[4])
        self.assertTrue(parts[-1].endswith("\n"))

    def test_no_wider_than_the_terminal(self) -> None:
        """A bar that doesn't fit is cut, and covers what stood there before."""
        text = Terminal()
        with patch("shutil.get_terminal_size", return_value=type("Size", (), {"columns": 20})), Progress(2, text):
            pass
        self.assertEqual([len(part) for part in text.getvalue().strip("\n").split("\r")[1:]], [19])

    def test_durations(self) -> None:
        """Seconds, minutes, hours."""
        self.assertEqual([duration(seconds) for seconds in (0.26, 99, 150, 5990, 7320)],
                         ["0.3 s", "99 s", "2 min", "1 h 40 min", "2 h 2 min"])
