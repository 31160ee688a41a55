"""Shows that the checker of recipes accepts those of the project and finds each kind of difference."""

import shutil
import tempfile
import unittest
from pathlib import Path

import check_recipes

ROOT = Path(__file__).resolve().parents[2]
FILES = ("setup.sh", "CMakeLists.txt", "cmake/ImplamDependencies.cmake", "packaging/implam.def", check_recipes.SPACK)


class RecipesTest(unittest.TestCase):
    """Changes copies of the files."""

    def breaches(self, name="setup.sh", old="", new=""):
        """Sentences on a copy of the project in which a text of a file is replaced."""
        with tempfile.TemporaryDirectory() as folder:
            for path in FILES:
                Path(folder, path).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(ROOT / path, Path(folder, path))
            text = Path(folder, name).read_text(encoding="utf-8")
            self.assertIn(old, text)
            Path(folder, name).write_text(text.replace(old, new) if old else text, encoding="utf-8")
            return list(check_recipes.breaches(Path(folder)))

    def test_project(self):
        """The recipes of the project agree with its build."""
        self.assertEqual(self.breaches(), [])

    def test_packages(self):
        """A package that only one of both installs is found."""
        self.assertIn("libmetis-dev is in setup.sh only", self.breaches("packaging/implam.def", "libmetis-dev ")[0])
        self.assertIn("ninja-build is in the definition only", self.breaches("setup.sh", "ninja-build ")[0])

    def test_versions(self):
        """Other versions of PETSc and CMake, and invalid Python, are found."""
        later = self.breaches("cmake/ImplamDependencies.cmake", "EQUAL 3.23", "EQUAL 3.24")
        self.assertIn("no petsc@3.18:3.23", later[0])
        self.assertIn("no cmake@3.27:", self.breaches("CMakeLists.txt", "VERSION 3.25", "VERSION 3.27")[0])
        self.assertIn(check_recipes.SPACK, self.breaches(check_recipes.SPACK, "class Implam(", "class (")[0])


if __name__ == "__main__":
    unittest.main()
