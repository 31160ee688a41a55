"""Tests of the single numbers taken from a history."""

import tempfile
import unittest
from pathlib import Path

import numpy as np

from implam_post.io.history import ENERGIES, History, read_history
from implam_post.io.quantities import (
    QUANTITIES,
    contacts,
    l2_force_difference,
    peak,
    rms_force_difference,
    second_peak,
)


def pulses(*forces: float) -> History:
    """Return a history with the forces at times 0, 1, 2 ..."""
    return History({"time": np.arange(len(forces), dtype=float), "force": np.array(forces, dtype=float)})


class QuantitiesTest(unittest.TestCase):
    """Peaks, contacts, energies and differences."""

    def test_peak_of_a_parabola_between_uneven_rows(self) -> None:
        """The parabola through three rows is exact."""
        time = np.array([0.0, 1.0, 2.5, 3.0, 5.0])
        found = peak(History({"time": time, "force": 7 - 2 * (time - 2.2)**2}), "force")
        np.testing.assert_allclose(found, (7, 2.2), rtol=1e-14)

    def test_contacts_of_hertzian_ends(self) -> None:
        """If force**(2/3) is linear, begin and end are exact; the end of a contact that has not ended is NaN."""
        depth = np.array([0, 0.5, 1.5, 0.4, 0, 0, 0.3, 0.6])
        found = contacts(pulses(*depth**1.5))
        np.testing.assert_allclose(found, [(0.5, 3 + 0.4 / 1.1), (5, np.nan)], rtol=1e-14)
        self.assertEqual(contacts(pulses(0, 0, 0)), [])

    def test_second_peak(self) -> None:
        """The largest force of the second contact, and NaN if there is none."""
        self.assertAlmostEqual(second_peak(pulses(0, 9, 0, 0, 2, 3, 2, 0)).value, 3, delta=1e-14)
        self.assertTrue(np.isnan(second_peak(pulses(0, 9, 0, 0)).value))

    def test_energy_error(self) -> None:
        """The largest absolute error, as a fraction of the total energy at the start."""
        columns = {name: np.zeros(3) for name in ENERGIES}
        columns |= {"time": np.arange(3.0), "energy_error": np.array([0, -0.3, 0.1])}
        columns["energy_impactor"] = np.array([6.0, 1, 1])
        self.assertAlmostEqual(QUANTITIES["energy_error"](History(columns)), 0.05, delta=1e-15)
        columns["energy_impactor"] = np.zeros(3)
        self.assertFalse(np.isfinite(QUANTITIES["energy_error"](History(columns))))

    def test_energy_rise(self) -> None:
        """The increase from the preceding minimum; work of the pressure and losses do not count."""
        columns = {name: np.zeros(6) for name in ENERGIES}
        columns |= {"time": np.arange(6.0), "work_external": np.array([0, 0, 0, 1.0, 1, 1])}
        columns["energy_impactor"] = np.array([10.0, 8, 6, 8, 7, 6])
        columns["energy_strain"] = np.array([0, 1, 1, 1, 2.5, 1])
        columns["energy_delamination"] = np.arange(6.0)
        self.assertAlmostEqual(QUANTITIES["energy_rise"](History(columns)), 0.15, delta=1e-15)
        columns["energy_kinetic"] = np.full(6, np.nan)
        self.assertTrue(np.isnan(QUANTITIES["energy_rise"](History(columns))))

    def test_energy_of_the_impactor(self) -> None:
        """Energy in the first row without work of the pressure, minus energy at the end of the last contact."""
        columns = dict(pulses(0, 8, 8, 0, 0, 8, 0, 0).columns)
        columns |= {name: np.zeros(8) for name in (*ENERGIES, "work_external")}
        columns["energy_impactor"] = np.array([9.0, 5, 4, 3, 3, 2, 1, 1])
        columns["energy_strain"][0], columns["work_external"][0] = 1.5, 0.5
        history = History(columns)
        self.assertEqual(QUANTITIES["impact_energy"](history), 10)
        end = contacts(history)[-1].end
        self.assertEqual(QUANTITIES["contact_duration"](history), sum(one.end - one.begin for one in contacts(history)))
        self.assertAlmostEqual(QUANTITIES["absorbed_energy"](history), 10 - np.interp(end, history.time, columns[
            "energy_impactor"]), delta=1e-14)
        untouched = History(columns | {"force": np.zeros(8)})
        constant = History(columns | {"force": np.full(8, 8.0)})
        for one in (untouched, constant):
            for name in ("contact_duration", "absorbed_energy"):
                self.assertTrue(np.isnan(QUANTITIES[name](one)), name)

    def test_energy_of_the_impactor_on_a_stressed_plate(self) -> None:
        """Initial strain energy of residual stress does not count as impact energy."""
        columns = dict(pulses(2, 8, 0).columns)
        columns |= {name: np.zeros(3) for name in (*ENERGIES, "work_external")}
        columns |= {"energy_impactor": np.array([9.96, 1, 5]), "energy_strain": np.array([7.04, 9, 5])}
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "stressed_history.csv"
            rows = zip(*columns.values(), strict=True)
            lines = [",".join(columns), *(",".join(map(repr, map(float, row))) for row in rows)]
            path.write_text("".join(f"{line}\n" for line in lines))
            self.assertAlmostEqual(QUANTITIES["impact_energy"](read_history(path)), 17, delta=1e-14)
            summary = path.with_name("stressed_summary.json")
            for text in ("{}", "[", '{"energy_impact": null}'):
                summary.write_text(text)
                self.assertAlmostEqual(QUANTITIES["impact_energy"](read_history(path)), 17, delta=1e-14, msg=text)
            summary.write_text('{"energy_impact": 10}')
            history = read_history(path)
        self.assertEqual(QUANTITIES["impact_energy"](history), 10)
        self.assertAlmostEqual(QUANTITIES["absorbed_energy"](history.until(2.0)), 5, delta=1e-14)

    def test_first_growth(self) -> None:
        """Force and time of the first growth, by stages of interfaces or else by area; NaN without."""
        columns = dict(pulses(0, 5, 3, 9).columns)
        force, time = (QUANTITIES[f"first_growth_{name}"] for name in ("force", "time"))
        self.assertTrue(np.isnan(force(History(columns))))
        columns["delaminated_area"] = np.array([1.0, 1, 2, 2])
        self.assertEqual(force(History(columns)), 3)
        self.assertEqual(time(History(columns)), columns["time"][2])
        staged = History(columns | {"stage_below_1": np.array([0, 1, 1, 2]), "stage_below_2": np.array([2, 2, 2, 2])})
        self.assertEqual((force(staged), time(staged)), (9, columns["time"][3]))
        for area in (np.ones(4), np.full(4, np.nan)):
            self.assertTrue(np.isnan(force(History(columns | {"delaminated_area": area}))))
        self.assertTrue(np.isnan(force(History(columns | {"force": np.full(4, np.nan)}))))

    def test_rms_force_difference(self) -> None:
        """A constant difference over the contact, and NaN if a history ends too early."""
        reference = pulses(0, 2, 4, 2, 0, 0)
        self.assertEqual(rms_force_difference(reference, reference), 0)
        self.assertAlmostEqual(rms_force_difference(pulses(1, 3, 5, 3, 1, 0), reference), 0.25, delta=1e-14)
        self.assertTrue(np.isnan(rms_force_difference(pulses(0, 2, 4), reference)))

    def test_l2_force_difference(self) -> None:
        """A force 10 % larger has a difference of .1; NaN if the history ends before the reference."""
        reference = pulses(0, 2, 4, 2, 0, 0)
        self.assertAlmostEqual(l2_force_difference(pulses(0, 2.2, 4.4, 2.2, 0, 0, 0), reference), 0.1, delta=1e-14)
        self.assertAlmostEqual(l2_force_difference(pulses(0, 2, 4, 2, 1, 0), reference), 24**-0.5, delta=1e-14)
        self.assertTrue(np.isnan(l2_force_difference(pulses(0, 2, 4), reference)))

    def test_nan_stays_nan(self) -> None:
        """One NaN among the forces makes all quantities NaN."""
        with_nan = pulses(0, 2, 4, np.nan, 0, 0)
        for name in ("peak_force", "peak_force_time", "contact_begin", "contact_release", "second_peak_force"):
            self.assertTrue(np.isnan(QUANTITIES[name](with_nan)), name)
        self.assertTrue(np.isnan(rms_force_difference(with_nan, pulses(0, 2, 4, 2, 0, 0))))
