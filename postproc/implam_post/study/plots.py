"""Plots of a study: error against processor time of every trial, with the Pareto front."""

import math
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from implam_post.io.files import replaced
from implam_post.study.plan import Study
from implam_post.study.table import LEAST, Mean, Row

_MAX_PROBLEMS, _COLUMNS, _MAX_NAMED = 12, 4, 24
_MARKS = "osD^v<>ph*XP"
_NARROWEST = 5.0  # up to this ratio of last to first value of an axis, ticks are at 1, 2 and 5
_WIDE = 1e3  # from this ratio on, ticks are at powers of ten only
_WORDS = {"peak_force": "error of peak force", "peak_force_time": "error of time of peak force",
          "contact_duration": "error of contact duration", "max_deflection": "error of largest deflection",
          "rebound_velocity": "error of rebound velocity", "force_history": "error of force history (L2)",
          "delaminated_area": "error of delaminated area"}


def plot_study(rows: list[Row], means: list[Mean], study: Study, path: Path) -> Path | None:
    """Draw a panel for each problem, and one of the means over all problems; None if no trial has an error yet."""
    panels = [(problem.name, [(row.trial.method, abs(row.errors.get(study.error, math.nan)), row.time, row.on_front)
                              for row in rows if row.trial.problem is problem])
              for problem in study.problems[:_MAX_PROBLEMS]]
    if len(study.problems) > 1 and means:
        panels.append(("all problems, geometric means",
                       [(mean.method, mean.errors[study.error], mean.time, mean.on_front) for mean in means]))
    if not any(math.isfinite(point[1]) for _, points in panels for point in points):
        return None
    columns = min(len(panels), _COLUMNS)
    lines = -(-len(panels) // columns)
    drawing = Drawing(figsize=(7, 5) if len(panels) == 1 else (3.6 * columns, 3.1 * lines + 0.6), layout="constrained")
    grid = drawing.subplots(lines, columns, squeeze=False).ravel()
    for axes, (name, points) in zip(grid, panels, strict=False):
        _draw(axes, points, study)
        axes.set_title(name, fontsize="medium")
    for axes in grid[len(panels):]:
        axes.set_visible(False)
    for axes in grid[max(len(panels) - columns, 0):len(panels)]:
        axes.set_xlabel("processor time [s]")
    for axes in grid[:len(panels):columns]:
        axes.set_ylabel(f"{_WORDS[study.error]} [%]")
    handles, labels = max((axes.get_legend_handles_labels() for axes in grid[:len(panels)]),
                          key=lambda entries: len(entries[1]))
    drawing.legend(handles, labels, loc="outside lower center", ncols=min(len(labels), 4), fontsize="small")
    with replaced(path) as draft:
        drawing.savefig(draft, dpi=150)
    return path


def series_of(study: Study) -> tuple[list[str], list[str]]:
    """Return the names with text values, which distinguish curves, and those with numbers, which vary along a curve."""
    words = [name for name in study.shown if any(isinstance(trial.method[name], str) for trial in study.trials)]
    numbers = [name for name in study.shown if name not in words]
    if not words and len(numbers) > 1:
        words, numbers = numbers[:1], numbers[1:]
    if not numbers:
        return words, []
    return words, numbers


def _draw(axes: Axes, points: list[tuple[dict[str, object], float, float, bool]], study: Study) -> None:
    """Draw the points of a problem as curves, and the Pareto front; trials without a result are omitted."""
    points = [point for point in points if math.isfinite(point[1]) and math.isfinite(point[2])]
    if not points:
        axes.text(0.5, 0.5, "no trial is complete", transform=axes.transAxes, horizontalalignment="center")
        axes.set(xticks=[], yticks=[])
        return
    words, numbers = series_of(study)
    curves: dict[str, list[tuple[float, float, str]]] = {}
    for method, error, time, _ in points:
        label = ", ".join(_short(method[name]) for name in words) or "trials"
        along = ", ".join(_short(method[name]) for name in numbers)
        curves.setdefault(label, []).append((time, max(100 * error, 100 * LEAST), along))
    for place, (label, curve) in enumerate(curves.items()):
        x, y, names = zip(*curve, strict=True)
        axes.plot(x, y, "-", marker=_MARKS[place % len(_MARKS)], color=f"C{place % 10}", markersize=4, linewidth=0.8,
                  alpha=0.8, label=label)
        if len(points) <= _MAX_NAMED:
            for time, up, name in zip(x, y, names, strict=True):
                if name and math.isfinite(up):
                    axes.annotate(name, (time, up), textcoords="offset points", xytext=(3, 3), fontsize=5)
    best = np.array(sorted((time, max(100 * error, 100 * LEAST)) for _, error, time, on_front in points if on_front))
    if len(best):
        axes.step(best[:, 0], best[:, 1], "k--", where="post", linewidth=1.2, label="Pareto front")
    axes.set(xscale="log", yscale="log")
    axes.margins(0.08)
    for axis, (first, last), set_limits in ((axes.xaxis, axes.get_xlim(), axes.set_xlim),
                                            (axes.yaxis, axes.get_ylim(), axes.set_ylim)):
        wider = max(math.sqrt(_NARROWEST * first / last), 1.0)
        set_limits(first / wider, last * wider)
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if last / first < _WIDE else (1,), numticks=12))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_locator(NullLocator())
    axes.grid(alpha=0.3, linewidth=0.4)


def _short(value: object) -> str:
    """Return a value of a method as a label."""
    if isinstance(value, list):
        return "x".join(map(_short, value))
    return f"{value:.3g}" if isinstance(value, float) else str(value) or "default"
