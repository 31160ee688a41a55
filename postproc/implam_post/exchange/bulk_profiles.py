"""Sections of beams from bulk data: PBAR, PBARL, PBEAM and PBEAML."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from implam_post.exchange.bulk_cards import BulkCard
from implam_post.exchange.bulk_data import BulkData
from implam_post.exchange.remarks import Remarks
from implam_post.exchange.stringers import SHEAR_CORRECTION, torsion_constant
from implam_post.io.errors import DeckError

# Properties by element.
PROPERTIES = {"CBAR": ("PBAR", "PBARL"), "CBEAM": ("PBEAM", "PBEAML")}


class NoStringer(Exception):  # noqa: N818
    """Why a beam cannot be a stringer of a deck, as the rest of a sentence."""


@dataclass(frozen=True)
class Profile:
    """A section about its centroid: area, second moments in the planes 1 and 2 of the element, torsion constant, areas
    that carry shear in these planes (None: no shear deformation), coordinates y and z of the centroid from the axis of
    the element; moduli, density and mass per length.

    `sizes` are those of a rectangle, width along z and height along y, or of a T: width and thickness of the flange,
    height and thickness of the web; `flange` is the side of y where the flange is.
    """

    area: float
    moments: tuple[float, float]
    torsion: float
    shear_areas: tuple[float | None, float | None]
    modulus: float
    shear_modulus: float
    density: float
    mass: float
    centroid: tuple[float, float] = (0.0, 0.0)
    sizes: tuple[float, ...] = ()
    flange: int = 0


def read_profile(bulk: BulkData, card: BulkCard, remarks: Remarks) -> Profile:
    """Return the section of a property; raise NoStringer if it is not uniform or of a type that is not read."""
    from pyNastran.bdf.cards.properties.bars import PBAR, PBARL
    from pyNastran.bdf.cards.properties.beam import PBEAM, PBEAML
    kinds = {"PBAR": PBAR, "PBARL": PBARL, "PBEAM": PBEAM, "PBEAML": PBEAML}
    read = bulk.read(card, kinds[card.name])
    modulus, shear, density = _material(bulk, read.mid, card)
    parts = {"PBAR": _of_bar, "PBARL": _of_sizes, "PBEAM": _of_beam, "PBEAML": _of_sizes}[card.name](read)
    if min(parts["area"], parts["moments"][0], parts["moments"][1], parts["torsion"]) < 0 or parts["area"] <= 0:
        raise card.error("A must be greater than zero, and I1, I2 and J must not be negative.")
    if parts.pop("product"):
        remarks.add(card, "I12 is ignored: the skin prevents bending along it")
    extra = parts.pop("extra")
    if min(extra, density) < 0:
        raise card.error("NSM and RHO must not be negative.")
    return Profile(modulus=modulus, shear_modulus=shear, density=0.0 if extra else density * bulk.mass_factor,
                   mass=(density * parts["area"] + extra) * bulk.mass_factor, **parts)


def _material(bulk: BulkData, number: int, user: BulkCard) -> tuple[float, float, float]:
    """Return E, G and RHO of a MAT1."""
    from pyNastran.bdf.cards.materials import MAT1
    card = next((card for card in bulk.named("MAT1") if bulk.integer(card, 1) == number), None)
    if card is None:
        raise NoStringer(f"the {user.name} in line {user.line} has no MAT1 with number {number}")
    e, g, nu = (bulk.real(card, field) for field in (2, 3, 4))
    e = 2 * (1 + nu) * g if e is None and None not in (g, nu) else e
    g = e / (2 * (1 + nu)) if g is None and None not in (e, nu) else g
    if not e or not g or min(e, g) <= 0:
        raise card.error("two of E, G and NU are needed, E and G greater than zero.")
    return e, g, bulk.read(card, MAT1).rho or 0.0


def _of_bar(read: Any) -> dict[str, Any]:
    """Return the section of a PBAR, in which a blank K1 or K2 stands for no shear deformation."""
    return {"area": read.A, "moments": (read.i1, read.i2), "torsion": read.j, "extra": read.nsm, "product": read.i12,
            "shear_areas": tuple(factor * read.A if factor and factor < _RIGID else None
                                 for factor in (read.k1, read.k2))}


# Shear factors above this one stand for no shear deformation.
_RIGID = 1e3


def _of_beam(read: Any) -> dict[str, Any]:
    """Return the section of a PBEAM, which must not be tapered; the centroid is at N1, N2."""
    for values in (read.A, read.i1, read.i2, read.j, read.nsm):
        if max(values) - min(values) > 1e-6 * max(map(abs, values)):
            raise NoStringer("its section is tapered")
    if read.n1a != read.n1b or read.n2a != read.n2b:
        raise NoStringer("its section is tapered")
    return {"area": read.A[0], "moments": (read.i1[0], read.i2[0]), "torsion": read.j[0], "extra": read.nsm[0],
            "product": read.i12[0], "centroid": (read.n1a, read.n2a),
            "shear_areas": tuple(factor * read.A[0] if factor else None for factor in (read.k1, read.k2))}


def _of_sizes(read: Any) -> dict[str, Any]:
    """Return the section of a PBARL or PBEAML. That of a PBARL has its centroid at the axis of the element; the axis of
    a PBEAML is its shear centre.
    """
    is_beam = read.type == "PBEAML"
    sizes, extra = (read.dim[0], read.nsm[0]) if is_beam else (read.dim, read.nsm)
    if is_beam and any(list(other) != list(sizes) for other in read.dim[1:]):
        raise NoStringer("its section is tapered")
    kind = read.Type
    if kind not in _SHAPES:
        raise NoStringer(f"TYPE {kind} is not read, but {', '.join(_SHAPES)}: give A, I1, I2 and J as a "
                         f"{'PBEAM' if is_beam else 'PBAR'}")
    section = _SHAPES[kind](*map(float, sizes))
    shear_centre = section.pop("shear_centre")
    if is_beam:
        section["centroid"] = (section["centroid"] - shear_centre, 0.0)
    else:
        section["centroid"] = (0.0, 0.0)
    return section | {"extra": extra, "product": 0.0}


def _bar(width: float, height: float) -> dict[str, Any]:
    """Return a rectangle: DIM1 along z, DIM2 along y."""
    return _of_rectangles([(0.0, height, width)], width * height, width * height) | {"sizes": (width, height)}


def _flanged(side: int) -> Callable[..., dict[str, Any]]:
    """Return the section of a T with its flange at the upper (1) or lower (-1) side of y: width of the flange, total
    height, thickness of the flange and of the web. The shear centre is in the middle of the flange.
    """
    def section(width: float, total: float, flange: float, web: float) -> dict[str, Any]:
        height = total - flange
        found = _of_rectangles([(0.0, flange, width), (-side * total / 2, height, web)], height * web, flange * width)
        return found | {"sizes": (width, flange, height, web), "flange": side, "shear_centre": 0.0}
    return section


def _i(total: float, lower: float, upper: float, web: float, lower_flange: float, upper_flange: float
       ) -> dict[str, Any]:
    """Return an I: height, widths of the lower and upper flange, thickness of the web and of these flanges."""
    height = total - lower_flange - upper_flange
    rise = total - (lower_flange + upper_flange) / 2
    found = _of_rectangles([(0.0, lower_flange, lower), ((height + lower_flange) / 2, height, web),
                            (rise, upper_flange, upper)], height * web, lower_flange * lower + upper_flange * upper)
    stiffness = upper_flange * upper**3, lower_flange * lower**3
    return found | {"shear_centre": rise * stiffness[0] / sum(stiffness)}


def _i1(flanges: float, web: float, height: float, total: float) -> dict[str, Any]:
    """Return an I with equal flanges: their width beside the web, thickness and height of the web, total height."""
    flange = (total - height) / 2
    return _i(total, flanges + web, flanges + web, web, flange, flange)


def _box(width: float, height: float, horizontal: float, vertical: float) -> dict[str, Any]:
    """Return a box: width along z, height along y, thickness of the walls along z and of those along y."""
    found = _of_rectangles([((horizontal - height) / 2, horizontal, width), ((height - horizontal) / 2, horizontal,
                                                                            width),
                            (0.0, height - 2 * horizontal, 2 * vertical)], 2 * vertical * (height - 2 * horizontal),
                           2 * horizontal * width)
    inside = width - 2 * vertical, height - 2 * horizontal
    found["moments"] = (found["moments"][0], (height * width**3 - inside[1] * inside[0]**3) / 12)
    # Bredt's formula of a closed thin wall.
    middle = width - vertical, height - horizontal
    return found | {"torsion": 2 * (middle[0] * middle[1])**2 / (middle[0] / horizontal + middle[1] / vertical)}


def _rod(radius: float) -> dict[str, Any]:
    """Return a circle."""
    return _tube(radius, 0.0)


def _tube(outer: float, inner: float) -> dict[str, Any]:
    """Return a tube; its shear correction is that of a circle (.9) or, as thin as pyNastran has it, of a tube (.5)."""
    area = math.pi * (outer**2 - inner**2)
    moment = math.pi * (outer**4 - inner**4) / 4
    share = (0.5 if inner else 0.9) * area
    return {"area": area, "moments": (moment, moment), "torsion": 2 * moment, "shear_areas": (share, share),
            "centroid": 0.0, "shear_centre": 0.0}


_SHAPES: dict[str, Callable[..., dict[str, Any]]] = {
    "BAR": _bar, "T": _flanged(1), "T2": _flanged(-1), "I": _i, "I1": _i1, "BOX": _box, "ROD": _rod, "TUBE": _tube}


def _of_rectangles(parts: Sequence[tuple[float, float, float]], webs: float, flanges: float) -> dict[str, Any]:
    """Return the section of rectangles above each other: y of the centre, side along y, side along z.

    `webs` and `flanges` are the areas that carry shear along y and along z.
    """
    for part in parts:
        if min(part[1:]) <= 0:
            raise DeckError("dimensions must be greater than zero and flanges thinner than the height.")
    areas = [height * width for _, height, width in parts]
    area = sum(areas)
    centroid = sum(each * part[0] for each, part in zip(areas, parts, strict=True)) / area
    first = sum(width * height**3 / 12 + each * (y - centroid)**2
                for each, (y, height, width) in zip(areas, parts, strict=True))
    second = sum(height * width**3 / 12 for _, height, width in parts)
    return {"area": area, "moments": (first, second), "torsion": sum(torsion_constant(part[1:]) for part in parts),
            "shear_areas": (SHEAR_CORRECTION * webs, SHEAR_CORRECTION * flanges), "centroid": centroid,
            "shear_centre": centroid}
