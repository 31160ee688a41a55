"""Tests of the progress of long commands."""

import io
import unittest
from unittest.mock import patch

from implam_post.io.progress import Progress


class Terminal(io.StringIO):
    """A stream that is a terminal."""

    def isatty(self) -> bool:
        """Return True."""
        return True


class ProgressTest(unittest.TestCase):
    """Lines in a file, a bar on a terminal, and the remaining time from the mean so far."""

    def test_lines(self) -> None:
        """A line for each run, with the remaining time in all but the last, without control characters."""
        text = io.StringIO()
        with patch("time.monotonic", side_effect=[100.0, 130.0, 160.0, 190.0]), Progress(3, text) as progress:
            for number, failure in ((1, ""), (2, "broke"), (3, "")):
                progress.tick()
                progress.end_run(f"case {number}", failure)
        self.assertEqual(text.getvalue(), "[1/3] case 1: done, 01:00 left\n[2/3] case 2: broke, 00:30 left\n"
                         "[3/3] case 3: done\n")

    def test_bar(self) -> None:
        """The bar is updated, and failures are printed on separate lines."""
        text = Terminal()
        with Progress(4, text) as progress:
            progress.end_run("case 1")
            progress.end_run("case 2", "broke")
            progress.tick()
        parts = text.getvalue().split("\r")
        self.assertTrue(any("1/4" in part for part in parts))
        self.assertTrue(any(part.strip() == "case 2: broke" and part.endswith("\n") for part in parts), parts)
        self.assertTrue(any("2/4" in part and "1 failed" in part for part in parts))
        self.assertTrue(text.getvalue().endswith("\n"))

    def test_nothing_to_do(self) -> None:
        """Without runs there is no bar."""
        text = Terminal()
        with Progress(0, text) as progress:
            progress.tick()
        self.assertEqual(text.getvalue(), "")
