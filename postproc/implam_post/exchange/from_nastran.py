"""Convert the bulk data of a rectangular panel to a deck (`implam-from-nastran FILE.bdf`)."""

import argparse
import re
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from implam_post.exchange.bulk_cards import KNOWN
from implam_post.exchange.bulk_data import BulkData, ranges, read_bulk_data
from implam_post.exchange.bulk_laminate import read_laminates
from implam_post.exchange.bulk_shape import material_angles, read_grids, read_shape, read_systems
from implam_post.exchange.bulk_stringers import read_stringers
from implam_post.exchange.bulk_supports import read_supports
from implam_post.exchange.bulk_thermal import read_thermal
from implam_post.exchange.bulk_zones import read_zones
from implam_post.exchange.deck_text import Impact, deck_text
from implam_post.exchange.remarks import Remarks
from implam_post.io.errors import EXIT_DONE, CommandParser, FileError, ImplamError, positive, run
from implam_post.io.files import printable, write_text
from implam_post.laminate.sections import Ply


def deck_of(bulk: BulkData, name: str, impact: Impact, struck_last: bool = False, supports: int | None = None,
            shear_23: float | None = None) -> tuple[str, Remarks]:
    """Return the deck of a panel and remarks on its cards."""
    for card in bulk.named("INCLUDE"):
        raise bulk.error(card, "it is not supported: put all bulk data into one file.")
    remarks = Remarks()
    systems, grids = read_systems(bulk), read_grids(bulk)
    shape = read_shape(bulk, systems, grids, struck_last, remarks)
    laminates = read_laminates(bulk, shape.properties, remarks, shear_23)
    # Isotropic plies have no material axis, so the first corner of their elements does not matter.
    isotropic = all(ply.material.isotropic for laminate in laminates.values() for ply in laminate.plies)
    angles = dict.fromkeys(laminates, 0.0) if isotropic else material_angles(bulk, systems, shape)
    plies = {number: _turned(laminate.plies, angles[number], shape.turn) for number, laminate in laminates.items()}
    zones, middle = read_zones(bulk, shape, laminates, plies, remarks)
    thermal = read_thermal(bulk, shape, zones.plies, remarks)
    stringers = read_stringers(bulk, systems, grids, shape, zones, middle, remarks)
    held = read_supports(bulk, systems, grids, shape, supports, remarks)
    return deck_text(name, printable(bulk.path.name), shape, held, zones, stringers, impact, thermal,
                     remarks.for_deck), remarks


def _turned(plies: list[Ply], angle: float, turn: int) -> list[Ply]:
    """Return the plies from the struck face on, with fibre angles from x of the panel; `angle` is that of the material
    axis, and `turn` is -1 if the last ply is at the struck face.
    """
    if turn > 0 and angle == 0:
        return plies
    turned = [replace(ply, angle=_within(angle + turn * ply.angle)) for ply in plies]
    return turned[::turn]


def _within(angle: float) -> float:
    """Return a fibre angle in (-90, 90] degrees."""
    return float(f"{90 - (90 - angle) % 180:.10g}")


def report(bulk: BulkData, remarks: Remarks) -> Iterator[str]:
    """Return the cards that were read, remarks on their fields, and the cards that were ignored, with line numbers."""
    lines = [card.line for card in bulk.cards]
    if bulk.first_line > 1:
        yield f"lines 1-{bulk.first_line - 1}: executive and case control; SPC, TEMP and WTMASS are read"
    yield "read:"
    for name in (*KNOWN, *sorted({card.name for card in bulk.also_read})):
        if there := [card.line for card in bulk.named(name) if name in KNOWN or card in bulk.also_read]:
            yield f"  {name:<8} {len(there)}, {ranges(there, lines)}"
    mass_cards = bulk.mass_cards()
    if mass_cards:
        yield f"  WTMASS   {bulk.mass_factor:g}, {ranges((card.line for card in mass_cards), lines)}: times RHO"
    elif bulk.mass_factor != 1:
        yield f"  WTMASS   {bulk.mass_factor:g}, in the case control: times RHO"
    texts = remarks.texts(bulk)
    yield from ["read in part or with changes:", *(f"  {text}" for text in texts)] if texts else []
    taken = {*mass_cards, *bulk.also_read}
    left = [card for card in bulk.cards if card.name not in KNOWN and card not in taken]
    others = list(dict.fromkeys(card.name for card in left))
    yield "ignored:" if others else "ignored: none"
    for name in others:
        there = [card.line for card in left if card.name == name]
        yield f"  {name:<8} {len(there)}, {ranges(there, lines)}"


def _command(options: argparse.Namespace) -> int:
    """Read, write and report."""
    impact = Impact(options.mass, options.velocity, options.radius, options.end, options.step)
    if len({value is None for value in impact[:3]}) > 1:
        raise ImplamError("--mass, --velocity and --radius must be given together.")
    if (options.end is None) != (options.step is None):
        raise ImplamError("--end and --step must be given together.")
    output = options.output or options.bulk.with_suffix(".nml")
    if options.output is None and output.exists():
        raise FileError(f"{output} already exists: give another deck by -o, or this one to replace it.")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # messages of pyNastran besides the error that it raises
        bulk = read_bulk_data(options.bulk, options.subcase)
        text, remarks = deck_of(bulk, re.sub(r"[^\w.-]", "_", output.stem, flags=re.ASCII), impact,
                                options.struck == "last", options.spc, options.g2z)
    write_text(output, text)
    print(*report(bulk, remarks), f"deck: {output}", sep="\n")
    return EXIT_DONE


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = CommandParser("implam-from-nastran", description="Convert Nastran bulk data of a rectangular composite "
                           "panel to a deck, and report which cards were read and which were ignored.")
    parser.add_argument("bulk", type=Path, metavar="FILE.bdf", help="bulk data, with or without case control")
    parser.add_argument("-o", "--output", type=Path, metavar="DECK.nml", help="the deck (default: FILE.nml)")
    parser.add_argument("--struck", choices=("first", "last"), default="first",
                        help="ply at the struck face, in the order of the property (default: first)")
    parser.add_argument("--subcase", type=int, metavar="NUMBER", help="subcase whose supports and temperature are used "
                        "(default: any, if they do not differ)")
    parser.add_argument("--spc", type=int, metavar="SET", help="support set (default: that of the case control)")
    parser.add_argument("--g2z", type=positive, metavar="NUMBER",
                        help="transverse shear modulus of the plies whose G2Z is blank")
    for key, words in (("mass", "mass of the impactor"), ("velocity", "velocity of the impactor"),
                       ("radius", "radius of the impactor"), ("end", "end of the run"), ("step", "time step")):
        parser.add_argument(f"--{key}", type=positive, metavar="NUMBER", help=f"{words}, in the file's units")
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
