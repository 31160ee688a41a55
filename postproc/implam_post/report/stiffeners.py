"""The section on doublers and stringers in the page of a run: places, sections, largest loads of the stringers."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from implam_post.io.counts import counted
from implam_post.io.errors import ImplamError
from implam_post.io.run import Run
from implam_post.plot.style import PictureStyle

HEAD = ("", "place", "section", "axial force", "strain at the free edge")
# Columns of the history for the last two.
_LARGEST = (("stringer_force", "force"), ("stringer_strain", ""))

Row = tuple[str, ...]


def stiffener_rows(run: Run, style: PictureStyle) -> list[Row]:
    """Return a row for each doubler and stringer; none if the plate has none, or if the deck is not known."""
    try:
        groups = run.deck.groups
    except ImplamError:
        return []
    return [*(_doubler(doubler, run.summary, style) for doubler in groups.get("doubler", [])),
            *(_stringer(stringer, number, run, style)
              for number, stringer in enumerate(groups.get("stringer", []), 1))]


def _doubler(doubler: Mapping[str, Any], summary: Mapping[str, Any], style: PictureStyle) -> Row:
    """Return the row of a doubler."""
    sides = summary["plate_size"]
    name = str(doubler["name"][0])
    plies = [ply for ply in summary["plies"] if ply.get("doubler") == name]
    size = " by ".join(style.shown("length", side, 4) for side in doubler["size"])
    thickness = style.shown("length", float(sum(ply["thickness"] for ply in plies)), 4)
    return (f"doubler '{name}'", f"{size} about {_places(doubler['at'], sides, style)}, {_face(doubler)}",
            f"{counted(len(plies), 'ply', 'plies')}, {thickness}", "", "")


def _stringer(stringer: Mapping[str, Any], number: int, run: Run, style: PictureStyle) -> Row:
    """Return the row of a stringer."""
    along = str(stringer.get("along", ["x"])[0]).lower()
    at = _places(stringer.get("at", [0.0]), run.summary["plate_size"], style)
    return (f"stringer '{stringer['name'][0]}'", f"{'y' if along == 'x' else 'x'} = {at}, {_face(stringer)}",
            _section(stringer, style),
            *(_largest(run, f"{column}_{number}", dimension, style) for column, dimension in _LARGEST))


def _section(stringer: Mapping[str, Any], style: PictureStyle) -> str:
    """Return shape and sizes of a section."""
    kind = str(stringer.get("section", ["blade"])[0])
    if kind.lower() == "given":
        return "given stiffness"
    sizes = [style.shown("length", stringer[key][0], 4)
             for key in ("height", "thickness", "cap_width", "cap_thickness") if key in stringer]
    cap = f", cap {' by '.join(sizes[2:])}" if sizes[2:] else ""
    return f"{kind}, {' by '.join(sizes[:2])}{cap}"


def _largest(run: Run, column: str, dimension: str, style: PictureStyle) -> str:
    """Return the value of largest magnitude of a column, with its sign, and its time."""
    if run.columns is None or column not in run.columns.columns:
        return "-"
    values = run.columns[column]
    row = int(np.argmax(np.abs(values)))
    value = style.shown(dimension, values[row], 4) if dimension else f"{100 * values[row]:.3g} %"
    return f"{value} at {style.instant(run.columns.time[row], run.columns.by_load_steps, 4)}"


def _face(group: Mapping[str, Any]) -> str:
    """Return the face to which a doubler or stringer is bonded."""
    return f"{str(group.get('face', ['back'])[0]).lower()} face"


def _places(at: Sequence[float], sides: Sequence[float], style: PictureStyle) -> str:
    """Return coordinates in the unit of the sides of the plate."""
    factor, unit = style.axis("", "length", sides).factor, style.shown("length", max(sides)).partition(" ")[2]
    numbers = ", ".join(f"{factor * value:.4g}" for value in at)
    return f"{numbers if len(at) == 1 else f'({numbers})'} {unit}".rstrip()
