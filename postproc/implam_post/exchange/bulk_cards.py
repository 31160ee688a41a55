"""Cards of Nastran bulk data with their line numbers, joined from their lines; pyNastran reads the fields."""

import contextlib
import math
import re
from collections.abc import Sequence, Set
from functools import cached_property
from typing import Any

from implam_post.io.errors import DeckError

# Exceptions of pyNastran on fields that it cannot read.
READING_ERRORS = (SyntaxError, RuntimeError, AssertionError, ValueError, TypeError, LookupError, AttributeError)
# Cards that are converted. A line of blanks followed by one of these names is a card, not a continuation.
KNOWN = ("GRID", "GRDSET", "CORD2R", "CORD2C", "CQUAD4", "CQUAD8", "PCOMP", "PCOMPG", "PSHELL", "MAT1", "MAT8", "SPC1",
         "SPC", "SPCADD", "TEMPD")
# Columns of a small field.
_FIELD = 8
# Columns of the field that names the continuation, and the number of that field in lines with commas.
_MARK = slice(72, 80)
_MARK_FIELD = {False: 9, True: 5}
# Phrases in messages of pyNastran, and what is printed instead.
_WORDS = (("(field #", "(field "), (" on card must be", " must be"), ("a float", "a real number with a decimal point"),
          (" (not an integer)", ""))


class BulkCard:
    """A card: name in capitals, number of its first line, text, name of the file."""

    def __init__(self, name: str, line: int, text: str, file: str) -> None:
        """Begin with the first line of the text."""
        self.name, self.line, self.lines, self.file = name, line, [text], file

    @cached_property
    def fields(self) -> Any:
        """Fields in the numbering of pyNastran; field 0 is the name."""
        from pyNastran.bdf.bdf_interface.bdf_card import BDFCard
        from pyNastran.bdf.bdf_interface.utils import to_fields
        try:
            card = BDFCard([field.strip() for field in to_fields(self.lines, self.name)])
        except READING_ERRORS as error:
            raise self.unread(error) from None
        for number, text in enumerate(card.card[1:], 1):
            if text and _is_infinite(text):
                raise self.error(f"{text} is not a finite number.")
            if self.name in KNOWN and text and len(text.split()) > 1:
                raise self.error(f"field {number}, '{text}', has blanks inside: is it one value that is written apart, "
                                 f"or two in the {_FIELD} or {2 * _FIELD} columns of one field?")
            # Python's numbers may have underscores, those of Nastran may not.
            if self.name in KNOWN and text and re.fullmatch(r"[-+.\d]+_[-+.\w]*", text):
                raise self.error(f"field {number}, '{text}', is not a number: leave out the underscore.")
        return card

    def error(self, sentence: str) -> DeckError:
        """Return an error that names file, line and card."""
        return DeckError(f"{self.file}:{self.line}: {self.name}: {sentence}")

    def unread(self, error: Exception) -> DeckError:
        """Return an error with the first line of pyNastran's message, without the name of the card."""
        lines = [line.strip() for line in str(error).splitlines() if line.strip() and "card_name=" not in line]
        sentence = (lines or [type(error).__name__])[0].rstrip(".")
        if match := re.match(r"invalid literal for int\(\) with base 10: ('.*')$", sentence):
            sentence = f"{match[1]} is not an integer"
        if match := re.match(r"field=('.*') is not (\d+) characters long", sentence):
            sentence = f"{match[1]} has more than {match[2]} characters"
        if isinstance(error, (LookupError, AttributeError, TypeError)):
            sentence = "its fields are not valid for this card"  # internal error of pyNastran
        for word, plain in _WORDS:
            sentence = sentence.replace(word, plain)
        return self.error(f"{sentence}.")

    def given(self, number: int) -> bool:
        """Return whether a field is given and is not zero."""
        text = self.fields.field(number)
        return text is not None and re.fullmatch(r"[-+]?0*\.?0*([-+DdEe]+\d+)?", text.strip()) is None


