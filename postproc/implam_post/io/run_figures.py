"""Figures of one run: all numbers of its summary, and what ASTM D7136 asks for, each with its dimension."""

import json
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from implam_post.io import damage_resistance
from implam_post.io.deck import recorded_deck, system_of_deck
from implam_post.io.errors import FileError, ImplamError
from implam_post.io.fields import Fields, read_fields
from implam_post.io.files import read_text
from implam_post.io.history import History, read_history
from implam_post.io.units import SYSTEMS

SUMMARY = "_summary.json"
# Members of a summary that are no figures of the run.
_APART = ("costs", "profile", "provenance", "estimated_errors", "exit", "warnings", "plies", "interfaces", "plate_size")
# Dimensions by what the name of a figure ends or begins with, the first that fits.
_DIMENSIONS = (("_at", "time"), ("contact_duration", "time"), ("contact_until", "time"), ("time_reached", "time"),
               ("force", "force"), ("velocity", "velocity"), ("area", "area"), ("energy", "energy"),
               ("work_external", "energy"), ("deflection", "length"), ("displacement", "length"), ("dent", "length"),
               ("damage_", "length"), ("depth", "length"))
_OF_ENDED_CONTACT = ("contact_duration", "contact_until")
_EVENTS = ("onset", "first_growth")


class Measured(NamedTuple):
    """A figure, NaN where a run has none, and its dimension."""

    value: float
    dimension: str


class Results(NamedTuple):
    """What a run has left: its summary, and history and fields if they are there."""

    summary: Mapping[str, Any]
    history: History | None
    fields: Fields | None

    @property
    def system(self) -> str:
        """Return the system of units that the deck tells; empty if none."""
        try:
            deck = recorded_deck(self.summary["provenance"], Path(f"{self.summary['case']}.nml"))
        except ImplamError:
            return ""
        return system_of_deck(deck)


def read_summary(path: Path) -> dict[str, Any]:
    """Read what a run says."""
    try:
        summary = json.loads(read_text(path, "the summary"))
    except ValueError as error:
        raise FileError(f"{path} isn't a summary written by implam ({error}).") from None
    if not isinstance(summary, dict) or not {"case", "exit", "plies", "provenance"} <= summary.keys():
        raise FileError(f"{path} isn't a summary written by implam.")
    return summary


def read_results(path: Path) -> Results:
    """Read a summary, and the history and the fields beside it."""
    base = path.with_name(path.name.removesuffix(SUMMARY))
    history, fields = base.with_name(f"{base.name}_history.csv"), base.with_name(f"{base.name}.h5")
    return Results(read_summary(path), read_history(history) if history.exists() else None,
                   read_fields(fields) if fields.exists() else None)


def results_in(folder: Path) -> Results:
    """Read the results of the only run in a folder."""
    found = sorted(folder.glob(f"*{SUMMARY}"))
    if not found:
        raise FileError(f"{folder} holds no summary of a run.")
    return read_results(found[0])


def corner_of(results: Results) -> float | None:
    """Return the corner frequency of the low pass for the threshold force, in the deck's units; None if it has none."""
    given = results.summary.get("force_filter")
    if given:
        return float(given["frequency"])
    return damage_resistance.CORNER * SYSTEMS[results.system][2] if results.system in SYSTEMS else None


def resistance(results: Results) -> dict[str, Measured]:
    """Return what ASTM D7136 asks for beyond the summary; NaN where the force never drops, or nothing is damaged."""
    found: dict[str, Measured] = {}
    history, corner = results.history, corner_of(results)
    if history is not None and np.any(history["force"]) and "impactor_displacement" in history.columns:
        turned = damage_resistance.threshold(history, corner) if corner else None
        force, time, energy = (turned.force, turned.time, turned.energy) if turned else 3 * (math.nan,)
        found |= {"threshold_force": Measured(force, "force"), "threshold_at": Measured(time, "time"),
                  "energy_to_threshold": Measured(energy, "energy"),
                  "energy_to_peak": Measured(damage_resistance.energy_to_peak(history), "energy"),
                  "largest_displacement": Measured(float(np.max(history["impactor_displacement"])), "length")}
    if results.fields is not None and results.fields.snapshots[-1].mesh.interfaces:
        size = damage_resistance.extent(results.fields)
        told = dict.fromkeys(("damage_diameter", "damage_length", "damage_width"), 0.0) if size is None else {
            "damage_diameter": size.diameter, "damage_length": size.length, "damage_width": size.width}
        told |= {f"damage_along_{angle}".replace("-", "minus_"): size.through[angle] if size else 0.0
                 for angle in damage_resistance.DIRECTIONS}
        found |= {name: Measured(value, "length") for name, value in told.items()}
    return found


def figures(results: Results) -> dict[str, Measured]:
    """Return all figures of a run by name: those of the summary, of its interfaces, and those of ASTM D7136."""
    found = {name: Measured(value, _dimension(name)) for name, value in _numbers(results.summary)}
    return found | resistance(results)


def _numbers(summary: Mapping[str, Any]) -> Iterator[tuple[str, float]]:
    """Give the numbers of a summary under their names, those of an interface with the ply above it."""
    for name, value in summary.items():
        if name in _APART:
            continue
        if summary.get("in_contact") and name in _OF_ENDED_CONTACT:
            value = None
        if name == "force_filter" and value:
            yield "filtered_peak_force", value["peak_force"]
        elif _is_number(value):
            yield name, math.nan if value is None else float(value)
    for entry in summary.get("interfaces", []):
        below = f"below_{entry['ply_above']}"
        yield f"area_{below}", float(entry["area"])
        yield f"energy_{below}", float(entry["energy"])
        for event in _EVENTS:
            told = entry[event] or {}
            if "force" in told or not told:
                yield f"{event}_force_{below}", float(told.get("force", math.nan))
        for axis in ("x", "y"):
            yield f"{axis}_extent_{below}", float(entry[axis][1] - entry[axis][0])


def _is_number(value: object) -> bool:
    """Tell whether a member of a summary is a number, or one that the run does not have."""
    return value is None or (isinstance(value, (int, float)) and not isinstance(value, bool))


def _dimension(name: str) -> str:
    """Return the dimension of a figure, by its name."""
    if "_extent_" in name:
        return "length"
    return next((kind for word, kind in _DIMENSIONS
                 if (name.endswith(word) if word.startswith("_") else word in name)), "")
