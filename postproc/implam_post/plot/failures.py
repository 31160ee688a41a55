"""Pictures of the failures of plies in plan."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from implam_post.io.counts import listed
from implam_post.io.errors import ImplamError
from implam_post.io.fields import MODES, Fields, deck_in, outline
from implam_post.laminate.decks import plies_of
from implam_post.plot.plan_frame import arrangement, caption, frame, label_outer, locate, reach_of
from implam_post.plot.style import FAILURES, HATCHES, PictureStyle

_PLAIN = PictureStyle()
# Inches beside and above a map, and below and above all maps: axis, legend, text.
_WORDS, _REST = (0.15, 0.3), 1.7
_CRACKING = "matrix cracking"


def draw_cracks(axes: Axes, fields: Fields, below_ply: int) -> None:
    """Draw the matrix cracks of the ply at the back and of the ply above it onto a delamination."""
    last = fields.snapshots[-1]
    for ply, line_style in ((last.mesh.plies[-1], "-"), (below_ply, ":")):
        edges = outline(fields.full_plate(last.failed_cells(ply, _CRACKING)))
        if len(edges):
            axes.add_collection(LineCollection(edges, colors=FAILURES[_CRACKING], linestyles=line_style,
                                               label=f"cracked region of ply {ply}"))
            axes.legend(loc="upper right", fontsize="x-small")


def failures_figure(fields: Fields, modes: Sequence[str] = tuple(MODES), style: PictureStyle = _PLAIN) -> Figure:
    """Draw the plies that failed in some modes at the last time, on one scale; cracks are along the fibres.

    Plies without such a failure are listed in the text.
    """
    last = fields.snapshots[-1]
    kinds = [kind for mode in modes for kind in (
        last.kinds_of_fibre_failure if mode == "fibre failure" else (mode,))]
    failed = [ply for ply in sorted(last.failures) if any(np.any(last.failed(ply, mode)) for mode in modes)]
    intact = [ply for ply in sorted(last.failures) if ply not in failed]
    plies = failed or intact[:1]
    reach = np.max([reach_of(fields.full_plate(last.failed_cells(ply, mode)), fields)
                    for ply in plies for mode in modes], axis=0)
    columns, rows, size = arrangement(len(plies), reach, _WORDS, _REST)
    figure = Figure(figsize=size, layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    angles = _angles(fields)
    for axes, ply in zip(grid, plies, strict=False):
        draw_failures(axes, fields, ply, kinds, angles.get(ply))
        axes.tick_params(labelsize="small")
        frame(axes, fields, reach, style)
    label_outer(grid[:len(plies)], columns)
    for axes in grid[len(plies):]:
        axes.set_visible(False)
    figure.legend(handles=[_entry(kind, bool(angles)) for kind in kinds], loc="outside lower center",
                  ncols=min(len(kinds), 2), fontsize="small")
    locate(grid[0], fields)
    without = f"none of these failures in {listed(intact)}\n" if intact else ""
    figure.suptitle(without + caption(fields, style, outlined=False), fontsize="small")
    return figure


def draw_failures(axes: Axes, fields: Fields, ply: int, kinds: Sequence[str], angle: float | None) -> None:
    """Draw the failures of a ply, earlier kinds on top of others; cracks are lines if the fibre angle is known."""
    for order, kind in enumerate(reversed(kinds)):
        cells = fields.full_plate(fields.snapshots[-1].failed_cells(ply, kind))
        if kind == _CRACKING and angle is not None:
            axes.add_collection(LineCollection(along_fibres(cells, angle), colors=FAILURES[kind], linewidths=1,
                                               zorder=4))
        else:
            axes.add_collection(PolyCollection(cells, facecolors=FAILURES[kind], edgecolors="black", linewidths=0.2,
                                               hatch=HATCHES.get(kind), zorder=2 + 0.1 * order))
    axes.set_title(f"ply {ply}" + ("" if angle is None else f", {angle:g}°"), fontsize="small")


def _entry(kind: str, as_lines: bool) -> Patch | Line2D:
    """Return the entry of the legend of a kind of failure."""
    if kind == _CRACKING and as_lines:
        return Line2D([], [], color=FAILURES[kind], label="matrix cracks, a line for each element")
    return Patch(facecolor=FAILURES[kind], edgecolor="black", linewidth=0.2, hatch=HATCHES.get(kind), label=kind)


def along_fibres(cells: np.ndarray, angle: float) -> np.ndarray:
    """Return a line through the centre of each cell at an angle in degrees, to its border, (cells, 2 ends, 2)."""
    middles, halves = cells.mean(axis=1), np.ptp(cells, axis=1) / 2
    direction = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    lengths = np.min(halves / np.maximum(np.abs(direction), 1e-12), axis=1, initial=np.inf)
    steps = lengths[:, None] * direction
    return np.stack([middles - steps, middles + steps], axis=1)


def _angles(fields: Fields) -> dict[int, float]:
    """Return the fibre angle of each ply; empty if the deck of the run is not known.

    Mirror images of a quarter keep angles of 0 and 90 degrees only, and only such laminates may be modelled so.
    """
    deck = deck_in(fields.path)
    try:
        return {} if deck is None else {place: ply.angle for place, ply in enumerate(plies_of(deck), start=1)}
    except ImplamError:
        return {}
