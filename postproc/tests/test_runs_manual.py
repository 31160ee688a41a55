"""Run the worked examples of the manual and compare with the figures in it."""

import csv
import re
import shutil
import tempfile
import unittest
from pathlib import Path

from implam_post.regress import command as regress
from implam_post.study import command as study
from implam_post.sweep import command as sweep
from implam_post.sweep.plan import COLUMNS
from tests.program import ROOT, SMALL, implam, run_quietly

# Rounding of figures in the manual.
TOLERANCE = 2e-3


class ManualTest(unittest.TestCase):
    """Each test has a folder and runs the first TOML of a page."""

    def setUp(self) -> None:
        """Make the folder."""
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def write_example(self, page: str, deck: str, name: str, decks: Path = SMALL) -> str:
        """Write the example of a page to the folder of its deck; return the text of the page."""
        text = (ROOT / "doc" / "manual" / page).read_text(encoding="utf-8")
        shutil.copy(decks / deck, self.folder)
        (self.folder / name).write_text(re.search(r"^```toml\n(.*?)^```", text, re.DOTALL | re.MULTILINE)[1])
        return text

    def test_sweep(self) -> None:
        """The table has the rows and figures of the page."""
        text = self.write_example("sweeps.md", "damage.nml", "energies.toml")
        code, said = run_quietly(sweep.main, self.folder / "energies.toml", "--program", implam(), "--jobs", 2)
        self.assertEqual(code, 0, said)
        lines = re.search(r"^\| laminate\.angles \|.*?\n\n", text, re.DOTALL | re.MULTILINE)[0].strip().splitlines()
        cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
        with (self.folder / "energies" / "table.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(cells) - 2)
        for row, expected in zip(rows, cells[2:], strict=True):
            self.assertEqual(row["laminate.angles"], expected[0])
            for name, value in list(zip(cells[0], expected, strict=True))[1:]:
                self.assertAlmostEqual(float(row[name]) / float(value), 1, delta=TOLERANCE, msg=f"{expected} {name}")
        described = set(re.findall(r"`(\w+)`", text[text.index("## The table"):]))
        self.assertEqual(set(COLUMNS) - described, set())

    def test_regression(self) -> None:
        """The example passes, and the printed lines are those of the page: names, expected values, verdicts."""
        text = self.write_example("regression.md", "ply_damage.nml", "ply_damage.toml")
        code, said = run_quietly(regress.main, self.folder, "--program", implam(), "--output", self.folder / "runs")
        self.assertEqual((code, said.count(" pass")), (0, 4), said)
        heading, *lines, total = re.search(r"^```text\n(.*?)\n```", text, re.DOTALL | re.MULTILINE)[1].splitlines()
        printed = [line.split() for line in said.splitlines()]
        self.assertIn(heading.split(), printed)
        self.assertIn(total.split(), printed)
        self.assertEqual([[*words[:3], words[-1]] for words in map(str.split, lines)],
                         [[*words[:3], words[-1]] for words in printed if words[-1:] == ["pass"]])

    def test_study(self) -> None:
        """The table has the rows and figures of the page, errors to .02 %."""
        text = self.write_example("studies.md", "karas.nml", "steps.toml", ROOT / "input" / "verify")
        code, said = run_quietly(study.main, self.folder / "steps.toml", "--program", implam())
        self.assertEqual(code, 0, said)
        expected, found = (_rows(re.search(r"^\| impactor\.integrator.*?\n\n", page, re.DOTALL | re.MULTILINE)[0])
                       for page in (text, said))
        self.assertEqual(len(expected), 6)
        for row, mine in zip(expected, found, strict=True):
            for name, value in row.items():
                if name.endswith("%"):
                    self.assertAlmostEqual(float(mine[name]), float(value), delta=0.02, msg=f"{row} {name}")
                else:
                    self.assertEqual(mine[name], value)


def _rows(table: str) -> list[dict[str, str]]:
    """Return the rows of a table in Markdown."""
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in table.strip().splitlines()]
    return [dict(zip(lines[0], line, strict=True)) for line in lines[2:]]
