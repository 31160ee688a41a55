"""Tests of runs with random inputs: statistics, pairs of variants, and lost results."""

import csv
import json
import shutil
import statistics
import tempfile
import unittest
from pathlib import Path

from implam_post.report import command as report
from implam_post.sweep import command as sweep
from tests.program import SMALL, implam, run_quietly
from tests.report.test_runs_report import Page

SWEEP = """
deck = "damage.nml"
measured = "expect.toml"
[scatter]
number = 4
[variants]
"as it is" = {}
"the same" = { "delamination.below_ply" = 2 }
"brittle" = { "delamination.G_c" = 250 }
"""
EXPECT = """
[[expect]]
quantity = "peak_force"
value = 1062
relative = 0.3
[[expect]]
quantity = "l2_force"
against = "measured.csv"
value = 0
absolute = 0.2
"""


class ScatterTest(unittest.TestCase):
    """A small deck, four runs of three variants."""

    def setUp(self) -> None:
        """Write the deck, a measured curve and the sweep."""
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        shutil.copy(SMALL / "damage.nml", self.folder)
        (self.folder / "expect.toml").write_text(EXPECT)
        (self.folder / "measured.csv").write_text("time,force\n0,0\n100e-6,500\n240e-6,1050\n")
        self.path, self.output = self.folder / "sweep.toml", self.folder / "out"
        self.path.write_text(SWEEP)

    def sweep(self) -> str:
        """Run the sweep; return its output."""
        code, text = run_quietly(sweep.main, self.path, "--output", self.output, "--program", implam(), "--jobs", 2)
        self.assertEqual(code, 0, text)
        return text

    def rows(self, name: str) -> list[dict[str, str]]:
        """Return the rows of a table."""
        with (self.output / name).open(newline="") as file:
            return list(csv.DictReader(file))

    def test_statistics_pairs_and_page(self) -> None:
        """Means are those of the summaries; equal variants have equal runs, a brittle interface differs."""
        text = self.sweep()
        summaries = [json.loads((self.output / row["folder"] / "damage_summary.json").read_text())
                     for row in self.rows("table.csv")]
        found = {(row["group"], row["figure"]): row for row in self.rows("statistics.csv")}
        for group, runs in (("as it is", summaries[:4]), ("brittle", summaries[8:])):
            for figure in ("peak_force", "projected_area", "energy_delamination"):
                values, row = [run[figure] for run in runs], found[group, figure]
                self.assertAlmostEqual(float(row["mean"]) / statistics.mean(values), 1, delta=1e-12)
                self.assertAlmostEqual(float(row["deviation"]) / statistics.stdev(values), 1, delta=1e-9)
                self.assertEqual((float(row["low_5"]), float(row["high_95"])), (min(values), max(values)))
        self.assertEqual(found["as it is", "area_below_2"]["runs"], "4")
        self.assertEqual(found["as it is", "damage_diameter"]["dimension"], "length")
        pairs = {(row["group"], row["figure"]): row for row in self.rows("differences.csv")}
        self.assertEqual({row["differs"] for (group, _), row in pairs.items() if group == "the same"}, {"0"})
        self.assertEqual(float(pairs["the same", "peak_force"]["difference"]), 0)
        self.assertEqual(pairs["brittle", "projected_area"]["differs"], "1")
        self.assertGreater(float(pairs["brittle", "projected_area"]["difference"]), 0)
        held = {(row["group"], row["figure"]): row for row in self.rows("measured.csv")}
        self.assertEqual(held["as it is", "peak_force"]["within"], "1")
        self.assertLess(float(held["as it is", "l2_force measured.csv"]["mean"]), 0.2)
        band = [row for row in self.rows("force_band.csv") if row["group"] == "as it is"]
        self.assertTrue(all(float(row["low_5"]) <= float(row["mean"]) <= float(row["high_95"]) for row in band))
        self.assertIn("brittle compared with as it is, pairs of runs with the same random inputs", text)
        self.assertIn("symmetry", text)
        self.page(summaries)

    def page(self, summaries: list[dict]) -> None:
        """The page has the means, the pictures and the sources of the coefficients of variation."""
        code, text = run_quietly(report.main, self.output)
        self.assertEqual((code, Path(text.strip()).name), (0, "out_report.html"), text)
        page = Page(Path(text.strip()).read_text(encoding="utf-8"))
        self.assertEqual((page.open, page.references), ([], []))
        mean = statistics.mean(summary["peak_force"] for summary in summaries[:4])
        self.assertIn(f"{mean / 1e3:.4g} kN", page.cells)
        self.assertEqual(set(page.pictures), {"Force history", "Fraction of runs with delamination"})
        self.assertIn("material.YT", page.cells)
        self.assertIn("Comparison of variants", page.text)
        self.assertIn("CMH-17-1G", page.text)
        (self.output / "statistics.json").write_text("{}")
        code, text = run_quietly(report.main, self.output)
        self.assertEqual((code, len(text.splitlines())), (4, 1), text)

    def test_unreadable_measurement(self) -> None:
        """The measured curve is read before the first run."""
        self.path.write_text(SWEEP.replace("expect.toml", "measured.csv"))
        (self.folder / "measured.csv").write_bytes(b"\xff\xfe\x00")
        code, text = run_quietly(sweep.main, self.path, "--output", self.output, "--program", implam())
        self.assertEqual((code, self.output.exists()), (4, False), text)
        self.assertIn("measured.csv cannot be read: it is not a text file", text)

    def test_lost_runs(self) -> None:
        """A run with emptied results is run again, others are not, and all tables are as before."""
        self.sweep()
        before = (self.output / "statistics.csv").read_text()
        self.assertIn("12 cases, 0 decks to run", self.sweep())
        next(iter(self.output.glob("cases/*/damage_history.csv"))).write_text("")
        self.assertIn("12 cases, 1 deck to run", self.sweep())
        self.assertEqual((self.output / "statistics.csv").read_text(), before)
        first = self.output / self.rows("table.csv")[0]["folder"] / "damage.h5"
        first.write_bytes(b"no fields")
        self.assertRegex(self.sweep(), "note: case 1 is omitted from the statistics: "
                         ".*damage.h5 is not a file of fields")
        self.assertEqual(self.rows("statistics.csv")[0]["runs"], "3")


if __name__ == "__main__":
    unittest.main()
