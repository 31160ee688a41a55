"""The results of a run: deck, summary, history, fields, warnings."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from implam_post.io.deck import Deck, recorded_deck, system_of_deck
from implam_post.io.errors import FileError, ImplamError
from implam_post.io.fields import Fields, NoTimeError, opened, read_fields
from implam_post.io.files import read_text
from implam_post.io.history import History, read_history
from implam_post.io.results import DIMENSIONS
from implam_post.io.summary_shape import misshapen_member, take_earlier_names
from implam_post.io.units import unit_of

if TYPE_CHECKING:
    import pandas as pd

    from implam_post.io.run_figures import Measured

SUMMARY, HISTORY, FIELDS = "_summary.json", "_history.csv", ".h5"


@dataclass(frozen=True)
class Field:
    """A field at one time: a value, or a row of components, at each place of the modelled part of the plate.

    Places are points or the centres of cells, (places, 3), z from the struck face to the back. `first_ply` is the first
    ply of each cell; the interface on top of the cell is below ply `first_ply - 1`, 0 for the bond of a
    doubler to the struck face. It is None for points.
    """

    name: str
    time: float
    values: np.ndarray
    coordinates: np.ndarray
    unit: str
    meaning: str
    first_ply: np.ndarray | None = None


class Summary(dict[str, Any]):
    """Members of NAME_summary.json; the error on a missing member names the file."""

    def __init__(self, members: Mapping[str, Any], path: Path) -> None:
        """Keep the members."""
        super().__init__(members)
        self.path = path

    def __missing__(self, name: str) -> object:
        """Raise the error on a missing member."""
        raise FileError(f"{self.path} lacks '{name}': the run has no such figure, or the file is damaged.")


class Run:
    """The results of a run; each part is read when it is first used.

    `base` is the common part of its file names: DIRECTORY/NAME for NAME_summary.json, NAME_history.csv, NAME.h5.
    """

    def __init__(self, base: Path) -> None:
        """Store the paths; files are read later."""
        self.base = base

    def __repr__(self) -> str:
        """Return the path of the results."""
        return f"Run({str(self.base)!r})"

    @property
    def name(self) -> str:
        """Name of the case."""
        return self.base.name

    @cached_property
    def summary(self) -> Mapping[str, Any]:
        """All members of NAME_summary.json."""
        return read_summary(self._file(SUMMARY))

    @property
    def warnings(self) -> list[str]:
        """Warnings of the run, in order."""
        return [warning["text"] for warning in self.summary["warnings"]]

    @property
    def ending(self) -> str:
        """How the run ended: done, stopped or failed."""
        return str(self.summary["exit"]["kind"])

    @cached_property
    def deck(self) -> Deck:
        """The deck of the run, with the values of its published materials."""
        if self._file(SUMMARY).exists():
            return recorded_deck(self.summary["provenance"], self._file(".nml"))
        with opened(self._file(FIELDS)) as file:
            return recorded_deck(file["provenance"], self._file(".nml"))

    @cached_property
    def system(self) -> str:
        """System of units of the deck; empty if it is not known."""
        try:
            return system_of_deck(self.deck)
        except ImplamError:
            return ""

    @cached_property
    def columns(self) -> History | None:
        """Columns of the history as arrays, for the functions of this package; None if there is no history."""
        path = self._file(HISTORY)
        return read_history(path) if path.exists() else None

    @cached_property
    def history(self) -> "pd.DataFrame":
        """The history as a table, a row for each accepted step; `attrs["units"]` has the unit of each column."""
        if self.columns is None:
            raise FileError(f"there is no history {self._file(HISTORY)}.")
        return self.columns.table(self.system)

    @cached_property
    def fields(self) -> Fields | None:
        """State of interfaces and plies in plan at the times written; None if there are none yet."""
        path = self._file(FIELDS)
        try:
            return read_fields(path) if path.exists() else None
        except NoTimeError:
            return None

    @cached_property
    def times(self) -> np.ndarray:
        """Times at which fields were written."""
        with opened(self._file(FIELDS)) as file:
            return np.array([float(file["times"][name]["time"][()]) for name in sorted(file["times"])])

    @cached_property
    def field_names(self) -> list[str]:
        """Names of the fields at the last time."""
        with opened(self._file(FIELDS)) as file:
            last = file["times"][max(file["times"])]
            return [*last.get("points", ()), *last.get("cells", ())]

    def field(self, name: str, time: float | None = None) -> Field:
        """Return a field at the time written that is nearest to `time`; at the last one if none is given."""
        place = -1 if time is None else int(np.argmin(np.abs(self.times - time)))
        with opened(self._file(FIELDS)) as file:
            group = file["times"][sorted(file["times"])[place]]
            where = next((where for where in ("points", "cells") if name in group.get(where, ())), None)
            if where is None:
                raise ImplamError(f"{self._file(FIELDS)} has no field {name}; it has {', '.join(self.field_names)}.")
            mesh, values = file["meshes"][f"{int(group['mesh'][()]):08d}"], group[where][name]
            places = mesh["coordinates"][()]
            first_ply = None
            if where == "cells":  # the last of the nine points of a cell is its centre
                places, first_ply = places[mesh["connectivity"][:, 8]], mesh["cells/first_ply"][()].astype(int)
            unit, meaning = (bytes(values.attrs.get(key, b"")).decode() for key in ("unit", "meaning"))
            unit = unit_of(DIMENSIONS.get(unit, unit), self.system) or unit.replace("-", "")
            return Field(name, float(group["time"][()]), values[()], places, unit, meaning, first_ply)

    @cached_property
    def figures(self) -> "Mapping[str, Measured]":
        """All single numbers of the run by name: those of the summary, of its interfaces, and those of ASTM D7136."""
        from implam_post.io.run_figures import figures

        return figures(self)

    def close_fields(self) -> None:
        """Free the memory of the fields; they are read again when they are needed."""
        self.__dict__.pop("fields", None)

    def _file(self, ending: str) -> Path:
        """Return the path of one of the result files."""
        return self.base.with_name(f"{self.base.name}{ending}")


def material_of(ply: Mapping[str, Any]) -> str:
    """Return the name of the material of a ply in a summary; `made_of` is its older name."""
    return str(ply.get("material", ply.get("made_of", "")))


def open_run(path: Path | str) -> Run:
    """Open a run by the folder of its results, or by its summary, history or fields."""
    path = Path(path)
    if path.is_dir():
        found = sorted({found.name.removesuffix(ending) for ending in (SUMMARY, HISTORY)
                        for found in path.glob(f"*{ending}")})
        if not found:
            raise FileError(f"{path} has no summary of a run.")
        if len(found) > 1:
            raise FileError(f"{path} has the results of several runs, {', '.join(found)}: give one NAME{SUMMARY}.")
        return Run(path / found[0])
    for ending in (SUMMARY, HISTORY, FIELDS):
        if path.name.endswith(ending) and not path.name.endswith("_restart.h5"):
            if not path.exists():
                raise FileError(f"{path} cannot be read: there is no such file.")
            return Run(path.with_name(path.name.removesuffix(ending)))
    raise FileError(f"{path} is not one of NAME{SUMMARY}, NAME{HISTORY}, NAME{FIELDS}, or a folder with one.")


def read_summary(path: Path) -> Summary:
    """Read the summary of a run."""
    try:
        summary = json.loads(read_text(path, "the summary"))
    except json.JSONDecodeError as error:
        raise FileError(f"{path} is not a summary written by implam (line {error.lineno} is not JSON).") from None
    except (ValueError, RecursionError):
        raise FileError(f"{path} is not a summary written by implam.") from None
    if not isinstance(summary, dict) or not {"case", "exit", "plies", "provenance"} <= summary.keys():
        raise FileError(f"{path} is not a summary written by implam.")
    take_earlier_names(summary)
    if wrong := misshapen_member(summary):
        raise FileError(f"{path} is not a summary written by implam, or it is damaged ({wrong}).")
    return Summary(summary, path)
