"""Pictures of histories and fields by `implam-plot`."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.transforms import ScaledTranslation

from implam_post.io.errors import FileError, ImplamError, reason
from implam_post.io.fields import Fields
from implam_post.io.files import replaced
from implam_post.io.history import ENERGY_ERROR, ENERGY_NAMES, History
from implam_post.plot.compression import compression_figure, is_compressed, remark_of
from implam_post.plot.curves import AXES, in_contact, rows_of_growth
from implam_post.plot.failures import draw_cracks, failures_figure
from implam_post.plot.front import front_figure
from implam_post.plot.plan import (
    FEW,
    add_times,
    delamination_figure,
    draw_delamination,
    draw_projected,
    draw_sizes,
    projected_figure,
)
from implam_post.plot.plan_frame import caption, reach_of
from implam_post.plot.section import section_figure
from implam_post.plot.style import ENERGIES, STYLES, PictureStyle, lay_out

RESPONSES = {"force": ("contact force", "force"), "indentation": ("indentation", "length"),
              "deflection": ("deflection of struck point", "length")}
_PLAIN = PictureStyle()
# Inches below axes for the label and ticks of the horizontal one.
_BELOW = 0.45


def plot_forces(histories: Sequence[History], path: Path) -> Path:
    """Draw the forces of several histories in one picture."""
    figure = Figure(figsize=(8, 4.5), layout="constrained")
    draw_response(figure.subplots(), histories, "force")
    return _save(figure, path)


def plot_response(histories: Sequence[History], path: Path, style: PictureStyle = _PLAIN,
                  measured: History | None = None) -> Path | None:
    """Draw force, indentation, deflection, all with measured values, and force against displacement.

    Without contact only the deflection is drawn, of compressions nothing, as `plot_compression` draws them.
    """
    struck = [history for history in histories if np.any(history.columns.get("force", 0))]
    if not struck and all(map(is_compressed, histories)):
        return None
    columns = list(RESPONSES) if struck else ["deflection"]
    figure = Figure(figsize=(7.5, 2.45 * (len(columns) + bool(struck)) + 0.2), layout="constrained")
    panels = np.ravel(figure.subplots(len(columns) + bool(struck), squeeze=False))
    for axes, column in zip(panels, columns, strict=False):
        axes.sharex(panels[0])
        draw_response(axes, histories if column == "deflection" else struck, column, style, measured)
    if struck:
        _draw_loop(panels[-1], struck, style)
    return _save(figure, path, style)


def plot_compression(histories: Sequence[History], path: Path, style: PictureStyle = _PLAIN,
                     summaries: Sequence[Mapping[str, Any]] | None = None,
                     undamaged: float | None = None) -> Path | None:
    """Draw stress and gauges of the histories that are compressions; None if there are none.

    Remarks are from the summaries of the runs, which may be empty; `undamaged` is the strength of the undamaged plate.
    """
    compressed = [(history, summary) for history, summary in
                  zip(histories, summaries or [{}] * len(histories), strict=True) if is_compressed(history)]
    if not compressed:
        return None
    names = _names([history.name for history, _ in compressed])
    remarks = {name: remark_of(summary, style, undamaged) for name, (_, summary) in zip(names, compressed, strict=True)}
    shown = {name: history for name, (history, _) in zip(names, compressed, strict=True)}
    return _save(compression_figure(shown, style, remarks, undamaged), path, style)


def plot_energies(history: History, path: Path, style: PictureStyle = _PLAIN) -> Path:
    """Draw the energies of a history stacked, negative ones downwards, and the total at the start."""
    figure = Figure(figsize=(8, 5), layout="constrained")
    _stack(figure.subplots(), history, style)
    return _save(figure, path, style)


def plot_overview(fields: Fields, history: History, path: Path, style: PictureStyle = _PLAIN) -> Path:
    """Draw in one picture each interface in plan with the cracks of adjacent plies, the force and the energies.

    Many interfaces are drawn in one map, projected as in a C-scan, with their areas.
    """
    interfaces = fields.snapshots[-1].mesh.interfaces
    if not interfaces:
        raise FileError(f"{fields.name} has no interface that may delaminate.")
    few = len(interfaces) <= FEW
    figure = Figure(figsize=(11, max(2.9 * len(interfaces) + 1, 5.8) if few else 7.5), layout="constrained")
    left, right = figure.subfigures(1, 2)
    if few:
        _draw_interfaces(left, fields, style)
    else:
        plan, sizes = left.subplots(2, height_ratios=[3, 2])
        draw_projected(plan, fields, style)
        draw_sizes(sizes, fields, style)
    force, energies = right.subplots(2)
    draw_response(force, [history], "force", style)
    _stack(energies, history, style)
    figure.supxlabel(caption(fields, style, inset=False), fontsize="small")
    return _save(figure, path, style)


def _draw_interfaces(figure: SubFigure, fields: Fields, style: PictureStyle) -> None:
    """Draw each interface in plan with the cracks of adjacent plies."""
    interfaces = fields.snapshots[-1].mesh.interfaces
    reach = np.max([reach_of(fields.delaminated(-1, ply), fields) for ply in interfaces], axis=0)
    grid = figure.subplots(len(interfaces), squeeze=False)[:, 0]
    for axes, below_ply in zip(grid, interfaces, strict=True):
        draw_delamination(axes, fields, below_ply, style, reach)
        if fields.snapshots[-1].failures:
            draw_cracks(axes, fields, below_ply)
    add_times(figure, list(grid), fields, style)


def plot_fields(fields: Fields, base: Path, times: Sequence[float] | None = None,
                style: PictureStyle = _PLAIN, history: History | None = None,
                angles: Sequence[float] | None = None) -> list[Path]:
    """Draw the interfaces, their fronts (at some times), the plies and sections at angles, one picture each."""
    figures = {}
    if fields.snapshots[-1].mesh.interfaces:
        figures["delamination"] = delamination_figure(fields, style)
        figures["projected"] = projected_figure(fields, style)
    if any(np.any(snapshot.release_ratio > 0) for snapshot in fields.snapshots):
        figures["front"] = front_figure(fields, times, style)
    if fields.snapshots[-1].failures:
        figures["matrix"] = failures_figure(fields, ("matrix cracking", "matrix crushing"), style)
        figures["fibres"] = failures_figure(fields, ("fibre failure",), style)
    section = section_figure(fields, style, history, angles) if figures or angles else None
    if section is not None:
        figures["section"] = section
    return [_save(figure, base.with_name(f"{base.name}_{name}.{style.kind}"), style)
            for name, figure in figures.items()]


def _stack(axes: Axes, history: History, style: PictureStyle) -> None:
    """Draw the energies stacked."""
    balance = {column: history[column] for column in ENERGY_NAMES if column in history.columns}
    shown = {column: values for column, values in balance.items() if np.any(values)}
    colours = [ENERGIES[list(ENERGY_NAMES).index(column) % len(ENERGIES)] for column in shown]
    start = sum(values[0] for values in balance.values())
    time = style.clock(history.time, [history.by_load_steps])
    energy = style.axis("energy", "energy", [start, *(np.max(np.abs(values)) for values in shown.values())])
    if shown:
        labels = [ENERGY_NAMES[column] for column in shown]
        for parts, names in ((np.maximum, labels), (np.minimum, ())):
            axes.stackplot(time.factor * history.time, [energy.factor * parts(values, 0) for values in shown.values()],
                           labels=names, colors=colours, edgecolor="white", linewidth=0.5)
    axes.axhline(energy.factor * start, color="black", linestyle="--", linewidth=1, label="total at the start")
    axes.plot(time.factor * history.time, energy.factor * history["energy_error"], color="black", linewidth=1,
              label=ENERGY_ERROR)
    axes.set(xlabel=time.label, ylabel=energy.label, title=Path(history.name).stem.removesuffix("_history"))
    axes.locator_params(axis="x", nbins=6)
    # From the top of the stack downwards.
    handles = axes.get_legend_handles_labels()[0][::-1]
    below = axes.transAxes + ScaledTranslation(0, -_BELOW, axes.figure.dpi_scale_trans)
    axes.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0), bbox_transform=below, ncols=3,
                fontsize="small")


def response_of(history: History, column: str) -> np.ndarray:
    """Return the values of a column to be drawn: no indentation where impactor and plate are apart."""
    if column == "indentation" and "force" in history.columns:
        return np.where(history["force"] > 0, history[column], np.nan)
    return history[column]


def draw_response(axes: Axes, histories: Sequence[History], column: str, style: PictureStyle = _PLAIN,
                  measured: History | None = None) -> None:
    """Draw a column of several histories, each in its own style, and measured values as dots."""
    words, dimension = RESPONSES[column]
    drawn = [*histories, *([measured] if measured is not None and column in measured.columns else [])]
    time = style.clock(np.concatenate([history.time for history in drawn]),
                       [history.by_load_steps for history in histories])
    value = style.axis(words, dimension, np.concatenate([response_of(history, column) for history in drawn]))
    names = _names([history.name for history in histories])
    for position, history in enumerate(histories):
        line_style = STYLES[position % len(STYLES)]
        axes.plot(time.factor * history.time, value.factor * response_of(history, column), label=names[position],
                  **line_style)
        grown = rows_of_growth(history)
        if column == "force" and len(grown):
            axes.plot(time.factor * history.time[grown], value.factor * history[column][grown], "o", markersize=3,
                      color=line_style["color"],
                      label="delamination grows" + (f" ({names[position]})" if position else ""))
    if drawn[-1] is measured:
        axes.plot(time.factor * measured.time, value.factor * measured[column], "k.", markersize=4,
                  label=f"measured ({Path(measured.name).stem})")
    axes.set(xlabel=time.label, ylabel=value.label)
    axes.locator_params(axis="x", nbins=6)
    axes.grid(alpha=0.3)
    axes.legend()


def _draw_loop(axes: Axes, histories: Sequence[History], style: PictureStyle) -> None:
    """Draw the force against the displacement of the impactor, or of the struck point if no history has the former."""
    along = "impactor_displacement" if all(
        np.any(history.columns.get("impactor_displacement", 0)) for history in histories) else "deflection"
    shown = [in_contact(history) for history in histories]
    horizontal, force = (style.axis(*AXES[column], np.concatenate([history[column] for history in shown]))
                     for column in (along, "force"))
    for position, (history, name) in enumerate(zip(shown, _names([one.name for one in histories]), strict=True)):
        axes.plot(horizontal.factor * history[along], force.factor * history["force"], label=name,
                  **STYLES[position % len(STYLES)])
    axes.set(xlabel=horizontal.label, ylabel=force.label)
    axes.grid(alpha=0.3)
    axes.legend()


def _names(paths: Sequence[str]) -> list[str]:
    """Return short names of runs: the name of the case, with its folder where two are equal."""
    stems = [Path(path).stem.removesuffix("_history") for path in paths]
    return [stem if stems.count(stem) == 1 else f"{Path(path).parent.name}/{stem}"
            for stem, path in zip(stems, paths, strict=True)]


def _save(figure: Figure, path: Path, style: PictureStyle = _PLAIN) -> Path:
    """Write the figure, create its folder if necessary, and return the path."""
    try:
        lay_out(figure)
        with replaced(path) as draft:
            figure.savefig(draft, dpi=style.dots_per_inch)
    except ValueError as error:
        raise ImplamError(f"{path} cannot be written ({reason(error)}).") from None
    return path
