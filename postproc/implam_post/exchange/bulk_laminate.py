"""Materials and lay-up from bulk data: MAT1, MAT8, PCOMP and PCOMPG."""

from collections.abc import Iterable
from dataclasses import replace
from itertools import zip_longest
from typing import Any, NamedTuple

from implam_post.exchange.bulk_cards import BulkCard
from implam_post.exchange.bulk_data import BulkData
from implam_post.exchange.remarks import Remarks
from implam_post.laminate.sections import Material, Ply

_MAT8_STRENGTHS = {12: "XT", 13: "XC", 14: "YT", 15: "YC", 16: "S12"}
_IGNORED = {
    "MAT1": {8: "GE", 9: "ST", 10: "SC", 11: "SS", 12: "MCSID"},
    "MAT8": {17: "GE", 18: "F12"},
    "PCOMP": {4: "SB", 5: "FT", 7: "GE"},
    "PCOMPG": {4: "SB", 5: "FT", 7: "GE"},
}
_NEAR = 0.01
# Transverse shear moduli above this multiple of the largest modulus of the laminate stand for a ply without shear
# deformation, which is written with this multiple; that of a core may exceed its own in-plane moduli. Measured: the
# deflection of a clamped plate, ten times as wide as thick, is by 4e-4 larger than without shear deformation, and the
# same to 1e-4 where it is forty times as wide.
_RIGID = 100.0
# Largest ratio of the moduli of one material that is written: a deck accepts 1e6.
_MAX_RATIO = 1e5
# Number of the field in which the first ply of a PCOMP or PCOMPG begins.
_FIRST_PLY = 9


class Laminate(NamedTuple):
    """The plies of a property, from its first one on, and the distance of the outer surface of ply 1 from the reference
    plane, along the normal of the elements.
    """

    card: BulkCard
    plies: list[Ply]
    first_face: float


def read_laminates(bulk: BulkData, properties: Iterable[int], remarks: Remarks, shear_23: float | None = None
                   ) -> dict[int, Laminate]:
    """Return the laminates of the properties of all elements; `shear_23` is used where G2Z is blank."""
    cards = _unique(bulk, "PCOMP", "PCOMPG", "PSHELL")
    found = {}
    for number in sorted(set(properties)):
        if number not in cards:
            raise bulk.missing(f"the elements have property {number}, but there is no PCOMP, PCOMPG or PSHELL of "
                               "that number.")
        plies = _plies(bulk, cards[number], remarks, shear_23)
        z0 = bulk.real(cards[number], 2) if cards[number].name != "PSHELL" else None
        found[number] = Laminate(cards[number], plies, -sum(ply.thickness for ply in plies) / 2 if z0 is None else z0)
    return found


def same_plies(one: Iterable[Ply], other: Iterable[Ply]) -> bool:
    """Return whether two stacks have the same plies; the names of their materials may differ."""
    return all(ply == beside and rest_of(ply.material) == rest_of(beside.material) if ply and beside else False
               for ply, beside in zip_longest(one, other))


def _unique(bulk: BulkData, *names: str) -> dict[int, BulkCard]:
    """Return the cards of these names by their number, which must be unique."""
    cards: dict[int, BulkCard] = {}
    for card in bulk.named(*names):
        number = bulk.integer(card, 1)
        if number in cards:
            raise bulk.error(card, f"number {number} is used by the {cards[number].name} in line "
                                   f"{cards[number].line}.")
        cards[number] = card
    return cards


def _plies(bulk: BulkData, card: BulkCard, remarks: Remarks, shear_23: float | None) -> list[Ply]:
    """Return the plies of a property, both halves of a symmetric one."""
    if card.name == "PSHELL":
        return [_only_ply(bulk, card, remarks, shear_23)]
    from pyNastran.bdf.cards.properties.shell import PCOMP, PCOMPG
    if len(card.fields) < _FIRST_PLY + 1:
        raise bulk.error(card, "it has no plies: give them on continuations, from the second field on.")
    material = _FIRST_PLY if card.name == "PCOMP" else _FIRST_PLY + 1
    for number, key in ((material, "MID1"), (material + 1, "T1")):
        if card.fields.field(number) is None:
            raise bulk.error(card, f"{key} is blank: only plies after the first one inherit that of the preceding ply.")
    laminate = bulk.read(card, PCOMP if card.name == "PCOMP" else PCOMPG)
    if card.name == "PCOMPG":
        _refuse_repeated(bulk, card, [*laminate.global_ply_ids])
    symmetric = (laminate.lam or "") == "SYM" and card.name == "PCOMP"
    if laminate.lam and not symmetric:
        raise bulk.error(card, f"LAM = {laminate.lam} is not supported: give all plies of the laminate, or half of "
                               "them with SYM on a PCOMP.")
    materials = _materials(bulk, {*laminate.mids}, card, remarks, shear_23)
    plies = [Ply(materials[mid], float(angle), float(thickness))
             for mid, angle, thickness in zip(laminate.mids, laminate.thetas, laminate.thicknesses, strict=True)]
    if symmetric:
        plies += plies[::-1]
    if min(ply.thickness for ply in plies) <= 0:
        raise bulk.error(card, "every ply needs a thickness greater than zero.")
    remarks.ignored(card, _IGNORED[card.name])
    thickness = sum(ply.thickness for ply in plies)
    plies = _with_nonstructural_mass(bulk, card, plies, thickness, remarks)
    return plies


