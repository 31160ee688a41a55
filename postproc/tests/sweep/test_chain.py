"""Tests of sweeps with a second deck: groups of the first deck in it, its figures, and the picture."""

import contextlib
import io
import json
import tempfile
import unittest
from pathlib import Path

import numpy as np

from implam_post.io.deck_text import copy_groups
from implam_post.sweep.chain import add_figures, following, remark_of_bounds
from implam_post.sweep.chain_plots import groups, plot_strength
from implam_post.sweep.command import exit_code
from implam_post.sweep.plan import read_plan
from implam_post.sweep.runs import Sweep
from implam_post.sweep.table import Table, make_table
from tests.io.test_summary_shape import SUMMARY

_IMPACT = """! strikes
&case name='hit' /
&mesh elements=4, 4 lines_x=0.01 /
&material name='a' density=1600 E=50e9 nu=0.3 /
&laminate materials='a' angles=0 thicknesses=2e-3 /
&impactor mass=1 velocity=1 radius=8e-3 /
&time end=1e-3 /
"""
_COMPRESSION = """&case name='pressed' /
&mesh elements=4, 4 lines_x=0.02 /
&material name='a' density=1600 E=50e9 nu=0.3 /
&laminate materials='a' angles=0 thicknesses=2e-3 /
&initial_state from='hit_restart.h5' /
&time end=2e-3 /
"""
_SWEEP = """deck = "hit.nml"
then = "pressed.nml"
[grid]
"material.E" = [50e9, 60e9]
"mesh.elements" = [[4, 4], [6, 6]]
"impactor.velocity" = [2.0]
"""


class ChainTest(unittest.TestCase):
    """A sweep of an impact and the compression after it."""

    def setUp(self) -> None:
        """Write the files."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        for name, text in (("hit.nml", _IMPACT), ("pressed.nml", _COMPRESSION), ("sweep.toml", _SWEEP)):
            (self.folder / name).write_text(text, encoding="utf-8")
        self.sweep = Sweep(read_plan(self.folder / "sweep.toml"), ["implam"])

    def _end(self, sweep: Sweep, place: int, summary: dict[str, object]) -> None:
        """Write the results of a run."""
        folder = sweep.folder(sweep.plan.cases[place])
        folder.mkdir(parents=True, exist_ok=True)
        name = "hit" if sweep is self.sweep else "pressed"
        (folder / "run.json").write_text(json.dumps({"exit_code": 0}), encoding="utf-8")
        (folder / f"{name}_history.csv").write_text("time\n0\n", encoding="utf-8")
        (folder / f"{name}_restart.h5").write_text("", encoding="utf-8")
        whole = SUMMARY | {"case": name} | summary
        (folder / f"{name}_summary.json").write_text(json.dumps(whole), encoding="utf-8")

    def test_second_deck(self) -> None:
        """It has material and mesh of the first deck, its own lines and end, and the final state of the case."""
        self._end(self.sweep, 3, {})
        second = following(self.sweep)
        self.assertEqual([case.number for case in second.plan.cases], [4])
        text = second.plan.cases[0].deck
        for found in ("E=60000000000.0", "elements=6, 6", "lines_x=0.02", "end=2e-3", "name='pressed'"):
            self.assertIn(found, text)
        self.assertNotIn("velocity", text)
        restart = self.sweep.folder(self.sweep.plan.cases[3]) / "hit_restart.h5"
        self.assertIn(f"from='{restart.absolute()}'", text)

    def test_figures_of_both_runs(self) -> None:
        """Cases without a second run have no strength."""
        self._end(self.sweep, 0, {"dent_depth": 1e-4, "projected_area": 2e-4})
        second = following(self.sweep)
        self._end(second, 0, {"residual_strength": 3e8, "failure_code": "LDM", "has_failed": False})
        table = make_table(self.sweep, {})
        add_figures(table, self.sweep, second)
        self.assertEqual(table.columns["residual_strength"][0], 3e8)
        self.assertEqual(table.columns["dent_depth"][0], 1e-4)
        self.assertEqual(table.columns["failure_code"], ["LDM", "", "", ""])
        self.assertEqual(table.columns["has_failed"], ["false", "", "", ""])
        self.assertIn("in 1 run of 4 the plate has not failed", remark_of_bounds(table))
        self.assertTrue(np.all(np.isnan(table.columns["residual_strength"][1:])))

    def test_damaged_summary(self) -> None:
        """The note names it, for first and second runs, and the other cases keep their figures."""
        self._end(self.sweep, 0, {"dent_depth": 1e-4})
        self._end(self.sweep, 1, {"dent_depth": 2e-4})
        second = following(self.sweep)
        for place in (0, 1):
            self._end(second, place, {"residual_strength": 3e8, "failure_code": "LDM", "has_failed": True})
        damaged = [self.sweep.folder(self.sweep.plan.cases[1]) / "hit_summary.json",
                   second.folder(second.plan.cases[0]) / "pressed_summary.json"]
        for path in damaged:
            path.write_text("{}", encoding="utf-8")
        table = make_table(self.sweep, {})
        self.assertTrue(any(str(damaged[0]) in note for note in table.notes))
        add_figures(table, self.sweep, second)
        self.assertEqual(sum(str(damaged[0]) in note for note in table.notes), 1)
        self.assertEqual(sum(str(damaged[1]) in note for note in table.notes), 1)
        self.assertEqual(table.columns["dent_depth"][0], 1e-4)
        self.assertEqual(table.columns["residual_strength"][1], 3e8)
        with contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(exit_code(self.sweep, table), 1)
            # Cases 3 and 4 have not run.
            self.assertEqual(exit_code(self.sweep, Table()), 75)

    def test_groups_are_copied(self) -> None:
        """All groups of a name are replaced."""
        text = copy_groups("&b x=1 /\n&b x=2 /\n&c y=1 /\n", "&a z=3 /\n&b x=5 /\n", ["b"])
        self.assertEqual(text.replace("\n\n", "\n"), "&a z=3 /\n&b x=1 /\n&b x=2 /\n")

    def test_picture(self) -> None:
        """Runs of the same energy are grouped; without a strength there is no picture."""
        self.assertEqual([list(rows) for rows in groups(np.array([2.0, 1.0, 2.0000000001]))], [[1], [0, 2]])
        numbers = {"has_failed": ["true", "false", "true"], "impact_energy": [1.0, 2, 2],
                   "dent_depth": [0.0, 1e-4, 2e-4], "projected_area": [0.0, 1e-4, 2e-4]}
        decks = 3 * ["&case /"]
        nothing = Table(numbers | {"residual_strength": [float("nan")] * 3}, decks=decks)
        self.assertIsNone(plot_strength(nothing, self.folder / "none.png"))
        drawn = plot_strength(Table(numbers | {"residual_strength": [3e8, 2e8, 2.2e8]}, decks=decks),
                              self.folder / "strength.png")
        self.assertGreater(drawn.stat().st_size, 1000)


if __name__ == "__main__":
    unittest.main()
