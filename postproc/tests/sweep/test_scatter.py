"""Tests of random inputs and the results of their runs: decks, statistics, maps."""

import statistics
import tempfile
import unittest
from pathlib import Path

import numpy as np

from implam_post.io.errors import DeckError
from implam_post.io.namelist import read_namelist
from implam_post.sweep.library_values import adopt, read_library
from implam_post.sweep.plan import Plan, only, read_plan
from implam_post.sweep.scatter_plan import KINDS
from implam_post.sweep.scatter_plots import inside
from implam_post.sweep.scatter_statistics import Difference, difference_of, spread_of
from tests.program import ROOT

DECK = """
&case units='SI' /
&plate length=0.15, 0.1 {symmetry} /
&material name='a' density=1600 E1=130e9 E2=8e9 G12=5e9 G13=5e9 G23=3e9 nu12=0.3 XT=2e9 YT=60e6 /
&laminate materials='a' stacking='[0/90]s' ply_thickness=0.5e-3 /
&impactor mass=2 energy=10 at=1e-3, 2e-3 /
&delamination below_ply=1 G_Ic=500 G_IIc=1600 friction=0.3 /
&delamination below_ply=3 G_Ic=500 G_IIc=1600 friction=0.3 /
&support window=0.125, 0.075 /
&support clamps=0.05, 0.04 /
"""
# Output of `implam explain materials`.
TABLE = """&material library names one of these; keys that the deck leaves out get its values. In SI:
  key      unit     im7_8552       as4_3501_6
  density  kg/m^3   1580 c         1560 h
  E1       Pa       171.42e9 d     126e9 g
  YT       Pa       62.3e6 d       48e6 g
  G_IIc    J/m^2    788 e          -
  eta      -        1.634 e        -

  c  assumed, a usual value of such laminates.
"""


