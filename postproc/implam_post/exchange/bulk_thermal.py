"""The change of temperature out of bulk data: TREF of the laminate or its materials, and TEMPD."""

from collections.abc import Collection, Iterable
from typing import NamedTuple

from implam_post.exchange.bulk_cards import BulkCard
from implam_post.exchange.bulk_data import BulkData
from implam_post.exchange.remarks import Remarks
from implam_post.laminate.sections import Ply

# Number of the field TREF.
_TREF = {"PCOMP": 6, "PCOMPG": 6, "MAT1": 7, "MAT8": 11}
# Cards that give temperatures of single grids or elements.
_SINGLE = ("TEMP", "TEMPP1", "TEMPRB", "TEMPF", "TEMPAX")


class Thermal(NamedTuple):
    """Change of temperature since the plies were free of stress, and their reference; None: the file has none."""

    change: float | None
    reference: float | None


def read_thermal(bulk: BulkData, properties: Collection[int], plies: Iterable[Ply], remarks: Remarks) -> Thermal | None:
    """Return the temperatures; None if no ply expands, or none is given."""
    plies = list(plies)
    defaults = list(bulk.named("TEMPD"))
    cards = _cards_with_reference(bulk, properties, {ply.material.name for ply in plies})
    if not any(any(ply.material.expansion) for ply in plies):
        for card in cards:
            remarks.untaken(card, {_TREF[card.name]: "TREF"})
        for card in defaults:
            remarks.add(card, "not taken: no material expands")
        return None
    references = {bulk.real(card, _TREF[card.name]) or 0.0: card for card in cards}
    temperature = _temperature(bulk, defaults, remarks)
    if len(references) > 1 and temperature is not None:
        first, *others = references.values()
        raise bulk.error(others[0], f"its TREF is not that of the {first.name} in line {first.line}: all plies are "
                                    "free of stress at one temperature.")
    reference = next(iter(references), 0.0)
    if temperature is not None:
        _note_blank_laminates(bulk, properties, cards, remarks)
        return Thermal(temperature - reference, reference)
    for card in cards:
        if card.given(_TREF[card.name]):
            remarks.add(card, "TREF stands in a comment of the deck, as there is no temperature by TEMPD"
                        if len(references) == 1 else "TREF is not taken, as it differs")
    return Thermal(None, reference if len(references) == 1 and reference else None)


def _cards_with_reference(bulk: BulkData, properties: Collection[int], names: Collection[str]) -> list[BulkCard]:
    """Return the cards whose TREF counts: those of the laminate if they give it, else those of its materials."""
    laminates = [card for card in bulk.named("PCOMP", "PCOMPG") if bulk.integer(card, 1) in properties]
    if any(card.fields.field(_TREF[card.name]) is not None for card in laminates):
        return laminates
    return [card for card in bulk.named("MAT1", "MAT8") if f"{card.name}_{card.fields.field(1)}" in names]


def _note_blank_laminates(bulk: BulkData, properties: Collection[int], cards: Iterable[BulkCard], remarks: Remarks
                          ) -> None:
    """Say where the TREF of materials counts in place of a laminate's blank one: MSC Nastran takes 0 then."""
    if any(card.name in ("MAT1", "MAT8") and card.given(_TREF[card.name]) for card in cards):
        for card in bulk.named("PCOMP", "PCOMPG"):
            if bulk.integer(card, 1) in properties:
                remarks.add(card, "TREF is blank: that of the materials is taken, for which MSC Nastran takes 0")


def _temperature(bulk: BulkData, cards: Iterable[BulkCard], remarks: Remarks) -> float | None:
    """Return the temperature of the panel: that of the set which the case control takes, or of the only one."""
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
            remarks.add(card, f"set {number} is not taken: it is not TEMPERATURE(LOAD) of the case control")
    if chosen not in found:
        return None
    card, temperature = found[chosen]
    if any(bulk.integer(single, 1) == chosen for single in bulk.named(*_SINGLE)):
        remarks.add(card, "not taken: single grids or elements have other temperatures")
        return None
    return temperature
