"""Pictures of the page of a run: plate and lay-up, curves, maps."""

import base64
import io
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from implam_post.fields import Fields
from implam_post.history import ALL_ENERGIES, History
from implam_post.plan import delamination_figure, failures_figure
from implam_post.quantities import growth_rows

_SPACE = 0.12  # free part of the picture beside the plies


def as_image(figure: Figure) -> str:
    """Return a figure as a PNG in base64."""
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=100)
    return base64.b64encode(stream.getvalue()).decode("ascii")


def layup_figure(summary: Mapping[str, Any]) -> Figure:
    """Draw the plies from the struck face, fibres as lines of their angle, interfaces that may delaminate in red."""
    plies = summary["plies"]
    total = sum(ply["thickness"] for ply in plies)
    figure = Figure(figsize=(7, min(max(1.6, 0.34 * len(plies)), 9)), layout="constrained")
    axes = figure.subplots()
    top, shades = 0.0, {angle: shade for shade, angle in enumerate(sorted({ply["angle"] % 180 for ply in plies}))}
    bottoms = []
    for ply in plies:
        depth = ply["thickness"] / total
        axes.add_patch(Rectangle((0, -top - depth), 1, depth, facecolor=f"C{shades[ply['angle'] % 180] % 10}",
                                 edgecolor="white", alpha=0.55))
        axes.text(0.5, -top - depth / 2, f"{ply['ply']}: {ply['angle']:g}°  {ply['made_of']}", ha="center", va="center",
                  fontsize=min(9, 200 / len(plies)))
        _fibre(axes, ply["angle"], -top - depth / 2, depth)
        top += depth
        bottoms.append(-top)
    for entry in summary.get("interfaces", []):
        height = bottoms[entry["ply_above"] - 1]
        axes.plot([0, 1], [height, height], color="red", linewidth=2)
        axes.text(1.01, height, "grown" if entry["first_growth"] else "intact", color="red", va="center", fontsize=8)
    axes.annotate("", (0.5, 0), (0.5, _SPACE), arrowprops={"arrowstyle": "->", "color": "red"})
    axes.set(xlim=(-_SPACE, 1 + _SPACE), ylim=(-1.02, _SPACE))
    axes.axis("off")
    return figure


def _fibre(axes: Any, angle: float, height: float, depth: float) -> None:
    """Draw the direction of the fibres at the left of a ply, as seen from the struck face."""
    turned, length = np.radians(angle), 0.4 * depth
    axes.plot(np.array([-1, 1]) * 0.03 * np.cos(turned) - _SPACE / 2,
              height + np.array([-1, 1]) * length * np.sin(turned), color="black", linewidth=1)


def plan_figure(summary: Mapping[str, Any]) -> Figure:
    """Draw the plate in plan with the rectangle around the delamination of each interface, all to scale."""
    along, across = summary["plate_size"]
    figure = Figure(figsize=(5, min(max(5 * across / along, 1.5), 8)), layout="constrained")
    axes = figure.subplots()
    axes.add_patch(Rectangle((-along / 2, -across / 2), along, across, facecolor="whitesmoke", edgecolor="black"))
    for position, entry in enumerate(summary.get("interfaces", [])):
        (left, right), (front, back) = entry["x"], entry["y"]
        axes.add_patch(Rectangle((left, front), right - left, back - front, facecolor="none",
                                 edgecolor=f"C{position % 10}", label=f"below ply {entry['ply_above']}"))
    axes.plot(0, 0, "+", color="red")
    axes.set(xlim=(-0.53 * along, 0.53 * along), ylim=(-0.53 * across, 0.53 * across), aspect="equal", xlabel="x",
             ylabel="y")
    if summary.get("interfaces"):
        axes.legend(fontsize="small", title="extents of what came apart")
    return figure


def history_pictures(history: History) -> Iterator[tuple[str, Figure]]:
    """Give the curves of a history: force, deflection, areas and energies."""
    if np.any(history["force"]):
        yield "contact force against time", _curve(history, "time", "force", "contact force")
        yield "contact force against deflection", _curve(history, "deflection", "force", "contact force")
    yield "deflection against time", _curve(history, "time", "deflection", "deflection of the struck point")
    areas = [name for name in history.columns if name.startswith("area_below_")]
    if areas:
        yield "delaminated area against time", _curves(
            history, {name.replace("area_below_", "below ply "): name for name in areas}, "delaminated area")
    energies = [name for name in ALL_ENERGIES if name in history.columns and np.any(history[name])]
    yield "energies against time", _curves(
        history, {name.removeprefix("energy_").replace("_", " "): name for name in energies}, "energy")


def _curve(history: History, against: str, column: str, label: str) -> Figure:
    """Draw one column; steps in which delaminations grew are marked on the force."""
    figure = Figure(figsize=(7, 3.4), layout="constrained")
    axes = figure.subplots()
    axes.plot(history[against], history[column])
    grown = growth_rows(history)
    if column == "force" and len(grown):
        axes.plot(history[against][grown], history[column][grown], "o", markersize=3, label="delamination grows")
        axes.legend()
    axes.set(xlabel=against, ylabel=label)
    axes.grid(alpha=0.3)
    return figure


def _curves(history: History, columns: Mapping[str, str], label: str) -> Figure:
    """Draw several columns against time."""
    figure = Figure(figsize=(7, 3.4), layout="constrained")
    axes = figure.subplots()
    for name, column in columns.items():
        axes.plot(history.time, history[column], label=name)
    axes.set(xlabel="time", ylabel=label)
    axes.grid(alpha=0.3)
    if columns:
        axes.legend(loc="center left", bbox_to_anchor=(1, 0.5), fontsize="small")
    return figure


def map_pictures(fields: Fields) -> Iterator[tuple[str, Figure]]:
    """Give what the fields hold of interfaces and plies, in plan."""
    last = fields.snapshots[-1]
    if last.mesh.interfaces:
        yield "delamination of each interface", delamination_figure(fields)
    if last.failures and any(np.any(failed) for failed in last.failures.values()):
        yield "failures of each ply", failures_figure(fields)
