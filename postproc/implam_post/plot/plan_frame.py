"""Common parts of maps of the plate: position and size, region shown, and the text below."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, PathPatch, Rectangle
from matplotlib.path import Path as Outline
from matplotlib.ticker import FuncFormatter, MaxNLocator

from implam_post.io.contours import GRAIN, outline
from implam_post.io.deck import Deck
from implam_post.io.errors import ImplamError
from implam_post.io.fields import Fields, deck_in, struck_point
from implam_post.io.units import Axis
from implam_post.plot.style import PictureStyle

_PLAIN = PictureStyle()
# Size of a page in inches, the part of its width for labels, and the largest number of maps side by side.
PAGE, _LABELS, _MAX_COLUMNS = (7.5, 10.0), 0.7, 5
# Width for the title of a small map, inches.
_TITLE = 1.35
# Margin of a map as a fraction of the region shown, with space for the small plate in its corner.
_MARGIN = 0.15


def fill(axes: Axes, cells: np.ndarray, **drawn: object) -> PathPatch | None:
    """Draw cells as one region with an outline; without cells draw nothing."""
    path = outlines(cells)
    return None if path is None else axes.add_patch(PathPatch(path, **drawn))


def outlines(cells: np.ndarray) -> Outline | None:
    """Return the closed outlines of cells as one path, holes in the opposite sense; None without cells."""
    edges = outline(cells)
    if not len(edges):
        return None
    places = np.round(edges / (np.abs(edges).max() * GRAIN)).astype(np.int64)
    leaving: dict[tuple[int, ...], list[int]] = {}
    for number, start in enumerate(map(tuple, places[:, 0])):
        leaving.setdefault(start, []).append(number)
    corners, codes = [], []
    while leaving:
        place = next(iter(leaving))
        loop = []
        while place in leaving:
            number = leaving[place].pop()
            if not leaving[place]:
                del leaving[place]
            loop.append(edges[number, 0])
            place = tuple(places[number, 1])
        corners += [*loop, loop[0]]
        codes += [Outline.MOVETO, *[Outline.LINETO] * (len(loop) - 1), Outline.CLOSEPOLY]
    return Outline(np.array(corners), codes)


def is_by_load_steps(fields: Fields) -> bool:
    """Return whether the times of the fields are load factors."""
    deck = deck_in(fields.path)
    return deck is not None and deck.has("static")


def clock_of(fields: Fields, style: PictureStyle) -> Axis:
    """Return factor and label of times."""
    return style.clock([fields.snapshots[-1].time], [is_by_load_steps(fields)])


def state_of(fields: Fields, time: float, style: PictureStyle, digits: int = 3) -> str:
    """Return a time of the fields as text."""
    by_load_steps = is_by_load_steps(fields)
    return ("" if by_load_steps else "time ") + style.instant(time, by_load_steps, digits)


def caption(fields: Fields, style: PictureStyle = _PLAIN, outlined: bool = True, inset: bool = True) -> str:
    """Return the text for all maps of a picture: state, meaning of outlines, direction of view, and the inset.

    z points from the struck face to the back, so that with x to the right and y up it points towards the viewer.
    """
    state = state_of(fields, fields.snapshots[-1].time, style, 4)
    law = "outlines enclose the dissipated area, where the dissipated fraction is largest; " if outlined and any(
        found.is_cohesive for found in fields.snapshots[-1].interfaces.values()) else ""
    stiffened = "; grey lines: doublers (dashed) and stringers" if _is_stiffened(deck_in(fields.path)) else ""
    return f"State at {state}; {law}0° along x;\nview of the back face (z towards the viewer), + struck point" + (
        stiffened) + (
        "\ninset: part of the plate shown (red)" + (", window of its support (dashed)" if _windows(fields) else "")
        if inset else "")


def _is_stiffened(deck: Deck | None) -> bool:
    """Return whether the plate has doublers or stringers."""
    return deck is not None and (deck.has("doubler") or deck.has("stringer"))


def _windows(fields: Fields) -> bool:
    """Return whether the plate has supports whose window is drawn."""
    deck = deck_in(fields.path)
    return deck is not None and any(support.get("window") or support.get("radius")
                                    for support in deck.groups.get("support", []))


def locate(axes: Axes, fields: Fields) -> None:
    """Draw the plate, its supports and the region shown in a corner of the map."""
    deck = deck_in(fields.path)
    try:
        along, across = deck.lengths() if deck else (0.0, 0.0)
    except ImplamError:
        along = 0.0
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    if not along or (right - left >= along and high - low >= across):
        return
    small = axes.inset_axes((0.01, 0.01, _MARGIN, _MARGIN))
    draw_plate(small, deck, along, across)
    small.add_patch(Rectangle((left, low), right - left, high - low, facecolor="none", edgecolor="#CC3311",
                              linewidth=1.2))
    small.set(xlim=(-0.55 * along, 0.55 * along), ylim=(-0.55 * across, 0.55 * across), aspect="equal", anchor="SW")
    small.axis("off")


def draw_plate(axes: Axes, deck: Deck | None, along: float, across: float) -> None:
    """Draw the edges of the plate, its doublers and stringers, and the windows of its supports."""
    axes.add_patch(Rectangle((-along / 2, -across / 2), along, across, facecolor="white", edgecolor="black",
                             linewidth=0.8))
    if deck is not None:
        _draw_stiffeners(axes, deck, along, across, facecolor="#DDDDDD")
    for support in deck.groups.get("support", []) if deck is not None else ():
        if len(window := support.get("window", [])) == 2:
            axes.add_patch(Rectangle((-window[0] / 2, -window[1] / 2), *window, facecolor="none", edgecolor="C0",
                                     linestyle="--", linewidth=0.8, label="window of the support"))
        elif radius := support.get("radius", []):
            axes.add_patch(Circle((0, 0), radius[0], facecolor="none", edgecolor="C0", linestyle="--", linewidth=0.8,
                                  label="window of the support"))


def _draw_stiffeners(axes: Axes, deck: Deck, along: float, across: float, **doublers: object) -> None:
    """Draw doublers as areas, stringers as grey lines."""
    for number, doubler in enumerate(deck.groups.get("doubler", [])):
        (x, y), (width, height) = doubler["at"], doubler["size"]
        axes.add_patch(Rectangle((x - width / 2, y - height / 2), width, height, **doublers,
                                 label=None if number else "doublers"))
    for number, stringer in enumerate(deck.groups.get("stringer", [])):
        runs_along_x = str(stringer.get("along", ["x"])[0]).lower() == "x"
        half = (along if runs_along_x else across) / 2
        ends = [stringer.get("from", [-half])[0], stringer.get("to", [half])[0]]
        place = 2 * [stringer.get("at", [0.0])[0]]
        axes.plot(*((ends, place) if runs_along_x else (place, ends)), color="#555555", linewidth=1,
                  label=None if number else "stringers")


def reach_of(cells: np.ndarray, fields: Fields) -> tuple[float, float]:
    """Return the sides of the smallest rectangle, centred at the struck point, around cells; 0 if there are none."""
    if not len(cells):
        return 0.0, 0.0
    along, across = 2 * np.max(np.abs(cells - struck_point(fields)), axis=(0, 1))
    return float(along), float(across)


def arrangement(count: int, reach: Sequence[float], words: Sequence[float], rest: float,
                 columns: int | None = None) -> tuple[int, int, tuple[float, float]]:
    """Return columns, rows and size of a figure, in inches, in which maps are as large as possible on a page.

    `words` are the inches beside the maps of a column and above those of a row, `rest` those below all of them.
    """
    slope, best = height_of(1.0, reach), (0.0, 1, 1)
    for number in [columns] if columns else range(1, min(count, _MAX_COLUMNS) + 1):
        rows = -(-count // number)
        width = min((PAGE[0] - _LABELS) / number - words[0], ((PAGE[1] - rest) / rows - words[1]) / slope)
        best = max(best, (width, number, rows))
    width, number, rows = max(best[0], 0.5), *best[1:]
    across = min(number * max(width + words[0], _TITLE) + _LABELS, PAGE[0])
    return number, rows, (across, rows * (width * slope + words[1]) + rest)


def label_outer(grid: Sequence[Axes], columns: int) -> None:
    """Keep the labels and ticks of the maps at the left of each row and at the lower end of each column."""
    for place, axes in enumerate(grid):
        if place % columns:
            axes.set_ylabel("")
            axes.tick_params(labelleft=False)
        if place + columns < len(grid):
            axes.set_xlabel("")
            axes.tick_params(labelbottom=False)


def height_of(width: float, reach: Sequence[float]) -> float:
    """Return the height of a map of a given width, without text."""
    along, across = np.maximum(reach, max(reach) / 3)
    return width * min(across / along, 2.0) if along > 0 else width


def frame(axes: Axes, fields: Fields, reach: Sequence[float], style: PictureStyle = _PLAIN) -> None:
    """Set a map to a rectangle around the struck point with a margin, equal scales on both axes, and units."""
    largest, middle = max(reach), struck_point(fields)
    half = (0.5 + _MARGIN) * np.maximum(reach, largest / 3) if largest > 0 else np.ones(2)
    low, high = middle - half, middle + half
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    for name, side in (("x", axes.xaxis), ("y", axes.yaxis)):
        length = style.axis(name, "length", [largest])
        side.set_label_text(length.label)
        side.set_major_formatter(FuncFormatter(lambda value, _, factor=length.factor: f"{factor * value:.4g}"))
        side.set_major_locator(MaxNLocator(5))
    deck = deck_in(fields.path)
    if deck is not None and _is_stiffened(deck):
        _draw_stiffeners(axes, deck, *deck.lengths(), facecolor="none", edgecolor="#555555", linestyle="--",
                         linewidth=0.8)
    axes.plot(*middle, "+", color="white", markersize=6.5, markeredgewidth=2.2, zorder=10)
    axes.plot(*middle, "+", color="black", markersize=5, markeredgewidth=0.9, zorder=11)
