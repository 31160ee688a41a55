"""Stacking sequences in the usual notation, such as [45/0/-45/90]2s, read as in the solver."""

import re

from implam_post.io.errors import DeckError

MAX_PLIES = 1000
_ANGLE = re.compile(r"\s*(?P<signs>\+-|-\+|±|\+|-)?\s*(?P<angle>\d+\.?\d*|\.\d+)")
_COUNT = re.compile(r"\s*(\d{1,4})(?!\d)")
_CLOSING = {"[": "]", "(": ")"}


def angles_of(sequence: str) -> list[float]:
    """Return the angles of the plies from the struck face on, in degrees."""
    reader = _Reader(sequence)
    angles, barred = reader.plies()
    if reader.text[reader.at:].strip() or barred:
        raise reader.error()
    return angles


class _Reader:
    """Reader of a sequence at its current position."""

    def __init__(self, text: str) -> None:
        """Begin before the first character."""
        self.text = text.rstrip()
        self.at = 0

    def error(self) -> DeckError:
        """Return an error with the current position."""
        return DeckError(f"stacking '{self.text}' cannot be read from character {self.at + 1} on.")

    def plies(self) -> tuple[list[float], bool]:
        """Read items separated by slashes; return their angles, and whether the last one is a mid-ply (~)."""
        angles: list[float] = []
        while True:
            item, barred = self._item()
            angles += item
            if len(angles) > MAX_PLIES:
                raise self.error()
            if barred or not self._take("/"):
                return angles, barred

    def _item(self) -> tuple[list[float], bool]:
        """Read an angle or a pair of angles with its count, or a bracket with its count and symmetry."""
        opening = self._take("[") or self._take("(")
        if not opening:
            angles = self._angle()
            if self._take("_"):
                return self._count() * angles, False
            return angles, len(angles) == 1 and bool(self._take("~"))
        angles, barred = self.plies()
        if not self._take(_CLOSING[opening]):
            raise self.error()
        while True:
            if self._take("s") or self._take("S"):
                angles += angles[:-1][::-1] if barred else angles[::-1]
                barred = False
            elif self._take("t") or self._take("T") or self._take("_"):
                continue
            elif self.text[self.at:].lstrip()[:1].isdigit():
                angles = self._count() * angles
            else:
                return angles, barred
            if len(angles) > MAX_PLIES:
                raise self.error()

    def _angle(self) -> list[float]:
        """Read an angle or a pair of opposite angles."""
        match = _ANGLE.match(self.text, self.at)
        if match is None or float(match["angle"]) > 360 or re.match(r"0\d", match["angle"]):
            raise self.error()
        self.at = match.end()
        angle = float(match["angle"])
        return {"±": [angle, -angle], "+-": [angle, -angle], "-+": [-angle, angle], "-": [-angle]
                }.get(match["signs"], [angle])

    def _count(self) -> int:
        """Read a count."""
        match = _COUNT.match(self.text, self.at)
        if match is None or not 1 <= int(match[1]) <= MAX_PLIES:
            raise self.error()
        self.at = match.end()
        return int(match[1])

    def _take(self, mark: str) -> str:
        """Read a mark if it comes next; return it, or an empty text."""
        rest = self.text[self.at:]
        if not rest.lstrip().startswith(mark):
            return ""
        self.at += len(rest) - len(rest.lstrip()) + 1
        return mark
