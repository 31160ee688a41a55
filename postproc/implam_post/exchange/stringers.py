"""Stringers of a deck as beams: place, section about the centroid, as in the solver."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from implam_post.io.deck import Deck, as_number
from implam_post.io.namelist import Group

# Shear correction of a rectangle.
SHEAR_CORRECTION = 5 / 6
# Shear modulus over Young's modulus where the deck gives none: that of a Poisson's ratio of .3.
_SHEAR_RATIO = 1 / 2.6
_SIZES = {"blade": ("height", "thickness"), "t": ("height", "thickness", "cap_width", "cap_thickness")}


@dataclass(frozen=True)
class Section:
    """A section about its centroid: area, second moments against bending out of the plate and about its normal, torsion
    constant, area that carries shear forces out of the plate, mass per length; moduli E and G.

    `eccentricity` is the distance of the centroid from the face, outwards; `web` and `cap` are height and thickness,
    width and thickness, of a section by sizes.
    """

    modulus: float
    shear_modulus: float
    area: float
    bending: float
    lateral: float
    torsion: float
    shear_area: float
    mass: float
    eccentricity: float
    web: tuple[float, float] | None = None
    cap: tuple[float, float] | None = None
    density: float = 0.0


@dataclass(frozen=True)
class Stringer:
    """A beam along x (`axis` 0) or y (1) at the other coordinate `at`, on the struck face (`front`) or the back."""

    name: str
    axis: int
    at: float
    ends: tuple[float, float]
    face: str
    section: Section

    @property
    def outwards(self) -> int:
        """Sign of z from its face outwards."""
        return -1 if self.face == "front" else 1


def torsion_constant(sides: tuple[float, float]) -> float:
    """Return the torsion constant of a rectangle (Roark's Formulas for Stress and Strain, table 10.1)."""
    short, long = sorted(sides)
    ratio = short / long
    return long * short**3 * (1 / 3 - 0.21 * ratio * (1 - ratio**4 / 12))


def section_of_sizes(web: tuple[float, float], cap: tuple[float, float] | None, modulus: float, shear_modulus: float,
                     density: float) -> Section:
    """Return the section of a web, height and thickness, and a cap on its free edge, width and thickness."""
    parts = [(web[0] * web[1], web[0] / 2, web[1] * web[0]**3 / 12, web[0] * web[1]**3 / 12, torsion_constant(web))]
    if cap is not None:
        parts.append((cap[0] * cap[1], web[0] + cap[1] / 2, cap[0] * cap[1]**3 / 12, cap[1] * cap[0]**3 / 12,
                      torsion_constant(cap)))
    area = sum(part[0] for part in parts)
    centroid = sum(part[0] * part[1] for part in parts) / area
    bending = sum(part[2] + part[0] * (part[1] - centroid)**2 for part in parts)
    lateral, torsion = (sum(part[place] for part in parts) for place in (3, 4))
    return Section(modulus, shear_modulus, area, bending, lateral, torsion, SHEAR_CORRECTION * parts[0][0],
                   density * area, centroid, web, cap, density)


def stringers_of(deck: Deck, modulus: float) -> tuple[Stringer, ...]:
    """Return the stringers of a deck; `modulus` is that of given sections without E."""
    return tuple(_stringers(deck, modulus))


def _stringers(deck: Deck, modulus: float) -> Iterator[Stringer]:
    """Return each stringer."""
    lengths = deck.lengths()
    for place, group in enumerate(deck.groups.get("stringer", []), 1):
        def number(key: str, default: float | None = None, group: Group = group) -> float:
            value = deck.single(group.get(key.lower(), []), "stringer", key, default)
            return as_number(value, f"{deck.path.name}: &stringer {key}")

        def word(key: str, allowed: tuple[str, ...], group: Group = group) -> str:
            value = str(deck.single(group.get(key, []), "stringer", key, allowed[0])).lower()
            if value not in allowed:
                raise deck.error("stringer", f"{key} = '{value}' is not one of {', '.join(allowed)}.")
            return value

        axis = ("x", "y").index(word("along", ("x", "y")))
        half = lengths[axis] / 2
        ends = number("from", -half), number("to", half)
        at = number("at", 0.0)
        name = str(deck.single(group.get("name", []), "stringer", "name", str(place)))
        near = 1e-6 * max(lengths)
        if not -half - near <= ends[0] < ends[1] <= half + near or abs(at) > lengths[1 - axis] / 2 + near:
            raise deck.error("stringer", f"'{name}' does not lie on the plate.")
        kind = word("section", ("blade", "t", "given"))
        face = word("face", ("back", "front"))
        yield Stringer(name, axis, at, ends, face, _section(deck, name, kind, number, modulus))


def _section(deck: Deck, name: str, kind: str, number: Callable[..., float], modulus: float) -> Section:
    """Return the section of a stringer."""
    if kind == "given":
        axial, bending, torsion = (number(key) for key in ("EA", "EI", "GJ"))
        young = number("E", modulus)
        shear = number("G", young * _SHEAR_RATIO)
        _check(deck, name, axial, bending, torsion, young, shear)
        return Section(young, shear, axial / young, bending / young, number("EI_lateral", 0.0) / young, torsion / shear,
                       SHEAR_CORRECTION * axial / young, number("mass_per_length", 0.0), number("eccentricity", 0.0))
    sizes = [number(key) for key in _SIZES[kind]]
    young = number("E")
    shear = number("G", young * _SHEAR_RATIO)
    _check(deck, name, *sizes, young, shear)
    return section_of_sizes((sizes[0], sizes[1]), (sizes[2], sizes[3]) if kind == "t" else None, young, shear,
                            number("density", 0.0))


def _check(deck: Deck, name: str, *values: float) -> None:
    """Refuse values that are not greater than zero."""
    if min(values) <= 0:
        raise deck.error("stringer", f"sizes, moduli and stiffness of '{name}' must be greater than zero.")
