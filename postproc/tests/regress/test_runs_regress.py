"""Tests of regression runs with the program: passed and failed runs, acceptance of values, JUnit XML."""

import shutil
import tempfile
import tomllib
import unittest
from pathlib import Path
from xml.etree import ElementTree

from implam_post.regress import command as regress
from implam_post.regress import compare
from tests.program import SMALL, implam, run_quietly

# Peak forces of input/small/ply_damage.nml at 2.5 and 3 m/s.
SLOW, FAST = 1339.7, 1663.6
EXPECT = """# Kept.
[[expect]]
quantity = "energy_error"  # so is this
value = 0
absolute = 1e-6

[[variant]]
name = "slow"
[[variant.expect]]
quantity = "peak_force"
value = {slow}
relative = 2e-3

[[variant]]
name = "fast"
set = ["impactor%velocity=3"]
[[variant.expect]]
quantity = "peak_force"
value = {fast} # N
relative = 2e-3
[[variant.expect]]
quantity = "rms_force"
against = "fast.csv"
value = 0
absolute = 1e-12
"""


class RegressTest(unittest.TestCase):
    """Each test has a folder with a deck and its expectations."""

    def setUp(self) -> None:
        """Make the folder."""
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.decks, self.runs = self.folder / "decks", self.folder / "runs"
        self.decks.mkdir()
        shutil.copy(SMALL / "ply_damage.nml", self.decks)
        self.expect = self.decks / "ply_damage.toml"

    def regress(self, *more: object) -> tuple[int, str]:
        """Run the command."""
        return run_quietly(regress.main, self.decks, "--program", implam(), "--output", self.runs, "--jobs", 2, *more)

    def write(self, **values: float) -> None:
        """Write the expectations, with some of the values changed."""
        self.expect.write_text(EXPECT.format(**{"slow": SLOW, "fast": FAST, **values}))

    def test_pass_and_fail(self) -> None:
        """Expected values pass, a value changed by 1 % fails, also in JUnit XML."""
        self.write()
        code, text = self.regress("--junit", self.folder / "junit.xml")
        self.assertEqual(code, 1, text)
        self.assertIn("fast.csv cannot be read", text)
        shutil.copy(self.runs / "ply_damage" / "fast" / "ply_damage_history.csv", self.decks / "fast.csv")
        code, text = self.regress("--junit", self.folder / "junit.xml")
        self.assertEqual((code, text.count(" pass"), text.count("FAIL")), (0, 5, 0), text)
        suite = ElementTree.parse(self.folder / "junit.xml").getroot().find("testsuite")
        self.assertEqual([suite.get(name) for name in ("tests", "failures", "errors")], ["2", "0", "0"])
        self.assertEqual([case.get("name") for case in suite], ["slow", "fast"])
        self.write(fast=1.01 * FAST)
        code, text = self.regress("--junit", self.folder / "junit.xml")
        self.assertEqual((code, text.count(" pass"), text.count("FAIL")), (1, 4, 1), text)
        suite = ElementTree.parse(self.folder / "junit.xml").getroot().find("testsuite")
        self.assertEqual([suite.get(name) for name in ("tests", "failures", "errors")], ["2", "1", "0"])
        failure = suite.findall("testcase")[1].find("failure")
        self.assertEqual(failure.get("message"), "not as expected: peak_force")
        self.assertRegex(failure.text, "peak_force .* FAIL")

    def test_runs_that_fail_are_errors(self) -> None:
        """A faulty deck, no convergence, a run beyond the time limit and a deck without expectations fail."""
        self.write()
        text = EXPECT.format(slow=SLOW, fast=FAST).replace("impactor%velocity=3", "impactor%mass=-1")
        self.expect.write_text(text.replace('name = "slow"', 'name = "slow"\nset = ["solver%max_iterations=1", '
                                            '"solver%tolerance=1e-13"]'))
        shutil.copy(SMALL / "damage.nml", self.decks / "other.nml")
        code, text = self.regress("--junit", self.folder / "junit.xml")
        self.assertEqual(code, 1, text)
        for expected in ("slow +the run ended with 3: ", "fast +the run ended with 2: .*mass = -1",
                     "other +the deck has no expected values"):
            self.assertRegex(text, expected)
        suite = ElementTree.parse(self.folder / "junit.xml").getroot().find("testsuite")
        self.assertEqual([suite.get(name) for name in ("tests", "failures", "errors")], ["3", "0", "3"])
        self.assertEqual(len(suite.findall("testcase/error")), 3)
        self.write()
        code, text = self.regress("--timeout", "0.01")
        self.assertEqual((code, text.count("the run took longer than 0.01 s. FAIL")), (1, 2), text)

    def test_accept_changes_what_differs(self) -> None:
        """A value that is not met is replaced; its tolerance, comments and other values are kept; then all pass."""
        self.write(fast=800)
        text = self.expect.read_text().replace('[[variant.expect]]\nquantity = "rms_force"\nagainst = "fast.csv"\n'
                                               'value = 0\nabsolute = 1e-12\n', "")
        self.expect.write_text(text)
        code, said = self.regress("--accept")
        self.assertEqual(code, 0, said)
        self.assertRegex(said, r"ply_damage\.toml: fast: peak_force: 800 -> [\d.]+, tolerance relative 0.002 kept")
        accepted = tomllib.loads(self.expect.read_text())["variant"][1]["expect"][0]
        self.assertAlmostEqual(accepted["value"] / FAST, 1, delta=2e-3)
        self.assertEqual(self.expect.read_text(), text.replace("value = 800 #", f"value = {accepted['value']} #"))
        self.assertEqual(self.regress()[0], 0)

    def test_accept_writes_new_files(self) -> None:
        """A deck without expectations gets a file that passes, and fails for another deck."""
        shutil.copy(SMALL / "static_damage.nml", self.decks)
        code, said = self.regress("--accept")
        self.assertEqual(code, 0, said)
        self.assertRegex(said, r"ply_damage\.toml: written with \d+ figures, tolerance 0\.1 %")
        content = tomllib.loads(self.expect.read_text())["expect"]
        names = [entry.get("column") or entry["quantity"] for entry in content]
        for name in ("peak_force", "peak_force_time", "max_deflection", "matrix_cracks", "energy_error"):
            self.assertIn(name, names)
        self.assertRegex(self.expect.read_text(), r"# Accepted from a run of Implam \d")
        code, said = self.regress()
        self.assertEqual((code, said.count("FAIL")), (0, 0), said)
        deck = self.decks / "ply_damage.nml"
        deck.write_text(deck.read_text().replace("velocity=2.5", "velocity=2.51"))
        code, said = self.regress()
        self.assertEqual(code, 1, said)
        self.assertRegex(said, "ply_damage +peak_force .* FAIL")

    def test_what_cannot_be_accepted(self) -> None:
        """Nothing is written if variants differ in a common expectation, or if entries are on one line."""
        entry = {"quantity": "peak_force", "value": 800, "relative": 1e-3}
        inline = "{" + ", ".join(f'{key} = "{value}"' if key == "quantity" else f"{key} = {value}"
                                 for key, value in entry.items()) + "}"
        variants = '[[variant]]\nname = "slow"\n[[variant]]\nname = "fast"\nset = ["impactor%velocity=3"]\n'
        both = '[[expect]]\nquantity = "peak_force"\nvalue = 800\nrelative = 1e-3\n' + variants
        for text, expected in ((both, r"differs between the variants"),
                               (f"expect = [{inline}]", r"each key on its own line")):
            self.expect.write_text(text)
            code, said = self.regress("--accept")
            self.assertEqual((code, self.expect.read_text()), (1, text), said)
            self.assertRegex(said, f"nothing is accepted: .*{expected}")

    def test_compare_takes_the_same_file(self) -> None:
        """A history of a named variant; without the name the message lists the variants."""
        self.write()
        self.regress()
        history = self.runs / "ply_damage" / "slow" / "ply_damage_history.csv"
        self.assertEqual(run_quietly(compare.main, history, self.expect, "--variant", "slow")[0], 0)
        self.assertEqual(run_quietly(compare.main, history, self.expect, "--variant", "fast")[0], 4)
        code, text = run_quietly(compare.main, history, self.expect)
        self.assertEqual(code, 4)
        self.assertIn("slow, fast", text)

    def test_nothing_to_run(self) -> None:
        """An empty folder and invalid expectations are errors of files."""
        entry = "expect]]\nquantity = 'peak_force'\nvalue = 1\nrelative = 1\n"
        for text in ("", "[[variant]]\nname = 'a/b'", "decks = 'x'", "expect = 3",
                     f"[[{entry}[[variant]]\nname = 'a'\nset = ['velocity=3']",
                     f"[[{entry}[[variant]]\nname = 'a'\n[[variant]]\nname = 'a'"):
            self.expect.write_text(text)
            self.assertEqual(self.regress()[0], 4, text)
        shutil.rmtree(self.decks)
        self.decks.mkdir()
        code, text = self.regress()
        self.assertEqual((code, text.count("\n")), (4, 1), text)


class HelpTest(unittest.TestCase):
    """The help of both commands has the format."""

    def test_help(self) -> None:
        """The help names every key of an entry."""
        for command in (compare, regress):
            code, text = run_quietly(command.main, "--help")
            self.assertEqual(code, 0)
            for word in ("[[expect]]", "[[variant]]", "relative", "absolute", "against", "deck =", "contact_duration"):
                self.assertIn(word, text)
