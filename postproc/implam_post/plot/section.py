"""Sections through the plate (B-scans): plies to scale, delaminations, cracks, failed fibres, and the dent."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from implam_post.io.errors import ImplamError
from implam_post.io.fields import Fields, deck_in
from implam_post.io.history import History
from implam_post.io.section import Section, section_at
from implam_post.laminate.decks import plies_of
from implam_post.laminate.zones import zones_of
from implam_post.plot.plan_frame import state_of
from implam_post.plot.section_drawing import ORDER, Dent, Drawing, Plate
from implam_post.plot.style import PictureStyle

_PLAIN = PictureStyle()
# Inches: width of the axes of a panel, their greatest height, words of a panel, space above the struck face for the
# arrow, legend and text of the figure, and the height of a page.
_WIDTH, _HEIGHT, _WORDS, _ABOVE, _REST, _PAGE = 6.0, 2.7, 0.95, 0.4, 1.3, 10.0
# Bending by more than this many thicknesses is not drawn.
_BENT = 2.0
# Least half of the length shown, in thicknesses of the plate, and margin beside the damage.
_LEAST, _MARGIN = 3.0, 1.15
# Possible factors by which thicknesses are drawn larger than lengths.
_FACTORS = (100.0, 50.0, 30.0, 20.0, 10.0, 5.0, 3.0, 2.0, 1.0)


def plate_of(fields: Fields) -> Plate | None:
    """Return the plies of a run; None if its deck is not known."""
    deck = deck_in(fields.path)
    try:
        if deck is None or not (plies := plies_of(deck)):
            return None
        return Plate(zones_of(deck, plies))
    except ImplamError:
        return None


def dent_of(fields: Fields, history: History | None, time: float) -> Dent | None:
    """Return the indentation at a time, from the history; None without one, or if the nose is not known."""
    deck = deck_in(fields.path)
    if history is None or deck is None or not deck.has("impactor"):
        return None
    radius = deck.number("impactor", "radius", 0.0)
    until = min(time, float(history.time[-1]))
    column = "indentation" if history.at("force", until) > 0 else "dent_indentation"
    depth = history.at(column, until) if column in history.columns else 0.0
    return Dent(depth, radius) if depth > 0 and radius > 0 else None


def section_figure(fields: Fields, style: PictureStyle = _PLAIN, history: History | None = None,
                   angles: Sequence[float] | None = None, place: int = -1) -> Figure | None:
    """Draw sections through the struck point at angles, by default along and across the fibres of the struck ply.

    None if the plies are not known. Thickness, deflection and openings are drawn on one scale.
    """
    plate = plate_of(fields)
    titles = {} if plate is None else _titles(float(plate.angles[0]), angles)
    sections = [found for angle in titles if len((found := section_at(fields, angle, place)).along)]
    if plate is None or not sections:
        return None
    time = fields.snapshots[place].time
    drawn, half = _drawings(sections, plate, dent_of(fields, history, time))
    spans = [one.span() for one in drawn]
    most = min(_HEIGHT, (_PAGE - _REST) / len(drawn) - _WORDS)
    largest = max(most, 0.5) / max(high - low for low, high in spans) * (2 * half / _WIDTH)
    factor = next((step for step in _FACTORS if step <= largest), 1.0)
    inches = factor * _WIDTH / (2 * half)
    heights = [(high - low) * inches + _ABOVE for low, high in spans]
    figure = Figure(figsize=(_WIDTH + 1.5, sum(heights) + _WORDS * len(heights) + _REST), layout="constrained")
    handles: dict[str, Patch | Line2D] = {}
    for axes, one, (low, high) in zip(figure.subplots(len(drawn), 1, squeeze=False, height_ratios=heights)[:, 0], drawn,
                                      spans, strict=True):
        handles |= one.draw(axes, style, (low - _ABOVE / inches, high), inches)
        axes.set_title(f"{titles[one.section.angle]}{one.remark(style)}", fontsize="medium")
    figure.legend(handles=[handles[name] for name in ORDER if name in handles], loc="outside lower center", ncols=2,
                  fontsize="small")
    scale = "one scale for length and thickness" if factor == 1 else (
        f"thickness, deflection and gaps {factor:g} times as large as the length")
    figure.suptitle(f"{state_of(fields, time, style, 4)}; {scale}", fontsize="small")
    return figure


def _titles(first: float, angles: Sequence[float] | None) -> dict[float, str]:
    """Return the titles of the sections by their angles; `first` is the angle of the struck ply."""
    if angles is not None:
        return {angle: f"section at {angle:g}° from x" for angle in angles}
    turned = {first: "along", first - 90 if first > 0 else first + 90: "across"}
    return {angle: f"section {word} the fibres of the struck ply, {angle:g}° from x" for angle, word in turned.items()}


def _drawings(sections: Sequence[Section], plate: Plate, dent: Dent | None) -> tuple[list[Drawing], float]:
    """Return the drawings of the damaged part of the plate, and half the length shown."""
    damaged = max(max(map(abs, section.damaged)) for section in sections)
    ends = max(float(np.abs(section.along).max()) for section in sections)
    half = min(max(_LEAST * plate.thickness, _MARGIN * damaged), ends)
    drawn = [Drawing(section, plate, half, dent) for section in sections]
    if any(one.range > _BENT * plate.thickness for one in drawn):
        for one in drawn:
            one.straighten()
    return drawn, half
