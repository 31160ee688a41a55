"""Pictures of runs with random inputs: band of the force history, and fraction of runs with delamination."""

import itertools
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from implam_post.io.contours import outline
from implam_post.io.files import replaced
from implam_post.io.history import History
from implam_post.plot.plan_frame import frame, height_of, locate, reach_of
from implam_post.plot.style import PictureStyle, lay_out
from implam_post.sweep.scatter_results import Group

BAND, SHARE = "force_band.png", "delaminated_share.png"
_PIXELS = 240  # number of points along the longer side of the map
_LEVELS = (0.05, 0.5, 0.95)
_WIDTH, _WORDS, _CAPTION, _BESIDE, _COLUMNS = 5.6, 2.0, 0.6, 0.9, 3


def plot_scatter(groups: Sequence[Group], curves: Sequence[History], style: PictureStyle, folder: Path) -> list[Path]:
    """Draw all pictures that have data, and return their paths."""
    drawn = []
    banded = [group for group in groups if group.band() is not None]
    if banded:
        drawn.append(_save(band_figure(banded, curves, style), folder / BAND))
    mapped = [group for group in groups if group.plate is not None]
    if mapped:
        drawn.append(_save(share_figure(mapped, style), folder / SHARE))
    return drawn


def band_figure(groups: Sequence[Group], curves: Sequence[History], style: PictureStyle) -> Figure:
    """Draw the mean force of each group, the band from the 5 to the 95 % point, and the runs as thin lines."""
    figure = Figure(figsize=(8, 4.8), layout="constrained")
    axes = figure.subplots()
    bands = [group.band() for group in groups]
    time = style.clock(np.concatenate([band["time"] for band in bands]),
                       [run.results.columns.by_load_steps for group in groups for run in group.ended
                        if run.results.columns is not None])
    force = style.axis("contact force", "force", np.concatenate([band["high"] for band in bands]))
    for place, (group, band) in enumerate(zip(groups, bands, strict=True)):
        colour, name = f"C{place % 10}", f"{group.name}: " if group.name else ""
        for run in group.ended if len(groups) == 1 else ():
            history = run.results.columns
            axes.plot(time.factor * history.time, force.factor * history["force"], color=colour, linewidth=0.4,
                      alpha=0.5)
        axes.fill_between(time.factor * band["time"], force.factor * band["low"], force.factor * band["high"],
                          color=colour, alpha=0.25, linewidth=0, label=f"{name}5 to 95 %")
        axes.plot(time.factor * band["time"], force.factor * band["mean"], color=colour,
                  label=f"{name}mean of {len(group.ended)} runs")
    for curve in curves:
        axes.plot(time.factor * curve.time, force.factor * curve["force"], "k.", markersize=4,
                  label=f"measured ({Path(curve.name).stem})")
    axes.set(xlabel=time.label, ylabel=force.label)
    axes.set_ylim(bottom=0)
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small")
    return figure


def share_figure(groups: Sequence[Group], style: PictureStyle) -> Figure:
    """Draw for each group the fraction of runs in which a place is delaminated in any interface."""
    regions = [[run.region for run in group.ended if run.region is not None] for group in groups]
    like = groups[0].plate
    reach = np.max([reach_of(cells, like) for cells in itertools.chain(*regions)], axis=0)
    columns = min(len(groups), _COLUMNS)
    rows = -(-len(groups) // columns)
    figure = Figure(figsize=(_WIDTH * columns, (height_of(_WIDTH - _BESIDE, reach) + _WORDS) * rows + _CAPTION),
                    layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, group, cells in zip(grid, groups, regions, strict=False):
        frame(axes, like, reach, style)
        image = _draw_share(axes, cells)
        axes.set_title(f"{group.name}: {len(cells)} runs" if group.name else f"{len(cells)} runs", fontsize="medium")
        bar = figure.colorbar(image, ax=axes, location="bottom", shrink=0.8,
                              label="fraction of runs with a delaminated interface")
        bar.set_ticks([0, 0.25, 0.5, 0.75, 1])
    for axes in grid[len(groups):]:
        axes.set_visible(False)
    locate(grid[0], like)
    figure.supxlabel("0° along x; lines at 5, 50 and 95 % of the runs;\nview of the back face (z towards the viewer), "
                     "+ struck point of the first run", fontsize="small")
    return figure


def _draw_share(axes: Axes, regions: Sequence[np.ndarray]) -> object:
    """Draw the fraction of regions that contain a point, over the area of the axes."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    step = max(right - left, high - low) / _PIXELS
    x, y = (np.arange(start + step / 2, stop, step) for start, stop in ((left, right), (low, high)))
    share = np.mean([inside(cells, x, y) for cells in regions], axis=0)
    image = axes.imshow(share, origin="lower", extent=(left, right, low, high), cmap="Blues", vmin=0, vmax=1,
                        interpolation="nearest", zorder=0)
    levels = [level for level in _LEVELS if share.min() < level < share.max()]
    if levels and len(regions) > 1:
        axes.contour(x, y, share, levels=levels, colors="black", linewidths=0.7)
    return image


def inside(cells: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return which points of a grid, (y, x), are in a region, given as polygons of the same orientation."""
    found = np.zeros((len(y), len(x)), dtype=bool)
    edges = outline(cells)
    if not len(edges):
        return found
    (first_x, first_y), (second_x, second_y) = edges[:, 0].T, edges[:, 1].T
    for row, height in enumerate(y):
        met = np.flatnonzero((first_y <= height) != (second_y <= height))
        crossing = first_x[met] + (height - first_y[met]) / (second_y[met] - first_y[met]) * (
            second_x[met] - first_x[met])
        order = np.argsort(crossing)
        windings = np.concatenate([[0], np.cumsum(np.sign(second_y[met] - first_y[met])[order])])
        found[row] = windings[np.searchsorted(crossing[order], x)] != 0
    return found


def _save(figure: Figure, path: Path) -> Path:
    """Replace a picture."""
    lay_out(figure)
    with replaced(path) as draft:
        figure.savefig(draft, dpi=150)
    return path
