"""Pictures of the plate in plan: delamination of each interface as in a C-scan, failures of each ply."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from implam_post.fields import MODES, Fields, area, extents, outline

_COLOURS = {"fibre failure": "C3", "matrix cracking": "C0", "matrix crushing": "C1"}
_COLUMNS = 5


def delamination_figure(fields: Fields) -> Figure:
    """Draw each interface of the whole plate, cells coloured by the time at which they came apart."""
    interfaces = fields.snapshots[-1].mesh.interfaces
    figure = Figure(figsize=(7, 4 * len(interfaces)), layout="constrained")
    for axes, below_ply in zip(figure.subplots(len(interfaces), squeeze=False)[:, 0], interfaces, strict=True):
        draw_delamination(axes, fields, below_ply)
    return figure


def draw_delamination(axes: Axes, fields: Fields, below_ply: int) -> None:
    """Draw the delamination below a ply: when each cell came apart, and the outline at every time written.

    Cells that are apart at the first time, as the starter, are grey.
    """
    cells, times = fields.times_apart(below_ply)
    first = fields.snapshots[0].time
    axes.add_collection(PolyCollection(cells[times <= first], facecolors="lightgrey", linewidths=0))
    shown = PolyCollection(cells[times > first], array=times[times > first], cmap="viridis_r", linewidths=0)
    axes.add_collection(shown)
    for time in np.unique(times):
        axes.add_collection(LineCollection(outline(cells[times <= time]), colors="black", linewidths=0.6))
    along, across = extents(cells)
    axes.set_title(f"below ply {below_ply}: area {area(cells):.3g}, {along:.3g} by {across:.3g}", fontsize="medium")
    axes.set(xlabel="x (the deck's units, as all)", ylabel="y")
    frame(axes, along, across)
    if np.any(times > first):
        axes.figure.colorbar(shown, ax=axes, location="bottom", ticks=MaxNLocator(5), shrink=0.8,
                             label="time at which cells came apart")


def draw_cracks(axes: Axes, fields: Fields, below_ply: int) -> None:
    """Draw over a delamination where the matrix cracked in the ply on the back and in the one above it."""
    last = fields.snapshots[-1]
    for ply, style in ((last.mesh.plies[-1], "-"), (below_ply, ":")):
        edges = outline(fields.whole(last.failed_cells(ply, MODES["matrix cracking"])))
        if len(edges):
            axes.add_collection(LineCollection(edges, colors="C3", linestyles=style, label=f"cracks of ply {ply}"))
            axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.12), fontsize="small", ncols=2)


def failures_figure(fields: Fields) -> Figure:
    """Draw the failures of each ply of the whole plate at the last time."""
    last = fields.snapshots[-1]
    plies = sorted(last.failures)
    columns = min(_COLUMNS, len(plies))
    rows = -(-len(plies) // columns)
    along, across = _reach(fields)
    height = 2.6 * min(max(across / along, 1 / 3), 3) if along > 0 else 2.6
    figure = Figure(figsize=(2.6 * columns, (height + 0.3) * rows + 0.6), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True).ravel()
    for axes, ply in zip(grid, plies, strict=False):
        draw_failures(axes, fields, ply)
    for axes in grid[len(plies):]:
        axes.set_visible(False)
    figure.legend(handles=[Patch(color=_COLOURS[name], label=name) for name in MODES], loc="outside lower center",
                  ncols=len(MODES))
    return figure


def draw_failures(axes: Axes, fields: Fields, ply: int) -> None:
    """Draw where a ply failed, a mode over the others where several meet: crushing, cracking, then fibres on top."""
    for name, mode in reversed(MODES.items()):
        cells = fields.whole(fields.snapshots[-1].failed_cells(ply, mode))
        axes.add_collection(PolyCollection(cells, facecolors=_COLOURS[name], linewidths=0))
    axes.set_title(f"ply {ply}", fontsize="medium")
    frame(axes, *_reach(fields))


def _reach(fields: Fields) -> tuple[float, float]:
    """Return the extents of all failures at the last time."""
    last = fields.snapshots[-1]
    reached = [extents(fields.whole(last.failed_cells(ply, mode))) for ply in last.failures for mode in MODES.values()]
    return max(along for along, _ in reached), max(across for _, across in reached)


def frame(axes: Axes, along: float, across: float) -> None:
    """Show a rectangle around the struck point with room around what is there, equal scales both ways."""
    largest = max(along, across)
    half = 0.65 * np.maximum([along, across], largest / 3) if largest > 0 else np.ones(2)
    axes.set(xlim=(-half[0], half[0]), ylim=(-half[1], half[1]), aspect="equal")
    axes.plot(0, 0, "+", color="red", markersize=6)
