"""The table of a sweep: a row for each case, with swept values, figures and exit code of its run."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np
import pandas as pd

from implam_post.io.deck import Deck, system_of_deck
from implam_post.io.deck_text import deck_value
from implam_post.io.errors import EXIT_DONE, DeckError, ImplamError
from implam_post.io.files import replaced, write_table
from implam_post.io.history import History, read_history
from implam_post.io.program import history_in, version_in
from implam_post.io.quantities import QUANTITIES
from implam_post.io.run import SUMMARY, read_summary
from implam_post.sweep.case_run import Record, read_record
from implam_post.sweep.runs import Sweep


@dataclass(frozen=True)
class Figure:
    """A figure of a run: the function that evaluates it, its dimension, and its label on an axis."""

    measure: Callable[[History], float]
    dimension: str
    label: str


def _area(history: History) -> float:
    """Return the delaminated area at the end, including starters; NaN if the history does not have it."""
    return float(history.columns.get("delaminated_area", [math.nan])[-1])


FIGURES = {
    "impact_energy": Figure(QUANTITIES["impact_energy"], "energy", "impact energy"),
    "peak_force": Figure(QUANTITIES["peak_force"], "force", "peak force"),
    "peak_force_time": Figure(QUANTITIES["peak_force_time"], "time", "time of peak force"),
    "contact_duration": Figure(QUANTITIES["contact_duration"], "time", "contact duration"),
    "max_deflection": Figure(QUANTITIES["max_deflection"], "length", "largest deflection"),
    "rebound_velocity": Figure(QUANTITIES["rebound_velocity"], "velocity", "rebound velocity"),
    "absorbed_energy": Figure(QUANTITIES["absorbed_energy"], "energy", "absorbed energy"),
    "delaminated_area": Figure(_area, "area", "delaminated area"),
    "first_growth_force": Figure(QUANTITIES["first_growth_force"], "force", "threshold force"),
    "first_growth_time": Figure(QUANTITIES["first_growth_time"], "time", "time of first growth"),
}


@dataclass
class Table:
    """Columns by name; missing numbers are NaN, missing texts are empty.

    `swept` are the columns set by the sweep, `derived` those of them given by formulas; `is_readable` is whether the
    results of all completed runs could be read.
    """

    columns: dict[str, list] = field(default_factory=dict)
    swept: list[str] = field(default_factory=list)
    derived: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    is_readable: bool = True
    decks: list[str] = field(default_factory=list)
    sweep: str = ""
    system: str = ""

    def numbers(self, name: str) -> np.ndarray | None:
        """Return a column as numbers; None if it has other values."""
        values = self.columns[name]
        if not all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in values):
            return None
        return np.array(values, dtype=float)


def make_table(sweep: Sweep, known: dict[str, dict[str, object]]) -> Table:
    """Return the table; `known` caches the figures of completed cases by deck between calls."""
    cases = sweep.plan.cases
    table = Table(swept=sweep.plan.names, derived=sweep.plan.derived, sweep=sweep.plan.text,
                  decks=[case.deck for case in cases])
    table.columns["case"] = [case.number for case in cases]
    for name in sweep.plan.names:
        table.columns[name] = [_plain(case.values.get(name, "")) for case in cases]
    rows = []
    for case in cases:
        folder = sweep.folder(case)
        record = read_record(folder)
        if case.key not in known or not known[case.key]["final"]:
            known[case.key] = {"final": record is not None and record.final, **_row(folder, record)}
        rows.append({**known[case.key], "folder": str(folder.relative_to(sweep.plan.output))})
    for name in (*FIGURES, "exit_code", "cpu_time", "version", "folder"):
        table.columns[name] = [row[name] for row in rows]
    table.notes, table.is_readable = _notes(rows), not any(row["fault"] for row in rows)
    table.system = sweep.plan.units or _system(cases[0].deck)
    return table


def write_csv(table: Table, path: Path) -> None:
    """Write the table as CSV; cells without a value are empty."""
    write_table(path, pd.DataFrame(table.columns, dtype=object))


def write_hdf5(table: Table, path: Path) -> None:
    """Write the table as HDF5: a data set for each column, the file of the sweep and the deck of each case."""
    with replaced(path) as draft, h5py.File(draft, "w") as file:
        columns = file.create_group("table", track_order=True)
        for name, values in table.columns.items():
            numbers = table.numbers(name)
            if numbers is not None and all(isinstance(value, int) for value in values):
                numbers = numbers.astype(int)
            data = list(map(str, values)) if numbers is None else numbers
            columns.create_dataset(name, data=data, dtype=h5py.string_dtype() if numbers is None else None)
            if name in FIGURES:
                columns[name].attrs["meaning"] = FIGURES[name].label
        file.create_dataset("decks", data=table.decks, dtype=h5py.string_dtype())
        file.attrs.update({"sweep": table.sweep, "swept": table.swept, "units": table.system or "the deck's"})


def _row(folder: Path, record: Record | None) -> dict[str, object]:
    """Return figures and exit code of one run; a failed run has no figures."""
    row: dict[str, object] = dict.fromkeys(FIGURES, math.nan)
    row |= {"exit_code": math.nan, "cpu_time": math.nan, "version": "", "fault": ""}
    if record is None:
        return row
    row |= {"exit_code": record.exit_code, "cpu_time": round(record.cpu_time, 3), "version": version_in(folder)}
    if record.exit_code != EXIT_DONE:
        return row
    try:
        path = history_in(folder)
        history = read_history(folder / "history.csv" if path is None else path)
        for summary in folder.glob(f"*{SUMMARY}"):
            read_summary(summary)  # raises an error if it is damaged; reading the history does not
        row |= {name: float(figure.measure(history)) for name, figure in FIGURES.items()}
    except ImplamError as error:
        row["fault"] = str(error)
    return row


def _notes(rows: Iterable[dict[str, object]]) -> list[str]:
    """Return the notes below the table."""
    versions = sorted({str(row["version"]) for row in rows if row["version"]})
    notes = [f"the runs are by several versions of Implam: {', '.join(versions)}."] if len(versions) > 1 else []
    return notes + [no_figures(row["fault"]) for row in rows if row["fault"]]


def no_figures(fault: object) -> str:
    """Return the note of a run whose results cannot be read."""
    return f"no figures: {fault}"


def _system(text: str) -> str:
    """Return the system of units of a deck; empty if the deck cannot be read."""
    try:
        return system_of_deck(Deck(text, Path("deck.nml")))
    except DeckError:
        return ""


def _plain(value: object) -> object:
    """Return a swept value as a cell: numbers as they are, other values as text of the deck."""
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return value if is_number else deck_value(value)
