"""Navier's series for simply supported (hard), specially orthotropic plates by first-order shear theory.

w = W sin sin, theta_x = X cos sin, theta_y = Y sin cos, with rotatory inertia; each (m, n) has three modes. A curved
plate is a shallow shell after Donnell whose edges hold the displacement along themselves only; in-plane displacements
are condensed out, without their inertia.
"""

from dataclasses import dataclass

import numpy as np

from implam_post.io.errors import DeckError
from implam_post.laminate.sections import Section


@dataclass(frozen=True)
class Plate:
    """A simply supported plate: section, sides along x and y, and curvatures of the lines along x and y."""

    section: Section
    lengths: tuple[float, float]
    curvatures: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        """Refuse laminates with couplings that the series does not satisfy."""
        if not self.section.is_specially_orthotropic():
            raise DeckError("the laminate couples bending with twisting or stretching (A16, A26, D16, D26, B or the "
                            "eccentricity of its mass is not zero): Navier's series is not a solution.")

    def stiffness(self, m: np.ndarray, n: np.ndarray) -> np.ndarray:
        """Return the 3x3 stiffness of (W, X, Y) over area/4 for each pair of half-wave numbers."""
        d, s = self.section.d, self.section.s
        x, y = np.asarray(m) * np.pi / self.lengths[0], np.asarray(n) * np.pi / self.lengths[1]
        rows = [[s[0, 0] * x**2 + s[1, 1] * y**2 + self._membrane(x, y), s[0, 0] * x, s[1, 1] * y],
                [s[0, 0] * x, d[0, 0] * x**2 + d[2, 2] * y**2 + s[0, 0], (d[0, 1] + d[2, 2]) * x * y],
                [s[1, 1] * y, (d[0, 1] + d[2, 2]) * x * y, d[2, 2] * x**2 + d[1, 1] * y**2 + s[1, 1]]]
        return np.moveaxis(np.array(rows, dtype=float), (0, 1), (-2, -1))

    def _membrane(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Return the stiffness of W by the membrane forces of a curved plate, with wave numbers along x and y."""
        if not any(self.curvatures):
            return np.zeros(np.broadcast(x, y).shape)
        a = self.section.a
        forces = a[:2, :2] @ np.array(self.curvatures)
        along_x, along_y = forces[0] * x, forces[1] * y
        k11, k22 = a[0, 0] * x**2 + a[2, 2] * y**2, a[2, 2] * x**2 + a[1, 1] * y**2
        k12 = (a[0, 1] + a[2, 2]) * x * y
        condensed = (along_x**2 * k22 - 2 * along_x * along_y * k12 + along_y**2 * k11) / (k11 * k22 - k12**2)
        return np.asarray(forces @ np.array(self.curvatures) - condensed)

    def compliance(self, m: np.ndarray, n: np.ndarray) -> np.ndarray:
        """Return W of each (m, n) under a sinusoidal pressure of unit amplitude; rotations are condensed."""
        k = self.stiffness(m, n)
        determinant = k[..., 1, 1] * k[..., 2, 2] - k[..., 1, 2]**2
        condensed = (k[..., 0, 1]**2 * k[..., 2, 2] - 2 * k[..., 0, 1] * k[..., 0, 2] * k[..., 1, 2]
                     + k[..., 0, 2]**2 * k[..., 1, 1])
        return 1 / (k[..., 0, 0] - condensed / determinant)

    def modes(self, m: np.ndarray, n: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the three angular frequencies of each (m, n), ascending, and W of each mode with unit modal mass."""
        scale = 1 / np.sqrt(self.section.mass[[0, 2, 2]])
        eigenvalues, vectors = np.linalg.eigh(self.stiffness(m, n) * scale[:, None] * scale)
        return np.sqrt(eigenvalues), vectors[..., 0, :] * scale[0]


def frequencies(plate: Plate, m: int = 1, n: int = 1) -> np.ndarray:
    """Return the three angular frequencies with m and n half waves along x and y."""
    return plate.modes(np.array(m), np.array(n))[0]


def sinusoidal_deflection(plate: Plate, pressure: float) -> float:
    """Return the centre deflection under a pressure of one half-sine along each side."""
    return float(pressure * plate.compliance(np.array(1), np.array(1)))


def uniform_deflection(plate: Plate, pressure: float, terms: int = 200) -> float:
    """Return the centre deflection under uniform pressure, with `terms` half-wave numbers along each side."""
    m, n = odd_pairs(terms, terms)
    amplitude = 16 * pressure / (np.pi**2 * m * n)
    return float(np.sum(amplitude * centre_shape(m, n) * plate.compliance(m, n)))


def odd_pairs(along_x: int, along_y: int) -> tuple[np.ndarray, np.ndarray]:
    """Return all pairs of the first odd half-wave numbers; the others do not deflect the centre."""
    m, n = np.meshgrid(2 * np.arange(along_x) + 1, 2 * np.arange(along_y) + 1, indexing="ij")
    return m.ravel(), n.ravel()


def centre_shape(m: np.ndarray, n: np.ndarray) -> np.ndarray:
    """Return the values of the shapes (m, n), both odd, at the centre of the plate."""
    return 1.0 - 2.0 * (((m - 1) // 2 + (n - 1) // 2) % 2)


def patch_shape(plate: Plate, patch: float, m: np.ndarray, n: np.ndarray) -> np.ndarray:
    """Return the means of the shapes (m, n) over the central square of side `patch`."""
    along_x, along_y = plate.lengths
    return centre_shape(m, n) * np.sinc(m * patch / (2 * along_x)) * np.sinc(n * patch / (2 * along_y))
