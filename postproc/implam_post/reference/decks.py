"""Impactor and indentation law of a deck."""

from dataclasses import dataclass

import numpy as np

from implam_post.io.deck import Deck
from implam_post.io.errors import DeckError
from implam_post.io.shapes import curvatures_of
from implam_post.laminate.decks import plies_of
from implam_post.reference.indentation import IndentationLaw


@dataclass(frozen=True)
class Impactor:
    """The rigid impactor; its velocity at first contact is positive towards the plate."""

    mass: float
    velocity: float
    gravity: float


def impactor_of(deck: Deck) -> Impactor:
    """Return the impactor."""
    if not deck.has("impactor"):
        raise DeckError(f"{deck.path.name} has no &impactor, so that there is no impact to check.")
    if deck.values("impactor", "travel"):
        raise deck.error("impactor", "the semi-analytic solution needs a free impactor, without travel.")
    mass = deck.number("impactor", "mass")
    if mass <= 0:
        raise deck.error("impactor", "the mass must be greater than zero.")
    if not deck.values("impactor", "energy"):
        return Impactor(mass, deck.number("impactor", "velocity"), deck.number("impactor", "gravity", 0.0))
    energy = deck.number("impactor", "energy")
    if deck.values("impactor", "velocity") or energy < 0:
        raise deck.error("impactor", "either velocity or energy is required, and must not be negative.")
    return Impactor(mass, float(np.sqrt(2 * energy / mass)), deck.number("impactor", "gravity", 0.0))


def indentation_law_of(deck: Deck) -> IndentationLaw:
    """Return the indentation law, elastic if the deck has no &indentation; the default of k is Sun's formula."""
    stiffness = deck.number("indentation", "k") if deck.values("indentation", "k") else _sun_stiffness(deck)
    if stiffness <= 0:
        raise deck.error("indentation", "k must be greater than zero.")
    if not deck.has("indentation") or deck.choice("indentation", "law", ("tan_sun", "hertz")) == "hertz":
        return IndentationLaw(stiffness, hertz=True)
    law = IndentationLaw(
        stiffness, unloading=deck.number("indentation", "q", 2.5),
        reloading=deck.number("indentation", "reload", 1.5), slope=deck.number("indentation", "beta", 0.094),
        critical=deck.number("indentation", "alpha_cr"),
        dent=deck.choice("indentation", "dent", ("tan_sun", "yang_sun")))
    if not (1.5 <= law.reloading <= law.unloading and 0 <= law.slope < 1 and law.critical > 0):
        raise deck.error("indentation", "1.5 <= reload <= q, 0 <= beta < 1 and 0 < alpha_cr are required.")
    return law


def _sun_stiffness(deck: Deck) -> float:
    """Return k = 4/3 sqrt(R) / [(1 - nu**2)/E + 1/E3] with E and nu of the impactor (without E: rigid).

    E3 is the modulus of the struck face through its thickness, unless the deck gives it E2 of ply 1, or E/(1 - nu**2)
    if that is isotropic. On a curved plate R is the radius of the relative curvature.
    """
    radius = deck.number("impactor", "radius", 0.0)
    if radius <= 0:
        raise deck.error("indentation", "without k, the radius of the &impactor is required.")
    radius /= np.sqrt(np.prod(1 + radius * np.array(curvatures_of(deck))))
    if deck.choice("indentation", "face", ("ply", "laminate")) == "laminate" and not deck.values("indentation", "E3"):
        raise deck.error("indentation", "with face = 'laminate', k or E3 is required.")
    struck = plies_of(deck)[0].material
    stiffness = struck.e2 / (1 - struck.nu12**2) if struck.isotropic else struck.e2
    flexibility = 1 / deck.number("indentation", "E3", stiffness)
    if deck.values("indentation", "impactor_E"):
        ratio = deck.number("indentation", "impactor_nu", 0.3)
        flexibility += (1 - ratio**2) / deck.number("indentation", "impactor_E")
    return 4.0 / 3.0 * np.sqrt(radius) / flexibility
