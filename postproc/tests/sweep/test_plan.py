"""Tests of the cases of the file of a sweep."""

import tempfile
import unittest
from pathlib import Path

from implam_post.io.errors import DeckError
from implam_post.io.namelist import Group, read_namelist
from implam_post.sweep.plan import Plan, read_plan
from tests.decks import KARAS, SUN_CHEN


class PlanTest(unittest.TestCase):
    """Each test has a folder with two decks."""

    def setUp(self) -> None:
        """Make the folder."""
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "sun_chen.nml").write_text(SUN_CHEN)
        (self.folder / "karas.nml").write_text(KARAS)

    def plan(self, text: str, deck: str = 'deck = "sun_chen.nml"\n') -> Plan:
        """Return the plan of this file."""
        path = self.folder / "sweep.toml"
        path.write_text(deck + text)
        return read_plan(path)

    def groups(self, plan: Plan, name: str) -> list[Group]:
        """Return a group of each case's deck."""
        return [read_namelist(case.deck)[name][0] for case in plan.cases]

    def test_grid(self) -> None:
        """All combinations, the last key changes fastest; keys may be given without quotes."""
        plan = self.plan('[grid]\nimpactor.velocity = [1, 2.5]\n"laminate.angles" = [[0, 90], "10*0"]')
        self.assertEqual([group["velocity"] for group in self.groups(plan, "impactor")], [[1], [1], [2.5], [2.5]])
        self.assertEqual([group["angles"] for group in self.groups(plan, "laminate")], 2 * [[0, 90], 10 * [0]])
        self.assertEqual(plan.cases[1].values, {"impactor.velocity": 1, "laminate.angles": "10*0"})
        self.assertEqual((plan.output, plan.names), (self.folder / "sweep", ["impactor.velocity", "laminate.angles"]))

    def test_tables_are_combined(self) -> None:
        """Rows of [list] are combined with each row of the grid and each sample."""
        plan = self.plan("""
            [grid]
            "mesh.patch" = [4e-3, 5e-3]
            [list]
            "impactor.mass" = [1, 2, 3]
            "impactor.radius" = [0.1, 0.2, 0.3]
            [samples]
            number = 2
            "impactor.velocity" = { distribution = "uniform", low = 1, high = 2 }""")
        self.assertEqual(len(plan.cases), 12)
        self.assertEqual({(case.values["impactor.mass"], case.values["impactor.radius"]) for case in plan.cases},
                         {(1, 0.1), (2, 0.2), (3, 0.3)})
        self.assertEqual(len({case.values["impactor.velocity"] for case in plan.cases}), 2)
        self.assertEqual(len({case.key for case in plan.cases}), 12)

    def test_derived(self) -> None:
        """Formulas may have free names, keys of the deck, swept or not, and values derived by preceding formulas."""
        plan = self.plan("""
            [grid]
            energy = [0.01, 0.02]
            angle = [30]
            "impactor.mass" = [0.5]
            [derived]
            double = "2*energy"
            "impactor.velocity" = "sqrt(double/impactor.mass)"
            "mesh.patch" = "impactor.radius + material[1].nu12/100"
            "laminate.angles" = "[0, angle, -angle]" """)
        velocities = [group["velocity"][0] for group in self.groups(plan, "impactor")]
        self.assertAlmostEqual(velocities[0] / 0.2, 1, delta=1e-15)
        self.assertAlmostEqual(velocities[1] / 0.08**0.5, 1, delta=1e-15)
        self.assertAlmostEqual(self.groups(plan, "mesh")[0]["patch"][0], 6.35e-3 + 3e-3, delta=1e-17)
        self.assertEqual(self.groups(plan, "laminate")[1]["angles"], [0, 30, -30])
        self.assertEqual(plan.derived, ["double", "impactor.velocity", "mesh.patch", "laminate.angles"])

    def test_decks_are_swept(self) -> None:
        """The deck may differ between cases."""
        plan = self.plan('[grid]\ndeck = ["karas.nml", "sun_chen.nml"]\n"impactor.velocity" = [1]', deck="")
        self.assertEqual([case.deck_name for case in plan.cases], ["karas.nml", "sun_chen.nml"])
        self.assertIn("! Karas", plan.cases[0].deck)

    def test_keys_distinguish_decks(self) -> None:
        """A case keeps its folder if others are inserted before it."""
        short, long = (self.plan(f'[grid]\n"impactor.velocity" = {values}') for values in ("[2]", "[1, 2, 2]"))
        self.assertEqual([case.key for case in long.cases[1:]], 2 * [short.cases[0].key])
        self.assertNotEqual(long.cases[0].key, short.cases[0].key)

    def test_faults(self) -> None:
        """Each error is one sentence with the name of the file."""
        grid, patch = "[grid]\nenergy = [1]\n", '"mesh.patch" = [1]\n'
        faults = {"the sweep has no values": "", "'grids'": "[grids]\na=1", "Cannot overwrite": grid + "energy=[2]",
                  "needs a list": '[grid]\n"mesh.patch" = 3', "at least": '[grid]\n"mesh.patch" = []',
                  "no formula": grid, "is not swept": grid + '[derived]\n"mesh.patch" = "energie"',
                  "equal length": '[list]\n"mesh.patch" = [1]\n"impactor.mass" = [1, 2]',
                  "is given in": f"[grid]\n{patch}[list]\n{patch}", "not a key": '[grid]\n"mesh[0].patch" = [1]',
                  "is the name of another": '[grid]\ncase = [1]', "a number from 1": "[samples]\nseed = 1",
                  "a distribution": '[samples]\nnumber = 1\n"mesh.patch" = 1',
                  "not a valid value": "[grid]\nmesh.patch=[nan]",
                  "as text": grid + '[derived]\n"mesh.patch" = 1', "only 1 group": "[grid]\n'mesh[3].patch' = [1]",
                  "at most": f"[grid]\na={list(range(400))}\nb={list(range(400))}",
                  "single number": grid + '[derived]\nmesh.patch = "energy*mesh.elements"', "units": "units = 'feet'",
                  "must be a table": "grid = 3",
                  "patch' is given twice in .grid.": f"[grid]\n{patch}mesh.patch = [2]",
                  "1..patch' is given twice in .grid.": f'[grid]\n{patch}"mesh[1].patch" = [2]',
                  "text, and units": "output = 3"}
        for expected, text in faults.items():
            with self.subTest(expected), self.assertRaisesRegex(DeckError, f"^{self.folder}/sweep.toml: .*{expected}"):
                self.plan(text)
        with self.assertRaisesRegex(DeckError, "deck, the base deck"):
            self.plan(patch.join(["[grid]\n", ""]), deck="")
