"""Tests of the table of a sweep and its plots, on small tables."""

import csv
import math
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

from implam_post.io.results import dimension_of
from implam_post.io.units import Axis, axis_of, system_of
from implam_post.sweep.plan import COLUMNS
from implam_post.sweep.plots import dimension_of_swept, plot_table, series
from implam_post.sweep.table import FIGURES, Table, write_csv, write_hdf5


def table(swept: dict[str, list], energies: list[float], derived: tuple[str, ...] = ()) -> Table:
    """Return a table with these values, a force and an area."""
    rows = len(energies)
    columns = {"case": list(range(1, rows + 1)), **swept, **{name: rows * [math.nan] for name in FIGURES}}
    columns |= {"impact_energy": energies, "peak_force": [1000.0 * energy for energy in energies],
                "delaminated_area": [1e-4 * energy for energy in energies], "exit_code": rows * [0],
                "cpu_time": rows * [1.0], "version": rows * ["1"], "folder": rows * ["cases/a"]}
    return Table(columns, list(swept), list(derived), [], rows * ["&case /"], "[grid]", "SI")


class TableTest(unittest.TestCase):
    """Files and pictures."""

    def setUp(self) -> None:
        """Make a folder."""
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def test_columns(self) -> None:
        """Reserved names include all other columns of the table."""
        names = tuple(table({}, [1.0]).columns)
        self.assertEqual(names, COLUMNS[: len(names)])

    def test_files(self) -> None:
        """CSV and HDF5 have the same values with all digits; missing ones are empty or NaN."""
        made = table({"laminate.angles": ["0, 90", "90"], "mass": [1, 0.1 + 0.2]}, [1 / 3, math.nan])
        write_csv(made, self.folder / "table.csv")
        write_hdf5(made, self.folder / "table.h5")
        with (self.folder / "table.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["laminate.angles"] for row in rows], ["0, 90", "90"])
        self.assertEqual([float(row["mass"]) for row in rows], [1, 0.1 + 0.2])
        self.assertEqual([row["impact_energy"] for row in rows], [repr(1 / 3), ""])
        with h5py.File(self.folder / "table.h5") as file:
            self.assertEqual(list(file["table"]), list(made.columns))
            self.assertEqual(file["table/exit_code"].dtype.kind, "i")
            np.testing.assert_array_equal(file["table/impact_energy"][()], [1 / 3, math.nan])
            self.assertEqual(list(file["table/laminate.angles"].asstr()), ["0, 90", "90"])

    def test_series(self) -> None:
        """Rows that differ only in energy, and in derived values, form a series in ascending energy."""
        grid = table({"G_c": [1, 1, 2, 2], "energy": [3.0, 2, 3, 2], "velocity": [6.0, 4, 6, 4]}, [3.0, 2, 3, 2],
                     ("velocity",))
        found = {label: rows.tolist() for label, rows in series(grid).items()}
        self.assertEqual(found, {"G_c=1": [1, 0], "G_c=2": [3, 2]})
        samples = table({"a": [1.0, 2.0, 3.0], "b": [4.0, 5.0, 6.0]}, [3.0, math.nan, 1.0])
        self.assertEqual({label: rows.tolist() for label, rows in series(samples).items()}, {"": [2, 0]})

    def test_plots(self) -> None:
        """Only columns with numbers are drawn."""
        drawn = plot_table(table({"energy": [1.0, 2.0]}, [1.0, 2.0]), self.folder)
        self.assertEqual([path.name for path in drawn], ["area_energy.png", "scatter.png"])
        self.assertGreater(min(path.stat().st_size for path in drawn), 5000)
        self.assertEqual(plot_table(table({"energy": [1.0]}, [math.nan]), self.folder / "none"), [])

    def test_dimensions_of_swept_values(self) -> None:
        """Keys have the dimension of their group, other names that of their last word."""
        for name, dimension in (("material.E", "stress"), ("material[2].E", "stress"), ("ply_damage.e", ""),
                                ("impactor.mass", "mass"), ("e", ""), ("energy", "energy"),
                                ("delamination[*].G_c", "toughness")):
            self.assertEqual(dimension_of_swept(name), dimension, name)

    def test_units(self) -> None:
        """Systems from the density of carbon/epoxy, and the same impact in each of them."""
        self.assertEqual([system_of(density) for density in (1580.0, 1.58e-9, 1.58e-6, 1.0, None)],
                         ["SI", "mm-t-s", "mm-kg-ms", "", ""])
        for system, force, area, speed in (("SI", 2500.0, 3e-4, 4.0), ("mm-t-s", 2500.0, 300.0, 4000.0),
                                           ("mm-kg-ms", 2.5, 300.0, 4.0)):
            for dimension, value, shown, unit in (("force", force, 2.5, "kN"), ("area", area, 300, "mm²"),
                                                  ("velocity", speed, 4, "m/s")):
                axis = axis_of("x", dimension, np.array([value, math.nan]), system)
                self.assertAlmostEqual(axis.factor * value / shown, 1, delta=1e-12)
                self.assertEqual(axis.label, f"x [{unit}]")
        self.assertEqual(axis_of("x", "energy", np.array([0.05]), "SI").label, "x [mJ]")
        self.assertEqual([dimension_of(name) for name in ("residual_strength", "effective_modulus", "contacts")],
                         ["stress", "stress", ""])
        self.assertEqual(axis_of("x", "force", np.array([2.5e6]), "mm-mN-kg-s"), Axis(1e-6, "x [kN]"))
        self.assertEqual(axis_of("x", "stress", np.array([5e4]), "mm-mN-kg-s").label, "x [MPa]")
        self.assertEqual(axis_of("x", "force", np.array([1.0]), "").label, "x (the deck's units)")
        self.assertEqual(axis_of("angle", "", np.array([1.0]), "SI").label, "angle")
