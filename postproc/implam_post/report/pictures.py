"""Pictures of the page of a run: plate and lay-up, curves, maps."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.ticker import FuncFormatter

from implam_post.io.damage_resistance import has_grown
from implam_post.io.deck import recorded_deck
from implam_post.io.errors import ImplamError
from implam_post.io.fields import Fields
from implam_post.io.history import ENERGY_ERROR, ENERGY_NAMES, History
from implam_post.io.run import material_of
from implam_post.plot.compression import compression_figure, is_compressed
from implam_post.plot.curves import axis_of_column, in_contact, rows_of_growth
from implam_post.plot.failures import failures_figure
from implam_post.plot.plan import add_depths, delamination_figure, depth_colours, projected_figure
from implam_post.plot.plan_frame import draw_plate
from implam_post.plot.section import section_figure
from implam_post.plot.style import PictureStyle

_SPACE = 0.12  # part of the picture width to the right of the plies
# Pale colours of fibre angles, by Tol; black letters can be read on them.
_SHADES = ("#BBCCEE", "#EEEEBB", "#CCDDAA", "#FFCCCC", "#CCEEFF", "#DDDDDD")
# Up to this many interfaces have an entry in a legend or a curve of their own.
_FEW = 6
# Line styles of the curves of a picture, by which they differ without colours.
_DASHES = ("-", "--", "-.", ":")
# Times at which the areas of many interfaces are drawn.
_TIMES = 400
_ENTRY = 0.22  # height of a line of a small legend, inches


def layup_figure(summary: Mapping[str, Any]) -> Figure:
    """Draw the plies from the struck face, with lines at the fibre angle; interfaces that may delaminate as lines."""
    plies = [ply for ply in summary["plies"] if "doubler" not in ply]
    total = sum(ply["thickness"] for ply in plies)
    height = min(max(1.6, 0.34 * len(plies)), 8.5)
    figure = Figure(figsize=(7, height + 0.5), layout="constrained")
    axes = figure.subplots()
    top, shades = 0.0, {angle: shade for shade, angle in enumerate(sorted({ply["angle"] % 180 for ply in plies}))}
    bottoms = []
    for ply in plies:
        depth = ply["thickness"] / total
        shade = _SHADES[shades[ply["angle"] % 180] % len(_SHADES)]
        axes.add_patch(Rectangle((0, -top - depth), 1, depth, facecolor=shade, edgecolor="white"))
        letters = min(9.0, 0.75 * 72 * height * depth)
        axes.text(0.5, -top - depth / 2, f"{ply['ply']}: {ply['angle']:g}°  {material_of(ply)}", ha="center",
                  va="center", fontsize=max(letters, 1.0))
        _fibre(axes, ply["angle"], -top - depth / 2, depth)
        top += depth
        bottoms.append(-top)
    lines: dict[bool, Line2D] = {}
    for entry in summary.get("interfaces", []):
        grown = has_grown(entry)
        lines[grown], = axes.plot([0, 1], 2 * [[0.0, *bottoms][entry["ply_above"]]], color="black",
                                  linewidth=2 if grown else 1, linestyle="-" if grown else ":",
                                  label="delamination has grown" if grown else "may delaminate, has not grown")
    if lines:
        figure.legend(handles=list(lines.values()), loc="outside lower center", ncols=2, fontsize="small")
    axes.annotate("struck face", (0.5, 0), (0.5, _SPACE), ha="center", va="center", fontsize="small",
                  arrowprops={"arrowstyle": "-|>", "color": "black"})
    axes.set(xlim=(-_SPACE, 1.02), ylim=(-1.02, 1.2 * _SPACE))
    axes.axis("off")
    return figure


def _fibre(axes: Any, angle: float, height: float, depth: float) -> None:
    """Draw the fibre direction at the left of a ply, with x to the right and y up as in the maps."""
    turned, length = np.radians(angle), 0.4 * depth
    axes.plot(np.array([-1, 1]) * 0.03 * np.cos(turned) - _SPACE / 2,
              height + np.array([-1, 1]) * length * np.sin(turned), color="black", linewidth=1)


def plan_figure(summary: Mapping[str, Any], style: PictureStyle) -> Figure:
    """Draw the plate in plan, to scale, with the rectangle around the failed points of each interface."""
    along, across = summary["plate_size"]
    figure = Figure(figsize=(7, min(max(5.2 * across / along, 1.5), 8) + 1.4), layout="constrained")
    axes = figure.subplots()
    try:
        deck = recorded_deck(summary["provenance"], Path(f"{summary['case']}.nml"))
        at = deck.numbers("impactor", "at") if deck.has("impactor") else []
    except ImplamError:
        deck, at = None, []
    draw_plate(axes, deck, along, across)
    entries = summary.get("interfaces", [])
    few = len(entries) <= _FEW
    for entry, colour in zip(entries, depth_colours(len(entries)), strict=True):
        (left, right), (front, back) = entry["x"], entry["y"]
        if right > left:
            axes.add_patch(Rectangle((left, front), right - left, back - front, facecolor="none", edgecolor=colour,
                                     label=f"failed points below ply {entry['ply_above']}" if few else None))
    if not few:
        add_depths(axes, [entry["ply_above"] for entry in entries], "extent of failed points, interface below ply")
    axes.plot(*(at if len(at) == 2 else (0, 0)), "+", color="black", label="struck point", linestyle="none")
    axes.set(xlim=(-0.53 * along, 0.53 * along), ylim=(-0.53 * across, 0.53 * across), aspect="equal")
    for name, side in (("x, along 0°", axes.xaxis), ("y", axes.yaxis)):
        length = style.axis(name, "length", [along / 2])
        side.set_label_text(length.label)
        side.set_major_formatter(FuncFormatter(lambda value, _, factor=length.factor: f"{factor * value:.4g}"))
    figure.legend(fontsize="small", loc="outside upper center", ncols=3)
    return figure


def history_pictures(history: History, style: PictureStyle, threshold: tuple[float, float] | None = None,
                     compression: tuple[str, float | None] = ("", None)) -> Iterator[tuple[str, Figure]]:
    """Yield the curves of a history: force, force against displacements, deflection, areas and energies.

    Time and force of a threshold are marked on the force curve. For a compression, a remark and the strength of the
    undamaged plate may be given.
    """
    clock = "load factor" if history.by_load_steps else "time"
    if np.any(history["force"]):
        shown = in_contact(history)
        yield f"contact force against {clock}", _curve(history, "time", "force", style, threshold)
        if np.any(history.columns.get("impactor_displacement", 0)):
            yield "contact force against displacement of the impactor", _curve(shown, "impactor_displacement", "force",
                                                                               style)
        yield "contact force against deflection", _curve(shown, "deflection", "force", style)
    if is_compressed(history):
        remark, undamaged = compression
        yield "stress of the compression, and strains of gauges", compression_figure({"": history}, style, {"": remark},
                                                                                     undamaged)
    yield f"deflection against {clock}", _curve(history, "time", "deflection", style)
    areas = {name: name.replace("area_below_", "below ply ") for name in history.columns
             if name.startswith("area_below_")}
    if areas:
        yield f"delaminated area against {clock}", (
            _curves if len(areas) <= _FEW else _areas_of_many)(history, areas, "delaminated area", "area", style)
    energies = {column: name for column, name in (ENERGY_NAMES | {"energy_error": ENERGY_ERROR}).items()
                if column in history.columns and np.any(history[column])}
    yield f"energies against {clock}", _curves(history, energies, "energy", "energy", style)


def _curve(history: History, against: str, column: str, style: PictureStyle,
           mark: tuple[float, float] | None = None) -> Figure:
    """Draw one column; delamination growth, and the threshold if there is one, are marked on the force."""
    figure = Figure(figsize=(7, 3.4), layout="constrained")
    axes = figure.subplots()
    along, up = (axis_of_column(name, history[name], history, style) for name in (against, column))
    axes.plot(along.factor * history[against], up.factor * history[column])
    grown = rows_of_growth(history)
    if column == "force" and len(grown):
        axes.plot(along.factor * history[against][grown], up.factor * history[column][grown], "o", markersize=3,
                  label="delamination grows")
    if mark is not None:
        axes.plot(along.factor * mark[0], up.factor * mark[1], "kx", label="threshold of the filtered force")
    if axes.get_legend_handles_labels()[0]:
        axes.legend()
    axes.set(xlabel=along.label, ylabel=up.label)
    axes.grid(alpha=0.3)
    return figure


def _curves(history: History, columns: Mapping[str, str], label: str, dimension: str, style: PictureStyle) -> Figure:
    """Draw several columns against time or load factor, with their names in a legend."""
    figure = Figure(figsize=(7, max(3.4, _ENTRY * (len(columns) + 2))), layout="constrained")
    axes = figure.subplots()
    along = style.clock(history.time, [history.by_load_steps])
    up = style.axis(label, dimension, np.concatenate([[0.0], *(history[column] for column in columns)]))
    for place, (column, name) in enumerate(columns.items()):
        axes.plot(along.factor * history.time, up.factor * history[column], label=name,
                  color="black" if name == ENERGY_ERROR else None, linestyle=_DASHES[place % len(_DASHES)])
    axes.set(xlabel=along.label, ylabel=up.label)
    axes.grid(alpha=0.3)
    if columns:
        axes.legend(loc="center left", bbox_to_anchor=(1, 0.5), fontsize="small")
    return figure


def _areas_of_many(history: History, columns: Mapping[str, str], label: str, dimension: str,
                   style: PictureStyle) -> Figure:
    """Draw the areas of many interfaces against time as colours, a row for each from the struck face downwards."""
    along = style.clock(history.time, [history.by_load_steps])
    values = np.array([history[column] for column in columns])
    size = style.axis(label, dimension, values.ravel())
    figure = Figure(figsize=(7, 5), layout="constrained")
    axes = figure.subplots()
    rows = np.unique(np.linspace(0, len(history.time) - 1, _TIMES).astype(int))
    edges = along.factor * np.concatenate([[0.0], history.time[rows]])
    shown = axes.pcolormesh(edges, np.arange(len(columns) + 1) - 0.5, size.factor * values[:, rows], cmap="Blues",
                            rasterized=True)
    step = -(-len(columns) // 16)
    axes.set_yticks(range(0, len(columns), step), [name.rpartition(" ")[2] for name in list(columns.values())[::step]])
    axes.set(xlabel=along.label, ylabel="interface below ply")
    axes.invert_yaxis()
    figure.colorbar(shown, ax=axes, label=size.label)
    return figure


def map_pictures(fields: Fields, style: PictureStyle, history: History | None) -> Iterator[tuple[str, Figure]]:
    """Yield sections through the plate, and the maps of interfaces and plies in plan."""
    last = fields.snapshots[-1]
    section = section_figure(fields, style, history) if last.mesh.interfaces or last.failures else None
    if section is not None:
        yield "sections through the plate", section
    if last.mesh.interfaces:
        yield "delamination of each interface", delamination_figure(fields, style)
        yield "projected delamination of all interfaces", projected_figure(fields, style)
    if last.failures and any(np.any(failed) for failed in last.failures.values()):
        yield "failures of each ply", failures_figure(fields, style=style)
