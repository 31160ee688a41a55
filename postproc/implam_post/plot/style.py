"""Style of pictures: units of axes, file format, dots per inch, font size, and line styles of several runs."""

import argparse
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from implam_post.io.errors import ImplamError
from implam_post.io.units import SYSTEMS, Axis, axis_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Space around axes, inches.
_PAD = 0.08

FORMATS = ("png", "pdf", "svg")
# Line styles of several runs, which can be distinguished without colours.
STYLES = [{"color": f"C{place}", "linestyle": line_style} for place, line_style in
          enumerate(("-", "--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1, 1, 1)), (0, (1, 1)), (0, (8, 3))))]


# Colours of failures, by Okabe and Ito: colour-blind readers can distinguish them.
FAILURES = {"matrix cracking": "#D55E00", "matrix crushing": "#F0E442", "fibres torn": "#CC79A7",
            "fibres crushed": "#009E73", "fibre failure": "#CC79A7"}
# Hatches of failures that fill an area.
HATCHES = {"fibres torn": "xxxx", "fibres crushed": "////", "fibre failure": "xxxx"}
# Colours of energies, by Tol, in the order of the energy balance.
ENERGIES = ("#88CCEE", "#DDCC77", "#44AA99", "#CC6677", "#332288", "#882255", "#999933", "#666666", "#AA4499",
            "#DDDDDD", "#117733", "#000000")
# Maps of colours of times, and of interfaces from the struck face on.
TIMES, DEPTHS = "viridis_r", "plasma"
# Numbers below are written without an exponent, as in the summary of a run: 14220 mm².
_FIRST_WITH_EXPONENT = 1e7


@dataclass(frozen=True)
class PictureStyle:
    """Settings for all pictures of a command; `system` is the system of units of the results, empty if not known."""

    system: str = ""
    dots_per_inch: int = 150
    letters: float = 10.0
    kind: str = "png"
    projected: str = "depth"

    @property
    def seconds(self) -> float:
        """The time unit of the results in seconds; 1 in an unknown system."""
        return SYSTEMS[self.system][2] if self.system in SYSTEMS else 1.0

    def axis(self, label: str, dimension: str, values: Iterable[float]) -> Axis:
        """Return factor and label of an axis, in units suitable for its values."""
        return axis_of(label, dimension, values, self.system)

    def clock(self, times: Iterable[float], by_load_steps: Iterable[bool]) -> Axis:
        """Return factor and label of a time axis of runs; times of load steps are load factors."""
        kinds = set(by_load_steps)
        if kinds == {True}:
            return Axis(1.0, "load factor")
        return Axis(1.0, "time (the deck's units), load factor") if True in kinds else self.axis("time", "time", times)

    def instant(self, time: float, by_load_steps: bool, digits: int = 3) -> str:
        """Return a time with its unit, or a load factor, as text."""
        return f"load factor {time:.{digits}g}" if by_load_steps else self.shown("time", time, digits)

    def shown(self, dimension: str, value: float, digits: int = 3) -> str:
        """Return a value with its unit, rounded to some digits; without a unit in an unknown system."""
        axis = self.axis("", dimension, [value])
        unit = axis.label.strip(" []") if self.system in SYSTEMS else ""
        words = f"{axis.factor * value:.{digits}g}"
        if "e+0" in words and abs(axis.factor * value) < _FIRST_WITH_EXPONENT:
            words = f"{float(words):.0f}"
        return f"{words} {unit}".strip()


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options for the appearance of pictures."""
    parser.add_argument("--units", choices=SYSTEMS, help="system of units of the results (default: that of the deck in "
                        "NAME.h5); if it is known, axes are in mm, ms, kN and J")
    parser.add_argument("--dpi", type=int, help="dots per inch (default: 150; pictures of --save and movies 80)")
    parser.add_argument("--font-size", type=float, default=10.0, help="font size in points (default: 10)")


def style_of(options: argparse.Namespace, results: Iterable[Path]) -> PictureStyle:
    """Return the style by the options; the default system of units is that of the first deck with a known one."""
    from implam_post.io.deck import system_of_deck
    from implam_post.io.fields import deck_in

    dots = (80 if getattr(options, "save", None) else 150) if options.dpi is None else options.dpi
    if not (10 <= dots <= 2400 and 3 <= options.font_size <= 60):
        raise ImplamError("--dpi must be from 10 to 2400, --font-size from 3 to 60.")
    system = options.units or next((name for path in results if (name := system_of_deck(deck_in(path)))), "")
    return PictureStyle(system, dots, options.font_size, getattr(options, "format", "png"),
                getattr(options, "projected", "depth"))


def lay_out(figure: "Figure") -> None:
    """Set margins, and compute the layout of a figure before it is drawn.

    Ticks depend on the sizes of axes and vice versa; titles and labels of axes with equal scales would be cut off.
    """
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.set(w_pad=_PAD, h_pad=_PAD)
    figure.draw_without_rendering()
