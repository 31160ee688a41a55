"""Pictures of G/G_c along delamination fronts, around the struck point and in plan."""

from collections.abc import Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from implam_post.io.contours import outline
from implam_post.io.fields import IMAGES, Fields, Snapshot, struck_point
from implam_post.plot.plan_frame import frame, is_by_load_steps, reach_of, state_of
from implam_post.plot.style import PictureStyle

_MAX_TIMES = 8
_PLAIN = PictureStyle()


def front_figure(fields: Fields, times: Sequence[float] | None = None, style: PictureStyle = _PLAIN) -> Figure:
    """Draw each interface at the given times, or at some of the times at which its front is loaded.

    Left: G/G_c against the angle around the struck point, a line for each time. Right: G/G_c in plan at the time of
    these at which it is largest.
    """
    interfaces = fields.snapshots[-1].mesh.interfaces
    figure = Figure(figsize=(11, 4 * len(interfaces)), layout="constrained")
    for (left, right), below_ply in zip(figure.subplots(len(interfaces), 2, squeeze=False), interfaces, strict=True):
        snapshots = _chosen(fields, below_ply, times)
        left.set_title(f"below ply {below_ply}", fontsize="medium")
        _draw_around(left, fields, below_ply, snapshots, style)
        if snapshots:
            draw_front(right, fields, below_ply, max(snapshots, key=lambda one: np.max(one.release(below_ply)[1])),
                       style)
    return figure


def draw_front(axes: Axes, fields: Fields, below_ply: int, snapshot: Snapshot, style: PictureStyle = _PLAIN) -> None:
    """Draw the front in plan at one time, and the cells ahead of it coloured by G/G_c."""
    cells, ratio = snapshot.release(below_ply)
    cells, ratio = fields.full_plate(cells), np.tile(ratio, len(IMAGES[fields.part]))
    shown = PolyCollection(cells, array=ratio, cmap="plasma_r", norm=Normalize(0, max(1.0, np.max(ratio, initial=0))),
                           linewidths=0)
    axes.add_collection(shown)
    delaminated = fields.delaminated(fields.place(snapshot.time), below_ply)
    axes.add_collection(LineCollection(outline(delaminated), colors="black", linewidths=0.8))
    axes.set_title(state_of(fields, snapshot.time, style), fontsize="medium")
    frame(axes, fields, reach_of(np.concatenate([cells, delaminated]), fields), style)
    axes.figure.colorbar(shown, ax=axes, location="bottom", shrink=0.8, label="$G/G_c$ ahead of the front")


def _draw_around(axes: Axes, fields: Fields, below_ply: int, snapshots: Sequence[Snapshot],
                 style: PictureStyle) -> None:
    """Draw G/G_c against the angle from x to the cells ahead of the front; of a quarter only the modelled part."""
    by_load_steps = is_by_load_steps(fields)
    colours = colormaps["viridis_r"](np.linspace(0.15, 1, max(len(snapshots), 2)))
    for snapshot, colour in zip(snapshots, colours, strict=False):
        cells, ratio = snapshot.release(below_ply)
        x, y = (np.mean(cells, axis=1) - struck_point(fields)).T
        angle = np.degrees(np.arctan2(y, x))
        order = np.argsort(angle)
        axes.plot(angle[order], ratio[order], ".-", color=colour, linewidth=1,
                  label=f"{snapshot.time:.3g}" if by_load_steps else style.shown("time", snapshot.time))
    axes.axhline(1, color="black", linestyle="--", linewidth=1)
    axes.set(xlabel="angle from x around the struck point (degrees)", ylabel="$G/G_c$",
             xlim=(0, 90) if fields.quarter else (-180, 180))
    axes.set_ylim(bottom=0)
    axes.xaxis.set_major_locator(MultipleLocator(15 if fields.quarter else 45))
    axes.grid(alpha=0.3)
    if snapshots:
        axes.legend(title="load factor" if by_load_steps else "time", fontsize="small", loc="center left",
                    bbox_to_anchor=(1, 0.5))


def _chosen(fields: Fields, below_ply: int, times: Sequence[float] | None) -> list[Snapshot]:
    """Return the stored times nearest to the requested ones, or up to eight equally spaced ones with a loaded front."""
    def loaded(snapshots: Sequence[Snapshot]) -> list[Snapshot]:
        return [snapshot for snapshot in snapshots if len(snapshot.release(below_ply)[1])]

    if times is None:
        all_loaded = loaded(fields.snapshots)
        places = np.linspace(0, len(all_loaded) - 1, min(len(all_loaded), _MAX_TIMES)).astype(int)
        return [all_loaded[place] for place in places]
    nearest = sorted({fields.place(time) for time in times})
    return loaded([fields.snapshots[place] for place in nearest])
