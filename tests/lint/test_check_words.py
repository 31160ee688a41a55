"""Shows that the checker of words finds them where they stand, and nothing else."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import check_words

CODE = """\
!> What the history tells of a plate; &time settle is a key.
module good
  integer, parameter :: most_steps = 3, limit = len('a crowd')
  real :: key_settle, text_at_least, settled_force ! he
  call text%haste(central%settle, least_squares)
end module good
"""


def found(text, name):
    """Lines and words of the breaches of a text."""
    return [(breach.line, breach.word) for breach in check_words.check_text(text, name)]


class CheckWords(unittest.TestCase):
    """Words, names, public names and the list."""

    def test_words_are_found_in_comments_strings_and_names(self):
        """Words stand alone or between underscores; parts of names are refused in code alone."""
        self.assertEqual(
            found(CODE, "good.f90"),
            [(1, "tells"), (3, "crowd"), (3, "most"), (4, "he"), (4, "settled"), (5, "haste")],
        )

    def test_words_inside_others_pass(self):
        """Only whole words count."""
        self.assertEqual(found("The header shows how the theory was untested; almost settled.", "page.md"), [])

    def test_phrases_and_capitals_are_found(self):
        """A phrase is found in any case."""
        self.assertEqual(found("Lengths Of The Whole Plate.\nSeconds on the wall", "page.md"),
                         [(1, "Whole Plate"), (2, "on the wall")])  # fmt: skip

    def test_names_of_python_are_checked_outside_docstrings(self):
        """Prose in docstrings may use everyday words that are no names."""
        self.assertEqual(found('"""A fall\nof much."""\nmuch = 1  # much\nrounds = "much"\n', "a.py"),
                         [(3, "much"), (4, "rounds")])  # fmt: skip

    def test_advice_is_printed(self):
        """A breach says what to write instead."""
        self.assertEqual(str(check_words.check_text("a tup", "page.md")[0]), "page.md:1: tup: impactor")

    def run_on(self, text, allowed, *options):
        """Run the checker on a project of one page; return its exit code, what it prints, and the list after it."""
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "doc").mkdir()
            (root / "doc/page.md").write_text(text, encoding="utf-8")
            (root / "list").write_text(allowed, encoding="utf-8")
            with contextlib.redirect_stdout(io.StringIO()) as printed:
                code = check_words.main([str(root), "--list", str(root / "list"), *options])
            return code, printed.getvalue(), (root / "list").read_text(encoding="utf-8")

    def test_the_list_allows_no_more_than_it_says(self):
        """As many breaches as listed pass; one more fails."""
        self.assertEqual(self.run_on("haste\nhaste\n", "# files\n2 doc/page.md\n")[0], 0)
        code, printed, _ = self.run_on("haste\nhaste\n", "# files\n1 doc/page.md\n")
        self.assertEqual(code, 1)
        self.assertIn("doc/page.md:2: haste: lag of damage", printed)
        self.assertEqual(self.run_on("haste\n", "# files\n")[0], 1)

    def test_numbers_of_the_list_only_become_smaller(self):
        """Writing the list lowers a number, keeps one that is passed, and drops files without breaches."""
        self.assertEqual(self.run_on("haste\n", "# files\n3 doc/page.md\n4 doc/gone.md\n", "--write")[2],
                         "# files\n1 doc/page.md\n")  # fmt: skip
        kept = "# files\n1 doc/page.md\n"
        self.assertEqual(self.run_on("haste\nhaste\n", kept, "--write")[2], kept)


if __name__ == "__main__":
    unittest.main()
