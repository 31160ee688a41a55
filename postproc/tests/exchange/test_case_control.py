"""Tests of the case control: sets that subcases and steps select, and temperatures of grids."""

from tests.bulk import MATERIALS, Bulk
from tests.exchange.test_from_nastran import ImportTest

# Plies with thermal expansion, stress-free at 180.
CURED = [(*MATERIALS[0][:9], -0.3e-6, 28e-6, 180.0, *MATERIALS[0][12:]), (*MATERIALS[1], 23e-6, 180.0)]
SETS = [("TEMPD", 7, 25.0, 8, 60.0), ("SPC1", 2, "12345", *Bulk().on_edge(0))]
CASES = "SOL 101\nCEND\nSPC = 1\nSUBCASE 1\n LOAD = 1\nSUBCASE 2\n TEMP(LOAD) = 7\nBEGIN BULK\n"


class SubcaseTest(ImportTest):
    """Subcases that select the same sets, other sets, or none."""

    def panel(self, head: str, *more: tuple[object, ...]) -> Bulk:
        """Return a panel with thermal expansion and several sets."""
        return Bulk(head=head, materials=CURED, more=[*SETS, *more])

    def change(self, head: str, *options: str, more: tuple[tuple[object, ...], ...] = ()) -> float | None:
        """Return delta_T of the deck."""
        deck = self.deck(self.panel(head, *more), *options)
        return deck.number("thermal", "delta_T") if deck.has("thermal") else None

    def test_one_of_two_temperatures(self) -> None:
        """A temperature in one of two subcases is used only by --subcase."""
        self.refused(self.panel(CASES), "TEMPERATURE(LOAD) selects no set in SUBCASE 1 (line 4), but set 7 in SUBCASE",
                     "choose one with --subcase")
        self.assertIsNone(self.change(CASES, "--subcase", "1"))
        self.assertEqual(self.change(CASES, "--subcase", "2"), -155)
        self.refused(self.panel(CASES), "no SUBCASE 3", "subcases 1, 2", options=("--subcase", "3"))
        code, printed = self.run_command(Bulk(head=CASES).text())
        self.assertEqual(code, 0, printed)

    def test_defaults_above(self) -> None:
        """Commands above the first subcase apply to all that do not select another set."""
        both = CASES.replace("SPC = 1", "SPC = 1\nTEMPERATURE = 8")
        self.refused(self.panel(both), "set 8 in SUBCASE 1 (line 5), but set 7 in SUBCASE 2")
        self.assertEqual(self.change(both, "--subcase", "1"), -120)
        self.assertEqual(self.change(both.replace("= 7", "= 8 $ the same")), -120)

    def test_other_blocks(self) -> None:
        """SUBCOM combines results; a STEP of a subcase selects sets of its own."""
        combined = CASES.replace(" LOAD = 1", " TEMP(BOTH) = 7").replace("BEGIN", "SUBCOM 3\n SUBSEQ = 1., 1.\nBEGIN")
        self.assertEqual(self.change(combined), -155)
        steps = CASES.replace(" LOAD = 1", " STEP 1\n STEP 2\n  TEMP(LOAD) = 8")
        self.refused(self.panel(steps), "no set in STEP 1 (line 5), but set 8 in STEP 2", options=("--subcase", "1"))
        self.assertEqual(self.change(steps, "--subcase", "2"), -155)

    def test_supports(self) -> None:
        """Supports in one of two subcases: --subcase or --spc selects them."""
        head = CASES.replace("SPC = 1\n", "").replace(" LOAD = 1", " SPC = 1").replace("TEMP(LOAD) = 7", "SPC = 2")
        bulk = self.panel(head)
        self.refused(bulk, "SPC selects set 1 in SUBCASE 1 (line 3), but set 2 in SUBCASE 2 (line 5)")
        self.assertEqual(self.deck(bulk, "--subcase", "1").edges(), 4 * ["simple"])
        self.assertEqual(self.deck(bulk, "--spc", "1").edges(), 4 * ["simple"])
        self.assertEqual(self.deck(bulk, "--subcase", "2").edges(), ["clamped", "free", "free", "free"])
        self.refused(self.panel(head.replace(" SPC = 2", " LOAD = 2")), "but no set in SUBCASE 2")

    def test_initial_temperature(self) -> None:
        """TEMPERATURE(INITIAL) is not the load; the report mentions it."""
        head = CASES.replace(" LOAD = 1", " TEMP(INIT) = 8").replace("TEMP(LOAD) = 7", "TEMP(INIT) = 8")
        self.assertIsNone(self.change(head))
        text = self.run_command(self.panel(head).text())[1]
        self.assertIn("TEMPERATURE(INITIAL) of the case control is ignored", text)


class GridTemperatureTest(SubcaseTest):
    """Temperatures of single grids."""

    def test_temperatures_of_grids(self) -> None:
        """TEMP of all grids of the panel is a uniform temperature, if all are equal; others are not in the panel."""
        head = CASES.replace("SUBCASE 1\n LOAD = 1\n", "")
        every = sorted({grid for i in range(0, 9, 2) for j in range(0, 7, 2) for grid in [Bulk().number(i, j)]})
        equal = [("TEMP", 9, grid, 40.0) for grid in every]
        nine = head.replace("= 7", "= 9")
        outside = ("GRID", 900, None, 5.0, 5.0, 5.0), ("TEMP", 9, 900, 400.0)
        self.assertEqual(self.change(nine, more=(*equal, *outside)), -140)
        _, printed = self.run_command(self.panel(nine, *equal, *outside).text())
        self.assertRegex(printed, r"read:(\n .*)+\n  TEMP     21, lines")
        self.assertIsNone(self.change(nine, more=(*equal[1:], ("TEMP", 9, every[0], 41.0))))
        self.assertIsNone(self.change(nine, more=tuple(equal[1:])))
        text = self.run_command(self.panel(nine, *equal[1:]).text())[1]
        self.assertIn("temperature set 9 is ignored: some grids of the panel have no temperature", text)
        self.assertEqual(self.change(head, more=(("TEMP", 7, every[0], 25.0),)), -155)
        self.assertIsNone(self.change(head, more=(("TEMPP1", 7, 1, 25.0, 0.0),)))
