"""Tests of Navier's solution against published or independently computed values."""

import unittest

import numpy as np

from implam_post.laminate.sections import Material, Ply, natural_shear_correction, section_of
from implam_post.reference.navier import Plate, frequencies, sinusoidal_deflection, uniform_deflection


def square(angles: list[float], slenderness: float, correction: str = "5/6", **moduli: float) -> Plate:
    """Return a unit square with plies of equal thickness; E2 = 1 unless it is in `moduli`."""
    data = {"density": 1.0, "e1": 25.0, "e2": 1.0, "g12": 0.5, "g13": 0.5, "g23": 0.2, "nu12": 0.25} | moduli
    thickness = 1 / slenderness / len(angles)
    return Plate(section_of([Ply(Material(**data), angle, thickness) for angle in angles], correction), (1.0, 1.0))


class NavierTest(unittest.TestCase):
    """Static deflection and frequencies."""

    def test_static_deflection(self) -> None:
        """[0/90/0], E1/E2 = 25: 100 w E2 h**3/(q a**4) to the four decimals of the table."""
        cases = {4: (1.7758, 2.6595), 10: (0.6693, 1.0219), 20: (0.4921, 0.7572), 100: (0.4337, 0.6697)}
        for slenderness, expected in cases.items():
            plate = square([0, 90, 0], slenderness)
            found = [100 * deflection(plate, 1.0) / slenderness**3
                     for deflection in (sinusoidal_deflection, uniform_deflection)]
            with self.subTest(slenderness):
                np.testing.assert_allclose(found, expected, atol=5.1e-5)

    def test_laminate_frequencies(self) -> None:
        """E1/E2 = 40, a/h = 5: omega a**2/h sqrt(rho/E2) to the four decimals of the table."""
        for angles, expected in (([0, 90, 90, 0], 10.8540), ([0, 90, 0], 10.2895)):
            plate = square(angles, 5, e1=40.0, g12=0.6, g13=0.6, g23=0.5)
            self.assertAlmostEqual(5 * frequencies(plate)[0], expected, delta=5.1e-5)

    def test_isotropic_frequencies(self) -> None:
        """a/h = 10, nu = 0.3: omega h sqrt(rho/G) times a/h."""
        shear = 1 / 2.6
        plate = square([0], 10, e1=1.0, g12=shear, g13=shear, g23=shear, nu12=0.3)
        for m, n, expected in ((1, 1, 0.93028), (1, 2, 2.21933), (2, 2, 3.40562)):
            self.assertAlmostEqual(frequencies(plate, m, n)[0] / np.sqrt(shear), expected, delta=6e-6)

    def test_curved_frequencies(self) -> None:
        """Cylindrical panels of Sun and Chen's laminate, thin: first frequencies, Hz, of another program."""
        ply = Material(density=1580, e1=120e9, e2=7.9e9, g12=5.5e9, g13=5.5e14, g23=5.5e14, nu12=0.3)
        section = section_of([Ply(ply, angle, 0.269e-3) for angle in [0, 90, 0, 90, 0, 0, 90, 0, 90, 0]])
        for radius, expected in ((0.0, 302.46), (2.0, 332.14), (1.0, 408.45), (0.5, 626.82)):
            plate = Plate(section, (0.2, 0.2), (0.0, 1 / radius if radius else 0.0))
            self.assertAlmostEqual(frequencies(plate)[0] / (2 * np.pi), expected, delta=2e-4 * expected)

    def test_compliance_is_the_sum_over_the_modes(self) -> None:
        """The static solution of a pair is the sum over its three modes."""
        plate = square([0, 90, 0], 10)
        m, n = np.array([1, 3, 21]), np.array([1, 5, 7])
        frequency, deflection = plate.modes(m, n)
        np.testing.assert_allclose(np.sum((deflection / frequency)**2, axis=1), plate.compliance(m, n), rtol=1e-11)

    def test_energy_of_any_plies(self) -> None:
        """Three different plies at general angles: the values in the unit test of the solver, from a third program."""
        pagano = Material(1.0, 25.0, 1.0, 0.5, 0.5, 0.2, 0.25)
        plies = [Ply(pagano, 30, 0.1), Ply(pagano, -60, 0.25), Ply(Material(1.0, 10, 2, 0.7, 0.6, 0.3, 0.3), 10, 0.15)]
        expected = [[0.128208435644, -0.029794813661], [-0.029794813661, 0.141398392483]]
        np.testing.assert_allclose(section_of(plies, "energy").s, expected, rtol=1e-10)

    def test_natural_shear_correction(self) -> None:
        """Shear stiffness from equilibrium if shear moduli in a direction differ by more than 10, as in the solver."""
        skin = Material(1.0, 70.0, 70.0, 5.0, 4.5, 4.5, 0.05)
        for moduli, angle, expected in (((0.03, 0.03), 0, "energy"), ((1.0, 0.449), 0, "energy"),
                                        ((0.449, 1.0), 90, "energy"), ((0.46, 0.46), 0, "5/6")):
            core = Material(0.1, 0.1, 0.1, 0.03, *moduli, 0.3)
            with self.subTest(moduli=moduli):
                plies = [Ply(skin, 0, 1.0), Ply(core, angle, 20.0), Ply(skin, 0, 1.0)]
                self.assertEqual(natural_shear_correction(plies), expected)

    def test_energy_shear_correction(self) -> None:
        """5/6 for one material; closer to three-dimensional elasticity for [0/90/0]."""
        moduli = {"e1": 1.0, "g12": 0.4, "g13": 0.4, "g23": 0.4, "nu12": 0.25}
        np.testing.assert_allclose(square([0], 10, "energy", **moduli).section.s, square([0], 10, **moduli).section.s,
                                   rtol=1e-13, atol=1e-17)
        for slenderness, elasticity in ((4, 2.0059), (10, 0.7530), (20, 0.5164), (100, 0.4347)):
            errors = [abs(100 * sinusoidal_deflection(square([0, 90, 0], slenderness, correction), 1.0)
                          / slenderness**3 / elasticity - 1) for correction in ("energy", "5/6")]
            with self.subTest(slenderness):
                self.assertLess(errors[0], errors[1])
