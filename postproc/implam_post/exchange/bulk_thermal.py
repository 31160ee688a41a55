"""The change of temperature from bulk data: TREF of the laminate or its materials, and TEMPD."""

from collections.abc import Collection, Iterable
from typing import NamedTuple

from implam_post.exchange.bulk_cards import BulkCard
from implam_post.exchange.bulk_data import BulkData
from implam_post.exchange.bulk_shape import Shape
from implam_post.exchange.remarks import Remarks
from implam_post.laminate.sections import Ply

# Field number of TREF.
_TREF = {"PCOMP": 6, "PCOMPG": 6, "MAT1": 7, "MAT8": 11}
# Cards with temperatures of single elements.
_OF_ELEMENTS = ("TEMPP1", "TEMPP2", "TEMPP3", "TEMPRB")


class Thermal(NamedTuple):
    """Change of temperature from the stress-free state, and the temperature of that state; None if not in the file."""

    change: float | None
    reference: float | None


def read_thermal(bulk: BulkData, shape: Shape, plies: Iterable[Ply], remarks: Remarks) -> Thermal | None:
    """Return the temperatures; None if no ply has thermal expansion, or no temperature is given."""
    plies = list(plies)
    defaults = list(bulk.named("TEMPD"))
    cards = _cards_with_reference(bulk, shape.properties, {ply.material.name for ply in plies})
    if not any(any(ply.material.expansion) for ply in plies):
        for card in cards:
            remarks.ignored(card, {_TREF[card.name]: "TREF"})
        for card in defaults:
            remarks.add(card, "ignored: no material has thermal expansion")
        return None
    references = {bulk.real(card, _TREF[card.name]) or 0.0: card for card in cards}
    temperature = _temperature(bulk, defaults, shape.places, remarks)
    if bulk.case_control.selected("TEMPERATURE(INITIAL)") is not None:
        remarks.note("TEMPERATURE(INITIAL) of the case control is ignored: TREF is the stress-free temperature")
    if len(references) > 1 and temperature is not None:
        first, *others = references.values()
        raise bulk.error(others[0], f"its TREF differs from that of the {first.name} in line {first.line}: all plies "
                                    "must be stress-free at the same temperature.")
    reference = next(iter(references), 0.0)
    if temperature is not None:
        _note_blank_laminates(bulk, shape.properties, cards, remarks)
        return Thermal(temperature - reference, reference)
    for card in cards:
        if card.given(_TREF[card.name]):
            remarks.add(card, "TREF is written as a comment of the deck, as no TEMPD gives a temperature"
                        if len(references) == 1 else "TREF is ignored, as it differs")
    return Thermal(None, reference if len(references) == 1 and reference else None)


def _cards_with_reference(bulk: BulkData, properties: Collection[int], names: Collection[str]) -> list[BulkCard]:
    """Return the cards whose TREF applies: those of the laminate if they have it, else those of its materials."""
    laminates = [card for card in bulk.named("PCOMP", "PCOMPG") if bulk.integer(card, 1) in properties]
    if any(card.fields.field(_TREF[card.name]) is not None for card in laminates):
        return laminates
    return [card for card in bulk.named("MAT1", "MAT8") if f"{card.name}_{card.fields.field(1)}" in names]


def _note_blank_laminates(bulk: BulkData, properties: Collection[int], cards: Iterable[BulkCard], remarks: Remarks
                          ) -> None:
    """Add a remark where TREF of a laminate is blank and that of its materials applies; MSC Nastran uses 0 then."""
    if any(card.name in ("MAT1", "MAT8") and card.given(_TREF[card.name]) for card in cards):
        for card in bulk.named("PCOMP", "PCOMPG"):
            if bulk.integer(card, 1) in properties:
                remarks.add(card, "TREF is blank: that of the materials is used, where MSC Nastran uses 0")


def _temperature(bulk: BulkData, defaults: Iterable[BulkCard], grids: Iterable[int], remarks: Remarks) -> float | None:
    """Return the temperature of the panel in the set that the case control selects, or in the only set."""
    found = _defaults(bulk, defaults)
    single = _single(bulk)
    chosen = bulk.case_control.selected("TEMPERATURE(LOAD)")
    if chosen is None and len(found | single) == 1 and bulk.first_line == 1:
        chosen = next(iter(found | single))
    for number, (card, _) in found.items():
        if number != chosen:
            remarks.add(card, f"set {number} is ignored: it is not TEMPERATURE(LOAD) of the case control")
    if chosen is None:
        return None
    for card in bulk.named(*_OF_ELEMENTS):
        if bulk.integer(card, 1) == chosen:
            remarks.add(card, f"temperature set {chosen} is ignored: single grids or elements have other temperatures")
            return None
    at_grids = single.get(chosen, {})
    values = {at_grids.get(grid, found[chosen][1] if chosen in found else None) for grid in grids}
    if len(values) == 1 and None not in values:
        bulk.also_read.update(card for card in bulk.named("TEMP") if bulk.integer(card, 1) == chosen)
        return values.pop()
    remarks.note(f"temperature set {chosen} is ignored: "
                 + ("some grids of the panel have no temperature" if None in values else
                    "single grids or elements have other temperatures, where &thermal has one"))
    return None


def _defaults(bulk: BulkData, cards: Iterable[BulkCard]) -> dict[int, tuple[BulkCard, float | None]]:
    """Return card and temperature of the TEMPD of each set."""
    found: dict[int, tuple[BulkCard, float | None]] = {}
    for card in cards:
        for number in range(1, len(card.fields), 2):
            if card.fields.field(number) is not None:
                group, value = bulk.integer(card, number), bulk.real(card, number + 1)
                if found.setdefault(group, (card, value))[1] != value:
                    raise bulk.error(card, f"set {group} has another temperature in line {found[group][0].line}.")
    return found


def _single(bulk: BulkData) -> dict[int, dict[int, float | None]]:
    """Return the temperatures of single grids in the TEMP of each set."""
    found: dict[int, dict[int, float | None]] = {}
    for card in bulk.named("TEMP"):
        for number in range(2, len(card.fields), 2):
            if card.fields.field(number) is not None:
                found.setdefault(bulk.integer(card, 1), {})[bulk.integer(card, number)] = bulk.real(card, number + 1)
    return found
