"""Tests of the tables of measured panels, and of which jobs remain."""

import sys
import unittest
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import panels
from tables import event_line, measured_line, number, variant_lines, verdict


class Tables(unittest.TestCase):
    """Lines of the tables."""

    def test_bounds(self):
        """A mean beyond its bound is within it only with a standard error that explains it."""
        entry = {"of": "peak_force", "value": 100.0, "bound": 10}
        self.assertEqual(verdict(entry, [109.0] * 10, 0.1), "within")
        self.assertEqual(verdict(entry, [114.0] * 10, 0.1), "outside")
        self.assertEqual(verdict(entry, [114.0] * 10, 3.0), "within")
        self.assertEqual(verdict(entry, [116.0] * 10, 9.0), "outside")
        self.assertEqual(verdict(entry, [109.0] * 3, 0.1), "within, 3 of 10 runs")

    def test_difference(self):
        """The scatter of the tests and the standard error of the runs are combined."""
        entry = {"of": "residual_strength", "value": 100.0, "scatter": 6.0, "tests": 4, "others": "90"}
        # Values 110 and 118: mean 114, standard error 4; that of four tests is 3.
        line = measured_line(entry, [110.0, 118.0])
        self.assertEqual(line[1:], ["100 ± 6", "114 ± 4", "+14 %", "+2.8", "-", "90", "-"])
        self.assertEqual(measured_line(entry, [110.0])[2:5], ["110", "+10 %", "-"])
        self.assertEqual(number(0.0123), ".0123")
        self.assertEqual(number(-0.5), "-.5")

    def test_events(self):
        """The lowest energy of each draw counts; a draw with missing steps and no event does not."""
        panel = {"energies": [1, 2, 3]}
        event = {"of": "front", "label": "front", "above": 10, "from": 2, "to": 3}
        rows = [{"seed": seed, "energy": str(energy), "front": str(front)} for seed, energy, front in
                [("1", 1, 0), ("1", 2, 9.9), ("1", 3, 12), ("2", 1, 0), ("2", 2, 2), ("2", 3, 11), ("3", 1, 0)]]
        self.assertEqual(event_line(event, panel, rows), ["front", "2 to 3", "2.5 ± .5", "2"])
        never = [row | {"front": "0"} for row in rows if row["seed"] == "1"]
        self.assertEqual(event_line(event, panel, never)[2:], ["not up to 3", "1"])

    def test_variants(self):
        """Variants are compared over draws that both have."""
        panel = {"measured": [{"of": "dent", "value": 1}], "variants": {"soft": {}}}
        rows = [{"panel": "p", "variant": variant, "seed": seed, "dent": dent} for variant, seed, dent in
                [("", "1", "1"), ("", "2", "2"), ("soft", "2", "2.5"), ("soft", "3", "9")]]
        self.assertEqual(variant_lines("p", panel, rows)[-1], "| soft | 1 | +0.5 |")


class Jobs(unittest.TestCase):
    """Which jobs remain."""

    def test_remaining(self):
        """A job with a row of the same inputs is not repeated; one of other inputs is."""
        panel = {"deck": "hs160_rem_0_90.nml", "energies": [1, 2]}
        row = {"panel": "p", "variant": "", "energy": "1", "seed": "1", "version": "1",
               "inputs": panels.digest(panel, "")}
        options = SimpleNamespace(seeds=range(1, 2), panel=None, variant=None, again=False)
        for rows, expected in ([row], [2]), ([row | {"inputs": "other"}], [1, 2]):
            with mock.patch.object(panels, "read_rows", return_value=rows):
                self.assertEqual([job.energy for job in panels.jobs_of(options, {"p": panel})], expected)
        self.assertNotEqual(panels.digest(panel, ""), panels.digest(panel | {"set": {"mesh.cell": "1e-3"}}, ""))

    def test_earlier_decks(self):
        """Rows of earlier decks are used and marked while there are none of the present ones."""
        panel = {"deck": "hs160_rem_0_90.nml"}
        old, older = ({"panel": "p", "variant": "", "energy": "1", "seed": "1", "inputs": inputs, "version": "1"}
                      for inputs in ("old", "older"))
        new = old | {"inputs": panels.digest(panel, "")}
        self.assertEqual(panels.usable([older, old], {"p": panel}), [old | {"earlier": "yes"}])
        self.assertEqual(panels.usable([old, new], {"p": panel}), [new])

    def test_pairs_of_one_version(self):
        """A variant is compared with the run of its own version, not with a later one."""
        panel = {"deck": "t700_m21_25J.nml", "measured": [{"of": "peak_force", "value": 1}], "variants": {"soft": {}}}
        first, later, soft = ({"panel": "p", "variant": variant, "energy": "1", "seed": "1", "version": version,
                               "inputs": panels.digest(panel, variant), "peak_force": force}
                              for variant, version, force in (("", "1", "2"), ("", "2", "4"), ("soft", "1", "3")))
        rows = panels.usable([first, soft, later], {"p": panel})
        self.assertEqual(variant_lines("p", panel, rows)[-1], "| soft | 1 | +1 |")

    def test_decks(self):
        """Every panel has decks, its drawn inputs are in them, and equal seeds draw equal decks."""
        from jobs import Job, decks_of
        for name, panel in panels.read_panels().items():
            first, second = decks_of(Job(name, panel, "", panel.get("energies", [""])[0], 1, ""), panels.DECKS)
            again, _ = decks_of(Job(name, panel, "", panel.get("energies", [""])[0], 1, ""), panels.DECKS)
            other, _ = decks_of(Job(name, panel, "", panel.get("energies", [""])[0], 2, ""), panels.DECKS)
            self.assertEqual(first, again)
            self.assertNotEqual(first, other)
            self.assertEqual(second is not None, "then" in panel)


if __name__ == "__main__":
    unittest.main()
