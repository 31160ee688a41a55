"""Remarks on the cards that were read: fields with another effect, or none."""

from collections.abc import Mapping

from implam_post.exchange.bulk_cards import BulkCard
from implam_post.exchange.bulk_data import BulkData, ranges


class Remarks:
    """Remarks on cards, equal ones on several cards as one, and on edges."""

    def __init__(self) -> None:
        """Begin with none."""
        self._lines: dict[tuple[str, str], set[int]] = {}
        self._edges: list[str] = []

    def add(self, card: BulkCard, sentence: str) -> None:
        """Add a remark on a card."""
        self._lines.setdefault((card.name, sentence), set()).add(card.line)

    def edge(self, edge: str, sentence: str) -> None:
        """Add a remark on an edge."""
        self._edges.append(f"edge {edge}: {sentence}")

    def untaken(self, card: BulkCard, names: Mapping[int, str]) -> None:
        """Add which of these fields of a card are there, for they are not taken."""
        for number, name in names.items():
            if card.given(number):
                self.add(card, f"{name} is not taken")

    def texts(self, bulk: BulkData) -> list[str]:
        """Return the remarks in the order of the file, those on edges at the end."""
        everything = [card.line for card in bulk.cards]
        found = [(min(lines), f"{name}, {ranges(lines, everything)}: {sentence}")
                 for (name, sentence), lines in self._lines.items()]
        return [*(text for _, text in sorted(found)), *self._edges]
