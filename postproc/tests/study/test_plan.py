"""Tests of the file of a study: problems, methods, references, and errors."""

import tempfile
import unittest
from pathlib import Path

from implam_post.io.errors import DeckError
from implam_post.study.plan import SEMI_ANALYTIC, Study, read_study
from implam_post.sweep.plan import Case
from tests.decks import KARAS, SUN_CHEN
from tests.program import ROOT

METHODS = """
[grid]
part = [1, 4]
[list]
method = ["Gear", "rule"]
"impactor.integrator" = ["gear4", "trapezoidal"]
[derived]
"time.step" = "coarse/part"
"""
REFERENCE = '[reference]\npart = 64\n"impactor.integrator" = "conserving"\n'


class StudyPlanTest(unittest.TestCase):
    """Each test has a folder with two decks."""

    def setUp(self) -> None:
        """Make the folder."""
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "karas.nml").write_text(KARAS)
        (self.folder / "sun_chen.nml").write_text(SUN_CHEN)

    def read(self, text: str) -> Study:
        """Return the study of a file with this text."""
        path = self.folder / "study.toml"
        path.write_text(text)
        return read_study(path)

    def test_trials_and_references(self) -> None:
        """All problems with all methods, references first, repeats last; derived steps depend on problem and method."""
        study = self.read('repeats = 2\n[problems]\ndeck = ["karas.nml", "sun_chen.nml"]\ncoarse = [8e-6, 16e-6]\n'
                          + METHODS + REFERENCE)
        self.assertEqual([problem.name for problem in study.problems], ["karas", "sun_chen"])
        self.assertEqual(study.methods, ["part", "method", "impactor.integrator"])
        self.assertEqual(len(study.trials), 8)
        self.assertEqual(len(study.cases), 2 + 2 * 8)
        self.assertEqual([case.repeat for case in study.cases], 10 * [1] + 8 * [2])
        steps = {(trial.problem.name, trial.method["part"]): trial.runs[0].deck.split("step=")[1].split(" ")[0]
                 for trial in study.trials}
        self.assertEqual(steps, {("karas", 1): "8e-06", ("karas", 4): "2e-06", ("sun_chen", 1): "1.6e-05",
                                 ("sun_chen", 4): "4e-06"})
        reference = study.problems[1].reference
        self.assertIsInstance(reference, Case)
        self.assertIn("step=2.5e-07", reference.deck)
        self.assertIn("integrator='conserving'", reference.deck)
        self.assertEqual(len({case.key for case in study.cases}), 18)
        self.assertEqual(study.trials[0].runs[0].deck, study.trials[0].runs[1].deck)

    def test_references_of_problems(self) -> None:
        """References are semi-analytic, a history, or the run of [reference]; names of problems are unique."""
        (self.folder / "measured.csv").write_text("time,force\n0,0\n1,1\n")
        study = self.read('deck = "karas.nml"\n[problems]\n"impactor.velocity" = [1.0, 2.0, 3.0]\n'
                          f'reference = ["{SEMI_ANALYTIC}", "measured.csv", ""]\n'
                          '[grid]\n"time.step" = [1e-6]\n[reference]\n"time.step" = 1e-7\n')
        self.assertEqual([problem.name for problem in study.problems],
                         ["karas velocity=1.0", "karas velocity=2.0", "karas velocity=3.0"])
        first, second, third = (problem.reference for problem in study.problems)
        self.assertEqual((first, second), (SEMI_ANALYTIC, self.folder / "measured.csv"))
        self.assertIn("velocity=3.0", third.deck)

    def test_studies_of_the_manual(self) -> None:
        """The files can be read, and all decks are different."""
        paths = sorted((ROOT / "tests" / "studies" / "plans").glob("*.toml"))
        self.assertGreaterEqual(len(paths), 6)
        for path in paths:
            first = [trial.runs[0].key for trial in read_study(path).trials]
            self.assertEqual(len(set(first)), len(first), path)

    def test_faults(self) -> None:
        """Errors are reported with the name of the file."""
        grid = '[grid]\n"time.step" = [1e-6]\n'
        for text, expected in (
                ('deck = "karas.nml"\n' + grid, "a reference is required"),
                ('deck = "karas.nml"\n' + grid + "[reference]\npart = 2\n", "'part' is not a key"),
                ('deck = "karas.nml"\n[problems]\nreference = "none.csv"\n' + grid, "there is no history"),
                ('[problems]\ndeck = ["karas.nml", "sun_chen.nml"]\n"time.end" = [1]\n' + grid, "of equal length"),
                ('[problems]\ndeck = ["karas.nml", "karas.nml"]\nreference = "semi-analytic"\n' + grid, "several have"),
                ('deck = "karas.nml"\nrepeats = 0\n' + grid, "repeats must be an integer"),
                ('deck = "karas.nml"\nerror = "force"\n' + grid, "error must be one of"),
                ('deck = "karas.nml"\nrepeat = 2\n' + grid, "'repeat' is not one of"),
                ('deck = "karas.nml"\n' + grid + '[figures]\nforce = "mean"\n', r"\[figures\] must give"),
                ('deck = "karas.nml"\n[grid]\ninterval = [1]\n' + REFERENCE.replace("part", '"time.step"'),
                 "no formula of"),
                ('deck = "karas.nml"\n[reference]\n"time.step" = 1e-7\n', "the sweep has no values")):
            with self.subTest(expected), self.assertRaisesRegex(DeckError, f"study.toml: .*{expected}"):
                self.read(text)
