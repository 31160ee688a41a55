"""Shows that the checker of words finds them at their positions, and nothing else."""

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
    """Words, names and public names."""

    def test_words_are_found_in_comments_strings_and_names(self):
        """Words are found alone or between underscores; parts of names are refused only in code."""
        self.assertEqual(
            found(CODE, "good.f90"),
            [(1, "tells"), (3, "crowd"), (3, "most"), (4, "he"), (4, "settled"), (5, "haste")],
        )

    def test_words_inside_others_pass(self):
        """Only whole words count."""
        self.assertEqual(found("The header shows how the theory was untested; almost settled.", "page.md"), [])

    def test_contractions_are_found(self):
        """Also with the doubled quotes of Fortran's strings."""
        text = "call fail(error, 'It isn''t there.') ! we can't"
        self.assertEqual([word for _, word in found(text, "good.f90")], ["isn''t", "can't"])

    def test_phrases_and_capitals_are_found(self):
        """A phrase is found in any case."""
        self.assertEqual(found("Lengths Of The Whole Plate.\nSeconds on the wall", "page.md"),
                         [(1, "Whole Plate"), (2, "on the wall")])  # fmt: skip

    def test_words_of_loads_and_histories_are_found(self):
        """Words for carrying, comparing and history variables."""
        self.assertEqual(found("! What the point remembers\n! A plate bears it, held against tests", "a.f90"),
                         [(1, "remembers"), (2, "bears"), (2, "held against")])  # fmt: skip

    def test_names_of_python_are_checked_outside_docstrings(self):
        """Docstrings may use everyday words that are refused in names."""
        self.assertEqual(found('"""A fall\nof much."""\nmuch = 1  # much\nrounds = "much"\n', "a.py"),
                         [(3, "much"), (4, "rounds")])  # fmt: skip

    def test_ledgers_and_places_have_their_terms(self):
        """Energies are recorded; positions are described by 'is'."""
        self.assertEqual(found("Booked energy leaves no trace.\na comma stands where a key is", "page.md"),
                         [(1, "Booked"), (1, "leaves no trace"), (2, "stands where")])  # fmt: skip
        self.assertEqual(found("handbook, bookmark; it stands alone", "page.md"), [])

    def test_everyday_words_of_tests_are_found(self):
        """Impacts, timers, paths and stress-free strains have their terms."""
        text = "! Strains that go without stress\n! A blow, by a stopwatch\n! Layers follow damage along a winding path"
        self.assertEqual(found(text, "a.f90"), [(1, "go without stress"), (2, "blow"), (2, "stopwatch"),
                                                (3, "follow damage"), (3, "winding path")])  # fmt: skip
        self.assertEqual(found("! Blowing winds follow a path; stop, watch.", "a.f90"), [])

    def test_advice_is_printed(self):
        """A breach has its replacement."""
        self.assertEqual(str(check_words.check_text("a tup", "page.md")[0]), "page.md:1: tup: impactor")

    def run_on(self, files):
        """Run the checker on a project of some files; return its exit code and what it prints."""
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                (Path(folder) / name).parent.mkdir(parents=True, exist_ok=True)
                (Path(folder) / name).write_text(text, encoding="utf-8")
            with contextlib.redirect_stdout(io.StringIO()) as printed:
                code = check_words.main([folder])
            return code, printed.getvalue()

    def test_a_breach_fails(self):
        """One word in a page, a deck or a script is a breach."""
        self.assertEqual(self.run_on({"doc/page.md": "Lag of damage.\n", "setup.sh": "true\n"}), (0, "0 breaches\n"))
        for name in ("doc/page.md", "input/small/deck.nml", "README.md", "setup.sh", ".ci/run", "packaging/a.def"):
            code, printed = self.run_on({name: "one\nhaste\n"})
            self.assertEqual((code, printed.split("\n")[0]), (1, f"{name}:2: haste: lag of damage"))

    def test_older_names_of_keys_pass(self):
        """A quoted older name that is still read is public."""
        self.assertEqual(found('if "scenes" in content:\n', "a.py"), [])


if __name__ == "__main__":
    unittest.main()