class _Splitter:
    """Cards found so far, and those whose last line names a continuation."""

    def __init__(self, file: str, named: Set[str]) -> None:
        """Begin without cards; `named` are the continuation marks in all lines of the file."""
        self.file, self.named = file, named
        self.cards: list[BulkCard] = []
        self.early: list[tuple[str, str, int]] = []
        self._continued: dict[str, BulkCard] = {}
        self._left_open = ""

    def error(self, number: int, sentence: str) -> DeckError:
        """Return an error that names file and line."""
        return DeckError(f"{self.file}:{number}: {sentence}")

    def begin(self, name: str, number: int, line: str) -> None:
        """Begin a card."""
        if name.startswith("="):
            raise self.error(number, f"{name}: replicated cards are not supported: give each card, as ECHO = SORT "
                                     "prints them.")
        if not name[0].isalpha():
            raise self.error(number, f"{name}: not the name of a card; a continuation has blanks, + or * in columns "
                                     f"1 to {_FIELD}.")
        self.cards.append(BulkCard(name, number, line, self.file))
        self._note(self.cards[-1], line)

    def carry_on(self, number: int, line: str) -> None:
        """Add a continuation to the card that names its mark, anywhere in the file, or else to the preceding card."""
        mark = _first_field(line).lstrip("+*").strip().upper()
        if mark in self._continued:
            self._add(self._continued.pop(mark), line)
        elif mark in self.named:
            self.early.append((mark, line, number))
        elif mark and self._left_open:
            raise self._unnamed(mark, number)
        elif not self.cards:
            raise self.error(number, "the continuation belongs to no card.")
        else:
            self._add(self.cards[-1], line)

    def carry_on_early(self) -> None:
        """Add continuations that precede the line which names their mark."""
        while self.early:
            there = [entry for entry in self.early if entry[0] in self._continued]
            if not there:
                raise self._unnamed(self.early[0][0], self.early[0][2])
            for entry in there:
                self.early.remove(entry)
                self._add(self._continued.pop(entry[0]), entry[1])

    def _unnamed(self, mark: str, number: int) -> DeckError:
        """Return an error about a continuation that belongs to no card."""
        return self.error(number, f"+{mark}: no card has this continuation mark in its tenth field.")

    def _add(self, card: BulkCard, line: str) -> None:
        """Add a line to a card."""
        card.lines.append(line)
        self._note(card, line)

    def _note(self, card: BulkCard, line: str) -> None:
        """Store the continuation mark of the line; in converted cards a value after the last field is an error."""
        if card.name in KNOWN and (lost := _beyond_last_field(line)):
            raise card.error(f"{lost} follows the last field of a line with commas and would be lost: continue on a "
                             "new line.")
        self._left_open = _named_continuation(line)
        if self._left_open:
            self._continued[self._left_open] = card


def read_cards(lines: Sequence[str], first: int, file: str) -> list[BulkCard]:
    """Return the cards up to ENDDATA; `first` is the number of the first line."""
    bare = [line.split("$")[0].rstrip() for line in lines]
    found = _Splitter(file, set(map(_named_continuation, bare)) - {""})
    for number, bare_line in enumerate(bare, first):
        if not bare_line.strip():
            continue
        if re.match(r"\s*ENDDATA\b", bare_line, re.I):
            break
        if is_begin(bare_line):
            check_begin(bare_line, number, file)
            raise DeckError(f"{file}:{number}: BEGIN BULK: there is another one above: give one part in each file.")
        line = _name_first(bare_line, number, file)
        name = re.split(r"[,*\s]", line.expandtabs()[:8 if "," not in line else None], maxsplit=1)[0].upper()
        if line[0] in "+*" or not name:
            found.carry_on(number, line)
        else:
            found.begin(name, number, line)
    found.carry_on_early()
    return found.cards


def is_begin(line: str) -> bool:
    """Return whether a part of the bulk data begins at a line."""
    return re.match(r"\s*BEGIN\b", line, re.I) is not None


def check_begin(line: str, number: int, file: str) -> None:
    """Refuse the bulk data of a superelement, a module or an auxiliary model: cards of equal names are independent."""
    words = " ".join(line.split("$")[0].upper().split())
    if not re.fullmatch(r"BEGIN( ?, ?| )BULK", words):
        raise DeckError(f"{file}:{number}: {words}: files of several superelements or parts are not supported: give "
                        "the part with the panel, its materials and supports as BEGIN BULK of its own file.")


def _named_continuation(line: str) -> str:
    """Return the continuation mark in the last field of a line; empty if there is none."""
    if "," in line:
        fields = line.split(",")
        place = _MARK_FIELD["*" in fields[0]]
        text = fields[place] if len(fields) > place else ""
    else:
        text = line.expandtabs()[_MARK]
    text = text.strip()
    return text.lstrip("+*").strip().upper() if text[:1] in ("+", "*") else ""


def _beyond_last_field(line: str) -> str:
    """Return a value after the last field of a line with commas; empty if there is none.

    The next field is a continuation mark, which is not a real number.
    """
    fields = [text.strip() for text in line.split(",")]
    place = _MARK_FIELD["*" in fields[0]]
    behind = [text for text in fields[place:place + 1] if re.match(r"[-+]?\d*\.", text)]
    return next(filter(None, behind + fields[place + 1:]), "")


def _first_field(line: str) -> str:
    """Return the first field of a line."""
    return line.split(",")[0] if "," in line else line.expandtabs()[:_FIELD]


def _name_first(line: str, number: int, file: str) -> str:
    """Return a line with its name moved to column 1; Nastran accepts a name anywhere in the first field."""
    if not line[0].isspace():
        return line
    word = re.split(r"[,*\s]", line.strip(), maxsplit=1)[0].upper()
    if "," in line:
        return line.lstrip() if line.split(",")[0].strip() else line
    line = line.expandtabs()
    indent = len(line) - len(line.lstrip())
    if word in KNOWN and indent + len(word) > _FIELD:
        raise DeckError(f"{file}:{number}: {word}: it begins in column {indent + 1}; the name of a card belongs in "
                        f"columns 1 to {_FIELD}.")
    first = line[:_FIELD].strip()
    return first.ljust(_FIELD) + line[_FIELD:] if first else line


def _is_infinite(text: str) -> bool:
    """Return whether a field is NaN, infinite or too large."""
    with contextlib.suppress(ValueError):
        return not math.isfinite(float(with_exponent(text)))
    return False


def with_exponent(text: str) -> str:
    """Return a number of bulk data with an E before its exponent."""
    return re.sub(r"(?<=[\d.])[DE]?([-+]\d+)$", r"E\1", text.upper())
