"""The stress-free shape of a plate: curvature and imperfection of its deck."""

import numpy as np

from implam_post.io.deck import Deck

__all__ = ["curvatures_of", "heights_of"]


def curvatures_of(deck: Deck) -> tuple[float, float]:
    """Return the curvatures of the lines along x and along y."""
    radii = deck.numbers("plate", "curvature_radius") or [0.0, 0.0]
    if len(radii) != 2:
        raise deck.error("plate", "curvature_radius must be two radii, 0 for straight lines.")
    return 1 / radii[0] if radii[0] else 0.0, 1 / radii[1] if radii[1] else 0.0


def heights_of(deck: Deck | None, places: np.ndarray) -> np.ndarray:
    """Return the heights of the stress-free mid-plane along z at places (..., 2) from the centre; 0 without a deck."""
    if deck is None:
        return np.zeros(places.shape[:-1])
    waves = np.array(deck.numbers("plate", "half_waves") or [1.0, 1.0])
    sines = np.sin(waves * np.pi * (places / np.array(deck.lengths()) + 0.5))
    amplitude = deck.number("plate", "imperfection", 0.0)
    return np.asarray(places**2 @ np.array(curvatures_of(deck)) / 2 + amplitude * np.prod(sines, axis=-1))
