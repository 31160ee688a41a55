"""Plots of histories and fields (`implam-plot HISTORY.csv ...`, `implam-plot NAME.h5`)."""

import argparse
from collections.abc import Sequence
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from implam_post.curves import AXES, in_contact
from implam_post.errors import EXIT_DONE, CommandParser, FileError, ImplamError, run
from implam_post.fields import Fields, read_fields
from implam_post.front import front_figure
from implam_post.history import ENERGY_NAMES, UNACCOUNTED, History, read_history
from implam_post.look import FORMATS, STYLES, Look, add_options, look_of, settle
from implam_post.plan import (
    delamination_figure,
    draw_cracks,
    draw_delamination,
    failures_figure,
    projected_figure,
)
from implam_post.plan_frame import caption, reach_of
from implam_post.quantities import growth_rows

_RESPONSES = {"force": ("contact force", "force"), "indentation": ("indentation", "length"),
              "deflection": ("deflection of struck point", "length")}
_PLAIN = Look()


def plot_forces(histories: Sequence[History], path: Path) -> Path:
    """Draw the force of several histories over each other."""
    figure = Figure(figsize=(8, 4.5), layout="constrained")
    _draw(figure.subplots(), histories, "force")
    return _save(figure, path)


def plot_response(histories: Sequence[History], path: Path, look: Look = _PLAIN,
                  measured: History | None = None) -> Path:
    """Draw force, indentation, deflection, all with what was measured, and force against displacement."""
    figure = Figure(figsize=(8, 13), layout="constrained")
    *panels, last = figure.subplots(len(_RESPONSES) + 1)
    for axes, column in zip(panels, _RESPONSES, strict=True):
        axes.sharex(panels[0])
        _draw(axes, histories, column, look, measured)
    _draw_loop(last, histories, look)
    return _save(figure, path, look)


def plot_energies(history: History, path: Path, look: Look = _PLAIN) -> Path:
    """Draw the energies of a history stacked, those below zero downwards, and the total at the start."""
    figure = Figure(figsize=(8, 5), layout="constrained")
    _stack(figure.subplots(), history, look)
    return _save(figure, path, look)


def plot_overview(fields: Fields, history: History, path: Path, look: Look = _PLAIN) -> Path:
    """Draw each interface in plan, with the cracks beside it, the force and the ledger in one picture."""
    interfaces = fields.snapshots[-1].mesh.interfaces
    if not interfaces:
        raise FileError(f"{fields.name} has no interface that may come apart.")
    figure = Figure(figsize=(11, 2.9 * max(len(interfaces), 2)), layout="constrained")
    left, right = figure.subfigures(1, 2)
    last = len(fields.snapshots) - 1
    reach = np.max([reach_of(fields.delaminated(last, ply), fields) for ply in interfaces], axis=0)
    for axes, below_ply in zip(left.subplots(len(interfaces), squeeze=False)[:, 0], interfaces, strict=True):
        draw_delamination(axes, fields, below_ply, look, reach)
        if fields.snapshots[-1].failures:
            draw_cracks(axes, fields, below_ply)
    force, ledger = right.subplots(2)
    _draw(force, [history], "force", look)
    _stack(ledger, history, look)
    figure.supxlabel(caption(fields, look), fontsize="small")
    return _save(figure, path, look)


def plot_fields(fields: Fields, base: Path, times: Sequence[float] | None = None, look: Look = _PLAIN) -> list[Path]:
    """Draw what the fields hold of interfaces, of their fronts (at some times) and of plies, a picture each."""
    figures = {}
    if fields.snapshots[-1].mesh.interfaces:
        figures["delamination"] = delamination_figure(fields, look)
        figures["projected"] = projected_figure(fields, look)
    if any(np.any(snapshot.release_ratio > 0) for snapshot in fields.snapshots):
        figures["front"] = front_figure(fields, times, look)
    if fields.snapshots[-1].failures:
        figures["matrix"] = failures_figure(fields, ("matrix cracking", "matrix crushing"), look)
        figures["fibres"] = failures_figure(fields, ("fibre failure",), look)
    return [_save(figure, base.with_name(f"{base.name}_{name}.{look.kind}"), look) for name, figure in figures.items()]


