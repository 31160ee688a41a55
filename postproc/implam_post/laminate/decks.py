"""The laminate of a deck: materials and plies, numbered from the struck face, stiffness and mass."""

from implam_post.io.deck import Deck, as_number
from implam_post.io.errors import DeckError
from implam_post.io.namelist import Group, Value
from implam_post.laminate.sections import Material, Ply, Section, natural_shear_correction, section_of
from implam_post.laminate.stacking import angles_of

STRENGTHS = ("XT", "XC", "YT", "YC", "S12", "Sf", "Sm23")


def plies_of(deck: Deck) -> list[Ply]:
    """Return the stacking sequence from the struck face on."""
    materials = materials_of(deck)
    angles, thicknesses = _stack(deck)
    names, thicknesses = (deck.spread(values, len(angles), "laminate")
                          for values in (deck.values("laminate", "materials"), thicknesses))
    where = f"{deck.path.name}: &laminate"
    plies = []
    for name, angle, thickness in zip(names, angles, thicknesses, strict=True):
        if str(name).lower() not in materials:
            raise deck.error("laminate", f"no &material is named '{name}'.")
        plies.append(Ply(materials[str(name).lower()], as_number(angle, f"{where} angles"),
                         as_number(thickness, f"{where} thicknesses")))
    if not plies:
        raise deck.error("laminate", "angles are required, one for each ply.")
    if min(ply.thickness for ply in plies) <= 0:
        raise deck.error("laminate", "every thickness must be greater than zero.")
    return plies


def uniform_plies_of(deck: Deck) -> list[Ply]:
    """Return the stacking sequence of a plate that has the same plies everywhere."""
    for group in ("doubler", "ply_drop"):
        if deck.has(group):
            raise deck.error(group, "a plate with different plies in different places is not supported here; leave "
                                    "doublers and ply drops out.")
    return plies_of(deck)


def section_of_deck(deck: Deck) -> Section:
    """Return stiffness and mass of the laminate."""
    plies = uniform_plies_of(deck)
    allowed = dict.fromkeys((natural_shear_correction(plies), "5/6", "energy"))
    return section_of(plies, deck.choice("laminate", "shear_correction", allowed))


def _stack(deck: Deck) -> tuple[list[Value], list[Value]]:
    """Return the angles of all plies, and their thicknesses or a single thickness."""
    if not (deck.values("laminate", "stacking") or deck.values("laminate", "ply_thickness")):
        return deck.values("laminate", "angles"), deck.values("laminate", "thicknesses")
    if deck.values("laminate", "angles") or deck.values("laminate", "thicknesses"):
        raise deck.error("laminate", "either stacking and ply_thickness or angles and thicknesses are required.")
    try:
        angles = angles_of(str(deck.value("laminate", "stacking")))
    except DeckError as error:
        raise deck.error("laminate", str(error)) from None
    return [*angles], deck.values("laminate", "ply_thickness")


def materials_of(deck: Deck) -> dict[str, Material]:
    """Return the materials by their name in lower case."""
    materials = {}
    for group in deck.groups.get("material", []):
        name = str(deck.single(group.get("name", []), "material", "name", "")).lower()
        if name in materials:
            raise deck.error("material", f"two materials are named '{name}'.")
        materials[name] = _material(deck, group)
    return materials


def bending_modulus(tension: float, compression: float) -> float:
    """Return the one modulus of a beam in bending that has two moduli, or the modulus itself if both are equal."""
    if tension == compression or min(tension, compression) <= 0:
        return tension
    return float(4 * tension * compression / (tension**0.5 + compression**0.5) ** 2)


def _material(deck: Deck, group: Group) -> Material:
    """Return one ply material, isotropic if the group gives E and nu."""
    def number(key: str, default: float | None = None) -> float:
        where = f"{deck.path.name}: &material {key}"
        # A default of 0 is the density in a static deck, which does not use it.
        if key.lower() not in group and "library" in group and not deck.has_adopted and default != 0:
            raise deck.error("material", f"{key} comes from library = {group['library'][0]!r}, whose values only the "
                                         "program has: give it in the deck, or give NAME.h5 of a run.")
        return as_number(deck.single(group.get(key.lower(), []), "material", key, default), where)

    moves = deck.has("time") or deck.has("impactor")
    density = number("density", None if moves else 0.0)
    name = str(deck.single(group.get("name", []), "material", "name", ""))
    strengths = tuple((key, number(key)) for key in STRENGTHS if key.lower() in group)
    expansion = number("alpha1", 0.0), number("alpha2", 0.0)
    if "e" in group:
        modulus, ratio = number("E"), number("nu")
        shear = modulus / (2 * (1 + ratio))
        material = Material(density, modulus, modulus, shear, shear, shear, ratio, name, strengths, isotropic=True,
                            expansion=expansion)
    else:
        shear = number("G12")
        tension = number("E1")
        along = bending_modulus(tension, number("E1c", tension))
        material = Material(density, along, number("E2"), shear, number("G13", shear), number("G23"),
                            number("nu12") * along / tension if tension else 0.0, name, strengths, expansion=expansion)
    if min(material.e1, material.e2, material.g12, material.g13, material.g23) <= 0 or (
            density < 0 or (moves and density == 0)):
        raise deck.error("material", "density and moduli must be greater than zero.")
    if material.nu12**2 * material.e2 >= material.e1:
        raise deck.error("material", "nu12**2 must be smaller than E1/E2.")
    return material
