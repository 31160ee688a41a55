"""Histories: columns of numbers over time."""

import io
import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from implam_post.io.errors import FileError
from implam_post.io.files import read_text
from implam_post.io.results import TABLES, dimension_of
from implam_post.io.units import unit_of

if TYPE_CHECKING:
    import pandas as pd

KEPT_ENERGIES = ("energy_impactor", "energy_kinetic", "energy_strain", "energy_indentation")
# Columns of every history.
ENERGIES = (*KEPT_ENERGIES, "energy_delamination", "energy_ply_damage", "energy_contact", "energy_algorithmic")
# Energies in legends and pages by their labels in the log, in the order of earlier versions, then those added since.
_LATER = ("energy_friction", "energy_layers", "energy_damping")
ENERGY_NAMES = {name: TABLES["summary"][name].label for name in (*ENERGIES, *_LATER)}
ENERGY_ERROR = TABLES["summary"]["energy_error"].label
_ENDING = "_history.csv"


@dataclass(frozen=True)
class History:
    """Columns of equal length by name, including `time`.

    `impact_energy` is the energy of the impactor before the first row, as in the summary; None: not known.
    In a run by load steps the times are load factors.
    """

    columns: dict[str, np.ndarray]
    name: str = ""
    impact_energy: float | None = None
    by_load_steps: bool = False

    def __getitem__(self, column: str) -> np.ndarray:
        """Return a column by its name."""
        if column not in self.columns:
            raise FileError(f"{self.name or 'the history'} has no column '{column}'.")
        return self.columns[column]

    @property
    def time(self) -> np.ndarray:
        """Times of the rows."""
        return self["time"]

    def table(self, system: str = "") -> "pd.DataFrame":
        """Return the columns as a table, with the unit of each in `attrs["units"]`; empty if it is not known.

        `system` is the system of units of the deck.
        """
        import pandas as pd

        table = pd.DataFrame(self.columns)
        table.attrs = {"name": self.name, "units": {name: unit_of(dimension_of(name), system) for name in table}}
        if self.by_load_steps:
            table.attrs["units"]["time"] = ""
        return table

    def until(self, time: float) -> "History":
        """Return the rows up to a time."""
        kept = self.time <= time * (1 + 1e-9)
        return replace(self, columns={name: values[kept] for name, values in self.columns.items()})

    def at(self, column: str, time: float) -> float:
        """Return a column's value at a time, between rows by linear interpolation; NaN outside the history."""
        if not self.time[0] <= time <= self.time[-1] * (1 + 1e-9):
            return float("nan")
        return float(np.interp(time, self.time, self[column]))


def read_history(path: Path | str) -> History:
    """Read a history from its CSV; the impact energy, and whether times are load factors, come from the other results.

    Lines that begin with # are comments.
    """
    history = read_columns(path)
    if not np.all(np.diff(history.time) > 0):
        raise FileError(f"the times of the history {path} do not increase.")
    summary = _summary_beside(Path(path))
    energy = summary.get("energy_impact")
    return replace(history, impact_energy=float(energy) if isinstance(energy, (int, float)) else None,
                   by_load_steps="load_factor_reached" in summary if summary else _is_static(Path(path)))


def _summary_beside(path: Path) -> dict[str, Any]:
    """Return the summary of the run of a history; empty if there is none, as before the end of the run."""
    summary = path.with_name(path.name.removesuffix(_ENDING) + "_summary.json")
    if not path.name.endswith(_ENDING) or not summary.exists():
        return {}
    try:
        found = json.loads(read_text(summary, "the summary"))
    except (FileError, ValueError, RecursionError):
        return {}  # damaged; functions that need the summary report it
    return found if isinstance(found, dict) else {}


def _is_static(path: Path) -> bool:
    """Return whether the run of a history has load steps, from the deck in its fields."""
    if not path.name.endswith(_ENDING) or not path.with_name(path.name.removesuffix(_ENDING) + ".h5").exists():
        return False
    # Importing h5py is slow.
    from implam_post.io.fields import deck_in

    deck = deck_in(path)
    return deck is not None and deck.has("static")


def read_columns(path: Path | str) -> History:
    """Read columns of numbers by name; rows may be in any order, and a time is not required."""
    import pandas as pd

    path = Path(path)
    text = read_text(path, "the history")
    lines = [(number, line) for number, line in enumerate(text.splitlines(), start=1)
             if line.strip() and line[0] != "#"]
    if len(lines) < 2:
        raise FileError(f"the history {path} has no rows.")
    widths = [line.count(",") + 1 for _, line in lines]
    for (number, _), width in zip(lines, widths, strict=True):
        if width != widths[0]:  # pandas would complete a short row
            raise FileError(f"the history {path} has {width} cells under {widths[0]} names in line {number}.")
    # Each complete row ends with a new line; without it the last number may have lost digits.
    if path.name.endswith(_ENDING) and not text.endswith("\n"):
        raise FileError(f"the history {path} is truncated in line {lines[-1][0]}, which has no end of line.")
    try:
        cells = pd.read_csv(io.StringIO("\n".join(line for _, line in lines)), skipinitialspace=True, dtype=str,
                            keep_default_na=False)
    except ValueError:
        raise FileError(f"the history {path} is not a table of numbers.") from None
    try:
        table = cells.astype(float)
    except ValueError:
        is_number = cells.apply(pd.to_numeric, errors="coerce").notna() | cells.isin(["nan", "NaN"])
        number = lines[1 + int((~is_number).any(axis=1).argmax())][0]
        raise FileError(f"the history {path} has a cell in line {number} that is not a number.") from None
    return History({name.strip(): table[name].to_numpy() for name in table}, str(path))
