"""Shows that the checker of versions finds deprecated keys that are due to be removed, and other citations."""

import unittest

import check_version

ROWS = """\
  !> For example 'time | old | - | new | 0.1.0'.
  character(len=*), parameter, public :: deprecated_rows(*) = [character(len=120) :: &
    'time | settling | - | settle | 0.2.0', 'solver | threads | - | - | 0.3.1']
"""


class CheckVersion(unittest.TestCase):
    """Rows and versions."""

    def test_a_row_lasts_one_minor_version(self):
        """Patches of the version that warns first keep the row; the next minor version does not."""
        self.assertEqual(list(check_version.overdue(ROWS, "0.2.9")), [])
        found = list(check_version.overdue(ROWS, "0.3.0"))
        self.assertEqual(len(found), 1)
        self.assertIn("&time settling has warned since 0.2; remove its row", found[0])
        self.assertEqual(len(list(check_version.overdue(ROWS, "1.0.0"))), 2)

    def test_the_program_cites_as_the_file_does(self):
        """Title and year of CITATION.cff are in the citation of the program."""
        cff = 'title: "Implam: impact on plates"\ndate-released: 2026-11-26\n'
        self.assertEqual(list(check_version.differing_citation(cff, "Implam 0.1.0 (2026), impact on plates.")), [])
        found = list(check_version.differing_citation(cff, "Implam 0.1.0, impact on plates."))
        self.assertEqual(len(found), 1)
        self.assertIn("(2026)", found[0])


if __name__ == "__main__":
    unittest.main()
