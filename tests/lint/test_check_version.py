"""Shows that the checker of versions finds other citations."""

import unittest

import check_version


class CheckVersion(unittest.TestCase):
    """Citations."""

    def test_the_program_cites_as_the_file_does(self):
        """Title and year of CITATION.cff are in the citation of the program."""
        cff = 'title: "Implam: impact on plates"\ndate-released: 2026-11-26\n'
        self.assertEqual(list(check_version.differing_citation(cff, "Implam 0.1.0 (2026), impact on plates.")), [])
        found = list(check_version.differing_citation(cff, "Implam 0.1.0, impact on plates."))
        self.assertEqual(len(found), 1)
        self.assertIn("(2026)", found[0])


if __name__ == "__main__":
    unittest.main()
