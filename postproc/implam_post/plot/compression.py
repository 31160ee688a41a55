"""Pictures of compressed plates: stress against shortening, gauge strains against stress."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from implam_post.io.compression import STRENGTH, STRESS, row_of_strength
from implam_post.io.history import History
from implam_post.plot.style import STYLES, PictureStyle

_GAUGE = "gauge_strain_"


def is_compressed(history: History) -> bool:
    """Return whether a &line of the run compresses the plate."""
    return bool(np.any(history.columns.get(STRESS, 0)))


def remark_of(summary: Mapping[str, Any], style: PictureStyle, undamaged: float | None = None) -> str:
    """Return strength, retained fraction of the undamaged strength, failure code and percent bending, if known."""
    if STRENGTH not in summary:
        return ""
    parts = [style.shown("stress", summary[STRENGTH], 4)]
    if undamaged:
        parts.append(f"{100 * summary[STRENGTH] / undamaged:.3g} % of the undamaged plate")
    parts.append((summary.get("failure_code") or "code not known") if summary["has_failed"] else "not failed")
    if "percent_bending" in summary:
        parts.append(f"bending {summary['percent_bending']:.3g} %")
    return ", ".join(parts)


def compression_figure(histories: Mapping[str, History], style: PictureStyle, remarks: Mapping[str, str] | None = None,
                       undamaged: float | None = None) -> Figure:
    """Draw the stress of runs, by name, against the shortening, and below it the strains of their gauges.

    Remarks on runs are shown in the legend; `undamaged` is the strength of the undamaged plate, if known.
    """
    gauges = any(_gauges(history) for history in histories.values())
    figure = Figure(figsize=(7, 8 if gauges else 4.2), layout="constrained")
    panels = np.ravel(figure.subplots(1 + gauges, squeeze=False))
    _draw_stress(panels[0], histories, style, remarks or {}, undamaged)
    if gauges:
        _draw_gauges(panels[1], histories, style)
    return figure


def _gauges(history: History) -> Sequence[str]:
    """Return the columns of gauge strains."""
    return [name for name in history.columns if name.startswith(_GAUGE)]


def _draw_stress(axes: Axes, histories: Mapping[str, History], style: PictureStyle, remarks: Mapping[str, str],
                 undamaged: float | None) -> None:
    """Draw stress against shortening, with a dot at the strength and a line at that of the undamaged plate."""
    along, up = (style.axis(label, dimension, np.concatenate([one[column] for one in histories.values()]))
                 for label, dimension, column in (("shortening", "length", "shortening"),
                                                  ("far-field stress", "stress", STRESS)))
    for place, (name, history) in enumerate(histories.items()):
        line, top = STYLES[place % len(STYLES)], row_of_strength(history)
        label = ": ".join(filter(None, (name, remarks.get(name))))
        axes.plot(along.factor * history["shortening"], up.factor * history[STRESS], label=label or None, **line)
        axes.plot(along.factor * history["shortening"][top], up.factor * history[STRESS][top], "o",
                  color=line["color"], label=None if place else "strength")
    if undamaged:
        axes.axhline(up.factor * undamaged, color="grey", linestyle="--", linewidth=1, label="undamaged plate")
    axes.set(xlabel=along.label, ylabel=up.label)
    axes.grid(alpha=0.3)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize="small", loc="lower center", bbox_to_anchor=(0.5, 1.0))


def _draw_gauges(axes: Axes, histories: Mapping[str, History], style: PictureStyle) -> None:
    """Draw gauge strains against the stress up to the strength; back-to-back gauges diverge when the plate buckles."""
    up = style.axis("far-field stress", "stress", np.concatenate([one[STRESS] for one in histories.values()]))
    for place, (name, history) in enumerate(histories.items()):
        rows = slice(0, row_of_strength(history) + 1)
        for gauge in _gauges(history):
            number = gauge.removeprefix(_GAUGE)
            label = f"gauge {number}" if len(histories) == 1 else f"{name}, gauge {number}"
            line = dict(STYLES[place % len(STYLES)])
            if len(histories) == 1:
                line["color"] = f"C{(int(number) - 1) % 10}"
            axes.plot(up.factor * history[STRESS][rows], 1e6 * history[gauge][rows], label=label, **line)
    axes.set(xlabel=up.label, ylabel="strain of gauges [1e-6]")
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small")
