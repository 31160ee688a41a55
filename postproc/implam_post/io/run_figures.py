"""Figures of runs: numbers of the summary and of ASTM D7136, with their dimensions; comparison of two runs."""

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from implam_post.io import damage_resistance
from implam_post.io.errors import ImplamError
from implam_post.io.quantities import l2_force_difference
from implam_post.io.results import dimension_of
from implam_post.io.run import Run
from implam_post.io.units import SYSTEMS, unit_of

if TYPE_CHECKING:
    import pandas as pd

# Members of a summary that are not figures of the run.
_NO_FIGURES = ("costs", "profile", "provenance", "estimated_errors", "exit", "warnings", "plies", "interfaces",
               "plate_size", "collapse", "failure_code")
_OF_ENDED_CONTACT = ("contact_duration", "contact_until")
_EVENTS = ("onset", "first_growth")
# Dimensions of members of the summary's lists, by the names of their figures without the interface.
_OF_LISTS = {"filtered_peak_force": "force", "onset_force": "force", "first_growth_force": "force",
             "x_extent": "length", "y_extent": "length"}


class Measured(NamedTuple):
    """A figure, NaN where a run has none, and its dimension."""

    value: float
    dimension: str


def corner_of(run: Run) -> float | None:
    """Return the corner frequency of the filter for the threshold force, in the deck's units; None if not known."""
    given = run.summary.get("force_filter")
    if given:
        return float(given["frequency"])
    return damage_resistance.CORNER * SYSTEMS[run.system][2] if run.system in SYSTEMS else None


def resistance(run: Run) -> dict[str, Measured]:
    """Return the figures of ASTM D7136 that are not in the summary; NaN if the force never drops or without damage.

    An impactor with given displacement has no impact energy, so that the energies are missing. Load steps have no time
    in which the force could be filtered, so that the threshold is missing.
    """
    found: dict[str, Measured] = {}
    history, corner = run.columns, corner_of(run)
    if history is not None and np.any(history["force"]) and "impactor_displacement" in history.columns:
        turned = damage_resistance.threshold(history, corner) if corner and not history.by_load_steps else None
        force, time, energy = (turned.force, turned.time, turned.energy) if turned else 3 * (math.nan,)
        found |= {"threshold_force": Measured(force, "force"), "threshold_at": Measured(time, "time"),
                  "largest_displacement": Measured(float(np.max(history["impactor_displacement"])), "length")}
        if "energy_impact" in run.summary:
            found |= {"energy_to_threshold": Measured(energy, "energy"),
                      "energy_to_peak": Measured(damage_resistance.energy_to_peak(history), "energy")}
    if run.fields is not None and run.fields.snapshots[-1].mesh.interfaces:
        size = damage_resistance.extent(run.fields)
        sizes = dict.fromkeys(("damage_diameter", "damage_length", "damage_width"), 0.0) if size is None else {
            "damage_diameter": size.diameter, "damage_length": size.length, "damage_width": size.width}
        sizes |= {f"damage_along_{angle}".replace("-", "minus_"): size.through[angle] if size else 0.0
                 for angle in damage_resistance.DIRECTIONS}
        found |= {name: Measured(value, "length") for name, value in sizes.items()}
    return found


def figures(run: Run) -> dict[str, Measured]:
    """Return all figures of a run by name: those of the summary, of its interfaces, and those of ASTM D7136."""
    found = {name: Measured(value, _dimension_of(name)) for name, value in numbers_of(run.summary)}
    if "load_factor_reached" in run.summary:
        found = {name: figure._replace(dimension="") if figure.dimension == "time" else figure
                 for name, figure in found.items()}
    return found | resistance(run)


def _dimension_of(name: str) -> str:
    """Return the dimension of a figure."""
    return _OF_LISTS.get(name.partition("_below_")[0]) or dimension_of(name)


def compare(first: Run, second: Run) -> "pd.DataFrame":
    """Return the figures of two runs: a row for each with both values, their difference, second/first - 1, and unit.

    `force_history` is the relative L2 norm of the difference of the contact forces over the time of the first run.
    """
    import pandas as pd

    if first.system != second.system:
        raise ImplamError(f"{first.name} and {second.name} have different units ({first.system or 'not known'}, "
                          f"{second.system or 'not known'}).")
    found = {name: [first.figures[name].value, second.figures[name].value, unit_of(figure.dimension, first.system)]
             for name, figure in first.figures.items() if name in second.figures}
    table = pd.DataFrame.from_dict(found, orient="index", columns=["first", "second", "unit"])
    table.insert(2, "difference", table["second"] - table["first"])
    table.insert(3, "relative", (table["difference"] / table["first"].abs()).where(table["first"] != 0))
    if first.columns is not None and second.columns is not None:
        relative = l2_force_difference(second.columns, first.columns)
        table.loc["force_history"] = [math.nan, math.nan, math.nan, relative, ""]
    return table


def numbers_of(summary: Mapping[str, Any]) -> Iterator[tuple[str, float]]:
    """Yield the numbers of a summary by name; names of interfaces include the number of the ply above."""
    for name, value in summary.items():
        if name in _NO_FIGURES:
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
            found = entry[event] or {}
            if "force" in found or not found:
                yield f"{event}_force_{below}", float(found.get("force", math.nan))
        for axis in ("x", "y"):
            yield f"{axis}_extent_{below}", float(entry[axis][1] - entry[axis][0])


def _is_number(value: object) -> bool:
    """Return whether a member of a summary is a number or null."""
    return value is None or (isinstance(value, (int, float)) and not isinstance(value, bool))
