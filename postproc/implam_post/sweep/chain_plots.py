"""Pictures of a sweep with a second deck: residual strength against impact energy, dent depth and projected area."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from implam_post.io.files import replaced
from implam_post.io.units import axis_of
from implam_post.sweep.chain import lower_bounds
from implam_post.sweep.plots import energies, series
from implam_post.sweep.table import FIGURES, Table

STRENGTH = "residual_strength"
_AGAINST = ("impact_energy", "dent_depth", "projected_area")
# Energies that differ by less belong to the same impact with other random inputs.
_DIGITS = 6


def plot_strength(table: Table, path: Path) -> Path | None:
    """Draw the strength of each run against energy, dent depth and area; None if no run has a strength.

    Runs of the same energy and series have a mean with the standard deviation of a single run.
    """
    strength = table.numbers(STRENGTH) if STRENGTH in table.columns else None
    if strength is None or not np.any(np.isfinite(strength)):
        return None
    bounds = lower_bounds(table)
    drawing = Figure(figsize=(12, 4.2), layout="constrained")
    up = axis_of(FIGURES[STRENGTH].label, "stress", strength, table.system)
    against = [name for name in _AGAINST if name in table.columns]
    for axes, name in zip(drawing.subplots(1, len(against), sharey=True, squeeze=False)[0], against, strict=True):
        values = table.numbers(name)
        along = axis_of(FIGURES[name].label, FIGURES[name].dimension, values, table.system)
        for place, (title, rows) in enumerate(series(table).items()):
            _draw(axes, along.factor * values[rows], up.factor * strength[rows], bounds[rows],
                  groups(energies(table)[rows]), f"C{place % 10}", title)
        axes.set_xlabel(along.label)
        axes.grid(alpha=0.3)
        axes.set_ylim(bottom=0)
    axes = drawing.axes[0]
    axes.set_ylabel(up.label)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize="small")
    with replaced(path) as draft:
        drawing.savefig(draft, dpi=150)
    return path


def groups(energies: np.ndarray) -> list[np.ndarray]:
    """Return the indices of the runs of each energy, in ascending order of the energies."""
    rounded = np.array([float(f"{energy:.{_DIGITS}g}") for energy in energies])
    return [np.flatnonzero(rounded == energy) for energy in np.unique(rounded)]


def _draw(axes: Axes, x: np.ndarray, y: np.ndarray, bounds: np.ndarray, together: list[np.ndarray], colour: str,
          title: str) -> None:
    """Draw the points of a series, and means with standard deviations if several runs have the same energy."""
    axes.plot(x[~bounds], y[~bounds], "o", color=colour, markersize=4, alpha=0.6)
    if np.any(bounds):
        named = "lower bound: not failed"
        again = named in axes.get_legend_handles_labels()[1]
        axes.plot(x[bounds], y[bounds], "^", color=colour, fillstyle="none", label=None if again else named)
    means = [(np.mean(x[kept]), np.mean(y[kept]), np.std(y[kept], ddof=1) if len(kept) > 1 else 0.0)
             for rows in together if len(kept := rows[np.isfinite(x[rows]) & np.isfinite(y[rows])])]
    if not means:
        return
    along, up, scatter = np.array(means).T
    axes.errorbar(along, up, yerr=scatter if np.any(scatter > 0) else None, color=colour, capsize=3, linewidth=1.2,
                  label=title or None)