class ScatterPlanTest(unittest.TestCase):
    """Decks of runs with random inputs."""

    def plan(self, text: str, symmetry: str = "") -> Plan:
        """Return the plan of a sweep over the deck above."""
        folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (folder / "deck.nml").write_text(DECK.format(symmetry=symmetry))
        path = folder / "sweep.toml"
        path.write_text('deck = "deck.nml"\n' + text)
        return read_plan(path)

    def test_deck_is_what_was_drawn(self) -> None:
        """Each value is that of the deck times its factor; the factor of the energy is that of the velocity squared."""
        for case in self.plan("[scatter]\nnumber = 4\n").cases:
            groups, drawn = read_namelist(case.deck), case.values
            material, first = groups["material"][0], groups["delamination"][0]
            self.assertAlmostEqual(material["yt"][0] / (60e6 * drawn["material.YT factor"]), 1, delta=1e-12)
            self.assertEqual(material["g12"], material["g13"])
            self.assertAlmostEqual(first["g_iic"][0] / (1600 * drawn["delamination[1].G_IIc factor"]), 1, delta=1e-12)
            self.assertNotEqual(first["g_iic"], groups["delamination"][1]["g_iic"])
            self.assertAlmostEqual(groups["impactor"][0]["energy"][0] / (10 * drawn["impactor.energy factor"]**2), 1,
                                   delta=1e-12)
            np.testing.assert_allclose(groups["impactor"][0]["at"], [1e-3 + drawn["place x"], 2e-3 + drawn["place y"]],
                                       rtol=1e-12)
            self.assertAlmostEqual(groups["laminate"][0]["ply_thickness"][0] / (0.5e-3 * drawn["thickness factor"]), 1,
                                   delta=1e-12)
            self.assertEqual(first["friction"], [0.3])

    def test_variations_are_the_defaults(self) -> None:
        """For many runs the means are those of the deck, the coefficients of variation those of the kinds."""
        plan = self.plan("[scatter]\nnumber = 400\n")
        for name, kind in (("material.YT factor", "strengths"), ("delamination[2].G_Ic factor", "toughness"),
                           ("thickness factor", "thickness"), ("material.E1 factor", "moduli"),
                           ("impactor.energy factor", "speed"), ("place x", "place")):
            values = [case.values[name] for case in plan.cases]
            variation = next(one.variation for one in KINDS if one.name == kind)
            self.assertAlmostEqual(statistics.stdev(values) / variation, 1, delta=0.1)
            self.assertAlmostEqual(statistics.mean(values), 0 if kind == "place" else 1, delta=3 * variation / 20)

    def test_given_variations(self) -> None:
        """Kinds and single keys may have other coefficients; samples do not depend on other inputs or the number."""
        plain = self.plan("[scatter]\nnumber = 5\n")
        given = self.plan('[scatter]\nnumber = 3\nplace = 0\nmoduli = 0\nthickness = 0\n"delamination[2].G_Ic" = 0\n'
                          '"material.XT" = 0.2\n')
        self.assertFalse({"place x", "material.E1 factor", "thickness factor", "delamination[2].G_Ic factor"} &
                         set(given.names))
        for one, other in zip(plain.cases[:3], given.cases, strict=True):
            self.assertEqual(one.values["material.YT factor"], other.values["material.YT factor"])
            self.assertGreater(*(abs(case.values["material.XT factor"] - 1) for case in (other, one)))
        self.assertNotEqual(self.plan("[scatter]\nnumber = 3\nseed = 2\n").cases[0].deck, plain.cases[0].deck)
        self.assertEqual(self.plan("[scatter]\nnumber = 3\n").cases[2].key, plain.cases[2].key)

    def test_variations_of_one_group_and_of_all(self) -> None:
        """The coefficient of a numbered group has precedence, whatever the order."""
        for lines in (('"delamination.G_Ic" = 0', '"delamination[2].G_Ic" = 0.1'),
                      ('"delamination[2].G_Ic" = 0.1', '"delamination[*].G_Ic" = 0')):
            names = self.plan("\n".join(["[scatter]", "number = 2", *lines])).names
            self.assertIn("delamination[2].G_Ic factor", names)
            self.assertNotIn("delamination[1].G_Ic factor", names)

    def test_variants_have_the_same_inputs(self) -> None:
        """Factors apply to the values of a variant; groups are removed by their number in the deck."""
        plan = self.plan("""
            [scatter]
            number = 2
            [variants]
            "as it is" = {}
            "tough" = { "delamination[*].G_IIc" = 2100, "delamination[*].friction" = 0, drop = ["support[2]"] }
            """)
        self.assertEqual([case.values["variant"] for case in plan.cases], 2 * ["as it is"] + 2 * ["tough"])
        for one, other in zip(plan.cases[:2], plan.cases[2:], strict=True):
            self.assertEqual({**one.values, "variant": ""}, {**other.values, "variant": ""})
            first, second = (read_namelist(case.deck) for case in (one, other))
            self.assertAlmostEqual(second["delamination"][0]["g_iic"][0] / first["delamination"][0]["g_iic"][0],
                                   2100 / 1600)
            self.assertEqual((len(first["support"]), len(second["support"])), (2, 1))
            self.assertIn("window", second["support"][0])
        self.assertEqual(set(plan.names) - {"variant"}, plan.random)

    def test_variants_with_fewer_groups_have_the_same_inputs(self) -> None:
        """The first of two groups has the same factors as a single one."""
        plan = self.plan("[scatter]\nnumber = 2\n[variants]\na = {}\nb = { drop = ['delamination[2]'] }\n")
        for one, other in zip(plan.cases[:2], plan.cases[2:], strict=True):
            first, second = (read_namelist(case.deck)["delamination"] for case in (one, other))
            self.assertEqual((len(first), len(second)), (2, 1))
            self.assertEqual(first[0], second[0])
            self.assertNotEqual(first[0]["g_iic"], first[1]["g_iic"])

    def test_some_variants(self) -> None:
        """Only the first variant and the requested ones, with unchanged decks; unknown variants are refused."""
        text = "[variants]\na = {}\nb = { 'impactor.energy' = 5 }\nc = { 'impactor.energy' = 6 }\n"
        plan = self.plan(text)
        some = only(plan, ["c"])
        self.assertEqual([(case.values["variant"], case.key) for case in some.cases],
                         [(case.values["variant"], case.key) for case in plan.cases[::2]])
        with self.assertRaisesRegex(DeckError, "'d' is not one of the variants a, b, c"):
            only(plan, ["d"])

    def test_sweeps_of_the_panels(self) -> None:
        """The files can be read, and the decks of variants differ unless a variant changes nothing."""
        paths = sorted((ROOT / "tests/studies/scatter").glob("*.toml"))
        self.assertGreaterEqual(len(paths), 3)
        for path in paths:
            plan = read_plan(path)
            decks = {}
            for case in plan.cases:
                decks.setdefault(case.values.get("variant", ""), []).append(case.key)
            firsts = [tuple(keys) for keys in decks.values()]
            runs = len(firsts[0])
            self.assertGreaterEqual(runs, 2)
            self.assertEqual({len(keys) for keys in firsts}, {runs})
            self.assertGreaterEqual(len(set(firsts)), len(firsts) - 3)
            self.assertTrue(all(len(set(keys)) == runs for keys in firsts))

    def test_variants_win(self) -> None:
        """If a variant sets a swept key, the table has the value of the variant."""
        plan = self.plan("""
            [grid]
            "impactor.mass" = [3]
            [variants]
            "heavy" = {}
            "light" = { "impactor.mass" = 1 }
            """)
        self.assertEqual([read_namelist(case.deck)["impactor"][0]["mass"] for case in plan.cases], [[3], [1]])
        self.assertEqual([case.values["impactor.mass"] for case in plan.cases], [3, 1])

    def test_published_materials(self) -> None:
        """Values of published materials are written into the deck in its units; given values are kept."""
        library = read_library(TABLE)
        self.assertEqual(library["as4_3501_6"]["YT"], (48e6, "Pa"))
        self.assertNotIn("G_IIc", library["as4_3501_6"])
        deck = ("&case units='mm-t-s' /\n&material name='a' library='im7_8552' YT=50 /\n&laminate materials='a' /\n"
                "&delamination below_ply=1 /\n&delamination below_ply=2 G_Ic=0.3 G_IIc=0.9 /\n")
        groups = read_namelist(adopt(deck, "deck.nml", lambda: library))
        material, (left_out, given) = groups["material"][0], groups["delamination"]
        np.testing.assert_allclose([material["e1"][0], material["density"][0], material["yt"][0], left_out["g_iic"][0],
                                    left_out["eta"][0], given["g_iic"][0]], [171420, 1.58e-9, 50, 0.788, 1.634, 0.9],
                                   rtol=1e-12)
        self.assertNotIn("eta", given)
        plain = "&material name='a' YT=50 /\n"
        self.assertEqual(adopt(plain, "deck.nml", dict), plain)
        with self.assertRaisesRegex(DeckError, "'im7_8552' is not one of the published materials"):
            adopt(deck, "deck.nml", lambda: read_library(TABLE.replace("im7_8552", "other   ")))

    def test_toughness_of_the_only_material(self) -> None:
        """Interfaces have the toughness of the published material if it is the same for all plies, under any names."""
        library = read_library(TABLE)
        deck = ("&case units='SI' /\n&material name='a' library='im7_8552' /\n"
                "&material name='b' library='IM7_8552' /\n"
                "&laminate materials='a', 'b' /\n&delamination below_ply=1 /\n")
        for text, adopted in ((deck, True), (deck.replace("IM7_8552", "as4_3501_6"), False),
                              (deck.replace("library='IM7_8552'", "E=70e9"), False)):
            groups = read_namelist(adopt(text, "deck.nml", lambda: library))
            self.assertEqual("g_iic" in groups["delamination"][0], adopted, text)

    def test_a_part_of_the_plate(self) -> None:
        """With symmetry the place of impact does not scatter, which a note reports."""
        plan = self.plan("[scatter]\nnumber = 1\n", "symmetry='point'")
        self.assertNotIn("place x", plan.names)
        self.assertEqual(len(plan.notes), 1)
        self.assertIn("symmetry", plan.notes[0])

    def test_faults(self) -> None:
        """Errors are one sentence."""
        for text, expected in (("[scatter]\n", "number of runs"), ("[scatter]\nnumber = 0\n", "number of runs"),
                           ("[scatter]\nnumber = 2\nstrength = 0.1\n", "'strength' is not one of"),
                           ("[scatter]\nnumber = 2\nstrengths = 1\n", "at least 0 and less than 1"),
                           ("[scatter]\nnumber = 2\nmethod = 'x'\n", "method"),
                           ("[scatter]\nnumber = 2\n'material.YC' = 0.1\n", "does not have this key"),
                           ("[scatter]\nnumber = 2\n'material.density' = 0.1\n", "is not one of"),
                           ("[variants]\na = 1\n", "table of tables"),
                           ("[variants.a]\nfriction = 1\n", "not a key of the deck"),
                           ("[variants.a]\ndrop = ['support[3]']\n", "2 groups &support"),
                           ("[variants.a]\ndrop = ['support']\n", "write support"),
                           ("scatter = 1\n", "table")):
            with self.subTest(text), self.assertRaisesRegex(DeckError, expected):
                self.plan(text)


