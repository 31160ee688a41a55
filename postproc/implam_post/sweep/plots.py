"""Plots of a sweep: delaminated area and threshold force against energy, and figures against swept values."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.ticker import MaxNLocator

from implam_post.io.files import replaced
from implam_post.io.units import axis_of
from implam_post.sweep.table import FIGURES, Table

_MAX_SERIES, _MAX_COLUMNS, _LONGEST = 10, 6, 40
_SCATTERED = ("peak_force", "max_deflection", "absorbed_energy", "delaminated_area", "first_growth_force",
              "residual_strength")
# Dimensions of free names and keys; of keys only; and of keys of &material (e of &ply_damage is a fraction).
_WORDS = {"energy": "energy", "velocity": "velocity", "mass": "mass"}
_DIMENSIONS = {**_WORDS,
               **dict.fromkeys(("radius", "thicknesses", "ply_thickness", "patch", "cell", "starter"), "length"),
               **dict.fromkeys(("end", "step", "step_max"), "time"),
               **dict.fromkeys(("g_c", "g_ic", "g_iic"), "toughness")}
_OF_MATERIAL = dict.fromkeys(("e", "e1", "e1c", "e2", "g12", "g13", "g23", "xt", "xc", "yt", "yc", "s12"), "stress")


def plot_table(table: Table, folder: Path) -> list[Path]:
    """Draw the numeric columns of the table, and return the paths of the pictures."""
    drawn = []
    for name, figure in (("area_energy", "delaminated_area"), ("threshold_energy", "first_growth_force")):
        drawing = _against_energy(table, figure)
        if drawing is not None:
            drawn.append(_save(drawing, folder / f"{name}.png"))
    drawing = _scatter(table)
    return [*drawn, _save(drawing, folder / "scatter.png")] if drawing is not None else drawn


def series(table: Table) -> dict[str, np.ndarray]:
    """Return groups of rows that differ only in the impact energy, in ascending energy, by their common values.

    If there are too many groups, or none has two rows, all rows are one series without a name.
    """
    energy = energies(table)
    finite = np.isfinite(energy)
    swept = [name for name in _varied(table) if name not in table.derived]
    kept = [name for name in swept if not _changes_energy(table, swept, name, energy)]
    groups: dict[str, list[int]] = {}
    for row in np.flatnonzero(finite):
        label = ", ".join(f"{name}={_short(table.columns[name][row])}" for name in kept)
        groups.setdefault(label, []).append(int(row))
    if len(groups) > _MAX_SERIES or all(len(rows) < 2 for rows in groups.values()):
        groups = {"": [int(row) for row in np.flatnonzero(finite)]}
    return {label: np.array(rows)[np.argsort(energy[rows], kind="stable")] for label, rows in groups.items()}


def energies(table: Table) -> np.ndarray:
    """Return the impact energies; NaN without an impactor."""
    return numbers_or_nan(table, "impact_energy")


def numbers_or_nan(table: Table, name: str) -> np.ndarray:
    """Return the numbers of a column; NaN if the table does not have it."""
    found = table.numbers(name) if name in table.columns else None
    return np.full(len(table.decks), np.nan) if found is None else found


def _changes_energy(table: Table, swept: list[str], name: str, energy: np.ndarray) -> bool:
    """Return whether two rows that differ only in this swept value have different energies."""
    others = [other for other in swept if other != name]
    energy_of: dict[tuple, float] = {}
    for row in np.flatnonzero(np.isfinite(energy)):
        same = tuple(table.columns[other][row] for other in others)
        if abs(energy_of.setdefault(same, energy[row]) - energy[row]) > 1e-9 * abs(energy[row]):
            return True
    return False


def _against_energy(table: Table, name: str) -> Drawing | None:
    """Draw a figure against the impact energy; None if no case has it."""
    x, y = energies(table), numbers_or_nan(table, name)
    if not np.any(np.isfinite(x) & np.isfinite(y)):
        return None
    drawing = Drawing(figsize=(7, 4.5), layout="constrained")
    axes = drawing.subplots()
    along, up = (axis_of(FIGURES[column].label, FIGURES[column].dimension, values, table.system)
                  for column, values in (("impact_energy", x), (name, y)))
    for label, rows in series(table).items():
        axes.plot(along.factor * x[rows], up.factor * y[rows], "o-" if label else "o", label=label or None,
                  markersize=4)
    axes.set(xlabel=along.label, ylabel=up.label)
    axes.set_ylim(0, 1.08 * up.factor * np.nanmax(y[np.isfinite(x)]) or None)
    axes.grid(alpha=0.3)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize="small")
    return drawing


def _scatter(table: Table) -> Drawing | None:
    """Draw figures (rows) against swept values (columns); None without values."""
    figures = [name for name in _SCATTERED if np.any(np.isfinite(numbers_or_nan(table, name)))]
    swept = _varied(table)[:_MAX_COLUMNS]
    if not figures or not swept:
        return None
    drawing = Drawing(figsize=(2.8 * len(swept) + 1, 2.2 * len(figures) + 0.6), layout="constrained")
    grid = drawing.subplots(len(figures), len(swept), squeeze=False, sharex="col", sharey="row")
    for row, figure in enumerate(figures):
        values = table.numbers(figure)
        up = axis_of(FIGURES[figure].label, FIGURES[figure].dimension, values, table.system)
        for axes, name in zip(grid[row], swept, strict=True):
            label = _scatter_one(axes, table, name, up.factor * values)
            axes.grid(alpha=0.3)
            if row == len(figures) - 1:
                axes.set_xlabel(label)
        grid[row, 0].set_ylabel(up.label)
    return drawing


def _scatter_one(axes: Axes, table: Table, name: str, values: np.ndarray) -> str:
    """Draw numbers against a swept value, or against categories if it is not a number; return the label of the axis."""
    numbers = table.numbers(name)
    if numbers is not None:
        along = axis_of(name, dimension_of_swept(name), numbers, table.system)
        axes.plot(along.factor * numbers, values, "o", markersize=4, alpha=0.7)
        axes.xaxis.set_major_locator(MaxNLocator(5))
        return along.label
    axes.margins(x=0.3)
    words = list(dict.fromkeys(map(str, table.columns[name])))
    axes.plot([words.index(str(word)) for word in table.columns[name]], values, "o", markersize=4, alpha=0.7)
    axes.set_xticks(range(len(words)), [_short(word) for word in words], rotation=30, ha="right", fontsize="x-small")
    return name


def _varied(table: Table) -> list[str]:
    """Return the names whose values differ between cases."""
    return [name for name in table.swept if len(set(map(str, table.columns[name]))) > 1]


def dimension_of_swept(name: str) -> str:
    """Return the dimension of a swept name, from its last word."""
    group, _, word = name.lower().rpartition(".")
    if group.partition("[")[0] == "material" and word in _OF_MATERIAL:
        return _OF_MATERIAL[word]
    return (_DIMENSIONS if group else _WORDS).get(word, "")


def _short(value: object) -> str:
    """Return a value as a label."""
    text = f"{value:.4g}" if isinstance(value, float) else str(value)
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST - 3]}..."


def _save(drawing: Drawing, path: Path) -> Path:
    """Replace a picture."""
    with replaced(path) as draft:
        drawing.savefig(draft, dpi=150)
    return path
