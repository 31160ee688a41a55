"""The table of a study: a row for each trial, with errors against its reference, cost, and whether it is on the front.

Errors are relative to the reference, with sign, over the time of both histories; that of the force history is a
relative L2 norm.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd

from implam_post.io.deck_text import deck_value
from implam_post.io.errors import FileError, ImplamError
from implam_post.io.files import write_table
from implam_post.io.history import History, read_history
from implam_post.io.program import history_in, version_in
from implam_post.io.quantities import COLUMN_QUANTITIES, QUANTITIES
from implam_post.io.run import read_summary
from implam_post.study.plan import ERRORS, Study, Trial
from implam_post.study.references import References
from implam_post.sweep.case_run import read_record
from implam_post.sweep.plan import Case
from implam_post.sweep.runs import Sweep
from implam_post.sweep.table import FIGURES, figures_in

LEAST = 1e-6  # smaller errors count as this one
_FIGURES = tuple(name for name in ERRORS if name != "force_history")
_COSTS = {"unknowns": "unknowns", "steps": "", "solves": "solves", "factorizations": "refactorisations"}
# Column heads of the text, errors in %.
_HEADS = {"peak_force": "peak force, %", "peak_force_time": "peak time, %", "contact_duration": "contact, %",
          "max_deflection": "deflection, %", "rebound_velocity": "rebound, %", "force_history": "force history, %",
          "delaminated_area": "area, %"}


@dataclass
class Row:
    """Figures, errors and costs of a trial by name, NaN if missing. `end` is the reason for missing ones, or empty."""

    trial: Trial
    end: str
    figures: dict[str, float] = field(default_factory=dict)
    errors: dict[str, float] = field(default_factory=dict)
    costs: dict[str, float] = field(default_factory=dict)
    on_front: bool = False
    note: str = ""

    @property
    def time(self) -> float:
        """Return the least processor time of the runs."""
        return self.costs.get("cpu_time_min", math.nan)


@dataclass(frozen=True)
class Mean:
    """A method over all problems: geometric means of errors and time, largest errors, number of fronts it is on."""

    method: dict[str, object]
    errors: dict[str, float]
    worst: dict[str, float]
    time: float
    problems: int
    fronts: int
    on_front: bool = False


def make_rows(sweep: Sweep, study: Study, references: References) -> list[Row]:
    """Return the rows of all trials, with the front of each problem marked."""
    rows = [_row(sweep, study, trial, references) for trial in study.trials]
    for problem in study.problems:
        mine = [row for row in rows if row.trial.problem is problem]
        for row, on_front in zip(mine, front((_size(row, study.error), row.time) for row in mine), strict=True):
            row.on_front = on_front
    return rows


def _size(row: Row, error: str) -> float:
    """Return the absolute error, but at least LEAST; NaN if there is none."""
    size = abs(row.errors.get(error, math.nan))
    return max(size, LEAST) if math.isfinite(size) else size


def front(points: Iterable[tuple[float, float]]) -> list[bool]:
    """Return for each point whether it is on the Pareto front of two numbers to be minimized; NaN is not."""
    points = list(points)
    known_points = [all(map(math.isfinite, point)) for point in points]
    return [known and not any(other_known and other[0] <= point[0] and other[1] <= point[1] and other != point
                              for other, other_known in zip(points, known_points, strict=True))
            for point, known in zip(points, known_points, strict=True)]


def force_history_error(history: History, reference: History) -> float:
    """Return the L2 norm of the difference of forces over that of the reference, in the common time.

    Before the first row of a history the force is zero. NaN if the reference has no force in that time.
    """
    last = min(history.time[-1], reference.time[-1])
    grid = reference.time[reference.time <= last * (1 + 1e-9)]
    if len(grid) < 2:
        return math.nan
    force = reference["force"][:len(grid)]
    mine = np.interp(grid, np.append(min(0.0, history.time[0]), history.time), np.append(0.0, history["force"]))
    weights = np.gradient(grid)
    size = float(weights @ force**2)
    return math.sqrt(float(weights @ (mine - force)**2) / size) if size > 0 else math.nan


def _row(sweep: Sweep, study: Study, trial: Trial, references: References) -> Row:
    """Return the row of a trial: figures of its first run, times of all runs that have ended."""
    first = trial.runs[0]
    row = Row(trial, sweep.failure(first))
    if row.end:
        return row
    folder = sweep.folder(first)
    try:
        row.costs = _costs(sweep, trial.runs, folder)
        history = read_history(history_in(folder) or folder / "history.csv")
        found = figures_in(folder)
        row.figures = {name: _number(found.get(FIGURES[name].member)) for name in _FIGURES}
        row.figures |= {name: COLUMN_QUANTITIES[way](history[name]) for name, way in study.figures.items()}
        reference = references.of(trial)
        if reference is not None:
            last = min(history.time[-1], reference.time[-1])
            mine, true = _measured(history.until(last)), _measured(reference.until(last))
            row.errors = {name: _error(mine[name], true[name]) for name in _FIGURES}
            row.errors["force_history"] = force_history_error(history, reference)
    except ImplamError as error:
        row.note = str(error)
    return row


def _error(value: float, true: float) -> float:
    """Return a relative error with its sign; NaN if the true value is zero."""
    return value / true - 1 if true else math.nan


def _number(value: object) -> float:
    """Return a figure of a summary as a number; NaN if the run does not have it."""
    return float(value) if isinstance(value, (int, float)) else math.nan


def _measured(history: History) -> dict[str, float]:
    """Return the figures of a history alone, as the reference may have no summary; NaN without the columns."""
    found = {}
    for name in _FIGURES:
        try:
            found[name] = (float(history["delaminated_area"][-1]) if name == "delaminated_area"
                           else float(QUANTITIES[name](history)))
        except FileError:  # a measured history may not have the column
            found[name] = math.nan
    return found


def _costs(sweep: Sweep, runs: list[Case], folder: Path) -> dict[str, float]:
    """Return the costs of a trial: processor times of all its runs, and the counts in the summary of the first one."""
    records = [read_record(sweep.folder(run)) for run in runs]
    times = [record.cpu_time for record in records if record is not None and record.exit_code == 0]
    costs = {"cpu_time_min": min(times), "cpu_time_median": float(np.median(times)), "repeats": len(times)}
    path = next(iter(sorted(folder.glob("*_summary.json"))), None)
    summary = read_summary(path) if path else {}
    counted = summary.get("costs", {})
    costs |= {name: float(counted.get(key, math.nan)) for name, key in _COSTS.items() if key}
    costs["steps"] = float(summary.get("accepted_steps", math.nan))
    return costs


def means(rows: list[Row], study: Study) -> list[Mean]:
    """Return the means of methods over all problems; methods without a result of some problem are omitted."""
    found = []
    for method in {str(row.trial.method): row.trial.method for row in rows}.values():
        mine = [row for row in rows if row.trial.method == method]
        sizes = {name: np.array([_size(row, name) for row in mine]) for name in ERRORS}
        if any(row.end for row in mine):
            continue
        found.append(Mean(method, {name: _geometric(values) for name, values in sizes.items()},
                          {name: float(np.max(values)) for name, values in sizes.items()},
                          _geometric(np.array([row.time for row in mine])), len(mine),
                          sum(row.on_front for row in mine)))
    marks = front((mean.errors[study.error], mean.time) for mean in found)
    return [Mean(**{**mean.__dict__, "on_front": mark}) for mean, mark in zip(found, marks, strict=True)]


def _geometric(values: np.ndarray) -> float:
    """Return the geometric mean."""
    return float(np.exp(np.mean(np.log(values))))


def write_csv(rows: list[Row], sweep: Sweep, study: Study, path: Path) -> None:
    """Write the table as CSV in the deck's units, errors as fractions; cells without a value are empty."""
    costs = ("cpu_time_min", "cpu_time_median", "repeats", *_COSTS)
    table = []
    for row in rows:
        first = row.trial.runs[0]
        folder = sweep.folder(first)
        numbers = {name: row.figures.get(name, math.nan) for name in (*_FIGURES, *study.figures)}
        numbers |= {f"{name}_error": row.errors.get(name, math.nan) for name in ERRORS}
        numbers |= {name: row.costs.get(name, math.nan) for name in costs}
        table.append({"case": first.number, "problem": row.trial.problem.name,
                      **{name: deck_value(row.trial.method[name]) for name in study.methods}, **numbers,
                      "front": int(row.on_front), "end": row.end, "version": version_in(folder),
                      "folder": folder.relative_to(study.output)})
    write_table(path, pd.DataFrame(table), "%.8g")