class StatisticsTest(unittest.TestCase):
    """Means, scatter and differences."""

    def test_smallest_difference(self) -> None:
        """The bound is that of the two-sided t-test at 5 %."""
        for pairs, bound in ((2, 12.7062), (3, 4.30265), (11, 2.22814), (101, 1.98397)):
            self.assertAlmostEqual(Difference(pairs, 1.0, 1.0, 1.0).least, bound, delta=1e-4 * bound)

    def test_spread(self) -> None:
        """Runs without the figure are omitted; of few runs the percentiles are the smallest and the largest value."""
        found = spread_of([3, 1, float("nan"), 2])
        self.assertEqual((found.number, found.mean, found.deviation, found.low, found.high), (3, 2, 1, 1, 3))
        self.assertAlmostEqual(found.error, 3**-0.5)
        even = spread_of(np.arange(1001) / 1000)
        self.assertAlmostEqual(even.low, 0.05, delta=1e-3)
        self.assertEqual(spread_of([]).number, 0)

    def test_differences(self) -> None:
        """Pairs detect a difference smaller than the scatter of the runs, and none between equal variants."""
        stream = np.random.default_rng(1)
        first = stream.normal(10, 2, 20)
        difference = difference_of(first, first + stream.normal(0.5, 0.2, 20))
        self.assertTrue(difference.differs)
        self.assertAlmostEqual(difference.mean, 0.5, delta=0.15)
        alone = difference_of(first, stream.normal(10.5, 2, 20))
        self.assertFalse(alone.differs)
        self.assertFalse(difference_of([1], [2]).differs)

    def test_risk(self) -> None:
        """Of 2000 comparisons of equal variants, one in 20 is significant."""
        stream = np.random.default_rng(2)
        wrong = sum(difference_of(stream.normal(size=6), stream.normal(size=6)).differs for _ in range(2000))
        self.assertAlmostEqual(wrong / 2000, 0.05, delta=0.015)

    def test_inside(self) -> None:
        """Points of a grid in a ring."""
        ring = np.array([[[a, b], [a + 1, b], [a + 1, b + 1], [a, b + 1]] for a in range(3) for b in range(3)
                         if (a, b) != (1, 1)], dtype=float)
        middles = np.arange(-0.5, 4)
        found = inside(ring, middles, middles)
        wanted = np.zeros((5, 5), dtype=bool)
        wanted[1:4, 1:4] = True
        wanted[2, 2] = False
        np.testing.assert_array_equal(found, wanted)


if __name__ == "__main__":
    unittest.main()
