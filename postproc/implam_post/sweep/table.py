"""The table of a sweep: a row for each case, with swept values, figures and exit code of its run."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np
import pandas as pd

from implam_post.io.counts import counted
from implam_post.io.deck import Deck, system_of_deck
from implam_post.io.deck_text import deck_value
from implam_post.io.errors import DeckError, ImplamError
from implam_post.io.files import write_table
from implam_post.io.new_hdf5 import new_hdf5
from implam_post.io.program import version_in
from implam_post.io.results import dimension_of
from implam_post.io.run import open_run
from implam_post.io.run_figures import numbers_of
from implam_post.sweep.case_run import Record, read_record
from implam_post.sweep.runs import OUTDATED, Sweep


@dataclass(frozen=True)
class Figure:
    """A column with a figure of the runs: member of the summary, and its label on an axis.

    `is_of_second` says whether it belongs to the second run of a case with `then`.
    """

    member: str
    label: str
    is_of_second: bool = False

    @property
    def dimension(self) -> str:
        """Dimension of the member."""
        return dimension_of(self.member)


FIGURES = {
    "impact_energy": Figure("energy_impact", "impact energy"),
    "peak_force": Figure("peak_force", "peak force"),
    "peak_force_time": Figure("peak_force_at", "time of peak force"),
    "contact_duration": Figure("contact_duration", "contact duration"),
    "max_deflection": Figure("largest_deflection", "largest deflection"),
    "rebound_velocity": Figure("rebound_velocity", "rebound velocity"),
    "absorbed_energy": Figure("energy_absorbed", "absorbed energy"),
    "delaminated_area": Figure("delaminated_area", "delaminated area"),
    "first_growth_force": Figure("first_growth_force", "force at first growth"),
    "first_growth_time": Figure("first_growth_at", "time of first growth"),
    "dent_depth": Figure("dent_depth", "dent depth"),
    "projected_area": Figure("projected_area", "projected delaminated area"),
    "residual_strength": Figure("residual_strength", "residual strength", True),
    "shortening_at_strength": Figure("shortening_at_strength", "shortening at the strength", True),
    "failure_load": Figure("failure_load", "failure load", True),
    "skin_stress_at_strength": Figure("skin_stress_at_strength", "stress of the laminate at the strength", True),
    "effective_modulus": Figure("effective_modulus", "effective modulus", True),
    "has_failed": Figure("has_failed", "whether the plate has failed", True),
    "failure_code": Figure("failure_code", "failure code", True),
}
RUN_COLUMNS = ("exit_code", "cpu_time", "version", "folder")


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
            known[case.key] = {"final": record is not None and record.final,
                               **_row(folder, record, sweep.failure(case))}
        rows.append({**known[case.key], "folder": str(folder.relative_to(sweep.plan.output))})
    add_columns(table, [row["figures"] for row in rows], FIGURES)
    for name in RUN_COLUMNS:
        table.columns[name] = [row[name] for row in rows]
    outdated = sum(sweep.failure(case) == OUTDATED for case in cases)
    table.notes, table.is_readable = _notes(rows, outdated), not any(row["fault"] for row in rows)
    table.system = sweep.plan.units or _system(cases[0].deck)
    return table


def write_csv(table: Table, path: Path) -> None:
    """Write the table as CSV; cells without a value are empty."""
    write_table(path, pd.DataFrame(table.columns, dtype=object))


def write_hdf5(table: Table, path: Path) -> None:
    """Write the table as HDF5: a data set for each column, the file of the sweep and the deck of each case."""
    with new_hdf5(path) as file:
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


def add_columns(table: Table, rows: Sequence[Mapping[str, object]], names: Iterable[str]) -> None:
    """Add the columns of figures that some run has; all of them as long as there are no results.

    Cells without a value are NaN, or empty for texts.
    """
    found = [row for row in rows if row]
    for name in names:
        member, is_number = FIGURES[name].member, bool(FIGURES[name].dimension)
        if not found or any(member in row for row in found):
            table.columns[name] = [_cell(row.get(member), math.nan if is_number else "") for row in rows]


def _cell(value: object, missing: object) -> object:
    """Return the value of a cell."""
    if isinstance(value, bool):
        return str(value).lower()
    return missing if value is None else value


def figures_in(folder: Path) -> dict[str, object]:
    """Return the members of the summary in a folder that are figures of the table; None: not known, or not ended."""
    summary = open_run(folder).summary
    numbers = dict(numbers_of(summary))
    return {member: numbers.get(member, summary[member]) for figure in FIGURES.values()
            if (member := figure.member) in summary}


def _row(folder: Path, record: Record | None, failure: str) -> dict[str, object]:
    """Return figures and exit code of one run; a failed or outdated run has no figures."""
    row: dict[str, object] = {"figures": {}, "exit_code": math.nan, "cpu_time": math.nan, "version": "", "fault": ""}
    if record is None:
        return row
    row |= {"exit_code": record.exit_code, "cpu_time": round(record.cpu_time, 3), "version": version_in(folder)}
    if failure:
        return row
    try:
        row["figures"] = figures_in(folder)
    except ImplamError as error:
        row["fault"] = str(error)
    return row


def _notes(rows: Iterable[dict[str, object]], outdated: int) -> list[str]:
    """Return the notes below the table; `outdated` is the number of cases whose input files have changed since."""
    versions = sorted({str(row["version"]) for row in rows if row["version"]})
    notes = [f"the runs are by several versions of Implam: {', '.join(versions)}."] if len(versions) > 1 else []
    if outdated:
        notes.append(f"{counted(outdated, 'case')} without figures: a file that the deck reads has changed since.")
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
