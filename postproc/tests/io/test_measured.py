"""Tests of measured curves in other units than those of the run."""

import unittest

import numpy as np

from implam_post.io.errors import FileError
from implam_post.io.history import History
from implam_post.io.measured import check_units

RUN = History({"time": np.linspace(0, 4e-3, 50), "force": 3e3 * np.sin(np.linspace(0, np.pi, 50)),
               "deflection": np.linspace(0, 2e-3, 50)}, "run.csv")


class MeasuredUnitsTest(unittest.TestCase):
    """A curve in ms, kN or mm beside a run in SI."""

    def test_other_units(self) -> None:
        """The sentence names file, column and both values."""
        for name, factor, reaches in (("time", 1e3, "time reaches 4, where the run reaches 0.004"),
                                      ("force", 1e-3, "force reaches 3, where the run reaches 3e+03"),
                                      ("deflection", 1e3, "deflection reaches 2, where the run reaches 0.002")):
            columns = {key: factor * values if key == name else values for key, values in RUN.columns.items()}
            with self.assertRaisesRegex(FileError, "^measured.csv: ") as caught:
                check_units(RUN, History(columns, "measured.csv"))
            self.assertIn(reaches, str(caught.exception))

    def test_same_units(self) -> None:
        """A shorter and weaker curve, one in other columns, and one of zeros are accepted."""
        check_units(RUN, History({"time": RUN.time / 9, "force": RUN["force"] / 9}, "short.csv"))
        check_units(RUN, History({"time": RUN.time, "strain": 1e6 * RUN["force"]}, "gauge.csv"))
        check_units(RUN, History({"time": RUN.time, "force": 0 * RUN["force"]}, "zero.csv"))
