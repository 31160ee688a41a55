"""Tests of the commands: output, files and exit codes."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import numpy as np

from implam_post.exchange import from_nastran
from implam_post.exchange.export import to_abaqus, to_nastran
from implam_post.io.errors import FileError
from implam_post.io.history import ENERGIES, read_history
from implam_post.plot import command as plot
from implam_post.plot import movie
from implam_post.reference import check_impact
from implam_post.reference.semi_analytic import semi_analytic
from implam_post.regress import command as regress
from implam_post.regress import compare
from implam_post.regress.expectations import read_expectations
from implam_post.report import command as report
from implam_post.sweep.case_run import read_record
from tests.decks import SUN_CHEN, deck


class CommandTest(unittest.TestCase):
    """Each test has a folder with a deck and a history that is the semi-analytic solution."""

    def setUp(self) -> None:
        """Make the folder."""
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.deck = self.folder / "case.nml"
        self.deck.write_text(SUN_CHEN)
        self.history = self.folder / "sun_chen_history.csv"
        self.write_history(1.0)

    def write_history(self, factor: float, last: float | None = None) -> None:
        """Write every tenth row of the semi-analytic solution, forces times `factor`, the last force replaced."""
        solution = semi_analytic(deck(SUN_CHEN))
        columns = {name: values[::10].copy() for name, values in solution.columns.items()}
        columns["force"] *= factor
        if last is not None:
            columns["force"][-1] = last
        columns |= {name: np.zeros(len(columns["time"])) for name in (*ENERGIES, "energy_error")}
        columns["energy_impactor"] = 8.537e-3 / 2 * columns["impactor_velocity"]**2
        columns["energy_kinetic"] = columns["energy_impactor"][0] - columns["energy_impactor"]
        columns["energy_error"][-1] = 1e-6
        np.savetxt(self.history, np.stack(list(columns.values()), axis=1), delimiter=",", header=",".join(columns),
                   comments="# written by a test\n")

    def run_quietly(self, command: object, *arguments: object) -> tuple[int, str]:
        """Return exit code and text of a command."""
        text = io.StringIO()
        with contextlib.redirect_stdout(text), contextlib.redirect_stderr(text):
            try:
                code = command([str(argument) for argument in arguments])
            except SystemExit as end:
                code = end.code
        return code, text.getvalue()

    def test_check_finds_history_and_plots(self) -> None:
        """A history that is the semi-analytic solution passes a narrow tolerance; the plot is in its folder."""
        code, text = self.run_quietly(check_impact.main, self.deck, "--tolerance", "0.005")
        self.assertEqual(code, 0, text)
        self.assertIn("second peak force", text)
        self.assertGreater((self.folder / "sun_chen_check.png").stat().st_size, 10000)

    def test_other_kinds_of_files(self) -> None:
        """Files of another kind are refused with the kind required, whatever their bytes."""
        picture = self.folder / "case.png"
        picture.write_bytes(b"\x89PNG\r\n\x1a\n\xff\xfe")
        for command, path, sentence in ((plot.main, picture, "not the fields NAME.h5 or the history"),
                                        (plot.main, self.deck, "not the fields NAME.h5 or the history"),
                                        (plot.main, self.folder / "case_restart.h5", "not the fields"),
                                        (report.main, picture, "is not NAME_summary.json"),
                                        (report.main, self.folder / "case.h5", "is not NAME_summary.json"),
                                        (check_impact.main, picture, "it is not a text file")):
            code, text = self.run_quietly(command, path)
            self.assertEqual((code, len(text.splitlines())), (4, 1), text)
            self.assertIn(sentence, text)

    def test_results_of_one_name(self) -> None:
        """Results of equal names are refused with a common output folder, and allowed without."""
        for ending, command in (("_history.csv", plot.main), ("_summary.json", report.main)):
            paths = [self.folder / str(number) / f"case{ending}" for number in (1, 2)]
            for path in paths:
                path.parent.mkdir(exist_ok=True)
                path.write_bytes(self.history.read_bytes())
            code, text = self.run_quietly(command, *paths, "--output", self.folder)
            self.assertEqual((code, len(text.splitlines())), (4, 1), text)
            self.assertIn("have the same name", text)
        self.assertEqual(self.run_quietly(plot.main, *(self.folder / word / "case_history.csv" for word in "12"))[0], 0)

    def test_faulty_expectations(self) -> None:
        """Missing or unknown keys of an entry are reported by name, not by internals of the program."""
        path = self.folder / "case.toml"
        for content, sentence in (('[[expect]]\nvalue = 1.0\nabsolute = 0.1\n', "lacks quantity"),
                                  ('[[expect]]\nquantity = "peak_force"\nvlaue = 1.0\n', "has no vlaue"),
                                  ('[[expect]]\nquantity = 1\nvalue = 1.0\nabsolute = 0.1\n', "must be texts"),
                                  ('[[expect]]\nquantity = "at"\ncolumn = "force"\ntime = "x"\nvalue = 0\n',
                                   "at: time must be a finite number"),
                                  ('variant = [1]\n', "list of tables"), ('[[variant]]\nname = 1\n', "must be a text")):
            path.write_text(content)
            with self.subTest(content), self.assertRaisesRegex(FileError, sentence) as caught:
                read_expectations(path)
            self.assertNotIn("__init__", str(caught.exception))

    def test_files_that_are_not_there(self) -> None:
        """The message has the name of the file once, without error numbers of the system."""
        none, expected = self.folder / "none.csv", self.folder / "case.toml"
        expected.write_text('[[expect]]\nquantity = "rms_force"\nagainst = "none.csv"\nvalue = 0\nabsolute = 1\n')
        for command, *words in ((plot.main, none), (plot.main, self.history, "--measured", none),
                                (compare.main, self.history, none), (compare.main, self.history, expected),
                                (compare.main, self.history, self.folder), (check_impact.main, none),
                                (regress.main, none, "--program", "true"), (from_nastran.main, none)):
            with self.subTest(command=command.__module__, words=words):
                code, text = self.run_quietly(command, *words)
                self.assertEqual((code, len(text.splitlines())), (4, 1), text)
                self.assertNotIn("Errno", text)
                self.assertEqual(text.count("none.csv"), 0 if self.folder in words else 1, text)

    def test_current_folder(self) -> None:
        """The current folder in place of a file is refused in one sentence."""
        with contextlib.chdir(self.folder):
            for command in (plot.main, movie.main, check_impact.main, from_nastran.main):
                with self.subTest(command=command.__module__):
                    code, text = self.run_quietly(command, ".")
                    self.assertEqual((code, len(text.splitlines())), (4, 1), text)

    def test_damaged_record(self) -> None:
        """An invalid record of a run is reported with what to do."""
        for content in ("", "[]", '{"exit_code": 0, "other": 1}', '{"exit_code": 0, "cpu_time": "x"}', "[" * 100000):
            (self.folder / "run.json").write_text(content)
            with self.subTest(content[:40]), self.assertRaisesRegex(FileError, "is damaged: delete it"):
                read_record(self.folder)

    def test_check_fails_beyond_the_tolerance_only(self) -> None:
        """A force 2 % too large is reported, and fails if a tolerance is given."""
        self.write_history(1.02)
        self.assertEqual(self.run_quietly(check_impact.main, self.deck, "--no-plot")[0], 0)
        self.assertEqual(self.run_quietly(check_impact.main, self.deck, "--no-plot", "--tolerance", "0.03")[0], 0)
        code, text = self.run_quietly(check_impact.main, self.deck, "--no-plot", "--tolerance", "0.01")
        self.assertEqual(code, 1, text)
        self.assertFalse((self.folder / "sun_chen_check.png").exists())

    def test_check_fails_on_nan(self) -> None:
        """A NaN in the history is never within a tolerance."""
        self.write_history(1.0, last=np.nan)
        self.assertEqual(self.run_quietly(check_impact.main, self.deck, "--no-plot", "--tolerance", "9")[0], 1)

    def test_check_without_a_history(self) -> None:
        """Without a history the semi-analytic solution is printed."""
        self.history.unlink()
        code, text = self.run_quietly(check_impact.main, self.deck, "--no-plot")
        self.assertEqual(code, 0)
        self.assertRegex(text, r"peak force +298\.87")

    def test_exit_codes(self) -> None:
        """2 for the deck, 4 for files, 1 for wrong usage, each with one sentence."""
        self.deck.write_text(SUN_CHEN.replace("4*'simple'", "'clamped'"))
        code, text = self.run_quietly(check_impact.main, self.deck)
        self.assertEqual((code, text.count("\n")), (2, 1), text)
        self.deck.write_text(SUN_CHEN)
        self.assertEqual(self.run_quietly(check_impact.main, self.folder / "none.nml")[0], 4)
        self.assertEqual(self.run_quietly(check_impact.main, self.deck, "--history", self.folder / "no.csv")[0], 4)
        self.assertEqual(self.run_quietly(check_impact.main, self.deck, "--modes", "0")[0], 1)

    def test_numbers_out_of_range(self) -> None:
        """An invalid number is wrong usage, reported before files are read."""
        for command, *words in ((movie.main, "--rate", "0"), (movie.main, "--rate", "1e-300"),
                                (plot.main, "--dpi", "0"), (plot.main, "--history", "none.csv", "--times", "nan"),
                                (to_abaqus, "--pressure", "inf"), (to_nastran, "--time", "nan"),
                                (check_impact.main, "--tolerance", "nan"), (regress.main, "--timeout", "-1")):
            words = [self.folder / "none.h5", *words]
            with self.subTest(words=words):
                code, text = self.run_quietly(command, *words)
                self.assertEqual(code, 1, text)
                self.assertNotIn("Traceback", text)

    def test_unknown_ending(self) -> None:
        """An ending for which there is no kind of file is wrong usage; a movie is refused before files are read."""
        code, text = self.run_quietly(movie.main, self.folder / "none.h5", "--save", self.folder / "x.foo")
        self.assertEqual((code, text.count("\n")), (1, 1), text)
        self.assertIn("does not end with .gif, .webp or .png", text)
        code, text = self.run_quietly(plot.main, self.history, "--save", self.folder / "x.foo")
        self.assertEqual(code, 1, text)
        self.assertFalse((self.folder / "x.foo").exists())

    def expect(self, text: str) -> tuple[int, str]:
        """Run the comparison with these expectations."""
        table = self.folder / "expect.toml"
        table.write_text(text)
        return self.run_quietly(compare.main, self.history, table)

    def test_compare_passes(self) -> None:
        """All kinds of quantities."""
        code, text = self.expect("""
            expect = [{quantity = "peak_force", value = 298.87, relative = 1e-3},
                      {quantity = "second_peak_force_time", value = 380e-6, absolute = 1e-6},
                      {quantity = "max_deflection", value = 4.265e-4, relative = 1e-3},
                      {quantity = "at", column = "impactor_velocity", time = 9.5e-4, value = -0.5178, absolute = 1e-3},
                      {quantity = "final", column = "impactor_velocity", value = -0.5178, absolute = 1e-3},
                      {quantity = "energy_error", value = 0, absolute = 1e-4},
                      {quantity = "rms_force", against = "case.nml", value = 0, absolute = 1e-3},
                      {quantity = "rms_force", against = "sun_chen_history.csv", value = 0, absolute = 0}]""")
        self.assertEqual((code, text.count(" pass")), (0, 8), text)

    def test_compare_fails(self) -> None:
        """One value out of tolerance, or NaN, ends with exit code 1; NaN for a time outside the history."""
        hit = '[[expect]]\nquantity="peak_force"\nvalue=298.87\nrelative=1e-3\n'
        self.assertEqual(self.expect(hit)[0], 0)
        miss = '[[expect]]\nquantity="peak_force"\nvalue=305\nrelative=1e-2\n'
        late = '[[expect]]\nquantity="at"\ncolumn="force"\ntime=1\nvalue=0\nabsolute=1e9\n'
        for wrong in (miss, late):
            code, text = self.expect(hit + wrong)
            self.assertEqual((code, text.count(" pass"), text.count(" FAIL")), (1, 1, 1), text)
        self.write_history(1.0, last=np.nan)
        self.assertEqual(self.expect(hit)[0], 1)

    def test_compare_refuses_entries_without_meaning(self) -> None:
        """Entries that cannot fail or cannot be evaluated are errors of the file."""
        for entry in ('quantity="peak"\nvalue=1\nabsolute=1', 'quantity="peak_force"\nvalue=1',
                      'quantity="peak_force"\nvalue=0\nrelative=1', 'quantity="peak_force"\nvalue=nan\nabsolute=1',
                      'quantity="peak_force"\nvalue=1\nabsolute=inf', 'quantity="max"\nvalue=1\nabsolute=1',
                      'quantity="at"\ncolumn="force"\nvalue=1\nabsolute=1', 'quantity="rms_force"\nvalue=0\nabsolute=1',
                      'quantity="peak_force"\nvalue=1\nabsolut=1', 'quantity="max"\ncolumn="x"\nvalue=1\nabsolute=1'):
            with self.subTest(entry):
                self.assertEqual(self.expect("[[expect]]\n" + entry)[0], 4)
        self.assertEqual(self.expect("")[0], 4)

    def test_compare_draws_measured_curves(self) -> None:
        """A picture of each curve; without a curve, or with unknown columns, an error."""
        hit = '[[expect]]\nquantity="l2_force"\nagainst="measured.csv"\nvalue=0\nabsolute=0.01\n'
        curve = '[[curve]]\nfile="measured.csv"\n'
        picture, table, measured = (self.folder / name for name in ("over.png", "expect.toml", "measured.csv"))
        sun_chen = read_history(self.history)
        rows = zip(sun_chen.time[::2], sun_chen["force"][::2], strict=True)
        measured.write_text("# rows\ntime,force\n" + "".join(f"{time:.6g},{force:.6g}\n" for time, force in rows))
        table.write_text(hit + curve)
        code, text = self.run_quietly(compare.main, self.history, table, "--plot", picture)
        self.assertEqual((code, text.count(" pass")), (0, 1), text)
        self.assertGreater(picture.stat().st_size, 10_000)
        table.write_text(hit)
        self.assertEqual(self.run_quietly(compare.main, self.history, table, "--plot", picture)[0], 4)
        for columns in ("time,step", "force"):
            (self.folder / "other.csv").write_text(f"{columns}\n" + "0" + ",0" * columns.count(",") + "\n")
            table.write_text(hit + '[[curve]]\nfile="other.csv"\n')
            self.assertEqual(self.run_quietly(compare.main, self.history, table, "--plot", picture)[0], 4, columns)

    def test_invalid_histories(self) -> None:
        """A truncated row, a word and decreasing times are errors of the file."""
        expectation = '[[expect]]\nquantity="peak_force"\nvalue=1\nabsolute=1'
        for text in ("time,force\n0,0\n1", "time,force\n0,x\n", "time,force\n1,0\n0,0\n", "time,force\n", "force\n1\n"):
            self.history.write_text(text)
            with self.subTest(text):
                self.assertEqual(self.expect(expectation)[0], 4)

    def test_plots(self) -> None:
        """One picture of the responses of all histories, one of the energies of each history."""
        code, text = self.run_quietly(plot.main, self.history, self.history, "--output", self.folder / "plots")
        self.assertEqual(code, 0, text)
        self.assertEqual({path.name for path in (self.folder / "plots").iterdir()},
                         {"sun_chen_history_response.png", "sun_chen_history_energies.png"})
