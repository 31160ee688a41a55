"""Single numbers that characterize a history: peaks, contacts, rebound, energy. NaN in the data results in NaN.

They compare a history with measured, analytical and other histories, which have no summary, and are more accurate than
the rows: peaks and ends of contact lie between them. Figures of a run are those of its summary (`run_figures`).
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from implam_post.io.history import ENERGIES, KEPT_ENERGIES, History


class Peak(NamedTuple):
    """The largest value of a column, and its time."""

    value: float
    time: float


class Contact(NamedTuple):
    """An interval of time with contact force; its end is NaN if the history ends in contact."""

    begin: float
    end: float


_GROWN = 2  # stage of an interface
NO_PEAK, NO_CONTACT = Peak(np.nan, np.nan), Contact(np.nan, np.nan)


def peak(history: History, column: str, window: Contact | None = None) -> Peak:
    """Return the largest value of a column, in a time window if given, by a parabola through the rows at the peak."""
    time, values = history.time, history[column]
    if window is not None:
        inside = (time >= window.begin) & ~(time > window.end)
        time, values = time[inside], values[inside]
    if not len(values) or not np.all(np.isfinite(values)):
        return NO_PEAK
    top = int(np.argmax(values))
    if not 0 < top < len(values) - 1:
        return Peak(float(values[top]), float(time[top]))
    left, right = time[top - 1] - time[top], time[top + 1] - time[top]
    rise_left, rise_right = values[top - 1] - values[top], values[top + 1] - values[top]
    curvature = (rise_left / left - rise_right / right) / (left - right)
    if curvature == 0:
        return Peak(float(values[top]), float(time[top]))
    slope = rise_left / left - curvature * left
    return Peak(float(values[top] - slope**2 / (4 * curvature)), float(time[top] - slope / (2 * curvature)))


def contacts(history: History) -> list[Contact]:
    """Return the contacts in order; they begin and end where force**(2/3), linear in the indentation, is zero."""
    time, force = history.time, history["force"]
    if not np.all(np.isfinite(force)):
        return [NO_CONTACT]
    touching = force > 0
    changes = np.diff(np.concatenate([[False], touching, [False]]).astype(int))
    depth = np.maximum(force, 0)**(2 / 3)
    found = []
    for first, after in zip(np.flatnonzero(changes == 1), np.flatnonzero(changes == -1), strict=True):
        begin = _zero(time, depth, first, 1, time[first - 1] if first else min(0.0, time[0]))
        end = _zero(time, depth, after - 1, -1, time[after]) if after < len(time) else np.nan
        found.append(Contact(float(begin), float(end)))
    return found


def _zero(time: np.ndarray, depth: np.ndarray, row: np.integer, inward: int, limit: float) -> float:
    """Return the time, between row and limit, of zero `depth`, extrapolated from `row` and its neighbour in contact."""
    neighbour = row + inward
    if not 0 <= neighbour < len(time) or depth[neighbour] <= depth[row]:
        return limit
    zero = time[row] - depth[row] * (time[neighbour] - time[row]) / (depth[neighbour] - depth[row])
    return float(np.clip(zero, min(limit, time[row]), max(limit, time[row])))


def contact(history: History, number: int) -> Contact:
    """Return one of the contacts, counted from 0; NaN if it does not exist."""
    found = contacts(history)
    return found[number] if number < len(found) else NO_CONTACT


def second_peak(history: History) -> Peak:
    """Return the largest force of the second contact."""
    second = contact(history, 1)
    return NO_PEAK if np.isnan(second.begin) else peak(history, "force", second)


def rebound_velocity(history: History) -> float:
    """Return the impactor's velocity at the end of the last contact, positive away from the plate."""
    found = contacts(history)
    return -history.at("impactor_velocity", found[-1].end) if found else np.nan


def contact_duration(history: History) -> float:
    """Return the total time of all contacts; NaN if the last one has not ended."""
    found = contacts(history)
    return float(sum(one.end - one.begin for one in found)) if found else np.nan


def impact_energy(history: History) -> float:
    """Return the kinetic and gravitational energy of the impactor at the start, as written by the run.

    For a history alone it is the total energy in the first row minus the work of pressure and lines, which equals the
    energy of the impactor if the plate had none initially.
    """
    if history.impact_energy is not None:
        return history.impact_energy
    return float(sum(history[column][0] for column in ENERGIES) - history["work_external"][0])


def absorbed_energy(history: History) -> float:
    """Return the kinetic and gravitational energy that the impactor has lost at the end of the last contact."""
    found = contacts(history)
    return impact_energy(history) - history.at("energy_impactor", found[-1].end) if found else np.nan


