"""Plots of histories and fields (`implam-plot HISTORY.csv ...`, `implam-plot NAME.h5`), in the deck's own units."""

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from implam_post.errors import EXIT_DONE, CommandParser, FileError, ImplamError, run
from implam_post.fields import Fields, read_fields
from implam_post.front import front_figure
from implam_post.history import ENERGIES, History, read_history
from implam_post.plan import delamination_figure, draw_cracks, draw_delamination, failures_figure
from implam_post.quantities import growth_rows

_RESPONSES = {"force": "contact force", "indentation": "indentation", "deflection": "deflection of struck point"}


def plot_forces(histories: Sequence[History], path: Path) -> Path:
    """Draw the force of several histories over each other."""
    figure = Figure(figsize=(8, 4.5), layout="constrained")
    _draw(figure.subplots(), histories, "force")
    return _save(figure, path)


def plot_response(histories: Sequence[History], path: Path) -> Path:
    """Draw force, indentation and deflection, each with all histories over each other."""
    figure = Figure(figsize=(8, 10), layout="constrained")
    for axes, column in zip(figure.subplots(len(_RESPONSES), sharex=True), _RESPONSES, strict=True):
        _draw(axes, histories, column)
    return _save(figure, path)


def plot_energies(history: History, path: Path) -> Path:
    """Draw the energies of a history stacked, those below zero downwards, and the total at the start."""
    figure = Figure(figsize=(8, 5), layout="constrained")
    _stack(figure.subplots(), history)
    return _save(figure, path)


def plot_overview(fields: Fields, history: History, path: Path) -> Path:
    """Draw each interface in plan, with the cracks beside it, the force and the ledger in one picture."""
    interfaces = fields.snapshots[-1].mesh.interfaces
    if not interfaces:
        raise FileError(f"{fields.name} has no interface that may come apart.")
    figure = Figure(figsize=(11, 2.9 * max(len(interfaces), 2)), layout="constrained")
    left, right = figure.subfigures(1, 2)
    for axes, below_ply in zip(left.subplots(len(interfaces), squeeze=False)[:, 0], interfaces, strict=True):
        draw_delamination(axes, fields, below_ply)
        if fields.snapshots[-1].failures:
            draw_cracks(axes, fields, below_ply)
    force, ledger = right.subplots(2)
    _draw(force, [history], "force")
    _stack(ledger, history)
    return _save(figure, path, dots_per_inch=80)


def plot_fields(fields: Fields, base: Path, times: Sequence[float] | None = None) -> list[Path]:
    """Draw what the fields hold of interfaces, of their fronts (at some times) and of plies, a picture each."""
    drawn = []
    if fields.snapshots[-1].mesh.interfaces:
        drawn.append(_save(delamination_figure(fields), base.with_name(f"{base.name}_delamination.png")))
    if any(np.any(snapshot.release_ratio > 0) for snapshot in fields.snapshots):
        drawn.append(_save(front_figure(fields, times), base.with_name(f"{base.name}_front.png")))
    if fields.snapshots[-1].failures:
        drawn.append(_save(failures_figure(fields), base.with_name(f"{base.name}_plies.png")))
    return drawn


def _stack(axes: Axes, history: History) -> None:
    """Draw the ledger."""
    ledger = {column: history[column] for column in ENERGIES}
    shown = {column: values for column, values in ledger.items() if np.any(values)}
    colours = [f"C{ENERGIES.index(column)}" for column in shown]
    if shown:
        labels = [column.removeprefix("energy_").replace("_", " ") for column in shown]
        axes.stackplot(history.time, [np.maximum(values, 0) for values in shown.values()], labels=labels,
                       colors=colours, alpha=0.8)
        axes.stackplot(history.time, [np.minimum(values, 0) for values in shown.values()], colors=colours, alpha=0.8)
    axes.axhline(sum(values[0] for values in ledger.values()), color="black", linestyle="--", linewidth=1,
                 label="total at the start")
    axes.plot(history.time, history["energy_error"], color="black", linewidth=1, label="not accounted for")
    axes.set(xlabel="time (the deck's units, as all)", ylabel="energy", title=Path(history.name).stem)
    axes.locator_params(axis="x", nbins=6)
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5))


def _draw(axes: Axes, histories: Sequence[History], column: str) -> None:
    """Draw a column of several histories."""
    for position, history in enumerate(histories):
        line, = axes.plot(history.time, history[column], label=Path(history.name).stem,
                          linestyle="--" if position else "-")
        grown = growth_rows(history)
        if column == "force" and len(grown):
            axes.plot(history.time[grown], history[column][grown], "o", color=line.get_color(), markersize=3,
                      label="delamination grows")
    axes.set(xlabel="time (the deck's units, as all)", ylabel=_RESPONSES[column])
    axes.locator_params(axis="x", nbins=6)
    axes.grid(alpha=0.3)
    axes.legend()


def _save(figure: Figure, path: Path, dots_per_inch: int = 150) -> Path:
    """Write the figure, making the folder if it isn't there, and return the path."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, dpi=dots_per_inch)
    except OSError as error:
        raise FileError(f"{path} cannot be written ({error}).") from None
    return path


def _command(options: argparse.Namespace) -> int:
    """Draw and say what was drawn."""
    results = [path for path in options.results if path.suffix == ".h5"]
    histories = [path for path in options.results if path.suffix != ".h5"]
    if options.save and (len(results), len(histories)) != (1, 0):
        raise ImplamError("--save goes with one NAME.h5.")
    for path in results:
        fields, history = read_fields(path), options.history or path.with_name(f"{path.stem}_history.csv")
        if options.save:
            print(plot_overview(fields, read_history(history), options.save))
            return EXIT_DONE
        drawn = plot_fields(fields, (options.output or path.parent) / path.stem, options.times)
        print(*drawn or [f"{path} holds neither interfaces nor failures of plies."], sep="\n")
        if history not in histories and (options.history or history.exists()):
            histories.append(history)
    return _plot_histories(histories, options.output) if histories else EXIT_DONE


def _plot_histories(paths: Sequence[Path], output: Path | None) -> int:
    """Draw the responses over each other and the energies of each history."""
    histories = [read_history(path) for path in paths]
    folders = [output or path.parent for path in paths]
    print(plot_response(histories, folders[0] / f"{paths[0].stem}_response.png"))
    for history, path, folder in zip(histories, paths, folders, strict=True):
        print(plot_energies(history, folder / f"{path.stem}_energies.png"))
    return EXIT_DONE


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = CommandParser("implam-plot", description="Plot force, indentation, deflection and energies of histories, "
                           "several drawn over each other, and of NAME.h5 the delamination of each interface, the "
                           "energy release rate along its front and the failures of each ply over the whole plate, "
                           "with the history beside it.")
    parser.add_argument("results", nargs="+", type=Path, metavar="RESULT",
                        help="histories (.csv) and fields (.h5) written by implam")
    parser.add_argument("--output", type=Path, metavar="DIR", help="folder of the plots (default: beside each result)")
    parser.add_argument("--history", type=Path, metavar="CSV",
                        help="history that goes with NAME.h5 (default: NAME_history.csv beside it)")
    parser.add_argument("--times", nargs="+", type=float, metavar="TIME",
                        help="times at which the front is drawn (default: up to eight of those written)")
    parser.add_argument("--save", type=Path, metavar="FILE",
                        help="one picture of delamination, force and energies of NAME.h5, instead of all")
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
