"""Tests that the check of the tests' folders can fail."""

import tempfile
import unittest
from pathlib import Path

from check_test_folders import breaches


class Breaches(unittest.TestCase):
    """Breaches in a small tree."""

    def found(self, **files):
        """Breaches of a tree with these files; in their names two underscores replace a slash and the last part is the
        type."""
        with tempfile.TemporaryDirectory() as name:
            for path, text in files.items():
                place = Path(name, *path.split("__")[:-1]).with_suffix("." + path.split("__")[-1])
                place.parent.mkdir(parents=True, exist_ok=True)
                place.write_text(text, encoding="utf-8")
            return list(breaches(Path(name)))

    def test_folders(self):
        """Tests are in the folder of the modules that they use, directly or by a helper."""
        source = {"src__plate__shapes__f90": "module shapes\nend module shapes\n",
                  "src__mesh__cells__f90": "module cells\nend module cells\n",
                  "tests__unit__mesh__test_cells__pf": "  use cells, only: cell_t\n"}
        self.assertEqual(self.found(**source), ["tests/unit/plate: there is no test of src/plate"])
        source["tests__unit__plate__test_shapes__pf"] = "  use cells, only: cell_t\n"
        self.assertEqual(self.found(**source), ["tests/unit/plate/test_shapes.pf: uses no module of src/plate"])
        source["tests__unit__plate__test_shapes__pf"] = "  use small_plates, only: plate\n"
        source["tests__support__small_plates__f90"] = "module small_plates\n  use shapes, only: shape\nend module\n"
        self.assertEqual(self.found(**source), [])


if __name__ == "__main__":
    unittest.main()