def energy_error(history: History) -> float:
    """Return the largest error of the energy balance, as a fraction of the total energy at the start."""
    initial = sum(history[column][0] for column in ENERGIES)
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.max(np.abs(history["energy_error"])) / np.abs(initial))


def energy_rise(history: History) -> float:
    """Return the largest increase of energy minus work of pressure over any window, over the energy at the start."""
    kept = sum(history[column] for column in KEPT_ENERGIES) - history["work_external"]
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.max(kept - np.minimum.accumulate(kept)) / np.abs(kept[0]))


def growth_rows(history: History) -> np.ndarray:
    """Return the rows at which delaminations have grown; none if the history has no delaminated area."""
    area = history.columns.get("delaminated_area", np.zeros(len(history.time)))
    return 1 + np.flatnonzero(np.diff(area) > 1e-9 * np.max(area, initial=0))


def first_growth(history: History) -> Peak:
    """Return force and time of the first row in which a delamination has grown, as in the summary.

    Histories without the stages of the interfaces have grown where the delaminated area has.
    """
    stages = [values for name, values in history.columns.items() if name.startswith("stage_below_")]
    rows = (np.flatnonzero(np.any([(values >= _GROWN) & (values[0] < _GROWN) for values in stages], axis=0))
            if stages else growth_rows(history))
    if not len(rows):
        return NO_PEAK
    return Peak(float(history["force"][rows[0]]), float(history.time[rows[0]]))


def rms_force_difference(history: History, reference: History) -> float:
    """Return the rms difference of the forces in the first contact, as a fraction of the peak of the reference.

    The window ends with the later end of contact of the two. NaN if either history ends before that.
    """
    first, other = contact(reference, 0), contact(history, 0)
    both = [max(one.end if np.isfinite(one.end) else data.time[-1], one.begin)
            for one, data in ((first, reference), (other, history))]
    grid = reference.time[(reference.time >= first.begin) & (reference.time <= max(both))]
    if np.isnan(other.begin) or not len(grid) or max(both) > (1 + 1e-6) * min(history.time[-1], reference.time[-1]):
        return np.nan
    difference = np.interp(grid, history.time, history["force"]) - np.interp(grid, reference.time, reference["force"])
    weights = np.gradient(grid) if len(grid) > 1 else np.ones(1)
    return float(np.sqrt(weights @ difference**2 / np.sum(weights)) / np.max(reference["force"]))


def l2_force_difference(history: History, reference: History) -> float:
    """Return the relative L2 difference of the forces over the time of the reference; NaN if the history is shorter."""
    grid = reference.time
    if len(grid) < 2 or history.time[-1] * (1 + 1e-6) < grid[-1]:
        return np.nan
    weights = np.gradient(grid)
    # The first row is the end of the first step; the force before it is zero.
    difference = np.interp(grid, history.time, history["force"], left=0) - reference["force"]
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.sqrt(weights @ difference**2 / (weights @ reference["force"]**2)))


QUANTITIES: dict[str, Callable[[History], float]] = {
    "peak_force": lambda history: peak(history, "force").value,
    "peak_force_time": lambda history: peak(history, "force").time,
    "contact_begin": lambda history: contact(history, 0).begin,
    "contact_release": lambda history: contact(history, 0).end,
    "second_contact_begin": lambda history: contact(history, 1).begin,
    "second_contact_release": lambda history: contact(history, 1).end,
    "second_peak_force": lambda history: second_peak(history).value,
    "second_peak_force_time": lambda history: second_peak(history).time,
    "max_deflection": lambda history: peak(history, "deflection").value,
    "max_deflection_time": lambda history: peak(history, "deflection").time,
    "first_growth_force": lambda history: first_growth(history).value,
    "first_growth_time": lambda history: first_growth(history).time,
    "contact_duration": contact_duration,
    "rebound_velocity": rebound_velocity,
    "impact_energy": impact_energy,
    "absorbed_energy": absorbed_energy,
    "energy_error": energy_error,
    "energy_rise": energy_rise,
}

COLUMN_QUANTITIES: dict[str, Callable[[np.ndarray], float]] = {
    "final": lambda values: float(values[-1]),
    "max": lambda values: float(np.max(values)),
    "min": lambda values: float(np.min(values)),
    "max_abs": lambda values: float(np.max(np.abs(values))),
}

AGAINST_QUANTITIES: dict[str, Callable[[History, History], float]] = {
    "rms_force": rms_force_difference,
    "l2_force": l2_force_difference,
}
