"""The change of temperature from bulk data: TREF of the laminate or its materials, and TEMPD."""

from collections.abc import Collection, Iterable
from typing import NamedTuple

from implam_post.exchange.bulk_cards import BulkCard
from implam_post.exchange.bulk_data import BulkData
from implam_post.exchange.remarks import Remarks
from implam_post.laminate.sections import Ply

# Field number of TREF.
_TREF = {"PCOMP": 6, "PCOMPG": 6, "MAT1": 7, "MAT8": 11}
# Cards that give temperatures of single grids or elements.
_SINGLE = ("TEMP", "TEMPP1", "TEMPRB", "TEMPF", "TEMPAX")


class Thermal(NamedTuple):
    """Change of temperature from the stress-free state, and the temperature of that state; None if not in the file."""

    change: float | None
    reference: float | None


def read_thermal(bulk: BulkData, properties: Collection[int], plies: Iterable[Ply], remarks: Remarks) -> Thermal | None:
    """Return the temperatures; None if no ply has thermal expansion, or no temperature is given."""
    plies = list(plies)
    defaults = list(bulk.named("TEMPD"))
    cards = _cards_with_reference(bulk, properties, {ply.material.name for ply in plies})
    if not any(any(ply.material.expansion) for ply in plies):
        for card in cards:
            remarks.ignored(card, {_TREF[card.name]: "TREF"})
        for card in defaults:
            remarks.add(card, "ignored: no material has thermal expansion")
        return None
    references = {bulk.real(card, _TREF[card.name]) or 0.0: card for card in cards}
    temperature = _temperature(bulk, defaults, remarks)
    if len(references) > 1 and temperature is not None:
        first, *others = references.values()
        raise bulk.error(others[0], f"its TREF differs from that of the {first.name} in line {first.line}: all plies "
                                    "must be stress-free at the same temperature.")
    reference = next(iter(references), 0.0)
    if temperature is not None:
        _note_blank_laminates(bulk, properties, cards, remarks)
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


def _temperature(bulk: BulkData, cards: Iterable[BulkCard], remarks: Remarks) -> float | None:
    """Return the temperature of the panel: that of the set that the case control selects, or of the only set."""
    found = {}
    for card in cards:
        for number in range(1, len(card.fields), 2):
            if card.fields.field(number) is not None:
                group, value = bulk.integer(card, number), bulk.real(card, number + 1)
                if found.setdefault(group, (card, value))[1] != value:
                    raise bulk.error(card, f"set {group} has another temperature in line {found[group][0].line}.")
    chosen = bulk.temperature_set
    if chosen is None and len(found) == 1 and bulk.first_line == 1:
        chosen = next(iter(found))
    for number, (card, _) in found.items():
        if number != chosen:
            remarks.add(card, f"set {number} is ignored: it is not TEMPERATURE(LOAD) of the case control")
    if chosen not in found:
        return None
    card, temperature = found[chosen]
    if any(bulk.integer(single, 1) == chosen for single in bulk.named(*_SINGLE)):
        remarks.add(card, "ignored: single grids or elements have other temperatures")
        return None
    return temperature
