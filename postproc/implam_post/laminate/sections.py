"""Stiffness and mass of a laminate by first-order shear theory."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

# Ratio of transverse shear moduli beyond which the default of the solver is the shear stiffness from equilibrium
# (src/laminate/shear_corrections.f90).
_MAX_CONTRAST = 10


@dataclass(frozen=True)
class Material:
    """An orthotropic ply, 1 along the fibres. Materials of equal density and stiffness are equal."""

    density: float
    e1: float
    e2: float
    g12: float
    g13: float
    g23: float
    nu12: float
    name: str = field(default="", compare=False)
    strengths: tuple[tuple[str, float], ...] = field(default=(), compare=False)
    isotropic: bool = field(default=False, compare=False)
    expansion: tuple[float, float] = field(default=(0.0, 0.0), compare=False)

    def reduced_stiffness(self, angle: float) -> np.ndarray:
        """Return the plane-stress stiffness (xx, yy, xy) of a ply with its fibres at `angle` degrees from x."""
        compliance = np.array([[1 / self.e1, -self.nu12 / self.e1, 0],
                               [-self.nu12 / self.e1, 1 / self.e2, 0],
                               [0, 0, 1 / self.g12]])
        c, s = direction(angle)
        strain = np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]])
        return strain.T @ np.linalg.inv(compliance) @ strain

    def transverse_shear_stiffness(self, angle: float) -> np.ndarray:
        """Return the transverse shear stiffness (xz, yz) of a ply at `angle`."""
        c, s = direction(angle)
        rotation = np.array([[c, s], [-s, c]])
        return rotation.T @ np.diag([self.g13, self.g23]) @ rotation


@dataclass(frozen=True)
class Ply:
    """One ply: material, angle of the fibres from x in degrees, thickness."""

    material: Material
    angle: float
    thickness: float


@dataclass(frozen=True)
class Section:
    """Stiffness and mass of a laminate, about its mid-plane.

    N = a e + b k, M = b e + d k, Q = s g; the mass is the integral of density times (1, z, z**2).
    """

    a: np.ndarray
    b: np.ndarray
    d: np.ndarray
    s: np.ndarray
    mass: np.ndarray
    thickness: float

    def is_specially_orthotropic(self) -> bool:
        """Return whether all couplings that Navier's series does not admit are zero."""
        thickness = self.thickness
        couplings = [*(self.a[:2, 2] / self.a[0, 0]), *(self.d[:2, 2] / self.d[0, 0]), self.s[0, 1] / self.s[0, 0],
                     *(self.b.ravel() / (thickness * self.a[0, 0])), self.mass[1] / (thickness * self.mass[0])]
        return bool(np.max(np.abs(couplings)) < 1e-9)


def shear_contrast(plies: Sequence[Ply]) -> float:
    """Return the largest over the smallest transverse shear modulus of the plies, along x or y."""
    moduli = [np.diag(ply.material.transverse_shear_stiffness(ply.angle)) for ply in plies]
    return float(np.max(np.max(moduli, axis=0) / np.min(moduli, axis=0)))


def natural_shear_correction(plies: Sequence[Ply]) -> str:
    """Return the default shear correction of the solver."""
    return "energy" if shear_contrast(plies) > _MAX_CONTRAST else "5/6"


def section_of(plies: Sequence[Ply], shear_correction: str = "5/6") -> Section:
    """Integrate the plies; `shear_correction` is '5/6' or 'energy'."""
    faces = _faces(plies)
    a, b, d = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros((3, 3))
    s = np.zeros((2, 2))
    mass = np.zeros(3)
    for ply, low, high in zip(plies, faces[:-1], faces[1:], strict=True):
        moments = np.array([high**power - low**power for power in (1, 2, 3)]) / (1, 2, 3)
        stiffness = ply.material.reduced_stiffness(ply.angle)
        a += moments[0] * stiffness
        b += moments[1] * stiffness
        d += moments[2] * stiffness
        s += moments[0] * ply.material.transverse_shear_stiffness(ply.angle)
        mass += moments * ply.material.density
    s = _energy_shear_stiffness(plies, a, b, d) if shear_correction == "energy" else 5.0 / 6.0 * s
    return Section(a, b, d, s, mass, faces[-1] - faces[0])


def _energy_shear_stiffness(plies: Sequence[Ply], a: np.ndarray, b: np.ndarray, d: np.ndarray) -> np.ndarray:
    """Return the shear stiffness whose energy is that of the shear stresses in equilibrium with Mx,x and My,y.

    Unit shear forces Qx = Mx,x and Qy = My,y cause the strain gradient e + z k without membrane forces. The shear
    stresses -integral(Q (e + z k) dz) from the struck face have the energy Q S**-1 Q / 2 (Rolfes and Rohwer 1997).
    """
    points, weights = np.polynomial.legendre.leggauss(3)
    growth = np.linalg.inv(np.block([[a, b], [b, d]]))[:, 3:5]
    faces = _faces(plies)
    compliance, above = np.zeros((2, 2)), np.zeros((2, 2))

    def flow(ply: Ply, low: float, high: float) -> np.ndarray:
        strain = (high - low) * growth[:3] + (high**2 - low**2) / 2 * growth[3:]
        stress = ply.material.reduced_stiffness(ply.angle) @ strain
        return np.array([[stress[0, 0], stress[2, 1]], [stress[2, 0], stress[1, 1]]])

    for ply, low, high in zip(plies, faces[:-1], faces[1:], strict=True):
        flexibility = np.linalg.inv(ply.material.transverse_shear_stiffness(ply.angle))
        for point, weight in zip(points, weights, strict=True):
            here = above + flow(ply, low, (low + high + (high - low) * point) / 2)
            compliance += (high - low) / 2 * weight * here.T @ flexibility @ here
        above = above + flow(ply, low, high)
    return np.linalg.inv(compliance)


def _faces(plies: Sequence[Ply]) -> np.ndarray:
    """Return z of the ply surfaces, from the struck face to the back."""
    heights = np.concatenate([[0.0], np.cumsum([ply.thickness for ply in plies])])
    return heights - heights[-1] / 2


def direction(angle: float) -> tuple[float, float]:
    """Return cosine and sine of an angle in degrees, exact at multiples of 90."""
    quarter, rest = divmod(angle, 90)
    c, s = np.cos(np.radians(rest)), np.sin(np.radians(rest))
    return [(c, s), (-s, c), (-c, -s), (s, -c)][int(quarter) % 4]
