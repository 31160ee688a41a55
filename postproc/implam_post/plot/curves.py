"""Pictures of a history with measured curves, each of two columns, such as force against displacement."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from implam_post.io.errors import FileError, ImplamError, reason
from implam_post.io.files import replaced
from implam_post.io.history import History, read_columns
from implam_post.io.measured import check_units
from implam_post.io.quantities import growth_rows
from implam_post.io.units import Axis
from implam_post.plot.style import PictureStyle

# Names of columns on axes, and their dimensions.
AXES = {"time": ("time", "time"), "force": ("contact force", "force"), "indentation": ("indentation", "length"),
        "deflection": ("deflection of struck point", "length"),
        "patch_deflection": ("deflection of the patch", "length"),
        "impactor_displacement": ("displacement of the impactor", "length"),
        "delaminated_area": ("delaminated area", "area"), "projected_area": ("projected area", "area")}

_GROWN = 2  # stage of an interface in which points have failed


def plot_curves(history: History, files: Sequence[Path], path: Path, style: PictureStyle) -> Path:
    """Draw a history as lines and measured curves as dots, a panel for each file of curves."""
    curves = [read_columns(file) for file in files]
    for curve in curves:
        check_units(history, curve)
    with matplotlib.rc_context({"font.size": style.letters}):
        figure = Figure(figsize=(8, 4.5 * len(curves)), layout="constrained")
        for axes, curve in zip(figure.subplots(len(curves), squeeze=False)[:, 0], curves, strict=True):
            along, up = _columns(curve)
            shown = history if along == "time" else in_contact(history)
            horizontal, vertical = (axis_of_column(name, [*curve[name], *shown[name]], history, style)
                                    for name in (along, up))
            axes.plot(horizontal.factor * shown[along], vertical.factor * shown[up], label="Implam")
            axes.plot(horizontal.factor * curve[along], vertical.factor * curve[up], "k.", markersize=4,
                      label=f"measured ({Path(curve.name).stem})")
            axes.set(xlabel=horizontal.label, ylabel=vertical.label)
            axes.grid(alpha=0.3)
            axes.legend()
        try:
            with replaced(path) as draft:
                figure.savefig(draft, dpi=style.dots_per_inch)
        except ValueError as error:
            raise ImplamError(f"{path} cannot be written ({reason(error)}).") from None
    return path


def axis_of_column(name: str, values: Sequence[float] | np.ndarray, history: History, style: PictureStyle) -> Axis:
    """Return factor and label of the axis of a column."""
    return style.clock(values, [history.by_load_steps]) if name == "time" else style.axis(*AXES[name], values)


def in_contact(history: History) -> History:
    """Return the rows up to the end of the last contact; all rows if there is no contact."""
    touching = np.flatnonzero(history["force"] > 0)
    return history.until(history.time[min(touching[-1] + 1, len(history.time) - 1)]) if len(touching) else history


def rows_of_growth(history: History) -> np.ndarray:
    """Return the rows at which delaminations grow, from first growth on: before it interfaces soften only."""
    stages = [values for name, values in history.columns.items() if name.startswith("stage_below_")]
    rows = growth_rows(history)
    return np.asarray(rows[np.any([values[rows] >= _GROWN for values in stages], axis=0)] if stages else rows)


def _columns(curve: History) -> tuple[str, str]:
    """Return the names of the two columns of a measured curve."""
    names = [*curve.columns][:2]
    if len(names) < 2 or not set(names) <= set(AXES):
        raise FileError(f"{curve.name} begins with the columns {', '.join(names)}; possible are {', '.join(AXES)}.")
    return names[0], names[1]
