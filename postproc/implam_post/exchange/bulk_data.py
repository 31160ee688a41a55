"""Nastran bulk data; pyNastran reads the fields."""

import codecs
import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from implam_post.exchange.bulk_cards import READING_ERRORS, BulkCard, check_begin, is_begin, read_cards
from implam_post.exchange.case_control import CaseControl
from implam_post.io.errors import DeckError, FileError, ImplamError, reason

_CEND = re.compile(r"\s*CEND\b", re.I)
_LINE_END = re.compile(r"\r\n|\r|\n")


class BulkData:
    """The cards of a file and its case control; `also_read` are cards that are converted on some conditions only."""

    def __init__(self, path: Path, text: str, subcase: int | None = None) -> None:
        """Split the text into cards; `subcase` is the one to use."""
        try:
            import pyNastran.bdf.bdf  # noqa: F401
        except ImportError as error:
            raise ImplamError(f"reading Nastran files needs pyNastran, and {error.name} is not installed: "
                              "pip install 'implam-post[nastran]' and pip install --no-deps pyNastran.") from None
        self.path = path
        self.cards: list[BulkCard] = []
        self.also_read: set[BulkCard] = set()
        self.first_line = 1
        self._split(text, subcase)
        self.mass_factor = self.case_control.mass_factor
        self._read_mass_factor()

    def named(self, *names: str) -> Iterator[BulkCard]:
        """Return the cards of these names in the order of the file."""
        return (card for card in self.cards if card.name in names)

    def read(self, card: BulkCard, kind: Any) -> Any:
        """Return the card as pyNastran's object of a `kind`."""
        try:
            return kind.add_card(card.fields)
        except READING_ERRORS as error:
            raise card.unread(error) from None

    def integer(self, card: BulkCard, number: int) -> int:
        """Return a field that must hold an integer."""
        from pyNastran.bdf.bdf_interface.assign_type import integer
        try:
            return integer(card.fields, number, f"field {number}")
        except READING_ERRORS as error:
            raise card.unread(error) from None

    def real(self, card: BulkCard, number: int) -> float | None:
        """Return a field that holds a real number or nothing."""
        from pyNastran.bdf.bdf_interface.assign_type import double_or_blank
        try:
            return double_or_blank(card.fields, number, f"field {number}")
        except READING_ERRORS as error:
            raise card.unread(error) from None

    def mass_cards(self) -> list[BulkCard]:
        """Return the cards PARAM,WTMASS, which convert weights to masses."""
        return [card for card in self.named("PARAM") if str(card.fields.field(1) or "").upper() == "WTMASS"]

    def _read_mass_factor(self) -> None:
        """Store WTMASS, the factor of all masses, from the bulk data or else the case control."""
        factors = {}
        for card in self.mass_cards():
            factor = self.real(card, 2)
            if factor is None or factor <= 0:
                raise card.error("WTMASS needs a number greater than zero.")
            factors.setdefault(factor, card)
        if len(factors) > 1:
            raise list(factors.values())[1].error("WTMASS differs from that of the preceding card.")
        self.mass_factor = next(iter(factors), self.mass_factor)

    def missing(self, sentence: str) -> DeckError:
        """Return an error about a missing card."""
        return DeckError(f"{self.path.name}: {sentence}")

    def error(self, card: BulkCard, sentence: str) -> DeckError:
        """Return an error that names file, line and card."""
        return card.error(sentence)

    def _split(self, text: str, subcase: int | None) -> None:
        """Find the cards between BEGIN BULK, if there is one, and ENDDATA."""
        # Not splitlines: it would split at bytes of UTF-8 letters, which are read as latin-1.
        lines = _LINE_END.split(text)
        begin = next((number for number, line in enumerate(lines) if is_begin(line)), -1)
        if begin >= 0:
            check_begin(lines[begin], begin + 1, self.path.name)
        if begin < 0 and (end := next((number for number, line in enumerate(lines, 1) if _CEND.match(line)), 0)):
            raise DeckError(f"{self.path.name}:{end}: CEND: no line BEGIN BULK follows.")
        self.case_control = CaseControl(lines[:max(begin, 0)], self.path.name, subcase)
        self.first_line = begin + 2
        self.cards = read_cards(lines[begin + 1:], begin + 2, self.path.name)


def read_bulk_data(path: Path, subcase: int | None = None) -> BulkData:
    """Read a file; `subcase` of its case control is used."""
    try:
        text = path.read_bytes().removeprefix(codecs.BOM_UTF8).decode("latin-1")
    except OSError as error:
        raise FileError(f"{path} cannot be read ({reason(error)}).") from None
    if "\0" in text:
        raise FileError(f"{path} is not a text file: give bulk data, a file .bdf or .dat.")
    return BulkData(path, text, subcase)


def ranges(lines: Iterable[int], everything: Sequence[int]) -> str:
    """Return line numbers as text; lines that are adjacent among `everything` become a range."""
    place = {line: number for number, line in enumerate(everything)}
    runs: list[list[int]] = []
    for line in sorted(lines):
        if runs and place[line] == place[runs[-1][-1]] + 1:
            runs[-1].append(line)
        else:
            runs.append([line])
    words = [str(run[0]) if len(run) == 1 else f"{run[0]}-{run[-1]}" for run in runs]
    return f"line{'s' if len(runs) > 1 or len(runs[0]) > 1 else ''} {', '.join(words)}"
