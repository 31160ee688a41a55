"""Tests of the tables of growth on long cells: which rows count, with which cells, and whether errors are those of the
rows."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from growth_plates import text_of
from growth_strips import Strip
from growth_table import impact_errors, strip_errors, table_lines
from onset_share import loads_of

try:
    from node_releases import bar, beam, released
except ModuleNotFoundError:
    released = None  # without NumPy


def strip(kind, load, opening="0.2", shear="0.7"):
    """Return a row of strips."""
    return {"strip": kind, "cells_opening": opening, "cells_shear": shear, "load_by_displacement": load}


def impact(cell, area, peak):
    """Return a row of impacts."""
    return {"deck": "a", "cell": cell, "cells_shear": f"{2/float(cell):.2f}", "projected_area": area,
            "peak_force": peak}


class Errors(unittest.TestCase):
    """Errors of rows."""

    def test_strips(self):
        """Shear counts with its own zone, all others with that of opening; a strip without growth does not count."""
        found = strip_errors([strip("enf", "0.98"), strip("slb", "1.03"), strip("dcb", "")])
        self.assertEqual([cells for cells, _ in found], [0.7, 0.2])
        self.assertAlmostEqual(found[0][1][0], -2)
        self.assertAlmostEqual(found[1][1][0], 3)

    def test_impacts(self):
        """The finest mesh of a deck is the reference, and has no error of its own."""
        found = impact_errors([impact("1", "100", "50"), impact("4", "110", "51"), impact("2", "95", "50")])
        self.assertEqual([cells for cells, _ in found], [0.5, 1.0])
        self.assertAlmostEqual(found[0][1][0], 10)
        self.assertAlmostEqual(found[0][1][1], 2)
        self.assertAlmostEqual(found[1][1][0], -5)

    def test_lines(self):
        """Errors with at least a number of cells, in whole per cent; none where only finer cells were measured."""
        lines = table_lines([(.1, (1.6,)), (.5, (-3.2,)), (.6, (2.4,))], [(1.0, (4.0, -1.0))]).splitlines()
        self.assertEqual(lines[0], "    growth_errors_t(0.0_wp, 3, [-3, 2], 0, [0, 0], [0, 0]), &")
        self.assertEqual(lines[1], "    growth_errors_t(0.25_wp, 0, [0, 0], 0, [0, 0], [0, 0]), &")
        self.assertEqual(lines[3], "    growth_errors_t(0.5_wp, 2, [-3, 2], 0, [0, 0], [0, 0]), &")
        self.assertEqual(lines[4], "    growth_errors_t(1.0_wp, 0, [0, 0], 1, [4, 4], [-1, -1]), &")
        self.assertEqual(lines[6], "    growth_errors_t(2.5_wp, 0, [0, 0], 0, [0, 0], [0, 0])]")


class Models(unittest.TestCase):
    """Closed forms of strips, and decks of plates."""

    def test_double_cantilever(self):
        """The load releases the toughness: the derivative of the energy at fixed load by finite differences."""
        model = Strip("dcb", 1e-3, 1e-3)
        crack, change = 30e-3, 1e-6
        energy = [model.load(crack)**2*(model.compliance(crack + step)) for step in (-change, change)]
        # Two arms, each with the load: energy P times u; the small square of the root rotation is not in the
        # compliance.
        self.assertAlmostEqual((energy[1] - energy[0])/(2*change)/212, 1, delta=.005)

    def test_crack_at_displacement(self):
        """The crack that grows at a displacement, also where a shorter one than the starter would grow at the same."""
        for kind in ("dcb", "enf", "slb"):
            model = Strip(kind, 1e-3, 4e-3)
            for part in (1.0, 1.05, 1.15, 1.25):
                crack = part*model.crack
                self.assertAlmostEqual(model.crack_at(model.load(crack)*model.compliance(crack))/crack, 1, delta=1e-9)

    def test_decks(self):
        """The deck's own cells give its own numbers of elements."""
        self.assertIn("elements=31, 17 ", text_of("peanut", .8, "energy"))
        self.assertIn("elements=12, 10 ", text_of("peanut", 4, "energy"))
        self.assertIn("growth_control='strength'", text_of("which_interfaces", 2, "strength"))
        self.assertIn("elements=15, 30 ", text_of("which_interfaces", 2, "strength"))


class Onset(unittest.TestCase):
    """Loads of a front that advances through nodes."""

    def test_one_node(self):
        """With all of the toughness a single node softens after another, each at the load of the closed form."""
        for load in loads_of(1.0)[:2]:
            self.assertAlmostEqual(load, 1)

    def test_two_nodes(self):
        """By hand: as the first of two softening nodes fails, having moved by 1/t with the onset t, it carries nothing,
        and the second has moved by x = (1/t - t)/(2 - t**2); the load is x and the traction of the second."""
        onset = .45**.5
        moved = (1/onset - onset)/(2 - onset**2)
        self.assertLess(moved, onset)
        loads = loads_of(.45)
        failing = moved + onset - onset**2*moved
        self.assertTrue(loads[0] - 1e-9 <= failing <= loads[1] + 1e-9)

    def test_bounds(self):
        """Loads differ from the closed form by at most 2 % up to a share of 2/9, and by more at a quarter."""
        largest = [max(abs(load - 1) for load in loads_of(k/450)[:2]) for k in range(5, 113)]
        self.assertLess(max(largest[:96]), .02)
        self.assertGreater(largest[-1], .03)


@unittest.skipIf(released is None, "NumPy is not installed")
class Releases(unittest.TestCase):
    """Energies that the nodes of an element release."""

    def test_shear(self):
        """The stiffness of a quadratic bar at an end whose other nodes are held is 7/3 of EA/h."""
        self.assertAlmostEqual(released(bar(20), 1)[0], 3/7, delta=1e-12)

    def test_opening(self):
        """On any cells nodes release their halves within a seventh, their integrals of shape functions not."""
        found = [released(beam(cell, 20, shear), 2)[0] for cell in (.25, 1, 4, 16, 128) for shear in (.4, .03)]
        self.assertGreater(min(found), 3/7)
        self.assertLess(max(found), 4/7)
        self.assertGreater(max(found)/(1/3), 1.7)


if __name__ == "__main__":
    unittest.main()
