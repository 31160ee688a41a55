"""The deck: what its groups say about plate, laminate, impactor and indentation."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from implam_post.errors import DeckError
from implam_post.files import read_text
from implam_post.indentation import IndentationLaw
from implam_post.laminate import Material, Ply, Section, natural_shear_correction, section_of
from implam_post.namelist import Group, Value, read_namelist
from implam_post.stacking import angles_of

STRENGTHS = ("XT", "XC", "YT", "YC", "S12", "Sf", "Sm23")


@dataclass(frozen=True)
class Impactor:
    """The rigid impactor; its velocity at first touch is positive towards the plate."""

    mass: float
    velocity: float
    gravity: float


class Deck:
    """The groups of a deck, with its defaults filled in."""

    def __init__(self, text: str, path: Path, adopted: str = "") -> None:
        """Read the groups from `text`; `path` names the deck in messages.

        `adopted` lists values that published materials gave in a run, a line each: &material 1 E1 = 130e9 [source].
        """
        self.path = path
        self.groups = read_namelist(text, path.name)
        for group, place, key, value in re.findall(r"&(\w+) (\d+) (\w+) = (\S+) \[", adopted):
            given = read_namelist(f"&{group} {key}={value} /", path.name)[group][0]
            self.groups[group][int(place) - 1] = given | self.groups[group][int(place) - 1]

    @property
    def name(self) -> str:
        """Name of the case, from which those of the results are made."""
        return str(self.value("case", "name", self.path.stem))

    @property
    def directory(self) -> Path:
        """Folder of the results."""
        return Path(str(self.value("output", "directory", ".")))

    def has(self, group: str) -> bool:
        """Tell whether the deck has a group of this name."""
        return group in self.groups

    def values(self, group: str, key: str) -> list[Value]:
        """Return all values of a key; empty if the deck doesn't give it."""
        found = self.groups.get(group, [])
        if len(found) > 1:
            raise self.error(group, "stands in the deck more than once.")
        return found[0].get(key.lower(), []) if found else []

    def value(self, group: str, key: str, default: Value | None = None) -> Value:
        """Return the value of a key, or `default` if the deck doesn't give it; no default means it must be there."""
        return self._single(self.values(group, key), group, key, default)

    def number(self, group: str, key: str, default: float | None = None) -> float:
        """Return a number, as `value` does."""
        return as_number(self.value(group, key, default), f"{self.path.name}: &{group} {key}")

    def numbers(self, group: str, key: str) -> list[float]:
        """Return all values of a key as numbers; empty if the deck doesn't give it."""
        return [as_number(value, f"{self.path.name}: &{group} {key}") for value in self.values(group, key)]

    def choice(self, group: str, key: str, allowed: Iterable[str]) -> str:
        """Return a word out of `allowed`, the first of which is the default."""
        allowed = list(allowed)
        word = str(self.value(group, key, allowed[0])).lower()
        if word not in allowed:
            raise self.error(group, f"{key} = '{word}' is none of {', '.join(allowed)}.")
        return word

    def lengths(self) -> tuple[float, float]:
        """Return the sides of the whole plate along x and y."""
        sides = self.numbers("plate", "length")
        if len(sides) != 2 or min(sides) <= 0:
            raise self.error("plate", "length needs the two sides of the plate, greater than zero.")
        return sides[0], sides[1]

    def edges(self) -> list[str]:
        """Return the supports at x-min, x-max, y-min and y-max."""
        return [str(edge).lower() for edge in self._spread(self.values("plate", "edges"), 4, "plate")]

    def plies(self) -> list[Ply]:
        """Return the stacking sequence from the struck face on."""
        materials = self._materials()
        angles, thicknesses = self._stack()
        names, thicknesses = (self._spread(values, len(angles), "laminate")
                              for values in (self.values("laminate", "materials"), thicknesses))
        where = f"{self.path.name}: &laminate"
        plies = []
        for name, angle, thickness in zip(names, angles, thicknesses, strict=True):
            if str(name).lower() not in materials:
                raise self.error("laminate", f"no &material is named '{name}'.")
            plies.append(Ply(materials[str(name).lower()], as_number(angle, f"{where} angles"),
                             as_number(thickness, f"{where} thicknesses")))
        if not plies:
            raise self.error("laminate", "angles are needed, one a ply.")
        if min(ply.thickness for ply in plies) <= 0:
            raise self.error("laminate", "every thickness must be greater than zero.")
        return plies

    def section(self) -> Section:
        """Return stiffness and mass of the laminate."""
        plies = self.plies()
        allowed = dict.fromkeys((natural_shear_correction(plies), "5/6", "energy"))
        return section_of(plies, self.choice("laminate", "shear_correction", allowed))

    def impactor(self) -> Impactor:
        """Return the impactor."""
        if not self.has("impactor"):
            raise DeckError(f"{self.path.name} has no &impactor: there is no impact to check.")
        mass = self.number("impactor", "mass")
        if mass <= 0:
            raise self.error("impactor", "the mass must be greater than zero.")
        if not self.values("impactor", "energy"):
            return Impactor(mass, self.number("impactor", "velocity"), self.number("impactor", "gravity", 0.0))
        energy = self.number("impactor", "energy")
        if self.values("impactor", "velocity") or energy < 0:
            raise self.error("impactor", "velocity or energy, one of them, is needed, and not below zero.")
        return Impactor(mass, float(np.sqrt(2 * energy / mass)), self.number("impactor", "gravity", 0.0))

    def indentation_law(self) -> IndentationLaw:
        """Return the indentation law, elastic if the deck has no &indentation; k by Sun's formula if none is given."""
        stiffness = self.number("indentation", "k") if self.values("indentation", "k") else self._sun_stiffness()
        if stiffness <= 0:
            raise self.error("indentation", "k must be greater than zero.")
        if not self.has("indentation") or self.choice("indentation", "law", ("tan_sun", "hertz")) == "hertz":
            return IndentationLaw(stiffness, hertz=True)
        law = IndentationLaw(
            stiffness, unloading=self.number("indentation", "q", 2.5),
            reloading=self.number("indentation", "reload", 1.5), slope=self.number("indentation", "beta", 0.094),
            critical=self.number("indentation", "alpha_cr"),
            dent=self.choice("indentation", "dent", ("tan_sun", "yang_sun")))
        if not (1.5 <= law.reloading <= law.unloading and 0 <= law.slope < 1 and law.critical > 0):
            raise self.error("indentation", "1.5 <= reload <= q, 0 <= beta < 1 and 0 < alpha_cr are needed.")
        return law

    def error(self, group: str, sentence: str) -> DeckError:
        """Return an error that names deck and group."""
        return DeckError(f"{self.path.name}: &{group}: {sentence}")

    def _stack(self) -> tuple[list[Value], list[Value]]:
        """Return angles, one a ply, and thicknesses, one a ply or one for all."""
        if not (self.values("laminate", "stacking") or self.values("laminate", "ply_thickness")):
            return self.values("laminate", "angles"), self.values("laminate", "thicknesses")
        if self.values("laminate", "angles") or self.values("laminate", "thicknesses"):
            raise self.error("laminate", "stacking and ply_thickness, or angles and thicknesses, are needed.")
        try:
            angles = angles_of(str(self.value("laminate", "stacking")))
        except DeckError as error:
            raise self.error("laminate", str(error)) from None
        return [*angles], self.values("laminate", "ply_thickness")

    def _sun_stiffness(self) -> float:
        """Return k = 4/3 sqrt(R) / [(1 - nu**2)/E + 1/E2]: E and nu of the impactor (no E: rigid), E2 of ply 1."""
        radius = self.number("impactor", "radius", 0.0)
        if radius <= 0:
            raise self.error("indentation", "without k, the &impactor needs a radius.")
        flexibility = 1 / self.plies()[0].material.e2
        if self.values("indentation", "impactor_E"):
            ratio = self.number("indentation", "impactor_nu", 0.3)
            flexibility += (1 - ratio**2) / self.number("indentation", "impactor_E")
        return 4.0 / 3.0 * np.sqrt(radius) / flexibility

    def _materials(self) -> dict[str, Material]:
        """Return the materials by their name in lower case."""
        materials = {}
        for group in self.groups.get("material", []):
            name = str(self._single(group.get("name", []), "material", "name", "")).lower()
            if name in materials:
                raise self.error("material", f"two materials are named '{name}'.")
            materials[name] = self._material(group)
        return materials

    def _material(self, group: Group) -> Material:
        """Return one ply material, isotropic if the group gives E and nu."""
        def number(key: str, default: float | None = None) -> float:
            where = f"{self.path.name}: &material {key}"
            return as_number(self._single(group.get(key.lower(), []), "material", key, default), where)

        moves = self.has("time") or self.has("impactor")
        density = number("density", None if moves else 0.0)
        name = str(self._single(group.get("name", []), "material", "name", ""))
        strengths = tuple((key, number(key)) for key in STRENGTHS if key.lower() in group)
        if "e" in group:
            modulus, ratio = number("E"), number("nu")
            shear = modulus / (2 * (1 + ratio))
            material = Material(density, modulus, modulus, shear, shear, shear, ratio, name, strengths, isotropic=True)
        else:
            shear = number("G12")
            material = Material(density, number("E1"), number("E2"), shear, number("G13", shear), number("G23"),
                                number("nu12"), name, strengths)
        if min(material.e1, material.e2, material.g12, material.g13, material.g23) <= 0 or (
                density < 0 or (moves and density == 0)):
            raise self.error("material", "density and moduli must be greater than zero.")
        if material.nu12**2 * material.e2 >= material.e1:
            raise self.error("material", "nu12**2 must be smaller than E1/E2.")
        return material

    def _single(self, values: list[Value], group: str, key: str, default: Value | None) -> Value:
        """Return the only value of a key, or its default."""
        if len(values) > 1:
            raise self.error(group, f"{key} takes one value.")
        if values:
            return values[0]
        if default is None:
            raise self.error(group, f"{key} is needed.")
        return default

    def _spread(self, values: list[Value], count: int, group: str) -> list[Value]:
        """Return `count` values; a single one serves all."""
        if len(values) not in (1, count):
            raise self.error(group, f"a list has {len(values)} values where 1 or {count} are needed.")
        return values if len(values) == count else count * values


def as_number(value: Value, where: str) -> float:
    """Return `value` if it is a finite number."""
    if isinstance(value, (bool, str)) or not np.isfinite(value):
        raise DeckError(f"{where}: {value!r} isn't a number.")
    return value


def recorded_deck(provenance: Mapping[str, Any], path: Path) -> Deck:
    """Return the deck of a run from the provenance in its results, with the values of published materials."""
    deck, adopted = (text if isinstance(text, str) else text[()].decode("utf-8")
                     for text in (provenance["deck"], provenance.get("library", "")))
    return Deck(deck, path, adopted)


def read_deck(path: Path | str) -> Deck:
    """Read the deck from its file."""
    path = Path(path)
    return Deck(read_text(path, "the deck"), path)
