"""One section through the plate: its plies, deformed, delaminations, cracks, failed fibres, and the dent."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, MaxNLocator

from implam_post.io.section import Section
from implam_post.laminate.zones import Zones
from implam_post.plot.style import FAILURES, HATCHES, PictureStyle

# Plies are light grey (fibres along the section) to grey (across it).
_OPEN, _CLOSED = "black", "#0072B2"
_LIGHT, _DARK = 0.94, 0.70
# Failures that fill a ply.
_FILLED = ("matrix crushing", "fibres torn", "fibres crushed", "fibre failure")
# Entries of the legend, in their order.
_ALONG, _ACROSS, _FACE = "ply, fibres along the section", "ply, fibres across the section", "struck face"
_THROUGH, _IN_DRAWING = "matrix crack (a line for each element)", "matrix crack in the plane of the section"
_GAPS = {"open": "delamination, open", "closed": "delamination, closed", "": "delamination, gap not written"}
ORDER = (_ALONG, _ACROSS, _FACE, _THROUGH, _IN_DRAWING, *_FILLED, *_GAPS.values())
# An interface is open where the gap exceeds this part of the thinnest ply.
_GAP = 0.01
# A crack lies in the plane of the drawing if the fibres run within this angle of the section, degrees.
_IN_PLANE = 10.0
_LETTERS = 7.0
# What lies below this order of drawing is written as pixels in files of lines.
_PIXELS = 2.5


class Layer(NamedTuple):
    """Plies of a layer at a place: their numbers, and depths of their faces below that of the laminate, one more."""

    plies: tuple[int, ...]
    depths: np.ndarray

    def of(self, ply: int) -> tuple[float, float]:
        """Return the depths of both faces of a ply."""
        place = self.plies.index(ply)
        return float(self.depths[place]), float(self.depths[place + 1])


class Plate:
    """Plies of the plate: its laminate, with doublers and ply drops."""

    def __init__(self, zones: Zones) -> None:
        """Store them; angles are in degrees, those of the plies of doublers after those of the laminate."""
        self.zones = zones
        self.thickness = float(sum(ply.thickness for ply in zones.laminate))
        self.angles = np.array([ply.angle for ply in zones.plies])
        self.thinnest = min(ply.thickness for ply in zones.plies)

    def layer(self, place: np.ndarray, first: int, last: int) -> Layer:
        """Return the layer of some plies of the laminate at a place, and of the doublers that are bonded to them.

        A layer of doublers that may come off has no ply of the laminate: on the struck face it ends before ply 1, on
        the back it begins after the last one.
        """
        lay_up, plies = self.zones.at(*map(float, place)), len(self.zones.laminate)
        skin = [at for at, number in enumerate(lay_up.numbers) if number <= plies]
        inside = [at for at in skin if first <= lay_up.numbers[at] <= last]
        begin, end = inside[0] if inside else skin[-1] + 1, inside[-1] + 1 if inside else len(lay_up.numbers)
        if last < 1:
            begin, end = 0, skin[0]
        elif first == 1 and not self.zones.may_separate(*map(float, place), "front"):
            begin = 0
        if last == plies and inside and not self.zones.may_separate(*map(float, place), "back"):
            end = len(lay_up.numbers)
        numbers = lay_up.numbers[begin:end]
        thicknesses = [self.zones.plies[number - 1].thickness for number in lay_up.numbers[:end]]
        depths = lay_up.front + self.thickness / 2 + np.concatenate([[0.0], np.cumsum(thicknesses)])
        return Layer(numbers, depths[begin:])


@dataclass(frozen=True)
class Dent:
    """Indentation by the law of contact under a spherical nose at the time of a section."""

    depth: float
    radius: float

    def at(self, along: np.ndarray) -> np.ndarray:
        """Return its depth at distances from the struck point."""
        return np.maximum(self.depth - along**2 / (2 * self.radius), 0.0)


class Drawing:
    """One section: the heights of its plies, deformed, and what is drawn there."""

    def __init__(self, section: Section, plate: Plate, half: float, dent: Dent | None) -> None:
        """Store the section within half a length of the struck point, and its deflection.

        The deflection of the curved or flat plate is counted from the ends of what is shown. The model has the total
        indentation only: it is drawn so that it decreases linearly to the back."""
        inside = np.flatnonzero(np.any(np.abs(section.along) <= half, axis=1))
        self.section, self.plate, self.half, self.rows = section, plate, half, inside
        self.layers = [plate.layer(*row) for row in zip(section.middles, section.first_ply, section.last_ply,
                                                        strict=True)]
        self.tops, self.bottoms = (np.array([layer.depths[end] for layer in self.layers]) for end in (0, -1))
        self.mean = self._mean()
        shown = self.mean[inside]
        self.range = float(np.ptp(shown))
        ends = [section.along[inside] == limit for limit in (section.along[inside].min(), section.along[inside].max())]
        reference = float(np.mean([np.mean(shown[end]) for end in ends]))
        self.deflection, self.straight = section.height + section.deflection - reference, False
        self.dent, self.width = dent, 0.0
        self.dented = 0 * self.deflection if dent is None else dent.at(section.along)

    def straighten(self) -> None:
        """Take the mean height of the layers off, so that curvature and bending do not hide the damage."""
        self.deflection, self.straight = self.section.height + self.section.deflection - self.mean, True

    def _mean(self) -> np.ndarray:
        """Return the mean of the deformed heights of all layers at the points of each row, by thickness."""
        along = self.section.along
        keys = np.round(along[:, [0, -1]] / (np.abs(along).max() or 1.0) * 1e7).astype(np.int64)
        _, column = np.unique(keys, axis=0, return_inverse=True)
        column = column.ravel()
        weights = self.bottoms - self.tops
        total, sums = np.zeros(column.max() + 1), np.zeros((column.max() + 1, along.shape[1]))
        np.add.at(total, column, weights)
        np.add.at(sums, column, weights[:, None] * (self.section.height + self.section.deflection))
        return np.asarray((sums / total[:, None])[column])

    def remark(self, style: PictureStyle) -> str:
        """Return what the title says of a deflection that is not drawn."""
        return f"\nbending of the plate over {style.shown('length', self.range)} not shown" if self.straight else ""

    def height(self, row: int, depth: float) -> np.ndarray:
        """Return the heights of a plane of a row, at its points, from the struck face downwards."""
        return np.asarray(depth + self.deflection[row] + (1 - depth / self.plate.thickness) * self.dented[row])

    def span(self) -> tuple[float, float]:
        """Return the least and greatest height shown."""
        tops = [self.height(row, self.tops[row]).min() for row in self.rows]
        bottoms = [self.height(row, self.bottoms[row]).max() for row in self.rows]
        margin = 0.06 * self.plate.thickness
        return float(min(tops)), float(max(bottoms) + margin)

    def draw(self, axes: Axes, style: PictureStyle, span: tuple[float, float],
             inches: float) -> dict[str, Patch | Line2D]:
        """Draw everything, a unit of depth `inches` high; return the entries of the legend by name."""
        # Lines are at most half as wide as a ply.
        self.width = min(1.8, 36 * inches * self.plate.thinnest)
        handles = self._plies(axes)
        handles |= self._failures(axes)
        handles |= self._cracks(axes)
        handles |= self._delaminations(axes)
        handles |= self._face(axes, style)
        axes.set_rasterization_zorder(_PIXELS)  # plies are thousands of small polygons
        axes.set(xlim=(-self.half, self.half), ylim=(span[1], span[0]))
        for name, side, largest in (("distance from the struck point", axes.xaxis, self.half),
                                    ("depth", axes.yaxis, self.plate.thickness)):
            length = style.axis(name, "length", [largest])
            side.set_label_text(length.label)
            side.set_major_formatter(FuncFormatter(lambda value, _, factor=length.factor: f"{factor * value:.4g}"))
        axes.yaxis.set_major_locator(MaxNLocator(6))
        self._numbers(axes, inches)
        return handles

    def _band(self, row: int, top: float, bottom: float) -> np.ndarray:
        """Return the outline of a band of a row."""
        along = self.section.along[row]
        return np.column_stack([np.concatenate([along, along[::-1]]),
                                np.concatenate([self.height(row, top), self.height(row, bottom)[::-1]])])

    def _plies(self, axes: Axes) -> dict[str, Patch | Line2D]:
        """Draw the plies, the darker the more their fibres run across the section, and lines between them."""
        bands, colours, lines = [], [], []
        across = np.abs(np.sin(np.radians(self.plate.angles - self.section.angle)))
        for row in self.rows:
            layer = self.layers[row]
            for ply, top, bottom in zip(layer.plies, layer.depths[:-1], layer.depths[1:], strict=True):
                bands.append(self._band(row, top, bottom))
                colours.append(_shade(across[ply - 1]))
                lines.append(np.column_stack([self.section.along[row], self.height(row, bottom)]))
            lines.append(np.column_stack([self.section.along[row], self.height(row, self.tops[row])]))
        axes.add_collection(PolyCollection(bands, facecolors=colours, edgecolors=colours, linewidths=0.2))
        axes.add_collection(LineCollection(lines, colors="0.55", linewidths=0.4))
        return {name: Patch(facecolor=_shade(value), edgecolor="0.55", label=name)
                for name, value in ((_ALONG, 0), (_ACROSS, 1))}

    def _failed(self, ply: int, mode: str) -> list[int]:
        """Return the rows shown in which a ply failed in a mode."""
        return [row for row in np.intersect1d(self.section.failed(ply, mode), self.rows)
                if ply in self.layers[row].plies]

    def _failures(self, axes: Axes) -> dict[str, Patch | Line2D]:
        """Draw crushed matrix and failed fibres as filled parts of plies."""
        bands: dict[str, list[np.ndarray]] = {name: [] for name in _FILLED}
        for ply in self.section.failures:
            for row in self._failed(ply, "matrix crushing"):
                bands["matrix crushing"].append(self._band(row, *self.layers[row].of(ply)))
            crushed = self.section.crushed.get(ply)
            for row in self._failed(ply, "fibre failure"):
                name = "fibre failure" if crushed is None else "fibres crushed" if crushed[row] else "fibres torn"
                bands[name].append(self._band(row, *self.layers[row].of(ply)))
        handles = {}
        for name, found in bands.items():
            if found:
                drawn = {"facecolor": FAILURES[name], "hatch": HATCHES.get(name, ""), "edgecolor": "black",
                         "linewidth": 0.3}
                axes.add_collection(PolyCollection(found, zorder=2, **drawn))
                handles[name] = Patch(label=name, **drawn)
        return handles

    def _cracks(self, axes: Axes) -> dict[str, Patch | Line2D]:
        """Draw a line through the ply for each cracked element; along the ply where the crack is in the drawing."""
        across, along = [], []
        for ply in self.section.failures:
            turned = (self.plate.angles[ply - 1] - self.section.angle + 90) % 180 - 90
            for row in self._failed(ply, "matrix cracking"):
                places, (top, bottom) = self.section.along[row], self.layers[row].of(ply)
                middle = len(places) // 2
                if abs(turned) < _IN_PLANE:
                    along.append(np.column_stack([places, self.height(row, (top + bottom) / 2)]))
                else:
                    across.append([(places[middle], self.height(row, top)[middle]),
                                   (places[middle], self.height(row, bottom)[middle])])
        handles = {}
        for name, lines, line_style in ((_THROUGH, across, "-"), (_IN_DRAWING, along, ":")):
            if lines:
                drawn = {"color": FAILURES["matrix cracking"], "linestyle": line_style}
                axes.add_collection(LineCollection(lines, linewidths=0.7 * self.width, zorder=3, **drawn))
                handles[name] = Line2D([], [], linewidth=1.3, label=name, **drawn)
        return handles

    def _delaminations(self, axes: Axes) -> dict[str, Patch | Line2D]:
        """Draw delaminated interfaces: filled gaps where they are open, lines where they are closed."""
        section, handles = self.section, {}
        delaminated = section.delaminated
        least = _GAP * self.plate.thinnest
        for row in self.rows[np.any(delaminated[self.rows], axis=1)]:
            lower = self.height(row, self.tops[row])
            gap = np.nan_to_num(section.opening[row])
            known = bool(np.all(np.isfinite(section.opening[row])))
            is_open = delaminated[row] & (gap > least)
            closed = delaminated[row] & ~is_open
            for name, where, colour in ((_GAPS["closed" if known else ""], closed, _CLOSED),
                                        (_GAPS["open"], is_open, _OPEN)):
                if not np.any(where):
                    continue
                axes.plot(section.along[row], np.where(_wider(where), lower, np.nan), color=colour,
                          linewidth=self.width, solid_capstyle="butt", zorder=4)
                handles[name] = Line2D([], [], color=colour, linewidth=3, label=name)
            axes.fill_between(section.along[row], lower, lower - gap, where=is_open, color=_OPEN, linewidth=0.8,
                              zorder=5)
        return handles

    def _face(self, axes: Axes, style: PictureStyle) -> dict[str, Patch | Line2D]:
        """Draw the struck face, with the dent, and an arrow at the struck point."""
        middles, first = self.section.along.mean(axis=1), self.section.first_ply
        own = [row for row in self.rows if first[row] == first[self.rows][middles[self.rows] == middles[row]].min()]
        own.sort(key=middles.__getitem__)
        orders = {row: np.argsort(self.section.along[row]) for row in own}
        along = np.concatenate([self.section.along[row][orders[row]] for row in own])
        heights = np.concatenate([self.height(row, self.tops[row])[orders[row]] for row in own])
        axes.plot(along, heights, color="black", linewidth=1, zorder=6)
        axes.annotate("struck point", (0, np.interp(0, along, heights)), (0, 14), ha="center",
                      textcoords="offset points", fontsize=_LETTERS, annotation_clip=False,
                      arrowprops={"arrowstyle": "-|>", "color": "black", "shrinkA": 0, "shrinkB": 1})
        depth = "" if self.dent is None else f", dent {style.shown('length', self.dent.depth)} by the indentation law"
        return {_FACE: Line2D([], [], color="black", linewidth=1, label=f"{_FACE}{depth}")}

    def _numbers(self, axes: Axes, inches: float) -> None:
        """Write numbers and angles of the plies beside the section, as many as there is room for."""
        least = self.plate.thinnest * inches * 72
        step = max(1, int(np.ceil(1.15 * _LETTERS / least)))
        reached = self.section.along[self.rows].max(axis=1)
        ends = self.rows[reached >= reached.max()]
        shown = [(ply, row) for row in ends for ply in self.layers[row].plies]
        for ply, row in shown[::step]:
            height = np.mean(self.layers[row].of(ply)) + self.deflection[row][-1]
            axes.text(1.01, height, f"{ply}: {self.plate.angles[ply - 1]:g}°", fontsize=_LETTERS, va="center",
                      transform=axes.get_yaxis_transform())


def _shade(across: float) -> str:
    """Return the grey of a ply by the sine of the angle between its fibres and the section."""
    return str(_LIGHT - (_LIGHT - _DARK) * across)


def _wider(where: np.ndarray) -> np.ndarray:
    """Return places and their neighbours, so that single points are drawn as lines too."""
    return np.asarray(where | np.concatenate([[False], where[:-1]]) | np.concatenate([where[1:], [False]]))