def text_table(rows: list[Row], study: Study) -> str:
    """Return the table as text, errors in %; `*` marks the front, and empty columns are omitted."""
    errors = [name for name in ERRORS if any(math.isfinite(row.errors.get(name, math.nan)) for row in rows)]
    several = len(study.problems) > 1
    head = [*(["problem"] if several else []), *study.shown, *(_HEADS[name] for name in errors), *study.figures,
            "processor, s", *(["median"] if study.repeats > 1 else []), "steps", "solves", "factorizations", "front"]
    lines = []
    for row in rows:
        words = [*([row.trial.problem.name] if several else []), *(_shown(row.trial.method[name])
                                                                for name in study.shown)]
        if row.end:
            lines.append([*words, row.end.split(":")[0], *[""] * (len(head) - len(words) - 1)])
            continue
        costs = [row.costs.get(name, math.nan) for name in ("steps", "solves", "factorizations")]
        lines.append([*words, *(_percent(row.errors.get(name, math.nan), name) for name in errors),
                      *(f"{row.figures.get(name, math.nan):.4g}" for name in study.figures), f"{row.time:.2f}",
                      *([f"{row.costs.get('cpu_time_median', math.nan):.2f}"] if study.repeats > 1 else []),
                      *("" if math.isnan(cost) else f"{cost:.0f}" for cost in costs), "*" if row.on_front else ""])
    return _lined_up([head, *lines])