def _stack(axes: Axes, history: History, look: Look) -> None:
    """Draw the ledger."""
    ledger = {column: history[column] for column in ENERGY_NAMES if column in history.columns}
    shown = {column: values for column, values in ledger.items() if np.any(values)}
    colours = [f"C{list(ENERGY_NAMES).index(column)}" for column in shown]
    start = sum(values[0] for values in ledger.values())
    time = look.axis("time", "time", history.time)
    energy = look.axis("energy", "energy", [start, *(np.max(np.abs(values)) for values in shown.values())])
    if shown:
        labels = [ENERGY_NAMES[column] for column in shown]
        for parts, names in ((np.maximum, labels), (np.minimum, ())):
            axes.stackplot(time.factor * history.time, [energy.factor * parts(values, 0) for values in shown.values()],
                           labels=names, colors=colours, alpha=0.8)
    axes.axhline(energy.factor * start, color="black", linestyle="--", linewidth=1, label="total at the start")
    axes.plot(time.factor * history.time, energy.factor * history["energy_error"], color="black", linewidth=1,
              label=UNACCOUNTED)
    axes.set(xlabel=time.label, ylabel=energy.label, title=Path(history.name).stem.removesuffix("_history"))
    axes.locator_params(axis="x", nbins=6)
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5))


def response_of(history: History, column: str) -> np.ndarray:
    """Return a column as it is drawn: without the indentation where there is a gap."""
    if column == "indentation" and "force" in history.columns:
        return np.where(history["force"] > 0, history[column], np.nan)
    return history[column]


def _draw(axes: Axes, histories: Sequence[History], column: str, look: Look = _PLAIN,
          measured: History | None = None) -> None:
    """Draw a column of several histories, each in a style of its own, and what was measured as dots."""
    words, dimension = _RESPONSES[column]
    drawn = [*histories, *([measured] if measured is not None and column in measured.columns else [])]
    time = look.axis("time", "time", np.concatenate([history.time for history in drawn]))
    value = look.axis(words, dimension, np.concatenate([response_of(history, column) for history in drawn]))
    names = _names([history.name for history in histories])
    for position, history in enumerate(histories):
        style = STYLES[position % len(STYLES)]
        axes.plot(time.factor * history.time, value.factor * response_of(history, column), label=names[position],
                  **style)
        grown = growth_rows(history)
        if column == "force" and len(grown):
            axes.plot(time.factor * history.time[grown], value.factor * history[column][grown], "o", markersize=3,
                      color=style["color"], label="delamination grows" + (f" ({names[position]})" if position else ""))
    if drawn[-1] is measured:
        axes.plot(time.factor * measured.time, value.factor * measured[column], "k.", markersize=4,
                  label=f"measured ({Path(measured.name).stem})")
    axes.set(xlabel=time.label, ylabel=value.label)
    axes.locator_params(axis="x", nbins=6)
    axes.grid(alpha=0.3)
    axes.legend()


def _draw_loop(axes: Axes, histories: Sequence[History], look: Look) -> None:
    """Draw the force against the displacement of the impactor, or of the struck point where no history has that."""
    along = "impactor_displacement" if all(
        np.any(history.columns.get("impactor_displacement", 0)) for history in histories) else "deflection"
    shown = [in_contact(history) for history in histories]
    across, force = (look.axis(*AXES[column], np.concatenate([history[column] for history in shown]))
                     for column in (along, "force"))
    for position, (history, name) in enumerate(zip(shown, _names([one.name for one in histories]), strict=True)):
        axes.plot(across.factor * history[along], force.factor * history["force"], label=name,
                  **STYLES[position % len(STYLES)])
    axes.set(xlabel=across.label, ylabel=force.label)
    axes.grid(alpha=0.3)
    axes.legend()


def _names(paths: Sequence[str]) -> list[str]:
    """Return short names of runs: that of the case, with its folder where two have the same."""
    stems = [Path(path).stem.removesuffix("_history") for path in paths]
    return [stem if stems.count(stem) == 1 else f"{Path(path).parent.name}/{stem}"
            for stem, path in zip(stems, paths, strict=True)]


