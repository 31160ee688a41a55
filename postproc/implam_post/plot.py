"""Plots of histories (`implam-plot HISTORY.csv ...`), in the deck's own consistent units."""

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from implam_post.errors import EXIT_DONE, CommandParser, FileError, run
from implam_post.history import ENERGIES, History, read_history

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
    axes = figure.subplots()
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
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    return _save(figure, path)


def _draw(axes: Axes, histories: Sequence[History], column: str) -> None:
    """Draw a column of several histories."""
    for position, history in enumerate(histories):
        axes.plot(history.time, history[column], label=Path(history.name).stem, linestyle="--" if position else "-")
    axes.set(xlabel="time (the deck's units, as all)", ylabel=_RESPONSES[column])
    axes.grid(alpha=0.3)
    axes.legend()


def _save(figure: Figure, path: Path) -> Path:
    """Write the figure, making the folder if it isn't there, and return the path."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, dpi=150)
    except OSError as error:
        raise FileError(f"{path} cannot be written ({error}).") from None
    return path


def _command(options: argparse.Namespace) -> int:
    """Draw and say what was drawn."""
    histories = [read_history(path) for path in options.histories]
    folders = [options.output or path.parent for path in options.histories]
    print(plot_response(histories, folders[0] / f"{options.histories[0].stem}_response.png"))
    for history, path, folder in zip(histories, options.histories, folders, strict=True):
        print(plot_energies(history, folder / f"{path.stem}_energies.png"))
    return EXIT_DONE


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = CommandParser("implam-plot", description="Plot force, indentation, deflection and energies of histories; "
                           "several histories are drawn over each other.")
    parser.add_argument("histories", nargs="+", type=Path, metavar="HISTORY.csv", help="history written by implam")
    parser.add_argument("--output", type=Path, metavar="DIR", help="folder of the plots (default: beside each history)")
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
