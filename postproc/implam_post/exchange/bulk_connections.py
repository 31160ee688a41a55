"""Elements, rigid bodies and equations of bulk data that connect the panel to something else and are not converted."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from implam_post.exchange.bulk_cards import KNOWN, READING_ERRORS, BulkCard
from implam_post.exchange.bulk_data import BulkData
from implam_post.exchange.remarks import Remarks
from implam_post.io.errors import DeckError

# Where pyNastran keeps what a card adds to a model.
_KINDS = ("elements", "rigid_elements", "mpcs", "masses")
# Grids of cards that pyNastran does not read, by field.
_FIELDS = {"RJOINT": (2, 3), "RTRPLT": (2, 3, 4), "RTRPLT1": (2, 3, 4), "SUPORT": (1, 3, 5, 7), "SUPORT1": (2, 4, 6),
           "DMIG": (2,)}
# Cards of which every integer after the number may be a grid.
_LISTS = ("CWELD", "CSEAM", "CINTC", "GENEL", "RSSCON", "CSUPER")


def remark_connections(bulk: BulkData, on_edges: Mapping[int, list[int]], edges: tuple[str, ...],
                       kinds: tuple[str, ...], remarks: Remarks) -> None:
    """Add a remark on each card that connects the panel, and on free edges that one of them may support.

    `on_edges` has the numbers of the edges on which each grid of the panel lies, `edges` their names and `kinds` their
    supports.
    """
    at_free: dict[int, BulkCard] = {}
    for card, grids, is_mass in _connections(bulk, on_edges):
        # A corner counts for its edges if the card has no grid between corners.
        touched = ({edge for grid in grids for edge in on_edges[grid] if len(on_edges[grid]) == 1}
                   or {edge for grid in grids for edge in on_edges[grid]})
        where = " and ".join(f"the edge {edges[edge]}" for edge in sorted(touched)) or "grids inside the panel"
        if is_mass:
            remarks.add(card, f"its mass at {where} is not in the deck")
            continue
        remarks.add(card, f"it connects {where} to something that is not in the deck")
        for edge in touched:
            at_free.setdefault(edge, card)
    for edge, card in sorted(at_free.items()):
        if kinds[edge] == "free":
            remarks.edge(edges[edge], f"free in the deck, although the {card.name} in line {card.line} may support it: "
                                      "choose its support in edges of &plate", in_deck=True)


def _connections(bulk: BulkData, panel: Mapping[int, Any]) -> Iterator[tuple[BulkCard, list[int], bool]]:
    """Return the cards that are not converted and have grids of the panel, these grids, and whether it is a mass."""
    from pyNastran.bdf.bdf import BDF
    model = BDF(debug=None)
    for card in bulk.cards:
        if card.name in KNOWN or card in bulk.also_read or card.name[0] not in "CRMSDG":
            continue
        if not any(number in panel for number in _integers(card)):
            continue
        grids, is_mass = _grids(model, card)
        if there := [grid for grid in dict.fromkeys(grids) if grid in panel]:
            yield card, there, is_mass


def _integers(card: BulkCard) -> list[int]:
    """Return the integers among the fields of a card, none if its fields cannot be read."""
    try:
        return [int(text) for text in card.fields.card[1:] if text and text.isdigit()]
    except DeckError:
        return []


def _grids(model: Any, card: BulkCard) -> tuple[list[int], bool]:
    """Return the grids of a card, none if it is not an element, and whether it is a mass; `model` is left empty."""
    if card.name in _FIELDS:
        texts = [card.fields.field(number) or "" for number in _FIELDS[card.name]]
        return [int(text) for text in texts if text.isdigit()], False
    if card.name in _LISTS:
        return _integers(card)[1:], False
    for kind in _KINDS:
        getattr(model, kind).clear()
    try:
        model.add_card(card.fields.card, card.name, comment="", is_list=True, has_none=True)
        read = [(kind, each) for kind in _KINDS for each in getattr(model, kind).values()]
        return [grid for _, found in read for grid in _nodes(found)], bool(read) and read[0][0] == "masses"
    except (*READING_ERRORS, DeckError):
        # A card that cannot be read may connect any grid that it names.
        return _integers(card)[1:], False


def _nodes(found: Any) -> Iterable[int]:
    """Return the grids of an object of pyNastran, or of a list of them."""
    if isinstance(found, list):
        return [grid for each in found for grid in _nodes(each)]
    if hasattr(found, "dependent_nodes"):
        return [*found.independent_nodes, *found.dependent_nodes]
    return filter(None, found.node_ids)
