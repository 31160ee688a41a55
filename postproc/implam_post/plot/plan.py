"""Pictures of delaminations in plan: of each interface, and projected as in a C-scan."""

from collections.abc import Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from implam_post.io.contours import WEIGHTS, areas
from implam_post.io.fields import Fields
from implam_post.plot.plan_frame import (
    arrangement,
    caption,
    clock_of,
    fill,
    frame,
    label_outer,
    locate,
    reach_of,
)
from implam_post.plot.style import DEPTHS, TIMES, PictureStyle

_PLAIN = PictureStyle()
# Inches beside and above a map in a column of full titles and in several columns, and below all maps: axis, bar, text.
_WIDE, _NARROW, _BELOW = (0.3, 0.75), (0.15, 0.35), 2.05
# Up to this many interfaces a map has a title of two lines and its own row.
FEW = 3
# Digits of areas, as in the summary.
_DIGITS = 4
# Colour of delaminations written at one time only.
_ONE_TIME = "#56B4E9"
# Growth between times written that counts, as a part of the final area.
_GROWN = 1e-3
# Largest number of interfaces that are all named below a bar of depths.
_NAMED = 16


def delamination_figure(fields: Fields, style: PictureStyle = _PLAIN) -> Figure:
    """Draw each interface of the full plate on one scale of lengths, coloured by the time of delamination."""
    interfaces = fields.snapshots[-1].mesh.interfaces
    reach = np.max([reach_of(fields.delaminated(-1, below_ply), fields) for below_ply in interfaces], axis=0)
    few = len(interfaces) <= FEW
    columns, rows, size = arrangement(len(interfaces), reach, _WIDE if few else _NARROW, _BELOW, 1 if few else None)
    figure = Figure(figsize=size, layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, below_ply in zip(grid, interfaces, strict=False):
        draw_delamination(axes, fields, below_ply, style, reach)
        if not few:
            axes.set_title(short_title_of(fields, below_ply, style), fontsize="x-small")
            axes.tick_params(labelsize="x-small")
    label_outer(grid[:len(interfaces)], columns)
    locate(grid[0], fields)
    for axes in grid[len(interfaces):]:
        axes.set_visible(False)
    add_times(figure, list(grid[:len(interfaces)]), fields, style)
    figure.supxlabel(caption(fields, style), fontsize="small")
    return figure


def draw_delamination(axes: Axes, fields: Fields, below_ply: int, style: PictureStyle = _PLAIN,
                      reach: Sequence[float] | None = None) -> None:
    """Draw the delamination below a ply: the time of delamination of each place, and outlines at all times written.

    The initial delamination (starter) is grey. `reach` is the size of the region to be shown.
    """
    regions = [fields.delaminated(place, below_ply) for place in range(len(fields.snapshots))]
    draw_times(axes, fields, regions, fields.starter(below_ply))
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


def short_title_of(fields: Fields, below_ply: int, style: PictureStyle = _PLAIN) -> str:
    """Return the area of an interface at the last time, for small maps."""
    area = fields.interface(len(fields.snapshots) - 1, below_ply).area
    return f"below ply {below_ply}: {style.shown('area', area, _DIGITS)}"


def projected_figure(fields: Fields, style: PictureStyle = _PLAIN) -> Figure:
    """Draw the projected (C-scan) delamination, coloured according to `style.projected`.

    The colour is the delaminated interface nearest to the struck face (depth), or the time of first delamination.
    """
    reach = reach_of(fields.projected(len(fields.snapshots) - 1), fields)
    figure = Figure(figsize=arrangement(1, reach, _WIDE, _BELOW)[2], layout="constrained")
    axes = figure.subplots()
    draw_projected(axes, fields, style)
    locate(axes, fields)
    figure.supxlabel(caption(fields, style), fontsize="small")
    return figure


def draw_projected(axes: Axes, fields: Fields, style: PictureStyle) -> None:
    """Draw the projected delamination with its bar of colours."""
    last = len(fields.snapshots) - 1
    final = fields.projected(last)
    if style.projected == "time":
        draw_times(axes, fields, [fields.projected(place) for place in range(len(fields.snapshots))],
                   np.empty((0, 4, 2)))
        add_times(axes.figure, [axes], fields, style)
    else:
        draw_depths(axes, fields.projected_rest(last))
        draw_depths(axes, fields.projected_depths(last))
        add_depths(axes, fields.snapshots[-1].mesh.interfaces,
                   "delaminated interface nearest to the struck face, below ply")
    fill(axes, final, facecolor="none", edgecolor="black", linewidth=0.8)
    axes.set_title(f"all interfaces: projected area {style.shown('area', fields.projected_area(last), _DIGITS)}",
                   fontsize="medium")
    frame(axes, fields, reach_of(final, fields), style)


def depth_colours(count: int) -> list[tuple[float, ...]]:
    """Return the colours of interfaces from the struck face on."""
    return [colormaps[DEPTHS](value) for value in np.linspace(0, 0.93, count)]


def draw_depths(axes: Axes, regions: Sequence[np.ndarray]) -> None:
    """Draw all interfaces in one map, the interface nearest to the struck face on top."""
    for cells, colour in reversed(list(zip(regions, depth_colours(len(regions)), strict=True))):
        fill(axes, cells, facecolor=colour, linewidth=0)


def add_depths(axes: Axes, interfaces: Sequence[int], label: str, location: str = "bottom") -> None:
    """Add the bar of colours of interfaces, by the ply above; every second or third one is named if there are many."""
    count = len(interfaces)
    scale = ScalarMappable(BoundaryNorm(np.arange(count + 1) - 0.5, count), ListedColormap(depth_colours(count)))
    ticks = range(0, count, -(-count // _NAMED))
    bar = axes.figure.colorbar(scale, ax=axes, ticks=ticks, location=location, label=label)
    bar.set_ticklabels([str(interfaces[place]) for place in ticks])
    bar.ax.minorticks_off()


def draw_sizes(axes: Axes, fields: Fields, style: PictureStyle) -> None:
    """Draw the area of each interface at the last time as bars, from the struck face downwards."""
    interfaces = fields.snapshots[-1].mesh.interfaces
    sizes = [fields.interface(len(fields.snapshots) - 1, below_ply).area for below_ply in interfaces]
    size = style.axis("area of the interface", "area", sizes)
    axes.barh(range(len(interfaces)), size.factor * np.array(sizes), color=depth_colours(len(interfaces)),
              edgecolor="black", linewidth=0.3)
    step = -(-len(interfaces) // _NAMED)
    axes.set_yticks(range(0, len(interfaces), step), [str(below_ply) for below_ply in interfaces[::step]])
    axes.set(xlabel=size.label, ylabel="interface below ply")
    axes.invert_yaxis()


def draw_times(axes: Axes, fields: Fields, regions: Sequence[np.ndarray], starter: np.ndarray) -> None:
    """Draw a growing region coloured by the time of delamination, the starter in grey."""
    scale = _scale(fields) if len(regions) > 1 else None
    for snapshot, cells in reversed(list(zip(fields.snapshots, regions, strict=True))):
        colour = _ONE_TIME if scale is None else scale.to_rgba(snapshot.time)
        fill(axes, cells, facecolor=colour, edgecolor="black", linewidth=0.5)
    patch = fill(axes, starter, facecolor="lightgrey", edgecolor="black", linewidth=0.5, label="starter")
    if patch is not None:
        axes.legend(handles=[patch], loc="upper right", fontsize="small")


def _scale(fields: Fields) -> ScalarMappable:
    """Return the colours of times, from the first time with delamination to the last with growth."""
    sizes = np.array([np.sum(areas(snapshot.mesh.corners) * (snapshot.shares @ WEIGHTS))
                      for snapshot in fields.snapshots])
    times = np.array([snapshot.time for snapshot in fields.snapshots])
    grown = np.flatnonzero(np.diff(sizes, prepend=0) > _GROWN * np.max(sizes))
    first, last = (times[grown[0]], times[grown[-1]]) if len(grown) else (times[0], times[-1])
    return ScalarMappable(Normalize(first if first < last else 0, last if last > 0 else 1), TIMES)


def add_times(figure: Figure, grid: Sequence[Axes], fields: Fields, style: PictureStyle) -> None:
    """Add one bar of times for maps, unless there is only one time or no delamination."""
    if len(fields.snapshots) < 2 or not any(np.any(snapshot.shares) for snapshot in fields.snapshots):
        return
    clock = clock_of(fields, style)
    bar = figure.colorbar(_scale(fields), ax=grid, location="bottom", ticks=MaxNLocator(5), shrink=0.8,
                          label=f"{clock.label}, first written with delamination there")
    bar.formatter = FuncFormatter(lambda value, _: f"{clock.factor * value:.3g}")