def text_means(found: list[Mean], study: Study) -> str:
    """Return the table of methods over all problems."""
    errors = [name for name in ERRORS if any(math.isfinite(mean.errors[name]) for mean in found)]
    head = [*study.shown, *(f"{_HEADS[name][:-3]}: mean, worst, %" for name in errors), "processor, s", "fronts",
            "front"]
    lines = [[*(_shown(mean.method[name]) for name in study.shown),
              *(f"{_small(mean.errors[name])}, {_small(mean.worst[name])}".strip(", ") for name in errors),
              f"{mean.time:.2f}", f"{mean.fronts} of {mean.problems}", "*" if mean.on_front else ""] for mean in found]
    return _lined_up([head, *lines])


def _shown(value: object) -> str:
    """Return a value of a method as text."""
    if isinstance(value, str):
        return value or "-"
    return f"{value:.4g}" if isinstance(value, float) else deck_value(value)


def _small(error: float) -> str:
    """Return an absolute error in % to two digits; errors up to LEAST are 0."""
    return "" if math.isnan(error) else f"{100 * error:.2g}" if error > 1.001 * LEAST else "0"


def _percent(error: float, name: str) -> str:
    """Return an error in %, rounded by its size; that of the force history has no sign."""
    if math.isnan(error):
        return ""
    digits = 2 if abs(error) < 0.1 else 1 if abs(error) < 1 else 0
    return f"{100 * error:{'' if name == 'force_history' else '+'}.{digits}f}"


def _lined_up(lines: list[list[str]]) -> str:
    """Return a table in Markdown with aligned columns."""
    widths = [max(len(line[place]) for line in lines) for place in range(len(lines[0]))]
    lines.insert(1, ["-" * width for width in widths])
    return "".join("| " + " | ".join(word.ljust(width) for word, width in zip(line, widths, strict=True)) + " |\n"
                   for line in lines)
