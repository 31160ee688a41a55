"""The section on the test in the page of an impact: impactor, energy, panel and supports, as ASTM D7136 requires."""

import math
from collections.abc import Mapping
from typing import Any

from implam_post.io.deck import Deck
from implam_post.io.errors import ImplamError
from implam_post.io.run import Run
from implam_post.io.shapes import curvatures_of
from implam_post.io.units import SYSTEMS
from implam_post.plot.style import PictureStyle

Row = tuple[str, str, str]
# Where a frame supports the panel.
_BEARINGS = {"edge": "at the edge of its window", "face": "on its face"}


def impact_rows(run: Run, style: PictureStyle) -> list[Row]:
    """Return the rows of the section; none without an impactor, or if the deck of the run is not known."""
    try:
        deck = run.deck
        if not deck.has("impactor"):
            return []
        plies = [ply for ply in run.summary["plies"] if "doubler" not in ply]
        thickness = float(sum(ply["thickness"] for ply in plies))
        sides = " by ".join(style.shown("length", side) for side in deck.lengths())
        return [*_impactor(deck, run.summary, thickness, style),
                ("panel", f"{sides}, {style.shown('length', thickness)} thick", f"{len(plies)} plies"),
                *_curvature(deck, style), *_supports(deck, style)]
    except ImplamError:
        return []


def _impactor(deck: Deck, summary: Mapping[str, Any], thickness: float, style: PictureStyle) -> list[Row]:
    """Return the rows of impactor and energy."""
    rows, mass = [], deck.number("impactor", "mass", 0.0)
    radius, travel = deck.number("impactor", "radius", 0.0), deck.number("impactor", "travel", 0.0)
    energy = deck.number("impactor", "energy", 0.0)
    velocity = deck.number("impactor", "velocity", math.sqrt(2 * energy / mass) if mass > 0 else 0.0)
    if travel > 0:
        rows.append(("prescribed displacement of the impactor", style.shown("length", travel, 4), ""))
    else:
        rows += [("impact velocity", style.shown("velocity", velocity, 4), ""),
                 ("mass of the impactor", style.shown("mass", mass, 4), "")]
    if radius > 0:
        rows.append(("nose of the impactor", f"hemisphere of {style.shown('length', 2 * radius, 4)} in diameter", ""))
    else:
        rows.append(("nose of the impactor", "by its contact stiffness k only", ""))
    if summary.get("energy_impact"):
        rows += [("impact energy", style.shown("energy", summary["energy_impact"], 4), ""),
                 ("impact energy per thickness", _per_thickness(summary["energy_impact"], thickness, style), "")]
    at = deck.numbers("impactor", "at")
    if any(at):
        rows.append(("struck point, from the centre", _point(at, style), "x, y"))
    return rows


def _per_thickness(energy: float, thickness: float, style: PictureStyle) -> str:
    """Return energy over thickness, in J/mm if the units are known."""
    if style.system not in SYSTEMS:
        return f"{energy / thickness:.4g}"
    length, mass, time = SYSTEMS[style.system]
    return f"{energy / thickness * mass * length / time**2 * 1e-3:.4g} J/mm"


def _curvature(deck: Deck, style: PictureStyle) -> list[Row]:
    """Return the row of the radii of a curved panel."""
    curvatures = curvatures_of(deck)
    if not any(curvatures):
        return []
    radii = ", ".join(style.shown("length", 1 / curvature) if curvature else "straight" for curvature in curvatures)
    return [("radius of the lines along x and y", radii, "positive: struck on the convex side")]


def _supports(deck: Deck, style: PictureStyle) -> list[Row]:
    """Return the rows of edges, frames and clamps."""
    names, edges = ("x-min", "x-max", "y-min", "y-max"), deck.edges()
    held = edges[0] if len(set(edges)) == 1 else ", ".join(f"{name} {edge}" for name, edge in
                                                           zip(names, edges, strict=True))
    rows = [("edges of the panel", held, "")]
    for support in deck.groups.get("support", []):
        rows += _frame(support, style)
        if clamps := support.get("clamps", []):
            points = ", ".join(_point(clamps[place:place + 2], style) for place in range(0, len(clamps), 2))
            force = support.get("clamp_force")
            rows.append(("clamps", f"{len(clamps) // 2} at {points}", "x, y; " + (
                f"{style.shown('force', force[0])} each" if force else "no limit of force")))
    return rows


def _frame(support: Mapping[str, Any], style: PictureStyle) -> list[Row]:
    """Return the row of a frame."""
    lifts = bool(support.get("unilateral", [False])[0])
    bearing = str(support.get("bearing", ["face" if lifts else "edge"])[0]).lower()
    sides = str(support.get("sides", [bearing])[0]).lower()
    words = _BEARINGS[bearing] + (f", its sides along x {_BEARINGS[sides]}" if sides != bearing else "")
    remark = f"supports {words}, {'the panel may lift off' if lifts else 'holds the panel both ways'}"
    if len(window := support.get("window", [])) == 2:
        return [("frame, window", " by ".join(style.shown("length", side) for side in window), remark)]
    if radius := support.get("radius", []):
        return [("frame, circular window", f"{style.shown('length', 2 * radius[0])} in diameter", remark)]
    return []


def _point(at: list[Any], style: PictureStyle) -> str:
    """Return the coordinates of a point."""
    axis = style.axis("", "length", at)
    unit = style.shown("length", max(map(abs, at))).partition(" ")[2]
    return f"({', '.join(f'{axis.factor * value:.4g}' for value in at)}) {unit}".rstrip()
