"""Tests of studies with runs of the program: errors, costs, failures, and a killed study."""

import csv
import json
import math
import shutil
import signal
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np

from implam_post.io.history import History, read_history
from implam_post.io.quantities import peak
from implam_post.study import command as study
from tests.decks import KARAS
from tests.program import ROOT, implam, run, run_quietly, start

STEPS = """
deck = "karas.nml"
repeats = 2
error = "peak_force"
[grid]
"impactor.integrator" = ["trapezoidal", "conserving"]
"time.step" = [8e-6, 4e-6]
[reference]
"impactor.integrator" = "trapezoidal"
"time.step" = 0.5e-6
"""
PATIENCE = 120  # seconds


class StudyTest(unittest.TestCase):
    """Each test has a folder with Karas' deck on a coarse mesh; a wrapper of the program logs its calls."""

    def setUp(self) -> None:
        """Make the folder."""
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "karas.nml").write_text(KARAS.replace("20, 20", "6, 6").replace("'simple'",
                                                                                       "'simple' symmetry='quarter'"))
        self.output, self.program, self.calls = (self.folder / name for name in ("out", "noting", "calls.txt"))
        self.program.write_text(f'#!/bin/sh\necho "$@" >> {self.calls}\nexec {implam()} "$@"\n')
        self.program.chmod(0o755)

    def arguments(self, text: str, *more: object) -> list[str]:
        """Write the file of a study and return the arguments to run it."""
        path = self.folder / "study.toml"
        path.write_text(text)
        return [str(word) for word in (path, "--output", self.output, "--program", self.program, *more)]

    def runs(self) -> int:
        """Return how many runs were started."""
        lines = self.calls.read_text().splitlines() if self.calls.exists() else []
        return sum(line.startswith("run ") for line in lines)

    def table(self) -> list[dict[str, str]]:
        """Return the rows of the table."""
        with (self.output / "table.csv").open(newline="") as file:
            return list(csv.DictReader(file))

    def histories(self) -> dict[str, History]:
        """Return the histories of the first runs by step and integrator of their decks."""
        found = {}
        for deck in sorted(self.output.glob("cases/*/karas.nml")):
            text = deck.read_text()
            if "_" not in deck.parent.name:
                key = f"{text.split('step=')[1].split()[0]} {text.split('integrator=')[1].split()[0]}"
                found[key] = read_history(deck.parent / "karas_history.csv")
        return found

    def test_errors_costs_and_front(self) -> None:
        """Errors are those of the histories and decrease with the step; costs are given; no run is repeated."""
        arguments = self.arguments(STEPS, "--format", "svg")
        code, text = run_quietly(study.main, *arguments)
        self.assertEqual(code, 0, text)
        rows, histories = self.table(), self.histories()
        self.assertEqual((len(rows), self.runs()), (4, 9))
        true = histories["5e-07 'trapezoidal'"]
        for row in rows:
            mine = histories[f"{float(row['time.step'])} '{row['impactor.integrator'].strip(chr(39))}'"]
            force = np.interp(true.time, np.append(0, mine.time), np.append(0, mine["force"]))
            error = math.sqrt(np.sum((force - true["force"])**2) / np.sum(true["force"]**2))
            self.assertAlmostEqual(float(row["force_history_error"]) / error, 1, delta=0.02)
            self.assertEqual(float(row["steps"]), len(mine.time))
            self.assertGreater(float(row["cpu_time_median"]), 0)
            self.assertGreaterEqual(float(row["cpu_time_median"]), float(row["cpu_time_min"]))
            self.assertEqual(row["repeats"], "2")
        for coarse, fine in ((rows[0], rows[1]), (rows[2], rows[3])):
            # Both integrators are of second order: half the step length gives a quarter of the error.
            ratio = float(coarse["force_history_error"]) / float(fine["force_history_error"])
            self.assertTrue(2.5 < ratio < 6, ratio)
        self.assertEqual({row["front"] for row in rows} - {"0"}, {"1"})
        self.assertIn("| impactor.integrator | time.step ", (self.output / "table.txt").read_text())
        self.assertGreater((self.output / "front.svg").stat().st_size, 10000)
        self.assertEqual((run_quietly(study.main, *arguments)[0], self.runs()), (0, 9))

    def test_semi_analytic_and_measured(self) -> None:
        """Karas' solution is 1343.24 N at 33.19 us; against a history of 1000 N the error is a third."""
        (self.folder / "measured.csv").write_text("time,force\n0,0\n30e-6,1000\n60e-6,0\n")
        code, text = run_quietly(study.main, *self.arguments("""
            deck = "karas.nml"
            [problems]
            problem = ["analytical", "measured"]
            reference = ["semi-analytic", "measured.csv"]
            "time.end" = "120e-6"
            [grid]
            "time.step" = [1e-6]
            """))
        self.assertEqual(code, 0, text)
        analytical, measured = self.table()
        self.assertEqual(self.runs(), 1)  # both problems have the same deck
        deck, = self.output.glob("cases/*/karas.nml")
        top = peak(read_history(deck.parent / "karas_history.csv"), "force")
        summary = json.loads((deck.parent / "karas_summary.json").read_text())
        for column, member in (("peak_force", "peak_force"), ("peak_force_time", "peak_force_at")):
            self.assertEqual(analytical[column], f"{summary[member]:.8g}")
        self.assertAlmostEqual(top.value / (1 + float(analytical["peak_force_error"])), 1343.24, delta=0.3)
        self.assertAlmostEqual(top.time / (1 + float(analytical["peak_force_time_error"])), 33.19e-6, delta=0.1e-6)
        self.assertAlmostEqual(float(measured["peak_force_error"]), top.value / 1000 - 1, delta=1e-6)
        self.assertEqual(measured["rebound_velocity_error"], "")
        self.assertIn("Geometric means over 2 problems", text)

    def test_failures_are_collected(self) -> None:
        """A method without convergence has a row with the reason, other rows are complete."""
        shutil.copy(ROOT / "input" / "small" / "ply_damage.nml", self.folder)
        code, text = run_quietly(study.main, *self.arguments("""
            deck = "ply_damage.nml"
            [list]
            "solver.max_iterations" = [1, 30]
            "solver.tolerance" = [1e-13, 1e-6]
            [reference]
            "solver.tolerance" = 1e-8
            """))
        self.assertEqual(code, 1, text)
        self.assertIn("1 of 3 cases failed:\n  case 1 ", text)
        failed, fine = self.table()
        self.assertTrue(failed["end"].startswith("ended with 3: "), failed)
        self.assertEqual((failed["peak_force_error"], fine["end"]), ("", ""))
        self.assertLess(abs(float(fine["peak_force_error"])), 1e-3)

    def test_results_that_cannot_be_read(self) -> None:
        """A trial with a damaged history is counted, and the exit code is not 0."""
        arguments = self.arguments(STEPS)
        self.assertEqual(run_quietly(study.main, *arguments)[0], 0)
        (self.output / self.table()[0]["folder"] / "karas_history.csv").write_text("time,force\n0,zero\n")
        code, text = run_quietly(study.main, *arguments, "--table")
        self.assertEqual(code, 1, text)
        self.assertIn("1 of 4 trials cannot be evaluated; see the notes.\n", text)
        self.assertEqual([row["peak_force"] == "" for row in self.table()], [True, False, False, False])

    def test_killed(self) -> None:
        """A killed study continues: completed runs are not repeated."""
        with start("study", *self.arguments(STEPS)) as process:
            latest = time.monotonic() + PATIENCE
            while len(self.ended()) < 3 and time.monotonic() < latest:
                time.sleep(0.005)
            process.send_signal(signal.SIGKILL)
        ended = self.ended()
        self.assertTrue(3 <= len(ended) < 9, ended)
        code, text = run("study", *self.arguments(STEPS))
        self.assertEqual(code, 0, text)
        self.assertEqual(len(self.ended()), 9)
        calls = self.calls.read_text().splitlines()
        for name in ended:
            self.assertEqual(sum(line.startswith("run ") and line.endswith(f"/{name}") for line in calls), 1, calls)
        self.assertEqual({row["repeats"] for row in self.table()}, {"2"})

    def ended(self) -> list[str]:
        """Return the folders of runs that have ended with a result."""
        return [path.parent.name for path in self.output.glob("cases/*/run.json")
                if json.loads(path.read_text())["exit_code"] == 0]
