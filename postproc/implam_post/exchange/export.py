"""Write a panel with the damage of a run as Nastran (`implam-to-nastran`) or Abaqus input (`implam-to-abaqus`)."""

import argparse
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

from implam_post.exchange.abaqus import abaqus_input, unwritten_stringers
from implam_post.exchange.nastran import nastran_deck
from implam_post.exchange.panel import Panel
from implam_post.exchange.results import read_panel
from implam_post.io.counts import counted
from implam_post.io.errors import EXIT_DONE, CommandParser, finite, run
from implam_post.io.files import printable, write_text


def summary(panel: Panel, notes: Sequence[str] = ()) -> Iterator[str]:
    """Return a summary of the panel as text; `notes` are on what this format does not have."""
    cells = len(panel.stacks)
    delaminated = sum(len(stacks) > 1 for stacks in panel.stacks.values())
    failed = sum(any(any(stack.failures) for stack in stacks) for stacks in panel.stacks.values())
    yield (f"{panel.name}: {counted(cells, 'cell')}, of which {delaminated} are delaminated and "
           f"{failed} have failed plies; {counted(len(panel.sections()), 'section')}, "
           f"{counted(len(panel.materials()), 'material')}")
    if panel.pressure is not None:
        yield f"uniform pressure on the struck face: {panel.pressure:g}"
    if panel.imperfection:
        yield f"initial deflection in the coordinates of the nodes, amplitude {panel.imperfection:g}"
    if any(panel.curvature):
        yield "curvature in the coordinates of the nodes, radii " + ", ".join(
            f"{1 / curvature:g}" if curvature else "0" for curvature in panel.curvature)
    if panel.temperature is not None:
        yield (f"change of temperature: {panel.temperature:g}" if panel.expands else
               "note: the change of temperature is not written, as no material expands.")
    if panel.stringers:
        yield counted(len(panel.stringers), "stringer")
    for sentence in (*panel.unwritten, *notes):
        yield f"note: {sentence}."


def _command(options: argparse.Namespace, suffix: str, lines: Callable[[Panel, argparse.Namespace], Iterable[str]],
             notes: Callable[[Panel], Sequence[str]] = lambda panel: ()) -> int:
    """Read, write and report."""
    panel = read_panel(options.source, options.time).with_pressure(options.pressure)
    output = options.output or options.source.with_name(f"{options.source.stem}_panel{suffix}")
    text = "\n".join(lines(panel, options)) + "\n"
    write_text(output, text)
    print(*summary(panel, notes(panel)), output, sep="\n")
    return EXIT_DONE


def _parser(name: str, what: str) -> CommandParser:
    """Return the parser that both commands share."""
    parser = CommandParser(name, description=f"Write a panel as {what}: with the ply failures and "
                           "delaminations of NAME.h5, or with the starters of a deck.")
    parser.add_argument("source", type=Path, metavar="RESULT.h5|DECK.nml", help="results of a run, or a deck")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE",
                        help="output file (default: in the folder of the source)")
    parser.add_argument("--time", type=finite, metavar="TIME", help="time of the results (default: the last)")
    parser.add_argument("--pressure", type=finite, metavar="VALUE", help="uniform pressure on the struck face, "
                        "positive towards the back (default: that of the deck)")
    return parser


def to_nastran(arguments: Sequence[str] | None = None) -> int:
    """Run implam-to-nastran."""
    parser = _parser("implam-to-nastran", "Nastran bulk data")
    parser.add_argument("--z0", action="store_true", help="offset stacks of delaminated cells by Z0 of their PCOMP, "
                        "for programs that do not accept ZOFFS with a PCOMP")
    return run(lambda options: _command(options, ".bdf", lambda panel, chosen: nastran_deck(
        panel, printable(chosen.source.name), chosen.z0)), parser, arguments)


def to_abaqus(arguments: Sequence[str] | None = None) -> int:
    """Run implam-to-abaqus."""
    return run(lambda options: _command(options, ".inp", lambda panel, chosen: abaqus_input(
        panel, printable(chosen.source.name)), unwritten_stringers),
               _parser("implam-to-abaqus", "Abaqus input, which CalculiX reads too"), arguments)
