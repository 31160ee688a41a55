"""Elastic constants that failures leave to a ply, as &ply_damage has it (Table 2 of Li et al. 2002)."""

import math
from dataclasses import dataclass, replace

from implam_post.io.deck import Deck
from implam_post.laminate.sections import Material

FIBRE, CRACKING, CRUSHING = 1, 2, 4
MODES = {FIBRE: "fibres", CRACKING: "cracked", CRUSHING: "crushed"}


@dataclass(frozen=True)
class Degradation:
    """Divisor of a constant at each mode that affects it, and its floor as a fraction of the undamaged one."""

    divisor: float = 100.0
    floor: float = 1e-3

    def left(self, failures: int, touching: int) -> float:
        """Return the fraction that is left of a constant; both arguments are sums of modes."""
        return max(self.divisor ** -(failures & touching).bit_count(), self.floor)

    def degraded(self, material: Material, failures: int) -> Material:
        """Return the material once the modes in `failures` have occurred, in whatever order.

        Fibre failure takes all constants, cracking E2, nu12 and G12, crushing E2 and nu12.
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
    """Return the values of &ply_damage; its defaults without the group."""
    rule = Degradation(deck.number("ply_damage", "d", 100.0), deck.number("ply_damage", "e", 1e-3))
    if not (rule.divisor >= 1 and 0 < rule.floor <= 1 and math.isfinite(rule.divisor)):
        raise deck.error("ply_damage", "d must be at least 1, e above 0 and at most 1.")
    return rule


def failed_modes(failures: int) -> str:
    """Return the modes in words."""
    return " and ".join(word for mode, word in MODES.items() if failures & mode)
