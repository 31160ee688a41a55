"""Nastran's bulk data card by card, each with its line; pyNastran reads the fields."""

import codecs
import contextlib
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

from implam_post.io.errors import DeckError, FileError, ImplamError

# What pyNastran raises about fields that it can't read.
_READING_ERRORS = (SyntaxError, RuntimeError, AssertionError, ValueError, TypeError, LookupError, AttributeError)


# Cards that a deck is made from. A line that begins with blanks and one of these names is a card and no continuation.
KNOWN = ("GRID", "GRDSET", "CORD2R", "CQUAD4", "CQUAD8", "PCOMP", "PCOMPG", "PSHELL", "MAT1", "MAT8", "SPC1", "SPC",
         "SPCADD", "TEMPD")
# Columns of a small field.
_FIELD = 8


class BulkCard:
    """A card: its name in capitals, the line it begins on, its text, and the name of its file."""

    def __init__(self, name: str, line: int, text: str, file: str) -> None:
        """Begin with the first line of the text."""
        self.name, self.line, self.lines, self.file = name, line, [text], file

    @cached_property
    def fields(self) -> Any:
        """Fields as pyNastran has them, the name being number 0."""
        from pyNastran.bdf.bdf_interface.bdf_card import BDFCard
        from pyNastran.bdf.bdf_interface.utils import to_fields
        try:
            card = BDFCard([field.strip() for field in to_fields(self.lines, self.name)])
        except _READING_ERRORS as error:
            raise self.unread(error) from None
        for text in filter(None, card.card[1:]):
            if _is_infinite(text):
                raise self.error(f"{text} isn't a finite number.")
        return card

    def error(self, sentence: str) -> DeckError:
        """Return an error that names file, line and card."""
        return DeckError(f"{self.file}:{self.line}: {self.name}: {sentence}")

    def unread(self, error: Exception) -> DeckError:
        """Return an error with the first line of one of pyNastran's, after that which repeats the card's name."""
        lines = [line.strip() for line in str(error).splitlines() if line.strip() and "card_name=" not in line]
        return self.error(f"{(lines or [type(error).__name__])[0].rstrip('.')}.")

    def given(self, number: int) -> bool:
        """Return whether a field is there and isn't zero."""
        text = self.fields.field(number)
        return text is not None and re.fullmatch(r"[-+]?0*\.?0*([-+DdEe]+\d+)?", text.strip()) is None


