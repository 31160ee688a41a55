"""Bulk data of the tests: a rectangular panel in small, large or free fields, in any plane."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

Fields = Sequence[object]
LAMINATE = [("PCOMP", 1, None, None, None, None, None, None, "SYM", 1, 0.125e-3, 45.0, "YES", 1, None, -45.0, "YES",
             2, 0.25e-3, 0.0, None)]
MATERIALS = [("MAT8", 1, 139e9, 9.4e9, 0.309, 4.5e9, 4.6e9, 2.98e9, 1580.0, None, None, None, 1.517e9, 1.59e9, 46e6,
              253e6, 105e6), ("MAT1", 2, 70e9, None, 0.33, 2700.0)]


def small(*fields: object) -> list[str]:
    """Return a card in fields of eight."""
    return _fixed(fields, 8, 8, "", "+")


def large(*fields: object) -> list[str]:
    """Return a card in fields of sixteen."""
    return _fixed(fields, 16, 4, "*", "*")


def free(*fields: object) -> list[str]:
    """Return a card with commas."""
    texts = [_text(each, 16) for each in fields[1:]]
    return [",".join([str(fields[0]) if not start else "", *texts[start:start + 8]])
            for start in range(0, len(texts), 8)]


def _fixed(fields: Fields, width: int, count: int, mark: str, continued: str) -> list[str]:
    """Return a card in fields of a width."""
    texts = [_text(each, width).rjust(width) for each in fields[1:]]
    return [(str(fields[0]) + mark if not start else continued).ljust(8) + "".join(texts[start:start + count])
            for start in range(0, len(texts), count)]


def _text(value: object, width: int) -> str:
    """Return a field; exponents without the letter E, as Nastran allows."""
    if not isinstance(value, float):
        return "" if value is None else str(value)
    text = f"{value:.{10 if width > 8 else 4}g}"
    mantissa, _, exponent = text.partition("e")
    return (mantissa if "." in mantissa else mantissa + ".") + (f"{int(exponent):+d}" if exponent else "")


@dataclass
class Bulk:
    """A panel of `cells`; `place` maps a point of the panel, measured from its corner, to coordinates in space."""

    cells: tuple[int, int] = (4, 3)
    lengths: tuple[float, float] = (0.2, 0.15)
    write: Callable[..., list[str]] = small
    place: Callable[[float, float], tuple[float, float, float]] = lambda x, y: (x, y, 0.0)
    theta: float | int | None = None
    eight: bool = False
    turned: bool = False
    edges: tuple[str, str, str, str] = ("1234", "1234", "1235", "1235")
    laminate: list[Fields] = field(default_factory=lambda: list(LAMINATE))
    materials: list[Fields] = field(default_factory=lambda: list(MATERIALS))
    more: list[Fields] = field(default_factory=list)
    head: str = ""
    property_of: Callable[[int, int], int] = lambda i, j: 1

    def text(self) -> str:
        """Return the file."""
        cards = [*self._grids(), *self._elements(), *self.laminate, *self.materials, *self._supports(), *self.more]
        return self.head + "\n".join(line for card in cards for line in self.write(*card)) + "\n"

    def number(self, i: int, j: int) -> int:
        """Return the number of the grid at half-lines i and j."""
        return 1 + i + (2 * self.cells[0] + 1) * j

    def _there(self) -> list[tuple[int, int]]:
        """Return the positions of the grids: corners of cells, and mid-sides for CQUAD8."""
        every = [(i, j) for j in range(2 * self.cells[1] + 1) for i in range(2 * self.cells[0] + 1)]
        return [(i, j) for i, j in every if (not (i % 2 and j % 2) if self.eight else not (i % 2 or j % 2))]

    def _grids(self) -> list[Fields]:
        """Return the grids."""
        step = [length / (2 * cells) for length, cells in zip(self.lengths, self.cells, strict=True)]
        return [("GRID", self.number(i, j), None, *map(float, self.place(i * step[0], j * step[1])))
                for i, j in self._there()]

    def _elements(self) -> list[Fields]:
        """Return the elements; turned elements begin at the second corner and are numbered in the opposite sense."""
        corners = [(0, 0), (2, 0), (2, 2), (0, 2)]
        sides = [(1, 0), (2, 1), (1, 2), (0, 1)]
        if self.turned:
            corners, sides = [(2, 0), (0, 0), (0, 2), (2, 2)], [(1, 0), (0, 1), (1, 2), (2, 1)]
        found = []
        for j in range(self.cells[1]):
            for i in range(self.cells[0]):
                number = 1 + i + self.cells[0] * j
                grids = [self.number(2 * i + a, 2 * j + b) for a, b in corners]
                if self.eight:
                    grids += [self.number(2 * i + a, 2 * j + b) for a, b in sides]
                    found.append(("CQUAD8", number, self.property_of(i, j), *grids, None, None, None, None, self.theta))
                else:
                    found.append(("CQUAD4", number, self.property_of(i, j), *grids, self.theta))
        return found

    def on_edge(self, edge: int) -> list[int]:
        """Return the grids of an edge: x-min, x-max, y-min, y-max."""
        axis, far = divmod(edge, 2)
        limit = 2 * self.cells[axis] * far
        return [self.number(*place) for place in self._there() if place[axis] == limit]

    def _supports(self) -> list[Fields]:
        """Return one card per edge."""
        return [("SPC1", 1, held, *self.on_edge(edge)) for edge, held in enumerate(self.edges) if held]