def _save(figure: Figure, path: Path, look: Look = _PLAIN) -> Path:
    """Write the figure, making the folder if it isn't there, and return the path."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        settle(figure)
        figure.savefig(path, dpi=look.dots_per_inch)
    except (OSError, ValueError) as error:
        raise FileError(f"{path} cannot be written ({error}).") from None
    return path


def _command(options: argparse.Namespace) -> int:
    """Draw and say what was drawn."""
    look = look_of(options, options.results)
    with matplotlib.rc_context({"font.size": look.letters}):
        return _draw_all(options, look)


def _draw_all(options: argparse.Namespace, look: Look) -> int:
    """Draw what the command line asks for."""
    results = [path for path in options.results if path.suffix == ".h5"]
    histories = [path for path in options.results if path.suffix != ".h5"]
    for path in options.results:
        if path.suffix not in (".h5", ".csv") or path.name.endswith("_restart.h5"):
            raise FileError(f"{path} is neither the fields NAME.h5 nor the history NAME_history.csv of a run.")
    if options.save and (len(results), len(histories)) != (1, 0):
        raise ImplamError("--save goes with one NAME.h5.")
    for path in results:
        fields, history = read_fields(path), options.history or path.with_name(f"{path.stem}_history.csv")
        if options.save:
            print(plot_overview(fields, read_history(history), options.save, look))
            return EXIT_DONE
        drawn = plot_fields(fields, (options.output or path.parent) / path.stem, options.times, look)
        print(*drawn or [f"{path} holds neither interfaces nor failures of plies."], sep="\n")
        if history not in histories and (options.history or history.exists()):
            histories.append(history)
    return _plot_histories(histories, options, look) if histories else EXIT_DONE


def _plot_histories(paths: Sequence[Path], options: argparse.Namespace, look: Look) -> int:
    """Draw the responses over each other and the energies of each history."""
    histories = [read_history(path) for path in paths]
    folders = [options.output or path.parent for path in paths]
    measured = read_history(options.measured) if options.measured else None
    if measured is not None and not set(measured.columns) & set(_RESPONSES):
        raise FileError(f"{options.measured} has none of the columns {', '.join(_RESPONSES)} beside time.")
    response = folders[0] / f"{paths[0].stem}_response.{look.kind}"
    print(plot_response(histories, response, look, measured))
    for history, path, folder in zip(histories, paths, folders, strict=True):
        print(plot_energies(history, folder / f"{path.stem}_energies.{look.kind}", look))
    return EXIT_DONE


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = CommandParser("implam-plot", description="Plot force, indentation, deflection and energies of histories, "
                           "several drawn over each other, and of NAME.h5 the delamination of each interface and all "
                           "seen through the plate, the energy release rate along its front and the failures of each "
                           "ply over the whole plate, with the history beside it.")
    parser.add_argument("results", nargs="+", type=Path, metavar="RESULT",
                        help="histories (.csv) and fields (.h5) written by implam")
    parser.add_argument("--output", type=Path, metavar="DIR", help="folder of the plots (default: beside each result)")
    parser.add_argument("--history", type=Path, metavar="CSV",
                        help="history that goes with NAME.h5 (default: NAME_history.csv beside it)")
    parser.add_argument("--times", nargs="+", type=float, metavar="TIME",
                        help="times at which the front is drawn (default: up to eight of those written)")
    parser.add_argument("--save", type=Path, metavar="FILE",
                        help="one picture of delamination, force and energies of NAME.h5, instead of all")
    parser.add_argument("--measured", type=Path, metavar="CSV", help="measured curve to draw as dots: columns time and "
                        "force, indentation or deflection, in the units of the results")
    parser.add_argument("--projected", choices=("depth", "time"), default="depth", help="colour of NAME_projected: the "
                        "first interface apart, or when the first one came apart (default: depth)")
    parser.add_argument("--format", choices=FORMATS, default="png", help="kind of file (default: png)")
    add_options(parser)
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
