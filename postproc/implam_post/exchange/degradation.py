"""Degraded elastic constants of a ply after failure, as by &ply_damage (Table 2 of Li et al. 2002)."""

import math
from dataclasses import dataclass, replace

from implam_post.io.deck import Deck
from implam_post.laminate.sections import Material

FIBRE, CRACKING, CRUSHING = 1, 2, 4
MODES = {FIBRE: "fibres", CRACKING: "cracked", CRUSHING: "crushed"}


@dataclass(frozen=True)
class Degradation:
    """Divisor of a constant for each mode that affects it, and its lower limit as a fraction of the undamaged value."""

    divisor: float = 100.0
    floor: float = 1e-3

    def left(self, failures: int, touching: int) -> float:
        """Return the remaining fraction of a constant; both arguments are sums of modes."""
        return max(self.divisor ** -(failures & touching).bit_count(), self.floor)

    def degraded(self, material: Material, failures: int) -> Material:
        """Return the material after the modes in `failures`, whose order does not matter.

        Fibre failure affects all constants, cracking E2, nu12 and G12, crushing E2 and nu12.
        """
        if not failures:
            return material
        fibre = self.left(failures, FIBRE)
        shear = self.left(failures, FIBRE | CRACKING)
        matrix = self.left(failures, FIBRE | CRACKING | CRUSHING)
        return replace(material, e1=material.e1 * fibre, e2=material.e2 * matrix, g12=material.g12 * shear,
                       g13=material.g13 * fibre, g23=material.g23 * fibre, nu12=material.nu12 * matrix,
                       strengths=(), isotropic=False)


def degradation_of(deck: Deck) -> Degradation:
    """Return the values of &ply_damage; the defaults if the deck does not have the group."""
    rule = Degradation(deck.number("ply_damage", "d", 100.0), deck.number("ply_damage", "e", 1e-3))
    if not (rule.divisor >= 1 and 0 < rule.floor <= 1 and math.isfinite(rule.divisor)):
        raise deck.error("ply_damage", "d must be at least 1, e greater than 0 and at most 1.")
    return rule


def failed_modes(failures: int) -> str:
    """Return the names of the modes."""
    return " and ".join(word for mode, word in MODES.items() if failures & mode)
