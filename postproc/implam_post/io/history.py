"""A history: columns of numbers against time."""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from implam_post.io.errors import FileError
from implam_post.io.files import read_text

KEPT_ENERGIES = ("energy_impactor", "energy_kinetic", "energy_strain", "energy_indentation")
# Those of every history.
ENERGIES = (*KEPT_ENERGIES, "energy_delamination", "energy_ply_damage", "energy_contact", "energy_algorithmic")
# What each is called in legends and pages, as in the summary; histories of earlier versions lack the last three.
ENERGY_NAMES = {"energy_impactor": "impactor", "energy_kinetic": "kinetic", "energy_strain": "strain",
                "energy_indentation": "indentation", "energy_delamination": "delamination",
                "energy_ply_damage": "ply damage", "energy_contact": "contact",
                "energy_algorithmic": "algorithmic dissipation", "energy_friction": "friction",
                "energy_layers": "layers", "energy_damping": "damping"}
UNACCOUNTED = "not accounted for"


@dataclass(frozen=True)
class History:
    """Columns by name, all of one length, `time` among them."""

    columns: dict[str, np.ndarray]
    name: str = ""

    def __getitem__(self, column: str) -> np.ndarray:
        """Return a column by its name."""
        if column not in self.columns:
            raise FileError(f"{self.name or 'the history'} has no column '{column}'.")
        return self.columns[column]

    @property
    def time(self) -> np.ndarray:
        """Times of the rows."""
        return self["time"]

    def until(self, time: float) -> "History":
        """Return the rows up to a time."""
        kept = self.time <= time * (1 + 1e-9)
        return History({name: values[kept] for name, values in self.columns.items()}, self.name)

    def at(self, column: str, time: float) -> float:
        """Return a column's value at a time, between rows by linear interpolation; NaN outside the history."""
        if not self.time[0] <= time <= self.time[-1] * (1 + 1e-9):
            return float("nan")
        return float(np.interp(time, self.time, self[column]))


def read_history(path: Path | str) -> History:
    """Read a history from the solver's CSV; lines that begin with # are comments."""
    history = read_columns(path)
    if not np.all(np.diff(history.time) > 0):
        raise FileError(f"the times of the history {path} do not increase.")
    return history


def read_columns(path: Path | str) -> History:
    """Read columns of numbers under their names, in any order of the rows and with or without a time."""
    path = Path(path)
    lines = [(number, line) for number, line in enumerate(read_text(path, "the history").splitlines(), start=1)
             if line.strip() and line[0] != "#"]
    try:
        rows = list(csv.reader((line for _, line in lines), skipinitialspace=True))
    except csv.Error as error:
        raise FileError(f"the history {path} is no table of numbers ({error}).") from None
    if len(rows) < 2:
        raise FileError(f"the history {path} has no rows.")
    names = [name.strip() for name in rows[0]]
    table = np.empty((len(rows) - 1, len(names)))
    for place, ((number, _), row) in enumerate(zip(lines[1:], rows[1:], strict=False)):
        if len(row) != len(names):
            raise FileError(f"the history {path} has {len(row)} cells under {len(names)} names in line {number}.")
        try:
            table[place] = [float(cell) for cell in row]
        except ValueError:
            raise FileError(f"the history {path} has a cell in line {number} that is no number.") from None
    return History(dict(zip(names, table.T, strict=True)), str(path))