class BulkData:
    """The cards of a file and what its case control says of supports."""

    def __init__(self, path: Path, text: str) -> None:
        """Split the text into cards."""
        try:
            import pyNastran.bdf.bdf_interface.bdf_card  # noqa: F401
        except ImportError:
            raise ImplamError("Nastran's files are read by pyNastran, which isn't installed: "
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
        except _READING_ERRORS as error:
            raise card.unread(error) from None

    def integer(self, card: BulkCard, number: int) -> int:
        """Return a field that must hold an integer."""
        from pyNastran.bdf.bdf_interface.assign_type import integer
        try:
            return integer(card.fields, number, f"field {number}")
        except _READING_ERRORS as error:
            raise card.unread(error) from None

    def real(self, card: BulkCard, number: int) -> float | None:
        """Return a field that holds a real number or nothing."""
        from pyNastran.bdf.bdf_interface.assign_type import double_or_blank
        try:
            return double_or_blank(card.fields, number, f"field {number}")
        except _READING_ERRORS as error:
            raise card.unread(error) from None

    def mass_cards(self) -> list[BulkCard]:
        """Return the cards PARAM,WTMASS, which turn weights into masses."""
        return [card for card in self.named("PARAM") if str(card.fields.field(1) or "").upper() == "WTMASS"]

    def _read_mass_factor(self) -> None:
        """Note the factor of all masses, from the bulk data or else the case control."""
        factors = {}
        for card in self.mass_cards():
            factor = self.real(card, 2)
            if factor is None or factor <= 0:
                raise card.error("WTMASS needs a number greater than zero.")
            factors.setdefault(factor, card)
        if len(factors) > 1:
            raise list(factors.values())[1].error("WTMASS is another one than before.")
        self.mass_factor = next(iter(factors), self.mass_factor)

    def missing(self, sentence: str) -> DeckError:
        """Return an error about what isn't there."""
        return DeckError(f"{self.path.name}: {sentence}")

    def error(self, card: BulkCard, sentence: str) -> DeckError:
        """Return an error that names file, line and card."""
        return card.error(sentence)

    def _split(self, text: str) -> None:
        """Find the cards between BEGIN BULK, if there is one, and ENDDATA."""
        lines = text.splitlines()
        begin = next((number for number, line in enumerate(lines) if re.match(r"\s*BEGIN\s+BULK", line, re.I)), -1)
        self._read_case_control(lines[:begin + 1])
        self.first_line = begin + 2
        for number, line in enumerate(lines[begin + 1:], begin + 2):
            line = line.split("$")[0].rstrip()
            if not line.strip():
                continue
            line = self._name_first(line, number)
            name = re.split(r"[,*\s]", line.expandtabs()[:8 if "," not in line else None], maxsplit=1)[0].upper()
            if name == "ENDDATA":
                break
            if name.startswith("="):
                raise DeckError(f"{self.path.name}:{number}: {name}: replicated cards aren't read: write each card "
                                "out, as ECHO = SORT prints them.")
            if line[0] in "+*" or not name:
                if not self.cards:
                    raise DeckError(f"{self.path.name}:{number}: a continuation without a card.")
                self.cards[-1].lines.append(line)
            else:
                self.cards.append(BulkCard(name, number, line, self.path.name))

    def _name_first(self, line: str, number: int) -> str:
        """Return a line whose first field begins with its name, as Nastran reads a name anywhere in that field."""
        if not line[0].isspace():
            return line
        word = re.split(r"[,*\s]", line.strip(), maxsplit=1)[0].upper()
        if "," in line:
            first = line.split(",")[0].strip()
            return line.lstrip() if first else line
        line = line.expandtabs()
        indent = len(line) - len(line.lstrip())
        if word in KNOWN and indent + len(word) > _FIELD:
            raise DeckError(f"{self.path.name}:{number}: {word}: it begins in column {indent + 1}; the name of a card "
                            f"stands in columns 1 to {_FIELD}.")
        first = line[:_FIELD].strip()
        return first.ljust(_FIELD) + line[_FIELD:] if first else line

    def _read_case_control(self, lines: Sequence[str]) -> None:
        """Note which sets of supports and temperatures the case control takes; several subcases may not differ."""
        chosen = _chosen(r"SPC", lines)
        temperatures = _chosen(r"TEMP(?:ERATURE)?\s*(?:\(\s*(?:LOAD|BOTH)\s*\))?", lines)
        if len(temperatures) > 1:
            raise self.missing(f"the case control takes the temperatures {sorted(temperatures)}: leave one.")
        self.temperature_set = next(iter(temperatures), None)
        for line in lines:
            if match := re.match(r"\s*PARAM\s*,\s*WTMASS\s*,\s*([^\s,$]+)", line, re.I):
                self.mass_factor = self._plain_number(match[1])
        if len(chosen) > 1:
            raise self.missing(f"the case control takes the supports {sorted(chosen)}: choose one by --spc.")
        self.support_set = next(iter(chosen), None)


    def _plain_number(self, text: str) -> float:
        """Return a number of the case control, which is written as in bulk data."""
        with contextlib.suppress(ValueError):
            value = float(_with_exponent(text))
            if math.isfinite(value) and value > 0:
                return value
        raise self.missing(f"PARAM,WTMASS,{text} in the case control needs a number greater than zero.")


def read_bulk_data(path: Path) -> BulkData:
    """Read a file."""
    try:
        text = path.read_bytes().removeprefix(codecs.BOM_UTF8).decode("latin-1")
    except OSError as error:
        raise FileError(f"{path} cannot be read ({error}).") from None
    return BulkData(path, text)


def _chosen(command: str, lines: Iterable[str]) -> set[int]:
    """Return the numbers of the sets that a command of the case control takes."""
    pattern = re.compile(rf"\s*{command}\s*=\s*(\d+)\s*(\$|$)", re.I)
    return {int(match[1]) for line in lines if (match := pattern.match(line))}


def _is_infinite(text: str) -> bool:
    """Return whether a field is no number by name, or one too large."""
    with contextlib.suppress(ValueError):
        return not math.isfinite(float(_with_exponent(text)))
    return False


def _with_exponent(text: str) -> str:
    """Return a number of bulk data with the letter of its exponent."""
    return re.sub(r"(?<=[\d.])[DE]?([-+]\d+)$", r"E\1", text.upper())


def ranges(lines: Iterable[int], everything: Sequence[int]) -> str:
    """Return lines in words, those next to each other among `everything` as a range."""
    place = {line: number for number, line in enumerate(everything)}
    runs: list[list[int]] = []
    for line in sorted(lines):
        if runs and place[line] == place[runs[-1][-1]] + 1:
            runs[-1].append(line)
        else:
            runs.append([line])
    words = [str(run[0]) if len(run) == 1 else f"{run[0]}-{run[-1]}" for run in runs]
    return f"line{'s' if len(runs) > 1 or len(runs[0]) > 1 else ''} {', '.join(words)}"
