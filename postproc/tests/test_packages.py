"""Tests of the imports between packages, and that the top package imports no large library."""

import ast
import unittest
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1] / "implam_post"
# Allowed imports of each package.
ALLOWED = {
    "io": set(),
    "laminate": {"io"},
    "exchange": {"io", "laminate"},
    "plot": {"io", "laminate"},
    "reference": {"io", "laminate", "plot"},
    "regress": {"io", "plot", "reference"},
    "sweep": {"io", "plot", "regress"},
    "study": {"io", "plot", "reference", "sweep"},
    "report": {"io", "plot", "sweep"},
}


def imported(path: Path) -> set[str]:
    """Return the packages of implam_post that a module imports, anywhere in it."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names = [node.module] if isinstance(node, ast.ImportFrom) else [alias.name for alias in node.names] if (
            isinstance(node, ast.Import)) else []
        found |= {name.split(".")[1] for name in names if name and name.startswith("implam_post.")}
    return found


class Packages(unittest.TestCase):
    """Imports between packages."""

    def test_imports_are_allowed(self) -> None:
        """Each package imports exactly the allowed packages."""
        for name, allowed in ALLOWED.items():
            with self.subTest(package=name):
                found = set().union(*map(imported, (PACKAGE / name).glob("*.py"))) - {name}
                self.assertEqual(found, allowed)

    def test_allowed_imports_have_no_cycle(self) -> None:
        """Imports have no cycle."""
        left = {name: set(allowed) for name, allowed in ALLOWED.items()}
        while left:
            free = {name for name, allowed in left.items() if not allowed}
            self.assertTrue(free, f"a cycle among {', '.join(left)}")
            left = {name: allowed - free for name, allowed in left.items() if name not in free}

    def test_every_package_is_listed(self) -> None:
        """All folders are in the table, and each package has a docstring."""
        folders = {path.parent.name for path in PACKAGE.glob("*/__init__.py")}
        self.assertEqual(folders, ALLOWED.keys())
        for name in folders:
            text = (PACKAGE / name / "__init__.py").read_text(encoding="utf-8")
            self.assertGreater(len(ast.get_docstring(ast.parse(text))), 60)
