"""Write a panel with the damage of a run for Nastran (`implam-to-nastran`) or Abaqus (`implam-to-abaqus`)."""

import argparse
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

from implam_post.exchange.abaqus import abaqus_input
from implam_post.exchange.nastran import nastran_deck
from implam_post.exchange.panel import Panel
from implam_post.exchange.results import read_panel
from implam_post.io.counts import counted
from implam_post.io.errors import EXIT_DONE, CommandParser, FileError, finite, reason, run
from implam_post.io.files import printable


def summary(panel: Panel) -> Iterator[str]:
    """Return the contents of the panel in words."""
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
    for group in panel.unwritten:
        yield f"note: &{group} is not written: add what it holds or loads."


def _command(options: argparse.Namespace, suffix: str, lines: Callable[[Panel, argparse.Namespace], Iterable[str]]
             ) -> int:
    """Read, write and report."""
    panel = read_panel(options.source, options.time).with_pressure(options.pressure)
    output = options.output or options.source.with_name(f"{options.source.stem}_panel{suffix}")
    text = "\n".join(lines(panel, options)) + "\n"
    try:
        output.write_text(text, encoding="utf-8")
    except OSError as error:
        raise FileError(f"{output} cannot be written ({reason(error)}).") from None
    print(*summary(panel), output, sep="\n")
    return EXIT_DONE


def _parser(name: str, what: str) -> CommandParser:
    """Return the parser that both commands share."""
    parser = CommandParser(name, description=f"Write a panel as {what}: with the failures of its plies and its "
                           "delaminations from NAME.h5, or as a deck gives it.")
    parser.add_argument("source", type=Path, metavar="RESULT.h5|DECK.nml", help="results of a run, or a deck")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE",
                        help="the file written (default: beside the source)")
    parser.add_argument("--time", type=finite, metavar="TIME", help="time of the results (default: the last)")
    parser.add_argument("--pressure", type=finite, metavar="VALUE", help="uniform pressure on the struck face, "
                        "positive towards the back (default: that of the deck)")
    return parser


def to_nastran(arguments: Sequence[str] | None = None) -> int:
    """Run implam-to-nastran."""
    parser = _parser("implam-to-nastran", "Nastran's bulk data")
    parser.add_argument("--z0", action="store_true", help="place stacks of delaminated cells by Z0 of their PCOMP, for "
                        "programs that refuse ZOFFS beside a PCOMP")
    return run(lambda options: _command(options, ".bdf", lambda panel, chosen: nastran_deck(
        panel, printable(chosen.source.name), chosen.z0)), parser, arguments)


def to_abaqus(arguments: Sequence[str] | None = None) -> int:
    """Run implam-to-abaqus."""
    return run(lambda options: _command(options, ".inp", lambda panel, chosen: abaqus_input(
        panel, printable(chosen.source.name))),
               _parser("implam-to-abaqus", "Abaqus' input, which CalculiX reads too"), arguments)
