"""Plots of histories and fields (`implam-plot HISTORY.csv ...`, `implam-plot NAME.h5`).

Modules that draw are imported after the command line has been read, as they take most of the start-up time.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from implam_post.io.errors import EXIT_DONE, CommandParser, FileError, ImplamError, finite, run
from implam_post.plot.style import FORMATS, PictureStyle, add_options, style_of

if TYPE_CHECKING:
    from implam_post.io.history import History


def _command(options: argparse.Namespace) -> int:
    """Draw the pictures and print their names."""
    import matplotlib

    style = style_of(options, options.results)
    with matplotlib.rc_context({"font.size": style.letters}):
        return _draw_all(options, style)


def _draw_all(options: argparse.Namespace, style: PictureStyle) -> int:
    """Draw the pictures of the command line."""
    from implam_post.io.fields import read_fields
    from implam_post.io.files import refuse_equal_names
    from implam_post.io.history import read_history
    from implam_post.plot.pictures import plot_fields, plot_overview

    results = [path for path in options.results if path.suffix == ".h5"]
    paths = [path for path in options.results if path.suffix != ".h5"]
    for path in options.results:
        if path.suffix not in (".h5", ".csv") or path.name.endswith("_restart.h5"):
            raise FileError(f"{path} is not the fields NAME.h5 or the history NAME_history.csv of a run.")
    if options.save and (len(results), len(paths)) != (1, 0):
        raise ImplamError("--save needs exactly one NAME.h5.")
    if options.save:
        history = options.history or _beside(results[0])
        print(plot_overview(read_fields(results[0]), read_history(history), options.save, style))
        return EXIT_DONE
    for path in results:
        history = options.history or _beside(path)
        if history not in paths and (options.history or history.exists()):
            paths.append(history)
    for written in (results, paths):
        refuse_equal_names(written, options.output)
    # All files are read before the first picture is drawn, so that a damaged file does not leave some pictures only.
    curves = _read_curves(paths, options)
    for path, fields in [(path, read_fields(path)) for path in results]:
        beside = options.history or _beside(path)
        history = next((one for one, file in zip(curves.histories, paths, strict=True) if file == beside), None)
        drawn = plot_fields(fields, (options.output or path.parent) / path.stem, options.times, style, history,
                            options.sections)
        print(*drawn or [f"{path} has no interfaces and no ply failures."], sep="\n")
    return _plot_histories(curves, options, style) if paths else EXIT_DONE


def _beside(path: Path) -> Path:
    """Return the path of the history that belongs to the fields NAME.h5."""
    return path.with_name(f"{path.stem}_history.csv")


@dataclass
class _Curves:
    """Histories with their paths, summaries of compressions, a measured curve, strength of the undamaged plate."""

    paths: Sequence[Path]
    histories: list[History]
    summaries: list[Mapping[str, object]]
    measured: History | None
    undamaged: float | None


def _read_curves(paths: Sequence[Path], options: argparse.Namespace) -> _Curves:
    """Read the data of the curves."""
    from implam_post.io.compression import strength_of
    from implam_post.io.history import read_history
    from implam_post.io.measured import check_units
    from implam_post.io.run import HISTORY, SUMMARY, read_summary
    from implam_post.plot.compression import is_compressed
    from implam_post.plot.pictures import RESPONSES

    measured = read_history(options.measured) if options.measured else None
    if measured is not None and not set(measured.columns) & set(RESPONSES):
        raise FileError(f"{options.measured} has none of the columns {', '.join(RESPONSES)} in addition to time.")
    histories = [read_history(path) for path in paths]
    if measured is not None:
        for history in histories:
            check_units(history, measured)
    beside = [path.with_name(path.name.removesuffix(HISTORY) + SUMMARY) for path in paths]
    summaries = [read_summary(path) if is_compressed(history) and path.exists() else {}
                 for history, path in zip(histories, beside, strict=True)]
    undamaged = strength_of(options.undamaged) if options.undamaged else None
    return _Curves(paths, histories, summaries, measured, undamaged)


def _plot_histories(curves: _Curves, options: argparse.Namespace, style: PictureStyle) -> int:
    """Draw the responses in one picture and the energies of each history."""
    from implam_post.plot.pictures import plot_compression, plot_energies, plot_response

    paths, histories = curves.paths, curves.histories
    folders = [options.output or path.parent for path in paths]
    response = folders[0] / f"{paths[0].stem}_response.{style.kind}"
    drawn = plot_response(histories, response, style, curves.measured)
    if drawn is not None:
        print(drawn)
    compressed = plot_compression(histories, folders[0] / f"{paths[0].stem}_compression.{style.kind}", style,
                                  curves.summaries, curves.undamaged)
    if compressed is not None:
        print(compressed)
    for history, path, folder in zip(histories, paths, folders, strict=True):
        print(plot_energies(history, folder / f"{path.stem}_energies.{style.kind}", style))
    return EXIT_DONE


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = CommandParser("implam-plot", description="Plot force, indentation, deflection and energies of histories "
                           "(several in one picture), stress and gauges of compressions, and from NAME.h5 the "
                           "delamination of each interface and the projected one, the energy release "
                           "rate along fronts, the failures of each ply, all over the full plate, and sections "
                           "through the plate, with the history of the run.")
    parser.add_argument("results", nargs="+", type=Path, metavar="RESULT",
                        help="histories (.csv) and fields (.h5) written by implam")
    parser.add_argument("--output", type=Path, metavar="DIR", help="folder of the plots (default: that of each result)")
    parser.add_argument("--history", type=Path, metavar="CSV",
                        help="history of the run of NAME.h5 (default: NAME_history.csv in its folder)")
    parser.add_argument("--times", nargs="+", type=finite, metavar="TIME",
                        help="times at which fronts are drawn (default: up to eight of those written)")
    parser.add_argument("--sections", nargs="+", type=finite, metavar="ANGLE", help="angles from x, in degrees, of the "
                        "sections through the struck point (default: along and across the fibres of ply 1)")
    parser.add_argument("--save", type=Path, metavar="FILE",
                        help="write only one picture, with delamination, force and energies of NAME.h5")
    parser.add_argument("--measured", type=Path, metavar="CSV", help="measured curve, drawn as dots: columns time and "
                        "force, indentation or deflection, in the units of the results")
    parser.add_argument("--undamaged", type=Path, metavar="SUMMARY", help="NAME_summary.json of the compression of "
                        "the undamaged plate: its strength and the retained fraction are shown")
    parser.add_argument("--projected", choices=("depth", "time"), default="depth", help="colour of NAME_projected: the "
                        "delaminated interface nearest to the struck face, or time of delamination (default: depth)")
    parser.add_argument("--format", choices=FORMATS, default="png", help="file format (default: png)")
    add_options(parser)
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
