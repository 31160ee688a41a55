"""Pictures of the plate in plan: delamination of each interface and of all as in a C-scan, failures of each ply."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import BoundaryNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, MaxNLocator

from implam_post.errors import ImplamError
from implam_post.fields import MODES, Fields, area, extents, outline
from implam_post.look import Look, deck_in

_COLOURS = {"fibre failure": "C3", "matrix cracking": "C0", "matrix crushing": "C1"}
_COLUMNS = 5
_PLAIN = Look()


def delamination_figure(fields: Fields, look: Look = _PLAIN) -> Figure:
    """Draw each interface of the whole plate on one scale of lengths, cells coloured by the time they came apart."""
    interfaces = fields.snapshots[-1].mesh.interfaces
    columns = 1 if len(interfaces) < 4 else 3
    rows = -(-len(interfaces) // columns)
    figure = Figure(figsize=(7 if columns == 1 else 4 * columns, 4 * rows), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    reach = np.max([reach_of(fields.times_apart(below_ply)[0], fields) for below_ply in interfaces], axis=0)
    for axes, below_ply in zip(grid, interfaces, strict=False):
        draw_delamination(axes, fields, below_ply, look, reach)
    for axes in grid[len(interfaces):]:
        axes.set_visible(False)
    return figure


def draw_delamination(axes: Axes, fields: Fields, below_ply: int, look: Look = _PLAIN,
                      reach: Sequence[float] | None = None) -> None:
    """Draw the delamination below a ply: when each cell came apart, and the outline at every time written.

    Cells that are apart at the first time are the starter, in grey. `reach` is what the picture has to hold.
    """
    cells, times = fields.times_apart(below_ply)
    _draw_times(axes, cells, times, fields, look)
    for time in np.unique(times):
        axes.add_collection(LineCollection(outline(cells[times <= time]), colors="black", linewidths=0.6))
    along, across = extents(cells)
    axes.set_title(f"below ply {below_ply}: area {look.said('area', area(cells))}, {look.said('length', along)} by "
                   f"{look.said('length', across)}", fontsize="medium")
    frame(axes, fields, reach_of(cells, fields) if reach is None else reach, look)


def projected_figure(fields: Fields, look: Look = _PLAIN) -> Figure:
    """Draw all interfaces seen from the struck face as a C-scan does, coloured as `look.projected` says.

    By depth a cell has the colour of the first interface apart there, by time of when the first one came apart.
    """
    interfaces = fields.snapshots[-1].mesh.interfaces
    figure = Figure(figsize=(7, 6), layout="constrained")
    axes = figure.subplots()
    found = [fields.times_apart(below_ply) for below_ply in interfaces]
    everywhere, times = (np.concatenate(parts) for parts in zip(*found, strict=True))
    places = np.concatenate([np.full(len(cells), place) for place, (cells, _) in enumerate(found)])
    # What is on top comes last: the nearest interface, or the earliest time.
    order = np.argsort(-(times if look.projected == "time" else places), kind="stable")
    middles = np.round(everywhere.mean(axis=1) / (np.abs(everywhere).max(initial=0) or 1) * 1e6)
    _, last = np.unique(middles[order][::-1], axis=0, return_index=True)
    seen = order[::-1][last]
    if look.projected == "time":
        _draw_times(axes, everywhere[seen], times[seen], fields, look)
    else:
        shown = PolyCollection(everywhere[seen], array=places[seen], cmap="turbo", linewidths=0,
                               norm=BoundaryNorm(np.arange(len(interfaces) + 1) - 0.5, 256))
        axes.add_collection(shown)
        bar = figure.colorbar(shown, ax=axes, ticks=range(len(interfaces)), label="first interface apart, below ply")
        bar.set_ticklabels([str(below_ply) for below_ply in interfaces])
    axes.add_collection(LineCollection(outline(everywhere[seen]), colors="black", linewidths=0.8))
    axes.set_title(f"all interfaces: projected area {look.said('area', area(everywhere[seen]))}", fontsize="medium")
    frame(axes, fields, reach_of(everywhere, fields), look)
    return figure


def _draw_times(axes: Axes, cells: np.ndarray, times: np.ndarray, fields: Fields, look: Look) -> None:
    """Draw the cells, those of the starter in grey, the others by the time they came apart, with a bar."""
    first, last = fields.snapshots[0].time, fields.snapshots[-1].time
    starter = PolyCollection(cells[times <= first], facecolors="lightgrey", linewidths=0, label="starter")
    axes.add_collection(starter)
    shown = PolyCollection(cells[times > first], array=times[times > first], cmap="viridis_r", linewidths=0,
                           norm=Normalize(first, max(last, np.nextafter(first, np.inf))))
    axes.add_collection(shown)
    if np.any(times <= first):
        axes.legend(handles=[starter], loc="upper right", fontsize="small")
    if np.any(times > first):
        clock = look.axis("time at which cells came apart", "time", [last])
        bar = axes.figure.colorbar(shown, ax=axes, location="bottom", ticks=MaxNLocator(5), shrink=0.8,
                                   label=clock.label)
        bar.formatter = FuncFormatter(lambda value, _: f"{clock.factor * value:.3g}")


def draw_cracks(axes: Axes, fields: Fields, below_ply: int) -> None:
    """Draw over a delamination where the matrix cracked in the ply on the back and in the one above it."""
    last = fields.snapshots[-1]
    for ply, style in ((last.mesh.plies[-1], "-"), (below_ply, ":")):
        edges = outline(fields.whole(last.failed_cells(ply, MODES["matrix cracking"])))
        if len(edges):
            axes.add_collection(LineCollection(edges, colors="C3", linestyles=style, label=f"cracks of ply {ply}"))
            axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.12), fontsize="small", ncols=2)


def failures_figure(fields: Fields, modes: Sequence[str] = tuple(MODES), look: Look = _PLAIN) -> Figure:
    """Draw failures of each ply of the whole plate at the last time, all on one scale; cracks run along the fibres."""
    last = fields.snapshots[-1]
    plies = sorted(last.failures)
    columns = min(_COLUMNS, len(plies))
    rows = -(-len(plies) // columns)
    along, across = _reach(fields)
    height = 2.6 * min(max(across / along, 1 / 3), 3) if along > 0 else 2.6
    figure = Figure(figsize=(2.6 * columns, (height + 0.3) * rows + 0.6), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True).ravel()
    angles = _angles(fields)
    for axes, ply in zip(grid, plies, strict=False):
        draw_failures(axes, fields, ply, modes, angles.get(ply), look)
        axes.label_outer()
    for axes in grid[len(plies):]:
        axes.set_visible(False)
    figure.legend(handles=[Patch(color=_COLOURS[name], label=name) for name in modes], loc="outside lower center",
                  ncols=len(modes))
    return figure


def draw_failures(axes: Axes, fields: Fields, ply: int, modes: Sequence[str], angle: float | None,
                  look: Look = _PLAIN) -> None:
    """Draw where a ply failed, a mode over the others where several meet; cracks as lines along known fibres."""
    for name in reversed(modes):
        cells = fields.whole(fields.snapshots[-1].failed_cells(ply, MODES[name]))
        if name == "matrix cracking" and angle is not None:
            axes.add_collection(LineCollection(along_fibres(cells, angle), colors=_COLOURS[name], linewidths=1))
        else:
            axes.add_collection(PolyCollection(cells, facecolors=_COLOURS[name], linewidths=0))
    axes.set_title(f"ply {ply}" + ("" if angle is None else f", {angle:g}°"), fontsize="medium")
    frame(axes, fields, _reach(fields), look)


def along_fibres(cells: np.ndarray, angle: float) -> np.ndarray:
    """Return a line through the middle of each cell along an angle in degrees, to its border, (cells, 2 ends, 2)."""
    middles, halves = cells.mean(axis=1), np.ptp(cells, axis=1) / 2
    direction = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    lengths = np.min(halves / np.maximum(np.abs(direction), 1e-12), axis=1, initial=np.inf)
    steps = lengths[:, None] * direction
    return np.stack([middles - steps, middles + steps], axis=1)


def _angles(fields: Fields) -> dict[int, float]:
    """Return the fibre angle of each ply; nothing if the deck of the run can't be told.

    A quarter is mirrored, which leaves only 0 and 90 degrees as they are; no other laminate has a quarter.
    """
    deck = deck_in(fields.path)
    try:
        return {} if deck is None else {place: ply.angle for place, ply in enumerate(deck.plies(), start=1)}
    except ImplamError:
        return {}


def _reach(fields: Fields) -> tuple[float, float]:
    """Return how far failures reach around the struck point at the last time."""
    last = fields.snapshots[-1]
    reached = [reach_of(fields.whole(last.failed_cells(ply, mode)), fields)
               for ply in last.failures for mode in MODES.values()]
    return max(along for along, _ in reached), max(across for _, across in reached)


def struck_point(fields: Fields) -> np.ndarray:
    """Return where the plate was struck, from its middle; the middle, if the deck of the run can't be told."""
    deck = deck_in(fields.path)
    at = [] if deck is None else deck.numbers("impactor", "at")
    return np.array(at if len(at) == 2 else [0.0, 0.0])


def reach_of(cells: np.ndarray, fields: Fields) -> tuple[float, float]:
    """Return the sides of the smallest rectangle around the struck point that holds cells; 0 if there are none."""
    if not len(cells):
        return 0.0, 0.0
    along, across = 2 * np.max(np.abs(cells - struck_point(fields)), axis=(0, 1))
    return float(along), float(across)


def frame(axes: Axes, fields: Fields, reach: Sequence[float], look: Look = _PLAIN) -> None:
    """Show a rectangle around the struck point with room around what is there, equal scales both ways, with units."""
    largest, middle = max(reach), struck_point(fields)
    half = 0.65 * np.maximum(reach, largest / 3) if largest > 0 else np.ones(2)
    low, high = middle - half, middle + half
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    for name, side in (("x", axes.xaxis), ("y", axes.yaxis)):
        length = look.axis(name, "length", [largest])
        side.set_label_text(length.label)
        side.set_major_formatter(FuncFormatter(lambda value, _, factor=length.factor: f"{factor * value:.4g}"))
        side.set_major_locator(MaxNLocator(5))
    axes.plot(*middle, "+", color="red", markersize=6)
