"""Nastran bulk data and the sets that the case control selects; pyNastran reads the fields."""

import codecs
import contextlib
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from implam_post.exchange.bulk_cards import READING_ERRORS, BulkCard, read_cards, with_exponent
from implam_post.io.errors import DeckError, FileError, ImplamError, reason

_BEGIN = re.compile(r"\s*BEGIN(\s+|\s*,\s*)BULK", re.I)
_CEND = re.compile(r"\s*CEND\b", re.I)
_LINE_END = re.compile(r"\r\n|\r|\n")


class BulkData:
    """The cards of a file and the supports selected by its case control."""

    def __init__(self, path: Path, text: str) -> None:
        """Split the text into cards."""
        try:
            import pyNastran.bdf.bdf  # noqa: F401
        except ImportError as error:
            raise ImplamError(f"reading Nastran files needs pyNastran, and {error.name} is not installed: "
                              "pip install 'implam-post[nastran]' and pip install --no-deps pyNastran.") from None
        self.path = path
        self.cards: list[BulkCard] = []
        self.first_line = 1
        self.support_set: int | None = None
        self.temperature_set: int | None = None
        self.mass_factor = 1.0
        self._split(text)
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

    def _split(self, text: str) -> None:
        """Find the cards between BEGIN BULK, if there is one, and ENDDATA."""
        # Not splitlines: it would split at bytes of UTF-8 letters, which are read as latin-1.
        lines = _LINE_END.split(text)
        begin = next((number for number, line in enumerate(lines) if _BEGIN.match(line)), -1)
        if begin < 0 and (end := next((number for number, line in enumerate(lines, 1) if _CEND.match(line)), 0)):
            raise DeckError(f"{self.path.name}:{end}: CEND: no line BEGIN BULK follows.")
        self._read_case_control(lines[:begin + 1])
        self.first_line = begin + 2
        self.cards = read_cards(lines[begin + 1:], begin + 2, self.path.name)

    def _read_case_control(self, lines: Sequence[str]) -> None:
        """Store the sets of supports and temperatures that the case control selects; subcases may not differ."""
        chosen = _chosen(r"SPC", lines)
        temperatures = _chosen(r"TEMP(?:ERATURE)?\s*(?:\(\s*(?:LOAD|BOTH)\s*\))?", lines)
        if len(temperatures) > 1:
            raise self.missing(f"the case control selects the temperature sets {sorted(temperatures)}: select one.")
        self.temperature_set = next(iter(temperatures), None)
        for line in lines:
            if re.match(r"\s*INCLUDE\b", line, re.I):
                raise self.missing("INCLUDE in the case control is not supported: put all into one file.")
            if match := re.match(r"\s*PARAM\s*,\s*WTMASS\s*,\s*([^\s,$]+)", line, re.I):
                self.mass_factor = self._plain_number(match[1])
        if len(chosen) > 1:
            raise self.missing(f"the case control selects the support sets {sorted(chosen)}: choose one with --spc.")
        self.support_set = next(iter(chosen), None)

    def _plain_number(self, text: str) -> float:
        """Return a number of the case control, in the notation of bulk data."""
        with contextlib.suppress(ValueError):
            value = float(with_exponent(text))
            if math.isfinite(value) and value > 0:
                return value
        raise self.missing(f"PARAM,WTMASS,{text} in the case control needs a number greater than zero.")


def read_bulk_data(path: Path) -> BulkData:
    """Read a file."""
    try:
        text = path.read_bytes().removeprefix(codecs.BOM_UTF8).decode("latin-1")
    except OSError as error:
        raise FileError(f"{path} cannot be read ({reason(error)}).") from None
    if "\0" in text:
        raise FileError(f"{path} is not a text file: give bulk data, a file .bdf or .dat.")
    return BulkData(path, text)


def _chosen(command: str, lines: Iterable[str]) -> set[int]:
    """Return the numbers of the sets that a command of the case control selects."""
    pattern = re.compile(rf"\s*{command}\s*=\s*(\d+)\s*(\$|$)", re.I)
    return {int(match[1]) for line in lines if (match := pattern.match(line))}


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
