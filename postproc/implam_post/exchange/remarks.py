"""Remarks on the cards that were read: fields that are ignored or have another effect in Implam."""

from collections.abc import Mapping

from implam_post.exchange.bulk_cards import BulkCard
from implam_post.exchange.bulk_data import BulkData, ranges


class Remarks:
    """Remarks on cards and edges; equal remarks on several cards are merged."""

    def __init__(self) -> None:
        """Begin without remarks."""
        self._lines: dict[tuple[str, str], set[int]] = {}
        self._notes: list[str] = []
        self.for_deck: list[str] = []

    def add(self, card: BulkCard, sentence: str) -> None:
        """Add a remark on a card."""
        self._lines.setdefault((card.name, sentence), set()).add(card.line)

    def edge(self, edge: str, sentence: str, in_deck: bool = False) -> None:
        """Add a remark on an edge."""
        self.note(f"edge {edge}: {sentence}", in_deck)

    def note(self, sentence: str, in_deck: bool = False) -> None:
        """Add a remark that belongs to no single card; `in_deck` if the deck has it as a comment."""
        self._notes.append(sentence)
        self.for_deck += [sentence] if in_deck else []

    def ignored(self, card: BulkCard, names: Mapping[int, str]) -> None:
        """Add a remark on each of these fields that the card has, as they are ignored."""
        for number, name in names.items():
            if card.given(number):
                self.add(card, f"{name} is ignored")

    def texts(self, bulk: BulkData) -> list[str]:
        """Return the remarks in the order of the file, then those on edges and the case control."""
        everything = [card.line for card in bulk.cards]
        found = [(min(lines), f"{name}, {ranges(lines, everything)}: {sentence}")
                 for (name, sentence), lines in self._lines.items()]
        return [*(text for _, text in sorted(found)), *self._notes]