def _refuse_repeated(bulk: BulkData, card: BulkCard, global_plies: list[int]) -> None:
    """Refuse a PCOMPG that has a global ply twice, which Nastran does not accept."""
    for number in global_plies:
        if global_plies.count(number) > 1:
            raise bulk.error(card, f"global ply {number} is given twice: each GPLYIDi of a PCOMPG is unique.")


def _only_ply(bulk: BulkData, card: BulkCard, remarks: Remarks, shear_23: float | None) -> Ply:
    """Return the ply that is equivalent to a PSHELL of one material."""
    from pyNastran.bdf.cards.properties.shell import PSHELL
    shell = bulk.read(card, PSHELL)
    first = shell.mid1
    if first is None or shell.mid2 != first or shell.mid3 not in (None, first) or shell.mid4 is not None:
        raise bulk.error(card, ("MID2 is blank, a membrane without bending stiffness: give MID2 = MID1."
                                if first is not None and shell.mid2 is None else
                                "MID1, MID2 and MID3 must be one material and MID4 blank: give other sections as a "
                                "PCOMP."))
    if abs(shell.twelveIt3 - 1) > 1e-6:
        raise bulk.error(card, "12I/T**3 is not 1: give the plies of the section as a PCOMP.")
    if shell.t is None or shell.t <= 0:
        raise bulk.error(card, "T must be greater than zero.")
    if shell.mid3 is None:
        remarks.add(card, "MID3 is blank: Implam uses the transverse shear stiffness of the material")
    elif abs(shell.tst - 5 / 6) > _NEAR:
        remarks.add(card, "TS/T is ignored: Implam uses 5/6")
    ply = Ply(_materials(bulk, {first}, card, remarks, shear_23)[first], 0.0, float(shell.t))
    return _with_nonstructural_mass(bulk, card, [ply], ply.thickness, remarks, 8)[0]


def _with_nonstructural_mass(bulk: BulkData, card: BulkCard, plies: list[Ply], thickness: float, remarks: Remarks,
                             field: int = 3) -> list[Ply]:
    """Return plies whose densities include NSM, the non-structural mass per area, distributed over the thickness."""
    extra = (bulk.real(card, field) or 0.0) * bulk.mass_factor / thickness
    if extra == 0:
        return plies
    if extra < 0:
        raise bulk.error(card, "NSM must not be negative.")
    remarks.add(card, f"NSM is distributed over the plies: {extra:.5g} is added to their densities")
    return [replace(ply, material=replace(ply.material, density=ply.material.density + extra)) for ply in plies]


def _materials(bulk: BulkData, numbers: Iterable[int], user: BulkCard, remarks: Remarks, shear_23: float | None
               ) -> dict[int, Material]:
    """Return the materials of these numbers."""
    cards = _unique(bulk, "MAT1", "MAT8", "MAT2", "MAT3", "MAT9", "MAT11", "MATORT")
    for number in numbers:
        if number not in cards:
            raise bulk.error(user, f"there is no MAT1 or MAT8 with number {number}.")
        if cards[number].name not in ("MAT1", "MAT8"):
            raise bulk.error(cards[number], f"it is not a material of plies, which the {user.name} in line {user.line} "
                                            "needs: give E1, E2, NU12, G12, G1Z and G2Z as a MAT8.")
    numbers = list(numbers)
    stiffest = max(_stiffness(bulk, cards[number]) for number in numbers)
    return {number: _isotropic(bulk, cards[number], remarks) if cards[number].name == "MAT1"
            else _orthotropic(bulk, cards[number], remarks, shear_23, stiffest) for number in numbers}


def _stiffness(bulk: BulkData, card: BulkCard) -> float:
    """Return the largest in-plane modulus of a MAT1 or MAT8."""
    from pyNastran.bdf.cards.materials import MAT1, MAT8
    if card.name == "MAT1":
        return float(bulk.read(card, MAT1).e or 0.0)
    found = bulk.read(card, MAT8)
    return max(float(found.e11), float(found.e22))


