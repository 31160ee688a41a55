"""Pictures of the plate in plan: delamination of each interface, projected delamination, failures of each ply."""

from collections.abc import Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import BoundaryNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, MaxNLocator

from implam_post.io.errors import ImplamError
from implam_post.io.fields import MODES, Fields, deck_in, outline
from implam_post.laminate.decks import plies_of
from implam_post.plot.plan_frame import caption, clock_of, fill, frame, height_of, locate, reach_of
from implam_post.plot.style import PictureStyle

_COLOURS = {"fibre failure": "C3", "matrix cracking": "C0", "matrix crushing": "C1"}
_COLUMNS = 5
_PLAIN = PictureStyle()
# Inches next to a map, above and below it (title, axis, bar), of the text below all maps, and of a legend.
_BESIDE, _WORDS, _CAPTION, _BAR = 0.9, 2.0, 0.6, 0.6
# Digits of areas, as in the summary.
_DIGITS = 4


def delamination_figure(fields: Fields, style: PictureStyle = _PLAIN) -> Figure:
    """Draw each interface of the full plate on one scale of lengths, coloured by the time of delamination."""
    interfaces = fields.snapshots[-1].mesh.interfaces
    columns = 1 if len(interfaces) < 4 else 3
    rows = -(-len(interfaces) // columns)
    reach = np.max([reach_of(_last(fields, below_ply), fields) for below_ply in interfaces], axis=0)
    width = 7.0 if columns == 1 else 4.2
    height = height_of(width - _BESIDE, reach) + _WORDS
    figure = Figure(figsize=(width * columns, height * rows + _CAPTION), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, below_ply in zip(grid, interfaces, strict=False):
        draw_delamination(axes, fields, below_ply, style, reach)
    locate(grid[0], fields)
    for axes in grid[len(interfaces):]:
        axes.set_visible(False)
    figure.supxlabel(caption(fields, style), fontsize="small")
    return figure


def draw_delamination(axes: Axes, fields: Fields, below_ply: int, style: PictureStyle = _PLAIN,
                      reach: Sequence[float] | None = None) -> None:
    """Draw the delamination below a ply: the time of delamination of each place, and outlines at all times written.

    The initial delamination (starter) is grey. `reach` is the size of the region to be shown.
    """
    regions = [fields.delaminated(place, below_ply) for place in range(len(fields.snapshots))]
    draw_times(axes, fields, regions, fields.starter(below_ply), style)
    axes.set_title(title_of(fields, below_ply, style), fontsize="medium")
    frame(axes, fields, reach_of(regions[-1], fields) if reach is None else reach, style)


def title_of(fields: Fields, below_ply: int, style: PictureStyle = _PLAIN) -> str:
    """Return area and extents of an interface at the last time, as in the summary."""
    figures = fields.interface(len(fields.snapshots) - 1, below_ply)
    kind = "dissipated area" if figures.is_cohesive else "delaminated area"
    along, across = (style.shown("length", length) for length in figures.extents)
    grown = f"{'failed' if figures.is_cohesive else 'delaminated'} over {along} by {across}" if any(
        figures.extents) else "no point has failed"
    return f"below ply {below_ply}: {kind} {style.shown('area', figures.area, _DIGITS)}\n{grown}"


def projected_figure(fields: Fields, style: PictureStyle = _PLAIN) -> Figure:
    """Draw the projected (C-scan) delamination, coloured according to `style.projected`.

    The colour is the delaminated interface nearest to the struck face (depth), or the time of first delamination.
    """
    interfaces, last = fields.snapshots[-1].mesh.interfaces, len(fields.snapshots) - 1
    final = fields.projected(last)
    figure = Figure(figsize=(7, height_of(7 - _BESIDE, reach_of(final, fields)) + _WORDS + _CAPTION),
                    layout="constrained")
    axes = figure.subplots()
    if style.projected == "time":
        earlier = [fields.projected(place) for place in range(last)]
        draw_times(axes, fields, [*earlier, final], np.empty((0, 4, 2)), style)
    else:
        # Interpolating the largest share is not the largest of the interpolated shares: the difference stays grey.
        fill(axes, final, facecolor="lightgrey", linewidth=0)
        draw_depths(axes, fields.projected_depths(last))
    if style.projected == "depth" and len(interfaces) > 1:
        scale = ScalarMappable(BoundaryNorm(np.arange(len(interfaces) + 1) - 0.5, 256), "turbo")
        bar = figure.colorbar(scale, ax=axes, ticks=range(len(interfaces)), location="bottom",
                              label="delaminated interface nearest to the struck face, below ply")
        bar.set_ticklabels([str(below_ply) for below_ply in interfaces])
    fill(axes, final, facecolor="none", edgecolor="black", linewidth=0.8)
    axes.set_title(f"all interfaces: projected area {style.shown('area', fields.projected_area(last), _DIGITS)}",
                   fontsize="medium")
    frame(axes, fields, reach_of(final, fields), style)
    locate(axes, fields)
    figure.supxlabel(caption(fields, style), fontsize="small")
    return figure


def draw_depths(axes: Axes, regions: Sequence[np.ndarray], cmap: str = "turbo") -> None:
    """Draw all interfaces in one map, the interface nearest to the struck face on top."""
    norm = BoundaryNorm(np.arange(len(regions) + 1) - 0.5, 256)
    for place in reversed(range(len(regions))):
        fill(axes, regions[place], facecolor=colormaps[cmap](norm(place)), linewidth=0)


def draw_times(axes: Axes, fields: Fields, regions: Sequence[np.ndarray], starter: np.ndarray,
               style: PictureStyle) -> None:
    """Draw a growing region coloured by the time of delamination, the starter in grey, with a colour bar."""
    times = [snapshot.time for snapshot in fields.snapshots]
    scale = ScalarMappable(Normalize(0, times[-1] if times[-1] > 0 else 1), "viridis_r")
    several = len(times) > 1
    for time, cells in reversed(list(zip(times, regions, strict=True))):
        fill(axes, cells, facecolor=scale.to_rgba(time) if several else "C0", edgecolor="black", linewidth=0.5)
    patch = fill(axes, starter, facecolor="lightgrey", edgecolor="black", linewidth=0.5, label="starter")
    if patch is not None:
        axes.legend(handles=[patch], loc="upper right", fontsize="small")
    if several and any(map(len, regions)):
        clock = clock_of(fields, style)
        bar = axes.figure.colorbar(scale, ax=axes, location="bottom", ticks=MaxNLocator(5), shrink=0.8,
                                   label=f"{clock.label}, first written with delamination there")
        bar.formatter = FuncFormatter(lambda value, _: f"{clock.factor * value:.3g}")


def _last(fields: Fields, below_ply: int) -> np.ndarray:
    """Return the delamination below a ply at the last time."""
    return fields.delaminated(len(fields.snapshots) - 1, below_ply)


def draw_cracks(axes: Axes, fields: Fields, below_ply: int) -> None:
    """Draw the matrix cracks of the ply at the back and of the ply above it onto a delamination."""
    last = fields.snapshots[-1]
    for ply, line_style in ((last.mesh.plies[-1], "-"), (below_ply, ":")):
        edges = outline(fields.full_plate(last.failed_cells(ply, MODES["matrix cracking"])))
        if len(edges):
            axes.add_collection(LineCollection(edges, colors="C3", linestyles=line_style, label=f"cracks of ply {ply}"))
            axes.legend(loc="upper right", fontsize="small")


def failures_figure(fields: Fields, modes: Sequence[str] = tuple(MODES), style: PictureStyle = _PLAIN) -> Figure:
    """Draw the failures of each ply of the full plate at the last time on one scale; cracks are along the fibres."""
    last = fields.snapshots[-1]
    plies = sorted(last.failures)
    columns = min(_COLUMNS, len(plies))
    rows = -(-len(plies) // columns)
    along, across = _reach(fields)
    height = 2.6 * min(max(across / along, 1 / 3), 3) if along > 0 else 2.6
    figure = Figure(figsize=(2.6 * columns, (height + 0.3) * rows + _BAR + _CAPTION), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True).ravel()
    angles = _angles(fields)
    for axes, ply in zip(grid, plies, strict=False):
        draw_failures(axes, fields, ply, modes, angles.get(ply), style)
        axes.label_outer()
    for axes in grid[len(plies):]:
        axes.set_visible(False)
    figure.legend(handles=[Patch(color=_COLOURS[name], label=name) for name in modes], loc="outside lower center",
                  ncols=len(modes))
    if plies:
        locate(grid[0], fields)
    figure.suptitle(caption(fields, style, outlined=False), fontsize="small")
    return figure


def draw_failures(axes: Axes, fields: Fields, ply: int, modes: Sequence[str], angle: float | None,
                  style: PictureStyle = _PLAIN) -> None:
    """Draw the failures of a ply, later modes on top of others; cracks are lines if the fibre angle is known."""
    for name in reversed(modes):
        cells = fields.full_plate(fields.snapshots[-1].failed_cells(ply, MODES[name]))
        if name == "matrix cracking" and angle is not None:
            axes.add_collection(LineCollection(along_fibres(cells, angle), colors=_COLOURS[name], linewidths=1))
        else:
            axes.add_collection(PolyCollection(cells, facecolors=_COLOURS[name], linewidths=0))
    axes.set_title(f"ply {ply}" + ("" if angle is None else f", {angle:g}°"), fontsize="medium")
    frame(axes, fields, _reach(fields), style)


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


def _reach(fields: Fields) -> tuple[float, float]:
    """Return the size of the region of failures around the struck point at the last time."""
    last = fields.snapshots[-1]
    reached = [reach_of(fields.full_plate(last.failed_cells(ply, mode)), fields)
               for ply in last.failures for mode in MODES.values()]
    return max(along for along, _ in reached), max(across for _, across in reached)
