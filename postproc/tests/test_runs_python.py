"""Tests of the Python interface with runs: decks with changed keys, results with units, errors; the notebook."""

import contextlib
import importlib.util
import json
import os
import re
import subprocess
import tempfile
import unittest
import unittest.mock
from pathlib import Path

import numpy as np

import implam_post as implam
from implam_post.io.results import dimension_of
from implam_post.plot.curves import AXES
from tests.program import ROOT, SMALL
from tests.program import implam as program

NOTEBOOK = ROOT / "postproc" / "examples" / "example.ipynb"


class PythonInterfaceTest(unittest.TestCase):
    """Runs of a small deck, started once."""

    @classmethod
    def setUpClass(cls) -> None:
        """Run the deck unchanged, and with another velocity and mesh."""
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        started = [implam.run_deck(SMALL / "damage.nml", changes, cls.folder / str(number), str(program()))
                   for number, changes in enumerate(({"case%units": "SI"}, {
                       "case.units": "SI", "impactor%velocity": np.float64(3.0), "mesh%elements": (7, 7),
                       "delamination[1]%G_c": 350, "ply_damage%d": None}))]
        cls.slow, cls.fast = (run.wait(timeout=200) for run in started)

    def test_changes_reach_the_run(self) -> None:
        """Keys and lists are set, None removes a key; the given deck is not changed."""
        deck = self.fast.deck
        self.assertEqual((deck.number("impactor", "velocity"), deck.numbers("mesh", "elements")), (3, [7, 7]))
        self.assertEqual(deck.groups["delamination"][0]["g_c"], [350])
        self.assertEqual((self.slow.deck.number("ply_damage", "d"), deck.values("ply_damage", "d")), (100, []))
        self.assertIn("velocity=2.5", (SMALL / "damage.nml").read_text(encoding="utf-8"))

    def test_history_and_summary(self) -> None:
        """The table is that of the file, with units of every column; the summary is that of the JSON file."""
        history = self.slow.history
        path = self.folder / "0" / "damage_history.csv"
        written = np.genfromtxt(path, delimiter=",", names=True)
        self.assertEqual(list(history), list(written.dtype.names))
        for name in history:
            np.testing.assert_array_equal(history[name], written[name])
        units = history.attrs["units"]
        self.assertEqual(units.keys(), set(history))
        self.assertEqual([units[name] for name in ("time", "force", "deflection", "delaminated_area", "stress", "step",
                                                   "impactor_velocity", "energy_below_2", "extent_x_below_2")],
                         ["s", "N", "m", "m2", "Pa", "", "m/s", "J", "m"])
        expected = json.loads((self.folder / "0" / "damage_summary.json").read_text(encoding="utf-8"))
        self.assertEqual(self.slow.summary, expected)
        self.assertEqual((self.slow.ending, self.slow.warnings),
                         ("done", [warning["text"] for warning in expected["warnings"]]))

    def test_units_are_those_of_the_program(self) -> None:
        """Each column has the dimension in the table of columns of the program."""
        text = subprocess.run([program(), "explain", "history"], capture_output=True, text=True, check=True).stdout
        rows = re.findall(r"^  (\w+) +(?:real|integer|logical) +(\S+) ", text, re.MULTILINE)
        self.assertGreater(len(rows), 60)
        other = {"-": "", "pressure": "stress", "length/time": "velocity"}
        self.assertEqual({name: dimension_of(name) for name, _ in rows},
                         {name: other.get(unit, unit) for name, unit in rows})
        self.assertLessEqual(AXES.keys(), {name for name, _ in rows})

    def test_fields_have_coordinates(self) -> None:
        """Values agree with places: no displacement at clamped edges, the largest one at the struck point."""
        field = self.slow.field("displacement")
        self.assertEqual((field.values.shape, field.coordinates.shape, field.unit), (*2 * [(229, 3)], "m"))
        edge = np.isclose(field.coordinates[:, 0], 0.02)
        np.testing.assert_allclose(field.values[edge], 0, atol=1e-12)
        most = field.coordinates[np.argmax(field.values[:, 2])]
        np.testing.assert_allclose(most[:2], 0, atol=1e-12)
        self.assertAlmostEqual(np.max(field.values[:, 2]) / self.slow.summary["largest_deflection"], 1, delta=0.05)
        cells = self.slow.field("delaminated_above", 1.0)
        self.assertEqual(set(cells.first_ply), {1, 3})
        self.assertEqual(cells.time, self.slow.times[-1])
        self.assertEqual(cells.coordinates.shape, (len(cells.values), 3))
        with self.assertRaisesRegex(implam.ImplamError, "no field strain; it has .*displacement"):
            self.slow.field("strain")

    def test_compare(self) -> None:
        """Figures of two runs with their units; a run does not differ from itself."""
        table = implam.compare(self.slow, self.fast)
        row = table.loc["peak_force"]
        self.assertEqual(row["first"], self.slow.summary["peak_force"])
        self.assertAlmostEqual(row["relative"], row["second"] / row["first"] - 1)
        self.assertEqual((row["unit"], table.loc["contacts", "unit"]), ("N", ""))
        self.assertGreater(table.loc["force_history", "relative"], 0.05)
        same = implam.compare(self.slow, implam.open_run(self.folder / "0" / "damage_history.csv"))
        self.assertEqual(float(np.nanmax(np.abs(same["difference"]))), 0)

    def test_faults(self) -> None:
        """A faulty deck, an unknown key, the folder of the deck and missing results are reported in one sentence."""
        with self.assertRaisesRegex(implam.RunError, "the run ended with 2: .*velocty") as caught:
            implam.run_deck(SMALL / "damage.nml", {"impactor%velocty": 3}, self.folder / "x", str(program())).wait(60)
        self.assertEqual(caught.exception.exit_code, 2)
        # The last line that the program prints is a warning.
        with self.assertRaisesRegex(implam.RunError, "the run ended with 2: .*is missing"):
            implam.run_deck(SMALL / "damage.nml", {"delamination[2]%G_c": 3}, self.folder / "x", str(program())).wait()
        with self.assertRaisesRegex(implam.DeckError, "'velocity' is not a key"):
            implam.run_deck(SMALL / "damage.nml", {"velocity": 3}, self.folder / "x", str(program()))
        with self.assertRaisesRegex(implam.FileError, "the folder of the deck itself"):
            implam.run_deck(SMALL / "damage.nml", {}, SMALL, str(program()))
        for path in (self.folder, self.folder / "none_summary.json", self.folder / "0" / "damage.log"):
            with self.subTest(path), self.assertRaises(implam.FileError):
                implam.open_run(path)

    def test_folder_with_another_run(self) -> None:
        """The results are those of the deck."""
        folder = self.folder / "two"
        folder.mkdir()
        (folder / "other_summary.json").write_text("{}")
        changes = {"case%name": "short", "time%end": 2e-5}
        run = implam.run_deck(SMALL / "damage.nml", changes, folder, str(program())).wait(60)
        self.assertEqual((run.name, run.summary["accepted_steps"]), ("short", 2))

    def test_runs_can_be_stopped(self) -> None:
        """After a time limit the run continues; after `stop` it ends with exit code 75."""
        run = implam.run_deck(SMALL / "damage.nml", {"time%step": 1e-8}, self.folder / "long", str(program()))
        with self.assertRaises(TimeoutError):
            run.wait(timeout=1)
        self.assertTrue(run.is_running)
        run.stop()
        with self.assertRaises(implam.RunError) as caught:
            run.wait(timeout=100)
        self.assertEqual(caught.exception.exit_code, 75)
        self.assertEqual(implam.open_run(self.folder / "long").ending, "stopped")

    def test_notebook(self) -> None:
        """Every cell of the example runs, in the kernel of Jupyter if it is installed."""
        folder = self.folder / "notebook"
        folder.mkdir()
        surroundings = {"IMPLAM": str(program()), "MPLBACKEND": "agg", "PYTHONPATH": str(ROOT / "postproc")}
        with contextlib.chdir(folder), unittest.mock.patch.dict(os.environ, surroundings):
            if all(map(importlib.util.find_spec, ("nbclient", "nbformat", "ipykernel"))):
                import nbformat
                from nbclient import NotebookClient
                NotebookClient(nbformat.read(NOTEBOOK, 4), timeout=300, resources={"metadata": {"path": folder}}
                               ).execute()
            else:
                names: dict[str, object] = {}
                for cell in json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]:
                    if cell["cell_type"] == "code":
                        exec("".join(cell["source"]), names)
        self.assertTrue((folder / "speed_3.5" / "panel_summary.json").exists())