def _isotropic(bulk: BulkData, card: BulkCard, remarks: Remarks) -> Material:
    """Return the material of a MAT1; one of E, G and NU may be blank."""
    from pyNastran.bdf.cards.materials import MAT1
    found = bulk.read(card, MAT1)
    e, g, nu = (bulk.real(card, number) for number in (2, 3, 4))
    e = 2 * (1 + nu) * g if e is None and None not in (g, nu) else e
    nu = e / (2 * g) - 1 if nu is None and None not in (e, g) else nu
    if e is None or nu is None or e <= 0 or not -1 < nu < 0.5:
        raise bulk.error(card, "two of E, G and NU are needed, E greater than zero, NU above -1 and below 0.5.")
    shear = e / (2 * (1 + nu))
    if g is not None and abs(g - shear) > _NEAR * shear:
        raise bulk.error(card, f"G = {g:g} contradicts E and NU, which give {shear:.5g}.")
    if g is not None and card.given(2) and card.given(4) and abs(g - shear) > 1e-6 * shear:
        remarks.add(card, f"G is ignored: E and NU give {shear:.5g}")
    remarks.ignored(card, _IGNORED["MAT1"])
    expansion = bulk.real(card, 6) or 0.0
    return Material(_density(bulk, card, found.rho, remarks), e, e, shear, shear, shear, nu, _name(card),
                    isotropic=True, expansion=(expansion, expansion))


def _absent(bulk: BulkData, card: BulkCard, number: int) -> str:
    """Return 'blank' or '0' for a field without a value."""
    return "blank" if bulk.real(card, number) is None else "0"


def _orthotropic(bulk: BulkData, card: BulkCard, remarks: Remarks, shear_23: float | None, stiffest: float) -> Material:
    """Return the material of a MAT8; `stiffest` is the largest in-plane modulus of the laminate."""
    from pyNastran.bdf.cards.materials import MAT8
    found = bulk.read(card, MAT8)
    g13, g23 = (bulk.real(card, number) for number in (6, 7))
    if not g23 and shear_23 is None:
        raise bulk.error(card, "G2Z is required, on the card or with --g2z; without it the ply is rigid in "
                               "transverse shear.")
    if not g23:
        remarks.add(card, f"G2Z is {_absent(bulk, card, 7)}: {shear_23:g} of --g2z is used")
        g23 = shear_23
    if not g13:
        remarks.add(card, f"G1Z is {_absent(bulk, card, 6)}: G12 is used")
        g13 = found.g12
    limit = _RIGID * stiffest
    written = min(limit, _MAX_RATIO * min(found.e11, found.e22, found.g12))
    g13, g23 = (_finite_shear(card, key, modulus, limit, written, remarks)
                for key, modulus in (("G1Z", g13), ("G2Z", g23)))
    if min(found.e11, found.e22, found.g12, g13, g23) <= 0:
        raise bulk.error(card, "E1, E2, G12, G1Z and G2Z must be greater than zero.")
    if found.nu12**2 * found.e22 >= found.e11:
        raise bulk.error(card, "NU12 squared must be smaller than E1/E2.")
    if card.fields.field(4) is None:
        remarks.add(card, "NU12 is blank: 0 is used")
    remarks.ignored(card, _IGNORED["MAT8"] | (_MAT8_STRENGTHS if card.given(19) else {}))
    strengths = () if card.given(19) else tuple(
        (key, abs(bulk.real(card, number))) for number, key in _MAT8_STRENGTHS.items() if card.given(number))
    return Material(_density(bulk, card, found.rho, remarks), found.e11, found.e22, found.g12, g13, g23, found.nu12,
                    _name(card), strengths, expansion=(bulk.real(card, 9) or 0.0, bulk.real(card, 10) or 0.0))


def _finite_shear(card: BulkCard, key: str, modulus: float, limit: float, written: float, remarks: Remarks) -> float:
    """Return a transverse shear modulus; one that excludes shear deformation is reduced to what a deck can have."""
    if not modulus > limit or written <= 0:
        return modulus
    remarks.add(card, f"{key} = {modulus:g} is taken as no transverse shear deformation: {written:g} has the same "
                      "effect and is written; an impact needs the modulus of the material")
    return written


def rest_of(material: Material) -> tuple[object, ...]:
    """Return the fields in which equal materials may differ."""
    return material.strengths, material.expansion


def _density(bulk: BulkData, card: BulkCard, density: Any, remarks: Remarks) -> float:
    """Return the density; 0 if RHO is blank."""
    if density < 0:
        raise bulk.error(card, "RHO must not be negative.")
    if density == 0:
        remarks.add(card, "RHO is blank: an impact needs the density")
    return float(density) * bulk.mass_factor


def _name(card: BulkCard) -> str:
    """Return the name of the material in the deck."""
    return f"{card.name}_{card.fields.field(1)}"
